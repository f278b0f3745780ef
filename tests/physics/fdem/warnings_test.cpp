// Warnings of set-up about models that can be run, but should be looked at.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace warnings_test {

using namespace testing;

TEST(FdemWarnings, name_the_sliver_that_rules_the_step) {
  Scene scene;
  scene.material();
  scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.02, 0.01}}, 1e-3));
  EXPECT_TRUE(scene.world().given->warnings.empty());
  scene.triangle("sliver", {0.05, 0.0}, {0.051, 0.0}, {0.0505, 1e-5});
  const std::vector<std::string> said = scene.world().given->warnings;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("(sliver) at (0.0505, 3.33333e-06) m"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("times shorter than the median"), std::string::npos) << said[0];
}

/// E G_I/f_t^2 is 3 mm with 10 J/m2; squares of 3 mm with diagonals have edges of 2.4 mm in the
/// mean.
TEST(FdemWarnings, tell_where_edges_are_too_long_for_the_process_zone) {
  const auto said = [](double edge, double energy, const char* joints) {
    Scene scene;
    MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
    m.name = "granite";
    m.joints = joints;
    m.joint.tension = 10e6;
    m.joint.energy_open = energy;
    scene.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.03, 0.03}}, edge));
    const std::vector<std::string> all = scene.world().given->warnings;
    return all.empty() ? "" : all[0];
  };
  EXPECT_EQ(said(1e-3, 11.0, "intrinsic"), "");
  EXPECT_EQ(said(3e-3, 10.0, "none"), "");
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const std::string text = said(3e-3, 10.0, joints);
    EXPECT_NE(text.find("(granite): their process zone E G_I/f_t^2 = 0.003 m spans 1.3 edges"),
              std::string::npos)
        << text;
  }
}

TEST(FdemWarnings, name_probes_whose_box_holds_nothing) {
  Scene scene;
  scene.material().joints = "none";
  scene.body("left", prepare::crossed_rectangle({{0.0, 0.0}, {0.01, 0.01}}, 5e-3));
  scene.body("right", prepare::crossed_rectangle({{0.03, 0.0}, {0.01, 0.01}}, 5e-3));
  const auto said = [&](const char* on, const char* quantity, double low, double high) {
    ProbeConfig probe;
    probe.name = "gauge";
    probe.on = on;
    probe.quantity = quantity;
    probe.min = {low, -1.0, -1.0};
    probe.max = {high, 1.0, 1.0};
    scene.config.probes = {probe};
    const std::vector<std::string> all = scene.world().given->warnings;
    return all.empty() ? "" : all[0];
  };
  EXPECT_EQ(said("", "displacement_x", 0.0049, 0.0051), "");
  EXPECT_EQ(said("", "displacement_x", 0.0051, 0.0055),
            "probe.gauge: its box holds no corner of the mesh at the start, and it reads 0; the "
            "nearest is at (0.005, -0.005) m");
  EXPECT_EQ(said("left", "velocity_x", 0.0045, 0.0255), "");
  EXPECT_NE(said("right", "velocity_x", 0.0045, 0.0055).find("nearest is at (0.025, -0.005) m"),
            std::string::npos);
  EXPECT_EQ(said("", "stress_xx", -0.005, -0.003), "");
  EXPECT_NE(said("", "stress_xx", -0.005, -0.0045).find("no middle of an element"),
            std::string::npos);
  EXPECT_EQ(said("", "opening", 0.0101, 0.0105), "") << "no crack reads 0";
}

}  // namespace warnings_test
}  // namespace breccia::fdem
