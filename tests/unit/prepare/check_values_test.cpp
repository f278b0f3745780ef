// Notes on values that can be run and are hardly meant.

#include "prepare/checks/check_values.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prepare/checks/check_case.hpp"
#include "prepare/checks/check_in_situ.hpp"
#include "prepare/checks/check_stages.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia {
namespace check_values_test {

using prepare::doubtful_values;
using Notes = std::vector<std::string>;

fdem::Config plate_of(const fdem::MaterialConfig& material) {
  fdem::Config config;
  config.bodies = {fdem::regular_plate({1.0, 1.0}, 0.1)};
  config.materials = {material};
  return config;
}
fdem::MaterialConfig rock() {
  fdem::MaterialConfig m;
  m.name = "rock";
  return m;
}

TEST(CheckValues, tells_of_densities_in_another_unit) {
  fdem::MaterialConfig m = rock();
  EXPECT_EQ(doubtful_values(plate_of(m), "."), Notes{});
  m.density = 100.0;
  EXPECT_EQ(doubtful_values(plate_of(m), "."), Notes{});
  m.density = 2.6;
  EXPECT_EQ(doubtful_values(plate_of(m), "."),
            Notes{"material.rock.density = 2.6 kg/m3 is lighter than any rock or concrete; did you "
                  "mean \"2.6 g/cm3\"? Rock and concrete have 2 to 3 g/cm3"});
  m.density = 2.6e6;
  EXPECT_EQ(doubtful_values(plate_of(m), "."),
            Notes{"material.rock.density = 2.6e+06 kg/m3 is heavier than any metal; did you mean "
                  "\"2600 kg/m3\"? Rock and concrete have 2 to 3 g/cm3"});
  m.density = 60.0;
  EXPECT_EQ(doubtful_values(plate_of(m), "."),
            Notes{"material.rock.density = 60 kg/m3 is lighter than any rock or concrete; kg/m3, "
                  "g/cm3 and t/m3 are allowed, and numbers without a unit are kg/m3"});
  dem::Config spheres;
  spheres.materials.resize(2);
  spheres.materials[0].density = spheres.materials[1].density = 40.0;
  spheres.materials[1].law = "grain";  // may be anything
  EXPECT_EQ(doubtful_values(spheres, ".").size(), 1U);
}

TEST(CheckValues, tells_of_tension_beyond_the_apex) {
  fdem::MaterialConfig m = rock();
  m.joint.cohesion = 20e6;
  m.joint.friction_angle = std::atan(0.7);
  m.joint.tension = 28.5e6;
  EXPECT_EQ(doubtful_values(plate_of(m), "."), Notes{});
  m.joint.tension = 60e6;
  const std::string sentence =
      ".tension = 60 MPa is never reached: the joint slides from cohesion / tan(friction_angle) = "
      "28.57 MPa on, the apex of its strength; tension is at most that";
  EXPECT_EQ(doubtful_values(plate_of(m), "."), Notes{"material.rock.joint" + sentence});
  fdem3::Config solid = fdem3::case_of({fdem3::regular_box({0.1, 0.1, 0.1}, 0.05)});
  solid.materials = {m};
  solid.joint_laws.push_back({"seam", {}, m.joint});
  solid.materials[0].joints = "none";
  EXPECT_EQ(doubtful_values(solid, "."), Notes{"joint.seam.strength" + sentence});
}

TEST(CheckValues, tells_of_elements_larger_than_their_body) {
  const auto notes = [](const fdem3::BodyConfig& body) {
    return doubtful_values(fdem3::case_of({body}), ".");
  };
  EXPECT_EQ(notes(fdem3::regular_box({0.03, 0.03, 0.06}, 0.03)), Notes{});
  EXPECT_EQ(notes(fdem3::regular_box({0.03, 0.03, 0.06}, 0.09)),
            Notes{"body.block.mesh_size = 90 mm is longer than the shortest side of block, 30 mm: "
                  "one element across it shows neither bending nor cracks; a fifth of the side, 6 "
                  "mm, or less is usual"});
  EXPECT_EQ(notes(fdem3::regular_box({0.1, 0.05, 0.002}, 0.005)), Notes{});  // a slice
  fdem::Config plane = plate_of(rock());
  plane.bodies = {fdem::disc_of(0.05, 0.11)};
  EXPECT_EQ(doubtful_values(plane, ".").size(), 1U);
  plane.bodies[0].mesh_size = 0.1;
  EXPECT_EQ(doubtful_values(plane, "."), Notes{});
  plane.bodies[0].shape = "ring";
  plane.bodies[0].inner_radius = 0.04;
  EXPECT_EQ(doubtful_values(plane, ".").size(), 1U);
}

/// A beam of 400 by 100 by 100 mm on two supports, and a roller on it.
dem::Config beam() {
  dem::Config config;
  config.materials.resize(1);
  config.materials[0].name = "concrete";
  dem::BodyConfig& body = config.bodies.emplace_back();
  body.name = "beam";
  body.material = "concrete";
  body.size = {0.4, 0.1, 0.1};
  body.pack.count = 700;
  for (const double x : {-0.18, 0.18}) {
    dem::SupportConfig& s = config.supports.emplace_back();
    s.name = x < 0.0 ? "left" : "right";
    s.min.x = x - 0.012;
    s.max = {x + 0.012, no_limit, -0.04};
  }
  dem::WallConfig& press = config.walls.emplace_back();
  press.name = "press";
  press.shape = "cylinder";
  press.point = {0.0, 0.06, 0.0655};
  press.radius = 0.015;
  press.length = 0.12;
  return config;
}

TEST(CheckValues, tells_of_a_body_in_metres_amid_millimetres) {
  dem::Config config = beam();
  EXPECT_EQ(doubtful_values(config, "."), Notes{});
  config.bodies[0].size = {400.0, 100.0, 100.0};
  EXPECT_EQ(doubtful_values(config, "."),
            Notes{"body.beam.size: beam is 400 m long, and all that support.left and wall.press "
                  "name lies within 192 mm, less than one of its elements: are both in the right "
                  "unit? Numbers without one are metres"});
  config.supports.clear();  // a tool in the middle of a large block may be meant
  EXPECT_EQ(doubtful_values(config, "."), Notes{});
}

TEST(CheckValues, tells_of_bodies_far_from_each_other_in_size_or_place) {
  fdem3::BodyConfig block = fdem3::regular_box({0.2, 0.2, 0.2}, 0.02), tool = block;
  tool.name = "tool";
  tool.size = {0.02, 0.02, 0.02};
  tool.center = {0.0, 0.0, 0.11};
  EXPECT_EQ(doubtful_values(fdem3::case_of({block, tool}), "."), Notes{});
  fdem3::BodyConfig far = tool;
  far.center.z = 110.0;
  EXPECT_EQ(doubtful_values(fdem3::case_of({block, far}), "."),
            Notes{"body.tool.center: it lies 109.9 m from block, which is nearest, and neither is "
                  "longer than 200 mm: are all in the right unit? Numbers without one are metres"});
  block.size = {200.0, 200.0, 200.0};
  block.mesh_size = 20.0;
  const Notes large = doubtful_values(fdem3::case_of({block, tool}), ".");
  ASSERT_EQ(large.size(), 1U);
  EXPECT_EQ(large[0],
            "body.tool.size: tool is 20 mm long, and one element of block is 20 m: are both in the "
            "right unit? Numbers without one are metres");
}

TEST(CheckValues, tells_of_ramps_longer_than_the_run_or_their_stage) {
  fdem::Config config = plate_of(rock());
  config.time.end = 1e-3;
  auto& load = config.loads.emplace_back();
  load.name = "top";
  load.history.ramp = 1e-3;
  EXPECT_EQ(prepare::doubtful_times(config), Notes{});
  load.history.ramp = 10e-3;
  EXPECT_EQ(
      prepare::doubtful_times(config),
      Notes{"load.top.ramp = 10 ms: it counts for 1 ms at most, so what it leads reaches 10 % "
            "of the value given"});
  load.history.ramp = 0.0;
  auto& stage = config.stages.emplace_back();
  stage.name = "push";
  stage.until = 4e-4;
  auto& change = stage.loads.emplace_back();
  change.name = "top";
  change.ramp = 8e-4;
  EXPECT_EQ(
      prepare::doubtful_times(config),
      Notes{"stage.push.load.top.ramp = 800 us: it counts for 400 us at most, so what it leads "
            "reaches 50 % of the value given"});
  stage.until = 0.0;  // by another rule
  EXPECT_EQ(prepare::doubtful_times(config), Notes{});
}

TEST(CheckValues, refuses_what_is_too_soft_for_its_stress) {
  fdem::Config config = plate_of(rock());
  config.in_situ.xx = config.in_situ.yy = -5e6;
  EXPECT_EQ(prepare::soft_problems(config), Notes{});
  config.materials[0].young = 12.4e6;  // 2 (1 + 0.25) 5 MPa = 12.5 MPa
  const Notes given = prepare::soft_problems(config);
  ASSERT_EQ(given.size(), 1U);
  EXPECT_TRUE(given[0].starts_with(
      "material.rock.young = 12.4 MPa is too soft for the pressure in situ that rock bears, 5 MPa: "
      "elements whose shear modulus young / (2 (1 + poisson)) is not above it turn inside out, "
      "whatever the step; it needs more than 12.5 MPa"))
      << given[0];
  EXPECT_THROW(check_case(config), InputError);
  config.materials[0].young = 20e9;
  auto& stage = config.stages.emplace_back();
  stage.name = "relax";
  auto& change = stage.materials.emplace_back();
  change.name = "rock";
  change.young = 6e6;
  change.in_situ = 0.5;
  ASSERT_EQ(prepare::soft_problems(config).size(), 1U);
  EXPECT_TRUE(prepare::soft_problems(config)[0].starts_with(
      "stage.relax.material.rock.young = 6 MPa is too soft for the pressure in situ that rock "
      "bears, "
      "2.5 MPa"));
  change.young = 6.5e6;
  EXPECT_EQ(prepare::soft_problems(config), Notes{});
  change.in_situ = -1.0;  // as before: all of it
  EXPECT_EQ(prepare::soft_problems(config).size(), 1U);
  change.in_situ = 0.0;
  change.young = 1.0;
  EXPECT_EQ(prepare::soft_problems(config), Notes{});
  config.in_situ.xx = config.in_situ.yy = 5e6;  // pulls: it stiffens
  change.in_situ = 1.0;
  EXPECT_EQ(prepare::soft_problems(config), Notes{});
}

TEST(CheckValues, refuses_soft_tetrahedra_by_the_stress_where_they_are) {
  fdem3::BodyConfig deep = fdem3::regular_box({1.0, 1.0, 1.0}, 0.5), high = deep;
  deep.center.z = -99.0;
  deep.name = "deep";
  deep.material = "clay";
  fdem3::Config config = fdem3::case_of({high, deep});
  fdem::MaterialConfig m = rock();
  m.young = 1e6;
  config.materials = {m, m};
  config.materials[1].name = "clay";
  config.in_situ.zz_slope = {0.0, 0.0, 25e3};
  config.in_situ.origin = {0.0, 0.0, 0.5};
  const Notes told = prepare::soft_problems(config);  // 2.49 MPa at a depth of 99.5 m
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(told[0].starts_with("material.clay.young = 1 MPa is too soft")) << told[0];
}

}  // namespace check_values_test
}  // namespace breccia
