// The launches of a device's step, carried out by the processor: laws of links by material.
#include <gtest/gtest.h>

#include <string>

#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace device_schedule_test {

using breccia::dem::testing::Scene;

/// Pairs of spheres in a row, each pair of a material of its own. The ends part with `speed`, which
/// breaks the weaker links.
Scene pairs_that_part(int materials, double speed) {
  Scene scene;
  for (int m = 0; m < materials; ++m) {
    MaterialConfig& material =
        scene.material(("m" + std::to_string(m)).c_str(), "concrete", 30e9, 0.2, 2400.0);
    material.tensile_strength = 1e6 * (1 + m);
    material.softening = 5.0;
    const Vec3 left{0.1 * m, 0.0, 0.0}, right{0.1 * m + 0.021, 0.0, 0.0};
    const auto own = static_cast<std::int16_t>(m);
    const Index a = scene.sphere(left, 0.01, {-speed, 0.0, 0.0}, {}, own);
    const Index b = scene.sphere(right, 0.01, {speed, 0.0, 0.0}, {}, own);
    scene.link(a, b, LinkKind::concrete, own);
  }
  return scene;
}

Index broken(const World& w) {
  return static_cast<Index>(count(w).broken_of(LinkKind::concrete));
}

constexpr int steps = 120;

World run_alone(const Scene& scene, Space space) {
  Exec exec;
  exec.space = space;
  World w = make_world(scene.config, scene.model, exec);
  while (w.step < steps) advance(w, {1e300, steps});
  return w;
}

TEST(DeviceSchedule, gives_each_of_ten_materials_its_own_law) {
  const Scene scene = pairs_that_part(10, 1.0);
  const World host = run_alone(scene, Space::host);
  EXPECT_GT(broken(host), 2);
  EXPECT_LT(broken(host), 9);
  const World shadow = run_alone(scene, Space::shadow);
  EXPECT_EQ(broken(shadow), broken(host));
  EXPECT_EQ(state_hash(shadow), state_hash(host));
}

TEST(DeviceSchedule, gives_a_rank_without_links_of_the_first_material_the_law_of_the_second) {
  Scene scene = pairs_that_part(2, 0.2);
  for (Index e = 2; e < 4; ++e) scene.model.position[static_cast<std::size_t>(e)].x += 10.0;
  const World host = run_alone(scene, Space::host);
  EXPECT_EQ(broken(host), 1);
  simulate_ranks(2, 5, [&](Communicator& ranks) {
    World whole = make_world(scene.config, scene.model, {});
    World part = share_out(whole, ranks, {}, Space::shadow);
    EXPECT_EQ(part.concrete.size(), 1);  // each rank holds one body
    for (int i = 0; i < steps; ++i) step(part);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(broken(whole), broken(host));
    EXPECT_EQ(state_hash(whole), state_hash(host));
  });
}

}  // namespace device_schedule_test
}  // namespace breccia::dem
