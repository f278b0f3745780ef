#pragma once
// The small slab with an option of its links, run in every way that must give the same bits.

#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "run/method/dem_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::testing {

struct SlabEnd {
  std::uint64_t hash;
  EnergyBalance energy;
};

class SmallSlabRuns {
 public:
  static constexpr int steps = 500;  // the slab breaks from the 200th on

  explicit SmallSlabRuns(std::vector<std::string> keys)
      : keys_(std::move(keys)),
        model_(build_model(config(), std::string(source_dir) + "/cases/rc_slab")),
        alone_(to_end(world())),
        reference_(end_of(alone_)) {}

  dem::Config config(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> overrides = keys_;
    overrides.insert(overrides.end(), more.begin(), more.end());
    return read_case<dem::Config>(std::string(source_dir) + "/cases/rc_slab/small.toml", overrides);
  }
  dem::World world(const Exec& exec = {}) const { return dem::make_world(config(), model_, exec); }
  SlabEnd end_of(const dem::Config& other) const {
    dem::World w = to_end(dem::make_world(other, model_, {}));
    return end_of(w);
  }
  const SlabEnd& reference() const { return reference_; }

  void expect_same_on_threads_packs_and_in_the_shadow_space(const std::vector<Index>& tiles = {
                                                                0}) const {
    Exec three, shadow;
    three.threads = 3;
    shadow.space = Space::shadow;
    expect_same(to_end(world(three)));
    for (const Index count : tiles) {
      shadow.tiles = count;
      expect_same(to_end(world(shadow)));
    }
    for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
      if (lanes > widest_lanes()) continue;
      dem::World w = world();
      w.lanes = lanes;
      expect_same(to_end(std::move(w)));
    }
  }
  /// @param kept  an array that links with the option keep
  template <class Kept>
  void expect_same_on_ranks(const Kept& kept) const {
    simulate_ranks(3, 60, [&](Communicator& ranks) {
      dem::World whole = world();
      dem::World part = dem::share_out(whole, ranks, {}, Space::host);
      for (int i = 0; i < steps; ++i) dem::step(part);
      dem::collect(part, whole);
      if (ranks.rank() != 0) return;
      EXPECT_EQ(dem::state_hash(whole), reference_.hash);
      const auto &ours = kept(whole), &theirs = kept(alone_);
      ASSERT_GT(theirs.size(), 0);
      ASSERT_EQ(ours.size(), theirs.size());
      for (Index i = 0; i < theirs.size(); ++i) ASSERT_EQ(ours.data()[i], theirs.data()[i]) << i;
    });
  }
  void expect_same_across_a_checkpoint() const {
    const ScratchFolder folder;
    for (const char* precision : {"double", "mixed", "single"}) {
      const dem::Config in = config({std::string("precision=") + precision});
      const Exec exec = in_precision({}, in.precision);
      const auto whole = make_method(in, model_, exec), before = make_method(in, model_, exec);
      for (int i = 0; i < 300; ++i) whole->advance({}), before->advance({});
      CheckpointWriter writer;
      before->save(writer);
      writer.write(folder / "state.br");
      const auto after = make_method(in, model_, exec);
      const CheckpointReader state(folder / "state.br");
      after->load(&state);
      for (int i = 0; i < 200; ++i) whole->advance({}), after->advance({});
      EXPECT_EQ(after->state_hash(), whole->state_hash()) << precision;
    }
  }

 private:
  static dem::World to_end(dem::World w) {
    while (w.step < steps) dem::advance(w, {1e300, steps});
    EXPECT_GT(dem::count(w).broken_of(dem::LinkKind::concrete), 50);
    return w;
  }
  static SlabEnd end_of(dem::World& w) { return {dem::state_hash(w), dem::balance(w)}; }
  void expect_same(dem::World w) const {
    const SlabEnd end = end_of(w);
    EXPECT_EQ(end.hash, reference_.hash);
    EXPECT_EQ(end.energy.fracture, reference_.energy.fracture);
    EXPECT_EQ(end.energy.elastic, reference_.energy.elastic);
    EXPECT_EQ(end.energy.damping, reference_.energy.damping);
  }

  std::vector<std::string> keys_;
  dem::Model model_;
  dem::World alone_;
  SlabEnd reference_;
};

}  // namespace breccia::testing
