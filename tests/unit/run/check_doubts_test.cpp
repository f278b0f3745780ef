// What `breccia check` and `run` doubt about a case that can be run, with line and key.

#include <gtest/gtest.h>

#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace check_doubts_test {

struct Told {
  int exit_code;
  std::string text;
};

class Doubts : public ::testing::Test {
 protected:
  Told told_by(const std::string& command, const std::string& text, const std::string& more = "") {
    replace_file(path_, text);
    const std::string output = folder_.path() + "/told.txt";
    const int code = wait_for(start_program(command + " " + path_ + more, output));
    std::string told = read_whole_file(output);
    for (std::size_t at = told.find("\n "); at != std::string::npos; at = told.find("\n ", at))
      told.erase(at, told.find_first_not_of(" \n", at) - at - 1), told[at] = ' ';  // folded lines
    return {code, told};
  }
  Told run(const std::string& text) {
    return told_by("run", text, " --steps 1 --force -o " + folder_.path() + "/out");
  }
  ScratchFolder folder_;
  std::string path_ = folder_.path() + "/case.toml";
};
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string rock = R"(breccia = 1
method = "fdem2d"
[time]
end = "1 ms"
[output]
frames = 0
[in_situ]
xx = "-5 MPa"
[material.stone]
young = "30 GPa"
[[body]]
name = "rock"
shape = "plate"
structured = true
material = "stone"
size = ["1 m", "1 m"]
mesh_size = "0.2 m"
[[support]]
name = "left"
max = ["-0.49 m", "1 m"]
)";

TEST_F(Doubts, tell_of_openings_that_nothing_can_have) {
  const std::string probe = "[[probe]]\nname = \"gap\"\nquantity = \"opening\"\n";
  std::string loose = rock + probe;
  loose.replace(loose.find("young"), 5, "joints = \"none\"\nyoung");
  const std::string doubt = "line 24, probe.gap.quantity = \"opening\" is of joints";
  EXPECT_TRUE(has(told_by("check", loose).text, doubt)) << told_by("check", loose).text;
  EXPECT_TRUE(has(run(loose).text, doubt));
  EXPECT_FALSE(has(told_by("check", rock + probe).text, "is of joints"));
}

TEST_F(Doubts, tell_what_bears_no_stress_in_situ) {
  const std::string sentence =
      "line 8, in_situ.xx: nothing bears the stress at the start, -5 MPa, on the side x = 500 mm "
      "of rock: it expands from the first step on";
  for (const Told& told : {told_by("check", rock), run(rock)}) {
    EXPECT_EQ(told.exit_code, 0) << told.text;
    EXPECT_TRUE(has(told.text, sentence)) << told.text;
  }
  const std::string held = rock + "[[support]]\nname = \"right\"\nmin = [\"0.49 m\", \"-1 m\"]\n";
  EXPECT_FALSE(has(told_by("check", held).text, "nothing bears"));
}

TEST_F(Doubts, tell_why_a_joint_is_too_weak_for_the_stress) {
  std::string pulled = rock;
  pulled.replace(pulled.find("-5 MPa"), 6, "20 MPa");
  const Told told = run(pulled);
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "line 7, in_situ: the joint between triangles ")) << told.text;
  EXPECT_TRUE(has(told.text, "it is pulled with ")) << told.text;
  EXPECT_TRUE(has(told.text, "tension is positive: rock under pressure has negative xx, yy"))
      << told.text;
}

const std::string packed = R"(breccia = 1
method = "dem3d"
[time]
end = "1 ms"
[output]
frames = 0
[material.c]
young = "30 GPa"
[[body]]
name = "block"
shape = "box"
material = "c"
size = ["0.1 m", "0.1 m", "0.1 m"]
pack = { count = 300 }
)";

TEST_F(Doubts, tell_of_what_passes_an_element_within_a_step) {
  const auto check = [&](const std::string& text) { return told_by("check", text).text; };
  EXPECT_FALSE(has(check(packed + "velocity = [0, 0, -30]\n"), "it goes"));
  const std::string fast = check(packed + "velocity = [0, 0, -30e3]\n");
  EXPECT_TRUE(has(fast, "line 15, body.block.velocity: with 30000 m/s it goes ")) << fast;
  EXPECT_TRUE(has(fast, " further than the radius of the smallest element, ")) << fast;
  const std::string led = rock + "[[stage]]\nname = \"a\"\n[[stage.support]]\nname = \"left\"\n";
  EXPECT_FALSE(has(check(led + "velocity = [10, 0]\n"), "it goes"));
  const std::string slow = check(led + "velocity = [[0, 0, 0], [1, 1e6, 0]]\n");
  EXPECT_TRUE(has(slow, "line 25, stage.a.support.left.velocity: with 1e+06 m/s it goes ")) << slow;
  EXPECT_TRUE(has(slow, " further than the edge of the smallest element, 200 mm: ")) << slow;
}

