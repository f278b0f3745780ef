// Equal bits for any number of ranks: the slab on simulated ones.

#include <gtest/gtest.h>

#include <map>

#include "confined_concrete.hpp"
#include "dem/ranks.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace dem_ranks_test {

using namespace mpi_testing;

constexpr int steps = 700;  ///< of the slab: elements have changed ranks for a second time
constexpr int amid = 400;   ///< of the slab: over a thousand links are broken then
constexpr int many = 200;   ///< of the piece: 1,491 links are broken then

const Outcome& slab_alone() {
  static const Outcome outcome = alone(slab(), steps);
  return outcome;
}
const Outcome& slab_amid() {
  static const Outcome outcome = alone(slab(), amid);
  return outcome;
}

TEST(DemRanks, leave_the_same_state_ledger_and_contacts_for_any_number_of_them) {
  EXPECT_GT(slab_alone().cracks, 50U);
  for (const int count : {1, 2, 3, 5, 10, 32}) {
    const Shared shared = on_ranks(count, slab(), steps);
    EXPECT_EQ(shared.outcome, slab_alone()) << count << " ranks";
    if (count > 3) {
      EXPECT_GT(shared.counts.migrations, 1) << count << " ranks";
    }
  }
}

TEST(DemRanks, leave_the_same_state_of_a_piece_that_flies_apart) {
  const Slab piece = slab_piece();
  const Outcome expected = alone(piece, 300);
  for (const int count : {2, 3, 4, 6, 7, 9, 13, 25})
    EXPECT_EQ(on_ranks(count, piece, 300).outcome, expected) << count << " ranks";
}

TEST(DemRanks, leave_the_same_state_on_any_number_of_threads_each) {
  const Slab piece = slab_piece();
  const Outcome expected = alone(piece, many);
  EXPECT_GT(expected.cracks, 50U);
  for (const auto& [count, threads] : {std::pair{1, 3}, {2, 2}, {3, 7}, {7, 2}, {32, 3}})
    EXPECT_EQ(on_ranks(count, piece, many, {}, threads).outcome, expected)
        << count << " ranks of " << threads << " threads";
}

// Stands for ranks that compute on GPUs: their arrays are out of the host's reach.
TEST(DemRanks, leave_the_same_state_where_arrays_lie_in_another_space) {
  const Shared shared = on_ranks(5, slab(), steps, {}, 1, Space::shadow);
  EXPECT_EQ(shared.outcome, slab_alone());
  EXPECT_GT(shared.counts.migrations, 1);
}

// Links of several groups meet at an element: their sums go by tiles of global ids.
TEST(DemRanks, leave_the_same_state_of_a_fabric_of_several_laws) {
  Slab cylinder;
  cylinder.config =
      read_case<dem::Config>(std::string(source_dir) + "/cases/split_cylinder/small.toml",
                             {"body.cylinder.pack.count=300", "body.cylinder.velocity=[0, 0, -2]"});
  cylinder.model = std::make_shared<const dem::Model>(build_model(cylinder.config, ""));
  const dem::World world = cylinder.world();
  EXPECT_GT(world.concrete.groups.size(), 1U);
  const Outcome expected = alone(cylinder, 80);
  for (const Space space : {Space::host, Space::shadow})
    EXPECT_EQ(on_ranks(3, cylinder, 80, {}, 1, space).outcome, expected);
}

TEST(DemRanks, leave_the_same_state_however_borders_and_copies_are_kept) {
  EXPECT_GT(slab_amid().cracks, 1000U);
  DomainConfig config;
  config.balance = false;
  EXPECT_EQ(on_ranks(3, slab(), amid, config).outcome, slab_amid());
  config = {};
  config.imbalance = 0.0;
  config.refinement = 10;
  const Shared eager = on_ranks(4, slab(), amid, config);
  EXPECT_EQ(eager.outcome, slab_amid());
  EXPECT_GT(eager.counts.cuts, 3);
  config = {};
  config.buffer = 0.0;
  EXPECT_EQ(on_ranks(5, slab(), amid, config).outcome, slab_amid());
  config.buffer = 2.0;
  config.refinement = 2;
  EXPECT_EQ(on_ranks(2, slab(), amid, config).outcome, slab_amid());
}

