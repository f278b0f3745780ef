// Mesh files: what is read, and what each wrong one is told.

#include "prepare/meshing/mesh_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "exec/error.hpp"
#include "fdem/world.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/meshing/meshing.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia::prepare {
namespace mesh_file_test {

using fdem::mentions;

/// Two triangles of a unit square, each a physical surface, and one physical line.
const std::string square = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 5 "bottom side"
2 1 "rock"
2 2 "vein"
$EndPhysicalNames
$Entities
0 1 2 0
1 0 0 0 1 0 0 1 5 0
1 0 0 0 1 1 0 1 1 0
2 0 0 0 1 1 0 1 2 0
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
3 3 1 3
1 1 1 1
1 1 2
2 1 2 1
2 1 2 3
2 2 2 1
3 1 3 4
$EndElements
)";

/// This mesh as an Abaqus file.
const std::string abaqus_square = R"(*HEADING
 a square
** comment
*Node
1, 0.0, 0.0
2, 1.0, 0.0, 0.0
3, 1., 1.
4, 0, 1E0
*ELEMENT, TYPE=CPS3, ELSET=rock
2, 1, 2, 3
*element, type=CPE3
3, 1, 3, 4
*ELEMENT, TYPE=T2D2, ELSET=base
7, 1, 2
*ELSET, ELSET=all, GENERATE
2, 3
*ELSET, ELSET=both
rock, 3
*NSET, NSET=right
2, 3
*MATERIAL, NAME=steel
*ELASTIC
210e9, 0.3
)";

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

