// Equal bits for any thread count, width of vector, search margin, and across a checkpoint.

#include <gtest/gtest.h>

#include "fdem/stepping/busy_pairs.hpp"
#include "physics/fdem/scene.hpp"
#include "run/method/fdem_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace fdem_same_bits_test {

using fdem::testing::Scene;

/// A brittle disc that breaks on a plate, both with joints.
Scene impact(double margin = 0.1) {
  Scene scene = fdem::testing::brittle_disc(60.0);
  scene.config.search.margin = margin;
  return scene;
}
fdem::World world(int threads, double margin = 0.1) {
  return impact(margin).world(threads);
}
/// Hash after the disc has begun to break.
std::uint64_t hash_after(fdem::World w, int steps = 250) {
  while (w.step < steps) fdem::advance(w, {1e300, steps});
  EXPECT_GT(fdem::cracks(w).size(), 20U);
  return fdem::state_hash(w);
}
std::uint64_t reference() {
  static const std::uint64_t hash = hash_after(world(1));
  return hash;
}

TEST(FdemSameBits, for_any_number_of_threads) {
  for (const int threads : {2, 3, 7}) EXPECT_EQ(hash_after(world(threads)), reference()) << threads;
}

/// So that the tests here cover both ways in which the rock fails at a joint, and the edges' own.
TEST(FdemSameBits, are_those_of_joints_that_fail_in_all_ways) {
  fdem::World w = world(1);
  for (int i = 0; i < 250; ++i) fdem::step(w);
  EXPECT_EQ(fdem::state_hash(w), reference());
  int failed[3] = {};
  for (Index i = 0; i < w.joints.size(); ++i)
    ++failed[static_cast<int>(fdem::failure_of(w.joints.points.data()[i].point[1]))];
  EXPECT_GT(failed[static_cast<int>(fdem::Failure::torn)], 5);
  EXPECT_GT(failed[static_cast<int>(fdem::Failure::sheared)], 5);
  Scene edge = impact();
  edge.config.joints.criterion = "edge";
  const std::uint64_t by_edge = hash_after(edge.world(1));
  EXPECT_NE(by_edge, reference());
  EXPECT_EQ(hash_after(edge.world(3)), by_edge);
}

TEST(FdemSameBits, for_any_width_of_vector) {
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;  // this processor has no wider ones
    fdem::World w = world(1);
    w.lanes = lanes;
    EXPECT_EQ(hash_after(std::move(w)), reference()) << static_cast<int>(lanes);
  }
}

/// The ledger, too: a hash holds no work of couples.
TEST(FdemSameBits, of_every_number_of_couples_for_any_width_of_vector) {
  for (const char* precision : {"double", "mixed", "single"}) {
    Scene scene = impact();
    scene.config.precision = precision;
    fdem::World one = scene.world(1), w = scene.world(1);
    one.lanes = Lanes::one;
    for (int i = 0; i < 400; ++i) {
      fdem::step(one);
      fdem::step(w);
    }
    ASSERT_EQ(one.couples.size(), w.couples.size());
    ASSERT_GT(w.couples.size(), 100);
    const auto bytes = [](const fdem::World& world, Index i) {
      const fdem::CoupleState& s = world.couples.history.state.data()[i];
      return std::string(reinterpret_cast<const char*>(&s), sizeof s);
    };
    for (Index i = 0; i < w.couples.size(); ++i)
      EXPECT_EQ(bytes(one, i), bytes(w, i)) << precision << ", couple " << i;
    Exec wide = in_precision({}, precision);
    wide.space = Space::shadow;
    fdem::World shadow = fdem::make_world(scene.config, scene.model, wide);
    for (int i = 0; i < 400; ++i) fdem::step(shadow);
    const EnergyBalance host = fdem::energies(w).balance, device = fdem::energies(shadow).balance;
    EXPECT_EQ(device.elastic, host.elastic) << precision;
    EXPECT_EQ(device.friction, host.friction) << precision;
    EXPECT_EQ(device.contact, host.contact) << precision;
    EXPECT_EQ(device.fracture, host.fracture) << precision;
    EXPECT_EQ(device.damping, host.damping) << precision;
    EXPECT_EQ(device.kinetic, host.kinetic) << precision;
  }
}