TEST(DemRanks, leave_the_same_state_in_mixed_precision) {
  Slab piece = slab_piece();
  const std::uint64_t in_double = alone(piece, many).hash;
  piece.config.precision = "mixed";
  const Outcome expected = alone(piece, many);
  EXPECT_GT(expected.cracks, 50U);
  EXPECT_NE(expected.hash, in_double);
  for (const auto& [count, threads] : {std::pair{1, 3}, {2, 1}, {5, 2}, {8, 1}, {32, 1}})
    EXPECT_EQ(on_ranks(count, piece, many, {}, threads).outcome, expected)
        << count << " ranks of " << threads << " threads";
  EXPECT_EQ(on_ranks(3, piece, many, {}, 1, Space::shadow).outcome, expected);
}

TEST(DemRanks, leave_the_same_state_of_links_that_wear_and_crush) {
  for (const char* precision : {"double", "mixed"}) {
    Slab piece = slab_piece();
    testing::confine(piece.config.materials[0]);
    piece.config.materials[2].rib_height = 1e-4;  // of bonds
    piece.config.precision = precision;
    const Outcome expected = alone(piece, many);
    EXPECT_GT(expected.cracks, 50U);
    for (const int count : {2, 5, 32})
      EXPECT_EQ(on_ranks(count, piece, many).outcome, expected) << count << " ranks";
  }
}

TEST(DemRanks, leave_the_same_state_for_any_margin_of_search) {
  EXPECT_EQ(on_ranks(3, slab({"search.margin=0.05"}), amid).outcome.hash, slab_amid().hash);
  EXPECT_EQ(on_ranks(4, slab({"search.margin=1.0"}), amid).outcome.hash, slab_amid().hash);
  EXPECT_EQ(on_ranks(2, slab({"search.every=10"}), amid).outcome.hash, slab_amid().hash);
}

TEST(DemRanks, write_the_same_bytes_and_go_on_from_those_of_any_other_number_of_ranks) {
  const Folder folder("dem_ranks");
  const std::string state = folder.file("state.br");
  const Journal expected = journal(1, slab(), 250, amid, state, "");
  EXPECT_EQ(expected.hash, slab_amid().hash);
  EXPECT_EQ(journal(3, slab(), 250, amid, state, ""), expected);
  for (const int count : {5, 2, 1})
    EXPECT_EQ(journal(count, slab(), 250, amid, state, state), expected);
}

/// Of each element by global id, on the rank that owns it, and the others' ghosts.
struct CriticalNumbers {
  std::map<GlobalId, double> owned;
  std::vector<std::pair<GlobalId, double>> ghosts;
};

// On GPUs the least of all elements that are here is noted, whoever owns them.
TEST(DemRanks, hold_no_copy_whose_critical_number_is_below_its_owners) {
  constexpr int count = 3;
  std::vector<CriticalNumbers> of_rank(count);
  const Slab piece = slab_piece();
  simulate_ranks(count, 5, [&](Communicator& ranks) {
    auto whole = piece.world(1);
    auto part = share_out(whole, ranks, {});
    for (int i = 0; i < 200; ++i) step(part);
    CriticalNumbers& own = of_rank[static_cast<std::size_t>(ranks.rank())];
    for (Index e = 0; e < part.elements.size(); ++e) {
      const GlobalId id = part.elements.id.data()[e];
      const double critical = part.critical.data()[e];
      if (part.domain.owns(e))
        own.owned[id] = critical;
      else
        own.ghosts.emplace_back(id, critical);
    }
  });
  std::map<GlobalId, double> owned;
  for (const CriticalNumbers& own : of_rank) owned.insert(own.owned.begin(), own.owned.end());
  int equal = 0, above = 0;
  for (const CriticalNumbers& own : of_rank)
    for (const auto& [id, critical] : own.ghosts) {
      EXPECT_GE(critical, owned.at(id)) << "element " << id;
      ++(critical > owned.at(id) ? above : equal);
    }
  EXPECT_GT(equal, 0);
  EXPECT_GT(above, 100);
}

}  // namespace dem_ranks_test
}  // namespace breccia
