// Records that few items have: made, moved, copied between spaces, sent and saved.

#include "core/rare_array.hpp"

#include <gtest/gtest.h>

#include "domain/redistribute.hpp"
#include "domain/simulated_ranks.hpp"
#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "run/method/state_array.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace rare_array_test {

struct Scar {
  double depth;
  double since = -1.0;  ///< below 0: never

  template <class Visit>
  static void each_member(Visit&& member) {
    member("depth", "m", &Scar::depth);
    member("since", "s", &Scar::since);
  }
};

struct Trees {
  Buffer<GlobalId> id;
  RareArray<Scar> scars;
  template <class Visit>
  void each_field(Visit&& field) {
    field("id", "-", id);
    field("scarred", "SI", scars);
  }
};

/// Trees 0 to count - 1; every third has a scar as deep as its number.
Trees forest(Index count) {
  Trees trees;
  resize_fields(trees, count);
  for (Index i = 0; i < count; ++i) {
    trees.id.data()[i] = i;
    if (i % 3 == 1) trees.scars.make(i) = {static_cast<double>(i), 0.5};
  }
  return trees;
}
void expect_own_scars(const Trees& trees) {
  for (Index i = 0; i < trees.id.size(); ++i) {
    const Index number = trees.id.data()[i];
    const Scar scar = trees.scars.item(i);
    EXPECT_EQ(scar.depth, number % 3 == 1 ? number : 0.0) << number;
    EXPECT_EQ(scar.since, number % 3 == 1 ? 0.5 : -1.0) << number;
  }
}

TEST(RareArray, holds_records_of_those_items_alone_that_have_one) {
  Trees trees = forest(30);
  expect_own_scars(trees);
  EXPECT_EQ(trees.scars.records(), 10);
  trees.scars.set(0, Scar{});  // as it is without one
  EXPECT_EQ(trees.scars.records(), 10);
  trees.scars.set(0, {0.0, 0.5});
  EXPECT_EQ(trees.scars.records(), 11);
  trees.scars.set(0, Scar{});
  EXPECT_EQ(trees.scars.item(0).since, -1.0);
}

TEST(RareArray, forgets_the_records_of_items_that_are_dropped) {
  Trees trees = forest(30);
  resize_fields(trees, 6);
  EXPECT_EQ(trees.scars.records(), 2);
  resize_fields(trees, 30);
  for (Index i = 6; i < 30; ++i) EXPECT_EQ(trees.scars.find(i), nullptr);
  resize_fields(trees, 0);
  EXPECT_EQ(trees.scars.records(), 0);
}

TEST(RareArray, follows_items_to_other_places) {
  Trees trees = forest(9);
  Buffer<Index> source;
  copy_to(source, std::vector<Index>{7, 1, 0, 4, 8});
  gather_fields(Exec{}, source, trees);
  expect_own_scars(trees);
  EXPECT_EQ(trees.scars.records(), 3);
}

TEST(RareArray, lets_items_of_a_device_wait_until_there_is_room) {
  RareArray<Scar> scars(Space::shadow);
  scars.resize(20);
  const Index room = scars.room();
  ASSERT_LT(room, 20);
  const auto mark = [&](Index from) {
    const KernelScope scope;
    const RareView<Scar> view = scars.view();
    for (Index i = from; i < 20; ++i)
      if (Scar* const scar = view.find_or_make(i)) scar->depth = i;
  };
  mark(0);
  EXPECT_TRUE(scars.is_short());
  EXPECT_EQ(scars.records(), room);
  {
    const KernelScope scope;
    for (Index i = 0; i < 20; ++i) EXPECT_EQ(scars.view().waits(i), i >= room) << i;
  }
  scars.make_room(20);
  EXPECT_FALSE(scars.is_short());
  mark(room);
  EXPECT_EQ(scars.records(), 20);
  const RareArray<Scar> here = host_copy(scars);
  for (Index i = 0; i < 20; ++i) EXPECT_EQ(here.item(i).depth, i);
}

