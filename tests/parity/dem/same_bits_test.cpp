// Equal bits for any thread count, width of vector, search margin, and across a checkpoint.

#include <gtest/gtest.h>

#include "confined_concrete.hpp"
#include "dem/observe.hpp"
#include "domain/simulated_ranks.hpp"
#include "exec/error.hpp"
#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "run/method/dem_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace dem_same_bits_test {

const std::string small_case = std::string(source_dir) + "/cases/rc_slab/small.toml";

dem::Config small_config(const std::vector<std::string>& overrides = {}) {
  return read_case<dem::Config>(small_case, overrides);
}
const dem::Model& small_model() {
  static const dem::Model model =
      build_model(small_config(), std::string(source_dir) + "/cases/rc_slab");
  return model;
}
dem::World small_world(int threads, const std::vector<std::string>& overrides = {}) {
  Exec exec;
  exec.threads = threads;
  return dem::make_world(small_config(overrides), small_model(), exec);
}
/// Hash after the impact has begun to break the slab.
std::uint64_t hash_after(dem::World w, int steps = 400) {
  while (w.step < steps) dem::advance(w, {1e300, steps});
  EXPECT_GT(dem::count(w).broken_of(dem::LinkKind::concrete), 100);
  return dem::state_hash(w);
}

std::uint64_t reference() {
  static const std::uint64_t hash = hash_after(small_world(1));
  return hash;
}

TEST(SameBits, for_any_number_of_threads) {
  for (const int threads : {2, 3, 7})
    EXPECT_EQ(hash_after(small_world(threads)), reference()) << threads;
}

TEST(SameBits, for_any_width_of_vector) {
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;  // this processor has no wider ones
    dem::World w = small_world(1);
    w.lanes = lanes;
    EXPECT_EQ(hash_after(std::move(w)), reference()) << static_cast<int>(lanes);
  }
}

TEST(SameBits, for_any_width_where_supports_move_and_motion_is_damped) {
  dem::Config config = small_config();
  config.local_damping = 0.3;
  config.gravity = {0.0, 0.0, -9.81};
  ASSERT_GE(config.supports.size(), 2U);
  config.supports[0].velocity = {0.1, 0.0, 2.0};
  config.supports[0].ramp = 2e-5;
  config.supports[1].fix = {"y", "spin_x"};
  std::uint64_t hash = 0;
  EnergyBalance energy{};
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;
    dem::World w = dem::make_world(config, small_model(), {});
    w.lanes = lanes;
    for (int i = 0; i < 200; ++i) dem::step(w);
    const EnergyBalance now = dem::balance(w);
    if (lanes == Lanes::one) {
      hash = dem::state_hash(w);
      energy = now;
      EXPECT_GT(energy.work, 0.0);
      EXPECT_GT(energy.damping, 0.0);
    }
    EXPECT_EQ(dem::state_hash(w), hash) << static_cast<int>(lanes);
    EXPECT_EQ(now.kinetic, energy.kinetic) << static_cast<int>(lanes);
    EXPECT_EQ(now.work, energy.work) << static_cast<int>(lanes);
    EXPECT_EQ(now.damping, energy.damping) << static_cast<int>(lanes);
  }
}

TEST(SameBits, for_any_margin_and_moment_of_search) {
  EXPECT_EQ(hash_after(small_world(1, {"search.margin=0.05"})), reference());
  EXPECT_EQ(hash_after(small_world(2, {"search.margin=1.0"})), reference());
  EXPECT_EQ(hash_after(small_world(2, {"search.every=10"})), reference());
}

TEST(SameBits, in_the_shadow_space_that_refuses_host_reads) {
  Exec exec;
  exec.space = Space::shadow;
  dem::World w = dem::make_world(small_config(), small_model(), exec);
  EXPECT_EQ(w.contacts.history.state.space(), Space::shadow);
  EXPECT_EQ(w.link_sums.space(), Space::shadow);
  EXPECT_EQ(hash_after(std::move(w)), reference());
}

TEST(SameBits, across_a_checkpoint_on_other_threads) {
  const ScratchFolder folder;
  const dem::Config config = small_config();
  Exec one, three;
  three.threads = 3;
  const auto before = make_method(config, small_model(), one);
  for (int i = 0; i < 500; ++i) before->advance({});
  CheckpointWriter writer;
  before->save(writer);
  writer.write(folder / "state.br");
  for (int i = 0; i < 400; ++i) before->advance({});

  const auto after = make_method(config, small_model(), three);
  const CheckpointReader state(folder / "state.br");
  after->load(&state);
  EXPECT_EQ(after->steps(), 500);
  for (int i = 0; i < 400; ++i) after->advance({});
  EXPECT_EQ(after->state_hash(), before->state_hash());
  EXPECT_EQ(after->energy().friction, before->energy().friction);
  EXPECT_EQ(after->energy().error_relative, before->energy().error_relative);
}

/// The whole impact with numbers stored, or computed, too, in single precision.
std::uint64_t hash_in(Precision precision, int threads, Lanes lanes, Space space = Space::host) {
  Exec exec;
  exec.threads = threads;
  exec.space = space;
  exec.precision = precision;
  dem::World w = dem::make_world(small_config(), small_model(), exec);
  w.lanes = std::min(lanes, widest_lanes());
  EXPECT_EQ(w.concrete.kept.in_double.opening.size(), 0);
  return hash_after(std::move(w));
}

