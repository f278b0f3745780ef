#include "report/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "report/breakage.hpp"
#include "report/survey.hpp"
#include "unit/report/result_scene.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::report {
namespace findings_test {

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

TEST(Findings, ABrokenChainIsToldByWhatWhenAndWhere) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("1 of 7 links broke (14 %); softening began at 2 ms, the first broke between "
                      "1 ms and 2 ms."),
            std::string::npos)
      << text;
  // The link between spheres 3 and 4: at 0.07 m, stretched by 2 %, half of the gap of 50 mm.
  EXPECT_NE(text.find("It began around (96.4, 0.5, 0) mm in chain"), std::string::npos) << text;
  EXPECT_NE(text.find("2 pieces are left, the largest with 50 % of the mass"), std::string::npos)
      << text;
  EXPECT_NE(text.find("pull, right was 4,000 N at its strongest, at 1 ms; 25 % of it is left"),
            std::string::npos)
      << text;
}

TEST(Findings, AnUnbrokenChainTellsHowNearItCame) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 8, 99);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("Nothing broke: all 7 links are whole and none has softened."),
            std::string::npos)
      << text;
  // 0.25 a frame of what a link bears, two frames.
  EXPECT_NE(text.find("is 0.5 of the strength of c30"), std::string::npos) << text;
  EXPECT_NE(text.find("2 times the load begins to break it"), std::string::npos) << text;
}

TEST(Findings, WhatCutsPartedBeforeTheStartDidNotBreak) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 8, 0);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("Nothing broke: all 6 links are whole"), std::string::npos) << text;
  EXPECT_NE(text.find("Besides, 1 link was parted by cuts before the start."), std::string::npos)
      << text;
  EXPECT_EQ(text.find("It began"), std::string::npos) << text;
}

TEST(Findings, ARunWithoutFramesStillHasItsNumbers) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  for (const char* name : {"/elements.pvd", "/links.pvd"})
    std::filesystem::remove(folder.path() + name);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("1 of 7 links broke"), std::string::npos) << text;
}

TEST(Findings, CracksOfAPlaneTellTheirMode) {
  const ScratchFolder folder;
  test::write_text(folder / "summary.json", R"({"case": {"name": "disc"}, "model": {"joints": 50},
    "fracture": {"broken_joints": 2, "fragments": 2, "largest_fragment_fraction": 0.75,
                 "energy_by_mode": {"opening": 3.0, "sliding": 1.0}}})");
  test::write_text(folder / "cracks.csv",
                   "time,x0,y0,x1,y1,mode\ns,m,m,m,m,-\n"
                   "0.001,0,0,0,0.02,0\n0.003,0,0,-0.01,-0.01,1\n");
  const Record record = read_record(folder.path());
  const std::string text = joined(findings_of(record));
  EXPECT_NE(text.find("2 of 50 joints broke (4 %); the first broke at 1 ms, half of them by 1 ms."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("It began at (0, 10) mm, by opening (75 % of the fracture energy); 2 pieces"),
            std::string::npos)
      << text;
  Shot plane;
  plane.plane = true;
  const std::vector<Rose> roses = roses_of(record, plane, plane);
  ASSERT_EQ(roses.size(), 1U);
  EXPECT_NEAR(roses[0].bars[9], 0.02, 1e-12);                   // upright
  EXPECT_NEAR(roses[0].bars[4], 0.01 * std::sqrt(2.0), 1e-12);  // at 45 degrees
}

TEST(Findings, PiecesAreWhatWholeLinksHoldTogether) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const Record record = read_record(folder.path());
  const Survey survey = survey_of(folder.path(), 3);
  EXPECT_EQ(fragment_shares(record, survey.first), std::vector<double>{1.0});
  EXPECT_EQ(fragment_shares(record, survey.last), (std::vector<double>{0.5, 0.5}));
  const std::vector<Rose> roses = roses_of(record, survey.first, survey.last);
  ASSERT_EQ(roses.size(), 2U);
  // The link lay along x: its crack stands upright, its strike is about along y.
  EXPECT_NEAR(roses[1].bars.back(), 3.14159265 * 1e-4, 1e-9);
  double sum = 0.0;
  for (const double bar : roses[0].bars) sum += bar;
  EXPECT_NEAR(roses[0].bars[8] + roses[0].bars[9], sum, 1e-15);
}

}  // namespace findings_test
}  // namespace breccia::report