TEST(RareArray, goes_to_other_ranks_with_its_items) {
  simulate_ranks(3, 1, [](Communicator& ranks) {
    Trees own = forest(ranks.rank() == 0 ? 40 : 0);
    for (Index round = 0; round < 5; ++round) {
      SendLists to(3);
      for (Index i = 0; i < own.id.size(); ++i)
        to.add(static_cast<int>((own.id.data()[i] * (round + 3) + round) / 4 % 3), i);
      redistribute(ranks, own, to, own.id);
      expect_own_scars(own);
      Index scars = 0;
      for (const GlobalId id : own.id.host()) scars += id % 3 == 1 ? 1 : 0;
      EXPECT_EQ(own.scars.records(), scars);
    }
  });
}

Trees read_back(const CheckpointWriter& writer) {
  Trees read;
  CheckpointReader(writer).fields("trees", read);
  return read;
}

TEST(RareArray, is_saved_as_the_records_that_there_are) {
  Trees trees = forest(30);
  CheckpointWriter writer;
  writer.fields("trees", trees);
  const CheckpointReader reader(writer);
  EXPECT_EQ(reader.section("trees.scarred").count, 10U);
  EXPECT_EQ(reader.section("trees.depth").count, 10U);
  const Trees read = read_back(writer);
  ASSERT_EQ(read.scars.size(), 30);
  expect_own_scars(read);
  EXPECT_EQ(read.scars.records(), 10);

  // Neither the order in which records were made nor one that says nothing is seen.
  Trees other = forest(0);
  resize_fields(other, 30);
  copy_to(other.id, trees.id);
  for (Index i = 30; i-- > 0;) other.scars.make(i) = trees.scars.item(i);
  CheckpointWriter again;
  again.fields("trees", other);
  EXPECT_EQ(again.first_difference(writer), "");
}

TEST(RareArray, is_read_from_older_files_that_hold_all_items) {
  CheckpointWriter writer;
  const std::vector<GlobalId> id{0, 1, 2};
  const std::vector<double> depth{0.0, 1.0, 0.0}, since{-1.0, 0.5, -1.0};
  writer.section("trees.id", id.data(), 3, sizeof id[0]);
  writer.section("trees.depth", depth.data(), 3, 8);
  writer.section("trees.since", since.data(), 3, 8);
  const Trees read = read_back(writer);
  expect_own_scars(read);
  EXPECT_EQ(read.scars.records(), 1);
}

TEST(RareArray, whose_places_in_a_file_do_not_fit_is_refused) {
  const auto refusal = [](const std::vector<Index>& places, std::size_t values) {
    CheckpointWriter writer;
    const std::vector<GlobalId> id{0, 1, 2};
    const std::vector<double> numbers(values, 1.0);
    writer.section("trees.id", id.data(), 3, sizeof id[0]);
    writer.section("trees.scarred", places.data(), places.size(), sizeof places[0]);
    writer.section("trees.depth", numbers.data(), values, 8);
    writer.section("trees.since", numbers.data(), values, 8);
    try {
      read_back(writer);
    } catch (const CheckpointError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({0, 2}, 2), "");
  EXPECT_EQ(refusal({0, 3}, 2),
            "a state in memory: section trees.scarred leads to 3 (item 1), expected ascending "
            "places below 3");
  EXPECT_NE(refusal({1, 1}, 2), "");
  EXPECT_NE(refusal({-1, 1}, 2), "");
  EXPECT_EQ(refusal({0, 2}, 3),
            "a state in memory: section trees.depth has 3 items, the others of trees have 2");
}

TEST(RareArray, is_shown_as_an_array_of_all_items) {
  Trees trees = forest(5);
  StateArrays arrays("trees.depth");
  arrays.add_fields("trees.", trees);
  ASSERT_EQ(arrays.found.size(), 1U);
  EXPECT_EQ(arrays.found[0].shape, std::vector<std::int64_t>{5});
  const auto* const values = static_cast<const double*>(arrays.found[0].data);
  EXPECT_EQ(std::vector<double>(values, values + 5), (std::vector<double>{0, 1, 0, 0, 4}));
}

}  // namespace rare_array_test
}  // namespace breccia
