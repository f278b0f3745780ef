// Notes on stress at the start that nothing bears on the border.

#include "prepare/checks/check_in_situ.hpp"

#include <gtest/gtest.h>

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

}  // namespace check_in_situ_test
}  // namespace breccia
