// The same bits for any number of ranks: the slab on simulated ones.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "io/case_file.hpp"
#include "prepare/build.hpp"
#include "run/dem_method.hpp"

namespace breccia {
namespace {

const std::string small_case = BR_SOURCE_DIR "/cases/rc_slab/small.toml";
constexpr int steps = 700;

dem::Config small_config(const std::vector<std::string>& overrides = {}) {
  return read_case<dem::Config>(small_case, overrides);
}
const dem::Model& small_model() {
  static const dem::Model model = build_model(small_config(), BR_SOURCE_DIR "/cases/rc_slab");
  return model;
}

/// What a run leaves behind.
struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t searches = 0;
  double energies[4] = {};
  Index broken = 0, candidates = 0;
  bool operator==(const Outcome&) const = default;
};
Outcome outcome_of(dem::World& w) {
  const EnergyBalance e = dem::balance(w);
  return {dem::state_hash(w),
          w.searches,
          {e.kinetic, e.elastic, e.friction, e.fracture},
          dem::count(w).broken_concrete,
          w.contacts.size()};
}

const Outcome& alone() {
  static const Outcome outcome = [] {
    dem::World w = dem::make_world(small_config(), small_model(), Exec{});
    for (int i = 0; i < steps; ++i) dem::step(w);
    return outcome_of(w);
  }();
  return outcome;
}

struct Shared {
  Outcome outcome;
  DomainCounts counts;
};
Shared on_ranks(int count, const std::vector<std::string>& overrides = {}, int threads = 1) {
  Shared shared;
  const dem::Config config = small_config(overrides);
  small_model();
  simulate_ranks(count, static_cast<std::uint64_t>(count), [&](Communicator& ranks) {
    Exec exec;
    exec.threads = threads;
    dem::World whole = dem::make_world(config, small_model(), exec);
    dem::World part = dem::share_out(whole, ranks, config.domain);
    for (int i = 0; i < steps; ++i) dem::step(part);
    dem::collect(part, whole);
    if (ranks.rank() == 0) shared = {outcome_of(whole), part.domain.counts};
  });
  return shared;
}

TEST(DemRanks, leave_the_same_state_ledger_and_contacts_for_any_number_of_them) {
  EXPECT_GT(alone().broken, 50);
  for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16}) {
    const Shared shared = on_ranks(count);
    EXPECT_EQ(shared.outcome, alone()) << count << " ranks";
    EXPECT_GT(shared.counts.migrations, 1) << count << " ranks";
  }
}

TEST(DemRanks, leave_the_same_state_however_borders_and_copies_are_kept) {
  EXPECT_EQ(on_ranks(3, {"domain.balance=false"}).outcome, alone());
  const Shared eager = on_ranks(4, {"domain.imbalance=0", "domain.refinement=10"});
  EXPECT_EQ(eager.outcome, alone());
  EXPECT_GT(eager.counts.cuts, 3);
  EXPECT_EQ(on_ranks(5, {"domain.buffer=0"}).outcome, alone());
  EXPECT_EQ(on_ranks(2, {"domain.buffer=2", "domain.refinement=2"}).outcome, alone());
  EXPECT_EQ(on_ranks(3, {}, 2).outcome, alone());
}

TEST(DemRanks, leave_the_same_state_for_any_margin_of_search) {
  EXPECT_EQ(on_ranks(3, {"search.margin=0.05"}).outcome.hash, alone().hash);
  EXPECT_EQ(on_ranks(4, {"search.margin=1.0"}).outcome.hash, alone().hash);
  EXPECT_EQ(on_ranks(2, {"search.every=10"}).outcome.hash, alone().hash);
}

/// The file of a run on `first` ranks, saved on the way, and the hash at the end of it or of the
/// same run continued from a checkpoint on `second` ranks.
struct Journal {
  std::string checkpoint;
  std::uint64_t hash = 0;
  double friction = 0.0, error = 0.0;
  std::string frame;
  bool operator==(const Journal&) const = default;
};
std::string bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
Journal journal(int count, const std::string& folder, const std::string& from) {
  Journal j;
  const dem::Config config = small_config();
  small_model();
  simulate_ranks(count, 77, [&](Communicator& ranks) {
    const auto method =
        make_dem_method(config, small_model(), Exec{}, count > 1 ? &ranks : nullptr);
    if (ranks.rank() != 0) {
      EXPECT_EQ(method->follow(), 3);
      return;
    }
    if (!from.empty()) method->load(CheckpointReader(from));
    while (method->steps() < 450) {
      method->advance({1e300, method->steps() + 1});
      if (method->steps() % 7 == 0) method->energy();  // looking changes nothing
    }
    CheckpointWriter writer;
    method->save(writer);
    writer.write(folder + "/state.br");
    j.checkpoint = bytes_of_file(folder + "/state.br");
    while (method->steps() < steps) method->advance({1e300, steps});
    j.hash = method->state_hash();
    j.friction = method->energy().friction;
    j.error = method->energy().error_relative;
    for (const FrameField& field : method->frame().line_fields)
      j.frame.append(reinterpret_cast<const char*>(field.values.data()),
                     field.values.size() * sizeof(float));
    method->dismiss(3);
  });
  return j;
}

TEST(DemRanks, write_the_same_bytes_and_go_on_from_those_of_any_other_number_of_ranks) {
  const std::string folder = std::filesystem::temp_directory_path() / "breccia_dem_ranks";
  std::filesystem::create_directories(folder);
  const Journal expected = journal(1, folder, "");
  EXPECT_EQ(expected.hash, alone().hash);
  EXPECT_EQ(journal(3, folder, ""), expected);
  EXPECT_EQ(journal(5, folder, folder + "/state.br"), expected);
  EXPECT_EQ(journal(2, folder, folder + "/state.br"), expected);
  EXPECT_EQ(journal(1, folder, folder + "/state.br"), expected);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace breccia
