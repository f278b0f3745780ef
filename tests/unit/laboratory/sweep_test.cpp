// Values of a sweep, its folders, and its tables.

#include "laboratory/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exec/error.hpp"

namespace breccia::laboratory {
namespace sweep_test {

using Texts = std::vector<std::string>;

TEST(SweepAxis, TakesListsAndRangesOfEveryNumberInThem) {
  EXPECT_EQ(sweep_axis("seed=1,2, 5").values, (Texts{"1", "2", "5"}));
  EXPECT_EQ(sweep_axis("time.end=1..2:3").values, (Texts{"1", "1.5", "2"}));
  EXPECT_EQ(sweep_axis("v=10..40 m/s2:4").values,
            (Texts{"10 m/s2", "20 m/s2", "30 m/s2", "40 m/s2"}));
  EXPECT_EQ(sweep_axis("v=[0, 0, -10]..[0, 0, -20]:2,[1, 2, 3]").values,
            (Texts{"[0, 0, -10]", "[0, 0, -20]", "[1, 2, 3]"}));
  EXPECT_EQ(sweep_axis("title=\"a, b\",c").values, (Texts{"\"a, b\"", "c"}));
  EXPECT_EQ(sweep_axis("x=1e-3..3e-3:3").values, (Texts{"0.001", "0.002", "0.003"}));
}

TEST(SweepAxis, RefusesWhatIsNoListOfValues) {
  for (const char* wrong : {"seed", "=1", "seed=", "seed=1,,2", "seed=1,1", "seed=1..5:1",
                            "seed=1..5:x", "v=1 m..2 s:3"})
    EXPECT_THROW(sweep_axis(wrong), InputError) << wrong;
}

TEST(SweepPoints, AreEveryCombinationWithEverySeed) {
  const std::vector<SweepAxis> axes{{"a.b", {"1", "2"}}, {"c", {"x", "y"}}};
  const std::vector<SweepPoint> points = sweep_points(axes, {7, 8, 9});
  ASSERT_EQ(points.size(), 12U);
  EXPECT_EQ(points[4].overrides(axes), (Texts{"a.b=1", "c=y", "seed=8"}));
  EXPECT_EQ(points[4].name(axes), "b=1 c=y seed=8");
  EXPECT_THROW(sweep_points({{"a", Texts(5000, "1")}}, {1, 2, 3}), InputError);
}

TEST(SweepPoints, HaveTheSeedsOfTheAxisSeed) {
  using Seeds = std::vector<std::int64_t>;
  std::vector<SweepAxis> axes{{"a", {"1", "2"}}, {"seed", {"4", "9"}}};
  const Seeds seeds = sweep_seeds(axes, 1, 1);
  EXPECT_EQ(seeds, (Seeds{4, 9}));
  ASSERT_EQ(axes.size(), 1U);
  const std::vector<SweepPoint> points = sweep_points(axes, seeds);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[3].overrides(axes), (Texts{"a=2", "seed=9"}));
  EXPECT_EQ(sweep_seeds(axes, 5, 2), (Seeds{5, 6}));
  std::vector<SweepAxis> wrong{{"seed", {"1", "1.5"}}};
  EXPECT_THROW(sweep_seeds(wrong, 1, 1), InputError);
  EXPECT_THROW(sweep_seeds(wrong, 1, 2), InputError);
}

TEST(RunFolder, IsAPlainNameThatDiffersWithTheCase) {
  EXPECT_EQ(run_folder_name("v=[0, 1] seed=2", "0123456789"), "v=_0__1__seed=2-01234567");
}

RunResult shown(double value) {
  RunResult result;
  result.status = "done";
  result.numbers = {{"a", value}, {"probe.p.min", -value}, {"probe.p.max", 0.5 * value}};
  return result;
}

TEST(SweepTable, GivesMeanDeviationAndCountAndKeepsFailures) {
  const std::vector<SweepAxis> axes{{"k", {"1", "2"}}};
  std::vector<SweepRow> rows;
  for (const SweepPoint& point : sweep_points(axes, {1, 2})) rows.push_back({point, "f", {}, {}});
  rows[0].result = shown(1.0);
  rows[1].result = shown(3.0);
  rows[2].result = shown(5.0);
  rows[3].run.exit_code = 4;
  rows[3].run.message = "step 12, t = 1 s: it flew away";
  const SweepTable table(axes, rows, {"a", "probe.p.peak"});
  const auto groups = table.groups();
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_DOUBLE_EQ(groups[0].spreads[0].mean, 2.0);
  EXPECT_DOUBLE_EQ(groups[0].spreads[0].deviation, std::sqrt(2.0));
  EXPECT_EQ(groups[0].spreads[0].n, 2);
  EXPECT_DOUBLE_EQ(groups[0].spreads[1].mean, -2.0);  // the peak has the sign of the larger side
  EXPECT_EQ(groups[1].spreads[0].n, 1);
  EXPECT_NE(table.csv().find("2,2,failed,4,,,f,\"step 12, t = 1 s: it flew away\""),
            std::string::npos)
      << table.csv();
  const std::string text = table.markdown("t");
  EXPECT_NE(text.find("| 1 | 2 +- 1.4 (2) | -2 +- 1.4 (2) |"), std::string::npos) << text;
  EXPECT_NE(
      text.find("- k=2 seed=2: exit code 4: step 12, t = 1 s: it flew away; all it said: f.log"),
      std::string::npos)
      << text;
  EXPECT_EQ(table.plots().size(), 2U);
}

TEST(SweepTable, TellsWhichRunsFailedWhereNoneHasAResult) {
  std::vector<SweepRow> rows(3);
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k].point.seed = static_cast<std::int64_t>(k) + 1;
  rows[0] = {rows[0].point, "runs/a", {4, false, 1.0, "it flew away"}, {}};
  rows[1] = {rows[1].point, "runs/b", {-9, false, 1.0, "killed by signal 9"}, {}};
  rows[2] = {rows[2].point, "runs/c", {130, false, 0.0, ""}, {}};
  const std::string text = SweepTable({}, rows, {}).markdown("t");
  EXPECT_EQ(text,
            "# t\n\nNo run has a result.\n\n## Every run\n\n| seed | status |\n|---|---|\n"
            "| 1 | failed |\n| 2 | failed |\n| 3 | interrupted |\n\n## Runs without a result\n\n"
            "- seed=1: exit code 4: it flew away; all it said: runs/a.log\n"
            "- seed=2: killed by signal 9; all it said: runs/b.log\n- seed=3: was not run\n");
}

TEST(LinePlot, SaysWhenThereIsNothingToDraw) {
  EXPECT_NE(svg_of({LinePlot{"a < b", "x", "y", {}, {}, {}}}).find("no numbers"),
            std::string::npos);
  EXPECT_NE(svg_of({LinePlot{"a < b", "x", "y", {}, {}, {}}}).find("a &lt; b"), std::string::npos);
}

}  // namespace sweep_test
}  // namespace breccia::laboratory
