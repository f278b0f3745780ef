#pragma once
// Choosing items of a list: count, scan, fill, in any space.

#include "exec/for_each.hpp"
#include "exec/sort_scan.hpp"
#if defined(__CUDACC__)
#include "exec/device_scan.hpp"
#endif

namespace breccia {

template <class Keep>
struct MarkKept {
  static constexpr const char* name = "core.mark_kept";
  Keep keep;
  View<Index> mark;
  BR_HD void operator()(Index i) const { mark[i] = keep(i) ? 1 : 0; }
};

struct ListKept {
  static constexpr const char* name = "core.list_kept";
  View<const Index> starts;  ///< of count + 1 items
  View<Index> kept;
  BR_HD void operator()(Index i) const {
    if (starts[i + 1] != starts[i]) kept[starts[i]] = i;
  }
};

#if defined(__CUDACC__)
/// On a device the question is asked once, and answers wait for their places.
template <class Keep>
struct AskKept {
  static constexpr const char* name = "core.mark_kept";
  Keep keep;
  View<std::uint8_t> mark;
  __device__ Index operator()(Index i) const {
    const bool kept = keep(i);
    mark[i] = kept ? 1 : 0;
    return kept ? 1 : 0;
  }
};
struct WasKept {
  View<const std::uint8_t> mark;
  __device__ Index operator()(Index i) const { return mark[i]; }
};
struct PutKept {
  static constexpr const char* name = "core.list_kept";
  View<Index> kept;
  __device__ void operator()(Index i, Index begin, Index n) const {
    if (n != 0) kept[begin] = i;
  }
};
#endif

/// The items of [0, count) for which keep(i) holds, ascending.
template <class Keep>
Buffer<Index> items_where(const Exec& exec, Index count, const Keep& keep) {
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    Buffer<Index> kept = unfilled<Index>(exec.space, count);
    Buffer<std::uint8_t> mark = unfilled<std::uint8_t>(exec.space, count);
    const Scanned scanned =
        scan_on_device(count, AskKept<Keep>{keep, mark.view()}, WasKept{std::as_const(mark).view()},
                       PutKept{kept.view()}, nullptr, true);
    kept.resize_unfilled(static_cast<Index>(scanned.total));
    return kept;
  }
#endif
  Buffer<Index> starts = unfilled<Index>(exec.space, count + 1), kept(exec.space);
  clear_bytes(starts.data() + count, exec.space, sizeof(Index));
  for_each(exec, count, MarkKept<Keep>{keep, starts.view()});
  kept.resize_unfilled(exclusive_scan(exec, starts));
  for_each(exec, count, ListKept{std::as_const(starts).view(), kept.view()});
  return kept;
}

}  // namespace breccia
