// Arrays that threads fill: the same items for any number of threads.

#include "exec/filling.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "exec/plain_vector.hpp"
#include "exec/sort_scan.hpp"

namespace breccia {
namespace filling_test {

TEST(Filling, GivesTheSameItemsOnAnyNumberOfThreads) {
  for (const Space space : {Space::host, Space::shadow})
    for (const Index count : {0, 1, 5000, 100'000})
      for (const int threads : {1, 3, 8}) {
        Buffer<Index> items(space, 7);
        fill_items(items, count, threads, [](Index i) { return 3 * i + 1; });
        ASSERT_EQ(items.size(), count);
        std::vector<Index> found;
        copy_to(found, items);
        for (Index i = 0; i < count; ++i) ASSERT_EQ(found[at(i)], 3 * i + 1) << threads;
      }
}

TEST(Filling, ListsNumbersInOrderOnAnyNumberOfThreads) {
  const auto keep = [](Index i) { return i % 7 == 3 || i / 1000 % 2 == 0; };
  for (const Index count : {0, 1, 9000, 100'000}) {
    std::vector<Index> expected;
    for (Index i = 0; i < count; ++i)
      if (keep(i)) expected.push_back(i);
    for (const int threads : {1, 2, 5, 16}) {
      std::vector<Index> found;
      copy_to(found, numbers_where(threads, count, keep));
      EXPECT_EQ(found, expected) << count << " numbers, " << threads << " threads";
    }
  }
}

TEST(Filling, RunsMakeUpTheWholeInOrder) {
  for (const Index count : {0, 3, 50'000})
    for (const int threads : {1, 2, 7}) {
      Index next = 0;
      for (const auto& run : of_runs(threads, count, [](Index begin, Index end) {
             return std::pair{begin, end};
           })) {
        EXPECT_EQ(run.found.first, next);
        next = run.found.second;
      }
      EXPECT_EQ(next, count);
    }
}

TEST(Filling, LargeArraysAreClearedAndCopiedWhole) {
  constexpr Index count = 5'000'001;
  for (const int threads : {1, 4}) {
    const FillingThreads filling(threads);
    Buffer<Index> zeros(Space::host, count), numbers;
    for (const Index i : zeros.host()) ASSERT_EQ(i, 0);
    fill_items(numbers, count, threads, [](Index i) { return i; });
    copy_to(zeros, numbers);
    ASSERT_EQ(std::memcmp(zeros.data(), numbers.data(), sizeof(Index) * at(count)), 0) << threads;
  }
}

TEST(Filling, ScansAlikeOnAnyNumberOfThreads) {
  for (const Index count : {0, 1, 300, 50'000}) {
    std::vector<Index> given(at(count)), expected(at(count));
    for (Index i = 0; i < count; ++i) given[at(i)] = i * 7 % 5;
    std::exclusive_scan(given.begin(), given.end(), expected.begin(), 0);
    for (const int threads : {1, 2, 3, 7}) {
      Buffer<Index> counts;
      copy_to(counts, given);
      EXPECT_EQ(exclusive_scan({.threads = threads}, counts),
                std::accumulate(given.begin(), given.end(), 0));
      EXPECT_TRUE(std::equal(expected.begin(), expected.end(), counts.host().begin())) << threads;
    }
  }
}

TEST(PlainVector, KeepsWhatItHoldsAndFillsWhatItIsGiven) {
  PlainVector<double> numbers(3, 1.5);
  numbers.resize(1000);
  EXPECT_EQ(numbers[2], 1.5);
  numbers.assign(5, 2.0);
  numbers.push_back(7.0);
  EXPECT_EQ(numbers, (PlainVector<double>{2.0, 2.0, 2.0, 2.0, 2.0, 7.0}));
}

}  // namespace filling_test
}  // namespace breccia