std::string gmsh_refusal(const std::string& text) {
  try {
    parse_gmsh(text, "m.msh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}
std::string abaqus_refusal(const std::string& text) {
  try {
    parse_abaqus(text, "m.inp");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}

TEST(MeshFile, GmshTextIsRead) {
  const Mesh mesh = parse_gmsh(square, "m.msh");
  EXPECT_EQ(mesh.point.size(), 4U);
  EXPECT_EQ(mesh.triangle, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.parts.size(), 2U);
  EXPECT_EQ(mesh.parts[0].name, "rock");
  EXPECT_EQ(mesh.parts[1].name, "vein");
  EXPECT_EQ(mesh.parts[1].triangles, std::vector<Index>{1});
  ASSERT_EQ(mesh.edge_sets.size(), 1U);
  EXPECT_EQ(mesh.edge_sets[0].name, "bottom side");
  EXPECT_EQ(mesh.edge_sets[0].edges, (std::vector<Edge>{{0, 1}}));
}

TEST(MeshFile, AbaqusIsRead) {
  const Mesh mesh = parse_abaqus(abaqus_square, "m.inp");
  EXPECT_EQ(mesh.triangle, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.parts.size(), 3U);
  EXPECT_EQ(mesh.parts[0].name, "all");
  EXPECT_EQ(mesh.parts[1].name, "both");
  EXPECT_EQ(mesh.parts[1].triangles, (std::vector<Index>{0, 1}));
  EXPECT_EQ(mesh.parts[2].name, "rock");
  ASSERT_EQ(mesh.edge_sets.size(), 2U);
  EXPECT_EQ(mesh.edge_sets[0].name, "base");
  EXPECT_EQ(mesh.edge_sets[0].edges, (std::vector<Edge>{{0, 1}}));
  EXPECT_EQ(mesh.edge_sets[1].name, "right");
  EXPECT_EQ(mesh.edge_sets[1].edges, (std::vector<Edge>{{1, 2}}));
}

struct Wrong {
  const char *old, *replacement, *message;
};

class WrongGmsh : public testing::TestWithParam<Wrong> {};
TEST_P(WrongGmsh, IsToldWhatIsWrong) {
  const std::string message = gmsh_refusal(with(square, GetParam().old, GetParam().replacement));
  EXPECT_TRUE(mentions(message, GetParam().message)) << message;
  EXPECT_TRUE(message.starts_with("m.msh, line ") ||
              mentions(message, " in m.msh; nothing was run"))
      << message;
}
INSTANTIATE_TEST_SUITE_P(
    Table, WrongGmsh,
    testing::Values(
        Wrong{"4.1 0 8", "4.0 0 8", "line 2: the file has version 4.0; needed is 4.1"},
        Wrong{"4.1 0 8", "4.1 7 8", "mode 7 with words of 8 bytes cannot be read"},
        Wrong{"$MeshFormat\n", "solid cube\n", "stands where a section like $Nodes should begin"},
        Wrong{"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "", "does not begin with $MeshFormat"},
        Wrong{"1 1 0\n0 1 0", "1 1 0.5\n0 1 0",
              "line 25, node 3 has z = 0.5, node 1 has z = 0; a mesh must lie in one plane"},
        Wrong{"2 1 2 3\n", "2 1 3 2\n",
              "line 33, element 2 at (0.666667, 0.333333) m has clockwise corners"},
        Wrong{"2 1 2 3\n", "2 1 2 2\n", "line 33, element 2 has the same corner twice"},
        Wrong{"1 1 0\n0 1 0", "2 0 0\n0 1 0",
              "line 33, element 2 at (1, 0) m has no area: its corners lie on a line"},
        Wrong{"3 1 3 4\n", "3 3 1 2\n",
              "line 33, element 2 and line 35, element 3 are the same triangle"},
        Wrong{"3 1 3 4\n", "3 1 2 4\n",
              "lie on the same side of the edge from node 1 to node 2: they overlap"},
        Wrong{"3 1 3 4\n", "3 1 3 9\n", "line 35, element 3: there is no node 9"},
        Wrong{"3 1 3 4\n", "3 1 3 18446744073709551615\n", "is too large for a number of a node"},
        Wrong{"3 1 3 4\n", "3 1 3 99999999999999999999999\n", "in $Elements is too large"},
        Wrong{"3 1 3 4\n", "3 1 3 x\n", "line 35: \"x\" in $Elements is not a whole number"},
        Wrong{"1 4 1 4\n", "1 4000000000 1 4\n",
              "$Nodes says that there are 4000000000 nodes; the whole file has"},
        Wrong{"1 4 1 4\n", "1 5 1 4\n", "$Nodes holds 4 nodes, but says 5"},
        Wrong{"3 3 1 3\n", "3 4 1 3\n", "$Elements holds 3 elements, but says 4"},
        Wrong{"0 1 0\n$EndNodes", "0 nan 0\n$EndNodes",
              "node 4 has a coordinate that is no number"},
        Wrong{"1\n2\n3\n4\n", "1\n2\n3\n3\n", "line 26, node 3 is there twice"},
        Wrong{"2 2 2 1\n3 1 3 4\n", "2 2 3 1\n3 1 2 3 9\n", "element 3: there is no node 9"},
        Wrong{"2 2 2 1\n3 1 3 4\n", "3 2 4 1\n3 1 2 3 4\n", "element 3 is a tetrahedron"},
        Wrong{"2 2 2 1\n3 1 3 4\n", "2 2 9 1\n3 1 2 3 4 1 2\n",
              "a triangle of second order; a mesh may hold those of first order (gmsh -order 1)"},
        Wrong{"2 2 2 1\n3 1 3 4\n", "1 1 1 1\n3 1 3\n", "node 4 belongs to no triangle"},
        Wrong{"1 1 2\n2 1 2 1", "1 2 4\n2 1 2 1",
              "line 31, element 1 of the set \"bottom side\" is not an edge of a triangle"},
        Wrong{"2 1 \"rock\"", "2 1 rock", "a name between quotation marks is missing"},
        Wrong{"$EndNodes\n", "7\n$EndNodes\n", "\"7\" stands where $EndNodes should"}));

TEST(MeshFile, EdgeOfThreeTrianglesIsNamed) {
  std::string text = with(square, "1 4 1 4\n2 1 0 4\n", "1 5 1 5\n2 1 0 5\n");
  text = with(text, "3\n4\n0 0 0", "3\n4\n5\n0 0 0");
  text = with(text, "0 1 0\n$EndNodes", "0 1 0\n0.5 3 0\n$EndNodes");
  text = with(text, "3 3 1 3\n", "3 4 1 4\n");
  text = with(text, "2 2 2 1\n3 1 3 4\n", "2 2 2 2\n3 1 3 4\n4 1 3 5\n");
  EXPECT_TRUE(mentions(gmsh_refusal(text),
                       "the edge from node 1 to node 3 belongs to 3 triangles (line 35, element 2, "
                       "line 37, element 3, line 38, element 4); at most 2 can share one"))
      << gmsh_refusal(text);
}

TEST(MeshFile, TrianglesThatAreNotJoinedAreNamed) {
  std::string text = with(square, "1 4 1 4\n2 1 0 4\n", "1 5 1 5\n2 1 0 5\n");
  text = with(text, "3\n4\n0 0 0", "3\n4\n5\n0 0 0");
  text = with(text, "0 1 0\n$EndNodes", "0 1 0\n1 1 0\n$EndNodes");
  text = with(text, "3 1 3 4\n", "3 1 5 4\n");
  const std::string message = gmsh_refusal(text);
  EXPECT_TRUE(mentions(message,
                       "node 3 and node 5 lie at one place, (1, 1) m: triangles beside "
                       "them are not joined"))
      << message;
  EXPECT_TRUE(mentions(message, "line 37, element 3 shares no edge with any other")) << message;
  EXPECT_TRUE(mentions(message, "seams = \"open\"")) << message;
  EXPECT_EQ(parse_gmsh(text, "m.msh", true).triangle.size(), 2U);  // where it is meant
}

TEST(MeshFile, NoTriangleIsNamed) {
  std::string text = with(square, "3 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 1\n2 1 2 3\n2 2 2 1\n3 1 3 4\n",
                          "1 1 1 1\n1 1 1 1\n1 1 2\n");
  EXPECT_TRUE(mentions(gmsh_refusal(text), "there are no triangles"));
}

TEST(MeshFile, CutOffTextIsRefusedWhereverItIsCut) {
  for (std::size_t length = 0; length + 2 < square.size(); ++length) {
    const std::string message = gmsh_refusal(square.substr(0, length));
    EXPECT_NE(message, "no problem") << length;
  }
  const std::string message = gmsh_refusal(square.substr(0, square.find("3 1 3 4\n") + 4));
  EXPECT_TRUE(mentions(message, "line 35: the file ends within $Elements; it is cut off"))
      << message;
}

class WrongAbaqus : public testing::TestWithParam<Wrong> {};
TEST_P(WrongAbaqus, IsToldWhatIsWrong) {
  const std::string message =
      abaqus_refusal(with(abaqus_square, GetParam().old, GetParam().replacement));
  EXPECT_TRUE(mentions(message, GetParam().message)) << message;
}
INSTANTIATE_TEST_SUITE_P(
    Table, WrongAbaqus,
    testing::Values(
        Wrong{"3, 1, 3, 4\n", "3, 1, 4, 3\n",
              "line 12, element 3 at (0.333333, 0.666667) m has clockwise corners"},
        Wrong{"TYPE=CPS3", "TYPE=CPS8",
              "line 10: element 2 is of type CPS8; allowed are triangles (CPE3, CPS3,"},
        Wrong{"TYPE=CPS3", "TYPE=CPS4",
              "line 10: an element of type CPS4 is its number and 4 nodes; here are 4 words"},
        Wrong{"3, 1, 3, 4\n", "3, 1, 3\n",
              "line 12: an element of type CPE3 is its number and 3 nodes; here are 3 words"},
        Wrong{"3, 1, 3, 4\n", "3, 1, 3, 44\n", "line 12, element 3: there is no node 44"},
        Wrong{"3, 1, 3, 4\n", "2, 1, 3, 4\n", "line 12: element 2 is there twice"},
        Wrong{"3, 1., 1.\n", "3, 1., one\n", "line 7: \"one\" is not a number"},
        Wrong{"3, 1., 1.\n", "3, 1.\n", "line 7: a node is its number, x, y and perhaps z"},
        Wrong{"3, 1., 1.\n", "3, 1., 1., 2.\n", "node 3 has z = 2"},
        Wrong{"rock, 3\n", "stone, 3\n",
              "line 18: the set \"both\" names the set \"stone\", which is not there"},
        Wrong{"rock, 3\n", "rock, 30\n",
              "line 18: the element set \"both\" names element 30, which is not there"},
        Wrong{"NSET=right\n2, 3", "NSET=right\n2, 30",
              "the node set \"right\" names node 30, which is not there"},
        Wrong{"\n2, 3\n*ELSET", "\n2, 3000000000\n*ELSET", "makes no sense"},
        Wrong{", TYPE=CPS3", "", "line 9: *ELEMENT needs TYPE="},
        Wrong{", NSET=right", "", "line 19: *NSET needs a name"},
        Wrong{"*NSET", "*INCLUDE, INPUT=rest.inp\n*NSET", "line 19: *INCLUDE cannot be read"},
        Wrong{"*NSET", "*Elgen, elset=rock\n2, 5\n*NSET", "line 19: *ELGEN cannot be read"},
        Wrong{"*NSET", "*Instance, name=a, part=p\n1., 0., 0.\n*End Instance\n*NSET",
              "line 20: *INSTANCE moves its part; write the nodes in global coordinates"}));

TEST(MeshFile, AbaqusInstanceThatStaysInPlaceIsRead) {
  const std::string text = with(abaqus_square, "*NSET", "*Instance, name=a, part=p\n*NSET");
  EXPECT_EQ(parse_abaqus(text, "m.inp").triangle.size(), 2U);
}

TEST(MeshFile, AbaqusWithoutKeywordsIsRefused) {
  EXPECT_TRUE(mentions(abaqus_refusal("1, 2, 3\n"), "line 1: \"1, 2, 3\" stands before the first"));
  EXPECT_TRUE(mentions(abaqus_refusal(""), "m.inp: there is no line that begins with *"));
}

/// Four triangles around the middle, one after the other, in all sets that the quadrangle is in.
void expect_a_quadrangle(const Mesh& mesh, const std::string& part) {
  ASSERT_EQ(mesh.triangle.size(), 4U);
  ASSERT_EQ(mesh.point.size(), 5U);
  EXPECT_EQ(mesh.point[4].x, 0.5);
  EXPECT_EQ(mesh.point[4].y, 0.5);
  for (const Triangle& t : mesh.triangle) EXPECT_EQ(signed_area(mesh.point, t), 0.25);
  const std::vector<Edge> inner{{0, 4}, {1, 4}, {2, 4}, {3, 4}};
  EXPECT_EQ(mesh.inner, inner);
  const auto found = std::find_if(mesh.parts.begin(), mesh.parts.end(),
                                  [&](const Part& p) { return p.name == part; });
  ASSERT_NE(found, mesh.parts.end());
  EXPECT_EQ(found->triangles, (std::vector<Index>{0, 1, 2, 3}));
}

TEST(MeshFile, AQuadrangleBecomesFourTrianglesAroundItsMiddle) {
  const Mesh mesh =
      parse_gmsh(with(square, "3 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 1\n2 1 2 3\n2 2 2 1\n3 1 3 4\n",
                      "2 2 1 2\n1 1 1 1\n1 1 2\n2 1 3 1\n2 1 2 3 4\n"),
                 "m.msh");
  expect_a_quadrangle(mesh, "rock");
  ASSERT_EQ(mesh.edge_sets.size(), 1U);
  EXPECT_EQ(mesh.edge_sets[0].edges, (std::vector<Edge>{{0, 1}}));
  for (const char* type : {"CPS4", "CPE4R"})
    expect_a_quadrangle(
        parse_abaqus(std::string("*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=") +
                         type + ", ELSET=rock\n7, 1, 2, 3, 4\n",
                     "m.inp"),
        "rock");
}

TEST(MeshFile, OtherEndingsAreRefused) {
  try {
    read_mesh("mesh.vtk");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(mentions(error.what(), "allowed are .msh (Gmsh 4.1) and .inp (Abaqus)"));
  }
  EXPECT_THROW(read_mesh("/nowhere/mesh.msh"), IoError);
}

/// A folder that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "breccia_mesh_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name) << content;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// A square with a round inclusion, in the language of gmsh.
const std::string inclusion_geo = R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Disk(2) = {0.5, 0.5, 0, 0.2};
BooleanFragments{ Surface{1, 2}; Delete; }{}
Mesh.MeshSizeMax = 0.1;
Physical Surface("pebble") = {2};
Physical Surface("matrix") = {3};
left() = Curve In BoundingBox{-0.1, -0.1, -0.1, 0.1, 1.1, 0.1};
Physical Curve("left") = left();
)";

/// Two quadrangles side by side: the joint between them is the only one, whatever the material
/// says.
TEST(MeshFile, TrianglesOfAQuadrangleMoveAsOne) {
  const Folder folder;
  folder.write("two.inp",
               "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 0, 1\n5, 1, 1\n6, 2, 1\n"
               "*ELEMENT, TYPE=CPS4\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n");
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    fdem::Config config;
    config.materials.emplace_back().name = "rock";
    config.materials[0].joints = joints;
    fdem::BodyConfig& body = config.bodies.emplace_back();
    body.name = "two";
    body.shape = "mesh";
    body.material = "rock";
    body.file = "two.inp";
    const fdem::Model model = build_model(config, folder.path());
    EXPECT_EQ(model.triangle.size(), 8U);
    const fdem::World w = fdem::make_world(config, model, {});
    ASSERT_EQ(w.joints.size(), 1) << joints;
    EXPECT_NEAR(w.joints.length.data()[0], 1.0, 1e-15);
  }
}

TEST(MeshFile, BodiesFromOneGeoFileShareTheirVertices) {
  const Folder folder;
  folder.write("inclusion.geo", inclusion_geo);
  fdem::BodyConfig matrix;
  matrix.name = "matrix";
  matrix.shape = "geo";
  matrix.material = "rock";
  matrix.file = "inclusion.geo";
  matrix.parts = {"matrix"};
  fdem::BodyConfig pebble = matrix;
  pebble.name = "pebble";
  pebble.material = "quartz";
  pebble.parts = {"pebble"};
  const fdem::Model m = fdem::built({matrix, pebble}, {}, 1, folder.path());
  EXPECT_TRUE(fdem::is_sound(m));
  EXPECT_NEAR(fdem::area_of(m, 0), 1.0 - 0.1257, 0.005);
  EXPECT_NEAR(fdem::area_of(m, 1), 0.1257, 0.005);
  int between = 0;
  for (const MeshEdge& edge : edges_of(m.triangle))
    between += edge.triangles[1] >= 0 && m.group[static_cast<std::size_t>(edge.triangles[0])] !=
                                             m.group[static_cast<std::size_t>(edge.triangles[1])];
  EXPECT_GT(between, 8);
  ASSERT_EQ(m.edge_sets.size(), 1U);
  EXPECT_EQ(m.edge_sets[0].name, "left");
  double length = 0.0;
  for (const auto& edge : m.edge_sets[0].edges) {
    EXPECT_NEAR(at(m.point, edge[0]).x, 0.0, 1e-9);
    length += norm(at(m.point, edge[0]) - at(m.point, edge[1]));
  }
  EXPECT_NEAR(length, 1.0, 1e-9);

  pebble.parts = {"gravel"};
  EXPECT_TRUE(mentions(fdem::refusal({matrix, pebble}, {}, folder.path()),
                       "body.pebble: parts: inclusion.geo has no part \"gravel\"; it has: matrix, "
                       "pebble"));
  pebble.parts = {"matrix"};
  EXPECT_TRUE(mentions(fdem::refusal({matrix, pebble}, {}, folder.path()),
                       "parts of inclusion.geo are also those of body.matrix"));
}

TEST(MeshFile, BinaryAndTextOfGmshAreOneMesh) {
  const Folder folder;
  const std::string geo = folder.write("inclusion.geo", inclusion_geo);
  const std::string text = folder.path() + "/text.msh", binary = folder.path() + "/binary.msh";
  const std::string run = "gmsh -2 -format msh41 -v 1 " + geo;
  ASSERT_EQ(std::system((run + " -o " + text).c_str()), 0);
  ASSERT_EQ(std::system((run + " -bin -o " + binary).c_str()), 0);
  const Mesh a = read_mesh(text), b = read_mesh(binary);
  EXPECT_EQ(a.triangle, b.triangle);
  ASSERT_EQ(a.parts.size(), 2U);
  EXPECT_EQ(a.parts[1].triangles, b.parts[1].triangles);
  EXPECT_EQ(a.edge_sets.at(0).edges, b.edge_sets.at(0).edges);

  // A binary file that is cut off or changed anywhere is refused or read, never more.
  const std::string content = read_whole_file(binary);
  for (std::size_t k = 0; k + 16 < content.size(); k += 37) {
    EXPECT_NE(gmsh_refusal(content.substr(0, k)), "no problem") << k;
    std::string changed = content;
    changed[k] = static_cast<char>(changed[k] ^ 0x81);
    gmsh_refusal(changed);
  }
  std::string reversed = content;
  const std::size_t one = reversed.find("4.1 1 8\n") + 8;
  std::swap(reversed[one], reversed[one + 3]);
  EXPECT_TRUE(mentions(gmsh_refusal(reversed), "in the order of another kind of machine"));
}

std::string geo_refusal(const std::string& program, const std::string& path) {
  try {
    mesh_geo_file_with(program, path, 0.0, 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}

TEST(Meshing, MissingAndFailingGmshAreExplained) {
  const Folder folder;
  const std::string bad = folder.write("bad.geo", "Point(1) = {0, 0;\n");
  EXPECT_TRUE(mentions(geo_refusal("no_such_gmsh", bad),
                       "needs the program no_such_gmsh to make its mesh, and it is not installed; "
                       "install it (Debian and Ubuntu: apt install gmsh)"));
  const std::string message = geo_refusal("gmsh", bad);
  EXPECT_TRUE(mentions(message, "bad.geo: gmsh")) << message;
  EXPECT_TRUE(mentions(message, "syntax error")) << message;
  EXPECT_TRUE(mentions(geo_refusal("gmsh", folder.path() + "/none.geo"), "none.geo is no file"));
  EXPECT_TRUE(mentions(geo_refusal("gmsh", folder.write("nothing.geo", "\n")),
                       "made no mesh of it; does it draw a surface?"));
  const std::string empty = folder.write("empty.geo", "Point(1) = {0, 0, 0};\n");
  EXPECT_TRUE(mentions(geo_refusal("gmsh", empty), "there are no triangles"))
      << geo_refusal("gmsh", empty);
}

TEST(Meshing, OutlinesAreReadAndChecked) {
  const Folder folder;
  folder.write("good.csv", "x,y\n0,0\n2,0\n2,1\n1,0.5\n0,1\n0,0\n");
  folder.write("clockwise.csv", "0,0\n0,1\n1,0.5\n2,1\n2,0\n");
  folder.write("crossed.csv", "0,0\n1,1\n1,0\n0,1\n");
  folder.write("line.csv", "0,0\n1,1\n2,2\n");
  folder.write("two.csv", "0,0\n1,1\n");
  folder.write("words.csv", "0,0\n1,1\n1,b\n");
  fdem::BodyConfig body;
  body.name = "stone";
  body.shape = "outline";
  body.material = "rock";
  body.mesh_size = 0.1;
  body.file = "good.csv";
  EXPECT_NEAR(fdem::area_of(fdem::built({body}, {}, 1, folder.path()), 0), 1.5, 1e-9);
  body.file = "clockwise.csv";
  EXPECT_NEAR(fdem::area_of(fdem::built({body}, {}, 1, folder.path()), 0), 1.5, 1e-9);
  const auto refusal_of = [&](const std::string& file) {
    body.file = file;
    return fdem::refusal({body}, {}, folder.path());
  };
  EXPECT_TRUE(mentions(refusal_of("crossed.csv"), "crosses itself between corners 1 and 3"));
  EXPECT_TRUE(mentions(refusal_of("line.csv"), "encloses no area"));
  EXPECT_TRUE(mentions(refusal_of("two.csv"), "needs at least 3 corners; it has 2"));
  EXPECT_TRUE(mentions(refusal_of("words.csv"), "line 3: \"1,b\" is not x,y in metres"));
  EXPECT_TRUE(mentions(refusal_of("good.txt"), "needs file, the name of a .csv file"));
}

}  // namespace mesh_file_test
}  // namespace breccia::prepare
