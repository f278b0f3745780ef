#include "report/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exec/error.hpp"
#include "unit/report/result_scene.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::report {
namespace table_test {

std::string message_of(const std::string& path) {
  try {
    read_measured(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReportTable, ATableOfARunHasNamesUnitsAndNumbers) {
  const ScratchFolder folder;
  test::write_text(folder / "t.csv", "time,\"a, \"\"b\"\"\"\ns,N\n0,1\n0.5,-2e3\n");
  const NumberTable table = read_table(folder / "t.csv");
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[1].name, "a, \"b\"");
  EXPECT_EQ(table.columns[1].unit, "N");
  EXPECT_EQ(table.column("time")->values, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(table.columns[1].values.back(), -2000.0);
}

TEST(ReportTable, ALineThatARunHasOnlyBegunIsPassedOver) {
  const ScratchFolder folder;
  test::write_text(folder / "t.csv", "time,x\ns,m\n0,1\n0.5");
  EXPECT_EQ(read_table(folder / "t.csv").rows(), 1U);
}

TEST(ReportTable, MeasurementsOfALaboratoryBecomeSi) {
  const ScratchFolder folder;
  test::write_text(folder / "lab.csv",
                   "\xef\xbb\xbf# machine 4\ntime [ms];force (kN);note\n0;0;1\n2,5;14,9;\n");
  const NumberTable lab = read_measured(folder / "lab.csv");
  ASSERT_EQ(lab.columns.size(), 3U);
  EXPECT_EQ(lab.columns[0].name, "time");
  EXPECT_EQ(lab.columns[0].unit, "s");
  EXPECT_NEAR(lab.columns[0].values[1], 2.5e-3, 1e-12);
  EXPECT_EQ(lab.columns[1].unit, "N");
  EXPECT_NEAR(lab.columns[1].values[1], 14900.0, 1e-9);
  EXPECT_TRUE(std::isnan(lab.columns[2].values[1]));
}

TEST(ReportTable, UnitsOfMeasurementsMayHaveTheirOwnLine) {
  const ScratchFolder folder;
  test::write_text(folder / "lab.csv", "deflection,force\nmm,N\n1,10\n");
  const NumberTable lab = read_measured(folder / "lab.csv");
  EXPECT_EQ(lab.columns[0].unit, "m");
  EXPECT_NEAR(lab.columns[0].values[0], 1e-3, 1e-15);
}

TEST(ReportTable, WrongMeasurementsAreNamedByFileAndLine) {
  const ScratchFolder folder;
  test::write_text(folder / "names.csv", "1,2\n3,4\n");
  EXPECT_NE(message_of(folder / "names.csv").find("names.csv:1: the first line must hold"),
            std::string::npos);
  test::write_text(folder / "word.csv", "t,f\n0,1\n1,much\n");
  EXPECT_NE(message_of(folder / "word.csv").find("word.csv:3: \"much\" is no number"),
            std::string::npos);
  test::write_text(folder / "short.csv", "t,f\n0,1\n1\n");
  EXPECT_NE(message_of(folder / "short.csv").find("short.csv:3: 1 fields"), std::string::npos);
  test::write_text(folder / "one.csv", "t\n0\n");
  EXPECT_NE(message_of(folder / "one.csv").find("at least two numbers"), std::string::npos);
  EXPECT_THROW(read_measured(folder / "none.csv"), IoError);
}

TEST(ReportTable, UnknownUnitsAreRefusedWithTheirColumn) {
  const ScratchFolder folder;
  test::write_text(folder / "a.csv", "deflection [mm],force [kNn]\n1,10\n");
  EXPECT_NE(message_of(folder / "a.csv")
                .find("a.csv: \"kNn\", the unit of column force, is no "
                      "unit; did you mean kN"),
            std::string::npos)
      << message_of(folder / "a.csv");
  test::write_text(folder / "b.csv", "deflection,force\nmm,bananas\n1,10\n");
  EXPECT_NE(message_of(folder / "b.csv").find("bananas"), std::string::npos);
  test::write_text(folder / "c.csv", "strain [%],share [-]\n1,10\n");
  EXPECT_EQ(message_of(folder / "c.csv"), "");
}

}  // namespace table_test
}  // namespace breccia::report
