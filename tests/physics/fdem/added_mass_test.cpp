// time.added_mass: elements that rule the step become heavier, all steps longer.

#include "core/added_mass.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "fdem/stepping/step.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace fdem_added_mass_test {

using testing::far;
using testing::Scene;

TEST(AddedMass, spends_the_share_on_the_shortest_steps_alone) {
  const std::vector<double> step{4.0, 1.0, 2.0, 3.0, 1e300};
  std::vector<double> mass{10.0, 1.0, 2.0, 5.0, 2.0};
  // Of 20, 0.25 is room for 5: steps of 2 ask 1 (4 - 1) of the first; then f^2 (1 + 2/4) - 3 = 5.
  const double square = 8.0 / 1.5;
  const AddedMass added = add_mass(0.25, step, mass, mass);
  EXPECT_EQ(added.elements, 2);
  EXPECT_NEAR(added.share, 0.25, 1e-14);
  EXPECT_NEAR(added.longer, std::sqrt(square), 1e-14);
  EXPECT_NEAR(mass[1], square, 1e-13);
  EXPECT_NEAR(mass[2], 2.0 * square / 4.0, 1e-13);
  EXPECT_EQ(mass[0], 10.0);
  EXPECT_EQ(mass[3], 5.0);
  EXPECT_EQ(mass[4], 2.0);
}

TEST(AddedMass, adds_nothing_where_nothing_rules_or_no_share_is_given) {
  const std::vector<double> any{1e300, 1e300}, step{1.0, 2.0};
  std::vector<double> mass{1.0, 1.0};
  EXPECT_EQ(add_mass(0.1, any, mass, mass).elements, 0);
  EXPECT_EQ(add_mass(0.0, step, mass, mass).elements, 0);
  EXPECT_EQ(mass, (std::vector<double>{1.0, 1.0}));
}

/// A column of height 0.4 on a held base under a load on its top; one row of its mesh is a
/// twentieth as high as the others.
struct Column {
  double thin = 0.0;  ///< share of the added mass that the thin row got  [-]
  double first_step = 0.0, mass = 0.0, reaction = 0.0, shortening = 0.0;
  long steps = 0;
  AddedMass added;

  Column(double share, const char* joints) {
    Scene scene;
    MaterialConfig& m = scene.material(1e8, 0.0, 2000.0);
    m.damping = 0.0;
    m.joints = joints;
    m.joint.tension = m.joint.cohesion = 1e6;
    m.joint.energy_open = m.joint.energy_slide = 1e3;
    scene.config.time.added_mass = share;
    scene.config.local_damping = 0.1;
    prepare::Mesh mesh;
    const std::vector<double> height{0.0, 0.1, 0.2, 0.205, 0.3, 0.4};
    for (const double y : height)
      for (const double x : {0.0, 0.1}) mesh.point.push_back({x, y});
    for (Index row = 0; row + 1 < static_cast<Index>(height.size()); ++row) {
      const Index a = 2 * row;
      mesh.triangle.push_back({a, a + 1, a + 3});
      mesh.triangle.push_back({a, a + 3, a + 2});
    }
    scene.body("column", mesh);
    scene.support("base", {-far, -1e-6}, {far, 1e-6}, {"y"});
    LoadConfig& l = scene.load("top", "pressure", {-far, 0.399}, {far, far});
    l.pressure = 1e4;
    l.history.ramp = 0.1;
    World w = scene.world();
    first_step = w.next_dt;
    added = w.given->added_mass;
    for (const double corner : w.triangles.mass.host()) mass += 3.0 * corner;
    const double own = 2000.0 * 0.5 * 0.1 * 0.005;  // of a thin triangle
    if (share > 0.0)
      thin = (3.0 * (w.triangles.mass.data()[4] + w.triangles.mass.data()[5]) - 2.0 * own) /
             (share * 2000.0 * 0.1 * 0.4);
    const double high = testing::value(w, "column", "position_y");
    while (w.time < 0.5) step(w), ++steps;
    reaction = testing::value(w, "base", "force_y", "sum");
    shortening = high - testing::value(w, "column", "position_y");
    EXPECT_LT(energies(w).balance.error_relative, 1e-4);
  }
};

void expect_same_equilibrium(const Column& heavier, const Column& plain) {
  EXPECT_NEAR(heavier.reaction, plain.reaction, 1e-3 * std::fabs(plain.reaction));
  EXPECT_NEAR(heavier.shortening, plain.shortening, 1e-3 * plain.shortening);
}

TEST(AddedMass, takes_longer_steps_to_the_same_equilibrium) {
  const Column plain(0.0, "intrinsic"), heavier(0.02, "intrinsic");
  EXPECT_EQ(plain.added.elements, 0);
  EXPECT_EQ(heavier.added.elements, 2);  // the thin row alone
  EXPECT_NEAR(heavier.mass / plain.mass - 1.0, 0.02, 1e-12);
  EXPECT_NEAR(heavier.added.share, 0.02, 1e-12);
  // the row has 0.0125 of the mass: f^2 = (0.02 + 0.0125) / 0.0125
  EXPECT_NEAR(heavier.first_step / plain.first_step, std::sqrt(0.0325 / 0.0125), 0.05);
  EXPECT_NEAR(heavier.added.longer, heavier.first_step / plain.first_step, 0.05);
  EXPECT_LT(heavier.steps, 0.67 * static_cast<double>(plain.steps));
  expect_same_equilibrium(heavier, plain);
}

// Corners that move as one bear each other's rows: what the thin row adds to them asks for more
// mass, and it gets most of it.
TEST(AddedMass, goes_to_the_elements_whose_rows_rule_a_bundle) {
  const Column alone(0.0, "intrinsic"), plain(0.0, "none"), heavier(0.1, "none");
  EXPECT_GT(plain.first_step, 2.0 * alone.first_step);
  EXPECT_NEAR(heavier.mass / plain.mass - 1.0, 0.1, 1e-12);
  EXPECT_NEAR(heavier.added.longer, heavier.first_step / plain.first_step, 0.05);
  EXPECT_GT(heavier.added.longer, 1.15);
  EXPECT_GT(heavier.thin, 0.7);
  expect_same_equilibrium(heavier, plain);
}

}  // namespace fdem_added_mass_test
}  // namespace breccia::fdem
