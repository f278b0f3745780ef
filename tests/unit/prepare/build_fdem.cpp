// Models of FDEM cases: areas, counts, order in memory, refused bodies.

#include "prepare/build_fdem.hpp"

#include <gtest/gtest.h>

#include <set>

#include "math/constants.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia::fdem {
namespace build_fdem_test {

TEST(BuildFdem, RegularPlatesFillTheirRectangle) {
  for (const char* pattern : {"equilateral", "crossed"}) {
    BodyConfig plate = regular_plate({0.1, 0.06}, 0.01);
    plate.pattern = pattern;
    plate.center = {1.0, -2.0};
    plate.velocity = {3.0, 4.0};
    const Model m = built({plate});
    EXPECT_TRUE(is_sound(m)) << pattern;
    EXPECT_NEAR(area_of(m, 0), 0.1 * 0.06, 1e-15);
    for (const Vec2& p : m.point) {
      EXPECT_LE(std::abs(p.x - 1.0), 0.05 + 1e-12);
      EXPECT_LE(std::abs(p.y + 2.0), 0.03 + 1e-12);
    }
    EXPECT_EQ(m.velocity.back().y, 4.0);
    EXPECT_EQ(m.strength.back(), 1.0F);
    EXPECT_EQ(m.groups, std::vector<std::string>{"plate"});
  }
}

TEST(BuildFdem, CrossedSquaresHaveFourTrianglesEach) {
  BodyConfig plate = regular_plate({0.1, 0.06}, 0.01);
  plate.pattern = "crossed";
  const Model m = built({plate});
  EXPECT_EQ(m.size(), 4 * 10 * 6);
  EXPECT_EQ(interior_edges(m), (3 * m.size() - 2 * (10 + 6)) / 2);
  EXPECT_NEAR(smallest_angle(m), 45.0, 1e-9);
}

TEST(BuildFdem, RegularDiscHasSixTrianglesForEachRingSquared) {
  BodyConfig disc = disc_of(0.04, 0.004);
  disc.structured = true;
  const Model m = built({disc});
  EXPECT_TRUE(is_sound(m));
  EXPECT_EQ(m.size(), 600);
  // The regular polygon of 60 corners.
  EXPECT_NEAR(area_of(m, 0), 30.0 * std::sin(2.0 * pi / 60.0) * 0.04 * 0.04, 1e-15);
}

TEST(BuildFdem, JitterKeepsTheAreaAndTheRim) {
  BodyConfig plate = regular_plate({0.1, 0.1}, 0.005);
  const Model regular = built({plate});
  plate.jitter = 0.3;
  const Model moved = built({plate}), again = built({plate}), other = built({plate}, {}, 2);
  EXPECT_TRUE(is_sound(moved));
  EXPECT_NEAR(area_of(moved, 0), 0.01, 1e-15);
  EXPECT_LT(smallest_angle(moved), smallest_angle(regular) - 5.0);
  const auto same = [](const Model& a, const Model& b) {
    for (std::size_t i = 0; i < a.point.size(); ++i)
      if (a.point[i].x != b.point[i].x || a.point[i].y != b.point[i].y) return false;
    return a.triangle == b.triangle;
  };
  EXPECT_TRUE(same(moved, again));
  EXPECT_FALSE(same(moved, other));
}

TEST(BuildFdem, HexagonsAreFreeElementsOfSixTriangles) {
  BodyConfig box;
  box.name = "elements";
  box.shape = "hexagons";
  box.material = "rock";
  box.hexagons = {.count = 32400, .side = 1.0, .gap = 0.1};
  box.size = {400.0, 400.0};
  const Model m = built({box});
  EXPECT_EQ(m.size(), 6 * 32400);
  EXPECT_EQ(m.point.size(), 7U * 32400U);
  EXPECT_EQ(interior_edges(m), 6 * 32400);
  EXPECT_NEAR(area_of(m, 0), 32400 * 1.5 * std::sqrt(3.0), 1e-6);
  EXPECT_TRUE(is_sound(m));
  for (const Vec2& p : m.point) {
    EXPECT_LE(std::abs(p.x), 200.0 + 1e-9);
    EXPECT_LE(std::abs(p.y), 200.0 + 1e-9);
  }
  box.size = {100.0, 100.0};
  EXPECT_TRUE(mentions(refusal({box}), "do not fit into 100 x 100 m"));
}

TEST(BuildFdem, DiscOfGmshIsRoundAndOfGoodTriangles) {
  BodyConfig disc = disc_of(0.04, 0.002);
  disc.center = {0.0, 0.5};
  const Model m = built({disc});
  EXPECT_TRUE(is_sound(m));
  EXPECT_NEAR(area_of(m, 0), pi * 0.04 * 0.04, 1e-3 * pi * 0.04 * 0.04);
  EXPECT_GT(smallest_angle(m), 25.0);
  EXPECT_NEAR(m.size(), 4.0 / std::sqrt(3.0) * pi * 400.0, 0.1 * m.size());
  const Model again = built({disc});
  EXPECT_EQ(m.triangle, again.triangle);
}

/// The disc of Lukas et al. 2014, 5.2: R = 40 mm, 52,308 triangles with both platens, 75,466 joints
/// if the platens have none. At a mesh size of 0.501 mm, gmsh 4.8.4 gives 50,312 triangles and
/// 75,217 joints for the disc; each platen has 11 rows of 83 triangles: 52,138 in all.
TEST(BuildFdem, DiscOfThePaperHasItsCounts) {
  const BodyConfig disc = disc_of(0.04, 0.501e-3);
  BodyConfig top = regular_plate({0.0197, 0.0046}, 0.48e-3), bottom = top;
  top.name = "top";
  top.center = {0.0, 0.0423};
  bottom.name = "bottom";
  bottom.center = {0.0, -0.0423};
  const Model m = built({disc, top, bottom});
  EXPECT_EQ(count_of(m, 1), 913);
  EXPECT_EQ(count_of(m, 2), 913);
  EXPECT_NEAR(m.size(), 52308, 0.005 * 52308);
  EXPECT_NEAR(interior_edges(m) - 2 * interior_edges(built({top})), 75466, 0.005 * 75466);
  EXPECT_GT(smallest_angle(m), 25.0);
  EXPECT_NEAR(area_of(m, 0), pi * 0.04 * 0.04, 1e-4 * pi * 0.04 * 0.04);
}

TEST(BuildFdem, HolesAndSlotsAreCutOut) {
  BodyConfig plate = regular_plate({0.1, 0.05}, 0.002);
  plate.structured = false;
  plate.holes.push_back({{0.02, 0.0}, 0.01});
  plate.notches.push_back({.from = {-0.02, -0.03}, .to = {-0.02, -0.005}, .width = 0.004});
  plate.holes.push_back({{-0.03, 0.01}, 0.0, {{-0.01, -0.005}, {0.01, -0.005}, {0.0, 0.005}}});
  const Model m = built({plate});
  EXPECT_TRUE(is_sound(m));
  EXPECT_NEAR(area_of(m, 0), 0.005 - pi * 1e-4 - 0.004 * 0.02 - 1e-4, 4e-6);
}

TEST(BuildFdem, HolesThatMissTheirBodyAreRefused) {
  BodyConfig plate = regular_plate({0.1, 0.05}, 0.002), disc = disc_of(0.04, 0.002);
  plate.structured = disc.structured = false;
  plate.holes.push_back({{0.045, 0.0}, 0.01});  // over the edge: it takes something
  plate.holes.push_back({{0.07, 0.0}, 0.01});
  disc.holes.push_back({{0.0, 0.1}, 0.0, {{-0.01, -0.005}, {0.01, -0.005}, {0.0, 0.005}}});
  const std::string text = refusal({plate, disc}, {});
  EXPECT_TRUE(
      mentions(text, "body.plate: hole[1] lies wholly outside of the body: it is at x 0.06"));
  EXPECT_TRUE(mentions(text, "a hole must take something of it"));
  EXPECT_TRUE(mentions(text, "body.disc: hole[0] lies wholly outside"));
  EXPECT_TRUE(mentions(text, "2 problems"));
}

TEST(BuildFdem, NotchesAndPartsThatMissTheirBodyAreRefused) {
  BodyConfig plate = regular_plate({0.1, 0.05}, 0.002), ring = disc_of(0.04, 0.002);
  plate.structured = false;
  plate.notches.push_back({.from = {-0.05, 0.0}, .to = {0.05, 0.0}});  // from rim to rim
  plate.notches.push_back({.from = {0.06, 0.0}, .to = {0.08, 0.0}});
  plate.notches.push_back({.from = {-0.02, -0.06}, .to = {-0.02, -0.03}, .width = 0.004});
  ring.name = ring.shape = "ring";
  ring.inner_radius = 0.02;
  ring.center = {0.0, 0.2};
  ring.holes.push_back({{0.0, 0.2}, 0.01});
  BodyConfig part;
  part.name = "core";
  part.shape = "part";
  part.material = "rock";
  part.of = "plate";
  part.center = {0.0, 0.1};
  part.size = {0.02, 0.02};
  BodyConfig middle = part;
  middle.name = "middle";
  middle.of = "ring";
  middle.center = {0.0, 0.2};
  middle.size = {};
  middle.radius = 0.015;
  const std::string text = refusal({plate, ring, part, middle}, {});
  EXPECT_FALSE(mentions(text, "notch[0]"));
  EXPECT_TRUE(
      mentions(text, "body.plate: notch[1] lies wholly outside of the body: it is at x 0.06"));
  EXPECT_TRUE(mentions(text, "body.plate: notch[2] lies wholly outside of the body"));
  EXPECT_TRUE(mentions(text, "body.ring: hole[0] lies wholly in the empty middle of the body"));
  EXPECT_TRUE(mentions(text, "body.core: lies wholly outside of body.plate"));
  EXPECT_TRUE(mentions(text, "body.middle: lies wholly in the empty middle of body.ring"));
  EXPECT_TRUE(mentions(text, "5 problems"));
}

TEST(BuildFdem, RingHasItsArea) {
  BodyConfig ring = disc_of(0.04, 0.002);
  ring.shape = "ring";
  ring.inner_radius = 0.02;
  EXPECT_NEAR(area_of(built({ring}), 0), pi * 0.0012, 1e-5);
}

TEST(BuildFdem, NeighboursInSpaceAreNearInMemory) {
  const Model m = built({disc_of(0.04, 0.001)});
  double apart = 0.0;
  int count = 0;
  for (const auto& edge : prepare::edges_of(m.triangle))
    if (edge.triangles[1] >= 0) {
      apart += std::log2(1.0 + std::abs(edge.triangles[1] - edge.triangles[0]));
      ++count;
    }
  EXPECT_LT(std::exp2(apart / count), 0.01 * m.size());
}

TEST(BuildFdem, NamesEveryProblemAtOnce) {
  BodyConfig plate = regular_plate({0.1, 0.0}, 0.01), disc = disc_of(0.0, 0.0);
  plate.material = "cheese";
  disc.holes.push_back({{}, 0.01});
  plate.holes.push_back({{}, 0.01, {{0.0, 0.0}, {0.01, 0.0}, {0.0, 0.01}}});
  DiscontinuityConfig joint;
  joint.name = "dyke";
  joint.kind = "cohesive";
  joint.points = {{0.0, 0.0}};
  const std::string text = refusal({plate, disc}, {joint});
  EXPECT_TRUE(
      mentions(text, "body.plate: material = \"cheese\" is not a material; there are: rock,"));
  EXPECT_TRUE(mentions(text, "body.plate: shape plate needs size, two lengths above 0"));
  EXPECT_TRUE(mentions(text, "body.disc: shape disc needs a radius above 0"));
  EXPECT_TRUE(mentions(text, "body.disc: shape disc needs mesh_size"));
  EXPECT_TRUE(mentions(text, "discontinuity.dyke: points must be two or more points; there are 1"));
  EXPECT_TRUE(mentions(text,
                       "discontinuity.dyke: material = \"\" is not a joint law; there are: "
                       "rock_joint, vein"));
  EXPECT_TRUE(mentions(text, "body.plate: a hole needs a radius or corners, one of them"));
  EXPECT_TRUE(mentions(text, "8 problems"));
}

}  // namespace build_fdem_test
}  // namespace breccia::fdem