TEST(FdemSameBits, for_any_margin_of_search) {
  EXPECT_EQ(hash_after(world(1, 0.02)), reference());
  EXPECT_EQ(hash_after(world(1, 0.8)), reference());
}

/// Hexagons in a swarm that flies against a wall at rest, and past a hexagon that comes towards it.
Scene swarm(double margin) {
  Scene scene;
  scene.material(990e6, 0.3, 2700.0);
  scene.config.search.margin = margin;
  scene.config.time.evaluate_every = 20;
  prepare::HexagonField field;
  field.count = 100;
  field.side = 1.0;
  field.gap = 0.02;
  scene.body("swarm", prepare::hexagons(field), 0, {90.0, 40.0});
  field.center = {13.5, 12.0};
  field.count = 1;
  scene.body("other", prepare::hexagons(field), 0, {-60.0, -60.0});
  scene.body("wall", prepare::equilateral_rectangle({{24.0, 10.0}, {4.0, 40.0}}, 2.0));
  scene.support("held", {21.0, -100.0}, {100.0, 100.0}, {"x", "y"}, {}, "wall");
  return scene;
}

TEST(FdemSameBits, for_any_margin_in_a_swarm_that_meets_a_wall) {
  const auto flown = [](double margin, int threads) {
    fdem::World w = swarm(margin).world(threads);
    for (int i = 0; i < 2000; ++i) fdem::step(w);
    return w;
  };
  const fdem::World usual = flown(0.1, 1);
  EXPECT_GT(fdem::energy_split(usual).balance.elastic, 0.0);
  for (const double margin : {0.01, 1.0})
    EXPECT_EQ(fdem::state_hash(flown(margin, 1)), fdem::state_hash(usual)) << margin;
}

/// Blocks that come near each other, touch and part: the step falls and grows with what is near.
TEST(FdemSameBits, for_any_margin_and_space_where_steps_fall_and_grow) {
  Scene scene;
  scene.config.time.evaluate_every = 1;
  scene.material(30e9, 0.2, 2500.0).friction = 0.3;
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.002}, {0.012, 0.004}}, 1e-3));
  for (int i = 0; i < 2; ++i)
    scene.body(i == 0 ? "first" : "second",
               prepare::ringed_disc({4e-3 * i, 1e-4 + 0.001 + 2e-4 * i}, 0.001, 5e-4), 0,
               {3.0, -40.0});
  const auto flown = [&scene](double margin, const Exec& exec) {
    scene.config.search.margin = margin;
    fdem::World w = fdem::make_world(scene.config, scene.model, exec);
    double least = w.next_dt, most = least;
    while (w.step < 1500) {
      const Advanced taken = fdem::advance(w, {1e300, 1500});
      least = std::min(least, taken.dt_min);
      most = std::max(most, taken.dt_max);
    }
    EXPECT_GT(most, 2.0 * least);
    return fdem::state_hash(w);
  };
  const std::uint64_t usual = flown(0.1, {});
  Exec shadow;
  shadow.space = Space::shadow;
  for (const double margin : {0.001, 0.01, 1.0}) EXPECT_EQ(flown(margin, {}), usual) << margin;
  EXPECT_EQ(flown(0.02, shadow), usual);
}

TEST(FdemSearch, is_rare_while_all_fly_together) {
  Scene scene;
  scene.material(990e6, 0.3, 2700.0);
  prepare::HexagonField field;
  field.count = 50;
  field.side = 1.0;
  field.gap = 0.02;
  scene.body("swarm", prepare::hexagons(field), 0, {90.0, 40.0});
  fdem::World w = scene.world();
  for (int i = 0; i < 500; ++i) fdem::step(w);
  EXPECT_LE(w.searches, 2);  // by absolute travel: one in 35 steps
}

