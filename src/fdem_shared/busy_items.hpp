#pragma once
// Couples and joints with more work to do than others, listed on a device. Of all couples that a
// search lists few touch in a step, of all joints few are damaged; a warp that takes 32 of all
// waits for those of them that are.
//
// A launch of ListBusy looks at all items: it finishes those with little to do, couples at rest
// apart and joints that stay whole, and lists the others. A launch of BusyWide or BusyWhereDue
// evaluates the list; the sums of forces empty it (EmptiesList). The order of the list
// changes from run to run, but each item writes only its own forces.

#include <algorithm>
#include <bit>

#include "core/kernel.hpp"
#include "exec/buffer.hpp"
#include "exec/launch.hpp"
#include "exec/lockstep.hpp"

namespace breccia::fdem_shared {

/// Numbers of busy couples or joints: room for all, and how many there are.
struct BusyItems {
  Buffer<Index> item;   ///< [-]  (couples or joints)
  Buffer<Index> count;  ///< [-]  (1)
  void resize(Index items) {
    item.resize(items);
    count.resize(1);
  }
};

/// A list of busy items that is kept from step to step (kept_lists.hpp).
struct KeptList {
  Buffer<Index> item;           ///< those listed; room for all  [-]
  Buffer<std::uint8_t> listed;  ///< 1: it is  [-]  (items)
  Buffer<Index> count;          ///< listed before the present step, and with those of it  [-]  (2)
  Index begun = 0;              ///< at the last search
};

/// Where an item goes at the end of a list of `count`: one addition for all threads of a warp.
BR_HD inline Index place_at_end(Index& count) {
#if defined(__CUDA_ARCH__)
  const unsigned asking = __activemask();
  const int first = __ffs(static_cast<int>(asking)) - 1;
  const int lane = static_cast<int>(threadIdx.x % 32);
  Index begin = 0;
  if (lane == first) begin = atomicAdd(&count, __popc(asking));
  return __shfl_sync(asking, begin, first) + __popc(asking & ((1U << lane) - 1));
#else
  return count++;
#endif
}

/// Lists the items that update() of their kernel leaves to slow(). One launch before has ended that
/// emptied the list.
template <class Kernel>
struct ListBusy {
  static constexpr const char* name = "fdem.list_busy";
  static constexpr int least_blocks = least_blocks_of<Kernel>();
  Kernel all;
  View<Index> busy, count;

  using Loaded = typename LoadedBy<Kernel>::Loaded;
  BR_HD void set(const StepTime&) {}
  BR_HD void load_early(Index i, Loaded& loaded) const { all.load_early(i, loaded); }
  BR_HD void load_late(Index i, Loaded& loaded) const { all.load_late(i, loaded); }
  BR_HD void update(Index i, const Loaded& loaded) const { note(i, all.update(i, loaded)); }
  BR_HD void update_at(const StepTime& now, Index i, const Loaded& loaded) const {
    if constexpr (requires { all.update_at(now, i, loaded); })
      note(i, all.update_at(now, i, loaded));
    else
      note(i, all.update(i, loaded));
  }

 private:
  BR_HD void note(Index i, bool done) const {
    if (!done) busy[place_at_end(count[0])] = i;
  }
};

/// Groups of threads that share a list of items out: whole warps of them.
/// @param most  as many as run at a time, and more
template <class Wide>
Index groups_of(Index items, Index most) {
  return whole_warps(std::min(items, most) * Wide::width) / Wide::width;
}

/// Busy items by the threads of `groups` groups, each of which takes every groups-th one.
/// @tparam Wide  kernel of all items by `width` threads each; an item beyond the last is none
template <class Wide>
struct BusyWide {
  static constexpr const char* name = Wide::name;
  static constexpr Index width = Wide::width;
  Wide wide;
  View<const Index> busy, count;
  Index groups;

  BR_HD void set(const StepTime& now) { wide.set(now); }
  BR_HD void operator()(Index i) const {
    each(i, [this](Index thread, auto& loaded) { wide.update(thread, loaded); });
  }
  BR_HD void update_at(const StepTime& now, Index i) const {
    each(i, [this, &now](Index thread, auto& loaded) { wide.update_at(now, thread, loaded); });
  }

 private:
  template <class Update>
  BR_HD void each(Index i, const Update& update) const {
    const LaneGroup<width> group;
    const Index end = count[0];
    for (Index k = i / width; group.any_of_warp(k < end); k += groups) {
      const Index thread = (k < end ? busy[k] : wide.items()) * width + i % width;
      typename Wide::Loaded loaded;
      wide.load_early(thread, loaded);
      wide.load_late(thread, loaded);
      group.wait();  // one thread writes what all of them load
      update(thread, loaded);
    }
  }
};

/// Place of the lowest bit of a number that has one.
BR_HD inline int lowest_bit(unsigned bits) {
#if defined(__CUDA_ARCH__)
  return __ffs(static_cast<int>(bits)) - 1;
#else
  return std::countr_zero(bits);
#endif
}

/// Busy couples by the threads of `groups` groups: each thread looks whether one of them is due,
/// and all of its group evaluate those that are.
/// @tparam Wide  kernel of all couples by `width` threads each; a couple beyond the last is none
template <class Wide>
struct BusyWhereDue {
  static constexpr const char* name = Wide::name;
  static constexpr Index width = Wide::width;
  Wide wide;
  View<const Index> busy, count;
  Index groups;

  BR_HD void set(const StepTime& now) { wide.set(now); }
  BR_HD void operator()(Index i) const { at(wide.dt(), i); }
  BR_HD void update_at(const StepTime& now, Index i) const { at(now.last_dt, i); }

 private:
  BR_HD void at(double dt, Index i) const {
    const LaneGroup<width> group;
    const Index end = count[0];
    for (Index first = i / width; group.any_of_warp(first < end); first += groups * width) {
      const Index mine = first + groups * (i % width);
      unsigned due = group.ballot(mine < end && wide.is_due(busy[mine]));
      while (group.any_of_warp(due != 0)) {
        const Index c = due != 0 ? busy[first + groups * lowest_bit(due)] : wide.items();
        due &= due - 1;
        wide.evaluate(dt, c, static_cast<int>(i % width));
      }
    }
  }
};

/// The sums of forces that follow: they empty the list.
template <class Sums>
struct EmptiesList : Sums {
  Index* count;  ///< how many are listed; null: no list

  template <class Read>
  BR_HD void update(Index i, const Read& loaded) const {
    if (i == 0 && count != nullptr) *count = 0;
    Sums::update(i, loaded);
  }
};

template <class World, class Sums>
EmptiesList<Sums> emptying(World& w, const Sums& sums) {
  return {sums, w.busy.count.data()};
}

}  // namespace breccia::fdem_shared
