// Which sides of a mesh of tetrahedra lie on each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "exec/error.hpp"
#include "fdem3/setup/mesh_faces.hpp"
#include "prepare/tetrahedra/kuhn_box.hpp"

namespace breccia {
namespace sides_across_test {

fdem3::Model box(double edge) {
  const prepare::TetMesh mesh = prepare::kuhn_box({}, {1.0, 2.0, 1.5}, edge);
  fdem3::Model model;
  model.point = mesh.point;
  model.tetrahedron = mesh.tetrahedron;
  return model;
}

TEST(SidesAcross, are_those_with_the_same_vertices) {
  const fdem3::Model model = box(0.5);
  const std::vector<Index> across = fdem3::sides_across(model, 1);
  ASSERT_EQ(across.size(), 4 * model.tetrahedron.size());
  for (Index s = 0; s < static_cast<Index>(across.size()); ++s) {
    Index other = -1;
    for (Index q = 0; q < static_cast<Index>(across.size()); ++q)
      if (q != s && fdem3::vertices_of(model, q) == fdem3::vertices_of(model, s)) other = q;
    EXPECT_EQ(across[at(s)], other) << s;
  }
  std::set<std::array<Index, 3>> seen;
  Index last = -1;
  fdem3::each_face(model, across, [&](const fdem3::MeshFace& f) {
    EXPECT_TRUE(seen.insert(f.corners).second);
    EXPECT_TRUE(std::is_sorted(f.corners.begin(), f.corners.end()));
    EXPECT_GT(f.a, last);
    EXPECT_TRUE(f.b < 0 || f.b > f.a);
    last = f.a;
  });
  EXPECT_EQ(2 * seen.size(),
            across.size() + static_cast<std::size_t>(std::count(across.begin(), across.end(), -1)));
}

TEST(SidesAcross, are_the_same_for_any_number_of_threads) {
  const fdem3::Model model = box(0.05);  // some portions of vertices
  EXPECT_EQ(fdem3::sides_across(model, 3), fdem3::sides_across(model, 1));
}

TEST(SidesAcross, of_a_face_of_three_tetrahedra_are_refused) {
  fdem3::Model model = box(0.5);
  model.tetrahedron.push_back(model.tetrahedron[0]);
  try {
    fdem3::sides_across(model, 2);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("share one face"), std::string::npos);
  }
}

}  // namespace sides_across_test
}  // namespace breccia