TEST(FdemSameBits, in_the_shadow_space_that_refuses_host_reads) {
  Exec exec;
  exec.space = Space::shadow;
  const Scene scene = impact();
  fdem::World w = fdem::make_world(scene.config, scene.model, exec);
  EXPECT_EQ(w.couples.history.state.space(), Space::shadow);
  EXPECT_EQ(w.joints.force.in_double.space(), Space::shadow);
  EXPECT_EQ(hash_after(std::move(w)), reference());
}

/// How many a list of busy items holds for the next step.
Index held_by(const fdem_shared::KeptList& list) {
  std::vector<Index> count;
  copy_to(count, list.count);
  return count.at(0);
}
TEST(FdemSameBits, of_lists_kept_from_step_to_step_and_made_in_each) {
  Exec shadow;
  shadow.space = Space::shadow;
  const Scene scene = impact();
  fdem::World w = fdem::make_world(scene.config, scene.model, shadow);
  Index couples = 0, joints = 0;
  bool made_in_each = false;
  while (w.step < 250) {
    fdem::advance(w, {1e300, w.step + 1});
    if (fdem::keeps_lists(w)) {
      couples = std::max(couples, held_by(w.busy));
      joints = std::max(joints, held_by(w.busy_joints));
    } else {
      made_in_each = true;
      EXPECT_EQ(held_by(w.busy) + held_by(w.busy_joints), 0);
    }
  }
  EXPECT_GT(couples, 5);
  EXPECT_GT(joints, 5);
  EXPECT_TRUE(made_in_each);
  EXPECT_EQ(hash_after(std::move(w)), reference());
}

TEST(FdemSameBits, of_joints_that_wake_in_the_shadow_space) {
  Scene scene = impact();
  scene.config.materials[0].joints = "extrinsic";
  Exec shadow;
  shadow.space = Space::shadow;
  EXPECT_EQ(hash_after(fdem::make_world(scene.config, scene.model, shadow)),
            hash_after(scene.world(2)));
}

/// Rock that is stiffer along its planes, beside rock that is not.
void expect_one_hash_of_bedded_rock(const char* precision) {
  SCOPED_TRACE(precision);
  Scene scene = impact();
  fdem::MaterialConfig disc = scene.config.materials[0];
  disc.name = "shale";
  disc.bedding = {0.5, 0.6, 15e9, 0.15, 6e9};
  scene.config.materials.push_back(disc);
  scene.config.precision = precision;
  scene.config.in_situ.xx_slope = {0.0, 3e6};  // each triangle and joint has its own
  scene.config.in_situ.xx = scene.config.in_situ.yy = -1e3;
  for (std::size_t t = 0; t < scene.model.material.size(); ++t)
    if (scene.model.group[t] == 0 && t % 3 != 0) scene.model.material[t] = 1;
  std::uint64_t expected = 0;
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight})
    for (const int threads : {1, 3}) {
      fdem::World w = scene.world(threads);
      w.lanes = std::min(lanes, widest_lanes());
      const std::uint64_t hash = hash_after(std::move(w));
      if (expected == 0) expected = hash;
      EXPECT_EQ(hash, expected) << static_cast<int>(lanes) << ", " << threads;
    }
  EXPECT_NE(expected, reference());
  Exec shadow = in_precision({}, precision);
  shadow.space = Space::shadow;
  EXPECT_EQ(hash_after(fdem::make_world(scene.config, scene.model, shadow)), expected);
}
TEST(FdemSameBits, of_bedded_rock_for_any_threads_width_of_vector_and_space) {
  expect_one_hash_of_bedded_rock("double");
  expect_one_hash_of_bedded_rock("single");
}

