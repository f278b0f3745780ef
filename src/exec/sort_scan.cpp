#include "exec/sort_scan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <vector>

#include "exec/error.hpp"
#include "exec/sort_scan_device.hpp"

namespace breccia {

namespace {

constexpr int digit_bits = 8;
constexpr std::size_t digits = std::size_t{1} << digit_bits;
using Histogram = std::array<Index, digits>;

std::uint64_t key_of(std::uint64_t key) {
  return key;
}
std::uint64_t key_of(const KeyedIndex& item) {
  return item.key;
}

/// Contiguous blocks of an array, one a thread.
struct Blocks {
  Index count;
  int blocks;

  Blocks(const Exec& exec, Index items)
      : count(items), blocks(items < 20'000 ? 1 : std::max(1, exec.threads)) {}
  Index first(int block) const {
    return static_cast<Index>(static_cast<std::int64_t>(count) * block / blocks);
  }
  /// work(block, begin, end) for each of them.
  template <class Work>
  void each(const Work& work) const {
#pragma omp parallel for schedule(static, 1) num_threads(blocks) if (blocks > 1)
    for (int block = 0; block < blocks; ++block)
      work(static_cast<std::size_t>(block), first(block), first(block + 1));
  }
};

/// Whether items ascend, and all bits that their keys use.
struct Order {
  bool ascends = true;
  std::uint64_t used = 0;
};
Order order_of(const Exec& exec, const Buffer<KeyedIndex>& items) {
  const KeyedIndex* const of = items.data();
  const Blocks blocks(exec, items.size());
  std::vector<Order> found(static_cast<std::size_t>(blocks.blocks));
  blocks.each([&](std::size_t block, Index begin, Index end) {
    Order own;
    for (Index i = begin; i < end; ++i) {
      own.used |= of[i].key;
      own.ascends = own.ascends && (i == 0 || of[i - 1].item <= of[i].item);
    }
    found[block] = own;
  });
  Order all;
  for (const Order& own : found) {
    all.used |= own.used;
    all.ascends = all.ascends && own.ascends;
  }
  return all;
}

/// Stable: items with equal keys keep their order. Each of `blocks` contiguous blocks is counted
/// and then distributed by one thread; which items make a block does not change the result.
template <class Item>
void sort_by_digits(const Exec& exec, Buffer<Item>& items, Buffer<Item>& scratch, int bits) {
  const Index count = items.size();
  const Blocks blocks(exec, count);
  scratch.clear();
  scratch.resize_unfilled(count);
  std::vector<Histogram> places(static_cast<std::size_t>(blocks.blocks));
  for (int shift = 0; shift < bits; shift += digit_bits) {
    const Item* const from = items.data();
    Item* const to = scratch.data();
    const auto digit = [&](Index i) { return (key_of(from[i]) >> shift) & (digits - 1); };

    blocks.each([&](std::size_t block, Index begin, Index end) {
      Histogram counts{};
      for (Index i = begin; i < end; ++i) ++counts[digit(i)];
      places[block] = counts;
    });

    Index place = 0;
    bool all_alike = false;
    for (std::size_t d = 0; d < digits; ++d) {
      const Index before = place;
      for (Histogram& histogram : places) {
        const Index here = histogram[d];
        histogram[d] = place;
        place += here;
      }
      if (place - before == count) all_alike = true;
    }
    if (all_alike) continue;

    blocks.each([&](std::size_t block, Index begin, Index end) {
      Histogram next = places[block];
      for (Index i = begin; i < end; ++i) to[next[digit(i)]++] = from[i];
    });
    items.swap(scratch);
  }
}

}  // namespace

void sort_by_key(const Exec& exec, Buffer<KeyedIndex>& items) {
  if (items.space() == Space::cuda) return sort_by_key_on_device(items);
  KeyedIndex* const begin = items.data();
  KeyedIndex* const end = begin + items.size();
  const Order order = items.size() > 1000 ? order_of(exec, items) : Order{false, 0};
  if (order.ascends) {
    Buffer<KeyedIndex> scratch(items.space());
    sort_by_digits(exec, items, scratch, static_cast<int>(std::bit_width(order.used)));
    if (items.data() != begin) {  // views of the array stay good
      copy_to(scratch, items);
      items.swap(scratch);
    }
    return;
  }
  std::sort(begin, end, [](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : a.item < b.item;
  });
}

void sort_keys(const Exec& exec, Buffer<std::uint64_t>& keys, Buffer<std::uint64_t>& scratch,
               int bits) {
  if (keys.space() == Space::cuda) return sort_keys_on_device(keys, scratch, bits);
  sort_by_digits(exec, keys, scratch, bits);
}

namespace {

/// Each block is added up, then scanned from the sum of those before it.
std::int64_t exclusive_scan_on_host(const Exec& exec, Buffer<Index>& counts) {
  Index* const items = counts.data();
  const Blocks blocks(exec, counts.size());
  std::vector<std::int64_t> before(static_cast<std::size_t>(blocks.blocks) + 1, 0);
  if (blocks.blocks > 1)
    blocks.each([&](std::size_t block, Index begin, Index end) {
      std::int64_t sum = 0;
      for (Index i = begin; i < end; ++i) sum += items[i];
      before[block + 1] = sum;
    });
  std::partial_sum(before.begin(), before.end(), before.begin());
  std::int64_t last = 0;
  blocks.each([&](std::size_t block, Index begin, Index end) {
    std::int64_t total = before[block];
    for (Index i = begin; i < end; ++i) {
      const Index count = items[i];
      items[i] = static_cast<Index>(total);
      total += count;
    }
    if (end == blocks.count) last = total;
  });
  return last;
}

void check_total(std::int64_t total) {
  if (total > std::numeric_limits<Index>::max())
    throw DeviceError(
        "the model needs more than the 2,147,483,647 pairs of elements that fit a 32-bit index; "
        "use fewer elements, or a smaller search.margin or links.range");
}

}  // namespace

Index exclusive_scan(const Exec& exec, Buffer<Index>& counts) {
  const std::int64_t total = counts.space() == Space::cuda
                                 ? exclusive_scan_on_device(counts, nullptr, true).total
                                 : exclusive_scan_on_host(exec, counts);
  check_total(total);
  return static_cast<Index>(total);
}

Scanned exclusive_scan(const Exec& exec, Buffer<Index>& counts, const Buffer<Index>& flag) {
  Scanned scanned{0, 0};
  if (counts.space() == Space::cuda) {
    scanned = exclusive_scan_on_device(counts, flag.data(), true);
  } else {
    scanned.flag = flag.data()[0];
    scanned.total = exclusive_scan_on_host(exec, counts);
  }
  check_total(scanned.total);
  return scanned;
}

void exclusive_scan(const Exec& exec, Buffer<Index>& counts, [[maybe_unused]] Index total) {
  if (counts.space() == Space::cuda) {
    exclusive_scan_on_device(counts, nullptr, false);
    return;
  }
  [[maybe_unused]] const std::int64_t found = exclusive_scan_on_host(exec, counts);
  BR_ASSERT(found == total);
}

}  // namespace breccia
