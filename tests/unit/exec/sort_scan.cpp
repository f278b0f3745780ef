// Sorting gives one order, whatever the threads and whatever the order before.

#include "exec/sort_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "exec/error.hpp"

namespace breccia {
namespace sort_scan_test {

std::uint64_t scramble(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  return z ^ (z >> 27);
}

using KeysAndItems = std::vector<std::pair<std::uint64_t, Index>>;

KeysAndItems sorted_by_key(const KeysAndItems& given, int threads) {
  Buffer<KeyedIndex> items(Space::host, static_cast<Index>(given.size()));
  for (std::size_t i = 0; i < given.size(); ++i)
    items.host()[i] = {given[i].first, given[i].second};
  const KeyedIndex* const memory = items.data();
  sort_by_key({.threads = threads}, items);
  EXPECT_EQ(items.data(), memory) << "a view from before the sort would read freed memory";
  KeysAndItems sorted;
  for (const KeyedIndex& item : items.host()) sorted.emplace_back(item.key, item.item);
  return sorted;
}

TEST(SortByKey, OrdersByKeyAndThenByItem) {
  for (const Index count : {0, 1, 500, 3000, 50'000}) {
    for (const std::uint64_t kinds : {std::uint64_t{1}, std::uint64_t{100}, ~std::uint64_t{0}}) {
      KeysAndItems given;
      for (Index i = 0; i < count; ++i)
        given.emplace_back(scramble(static_cast<std::uint64_t>(i)) % kinds, i);
      KeysAndItems backwards(given.rbegin(), given.rend());
      KeysAndItems expected = given;
      std::sort(expected.begin(), expected.end());
      for (const int threads : {1, 2, 3, 7}) {
        ASSERT_EQ(sorted_by_key(given, threads), expected) << count << " items, " << threads;
        ASSERT_EQ(sorted_by_key(backwards, threads), expected) << count << " items, " << threads;
      }
    }
  }
}

TEST(SortKeys, OrdersNumbersOfAnyLength) {
  for (const int bits : {1, 8, 13, 40, 64}) {
    for (const Index count : {0, 1, 700, 50'000}) {
      Buffer<std::uint64_t> given(Space::host, count);
      for (Index i = 0; i < count; ++i)
        given.host()[static_cast<std::size_t>(i)] =
            scramble(static_cast<std::uint64_t>(i)) >> (64 - bits);
      std::vector<std::uint64_t> expected(given.host().begin(), given.host().end());
      std::sort(expected.begin(), expected.end());
      for (const int threads : {1, 2, 3, 7}) {
        Buffer<std::uint64_t> keys(given), scratch;
        sort_keys({.threads = threads}, keys, scratch, bits);
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), keys.host().begin()))
            << bits << " bits, " << count << " numbers, " << threads << " threads";
      }
    }
  }
}

TEST(ExclusiveScan, OfMoreThanAnIndexCanCountIsRefusedAsAModelTooLarge) {
  Buffer<Index> counts(Space::host, 3);
  for (Index& count : counts.host()) count = 1 << 30;
  try {
    exclusive_scan({}, counts);
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.exit_code(), 5);
    EXPECT_NE(std::string(error.what()).find("fewer elements"), std::string::npos);
  }
}

}  // namespace sort_scan_test
}  // namespace breccia
