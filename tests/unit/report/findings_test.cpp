#include "report/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/whole_file.hpp"
#include "report/breakage.hpp"
#include "report/first_breaks.hpp"
#include "report/survey.hpp"
#include "unit/io/solid_scene.hpp"
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
  EXPECT_NE(text.find("1 of 7 links broke (14 %); softening began by 2 ms, the first broke between "
                      "1 ms and 2 ms."),
            std::string::npos)
      << text;
  // The link between spheres 3 and 4: at 0.07 m, stretched by 2 %, half of the gap of 50 mm.
  EXPECT_NE(text.find("It began around (96.4, 0.5, 0) mm in chain"), std::string::npos) << text;
  EXPECT_NE(
      text.find("2 pieces are left, whole bodies among them, the largest with 50 % of all mass"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("pull, right was 4,000 N at its strongest, at 1 ms; 25 % of it is left"),
            std::string::npos)
      << text;
}

/// Corners of two bars that hit each other press on the penalty for a moment.
TEST(Findings, APeakOfOneRowIsToldAsSuch) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  for (const double beside : {3.0, 70.0}) {
    std::string rows = "step,time,push\n-,s,N\n";
    for (int i = 0; i < 30; ++i) {
      const double value = i == 12 ? 100.0 : i == 11 || i == 13 ? beside : 1.0;
      rows += fmt::format("{},{},{}\n", i, 1e-3 * i, value);
    }
    test::write_text(folder.path() + "/history.csv", rows);
    const std::string text = joined(findings_of(read_record(folder.path())));
    EXPECT_NE(text.find("push was 100 N at its strongest, at 12 ms"), std::string::npos) << text;
    EXPECT_EQ(text.find("in one row alone (3 N in those beside it") != std::string::npos,
              beside < 50.0)
        << text;
  }
}

TEST(Findings, ListsOfBrokenLinksTellWhenMoreCloselyThanFrames) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  test::write_text(folder.path() + "/broken_links.csv",
                   "a,b,kind,time\n-,-,-,s\n0,1,0,0\n4,5,0,0.0019\n3,4,0,0.0013\n5,6,0,0.0015\n");
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("the first broke by 1.3 ms, half of them by 1.5 ms."), std::string::npos)
      << text;
}

/// A frame shows two places broken; the list tells which one was first.
TEST(Findings, TheFirstBreakIsWhereTheListSaysAndNotBetweenTwo) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  Shot shot;
  for (int k = 0; k < 8; ++k) shot.corner.push_back({0.02 * k, 0.0, 0.0});
  for (int k = 0; k < 7; ++k) shot.ends.insert(shot.ends.end(), {k, k + 1});
  const std::vector<std::uint8_t> both{0, 1, 0, 0, 0, 1, 1};
  std::vector<std::uint8_t> broken = both;
  test::write_text(folder.path() + "/broken_links.csv", "a,b,kind,time\n-,-,-,s\n5,6,0,0.001\n");
  leave_first(read_record(folder.path()), shot, broken);
  EXPECT_EQ(broken, both) << "no places";
  EXPECT_NEAR(middle_of(shot, broken).x, 0.09, 1e-12);
  test::write_text(folder.path() + "/broken_links.csv",
                   "a,b,x,y,z,kind,time\n-,-,m,m,m,-,s\n1,2,0.03,0,0,0,0.002\n"
                   "5,6,0.1102,0,0,0,0.001\n6,7,0.13,0,0,0,0.002\n");
  leave_first(read_record(folder.path()), shot, broken);
  EXPECT_EQ(broken, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 0}));
}

/// Rows that are farther apart than softening takes: nothing breaks before it softens.
TEST(Findings, NothingBreaksBeforeItSoftens) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const auto told = [&](const char* broke) {
    test::write_text(folder.path() + "/broken_links.csv",
                     fmt::format("a,b,kind,time\n-,-,-,s\n3,4,0,{}\n", broke));
    return joined(findings_of(read_record(folder.path())));
  };
  const std::string before = told("0.0013");  // the row is of 2 ms
  EXPECT_NE(before.find("(14 %); the first broke by 1.3 ms."), std::string::npos) << before;
  const std::string after = told("0.0023");
  EXPECT_NE(after.find("softening began by 2 ms, the first broke by 2.3 ms."), std::string::npos)
      << after;
}

