// Steps that are done twice on a device: a sound run passes its audit, and keeps its bits and its
// energies. Before each of them the state is saved, then loaded into the world that has gone on.

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/machine/load_check.hpp"
#include "run/method/audited_method.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace audit_on_device_test {

/// A bar of links between a wall and a ball that comes to strike it.
dem::testing::Scene struck_bar() {
  dem::testing::Scene s;
  dem::MaterialConfig& concrete = s.material("c", "concrete", 30e9, 0.2, 2400.0);
  concrete.tensile_strength = 2e6;
  concrete.cohesion = 5e6;
  concrete.softening = 10.0;
  for (int i = 0; i < 6; ++i) {
    const Index e = s.sphere({0.0, 0.0, 0.01 + 0.02 * i}, 0.01);
    if (i > 0) s.link(e - 1, e);
  }
  s.sphere({0.001, 0.0, 0.131}, 0.01, {0.0, 0.0, -30.0});
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  return s;
}

/// A plate that supports pull apart, faster and faster, until its joints break or wake.
fdem::testing::Scene pulled_plate(const char* joints) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = joints;
  m.joint.tension = 3e6;
  m.joint.cohesion = 30e6;
  m.joint.energy_open = 5.0;
  m.joint.energy_slide = 50.0;
  s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {8e-3, 12e-3}}, 2e-3));
  s.support("top", {-far, 6e-3 - 1e-9}, {far, far}, {"y"}, {0.0, 5.0});
  s.support("bottom", {-far, -far}, {far, -6e-3 + 1e-9}, {"y"}, {0.0, -5.0});
  for (fdem::SupportConfig& support : s.config.supports) support.history.ramp = 2e-6;
  return s;
}

/// @param steps  taken; some of them search, break and wake
/// @param every  mean distance of repeated steps
template <class Scene>
void expect_sound(const Scene& s, std::int64_t steps, std::int64_t every = 3) {
  const auto run = [&](Method& method) {
    while (method.steps() < steps) method.advance({1e300, steps});
  };
  const auto host = make_method(s.config, s.model, {}, nullptr);
  run(*host);
  Exec shadow;
  shadow.space = Space::shadow;
  AuditConfig audit;
  audit.every = every;
  const auto method = audited(make_method(s.config, s.model, shadow, nullptr), audit, 1, nullptr);
  run(*method);
  EXPECT_EQ(method->state_hash(), host->state_hash());
  EXPECT_EQ(method->searches(), host->searches());
  EXPECT_GT(host->searches(), 2);
  EXPECT_EQ(method->time_step(), host->time_step());
  const EnergyBalance there = method->energy(), here = host->energy();
  EXPECT_EQ(there.work, here.work);
  EXPECT_EQ(there.fracture, here.fracture);
  EXPECT_GT(here.fracture, 0.0);
  EXPECT_EQ(there.elastic, here.elastic);
  EXPECT_EQ(there.contact, here.contact);
}

TEST(AuditOnDevice, passes_a_struck_bar) {
  expect_sound(struck_bar(), 400);
}
/// And no step may find another state than the one before it has left.
TEST(AuditOnDevice, passes_where_each_step_is_repeated) {
  expect_sound(struck_bar(), 400, 1);
  expect_sound(pulled_plate("intrinsic"), 400, 1);
}
TEST(AuditOnDevice, passes_cubes_that_meet_and_break) {
  expect_sound(fdem3::testing::meeting_cubes(), 650, 12);
}
TEST(AuditOnDevice, passes_a_plate_whose_joints_break) {
  expect_sound(pulled_plate("intrinsic"), 400);
}
TEST(AuditOnDevice, passes_a_plate_whose_joints_wake) {
  expect_sound(pulled_plate("extrinsic"), 400);
}

/// As after a flipped bit: the host must not follow them.
TEST(PlacesOnDevice, that_lead_nowhere_are_told) {
  const auto message = [](const auto& w) -> std::string {
    try {
      require_places(w);
      return "";
    } catch (const DeviceError& error) {
      return error.what();
    }
  };
  const auto flip = [](auto& array) { array.data()[0] ^= 1 << 14; };
  const auto on_device = [](const auto& scene) {
    Exec shadow;
    shadow.space = Space::shadow;
    return make_world(scene.config, scene.model, shadow);
  };
  auto bar = on_device(struck_bar());
  auto plate = on_device(pulled_plate("intrinsic"));
  auto cubes = on_device(fdem3::testing::meeting_cubes());
  EXPECT_EQ(message(bar) + message(plate) + message(cubes), "");
  flip(bar.elements.group);
  flip(plate.joints.edge_a);
  flip(cubes.tetrahedra.material);
  EXPECT_NE(message(bar).find("the device's array elements.group leads to 16384"),
            std::string::npos)
      << message(bar);
  EXPECT_NE(message(plate).find("the device's array joints.edge_a leads to "), std::string::npos)
      << message(plate);
  EXPECT_NE(message(cubes).find("the device's array tetrahedra.material leads to 16384"),
            std::string::npos)
      << message(cubes);
  // Corners of frames are numbered by ids.
  flip(bar.elements.group);
  flip(bar.elements.id);
  flip(plate.joints.edge_a);
  flip(plate.triangles.id);
  EXPECT_NE(message(bar).find("elements.id leads to 16384"), std::string::npos) << message(bar);
  EXPECT_NE(message(plate).find("triangles.id leads to 16384"), std::string::npos)
      << message(plate);
  flip(bar.elements.id);
  flip(bar.elements.material);
  EXPECT_NE(message(bar).find("elements.material leads to 16384"), std::string::npos)
      << message(bar);
}
/// Numbers worked out on the host for those who look at a run.
TEST(PlacesOnDevice, that_lead_nowhere_are_told_before_pieces_are_found) {
  const fdem::testing::Scene s = pulled_plate("intrinsic");
  Exec shadow;
  shadow.space = Space::shadow;
  const auto method = make_method(s.config, s.model, shadow, nullptr);
  const auto edge = method->arrays("joints.edge_b", Wanted::where_they_lie).front();
  *static_cast<Index*>(const_cast<void*>(edge.data)) ^= 1 << 30;
  for (const char* const name : {"damage", "stress", "fragment"})
    EXPECT_THROW(method->arrays(name), DeviceError) << name;
}

}  // namespace audit_on_device_test
}  // namespace breccia
