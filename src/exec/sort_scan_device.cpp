// The only file that sees CUB, the sorts of the CUDA toolkit.

#include "exec/sort_scan_device.hpp"

#include "exec/error.hpp"

#if defined(__CUDACC__)
#include <cub/device/device_radix_sort.cuh>

#include "exec/device_scan.hpp"
#include "exec/for_each.hpp"

namespace breccia {
namespace {

/// Calls one of CUB's functions twice, as they want it: for the size of its work space, then with
/// it.
template <class Call>
void with_work_space(const Call& call) {
  std::size_t bytes = 0;
  check_device(call(nullptr, bytes), "planning a sort or scan");
  void* work = allocate(Space::cuda, bytes);
  const cudaError_t result = call(work, bytes);
  release(Space::cuda, work);
  check_device(result, "a sort or scan");
}

struct SplitItem {
  View<const KeyedIndex> items;
  View<std::uint64_t> key;
  View<std::uint32_t> item;
  BR_HD void operator()(Index i) const {
    key[i] = items[i].key;
    item[i] = static_cast<std::uint32_t>(items[i].item);
  }
};
struct JoinItem {
  View<const std::uint64_t> key;
  View<const std::uint32_t> item;
  View<KeyedIndex> items;
  BR_HD void operator()(Index i) const { items[i] = {key[i], static_cast<Index>(item[i])}; }
};
struct CountOf {
  static constexpr const char* name = "exec.scan_counts";
  View<const Index> counts;
  BR_HD Index operator()(Index i) const { return counts[i]; }
};
struct PutBegin {
  static constexpr const char* name = "exec.scan_begins";
  View<Index> counts;
  BR_HD void operator()(Index i, Index begin, Index) const { counts[i] = begin; }
};

constexpr Exec on_device{Space::cuda, 1, nullptr};

/// Sorts two arrays by the numbers in the first, stable.
template <class Key, class Carried>
void sort_pairs(Buffer<Key>& key, Buffer<Carried>& carried) {
  Buffer<Key> sorted_key = unfilled<Key>(Space::cuda, key.size());
  Buffer<Carried> sorted_carried = unfilled<Carried>(Space::cuda, key.size());
  with_work_space([&](void* work, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(work, bytes, key.data(), sorted_key.data(),
                                           carried.data(), sorted_carried.data(), key.size(), 0,
                                           static_cast<int>(8 * sizeof(Key)), device_stream());
  });
  key.swap(sorted_key);
  carried.swap(sorted_carried);
}

}  // namespace

void sort_by_key_on_device(Buffer<KeyedIndex>& items) {
  const Index count = items.size();
  if (count < 2) return;
  Buffer<std::uint64_t> key = unfilled<std::uint64_t>(Space::cuda, count);
  Buffer<std::uint32_t> item = unfilled<std::uint32_t>(Space::cuda, count);
  const View<const KeyedIndex> view = std::as_const(items).view();
  for_each(on_device, count, SplitItem{view, key.view(), item.view()});
  sort_pairs(key, item);  // stable: equal keys stay in the order of their items
  for_each(on_device, count,
           JoinItem{std::as_const(key).view(), std::as_const(item).view(), items.view()});
}

void sort_keys_on_device(Buffer<std::uint64_t>& keys, Buffer<std::uint64_t>& scratch, int bits) {
  scratch.clear();
  scratch.resize_unfilled(keys.size());
  if (keys.size() < 2) return;
  with_work_space([&](void* work, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortKeys(work, bytes, keys.data(), scratch.data(), keys.size(), 0,
                                          bits, device_stream());
  });
  keys.swap(scratch);
}

void sort_pairs_on_device(Buffer<std::uint64_t>& keys, Buffer<Index>& carried,
                          Buffer<std::uint64_t>& key_scratch, Buffer<Index>& scratch, int bits) {
  key_scratch.clear();
  scratch.clear();
  key_scratch.resize_unfilled(keys.size());
  scratch.resize_unfilled(keys.size());
  if (keys.size() < 2) return;
  with_work_space([&](void* work, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(work, bytes, keys.data(), key_scratch.data(),
                                           carried.data(), scratch.data(), keys.size(), 0, bits,
                                           device_stream());
  });
  keys.swap(key_scratch);
  carried.swap(scratch);
}

Scanned exclusive_scan_on_device(Buffer<Index>& counts, const Index* flag, bool asks) {
  const CountOf of{std::as_const(counts).view()};
  return scan_on_device(counts.size(), of, of, PutBegin{counts.view()}, flag, asks);
}

}  // namespace breccia

#else

namespace breccia {
namespace {
[[noreturn]] void refuse_to_sort() {
  throw DeviceError("this build of breccia has no CUDA");
}
}  // namespace

void sort_by_key_on_device(Buffer<KeyedIndex>&) {
  refuse_to_sort();
}
void sort_keys_on_device(Buffer<std::uint64_t>&, Buffer<std::uint64_t>&, int) {
  refuse_to_sort();
}
void sort_pairs_on_device(Buffer<std::uint64_t>&, Buffer<Index>&, Buffer<std::uint64_t>&,
                          Buffer<Index>&, int) {
  refuse_to_sort();
}
Scanned exclusive_scan_on_device(Buffer<Index>&, const Index*, bool) {
  refuse_to_sort();
}

}  // namespace breccia
#endif
