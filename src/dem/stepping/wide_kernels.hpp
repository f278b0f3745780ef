#pragma once
// Kernels of a device that give several threads to an item: as fast as they are only so
// (bench/notes/gpu.md). Space::shadow runs their lanes in lockstep.

#include "core/kernel.hpp"
#include "dem/element_kernels.hpp"
#include "domain/domain.hpp"
#include "exec/lockstep.hpp"

namespace breccia::dem {

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
  View<const PairForceOf<Number>> actions;
  OwnedView owned;

  BR_HD void set(const StepTime&) {}
  struct Sum {
    double number;
    float straight, turning;  ///< of StiffnessSums
    BR_HD void add(const Sum& other) {
      number += other.number;
      straight += other.straight;
      turning += other.turning;
    }
  };
  /// One thread's columns of what an action holds.
  struct Columns {
    int number;  ///< for end a; for b three further
    int stiffness;
    BR_HD Columns b() const { return {number + 3, stiffness}; }
  };
  template <class Of>
  BR_HD static Sum read(const Of& action, const Columns& column) {
    const float stiffness = read_now(action.stiffness + column.stiffness);
    return {read_now(action.numbers + column.number), stiffness,
            read_now(action.stiffness + 8) * stiffness};
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
    Sum part[at_once];
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
  BR_HD void read(Few& few, const Columns& column) const {
    BR_UNROLL
    for (int k = 0; k < at_once; ++k) few.part[k] = read(actions.data[few.link[k]], column);
  }
  BR_HD static void add(Sum& sum, const Few& few, Row& row) {
    BR_UNROLL
    for (int k = 0; k < at_once; ++k)
      if (row.next + k < row.end) sum.add(few.part[k]);
    row.next += at_once;
  }
  /// A row of bars or contacts.
  BR_HD static void add_pairs(Sum& as_a, Sum& as_b, Row row, const Entry* entries,
                              const PairForce* actions, const Columns& column) {
    for (; row.next < row.end; row.next += at_once) {
      Entry entry[at_once];
      Sum part[at_once];
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end) entry[k] = entries[row.next + k];
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end)
          part[k] = read(actions[pair_of(entry[k])], side_of(entry[k]) == 0 ? column : column.b());
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
    read(loaded.as_a, column_of(i));
    read(loaded.as_b, column_of(i).b());
  }
  /// @returns the critical number of an element of this rank, once. A ghost lacks pairs, and its
  ///          bound may be above its owner's.
  BR_HD double update(Index i, Loaded& loaded) const {
    const Index e = element_of(i);
    const int part = i % width;
    const Columns column = column_of(i);
    Sum as_a{0.0, 0.0F, 0.0F}, as_b{0.0, 0.0F, 0.0F};
    for (;;) {
      add(as_a, loaded.as_a, loaded.links_a);
      add(as_b, loaded.as_b, loaded.links_b);
      if (loaded.links_a.next >= loaded.links_a.end && loaded.links_b.next >= loaded.links_b.end)
        break;
      list(loaded.as_a, loaded.links_a, rows_a.links.data);
      list(loaded.as_b, loaded.links_b, rows_b.links.data);
      read(loaded.as_a, column);
      read(loaded.as_b, column.b());
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
    // Each thread has one component of the matrices; all of them find both bounds.
    const float straight_part = as_a.straight + as_b.straight;
    const float turning_part = as_a.turning + as_b.turning;
    Symmetric<float> straight, turning;
    BR_UNROLL
    for (int k = 0; k < 6; ++k) {
      straight.c[k] = group.from(1 + k, straight_part);
      turning.c[k] = group.from(1 + k, turning_part);
    }
    const float turn = group.from(0, as_a.straight) + group.from(7, as_b.straight);
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