TEST(Findings, OneEventHasOneMagnitude) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string path = folder.path() + "/summary.json", plain = read_whole_file(path);
  for (const auto& [count, told] : {std::pair{1, "1 event, of magnitude -3.5; no b value"},
                                    {2, "2 events, of magnitudes up to -3.5; no b value"}}) {
    test::write_text(
        path, fmt::format(R"({{"emission": {{"events": {}, "largest_magnitude": -3.5}},{})", count,
                          plain.substr(1)));
    const std::string text = joined(findings_of(read_record(folder.path())));
    EXPECT_NE(text.find(told), std::string::npos) << text;
  }
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

/// A specimen may be torn through while each link still bears a little.
TEST(Findings, LinksThatHaveSoftenedMuchAreACrack) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 8, 99);
  const std::string path = folder.path() + "/summary.json";
  test::write_text(path, R"({"energy": {"fracture": 1.5}, "status": "done",
  "method": "dem3d", "model": {"elements": 8, "links": 7}, "fracture": {"broken_links": 0}})");
  for (const float lost : {0.3F, 0.9F}) {
    ParaviewSeries series(folder.path());
    for (int k = 0; k < 3; ++k) {
      Frame frame = test::chain_frame(k, 8, 99);
      if (k == 2) frame.point_fields[2].values[5] = lost;
      series.write(frame);
    }
    series.finish();
    const std::string text = joined(findings_of(read_record(folder.path())));
    EXPECT_EQ(
        text.find(
            "Nothing broke to its end, though 1.5 J went into softening of some of 7 links.") ==
            std::string::npos,
        lost > 0.5F)
        << text;
    EXPECT_EQ(
        text.find("of 7 links, none broke to its end, but 1.5 J went into softening, and those "
                  "around (102, 2, 0) mm have lost 90 % of what they bear") != std::string::npos,
        lost > 0.5F)
        << text;
  }
}

/// Frames give spheres of bodies that a stage has taken out the radius 0: the tension was "inf".
TEST(Findings, LinksOfBodiesThatAreGoneBearNothing) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 8, 99);
  ParaviewSeries series(folder.path());
  for (int k = 0; k < 3; ++k) {
    Frame frame = test::chain_frame(k, 8, 99);
    if (k == 2) frame.radius[3] = 0.0;
    series.write(frame);
  }
  series.finish();
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("is 0.5 of the strength of c30"), std::string::npos) << text;
}

TEST(Findings, WhatCutsPartedBeforeTheStartDidNotBreak) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 8, 0);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("Nothing broke to its end, though 1.5 J went into softening of some of 6"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Besides, 1 link was parted by cuts before the start."), std::string::npos)
      << text;
  EXPECT_EQ(text.find("It began"), std::string::npos) << text;
}

/// Frames of a block of tetrahedra with a crack of the normal x, and one stress in all of it.
void write_block(const std::string& folder, bool cracked, const std::array<double, 6>& stress) {
  ParaviewSeries series(folder);
  for (int k = 0; k < 2; ++k) {
    solid_scene::Block block(4, 2, 3);
    block.add_numbers("group", [](Vec3) { return 0; });
    block.add_numbers("material", [](Vec3) { return 0; });
    const char* const names[] = {"stress_xx", "stress_yy", "stress_zz",
                                 "stress_xy", "stress_yz", "stress_xz"};
    for (std::size_t c = 0; c < 6; ++c)
      block.add_field(names[c], "Pa", [&](Vec3) { return k * stress[c]; });
    if (cracked && k == 1) block.crack(2.0, [](Vec3) { return 0.0; }, {});
    block.frame.groups = {"rock"};
    block.frame.time = 1e-3 * k;
    series.write(block.frame);
  }
  series.finish();
  test::write_text(folder + "/summary.json",
                   fmt::format(R"({{"case": {{"name": "block"}}, "time": 0.001,
                     "model": {{"tetrahedra": 144, "joints": 228}},
                     "fracture": {{"broken_joints": {}, "fragments": 2}}}})",
                               cracked ? 12 : 0));
  test::write_text(folder + "/case.toml",
                   "[material.rock]\njoint = { tension = 4e6 }\n"
                   "[[body]]\nname = \"rock\"\nmaterial = \"rock\"\n");
}