TEST(FdemSameBits, across_a_checkpoint_amid_fracture_on_other_threads) {
  const ScratchFolder folder;
  const Scene scene = impact();
  Exec one, three;
  three.threads = 3;
  // one of these moments is bound to lie between a break and the search that follows
  for (const int moment : {120, 163, 201}) {
    const auto before = make_method(scene.config, scene.model, one);
    for (int i = 0; i < moment; ++i) before->advance({1e300, before->steps() + 1});
    CheckpointWriter writer;
    before->save(writer);
    writer.write(folder / "state.br");
    for (int i = moment; i < 250; ++i) before->advance({1e300, before->steps() + 1});
    const auto after = make_method(scene.config, scene.model, three);
    const CheckpointReader state(folder / "state.br");
    after->load(&state);
    EXPECT_EQ(after->steps(), moment);
    for (int i = moment; i < 250; ++i) after->advance({1e300, after->steps() + 1});
    EXPECT_EQ(after->state_hash(), before->state_hash());
    EXPECT_EQ(after->energy().friction, before->energy().friction);
    EXPECT_EQ(after->energy().fracture, before->energy().fracture);
    EXPECT_EQ(after->energy().error_relative, before->energy().error_relative);
    EXPECT_EQ(before->state_hash(), reference());
  }
}

/// @returns the hash
std::uint64_t expect_one_hash(const char* precision) {
  SCOPED_TRACE(precision);
  Scene scene = impact();
  scene.config.precision = precision;
  std::uint64_t expected = 0;
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight})
    for (const int threads : {1, 2}) {
      fdem::World w = scene.world(threads);
      EXPECT_EQ(w.joints.force.in_double.size(), 0);
      w.lanes = std::min(lanes, widest_lanes());
      const std::uint64_t hash = hash_after(std::move(w));
      if (expected == 0) expected = hash;
      EXPECT_EQ(hash, expected) << static_cast<int>(lanes) << ", " << threads;
    }
  EXPECT_NE(expected, reference());
  Exec shadow = in_precision({}, precision);
  shadow.space = Space::shadow;
  EXPECT_EQ(hash_after(fdem::make_world(scene.config, scene.model, shadow)), expected);
  return expected;
}

TEST(FdemSameBits, in_other_precisions_for_any_threads_width_of_vector_and_space) {
  EXPECT_NE(expect_one_hash("mixed"), expect_one_hash("single"));
}

void expect_same_across_a_checkpoint(const char* precision) {
  SCOPED_TRACE(precision);
  const ScratchFolder folder;
  Scene scene = impact();
  scene.config.precision = precision;
  const auto before = make_method(scene.config, scene.model, {});
  for (int i = 0; i < 163; ++i) before->advance({1e300, before->steps() + 1});
  CheckpointWriter writer;
  before->save(writer);
  writer.write(folder / "state.br");
  const CheckpointReader state(folder / "state.br");
  const auto after = make_method(scene.config, scene.model, {});
  after->load(&state);
  for (int i = 163; i < 250; ++i) {
    before->advance({1e300, before->steps() + 1});
    after->advance({1e300, after->steps() + 1});
  }
  EXPECT_EQ(after->state_hash(), before->state_hash());
  EXPECT_EQ(after->energy().friction, before->energy().friction);
  scene.config.precision = "double";
  EXPECT_THROW(make_method(scene.config, scene.model, {})->load(&state), CheckpointError);
}
TEST(FdemSameBits, in_other_precisions_across_a_checkpoint_that_double_refuses) {
  expect_same_across_a_checkpoint("mixed");
  expect_same_across_a_checkpoint("single");
}

TEST(FdemSameBits, one_changed_bit_changes_the_hash) {
  fdem::World w = world(1);
  const std::uint64_t hash = fdem::state_hash(w);
  double& x = w.triangles.nodes.data()[7].at[1].position.x;
  x = std::nextafter(x, 1e9);
  EXPECT_NE(fdem::state_hash(w), hash);
}

}  // namespace fdem_same_bits_test
}  // namespace breccia
