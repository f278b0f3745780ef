#pragma once
// Choosing items of a list: count, scan, fill, in any space.

#include "exec/for_each.hpp"
#include "exec/sort_scan.hpp"

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

/// The items of [0, count) for which keep(i) holds, ascending.
template <class Keep>
Buffer<Index> items_where(const Exec& exec, Index count, const Keep& keep) {
  Buffer<Index> starts = unfilled<Index>(exec.space, count + 1), kept(exec.space);
  clear_bytes(starts.data() + count, exec.space, sizeof(Index));
  for_each(exec, count, MarkKept<Keep>{keep, starts.view()});
  kept.resize_unfilled(exclusive_scan(exec, starts));
  for_each(exec, count, ListKept{std::as_const(starts).view(), kept.view()});
  return kept;
}

}  // namespace breccia
