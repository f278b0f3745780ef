#pragma once
// Kernels of a device that give several threads to an item: as fast as they are only so
// (bench/notes/gpu.md). Space::shadow runs their lanes in lockstep.

#include "core/kernel.hpp"
#include "dem/element_kernels.hpp"
#include "domain/domain.hpp"
#include "exec/lockstep.hpp"

namespace breccia::dem {

/// One thread's sum of a stiffness, of K and of ratio K (StiffnessSums); none in a step that does
/// not evaluate.
template <bool evaluates>
struct WideStiffness {
  float straight, turning;
  BR_HD static WideStiffness read(const float* of, int column) {
    const float stiffness = read_now(of + column);
    return {stiffness, read_now(of + 8) * stiffness};
  }
  BR_HD void add(const WideStiffness& other) {
    straight += other.straight;
    turning += other.turning;
  }
};
template <>
struct WideStiffness<false> {
  BR_HD static WideStiffness read(const float*, int) { return {}; }
  BR_HD void add(const WideStiffness&) {}
};
/// Its sums.
/// @tparam evaluates  as StepTime
template <bool evaluates>
struct WideSum {
  double number;  ///< of force or torque
  WideStiffness<evaluates> stiffness;
  BR_HD void add(const WideSum& other) {
    number += other.number;
    stiffness.add(other.stiffness);
  }
};

/// GatherForces where every link has an action, by eight threads an element. Each adds up one
/// stiffness of what the element gets as a, and as b, in the order of GatherForces; six of them one
/// number, too, and write one number of force and torque.
/// @tparam Number  what actions of links are stored in
template <class Number>
struct GatherWide {
  static constexpr const char* name = "dem.gather_wide";
  static constexpr Index width = 8;
  static constexpr int at_once = 2;  ///< actions of a row that are read before the first is added
  GatherForces gather;
  LinkRows::Seen rows_a, rows_b;
  SplitActions<Number> actions;
  OwnedView owned;

