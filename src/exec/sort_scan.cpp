#include "exec/sort_scan.hpp"

#include <limits>
#include <parallel/algorithm>
#include <stdexcept>

namespace breccia {

void sort_by_key(const Exec& exec, Buffer<KeyedIndex>& items) {
  const auto before = [](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : a.item < b.item;
  };
  KeyedIndex* const begin = items.data();
  KeyedIndex* const end = begin + items.size();
  if (exec.threads <= 1 || items.size() < 20'000) {
    std::sort(begin, end, before);
  } else {
    __gnu_parallel::sort(begin, end, before,
                         __gnu_parallel::multiway_mergesort_tag(
                             static_cast<__gnu_parallel::_ThreadIndex>(exec.threads)));
  }
}

Index exclusive_scan(const Exec&, Buffer<Index>& counts) {
  std::int64_t total = 0;
  for (Index i = 0; i < counts.size(); ++i) {
    const Index count = counts.data()[i];
    counts.data()[i] = static_cast<Index>(total);
    total += count;
    if (total > std::numeric_limits<Index>::max())
      throw std::length_error("more pairs than a 32-bit index can count");
  }
  return static_cast<Index>(total);
}

}  // namespace breccia
