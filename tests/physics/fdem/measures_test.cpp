// Probes of regions: stress, strain, torque, displacement, angular momentum, cracks against closed
// answers.

#include <gtest/gtest.h>

#include <algorithm>

#include "physics/fdem/scene.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia::fdem {
namespace fdem_measures_test {

using testing::deform;
using testing::far;
using testing::nodes;
using testing::Scene;
using testing::stir;
using testing::value;

Scene plate() {
  Scene s;
  s.material();
  s.config.time.evaluate_every = 10;
  s.config.local_damping = 0.5;
  s.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.04, 0.02}}, 4e-3));
  return s;
}

double stress(const World& w, const char* component, const std::vector<double>& min = {},
              const std::vector<double>& max = {}, const char* reduce = "mean") {
  return probe(w, {"p", "plate", component, reduce, min, max});
}

TEST(Measures, stress_under_pressure_from_all_sides_is_minus_the_pressure) {
  Scene s = plate();
  s.load("all", "pressure", {-far, -far}, {far, far}).pressure = 3e6;
  World w = s.world();
  for (int i = 0; i < 6'000; ++i) step(w);
  EXPECT_NEAR(stress(w, "stress_xx"), -3e6, 3e6 * 1e-6);
  EXPECT_NEAR(stress(w, "stress_yy"), -3e6, 3e6 * 1e-6);
  EXPECT_NEAR(stress(w, "stress_xy"), 0.0, 3e6 * 1e-6);
  EXPECT_NEAR(stress(w, "stress_xx", {0.0, 0.0}, {0.01, 0.01}), -3e6, 3e6 * 1e-6);
  EXPECT_NEAR(stress(w, "stress_xx", {}, {}, "max"), -3e6, 3e6 * 1e-5);
}

TEST(Measures, stress_under_a_pull_along_x_is_that_pull) {
  Scene s = plate();
  s.load("right", "traction", {0.0199, -far}, {far, far}).traction = Vec2{2e6, 0.0};
  s.load("left", "traction", {-far, -far}, {-0.0199, far}).traction = Vec2{-2e6, 0.0};
  World w = s.world();
  for (int i = 0; i < 6'000; ++i) step(w);
  // Tractions act on the sides as they were: 2 MPa / 60 GPa of them is what they shrink.
  EXPECT_NEAR(stress(w, "stress_xx"), 2e6, 2e6 * 1e-4);
  EXPECT_NEAR(stress(w, "stress_yy"), 0.0, 2e6 * 1e-4);
}

TEST(Measures, strain_displacement_and_angular_momentum_are_exact) {
  Scene s = plate();
  for (const char* word : {"strain_xx", "strain_yy", "strain_xy"})
    s.config.probes.push_back({word, "plate", word, "mean"});
  s.config.probes.push_back({"part", "plate", "strain_xy", "mean", {-0.01, -0.01}, {0.01, 0.01}});
  s.config.probes.push_back({"way", "plate", "displacement_x", "max"});
  World w = s.world();
  deform(w, [](const Vec2& x) {
    return Vec2{x.x + 1e-3 * x.x + 4e-3 * x.y + 0.5, x.y + 2e-3 * x.x - 5e-4 * x.y};
  });
  const std::vector<double> expected{1e-3, -5e-4, 3e-3, 3e-3, 0.5 + 1e-3 * 0.02 + 4e-3 * 0.01};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(probe(w, s.config.probes[i]), expected[i], 1e-12) << s.config.probes[i].name;

  World spinning = plate().world();
  stir(spinning, [](const Vec2& x) { return Vec2{-7.0 * x.y + 1.0, 7.0 * x.x}; });
  double inertia = 0.0, sideways = 0.0, mass = 0.0;
  for (Index t = 0; t < spinning.triangles.size(); ++t)
    for (const NodeState& n : nodes(spinning, t).at) {
      mass += spinning.triangles.mass.data()[t];
      inertia += spinning.triangles.mass.data()[t] * dot(n.position, n.position);
      sideways -= spinning.triangles.mass.data()[t] * n.position.y;
    }
  const double exact = 7.0 * inertia + sideways;
  EXPECT_NEAR(value(spinning, "plate", "angular_momentum_z", "sum"), exact, 1e-12 * exact);
  const double about = probe(spinning, {"", "plate", "angular_momentum_z", "sum", {}, {}, {0, 2}});
  EXPECT_NEAR(about, exact + 2.0 * mass, 1e-10 * mass);
}

TEST(Measures, torque_of_a_clamp_is_that_of_the_load) {
  Scene s = plate();
  s.support("clamp", {-far, -far}, {-0.0199, far}, {"x", "y"});
  s.load("end", "traction", {0.0199, -far}, {far, far}).traction = Vec2{0.0, -1e4};
  World w = s.world();
  for (int i = 0; i < 40'000; ++i) step(w);
  const double force = 1e4 * 0.02, torque = -force * 0.02;  // about the middle
  EXPECT_NEAR(value(w, "clamp", "force_y", "sum"), -force, 1e-3 * force);
  EXPECT_NEAR(probe(w, {"", "clamp", "torque_z", "sum", {}, {}, {0.0, 0.0}}), torque,
              2e-3 * force * 0.04);
}

TEST(Measures, cracks_show_how_far_they_have_opened_and_slipped) {
  Scene s;
  s.material().joints = "intrinsic";
  s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.04, 0.02}}, 0.01));
  World w = s.world();
  EXPECT_EQ(value(w, "plate", "opening", "max"), 0.0);
  EXPECT_EQ(value(w, "plate", "broken", "sum"), 0.0);
  // The upper half goes up by 3 and to the right by 2: joints between the halves are broken.
  double crossing = 0.0;
  for (Index i = 0; i < w.joints.size(); ++i) {
    const auto height = [&](Index edge) {
      const TriangleNodes& t = nodes(w, edge / 3);
      return t.at[0].position.y + t.at[1].position.y + t.at[2].position.y;
    };
    if (height(w.joints.edge_a.data()[i]) * height(w.joints.edge_b.data()[i]) >= 0.0) continue;
    w.joints.stage.data()[i] = JointStage::broken;
    ++crossing;
  }
  for (Index t = 0; t < w.triangles.size(); ++t) {
    TriangleNodes& n = nodes(w, t);
    if (n.at[0].position.y + n.at[1].position.y + n.at[2].position.y < 0.0) continue;
    for (NodeState& corner : n.at) corner.position += Vec2{2e-6, 3e-6};
  }
  EXPECT_EQ(crossing, 4.0);
  EXPECT_EQ(value(w, "plate", "broken", "sum"), crossing);
  EXPECT_NEAR(value(w, "plate", "broken"), crossing / w.joints.size(), 1e-15);
  EXPECT_NEAR(value(w, "plate", "opening"), 3e-6, 1e-12);
  EXPECT_NEAR(value(w, "plate", "slip", "max"), 2e-6, 1e-12);
  EXPECT_EQ(probe(w, {"", "", "broken", "sum", {0.0, -1.0}, {1.0, 1.0}}), 2.0);
  const Frame frame = fdem_frame(w).frame;
  const auto expect_all = [&](const char* name, double wanted) {
    const auto field = std::find_if(frame.line_fields.begin(), frame.line_fields.end(),
                                    [&](const FrameField& f) { return f.name == name; });
    ASSERT_NE(field, frame.line_fields.end()) << name;
    EXPECT_EQ(static_cast<double>(field->values.size()), crossing);
    for (const float one : field->values) EXPECT_NEAR(one, wanted, 1e-12) << name;
  };
  expect_all("opening", 3e-6);
  expect_all("slip", 2e-6);
}

}  // namespace fdem_measures_test
}  // namespace breccia::fdem