TEST(Findings, TetrahedraAreJudgedByTheirLargestPrincipalStress) {
  // 3 MPa along (2, 1, 2)/3, less 1 MPa along (1, 2, -2)/3 and 2 MPa along (2, -2, -1)/3.
  std::array<double, 6> stress{};
  const double principal[3][4] = {{2, 1, 2, 3e6}, {1, 2, -2, -1e6}, {2, -2, -1, -2e6}};
  for (const auto& [x, y, z, size] : principal) {
    const double parts[] = {x * x, y * y, z * z, x * y, y * z, x * z};
    for (std::size_t c = 0; c < 6; ++c) stress[c] += size * parts[c] / 9.0;
  }
  const ScratchFolder folder;
  write_block(folder.path(), false, stress);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("is 0.75 of the strength of rock"), std::string::npos) << text;
}

/// Joints of coarse meshes lie askew of what is pulled most.
TEST(Findings, TensionThatNoJointLiesAcrossSoftensNothing) {
  const ScratchFolder folder;
  write_block(folder.path(), false, {8e6, 0.0, 0.0, 0.0, 0.0, 0.0});
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("is 2 of the strength of rock"), std::string::npos) << text;
  EXPECT_EQ(text.find("softens there"), std::string::npos) << text;
  EXPECT_NE(text.find("and yet nothing softens: no joint lies across it."), std::string::npos)
      << text;
}

TEST(Findings, CracksOfTetrahedraHaveAPlaceAndDirections) {
  const ScratchFolder folder;
  write_block(folder.path(), true, {});
  const Record record = read_record(folder.path());
  const std::string text = joined(findings_of(record));
  EXPECT_NE(text.find("It began around (2, 1, 1.5) m"), std::string::npos) << text;
  const Survey survey = survey_of(folder.path(), 2);
  const std::vector<Rose> roses = roses_of(record, survey.first, survey.last);
  ASSERT_EQ(roses.size(), 2U);
  EXPECT_NEAR(roses[0].bars[9], 6.0, 1e-6);  // strike along y: 2 m by 3 m
  EXPECT_NEAR(roses[1].bars[8], 6.0, 1e-6);  // upright
}

TEST(Findings, ARunWithoutFramesStillHasItsNumbers) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  for (const char* name : {"/elements.pvd", "/links.pvd"})
    std::filesystem::remove(folder.path() + name);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("1 of 7 links broke"), std::string::npos) << text;
}

TEST(Findings, CracksOfSpheresTellWhatSlipAndFrictionTookBesides) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string path = folder.path() + "/summary.json";
  std::string summary = read_whole_file(path);
  const std::string fracture = "\"energy\": {\"fracture\": 1.5";
  const std::size_t at = summary.find(fracture);
  ASSERT_NE(at, std::string::npos);
  summary.insert(at + fracture.size(), ", \"plastic\": 2.1, \"friction\": 12.6");
  test::write_text(path, summary);
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("took 1.5 J in cracks besides 2.1 J of plastic slip and 12.6 J of friction"),
            std::string::npos)
      << text;
}

TEST(Findings, PlasticWorkOfBarsIsNoSlipAlone) {
  const ScratchFolder folder;
  test::write_text(folder / "summary.json", R"({"case": {"name": "tie"},
    "model": {"elements": 9, "links": 50, "links_by_kind": {"steel": 20}},
    "fracture": {"broken_links": 2, "fragments": 1, "largest_fragment_fraction": 1},
    "energy": {"fracture": 2.4, "plastic": 43.1}})");
  const std::string text = joined(findings_of(read_record(folder.path())));
  EXPECT_NE(text.find("besides 43.1 J in yielding bars and plastic slip"), std::string::npos)
      << text;
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