TEST(SameBits, in_mixed_and_single_precision_for_any_threads_width_of_vector_and_space) {
  std::uint64_t other = reference();
  for (const Precision precision : {Precision::mixed, Precision::single}) {
    const std::uint64_t expected = hash_in(precision, 1, Lanes::one);
    EXPECT_NE(expected, other);
    other = expected;
    EXPECT_EQ(hash_in(precision, 1, Lanes::four), expected);
    EXPECT_EQ(hash_in(precision, 1, Lanes::eight), expected);
    EXPECT_EQ(hash_in(precision, 3, Lanes::eight), expected);
    EXPECT_EQ(hash_in(precision, 2, Lanes::eight, Space::shadow), expected);
  }
}

TEST(SameBits, in_mixed_and_single_precision_across_a_checkpoint_that_others_refuse) {
  for (const char* precision : {"mixed", "single"}) {
    const ScratchFolder folder;
    const dem::Config config = small_config({std::string("precision=") + precision});
    const auto before = make_method(config, small_model(), {});
    for (int i = 0; i < 500; ++i) before->advance({});
    CheckpointWriter writer;
    before->save(writer);
    writer.write(folder / "state.br");
    for (int i = 0; i < 200; ++i) before->advance({});
    const CheckpointReader state(folder / "state.br");
    const auto after = make_method(config, small_model(), {});
    after->load(&state);
    for (int i = 0; i < 200; ++i) after->advance({});
    EXPECT_EQ(after->state_hash(), before->state_hash());
    EXPECT_THROW(make_method(small_config(), small_model(), {})->load(&state), CheckpointError);
  }
}

TEST(SameBits, in_mixed_and_single_precision_on_ranks) {
  constexpr std::int64_t steps = 300;
  for (const char* precision : {"mixed", "single"}) {
    const dem::Config config = small_config({std::string("precision=") + precision});
    const auto alone = make_method(config, small_model(), {});
    while (alone->steps() < steps) alone->advance({1e300, steps});
    const std::uint64_t hash = alone->state_hash();
    simulate_ranks(3, 5, [&](Communicator& ranks) {
      const auto part = make_method(config, small_model(), {}, &ranks);
      while (part->steps() < steps) part->advance({1e300, steps});
      const std::uint64_t together = part->state_hash();
      if (ranks.rank() != 0) return;
      EXPECT_EQ(together, hash) << precision;
    });
  }
}

/// Concrete that is bounded under pressure writes the free length of its links, too.
TEST(SameBits, of_links_that_wear_and_crush) {
  dem::Config config = small_config();
  testing::confine(config.materials[0]);
  config.materials[0].friction_cap = 1e6;  // bounds friction from 5.7 MPa on
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    config.materials[0].friction_bound = precision == Precision::mixed ? "smooth" : "sharp";
    config.materials[0].criterion = precision == Precision::mixed ? "corner" : "hyperbola";
    std::uint64_t hash = 0;
    EnergyBalance energy{};
    const auto expect_same = [&](int threads, Lanes lanes, Space space) {
      Exec exec;
      exec.threads = threads;
      exec.space = space;
      exec.precision = precision;
      dem::World w = dem::make_world(config, small_model(), exec);
      const Buffer<double> before = w.concrete.length;
      w.lanes = std::min(lanes, widest_lanes());
      for (int i = 0; i < 300; ++i) dem::step(w);
      const EnergyBalance now = dem::balance(w);
      if (hash == 0) {
        hash = dem::state_hash(w);
        energy = now;
        int shorter = 0;
        for (Index i = 0; i < before.size(); ++i)
          shorter += w.concrete.length.data()[i] < before.data()[i] ? 1 : 0;
        EXPECT_GT(shorter, 100);
        EXPECT_GT(dem::count(w).broken_of(dem::LinkKind::concrete), 100);
        EXPECT_LT(energy.error_relative, 1e-3);
      }
      EXPECT_EQ(dem::state_hash(w), hash) << threads << ", " << static_cast<int>(lanes);
      EXPECT_EQ(now.kinetic, energy.kinetic);
      EXPECT_EQ(now.elastic, energy.elastic);
      EXPECT_EQ(now.plastic, energy.plastic);
      EXPECT_EQ(now.fracture, energy.fracture);
      EXPECT_EQ(now.friction, energy.friction);
    };
    expect_same(1, Lanes::one, Space::host);
    expect_same(1, Lanes::four, Space::host);
    expect_same(2, Lanes::eight, Space::host);
    expect_same(1, Lanes::eight, Space::shadow);
  }
}

TEST(SameBits, one_changed_bit_changes_the_hash) {
  dem::World w = small_world(1);
  const std::uint64_t hash = dem::state_hash(w);
  double& x = w.elements.state.data()[7].position.x;
  x = std::nextafter(x, 1e9);
  EXPECT_NE(dem::state_hash(w), hash);
}

}  // namespace dem_same_bits_test
}  // namespace breccia
