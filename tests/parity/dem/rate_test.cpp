// Equal bits for links whose strength depends on their strain rate and whose softening has a
// knee: threads, packs, the shadow space, ranks, precision, across a checkpoint.
#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "run/method/dem_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace rate_test {

constexpr int steps = 500;  // the slab breaks from the 200th on

dem::Config config(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"material.c30.rate=malvar_ross",
                                     "material.c30.knee_strength=0.3333"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_case<dem::Config>(std::string(source_dir) + "/cases/rc_slab/small.toml", overrides);
}
const dem::Model& model() {
  static const dem::Model built = build_model(config(), std::string(source_dir) + "/cases/rc_slab");
  return built;
}
struct End {
  std::uint64_t hash;
  EnergyBalance energy;
};
End end_of(dem::World w) {
  while (w.step < steps) dem::advance(w, {1e300, steps});
  EXPECT_GT(dem::count(w).broken_of(dem::LinkKind::concrete), 50);
  return {dem::state_hash(w), dem::balance(w)};
}
dem::World world(const Exec& exec = {}) {
  return dem::make_world(config(), model(), exec);
}
const End& reference() {
  static const End end = end_of(world());
  return end;
}
void expect_same(const End& end) {
  EXPECT_EQ(end.hash, reference().hash);
  EXPECT_EQ(end.energy.fracture, reference().energy.fracture);
  EXPECT_EQ(end.energy.elastic, reference().energy.elastic);
}

TEST(RateBits, differ_from_those_of_links_without_a_rate_or_without_a_knee) {
  dem::Config none = config();
  none.materials[0].rate = "none";
  for (const dem::MaterialConfig& m : none.materials) EXPECT_EQ(m.rate, "none");
  EXPECT_NE(end_of(dem::make_world(none, model(), {})).hash, reference().hash);
  dem::Config straight = config();
  straight.materials[0].knee_strength = 0.0;
  EXPECT_NE(end_of(dem::make_world(straight, model(), {})).hash, reference().hash);
}

TEST(RateBits, are_the_same_on_threads_packs_and_in_the_shadow_space) {
  Exec three, shadow;
  three.threads = 3;
  shadow.space = Space::shadow;
  expect_same(end_of(world(three)));
  expect_same(end_of(world(shadow)));
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;
    dem::World w = world();
    w.lanes = lanes;
    expect_same(end_of(std::move(w)));
  }
}

TEST(RateBits, are_the_same_on_ranks) {
  simulate_ranks(3, 60, [&](Communicator& ranks) {
    dem::World whole = world();
    dem::World part = dem::share_out(whole, ranks, {}, Space::host);
    for (int i = 0; i < steps; ++i) dem::step(part);
    dem::collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(dem::state_hash(whole), reference().hash);
    const dem::World alone = [] {
      dem::World w = world();
      while (w.step < steps) dem::advance(w, {1e300, steps});
      return w;
    }();
    ASSERT_EQ(whole.concrete.rate.size(), alone.concrete.rate.size());
    for (Index i = 0; i < alone.concrete.rate.size(); ++i)
      ASSERT_EQ(whole.concrete.rate.data()[i], alone.concrete.rate.data()[i]) << i;
  });
}

TEST(RateBits, are_the_same_across_a_checkpoint) {
  const ScratchFolder folder;
  for (const char* precision : {"double", "mixed", "single"}) {
    const dem::Config in = config({std::string("precision=") + precision});
    const Exec exec = in_precision({}, in.precision);
    const auto whole = make_method(in, model(), exec), before = make_method(in, model(), exec);
    for (int i = 0; i < 300; ++i) whole->advance({}), before->advance({});
    CheckpointWriter writer;
    before->save(writer);
    writer.write(folder / "state.br");
    const auto after = make_method(in, model(), exec);
    const CheckpointReader state(folder / "state.br");
    after->load(&state);
    for (int i = 0; i < 200; ++i) whole->advance({}), after->advance({});
    EXPECT_EQ(after->state_hash(), whole->state_hash()) << precision;
  }
}

}  // namespace rate_test
}  // namespace breccia
