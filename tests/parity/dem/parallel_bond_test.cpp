// Rock of parallel bonds: same bits on threads, packs, a device's schedule and ranks; its energies.

#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "prepare/build.hpp"

namespace breccia::dem {
namespace parallel_bond_test {

/// A short column of rock that a fast plate pulls apart.
Config pulled_column() {
  Config config;
  MaterialConfig rock;
  rock.name = "rock";
  rock.law = "parallel";
  rock.tensile_strength = 10e6;
  rock.cohesion = 25e6;
  rock.friction_angle = 0.5;
  rock.bedding = {{0.0, 0.6, 0.8}, 0.7, 0.8};
  config.materials = {rock};
  BodyConfig column;
  column.name = "column";
  column.shape = "box";
  column.material = "rock";
  column.size = {0.1, 0.1, 0.2};
  column.pack.count = 700;
  config.bodies = {column};
  SupportConfig foot, head;
  foot.name = "foot";
  foot.min = {-1.0, -1.0, -1.0};
  foot.max = {1.0, 1.0, -0.08};
  foot.fix = {"all"};
  head = foot;
  head.name = "head";
  head.min.z = 0.08;
  head.max.z = 1.0;
  head.velocity = {0.0, 0.0, 1.0};
  head.ramp = 2e-5;
  config.supports = {foot, head};
  config.time.end = 1.0;
  return config;
}

const Model& model() {
  static const Model made = build_model(pulled_column(), "");
  return made;
}
constexpr int steps = 500;
World pulled(Space space, int threads, Lanes lanes = widest_lanes()) {
  Exec exec;
  exec.space = space;
  exec.threads = threads;
  World w = make_world(pulled_column(), model(), exec);
  w.lanes = lanes;
  while (w.step < steps) advance(w, {1e300, steps});
  return w;
}
const World& reference() {
  static const World w = pulled(Space::host, 1);
  return w;
}

/// Energy missing in the ledger when a column has been pulled until a time.  [-]
double missing(double safety, double until) {
  Config config = pulled_column();
  config.time.safety = safety;
  World w = make_world(config, model(), {});
  while (w.time < until) step(w);
  EXPECT_EQ(w.parallel.size(), w.links());
  EXPECT_GT(count(w).broken_of(LinkKind::parallel), 50);
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.fracture, 0.0);
  return e.error_relative;
}

TEST(ParallelBonds, break_and_account_for_every_joule_as_steps_get_shorter) {
  const double until = reference().time;
  const double coarse = missing(0.7, until), fine = missing(0.175, until);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, 0.3 * coarse);
}

TEST(ParallelBonds, end_alike_on_threads_packs_and_a_devices_schedule) {
  for (const int threads : {2, 3})
    EXPECT_EQ(state_hash(pulled(Space::host, threads)), state_hash(reference())) << threads;
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight})
    if (lanes <= widest_lanes()) {
      EXPECT_EQ(state_hash(pulled(Space::host, 1, lanes)), state_hash(reference()));
    }
  EXPECT_EQ(state_hash(pulled(Space::shadow, 1)), state_hash(reference()));
}

TEST(ParallelBonds, end_alike_on_ranks) {
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    World whole = make_world(pulled_column(), model(), {});
    World part = share_out(whole, ranks, {}, Space::host);
    for (int i = 0; i < steps; ++i) step(part);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), state_hash(reference()));
  });
}

}  // namespace parallel_bond_test
}  // namespace breccia::dem
