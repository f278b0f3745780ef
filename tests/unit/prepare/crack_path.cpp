// Cracks that are there at the start: the edges of the mesh that they take.

#include "prepare/meshing/crack_path.hpp"

#include <gtest/gtest.h>

#include "prepare/meshing/mesh_overlap.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia::fdem {
namespace crack_path_test {

double length_of(const Model& m, std::int16_t material) {
  double sum = 0.0;
  for (const auto& crack : m.discontinuities)
    if (crack.material == material)
      sum += norm(prepare::at(m.point, crack.edge[0]) - prepare::at(m.point, crack.edge[1]));
  return sum;
}

TEST(CrackPath, NotchOfNoWidthFollowsARowOfARegularMesh) {
  BodyConfig plate = regular_plate({0.1, 0.1}, 0.01);
  plate.pattern = "crossed";
  plate.notches.push_back({.from = {-0.02, 0.0}, .to = {0.03, 0.0}, .width = 0.0});
  const Model m = built({plate});
  EXPECT_EQ(m.discontinuities.size(), 5U);
  EXPECT_NEAR(length_of(m, -1), 0.05, 1e-12);
  for (const auto& crack : m.discontinuities)
    for (const Index v : crack.edge) EXPECT_NEAR(prepare::at(m.point, v).y, 0.0, 1e-12);
}

TEST(CrackPath, LineFromOutsideBeginsAtTheRim) {
  BodyConfig plate = regular_plate({0.1, 0.1}, 0.01);
  plate.pattern = "crossed";
  DiscontinuityConfig fault;
  fault.name = "fault";
  fault.kind = "cohesive";
  fault.material = "vein";
  fault.points = {{-0.5, 0.021}, {0.5, 0.019}};
  const Model m = built({plate}, {fault});
  EXPECT_EQ(m.discontinuities.size(), 10U);
  EXPECT_NEAR(length_of(m, 1), 0.1, 1e-12);
}

TEST(CrackPath, MeshOfGmshHasEdgesOnTheLine) {
  BodyConfig disc = disc_of(0.04, 0.001);
  disc.notches.push_back({.from = {-0.005, -0.005}, .to = {0.005, 0.005}, .width = 0.0});
  DiscontinuityConfig chord;
  chord.name = "chord";
  chord.points = {{-0.06, 0.02}, {0.06, 0.02}};
  const Model m = built({disc}, {chord});
  EXPECT_TRUE(is_sound(m));
  const double half_chord = std::sqrt(0.04 * 0.04 - 0.02 * 0.02);
  EXPECT_NEAR(length_of(m, -1), 0.01 * std::sqrt(2.0) + 2.0 * half_chord, 2e-5);
  int on_chord = 0;
  for (const auto& crack : m.discontinuities)
    for (const Index v : crack.edge) {
      const Vec2 p = prepare::at(m.point, v);
      EXPECT_TRUE(std::abs(p.y - 0.02) < 1e-9 || std::abs(p.x - p.y) < 1e-9);
      on_chord += std::abs(p.y - 0.02) < 1e-9;
    }
  EXPECT_GT(on_chord, 60);
}

TEST(CrackPath, SnappedPolylineIsOnePathNearTheLine) {
  BodyConfig disc = disc_of(0.04, 0.001);
  DiscontinuityConfig bent;
  bent.name = "bent";
  bent.embedded = false;
  bent.points = {{-0.02, 0.0}, {0.0, 0.003}, {0.02, -0.01}};
  const Model m = built({disc}, {bent});
  std::vector<int> ends(m.point.size());
  for (const auto& crack : m.discontinuities)
    for (const Index v : crack.edge) {
      ++ends[static_cast<std::size_t>(v)];
      const Vec2 p = prepare::at(m.point, v);
      const double line = p.x < 0.0 ? 0.003 + 0.15 * p.x : 0.003 - 0.65 * p.x;
      EXPECT_LT(std::abs(p.y - line), 0.0015);
    }
  EXPECT_EQ(std::count(ends.begin(), ends.end(), 1), 2) << "a path has two ends";
  EXPECT_EQ(std::count(ends.begin(), ends.end(), 3), 0) << "and no branches";
}

TEST(CrackPath, LineThroughAHoleIsInTwoPieces) {
  BodyConfig plate = regular_plate({0.1, 0.1}, 0.002);
  plate.structured = false;
  plate.holes.push_back({{0.0, 0.0}, 0.02});
  DiscontinuityConfig fault;
  fault.name = "fault";
  fault.points = {{-0.06, 0.0}, {0.06, 0.0}};
  EXPECT_NEAR(length_of(built({plate}, {fault}), -1), 0.06, 1e-9);
}

TEST(CrackPath, MissingTheBodyIsRefused) {
  BodyConfig plate = regular_plate({0.1, 0.1}, 0.01);
  DiscontinuityConfig far;
  far.name = "far";
  far.points = {{0.0, 3.0}, {1.0, 3.0}};
  const std::string beside = refusal({plate}, {far});
  EXPECT_TRUE(mentions(beside, "discontinuity.far: meets no edge between two triangles")) << beside;
  BodyConfig scratched = plate;  // shorter than an edge, inside of a triangle
  scratched.notches.push_back({.from = {0.002, 0.001}, .to = {0.003, 0.001}, .width = 0.0});
  const std::string within = refusal({scratched}, {far});
  EXPECT_TRUE(mentions(within, "body.plate: notch[0] meets no edge between two triangles"))
      << within;
  EXPECT_TRUE(mentions(within, "discontinuity.far: meets no edge between two triangles")) << within;
  plate.notches.push_back({.from = {1.0, 0.0}, .to = {2.0, 0.0}, .width = 0.0});
  const std::string outside = refusal({plate}, {far});
  EXPECT_TRUE(mentions(outside, "notch[0] lies wholly outside of the body")) << outside;
}

TEST(MeshOverlap, SharedAreaOfTriangles) {
  const std::array<Vec2, 3> a{Vec2{0, 0}, Vec2{2, 0}, Vec2{0, 2}};
  EXPECT_DOUBLE_EQ(prepare::shared_area(a, a), 2.0);
  EXPECT_DOUBLE_EQ(prepare::shared_area(a, {Vec2{1, 0}, Vec2{3, 0}, Vec2{1, 2}}), 0.5);
  EXPECT_DOUBLE_EQ(prepare::shared_area(a, {Vec2{2, 0}, Vec2{2, 2}, Vec2{0, 2}}), 0.0);
}

TEST(MeshOverlap, BodiesInEachOtherAreRefusedAndTouchingOnesAreNot) {
  BodyConfig disc = disc_of(0.04, 0.002), platen = regular_plate({0.02, 0.01}, 0.002);
  platen.center = {0.0, 0.045};
  EXPECT_EQ(refusal({disc, platen}), "");
  platen.center.y = 0.044;
  EXPECT_TRUE(mentions(refusal({disc, platen}), "body.disc and body.plate overlap at the start"));
}

}  // namespace crack_path_test
}  // namespace breccia::fdem
