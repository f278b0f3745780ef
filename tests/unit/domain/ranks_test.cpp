// Messages between ranks, halos, and elements that change hands.

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <numeric>

#include "core/state_hash.hpp"
#include "domain/domain.hpp"
#include "domain/simulated_ranks.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace ranks_test {

Message bytes_of(int number) {
  Message message(sizeof number);
  std::memcpy(message.data(), &number, sizeof number);
  return message;
}
int number_of(const Message& message) {
  int number = 0;
  std::memcpy(&number, message.data(), sizeof number);
  return number;
}

TEST(SimulatedRanks, messages_reach_their_rank_and_operation_in_any_order_of_delivery) {
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    simulate_ranks(5, seed, [](Communicator& ranks) {
      for (int round = 0; round < 10; ++round) {
        std::vector<Message> messages;
        for (int r = 0; r < 5; ++r)
          messages.push_back(bytes_of(100 * round + 10 * ranks.rank() + r));
        const std::vector<Message> came = ranks.exchange(std::move(messages));
        for (int r = 0; r < 5; ++r)
          EXPECT_EQ(number_of(came[static_cast<std::size_t>(r)]),
                    100 * round + 10 * r + ranks.rank());
      }
    });
}

TEST(SimulatedRanks, combine_numbers_of_all) {
  simulate_ranks(4, 1, [](Communicator& ranks) {
    EXPECT_EQ(ranks.least(10.0 - ranks.rank()), 7.0);
    EXPECT_EQ(ranks.any_of(std::uint64_t{1} << ranks.rank()), 15U);
    std::vector<std::int64_t> numbers{ranks.rank(), 1};
    ranks.add_up(numbers);
    EXPECT_EQ(numbers, (std::vector<std::int64_t>{6, 4}));
    std::vector<std::int64_t> wraps{std::numeric_limits<std::int64_t>::max() / 2 + 1};
    ranks.add_up(wraps);
    EXPECT_EQ(wraps[0], 0);
    EXPECT_EQ(number_of(ranks.from_first(bytes_of(5 + ranks.rank()))), 5);
  });
}

TEST(SimulatedRanks, an_error_on_one_rank_becomes_the_same_error_on_all) {
  std::atomic<int> refused = 0;
  simulate_ranks(6, 2, [&](Communicator& ranks) {
    try {
      collective_try(&ranks, [&] {
        if (ranks.rank() == 3) throw NumericsError("three");
        if (ranks.rank() == 5) throw InputError("five");
      });
    } catch (const NumericsError& error) {
      EXPECT_STREQ(error.what(), "three");
      ++refused;
    }
    EXPECT_EQ(ranks.any_of(1), 1U);  // all are still in step
  });
  EXPECT_EQ(refused, 6);
}

TEST(SimulatedRanks, a_rank_that_is_lost_does_not_leave_the_others_waiting) {
  EXPECT_THROW(simulate_ranks(4, 3,
                              [](Communicator& ranks) {
                                if (ranks.rank() == 2) throw std::runtime_error("lost");
                                ranks.any_of(1);
                              }),
               std::runtime_error);
}

/// Particle that wanders about in the test below.
struct Wanderers {
  Buffer<GlobalId> id;
  Buffer<Vec3> place;
  Vec3Planes memory;
  template <class Visit>
  void each_field(Visit&& field) {
    field("id", "-", id);
    field("place", "m", place);
    field("memory", "-", memory);
  }
};

TEST(Deal, no_element_is_lost_or_doubled_over_a_hundred_thousand_migrations) {
  constexpr Index count = 500;
  simulate_ranks(7, 4, [](Communicator& ranks) {
    Partition partition(7, {}, {1.0, 1.0, 0.0}, 0.05, 2);
    Wanderers own;
    if (ranks.rank() == 0) {
      resize_fields(own, count);
      std::iota(own.id.host().begin(), own.id.host().end(), 0);
    }
    std::uint64_t round = 0;
    for (std::int64_t moved = 0; moved < 100000; ++round) {
      std::vector<Load> loads;
      for (Index i = 0; i < own.id.size(); ++i) {
        const auto id = static_cast<std::uint64_t>(own.id.data()[i]);
        const auto random = [&](std::uint64_t k) {
          return static_cast<double>(mixed(1000003 * id + 7 * round + k) >> 11) * 0x1p-53;
        };
        own.place.data()[i] = {random(1), random(2) * random(3), 0.0};
        own.memory.view().store(i, {static_cast<double>(id), static_cast<double>(round), 0.5});
        loads.push_back({own.place.data()[i], 1});
      }
      if (round % 5 == 0) partition.cut(ranks, loads);
      SendLists to(7);
      std::int64_t left = 0;
      for (Index i = 0; i < own.id.size(); ++i) {
        to.add(partition.owner(own.place.data()[i]), i);
        left += partition.owner(own.place.data()[i]) != ranks.rank() ? 1 : 0;
      }
      redistribute(ranks, own, to, own.id);
      EXPECT_TRUE(std::is_sorted(own.id.host().begin(), own.id.host().end()));
      std::vector<std::int64_t> seen(count + 1, 0);
      for (Index i = 0; i < own.id.size(); ++i) {
        ++seen[static_cast<std::size_t>(own.id.data()[i])];
        EXPECT_EQ(own.memory.view()[i].x, own.id.data()[i]);
        EXPECT_EQ(own.memory.view()[i].y, static_cast<double>(round));
        EXPECT_EQ(partition.owner(own.place.data()[i]), ranks.rank());
      }
      seen[count] = left;
      ranks.add_up(seen);
      moved += seen[count];
      for (Index id = 0; id < count; ++id) ASSERT_EQ(seen[static_cast<std::size_t>(id)], 1);
    }
  });
}

