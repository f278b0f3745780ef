// Meshes of tetrahedra from files: formats, names, and what is refused.

#include "prepare/tetrahedra/tet_file.hpp"

#include <gtest/gtest.h>

#include "io/whole_file.hpp"
#include "prepare/checks/check_case.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::fdem3 {
namespace tet_file_test {

using prepare::TetMesh;

/// Two tetrahedra below and above the triangle 1 2 3; node 9 belongs to neither.
std::string two_in_41(const std::string& tetrahedra = "1 1 2 3 4\n2 1 3 2 5\n") {
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
         "$PhysicalNames\n3\n2 7 \"base\"\n3 8 \"upper\"\n3 9 \"both\"\n$EndPhysicalNames\n"
         "$Entities\n0 0 1 2\n"
         "5 0 0 0 1 1 0 1 7 0\n"
         "1 0 0 0 1 1 1 2 8 9 0\n2 0 0 -1 1 1 0 1 9 0\n$EndEntities\n"
         "$Nodes\n1 6 1 9\n3 1 0 6\n1\n2\n3\n4\n5\n9\n"
         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -1\n7 7 7\n$EndNodes\n"
         "$Elements\n3 3 1 3\n2 5 2 1\n3 1 2 3\n3 1 4 1\n" +
         tetrahedra.substr(0, tetrahedra.find('\n') + 1) + "3 2 4 1\n" +
         tetrahedra.substr(tetrahedra.find('\n') + 1) + "$EndElements\n";
}

std::string two_in_22() {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
         "$PhysicalNames\n2\n2 7 \"base\"\n3 8 \"upper\"\n$EndPhysicalNames\n"
         "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n9 7 7 7\n$EndNodes\n"
         "$Elements\n4\n1 15 2 0 1 9\n2 2 2 7 1 1 2 3\n3 4 2 8 1 1 2 3 4\n4 4 2 0 1 1 3 2 5\n"
         "$EndElements\n";
}

std::string two_in_inp(const std::string& last = "12, 1, 3, 2, 5\n") {
  return "*HEADING\nof a test\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
         "5, 0, 0, -1\n9, 7, 7, 7\n"
         "*ELEMENT, TYPE=T3D2, ELSET=wire\n1, 1, 2\n"
         "*ELEMENT, TYPE=CPS3, ELSET=base\n2, 3, 1, 2\n"
         "*ELEMENT, TYPE=C3D4, ELSET=upper\n11, 1, 2, 3, 4\n"
         "*ELEMENT, TYPE=C3D4, ELSET=lower\n" +
         last + "*ELSET, ELSET=both\nupper, lower\n*NSET, NSET=left\n1, 3, 4\n";
}

void expect_two(const TetMesh& mesh, const std::string& format) {
  ASSERT_EQ(mesh.tetrahedron.size(), 2U) << format;
  EXPECT_EQ(mesh.point.size(), 5U) << format << ": node 9 is dropped";
  for (const auto& t : mesh.tetrahedron)
    EXPECT_NEAR(prepare::signed_volume(mesh.point, t), 1.0 / 6.0, 1e-15) << format;
  EXPECT_GT(prepare::centroid(mesh.point, mesh.tetrahedron[0]).z, 0.0) << format;
}

TEST(TetFile, ReadsEachFormat) {
  const TetMesh new_one = prepare::parse_tet_gmsh(two_in_41(), "a.msh"),
                old_one = prepare::parse_tet_gmsh(two_in_22(), "a.msh"),
                abaqus = prepare::parse_tet_abaqus(two_in_inp(), "a.inp");
  expect_two(new_one, "4.1");
  expect_two(old_one, "2.2");
  expect_two(abaqus, "inp");
  const auto names = [](const TetMesh& mesh) {
    std::string text;
    for (const prepare::Volume& v : mesh.volumes)
      text += v.name + std::to_string(v.tetrahedra.size());
    for (const prepare::FaceSet& s : mesh.face_sets)
      text += s.name + std::to_string(s.faces.size());
    return text;
  };
  EXPECT_EQ(names(new_one), "both2upper1base1");
  EXPECT_EQ(names(old_one), "upper1base1");
  EXPECT_EQ(names(abaqus), "both2lower1upper1base1left1");
  for (const TetMesh& mesh : {new_one, old_one, abaqus})
    EXPECT_EQ(mesh.face_sets[0].faces[0], (prepare::Face{0, 1, 2}));
  EXPECT_EQ(abaqus.face_sets[1].faces[0], (prepare::Face{0, 2, 3}));
}

TEST(TetFile, TurnsAFileThatIsTurnedAsAWhole) {
  expect_two(prepare::parse_tet_gmsh(two_in_41("1 2 1 3 4\n2 3 1 2 5\n"), "a.msh"), "turned");
  const std::string text =
      refusal_of([] { prepare::parse_tet_gmsh(two_in_41("1 2 1 3 4\n2 1 3 2 5\n"), "a.msh"); });
  EXPECT_TRUE(mentions(text, "2 problems in a.msh; nothing was run.")) << text;
  EXPECT_TRUE(mentions(text, "line 37, element 1 at (0.25, 0.25, 0.25) m is turned inside out"))
      << text;
}

TEST(TetFile, RefusesWithFileLineAndElement) {
  const auto of_gmsh = [](const std::string& tetrahedra) {
    return refusal_of([&] { prepare::parse_tet_gmsh(two_in_41(tetrahedra), "a.msh"); });
  };
  const auto of_abaqus = [](const std::string& last) {
    return refusal_of([&] { prepare::parse_tet_abaqus(two_in_inp(last), "a.inp"); });
  };
  const std::pair<std::string, const char*> refusals[] = {
      {of_gmsh("1 1 2 3 4\n2 1 2 3 8\n"), "line 39, element 2: there is no node 8"},
      {of_gmsh("1 1 2 3 4\n2 1 2 3 4\n"), "element 2 are the same tetrahedron"},
      {of_gmsh("1 1 2 3 4\n2 1 2 3 9\n"), "lie on the same side of the face of node 1, node 2"},
      {of_gmsh("1 1 2 3 4\n2 1 2 3 3\n"), "element 2 has the same corner twice"},
      {of_abaqus("12, 1, 3, 2, 5\n13, 1, 2, 3, 9\n"),
       "belongs to 3 tetrahedra (line 15, element 11, line 17, element 12, line 18, element 13)"},
      {of_abaqus("12, 1, 3, 2\n"), "an element of type C3D4 is its number and 4 nodes; here are 4"},
      {of_abaqus("12, 1, 3, 2, 5\n*ELEMENT, TYPE=C3D8\n13, 1, 2, 3, 4, 5, 6, 7, 8\n"),
       "line 19: element 13 is of type C3D8; allowed are tetrahedra (C3D4) and, as names of faces, "
       "triangles (CPE3, CPS3,"},
      {of_abaqus("12, 1, 3, 2, 5\n*ELEMENT, TYPE=S3, ELSET=odd\n13, 1, 4, 5\n"),
       "line 19, element 13 of the set \"odd\" is not a face of a tetrahedron"},
  };
  for (const auto& [text, words] : refusals) EXPECT_TRUE(mentions(text, words)) << words << text;
  std::string flat = two_in_41();
  flat.replace(flat.find("0 0 1\n0 0 -1"), 5, "3 4 0");
  const std::string text = refusal_of([&] { prepare::parse_tet_gmsh(flat, "a.msh"); });
  EXPECT_TRUE(mentions(text, "has no volume: its corners lie in a plane")) << text;
  std::string brick = two_in_22();
  brick.replace(brick.find("4 4 2 0"), 7, "4 5 2 0");
  EXPECT_TRUE(mentions(refusal_of([&] { prepare::parse_tet_gmsh(brick, "a.msh"); }),
                       "line 23: element 4 is a hexahedron; a mesh may hold tetrahedra, and "
                       "triangles that name faces (leave out Recombine)"));
}

TEST(TetFile, BodiesOfOneFileShareVertices) {
  const ScratchFolder scratch;
  replace_file(scratch / "two.msh", two_in_41());
  BodyConfig upper;
  upper.name = "upper";
  upper.material = "rock";
  upper.shape = "mesh";
  upper.file = "two.msh";
  upper.center = {0.0, 0.0, 10.0};
  upper.parts = {"upper"};
  const Model alone = built({upper}, 1, scratch.path());
  EXPECT_EQ(alone.size(), 1);
  EXPECT_EQ(alone.point.size(), 4U);
  ASSERT_EQ(alone.face_sets.size(), 1U);
  EXPECT_EQ(alone.face_sets[0].name, "base");
  for (const Index v : alone.face_sets[0].faces.at(0))
    EXPECT_EQ(alone.point[static_cast<std::size_t>(v)].z, 10.0);

  BodyConfig rest = upper;
  rest.name = "rest";
  rest.parts = {"both"};
  Config config = case_of({upper, rest});
  EXPECT_TRUE(mentions(refusal(config, scratch.path()),
                       "body.rest: parts of two.msh are also those of body.upper"));
  rest.parts = {"lower"};
  config = case_of({upper, rest});
  EXPECT_TRUE(mentions(refusal(config, scratch.path()),
                       "parts: two.msh has no part \"lower\"; it has: both, upper"));
  EXPECT_TRUE(mentions(refusal_of([&] { prepare::check_files(config, scratch.path()); }),
                       "has no part \"lower\""));
  replace_file(scratch / "two.inp", two_in_inp());
  upper.file = rest.file = "two.inp";
  const Model both = built({upper, rest}, 1, scratch.path());
  EXPECT_EQ(both.size(), 2);
  EXPECT_EQ(both.point.size(), 5U);
  config.bodies[1].file = "none.msh";
  EXPECT_THROW(prepare::check_files(config, scratch.path()), IoError);
}

}  // namespace tet_file_test
}  // namespace breccia::fdem3