TEST_F(Doubts, tell_of_tools_that_begin_inside_of_a_body) {
  const std::string ball =
      "[[wall]]\nname = \"ball\"\nshape = \"sphere\"\nradius = \"1 mm\"\npoint = [";
  const Told inside = told_by("check", packed + ball + "\"11 mm\", 0.0, \"17 mm\"]\n");
  EXPECT_EQ(inside.exit_code, 0) << inside.text;
  EXPECT_TRUE(has(inside.text, "wall.ball.point: it begins inside of block")) << inside.text;
  EXPECT_TRUE(has(inside.text, "line ")) << inside.text;
  const Told outside = told_by("check", packed + ball + "0.0, 0.0, \"51 mm\"]\n");
  EXPECT_FALSE(has(outside.text, "begins inside")) << outside.text;
  const Told punch = told_by(
      "check", packed +
                   "[[wall]]\nname = \"punch\"\nshape = \"cylinder\"\nradius = \"1 mm\"\nlength = "
                   "\"10 mm\"\npoint = [0.0, 0.0, \"48 mm\"]\nnormal = [0.0, 0.0, -1.0]\n");
  EXPECT_FALSE(has(punch.text, "begins inside")) << punch.text;  // its middle is above
}

/// Plain check builds small models, and then tells what set-up doubts.
TEST_F(Doubts, of_set_up_are_told_by_a_plain_check_of_small_models) {
  const std::string floor = packed + "[[wall]]\nname = \"floor\"\npoint = [0.0, 0.0, \"-49 mm\"]\n";
  const Told told = told_by("check", floor);
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_TRUE(has(told.text, "wall.floor: at the start ")) << told.text;
  EXPECT_TRUE(has(told.text, "it begins without force")) << told.text;
}

TEST_F(Doubts, look_at_both_parts_of_a_case_of_both_methods) {
  const Told told = told_by("check", R"(breccia = 1
method = ["dem3d", "fdem3d"]
[time]
end = "1 ms"
[output]
frames = 0
[spheres.material.grain]
law = "grain"
[[spheres.body]]
name = "ball"
shape = "element"
material = "grain"
center = [0.0, 0.0, "20 mm"]
radius = "5 mm"
[[spheres.wall]]
name = "lid"
point = [0.0, 0.0, "1 m"]
normal = [0.0, 0.0, -1.0]
[tetrahedra.material.rock]
young = "30 GPa"
joints = "none"
[tetrahedra.in_situ]
zz = "-2 MPa"
[[tetrahedra.body]]
name = "block"
shape = "box"
material = "rock"
size = [0.1, 0.1, 0.02]
structured = true
mesh_size = "20 mm"
)");
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_TRUE(has(told.text, "spheres.wall.lid.point: no body touches the wall")) << told.text;
  EXPECT_TRUE(has(told.text, "tetrahedra.in_situ.zz: nothing bears")) << told.text;
}

/// Values that can be run and are hardly meant: by check and by run, with line and key.
TEST_F(Doubts, tell_of_values_that_are_hardly_meant) {
  const std::string slip = R"(breccia = 1
method = "fdem2d"
[time]
end = "1 ms"
[output]
frames = 0
[material.stone]
density = 2.6
[material.stone.joint]
tension = "60 MPa"
cohesion = "20 MPa"
[[body]]
name = "rock"
shape = "plate"
structured = true
material = "stone"
size = ["30 mm", "60 mm"]
mesh_size = "90 mm"
[[support]]
name = "foot"
max = ["1 m", "-29 mm"]
[[load]]
name = "top"
min = ["-1 m", "29 mm"]
pressure = "1 MPa"
ramp = "10 ms"
)";
  for (const Told& told : {told_by("check", slip), run(slip)}) {
    EXPECT_EQ(told.exit_code, 0) << told.text;
    EXPECT_TRUE(has(told.text,
                    "line 8, material.stone.density = 2.6 kg/m3 is lighter than any "
                    "rock or concrete; did you mean \"2.6 g/cm3\"?"))
        << told.text;
    EXPECT_TRUE(has(told.text, "line 10, material.stone.joint.tension = 60 MPa is never reached"))
        << told.text;
    EXPECT_TRUE(has(told.text,
                    "line 18, body.rock.mesh_size = 90 mm is longer than the shortest "
                    "side of rock, 30 mm"))
        << told.text;
    EXPECT_TRUE(has(told.text, "line 26, load.top.ramp = 10 ms: it counts for 1 ms at most"))
        << told.text;
  }
}

TEST_F(Doubts, tell_of_bodies_in_another_unit) {
  const std::string far =
      "[[body]]\nname = \"ball\"\nshape = \"element\"\nmaterial = \"c\"\nradius = \"5 "
      "mm\"\ncenter = [0.0, 0.0, 55.0]\n";
  for (const Told& told : {told_by("check", packed + far), run(packed + far)}) {
    EXPECT_EQ(told.exit_code, 0) << told.text;
    EXPECT_TRUE(has(told.text, "line 20, body.ball.center: it lies 54.95 m from block"))
        << told.text;
  }
}

