// Votes in shared memory: every rank hears what every other has told in the same round.

#include "domain/shared_reduction.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace breccia {
namespace shared_reduction_test {

/// Vote of a rank in a round.
std::uint64_t vote_of(std::size_t rank, std::uint64_t round) {
  return 1000 * round + rank;
}

TEST(SharedReduction, each_rank_hears_all_votes_of_a_round_in_the_order_of_ranks) {
  constexpr std::size_t ranks = 5;
  constexpr std::uint64_t rounds = 4000;
  std::vector<VoteSlot> slots(ranks);
  std::vector<std::uint64_t> wrong(ranks, 0), waited(ranks, 0);
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < ranks; ++rank)
    threads.emplace_back([&, rank] {
      SharedReduction board(slots, rank);
      for (std::uint64_t round = 1; round <= rounds; ++round) {
        board.publish(vote_of(rank, round));
        // One rank is late, another one each time.
        if (round % ranks == rank && round % 16 == 0) std::this_thread::yield();
        std::size_t next = 0;
        const auto idle = [&] {
          ++waited[rank];
          std::this_thread::yield();
        };
        board.collect(idle, [&](std::uint64_t told) {
          if (told != vote_of(next++, round)) ++wrong[rank];
        });
        if (next != ranks) ++wrong[rank];
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t rank = 0; rank < ranks; ++rank) EXPECT_EQ(wrong[rank], 0U) << "rank " << rank;
}

TEST(SharedReduction, telling_does_not_wait_and_hearing_does) {
  std::vector<VoteSlot> slots(2);
  SharedReduction one(slots, 0), other(slots, 1);
  one.publish(7);
  int idle = 0;
  std::uint64_t sum = 0;
  one.collect(
      [&] {
        if (++idle == 3) other.publish(5);
      },
      [&](std::uint64_t told) { sum += told; });
  EXPECT_EQ(idle, 3);
  EXPECT_EQ(sum, 12U);
}

}  // namespace shared_reduction_test
}  // namespace breccia
