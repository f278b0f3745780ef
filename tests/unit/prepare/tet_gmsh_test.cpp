// Meshes of tetrahedra by gmsh: volumes, counts, bits; its older file format.

#include "prepare/tetrahedra/tet_gmsh.hpp"

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/meshing/run_gmsh.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::fdem3 {
namespace tet_gmsh_test {

BodyConfig free_body(const std::string& shape, double edge) {
  BodyConfig body = regular_box({}, edge);
  body.shape = shape;
  body.structured = false;
  body.center = {1.0, 2.0, -3.0};
  return body;
}

std::pair<Vec3, Vec3> box_around(const Model& m) {
  Vec3 low = m.point[0], high = low;
  for (const Vec3& p : m.point) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {low, high};
}

void expect_box(const Model& m, const Vec3& center, const Vec3& size, double tolerance) {
  const auto [low, high] = box_around(m);
  EXPECT_NEAR(norm(0.5 * (low + high) - center), 0.0, tolerance);
  EXPECT_NEAR(norm(high - low - size), 0.0, tolerance);
}

TEST(TetGmsh, BoxesAreFilledExactly) {
  BodyConfig box = free_body("box", 0.01);
  box.size = {0.08, 0.06, 0.05};
  const Model m = built({box});
  EXPECT_TRUE(is_sound(m));
  EXPECT_NEAR(volume_of(m), 0.08 * 0.06 * 0.05, 1e-15);
  expect_box(m, box.center, box.size, 1e-12);
  // Five to six tetrahedra in a cube of the edge, as the limit of mesh_size expects.
  EXPECT_NEAR(m.size() * 1e-6 / volume_of(m), 5.5, 1.0);
}

TEST(TetGmsh, SpheresAndCylindersAreInscribed) {
  BodyConfig ball = free_body("sphere", 0.01);
  ball.radius = 0.05;
  const Model sphere = built({ball});
  EXPECT_TRUE(is_sound(sphere));
  for (const Vec3& p : sphere.point) EXPECT_LE(norm(p - ball.center), 0.05 + 1e-12);
  // A triangle of circumradius e / sqrt 3 is at most that squared / 2 r below the sphere: of the
  // volume 1.5 (e / r)^2 / 3, with e = 1.3 mesh_size.
  const double whole = 4.0 / 3.0 * pi * 0.05 * 0.05 * 0.05;
  EXPECT_LT(volume_of(sphere), whole);
  EXPECT_GT(volume_of(sphere), (1.0 - 0.5 * 0.26 * 0.26) * whole);

  BodyConfig rod = free_body("cylinder", 0.01);
  rod.radius = 0.02;
  rod.height = 0.1;
  for (const char* axis : {"x", "y", "z"}) {
    rod.axis = axis;
    const Model cylinder = built({rod});
    EXPECT_TRUE(is_sound(cylinder));
    const double along = 0.1, across = 0.04;
    const Vec3 size = rod.axis == "x"   ? Vec3{along, across, across}
                      : rod.axis == "y" ? Vec3{across, along, across}
                                        : Vec3{across, across, along};
    expect_box(cylinder, rod.center, size, 0.001);  // across, the polygon is smaller
    const double full = pi * 0.02 * 0.02 * 0.1;
    EXPECT_LT(volume_of(cylinder), full);
    EXPECT_GT(volume_of(cylinder), 0.93 * full);  // 12 corners: 6 sin 60 deg / pi = 0.955
  }
}

TEST(TetGmsh, AMeshIsAFunctionOfTheCase) {
  BodyConfig box = free_body("box", 0.02);
  box.size = {0.1, 0.1, 0.1};
  const Model one = built({box}), two = built({box});
  ASSERT_EQ(one.tetrahedron, two.tetrahedron);
  for (std::size_t i = 0; i < one.point.size(); ++i)
    ASSERT_EQ(norm(one.point[i] - two.point[i]), 0.0);
}

/// A closed surface as text.
std::string stl_of(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::string text = "solid test\n";
  for (const auto& t : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& p : t)
      text += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
              std::to_string(p.z) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

/// An upright wedge: a triangle of legs 0.06 and 0.04, 0.05 high.
std::vector<std::array<Vec3, 3>> wedge(const Vec3& at) {
  const Vec3 a = at, b = at + Vec3{0.06, 0.0, 0.0}, c = at + Vec3{0.0, 0.04, 0.0};
  const Vec3 up{0.0, 0.0, 0.05}, d = a + up, e = b + up, f = c + up;
  return {{a, c, b}, {d, e, f}, {a, b, e}, {a, e, d}, {b, c, f}, {b, f, e}, {c, a, d}, {c, d, f}};
}

TEST(TetGmsh, FillsAClosedSurface) {
  const ScratchFolder scratch;
  replace_file(scratch / "wedge.stl", stl_of(wedge({})));
  BodyConfig body = free_body("stl", 0.01);
  body.file = "wedge.stl";
  const Model m = built({body}, 1, scratch.path());
  EXPECT_TRUE(is_sound(m));
  EXPECT_NEAR(volume_of(m), 0.5 * 0.06 * 0.04 * 0.05, 1e-12);
  expect_box(m, body.center + Vec3{0.03, 0.02, 0.025}, {0.06, 0.04, 0.05}, 1e-9);
  EXPECT_GT(m.size(), 200);

  auto open = wedge({});
  open.pop_back();
  replace_file(scratch / "wedge.stl", stl_of(open));
  EXPECT_TRUE(mentions(refusal(case_of({body}), scratch.path()),
                       "the surface is not closed: 3 edges are not shared"));
  auto pair = wedge({});
  for (const auto& triangle : wedge({1.0, 0.0, 0.0})) pair.push_back(triangle);
  replace_file(scratch / "wedge.stl", stl_of(pair));
  const std::string text = refusal(case_of({body}), scratch.path());
  EXPECT_TRUE(mentions(text, "body.block: ")) << text;
  EXPECT_TRUE(mentions(text, "wedge.stl")) << text;
}

TEST(TetGmsh, SaysThatItIsNotThere) {
  const std::string text = refusal_of([] {
    const prepare::TemporaryFolder folder;
    prepare::run_gmsh({.geo = "none.geo", .what = "this shape", .program = "no_such_gmsh"}, folder);
  });
  EXPECT_TRUE(mentions(text, "this shape needs the program no_such_gmsh")) << text;
}

TEST(GmshFile, of_version_2_2_gives_the_mesh_of_version_4_1) {
  const std::string legacy = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "base"
2 9 "vein"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
3
1 1 2 7 1 1 2
2 2 2 9 1 1 2 3
3 2 2 0 1 1 3 4
$EndElements
)";
  const prepare::Mesh mesh = prepare::parse_gmsh(legacy, "old.msh");
  ASSERT_EQ(mesh.triangle.size(), 2U);
  EXPECT_EQ(mesh.point.size(), 4U);
  ASSERT_EQ(mesh.parts.size(), 1U);
  EXPECT_EQ(mesh.parts[0].name, "vein");
  EXPECT_EQ(mesh.parts[0].triangles.size(), 1U);
  ASSERT_EQ(mesh.edge_sets.size(), 1U);
  EXPECT_EQ(mesh.edge_sets[0].name, "base");
  std::string binary = legacy;
  binary.replace(binary.find("2.2 0 8"), 7, "2.2 1 8");
  EXPECT_THROW(prepare::parse_gmsh(binary, "old.msh"), InputError);
}

}  // namespace tet_gmsh_test
}  // namespace breccia::fdem3