TEST(Places, are_found_wherever_the_last_one_was) {
  const auto drawn = [](std::uint64_t i) { return mixed(2654435761 * i); };
  Buffer<Index> sorted;
  Index next = -40;
  for (std::uint64_t i = 0; i < 1000; ++i) {  // runs without gaps, and gaps
    sorted.resize(sorted.size() + 1);
    sorted.data()[i] = next += drawn(i) % 8 == 0 ? 30 : 1;
  }
  const auto all = sorted.host();
  Places places(sorted);
  int found = 0, missed = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const auto near = static_cast<Index>(drawn(3 * i) % 9) - 4;
    const Index number = all[drawn(2 * i) % 1000] + near;
    const auto place = std::find(all.begin(), all.end(), number) - all.begin();
    const bool is_there = place < sorted.size();
    EXPECT_EQ(places.find(number), is_there ? place : -1);
    ++(is_there ? found : missed);
  }
  EXPECT_GT(found, 5000);
  EXPECT_GT(missed, 1000);
  EXPECT_EQ(Places(Buffer<Index>()).find(0), -1);
}

/// Counts what is prepared.
class Counting final : public Communicator {
 public:
  explicit Counting(Communicator& ranks) : ranks_(ranks) {}
  int rank() const override { return ranks_.rank(); }
  int size() const override { return ranks_.size(); }
  std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                            const std::vector<Post>& from) override {
    ++prepared;
    return ranks_.prepare(to, from);
  }
  std::vector<Message> exchange(std::vector<Message> messages) override {
    return ranks_.exchange(std::move(messages));
  }
  void abort(int exit_code) override { ranks_.abort(exit_code); }

  int prepared = 0;

 private:
  Communicator& ranks_;
};

TEST(Halo, messages_are_prepared_once_for_each_place_that_they_come_from) {
  simulate_ranks(2, 6, [](Communicator& simulated) {
    Counting ranks(simulated);
    // Each of two ranks has one element of its own and a copy of the other's.
    const Index own = ranks.rank(), other = 1 - own;
    Buffer<GlobalId> ids(Space::host, 2);
    ids.data()[1] = 1;
    const std::vector<Ghost> ghosts{{other, static_cast<int>(other)}};
    Buffer<double> numbers(Space::host, 2);
    double told = 0.0;
    const auto follow = [&](Halo& halo) {
      numbers.data()[own] = ++told + 0.5 * own;
      halo.refresh(Exec{}, ranks, numbers);
      return numbers.data()[other] == told + 0.5 * other;
    };
    Halo halo;
    halo.build(ranks, ids, ghosts);
    for (int round = 0; round < 5; ++round) EXPECT_TRUE(follow(halo));
    EXPECT_EQ(ranks.prepared, 1);
    Halo copy = halo;
    EXPECT_TRUE(follow(copy));
    EXPECT_TRUE(follow(halo));
    EXPECT_EQ(ranks.prepared, 2);
    Buffer<Vec3> larger(Space::host, 2);
    larger.data()[own].z = own + 1.0;
    halo.refresh(Exec{}, ranks, larger);
    EXPECT_EQ(larger.data()[other].z, other + 1.0);
    halo.build(ranks, ids, {});  // nothing is to follow any more
    EXPECT_FALSE(follow(halo));
    EXPECT_EQ(ranks.prepared, 4);
  });
}

TEST(Halo, copies_become_what_their_owners_have) {
  simulate_ranks(3, 5, [](Communicator& ranks) {
    // Rank r owns 10 r to 10 r + 9 and holds ghosts of two of each other rank's.
    Buffer<GlobalId> ids;
    std::vector<int> owner;
    std::vector<Ghost> ghosts;
    for (int of = 0; of < 3; ++of)
      for (Index k = 0; k < 10; ++k) {
        if (of != ranks.rank() && k != ranks.rank() && k != 7) continue;
        ids.resize(ids.size() + 1);
        ids.data()[ids.size() - 1] = 10 * of + k;
        owner.push_back(of);
        if (of != ranks.rank()) ghosts.push_back({ids.size() - 1, of});
      }
    Halo halo;
    halo.build(ranks, ids, ghosts);
    EXPECT_EQ(halo.ghosts(), 4);
    Buffer<double> numbers(Space::host, ids.size());
    for (Index i = 0; i < ids.size(); ++i)
      numbers.data()[i] = owner[static_cast<std::size_t>(i)] == ranks.rank() ? ids.data()[i] : -1.0;
    for (int round = 0; round < 5; ++round) halo.refresh(Exec{}, ranks, numbers);
    for (Index i = 0; i < ids.size(); ++i) EXPECT_EQ(numbers.data()[i], ids.data()[i]);
  });
}

}  // namespace ranks_test
}  // namespace breccia
