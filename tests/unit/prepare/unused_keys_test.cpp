// Keys that would be read and do nothing are refused, alike by all methods.

#include <gtest/gtest.h>

#include <string>

#include "exec/error.hpp"
#include "run/case.hpp"

namespace breccia {
namespace unused_keys_test {

const std::string head = "breccia = 1\n[time]\nend = \"1 ms\"\n[material.c]\n";
const std::string triangles =
    "method = \"fdem2d\"\n" + head +
    "joints = \"none\"\n[[body]]\nname = \"b\"\nshape = \"plate\"\nmaterial = \"c\"\n"
    "size = [0.1, 0.1]\nmesh_size = 0.02\nstructured = true\n";
const std::string tetrahedra =
    "method = \"fdem3d\"\n" + head +
    "joints = \"none\"\n[[body]]\nname = \"b\"\nshape = \"box\"\nmaterial = \"c\"\n"
    "size = [0.1, 0.1, 0.1]\nmesh_size = 0.02\nstructured = true\n";
const std::string spheres =
    "method = \"dem3d\"\n" + head +
    "[[body]]\nname = \"b\"\nshape = \"box\"\nmaterial = \"c\"\nsize = [0.1, 0.1, 0.1]\n"
    "pack = { count = 100, compactness = 0.56 }\n";

/// What is said of a case; empty: it is good.
std::string said(const std::string& text) {
  try {
    case_of_text(text, "case.toml", ".", {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
testing::AssertionResult says(const std::string& text, const std::string& part) {
  const std::string all = said(text);
  if (all.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << all << "\" does not hold \"" << part << "\"";
}

/// A vector in the plane or in space whose parts are 0 but for one.
std::string vector_of(bool plane, int axis, const std::string& value) {
  std::string text = "[";
  for (int k = 0; k < (plane ? 2 : 3); ++k)
    text += (k > 0 ? ", " : "") + (k == axis ? value : std::string("0.0"));
  return text + "]";
}
const std::string stages = "[[stage]]\nname = \"a\"\nuntil = \"0.1 ms\"\n[[stage]]\nname = \"z\"\n";

TEST(UnusedKeys, refuses_sizes_of_loads_of_another_kind) {
  for (const bool plane : {true, false}) {
    const std::string load = (plane ? triangles : tetrahedra) + "[[load]]\nname = \"q\"\n" +
                             "min = " + vector_of(plane, 1, "0.049").replace(1, 3, "-inf") + "\n";
    const std::string force = "force = " + vector_of(plane, 0, "1e3") + "\n";
    const std::string traction = "traction = " + vector_of(plane, 0, "1e3") + "\n";
    const std::string pressure = "pressure = [[0, 1e3], [1, 2e3]]\n";
    EXPECT_TRUE(says(load + force,
                     "load.q.force has no use: the load is of kind \"pressure\"; kind = \"force\" "
                     "takes it"));
    EXPECT_TRUE(says(load + traction, "load.q.traction has no use"));
    EXPECT_TRUE(says(load + "kind = \"traction\"\n" + pressure,
                     "load.q.pressure has no use: the load is of kind \"traction\""));
    EXPECT_TRUE(says(load + "kind = \"absorbing\"\n" + force, "load.q.force has no use"));
    EXPECT_EQ(said(load + "kind = \"force\"\n" + force), "");
    EXPECT_EQ(said(load + "kind = \"fluid\"\n" + pressure), "");
    const std::string change = load + stages + "[[stage.load]]\nname = \"q\"\n";
    EXPECT_TRUE(
        says(change + force, "stage.z.load.q.force has no use: the load is of kind \"pressure\""));
    EXPECT_EQ(said(change + pressure), "");
  }
}

TEST(UnusedKeys, refuses_velocities_of_supports_along_what_they_do_not_fix) {
  for (const std::string* text : {&spheres, &triangles, &tetrahedra}) {
    const bool plane = text == &triangles;
    const std::string support = *text + "[[support]]\nname = \"press\"\non = \"b\"\n";
    const std::string up = "velocity = " + vector_of(plane, 1, "0.1") + "\n";
    const std::string row = vector_of(plane, 1, "0.1").substr(1);
    EXPECT_TRUE(says(support + "fix = [\"x\"]\n" + up,
                     "support.press.velocity leads along y, which fix = [\"x\"] leaves free; fix "
                     "must hold \"y\", or the velocity along it be 0"));
    EXPECT_TRUE(says(support + "fix = []\n" + up, "support.press.velocity leads along y"));
    EXPECT_TRUE(says(support + "fix = [\"x\"]\nvelocity = [[0, " + row + ", [1, " + row + "]\n",
                     "support.press.velocity leads along y"));
    EXPECT_EQ(said(support + "fix = [\"y\"]\n" + up), "");
    EXPECT_EQ(said(support + up), "");
    const std::string change =
        support + "fix = [\"y\"]\n" + up + stages + "[[stage.support]]\nname = \"press\"\n";
    EXPECT_TRUE(says(change + "fix = [\"x\"]\n" + up,
                     "stage.z.support.press.velocity leads along y, which fix = [\"x\"]"));
    EXPECT_EQ(said(change + up), "");
    EXPECT_EQ(said(change + "fix = []\n"), "");
    // Told once, not for each stage in which it lasts.
    const std::string lasts = said(support + "fix = [\"x\"]\n" + up + stages);
    EXPECT_EQ(lasts.find("velocity leads"), lasts.rfind("velocity leads")) << lasts;
  }
  EXPECT_EQ(said(spheres + "[[support]]\nname = \"all\"\nfix = [\"all\"]\nvelocity = [1, 2, 3]\n"),
            "");
}

TEST(UnusedKeys, refuses_ramps_that_lead_nothing) {
  for (const std::string* text : {&spheres, &triangles, &tetrahedra}) {
    const bool plane = text == &triangles;
    const std::string support = *text + "[[support]]\nname = \"press\"\non = \"b\"\n";
    const std::string up = "velocity = " + vector_of(plane, 1, "0.1") + "\n";
    EXPECT_TRUE(says(support + "ramp = \"2 ms\"\n", "support.press.ramp leads nothing"));
    EXPECT_EQ(said(support + up + "ramp = \"0.2 ms\"\n"), "");
    const std::string change =
        support + up + stages + "[[stage.support]]\nname = \"press\"\nramp = \"0.1 ms\"\n";
    EXPECT_TRUE(says(change, "stage.z.support.press.ramp leads nothing"));
    EXPECT_EQ(said(change + up), "");
  }
  EXPECT_EQ(said(spheres + "[[support]]\nname = \"load\"\non = \"b\"\nfix = []\n"
                           "force = [0, 0, 1]\nramp = \"0.1 ms\"\n"),
            "");
  EXPECT_EQ(said(triangles + "[[support]]\nname = \"turned\"\non = \"b\"\nspin = 10\n"
                             "ramp = \"0.1 ms\"\n"),
            "");
  EXPECT_EQ(said(triangles + "[[support]]\nname = \"free\"\non = \"b\"\nfree = [\"x\"]\n"
                             "force = [1e3, 0]\nramp = \"0.1 ms\"\n"),
            "");
  EXPECT_TRUE(says(triangles + "[[support]]\nname = \"press\"\non = \"b\"\ntimes = [0, 1]\n"
                               "factors = [1, 2]\n",
                   "support.press.times leads nothing"));
}

TEST(UnusedKeys, refuses_keys_of_bodies_of_another_shape) {
  const auto with = [](const std::string& text, const std::string& key) {
    return text + key + "\n";
  };
  EXPECT_TRUE(says(with(triangles, "radius = 3.0"),
                   "body.b.radius is of discs, rings and parts; shape is plate"));
  EXPECT_TRUE(says(with(triangles, "inner_radius = 3.0"),
                   "body.b.inner_radius is of rings; shape is plate"));
  EXPECT_TRUE(says(with(triangles, "corners = [[0, 0], [1, 0], [1, 1]]"),
                   "body.b.corners is of parts; shape is plate"));
  EXPECT_TRUE(says(with(triangles, "of = \"b\""), "body.b.of is of parts; shape is plate"));
  EXPECT_TRUE(says(with(triangles, "hexagons = { count = 3, side = 0.1 }"),
                   "body.b.hexagons is of hexagons; shape is plate"));
  EXPECT_TRUE(says(with(spheres, "radius = 1.0"),
                   "body.b.radius is of spheres, cylinders and elements; shape is box"));
  EXPECT_TRUE(says(with(spheres, "length = 1.0"), "body.b.length is of cylinders; shape is box"));
  EXPECT_TRUE(says(with(spheres, "file = \"nofile.stl\""),
                   "body.b.file is of STL surfaces and files; shape is box"));
  EXPECT_TRUE(
      says(with(spheres, "file_unit = \"1 mm\""), "body.b.file_unit is of STL surfaces; shape"));
  EXPECT_TRUE(says(with(spheres, "volume = 1.0"), "body.b.volume is of files; shape is box"));
  std::string ball = spheres;
  ball.replace(ball.find("\"box\""), 5, "\"sphere\"\nradius = 0.05");
  EXPECT_TRUE(says(ball, "body.b.size is of boxes and files; shape is sphere"));
  EXPECT_TRUE(says(with(tetrahedra, "radius = 1.0"),
                   "body.b.radius is of cylinders, spheres and parts; shape is box"));
  EXPECT_TRUE(says(with(tetrahedra, "height = 1.0"),
                   "body.b.height is of cylinders and parts; shape is box"));
  EXPECT_TRUE(says(with(spheres, "[[body.cut]]\nsize = [0.1, 0.1, 0.1]\nradius = 0.1"),
                   "body.b.cut[0].radius is of spheres and cylinders; shape is box"));
}

TEST(UnusedKeys, a_step_that_never_ends_names_its_key) {
  for (const std::string* text : {&spheres, &triangles, &tetrahedra}) {
    std::string endless = *text;
    endless.insert(endless.find("[material"), "max_step = \"1e-30 s\"\n");
    EXPECT_TRUE(
        says(endless, "time.max_step = 1e-30 s: time.end = 0.001 s is more than 1e15 steps away"));
  }
}

TEST(UnusedKeys, a_direction_that_a_plane_lacks_is_told_as_it_was_asked) {
  const std::string probe = triangles + "[[probe]]\nname = \"f\"\nquantity = ";
  EXPECT_TRUE(says(probe + "\"force_z\"\n",
                   "probe.f.quantity = \"force_z\" has a z, which a plane case lacks; allowed: "));
  EXPECT_TRUE(says(triangles + "[[probe]]\nname = \"f\"\n",
                   "probe.f.quantity = \"velocity_z\" (taken if none is given) has a z"));
}

TEST(UnusedKeys, a_forgotten_prefix_of_a_modulus_is_outside_its_range) {
  for (const std::string* text : {&spheres, &triangles, &tetrahedra}) {
    std::string soft = *text;
    soft.replace(soft.find("[material.c]\n"), 13, "[material.c]\nyoung = 26\n");
    EXPECT_TRUE(says(soft, "material.c.young = 26 is outside [1000, "));
  }
}

TEST(UnusedKeys, forces_of_plane_cases_are_per_metre_of_thickness) {
  const std::string support = triangles + "[[support]]\nname = \"s\"\non = \"b\"\n";
  const auto servo = [&](const std::string& force) {
    return support + "servo = { axis = \"y\", speed = 1, force = " + force + " }\n";
  };
  EXPECT_EQ(said(servo("\"-1 kN/m\"")), "");
  EXPECT_EQ(said(servo("\"-1 kN\"")), "");
  EXPECT_EQ(said(servo("[[0, 0], [\"1 ms\", \"-1 kN/m\"]]")), "");
  EXPECT_TRUE(says(servo("\"1 MPa\""), "\"1 MPa\" is a pressure, a force per length is wanted"));
  const std::string free = support + "free = [\"x\", \"y\", \"turn\"]\n";
  EXPECT_EQ(said(free + "torque = \"10 N m/m\"\n"), "");
  EXPECT_EQ(said(free + "torque = \"10 N\"\n"), "");
  EXPECT_TRUE(says(free + "torque = \"10 N m\"\n",
                   "\"10 N m\" is a torque, a torque per length is wanted, in N m/m"));
  EXPECT_TRUE(says(free + "force = [\"1 kN\", 0]\n", "is a force, a force per length is wanted"));
  const std::string solid = tetrahedra + "[[support]]\nname = \"s\"\non = \"b\"\n";
  EXPECT_TRUE(says(solid + "servo = { axis = \"y\", speed = 1, force = \"1 kN/m\" }\n",
                   "\"1 kN/m\" is a force per length, a force is wanted, in N"));
  EXPECT_TRUE(says(solid + "free = [\"turn\"]\ntorque = [0, 0, \"1 kN\"]\n",
                   "is a force, a torque is wanted, in N m"));
}

}  // namespace unused_keys_test
}  // namespace breccia
