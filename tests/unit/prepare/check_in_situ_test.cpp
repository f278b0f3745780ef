// Notes on stress at the start that nothing bears on the border.

#include "prepare/checks/check_in_situ.hpp"

#include <gtest/gtest.h>

#include "io/whole_file.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia {
namespace check_in_situ_test {

using prepare::doubtful_in_situ;
using Notes = std::vector<std::string>;

/// A plate of 1 m under 10 and 5 MPa, on rollers left, right and below.
fdem::Config plate() {
  fdem::Config config;
  config.bodies = {fdem::regular_plate({1.0, 1.0}, 0.1)};
  config.in_situ.xx = -10e6;
  config.in_situ.yy = -5e6;
  const auto roller = [&](const char* name, const Vec2& min, const Vec2& max, const char* fix) {
    auto& s = config.supports.emplace_back();
    s.name = name;
    s.region.min = min;
    s.region.max = max;
    s.fix = {fix};
  };
  roller("left", {-1.0, -1.0}, {-0.49, 1.0}, "x");
  roller("right", {0.49, -1.0}, {1.0, 1.0}, "x");
  roller("foot", {-1.0, -1.0}, {1.0, -0.49}, "y");
  return config;
}
fdem::LoadConfig& add_load(fdem::Config& config, const char* kind) {
  auto& load = config.loads.emplace_back();
  load.name = "top";
  load.kind = kind;
  load.region.min = {-1.0, 0.49};
  load.region.max = {1.0, 1.0};
  return load;
}

const std::string free_top =
    "in_situ.yy: nothing bears the stress at the start, -5 MPa, on the side y = 500 mm of plate: "
    "it expands from the first step on; a support with fix = [\"y\"] there holds it, or a load of "
    "kind \"pressure\" with pressure = \"5 MPa\"";

TEST(CheckInSitu, tells_which_side_nothing_bears) {
  EXPECT_EQ(doubtful_in_situ(plate(), "."), Notes{free_top});
  fdem::Config config = plate();
  config.in_situ.yy = 0.0;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  config = plate();
  config.supports[1].fix = {"y"};  // rollers that let it go across
  const Notes both = doubtful_in_situ(config, ".");
  ASSERT_EQ(both.size(), 2U);
  EXPECT_TRUE(
      both[0].starts_with("in_situ.xx: nothing bears the stress at the start, -10 MPa, on "
                          "the side x = 500 mm of plate"))
      << both[0];
  config = plate();
  config.supports[2].region.max.x = 0.0;  // half of the foot
  EXPECT_NE(doubtful_in_situ(config, ".")[0].find("on 50 % of the side y = -500 mm"),
            std::string::npos);
}

/// Regions take what lies outside of their box, or in a circle, where they say so.
TEST(CheckInSitu, asks_regions_by_their_shape) {
  fdem::Config config = plate();
  auto& foot = config.supports[2].region;
  foot.min = {-2.0, -0.49};
  foot.max = {2.0, 2.0};
  foot.outside = true;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{free_top});
  foot.min = {-2.0, -2.0};
  foot.max = {2.0, 0.49};
  const Notes lower = doubtful_in_situ(config, ".");
  ASSERT_EQ(lower.size(), 1U);
  EXPECT_NE(lower[0].find("on the side y = -500 mm of plate"), std::string::npos) << lower[0];
  foot = {};
  foot.center = {0.0, -0.5};
  foot.radius = 0.125;  // a quarter of the side
  const Notes round = doubtful_in_situ(config, ".");
  ASSERT_EQ(round.size(), 2U);
  EXPECT_NE(round[0].find("on 75 % of the side y = -500 mm"), std::string::npos) << round[0];
}

TEST(CheckInSitu, is_content_with_the_same_pressure_alone) {
  fdem::Config config = plate();
  auto* load = &add_load(config, "pressure");
  load->pressure = 5e6;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  load->history.ramp = 1e-3;
  EXPECT_EQ(doubtful_in_situ(config, "."),
            Notes{"load.top.pressure: it presses the side y = 500 mm with 0 Pa at the start, and "
                  "the stress in situ there is -5 MPa: the side moves from the first step on, "
                  "unless the pressure is 5 MPa"});
  load->history.ramp = 0.0;
  load->pressure = 4e6;
  EXPECT_EQ(doubtful_in_situ(config, ".").size(), 1U);
  load->kind = "traction";
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  load->kind = "absorbing";
  ASSERT_EQ(doubtful_in_situ(config, ".").size(), 1U);
  EXPECT_NE(doubtful_in_situ(config, ".")[0].find("bears no stress"), std::string::npos);
}

TEST(CheckInSitu, lets_the_surface_of_ground_be) {
  fdem::Config config = plate();
  config.in_situ.xx = config.in_situ.yy = 0.0;
  config.in_situ.yy_slope = {0.0, 25e3};
  config.in_situ.xx_slope = {0.0, 15e3};
  config.in_situ.origin = {0.0, 0.5};
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  config.in_situ.origin = {0.0, 1.5};
  ASSERT_EQ(doubtful_in_situ(config, ".").size(), 1U);
  EXPECT_TRUE(doubtful_in_situ(config, ".")[0].starts_with("in_situ.yy_slope: nothing bears"));
}

TEST(CheckInSitu, tells_stress_that_pulls) {
  fdem::Config config = plate();
  config.in_situ.yy = 0.0;
  config.in_situ.xx = 10e6;
  EXPECT_EQ(doubtful_in_situ(config, "."),
            Notes{"in_situ.xx: the stress at the start pulls with 10 MPa (tension is positive); "
                  "rock under that pressure has \"-10 MPa\""});
}