  BR_HD void set(const StepTime& now) { gather.evaluates = now.evaluates; }
  /// One thread's columns of what an action holds.
  struct Columns {
    int number;  ///< for end a; for b three further
    int stiffness;
    BR_HD Columns b() const { return {number + 3, stiffness}; }
  };
  template <bool evaluates>
  BR_HD static WideSum<evaluates> read(const PairForce& action, const Columns& column) {
    return {read_now(action.numbers + column.number),
            WideStiffness<evaluates>::read(action.stiffness, column.stiffness)};
  }
  struct Row {
    Index next, end;
    BR_HD void find(const View<const Index>& starts, Index e) {
      next = read_now(starts.data + e);
      end = read_now(starts.data + e + 1);
    }
  };
  /// The next few links of a row, and what they do.
  struct Few {
    Index link[at_once];
    double number[at_once];
  };
  /// Past the end of a row its last link is read again: a branch would cost more.
  BR_HD static void list(Few& few, const Row& row, const Index* links) {
    const Index last = row.end > 0 ? row.end - 1 : 0;
    BR_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const Index place = row.next + k < last ? row.next + k : last;
      few.link[k] = read_now(links + place);
    }
  }
  BR_HD void read(Few& few, int column) const {
    BR_UNROLL
    for (int k = 0; k < at_once; ++k)
      few.number[k] = read_now(actions.numbers[few.link[k]].of + column);
  }
  template <bool evaluates>
  BR_HD void add(WideSum<evaluates>& sum, const Few& few, Row& row, int column) const {
    WideStiffness<evaluates> stiffness[at_once] = {};
    if (actions.size > 0) {
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        stiffness[k] = WideStiffness<evaluates>::read(actions.stiffness[few.link[k]].of, column);
    }
    BR_UNROLL
    for (int k = 0; k < at_once; ++k)
      if (row.next + k < row.end) sum.add({few.number[k], stiffness[k]});
    row.next += at_once;
  }
  /// A row of bars or contacts.
  template <bool evaluates>
  BR_HD static void add_pairs(WideSum<evaluates>& as_a, WideSum<evaluates>& as_b, Row row,
                              const Entry* entries, const PairForce* pairs, const Columns& column) {
    for (; row.next < row.end; row.next += at_once) {
      Entry entry[at_once];
      WideSum<evaluates> part[at_once] = {};
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end) entry[k] = entries[row.next + k];
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end)
          part[k] = read<evaluates>(pairs[pair_of(entry[k])],
                                    side_of(entry[k]) == 0 ? column : column.b());
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end) side_of(entry[k]) == 0 ? as_a.add(part[k]) : as_b.add(part[k]);
    }
  }
  /// Rows are as the last search left them; actions come from the launch before.
  struct Loaded {
    Row links_a, links_b, bars, contacts;
    Few as_a, as_b;
    double inertia;
    int fixed;
  };
  BR_HD static Columns column_of(Index i) {
    const int part = i % width;
    return {part < 6 ? part : 5, part};  // two threads repeat the sixth number
  }
  /// Threads beyond the last element repeat it.
  BR_HD Index element_of(Index i) const {
    const Index last = gather.force.size - 1;
    return i / width < last ? i / width : last;
  }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index e = element_of(i);
    loaded.links_a.find(rows_a.starts, e);
    loaded.links_b.find(rows_b.starts, e);
    loaded.bars.find(gather.bars.starts, e);
    loaded.contacts.find(gather.contacts.starts, e);
    loaded.inertia = read_now(i % width < 3 ? &gather.mass[e] : &gather.inertia[e]);
    loaded.fixed = gather.fixed[e];
    if (actions.size == 0) return;
    list(loaded.as_a, loaded.links_a, rows_a.links.data);
    list(loaded.as_b, loaded.links_b, rows_b.links.data);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    if (actions.size == 0) return;
    read(loaded.as_a, column_of(i).number);
    read(loaded.as_b, column_of(i).b().number);
  }
  /// @returns the critical number of an element of this rank, once. A ghost lacks pairs, and its
  ///          bound may be above its owner's.
  BR_HD double update(Index i, Loaded& loaded) const {
    return gather.evaluates ? total<true>(i, loaded) : total<false>(i, loaded);
  }

 private:
  template <bool evaluates>
  BR_HD double total(Index i, Loaded& loaded) const {
    const Index e = element_of(i);
    const int part = i % width;
    const Columns column = column_of(i);
    WideSum<evaluates> as_a{0.0, {}}, as_b{0.0, {}};
    for (;;) {
      add(as_a, loaded.as_a, loaded.links_a, column.stiffness);
      add(as_b, loaded.as_b, loaded.links_b, column.stiffness);
      if (loaded.links_a.next >= loaded.links_a.end && loaded.links_b.next >= loaded.links_b.end)
        break;
      list(loaded.as_a, loaded.links_a, rows_a.links.data);
      list(loaded.as_b, loaded.links_b, rows_b.links.data);
      read(loaded.as_a, column.number);
      read(loaded.as_b, column.b().number);
    }
    add_pairs(as_a, as_b, loaded.bars, gather.bars.entries.data, gather.bar_actions.data, column);
    add_pairs(as_a, as_b, loaded.contacts, gather.contacts.entries.data,
              gather.contact_actions.data, column);
    // Force x y z, then torque: what the element gets as b, and as a (with the opposite force).
    const LaneGroup<width> group;
    const int other = part < 3 ? part + 3 : part < 6 ? part - 3 : part;
    const double from_a = group.from(other, as_a.number);
    if (part < 3) reinterpret_cast<double*>(&gather.force[e])[part] = as_b.number - from_a;
    if (part >= 3 && part < 6)
      reinterpret_cast<double*>(&gather.torque[e])[part - 3] = as_b.number + from_a;
    if constexpr (evaluates)
      return critical_by(group, i, loaded, as_a.stiffness, as_b.stiffness);
    else
      return largest_least;
  }
  BR_HD double critical_by(const LaneGroup<width>& group, Index i, const Loaded& loaded,
                           const WideStiffness<true>& of_a, const WideStiffness<true>& of_b) const {
    const Index e = element_of(i);
    const int part = i % width;
    // Each thread has one component of the matrices; all of them find both bounds.
    const float straight_part = of_a.straight + of_b.straight;
    const float turning_part = of_a.turning + of_b.turning;
    Symmetric<float> straight, turning;
    BR_UNROLL
    for (int k = 0; k < 6; ++k) {
      straight.c[k] = group.from(1 + k, straight_part);
      turning.c[k] = group.from(1 + k, turning_part);
    }
    const float turn = group.from(0, of_a.straight) + group.from(7, of_b.straight);
    const Stiffest most = stiffest(straight, turning, turn);
    const bool of_straight = part < 3;
    const float largest = is_held(loaded.fixed, of_straight ? 0 : 3) ? 0.0F
                          : of_straight                              ? most.straight
                                                                     : most.turning;
    const double slow = static_cast<double>(largest) / loaded.inertia;
    const double slowest = max(slow, group.from(3, slow));
    if (part != 0) return largest_least;
    const double critical = slowest > 0.0 ? 1.0 / slowest : largest_least;
    gather.critical[e] = critical;
    return owned(e) ? critical : largest_least;
  }
};
/// Critical numbers that walls have changed.
struct NoteCritical {
  static constexpr const char* name = "dem.note_critical";
  View<const double> critical;
  BR_HD void set(const StepTime&) {}
  BR_HD double operator()(Index e) const { return critical[e]; }
};

}  // namespace breccia::dem
