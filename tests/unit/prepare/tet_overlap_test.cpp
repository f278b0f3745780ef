// Bodies of tetrahedra that lie in each other, and vertices that look like one.

#include "prepare/tetrahedra/tet_overlap.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "io/whole_file.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::fdem3 {
namespace tet_overlap_test {

using Corners = std::array<Vec3, 4>;

bool inside(const Corners& t, const Vec3& x) {
  for (const auto& k : prepare::face_corners)
    if (dot(cross(t[k[1]] - t[k[0]], t[k[2]] - t[k[0]]), x - t[k[0]]) > 0.0) return false;
  return true;
}

TEST(TetOverlap, DepthIsPositiveJustWhereTwoShareAPoint) {
  int shared = 0, apart = 0;
  for (std::uint64_t round = 0; round < 300; ++round) {
    const Random random{round, 3};
    std::uint64_t draw = 0;
    const auto corners = [&] {
      Corners t;
      for (Vec3& p : t)
        p = {random.uniform(draw++), random.uniform(draw++), random.uniform(draw++)};
      if (dot(cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]) < 0.0) std::swap(t[0], t[1]);
      return t;
    };
    const Corners a = corners();
    Corners b = corners();
    for (Vec3& p : b) p.x += 0.35;
    const double depth = prepare::shared_depth(a, b);
    bool meet = false;
    for (int k = 0; k < 4000 && !meet; ++k) {  // points of a
      std::array<double, 4> w{};
      double sum = 0.0;
      for (double& each : w) sum += each = -std::log(1.0 - random.uniform(draw++));
      Vec3 x{};
      for (std::size_t c = 0; c < 4; ++c) x += (w[c] / sum) * a[c];
      meet = inside(b, x);
    }
    EXPECT_FALSE(meet && depth <= 0.0) << round;
    EXPECT_FALSE(!meet && depth > 0.1) << round;
    ++(depth > 0.0 ? shared : apart);
  }
  EXPECT_GT(shared, 50);
  EXPECT_GT(apart, 50);
}

TEST(TetOverlap, DepthIsThatOfTheShallowestAxis) {
  const Corners low{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Corners high = low;
  for (Vec3& p : high) p = Vec3{0.1, 0.1, -0.01} - p;  // base on base, turned
  for (Vec3& p : high) p.z += 0.03;
  EXPECT_NEAR(prepare::shared_depth(low, high), 0.02, 1e-15);
  for (Vec3& p : high) p.z -= 0.02;
  EXPECT_NEAR(prepare::shared_depth(low, high), 0.0, 1e-15);
}

TEST(TetOverlap, BodiesInEachOtherAreRefused) {
  BodyConfig box = regular_box({0.1, 0.1, 0.1}, 0.02), other = box;
  other.name = "other";
  other.center.x = 0.1;
  EXPECT_EQ(refusal(case_of({box, other})), "") << "they touch";
  other.center.x = 0.1 - 1e-6;
  EXPECT_TRUE(mentions(refusal(case_of({box, other})),
                       "body.block and body.other overlap at the start near ("));
  BodyConfig within = regular_box({0.01, 0.01, 0.01}, 0.01);
  within.name = "within";
  within.center = {0.003, 0.004, 0.005};
  EXPECT_TRUE(mentions(refusal(case_of({box, within})), "body.block and body.within overlap"));
  // Corners of a box within a large tetrahedron of the other, and no corner the other way.
  BodyConfig pin = regular_box({0.002, 0.002, 0.3}, 0.3);
  pin.name = "pin";
  pin.center = {0.011, 0.007, 0.0};
  EXPECT_TRUE(mentions(refusal(case_of({box, pin})), "body.block and body.pin overlap"));
}

/// Two that share a corner, an edge or a face lie beside each other or in each other.
TEST(TetOverlap, TwoThatShareACornerMayOverlap) {
  const ScratchFolder scratch;
  const auto said = [&](const char* other) {
    replace_file(scratch / "two.inp",
                 std::string("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
                             "5, 0.6, 0.1, 0.1\n6, 0.1, 0.6, 0.1\n7, 0.1, 0.1, 0.6\n"
                             "8, -1, 0, 0\n9, 0, -1, 0\n10, 0, 0, -1\n"
                             "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n2, ") +
                     other + "\n");
    BodyConfig body;
    body.name = "both";
    body.material = "rock";
    body.shape = "mesh";
    body.file = "two.inp";
    return refusal(case_of({body}), scratch.path());
  };
  for (const char* beside : {"1, 8, 10, 9", "1, 2, 9, 10", "1, 3, 2, 10"})
    EXPECT_EQ(said(beside).find("overlap"), std::string::npos) << said(beside);
  for (const char* within : {"1, 5, 6, 7", "1, 2, 6, 7", "1, 2, 3, 7"})
    EXPECT_TRUE(mentions(said(within), "overlap")) << within;
}

TEST(TetOverlap, VerticesAtOnePlaceAreRefusedWithinABody) {
  const ScratchFolder scratch;
  replace_file(scratch / "two.inp",
               "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 0, 0, -1\n"
               "6, 0, 0, 0\n7, 1, 0, 0\n8, 0, 1, 0\n"
               "*ELEMENT, TYPE=C3D4, ELSET=upper\n1, 1, 2, 3, 4\n"
               "*ELEMENT, TYPE=C3D4, ELSET=lower\n2, 6, 8, 7, 5\n");
  BodyConfig body;
  body.name = "both";
  body.material = "rock";
  body.shape = "mesh";
  body.file = "two.inp";
  EXPECT_TRUE(mentions(refusal(case_of({body}), scratch.path()),
                       "body.both: two vertices lie at one place, (0, 0, 0) m"));
  body.name = "upper";
  body.parts = {"upper"};
  BodyConfig lower = body;
  lower.name = "lower";
  lower.parts = {"lower"};
  EXPECT_EQ(refusal(case_of({body, lower}), scratch.path()), "") << "two bodies that touch";
}

}  // namespace tet_overlap_test
}  // namespace breccia::fdem3