TEST(CheckInSitu, tells_it_of_tetrahedra) {
  fdem3::Config config;
  config.bodies = {fdem3::regular_box({1.0, 1.0, 1.0}, 0.5)};
  config.in_situ.zz = -3e6;
  auto& s = config.supports.emplace_back();
  s.name = "foot";
  s.region.min = {-1.0, -1.0, -1.0};
  s.region.max = {1.0, 1.0, -0.49};
  EXPECT_EQ(doubtful_in_situ(config, "."),
            Notes{"in_situ.zz: nothing bears the stress at the start, -3 MPa, on the side z = 500 "
                  "mm of block: it expands from the first step on; a support with fix = [\"z\"] "
                  "there holds it, or a load of kind \"pressure\" with pressure = \"3 MPa\""});
  config.supports.clear();  // all six sides, of which four bear nothing
  EXPECT_EQ(doubtful_in_situ(config, ".").size(), 2U);
}

/// A disc of 1 m under 5 MPa all around, and what takes its rim.
fdem::Config disc() {
  fdem::Config config;
  config.bodies = {fdem::disc_of(1.0, 0.1)};
  config.in_situ.xx = config.in_situ.yy = -5e6;
  return config;
}
const std::string free_rim = "in_situ.xx: nothing bears the stress at the start, up to 5 MPa, on ";

TEST(CheckInSitu, looks_at_the_rim_of_discs) {
  fdem::Config config = disc();
  const std::string end =
      " of disc: it moves from the first step on; a support there holds it, or loads that press as "
      "it does";
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{free_rim + "the border" + end});
  auto& load = config.loads.emplace_back();
  load.name = "rim";
  load.pressure = 5e6;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  load.pressure = 4e6;
  EXPECT_EQ(doubtful_in_situ(config, "."),
            Notes{"load.rim.pressure: it presses the border of disc with 4 MPa at the start, and "
                  "the stress in situ there is -5 MPa across it: the border moves from the first "
                  "step on, unless the pressure is 5 MPa"});
  load.kind = "absorbing";
  EXPECT_NE(doubtful_in_situ(config, ".")[0].find("bears no stress"), std::string::npos);
  config.loads.clear();
  auto& support = config.supports.emplace_back();
  support.name = "rim";
  support.region.radius = 0.98;
  support.region.outside = true;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  support.region.min.y = 0.0;  // what the upper half of that circle leaves out
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  support.region = {};
  support.region.max.y = 0.0;  // the lower half
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{free_rim + "50 % of the border" + end});
  support.region = {};
  support.fix = {"y"};  // along x it is free
  EXPECT_EQ(doubtful_in_situ(config, ".").size(), 1U);
}

TEST(CheckInSitu, looks_at_both_borders_of_rings_and_at_no_border_between_bodies) {
  fdem::Config config = disc();
  config.bodies[0].shape = "ring";
  config.bodies[0].inner_radius = 0.5;
  auto& support = config.supports.emplace_back();
  support.name = "rim";
  support.region.radius = 0.98;
  support.region.outside = true;
  const Notes open = doubtful_in_situ(config, ".");
  ASSERT_EQ(open.size(), 1U);  // half as long as the outer one
  EXPECT_TRUE(open[0].starts_with(free_rim + "33 % of the border of disc")) << open[0];
  config.bodies.push_back(fdem::disc_of(0.5, 0.1));
  config.bodies.back().name = "core";
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
}

TEST(CheckInSitu, looks_at_borders_of_files) {
  const std::string path = std::string(::testing::TempDir()) + "/in_situ_outline.csv";
  replace_file(path, "0,0\n1,0\n1,2\n0,2\n");
  fdem::Config config;
  auto& body = config.bodies.emplace_back();
  body.name = "slope";
  body.shape = "outline";
  body.file = "in_situ_outline.csv";
  config.in_situ.xx = -2e6;
  auto& support = config.supports.emplace_back();
  support.name = "left";
  support.region.max.x = 0.0;
  const Notes told = doubtful_in_situ(config, ::testing::TempDir());
  ASSERT_EQ(told.size(), 1U);  // the right side, 2 of 6 m
  EXPECT_TRUE(
      told[0].starts_with("in_situ.xx: nothing bears the stress at the start, up to 2 MPa, "
                          "on 33 % of the border of slope"))
      << told[0];
}

TEST(CheckInSitu, looks_at_cylinders_and_spheres) {
  fdem3::Config config;
  auto& body = config.bodies.emplace_back();
  body.name = "core";
  body.shape = "cylinder";
  body.radius = 0.5;
  body.height = 1.0;
  body.axis = "x";
  config.in_situ.xx = -3e6;
  auto& foot = config.supports.emplace_back();
  foot.name = "foot";
  foot.region.max.x = -0.49;
  const Notes cap = doubtful_in_situ(config, ".");
  ASSERT_EQ(cap.size(), 1U);  // pi/4 m2 of 3 pi/2
  EXPECT_TRUE(
      cap[0].starts_with("in_situ.xx: nothing bears the stress at the start, up to 3 MPa, "
                         "on 17 % of the border of core"))
      << cap[0];
  auto& head = config.loads.emplace_back();
  head.name = "head";
  head.region.min.x = 0.49;
  head.pressure = 3e6;
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  body.axis = "z";
  EXPECT_FALSE(doubtful_in_situ(config, ".").empty());  // now its flank bears it
  body.shape = "sphere";
  config.in_situ.yy = config.in_situ.zz = -3e6;
  head.region = {};
  EXPECT_EQ(doubtful_in_situ(config, "."), Notes{});
  config.loads.clear();
  EXPECT_EQ(doubtful_in_situ(config, ".").size(), 1U);
}

}  // namespace check_in_situ_test
}  // namespace breccia