TEST_F(Doubts, refuse_what_turns_inside_out) {
  std::string soft = rock +
                     "[[stage]]\nname = \"relax\"\nuntil = \"1 ms\"\n"
                     "[[stage.material]]\nname = \"stone\"\nyoung = \"1 MPa\"\n";
  soft.replace(soft.find("-5 MPa\""), 7, "-5 MPa\"\nyy = \"-5 MPa\"");
  for (const Told& told : {told_by("check", soft), run(soft)}) {
    EXPECT_EQ(told.exit_code, 2) << told.text;
    EXPECT_TRUE(has(told.text,
                    "line 27, stage.relax.material.stone.young = 1 MPa is too soft for "
                    "the pressure in situ that stone bears, 5 MPa"))
        << told.text;
  }
}

/// By how much joints soften a specimen, and what to give instead.
TEST_F(Doubts, tell_the_modulus_of_a_specimen) {
  const Told told = told_by("check --model", rock);
  EXPECT_TRUE(has(told.text, "stone with its joints: E 27.")) << told.text;
  EXPECT_TRUE(has(told.text,
                  " % softer than its young of 30 GPa: a specimen shows that; young = "
                  "\"32."))
      << told.text;
  EXPECT_TRUE(has(told.text, " GPa\" gives 30 GPa")) << told.text;
}

/// A material of the program shows its target: nothing is to be raised.
TEST_F(Doubts, hold_materials_of_the_program_against_their_target) {
  const std::string granite =
      "[[body]]\nname = \"b\"\nshape = \"plate\"\nmaterial = \"stone\"\n"
      "size = [\"50 mm\", \"100 mm\"]\nmesh_size = \"4 mm\"\n"
      "[material.stone]\nuse = \"granite-pikes-peak\"\n";
  const std::string head = "breccia = 1\n[time]\nend = \"1 us\"\n";
  const Told plane = told_by("check --model", "method = \"fdem2d\"\n" + head + granite);
  EXPECT_TRUE(has(plane.text, " % of 70.5 GPa, which granite-pikes-peak is to show: nothing to do"))
      << plane.text;
  EXPECT_FALSE(has(plane.text, "found with triangles")) << plane.text;
  std::string solid = granite;
  solid.replace(solid.find("plate"), 5, "box");
  solid.replace(solid.find("\"100 mm\""), 8, "\"100 mm\", \"50 mm\"");
  solid.replace(solid.find("4 mm"), 4, "25 mm");
  const Told space = told_by("check", "method = \"fdem3d\"\n" + head + solid);
  EXPECT_TRUE(has(space.text, "were found with triangles in plane stress")) << space.text;
}

/// A support between centres, and a packing of too few: with line, name and what is near.
TEST_F(Doubts, refuse_supports_that_hold_no_element) {
  const std::string thin = packed +
                           "[[support]]\nname = \"foot\"\non = \"block\"\nmax = [\"1 m\", \"1 m\", "
                           "\"-49.9 mm\"]\n";
  for (const Told& told : {told_by("check", thin), run(thin)}) {
    EXPECT_EQ(told.exit_code, 2) << told.text;
    EXPECT_TRUE(has(told.text, "line 15, support foot holds no element")) << told.text;
    EXPECT_TRUE(has(told.text, "; the nearest, at (")) << told.text;
    EXPECT_TRUE(has(told.text, " m away (radius 0.00")) << told.text;
  }
  std::string few = packed;
  few.replace(few.find("300"), 3, "7");
  few.replace(few.find("0.1 m"), 5, "0.4 m");
  const Told told = told_by("check", few);
  EXPECT_EQ(told.exit_code, 2) << told.text;
  EXPECT_TRUE(has(told.text, "line 14, body.block.pack.count: 7 elements are too few"))
      << told.text;
}

/// A ball in the middle of a block, on it, and tied to it.
TEST_F(Doubts, tell_of_spheres_that_begin_inside_of_tetrahedra) {
  const auto at = [&](const std::string& z, const std::string& more = "") {
    return told_by("check", R"(breccia = 1
method = ["dem3d", "fdem3d"]
[time]
end = "1 ms"
[output]
frames = 0
[spheres.material.grain]
law = "grain"
[[spheres.body]]
name = "ball"
shape = "element"
material = "grain"
center = [0.0, 0.0, ")" + z +
                                R"("]
radius = "5 mm"
[tetrahedra.material.rock]
young = "30 GPa"
joints = "none"
[[tetrahedra.body]]
name = "block"
shape = "box"
material = "rock"
size = [0.1, 0.1, 0.02]
structured = true
mesh_size = "20 mm"
)" + more);
  };
  const Told inside = at("2 mm");
  EXPECT_EQ(inside.exit_code, 0) << inside.text;
  EXPECT_TRUE(has(inside.text, "spheres.body.ball: it reaches 13 mm into the tetrahedra of block"))
      << inside.text;
  EXPECT_TRUE(has(inside.text, "line ")) << inside.text;
  EXPECT_FALSE(has(at("15 mm").text, "into the tetrahedra"));
  EXPECT_FALSE(has(at("14 mm",
                      "[[bond]]\nname = \"b\"\nspheres = \"ball\"\ntetrahedra = "
                      "\"block\"\n")
                       .text,
                   "into the tetrahedra"));
}

}  // namespace check_doubts_test
}  // namespace breccia
