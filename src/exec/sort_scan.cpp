#include "exec/sort_scan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
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

/// Stable: items with equal keys keep their order. Each of `blocks` contiguous blocks is counted
/// and then distributed by one thread; which items make a block does not change the result.
template <class Item>
void sort_by_digits(const Exec& exec, Buffer<Item>& items, Buffer<Item>& scratch, int bits) {
  const Index count = items.size();
  const int blocks = count < 20'000 ? 1 : std::max(1, exec.threads);
  scratch.resize(count);
  std::vector<Histogram> places(static_cast<std::size_t>(blocks));
  const auto first_of = [&](int block) {
    return static_cast<Index>(static_cast<std::int64_t>(count) * block / blocks);
  };
  for (int shift = 0; shift < bits; shift += digit_bits) {
    const Item* const from = items.data();
    Item* const to = scratch.data();
    const auto digit = [&](Index i) { return (key_of(from[i]) >> shift) & (digits - 1); };

#pragma omp parallel for schedule(static, 1) num_threads(blocks) if (blocks > 1)
    for (int block = 0; block < blocks; ++block) {
      Histogram counts{};
      for (Index i = first_of(block), end = first_of(block + 1); i < end; ++i) ++counts[digit(i)];
      places[static_cast<std::size_t>(block)] = counts;
    }

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

#pragma omp parallel for schedule(static, 1) num_threads(blocks) if (blocks > 1)
    for (int block = 0; block < blocks; ++block) {
      Histogram next = places[static_cast<std::size_t>(block)];
      for (Index i = first_of(block), end = first_of(block + 1); i < end; ++i)
        to[next[digit(i)]++] = from[i];
    }
    items.swap(scratch);
  }
}

}  // namespace

void sort_by_key(const Exec& exec, Buffer<KeyedIndex>& items) {
  if (items.space() == Space::cuda) return sort_by_key_on_device(items);
  KeyedIndex* const begin = items.data();
  KeyedIndex* const end = begin + items.size();
  const auto item_before = [](const KeyedIndex& a, const KeyedIndex& b) { return a.item < b.item; };
  if (items.size() > 1000 && std::is_sorted(begin, end, item_before)) {
    Buffer<KeyedIndex> scratch(items.space());
    std::uint64_t used = 0;
    for (const KeyedIndex* item = begin; item != end; ++item) used |= item->key;
    sort_by_digits(exec, items, scratch, static_cast<int>(std::bit_width(used)));
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

Index exclusive_scan(const Exec&, Buffer<Index>& counts) {
  std::int64_t total = 0;
  if (counts.space() == Space::cuda) total = exclusive_scan_on_device(counts);
  const Index on_host = counts.space() == Space::cuda ? 0 : counts.size();
  for (Index i = 0; i < on_host; ++i) {
    const Index count = counts.data()[i];
    counts.data()[i] = static_cast<Index>(total);
    total += count;
  }
  if (total > std::numeric_limits<Index>::max())
    throw DeviceError(
        "the model needs more than the 2,147,483,647 pairs of elements that fit a 32-bit index; "
        "use fewer elements, or a smaller search.margin or links.range");
  return static_cast<Index>(total);
}

}  // namespace breccia
