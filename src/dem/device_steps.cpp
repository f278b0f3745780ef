// The step of dem/step.cpp on a device: the kernels of the host in the same order, launched ahead
// by the device's clock. In Space::shadow the processor carries the launches out.

#include "core/device_run.hpp"
#include "dem/launches.hpp"
#include "exec/early.hpp"
#include "exec/for_each.hpp"
#include "exec/lockstep.hpp"

namespace breccia::dem {
namespace {

/// MoveElements, and the question whether a search is due.
struct MoveAndWatch {
  static constexpr const char* name = "dem.move_and_watch";
  MoveElements move;
  UsedMargin used;
  int search_every;  ///< the paper's rule: steps between searches; 0: by travel
  std::int32_t* wanted;
  std::int64_t step = 0;

  BR_HD void set(const StepTime& now) {
    move.set(now);
    step = now.step;
  }
  /// What the sums of forces, which end while these are read, do not write; and then those sums.
  struct Loaded {
    ElementState state;
    Quaternion turn;
    Kick::Given given;
    Vec3 reference;
    double margin;
  };
  BR_HD void load_early(Index e, Loaded& loaded) const {
    loaded.state = read_record_now(&move.kick.state[e]);
    loaded.turn = read_record_now(&move.orientation[e]);
    loaded.given.mass = read_now(&move.kick.mass[e]);
    loaded.given.inertia = read_now(&move.kick.inertia[e]);
    loaded.given.fixed = move.kick.fixed[e];
    loaded.reference = read_vector(used.reference, e);
    loaded.margin = read_now(&used.margin[e]);
  }
  BR_HD void load_late(Index e, Loaded& loaded) const {
    loaded.given.force = read_vector(move.kick.force, e);
    loaded.given.torque = read_vector(move.kick.torque, e);
  }
  BR_HD void update(Index e, const Loaded& loaded) const {
    const Vec3 position = move.moved(e, loaded.state, loaded.turn, loaded.given);
    if (search_every > 0) {
      if (e == 0 && step % search_every == 0) *wanted = 1;
    } else if (UsedMargin::beyond(position, loaded.reference, loaded.margin)) {
      *wanted = 1;
    }
  }

 private:
  BR_HD static Vec3 read_vector(const View<const Vec3>& vectors, Index e) {
    const Vec3& v = vectors[e];
    return {read_now(&v.x), read_now(&v.y), read_now(&v.z)};
  }
};

/// The same for what this rank owns: copies follow their owners.
struct MoveOwn : MoveAndWatch {
  OwnedView owned;
  StepClock* clock;  ///< for the sums to note in
  BR_HD void update(Index e, const Loaded& loaded) const {
    if (e == 0) clock->least = ordered_bits(largest_least);
    if (owned(e)) MoveAndWatch::update(e, loaded);
  }
};

struct MoveWalls {
  static constexpr const char* name = "dem.move_walls";
  double dt, largest_travel;
  int search_every;
  View<Wall> walls;
  std::int32_t* wanted;

  BR_HD void set(const StepTime& now) { dt = now.next_dt; }
  BR_HD void operator()(Index k) const {
    Wall& wall = walls[k];
    wall.point += dt * wall.velocity;
    wall.travelled += dt * norm(wall.velocity);
    if (search_every == 0 && wall.travelled > largest_travel) *wanted = 1;
  }
};

/// GatherRows by eight threads an element, of which six each add up one number and one stiffness of
/// what it gets as a, and as b, in the same order, and write one number of force and torque.
template <class Number>
struct GatherWide {
  static constexpr const char* name = "dem.gather_wide";
  static constexpr Index width = 8;
  static constexpr int at_once = 4;  ///< actions of a row that are read before the first is added
  GatherRows<Number> all;

  BR_HD void set(const StepTime&) {}
  struct Sum {
    double number;
    float stiffness;
    BR_HD void add(const Sum& other) {
      number += other.number;
      stiffness += other.stiffness;
    }
  };
  BR_HD static Sum read(const Action* action, int column) {
    return {action->numbers[column], action->stiffness[column]};
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
  BR_HD void read(Few& few, int column) const {
    BR_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const ActionOf<Number>& action = all.actions.data[few.link[k]];
      few.part[k] = {read_now(action.numbers + column), read_now(action.stiffness + column)};
    }
  }
  BR_HD static void add(Sum& sum, const Few& few, Row& row) {
    BR_UNROLL
    for (int k = 0; k < at_once; ++k)
      if (row.next + k < row.end) sum.add(few.part[k]);
    row.next += at_once;
  }
  /// A row of bars or contacts.
  BR_HD static void add_pairs(Sum& as_a, Sum& as_b, Row row, const Entry* entries,
                              const Action* actions, int column) {
    for (; row.next < row.end; row.next += at_once) {
      Entry entry[at_once];
      Sum part[at_once];
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end) entry[k] = entries[row.next + k];
      BR_UNROLL
      for (int k = 0; k < at_once; ++k)
        if (row.next + k < row.end)
          part[k] = read(actions + pair_of(entry[k]), column + 3 * side_of(entry[k]));
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
  BR_HD static int column_of(Index i) {
    const int part = i % width;
    return part < 6 ? part : 5;  // two threads repeat the sixth
  }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index e = i / width;
    loaded.links_a.find(all.rows_a.starts, e);
    loaded.links_b.find(all.rows_b.starts, e);
    loaded.bars.find(all.gather.bars.starts, e);
    loaded.contacts.find(all.gather.contacts.starts, e);
    loaded.inertia = read_now(i % width < 3 ? &all.gather.mass[e] : &all.gather.inertia[e]);
    loaded.fixed = all.gather.fixed[e];
    if (all.actions.size == 0) return;
    list(loaded.as_a, loaded.links_a, all.rows_a.links.data);
    list(loaded.as_b, loaded.links_b, all.rows_b.links.data);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    if (all.actions.size == 0) return;
    read(loaded.as_a, column_of(i));
    read(loaded.as_b, column_of(i) + 3);
  }
  /// @returns the critical number of the element, once
  BR_HD double update(Index i, Loaded& loaded) const {
    const GatherForces& gather = all.gather;
    const Index e = i / width;
    const int part = i % width, column = column_of(i), fixed = loaded.fixed;
    Sum as_a{0.0, 0.0F}, as_b{0.0, 0.0F};
    for (;;) {
      add(as_a, loaded.as_a, loaded.links_a);
      add(as_b, loaded.as_b, loaded.links_b);
      if (loaded.links_a.next >= loaded.links_a.end && loaded.links_b.next >= loaded.links_b.end)
        break;
      list(loaded.as_a, loaded.links_a, all.rows_a.links.data);
      list(loaded.as_b, loaded.links_b, all.rows_b.links.data);
      read(loaded.as_a, column);
      read(loaded.as_b, column + 3);
    }
    add_pairs(as_a, as_b, loaded.bars, gather.bars.entries.data, gather.bar_actions.data, column);
    add_pairs(as_a, as_b, loaded.contacts, gather.contacts.entries.data,
              gather.contact_actions.data, column);
    // Force x y z, then torque: what the element gets as b, and as a (with the opposite force).
    const LaneGroup<width> group;
    const int other = part < 3 ? part + 3 : part < 6 ? part - 3 : part;
    const double from_a = group.from(other, as_a.number);
    float stiffness = group.from(other, as_a.stiffness) + as_b.stiffness;
    if (part < 3) reinterpret_cast<double*>(&gather.force[e])[part] = as_b.number - from_a;
    if (part >= 3 && part < 6)
      reinterpret_cast<double*>(&gather.torque[e])[part - 3] = as_b.number + from_a;
    if (part >= 6 || (fixed >> part & 1) != 0 || !(stiffness > 0.0F)) stiffness = 0.0F;
    float largest = stiffness;  // of three neighbours
    largest = std::fmax(largest, group.from_next(1, stiffness));
    largest = std::fmax(largest, group.from_next(2, stiffness));
    const double slow = static_cast<double>(largest) / loaded.inertia;
    const double slowest = larger(slow, group.from(3, slow));
    if (part != 0) return largest_least;
    const double critical = slowest > 0.0 ? 1.0 / slowest : largest_least;
    gather.critical[e] = critical;
    return critical;
  }
};
struct NoteCritical {
  static constexpr const char* name = "dem.note_critical";
  View<const double> critical;
  BR_HD void set(const StepTime&) {}
  BR_HD double operator()(Index e) const { return critical[e]; }
};

/// Links of all groups in one launch.
template <class Kernel, class Law>
struct Grouped {
  Kernel kernel;
  View<const Index> ends;  ///< of each group
  View<const Law> laws;

  Grouped(const Kernel& all, const GroupLaws<Law>& groups)
      : kernel(all), ends(groups.ends.view()), laws(groups.laws.view()) {}
  BR_HD void set(const StepTime& now) { kernel.set(now); }
  BR_HD const Law& law_of(Index i) const { return laws[group_of(ends, i)]; }
  BR_HD void operator()(Index i) const {
    if constexpr (std::is_same_v<Kernel, InterfaceLinkForces>) {
      kernel.with(law_of(i), i);
    } else {
      Kernel own = kernel;
      own.law = law_of(i);
      own(i);
    }
  }
};

/// Concrete links of all groups: what they keep is read ahead, motion ends while it comes.
template <class Number>
struct ConcreteAhead : Grouped<ConcreteLinkForces<Number>, ConcreteLink> {
  using Base = Grouped<ConcreteLinkForces<Number>, ConcreteLink>;
  using Base::Base;
  using Base::kernel;

  struct Loaded {
    Index a, b, group;
    double length, stiffness;
    LinkState<double> state;
    ElementState end_a, end_b;
  };
  BR_HD static Vec3 read_vector(const PlanesView<Number>& planes, Index i) {
    const Number* const x = planes.items.data + i;
    return {read_now(x), read_now(x + planes.stride), read_now(x + 2 * planes.stride)};
  }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    loaded.a = read_now(&kernel.a[i]);
    loaded.b = read_now(&kernel.b[i]);
    loaded.group = group_of(this->ends, i);
    loaded.length = read_now(&kernel.length[i]);
    loaded.stiffness = read_now(&kernel.stiffness[i]);
    loaded.state.opening = read_now(&kernel.opening[i]);
    loaded.state.shear = read_vector(kernel.shear, i);
    loaded.state.moment = read_vector(kernel.moment, i);
  }
  BR_HD void load_late(Index, Loaded& loaded) const {
    loaded.end_a = read_record_now(&kernel.elements.state[loaded.a]);
    loaded.end_b = read_record_now(&kernel.elements.state[loaded.b]);
  }
  BR_HD void update(Index i, const Loaded& loaded) const {
    ConcreteLinkForces<Number> own = kernel;
    own.law = this->laws[loaded.group];
    own.template answer<double>(i, end(loaded.end_a), loaded.end_a.radius, end(loaded.end_b),
                                loaded.end_b.radius, loaded.length, loaded.stiffness, loaded.state);
  }

 private:
  BR_HD static PairEnd<double> end(const ElementState& s) {
    return {s.position, s.velocity, s.spin};
  }
};

EndOfStep<StepRule> end_of_step(const World& w) {
  return {step_rule(w), w.parameters.time.evaluate_every};
}

void launch_move(World& w, const StepClocks& clocks) {
  const int every = w.parameters.search.every;
  std::int32_t* const wanted = &clocks.now->wanted;
  const EndOfStep<StepRule> end = end_of_step(w);
  const MoveAndWatch move{
      move_kernel(w),
      {w.elements.state.view(), w.travel.reference.view(), w.travel.margin.view()},
      every,
      wanted};
  const MoveWalls walls{0.0, w.parameters.largest_margin, every, w.device_walls.view(), wanted};
  for_each_part(w.exec, part(w.device_walls.size(), clocks.opening(walls, end, false),
                             part(w.elements.size(), clocks.opening(move, end, true), Parts<>{})));
}

/// All links and contacts. `by` wraps a kernel by the clock.
template <class Number, class By>
void launch_interactions(World& w, const By& by) {
  const LinkGroup<ConcreteLink> no_concrete{};
  const LinkGroup<SteelLink> no_steel{};
  const LinkGroup<InterfaceLink> no_interface{};
  const ConcreteAhead<Number> concrete(concrete_kernel<Number>(w, no_concrete), w.concrete_laws);
  const Grouped<SteelLinkForces, SteelLink> steel(steel_kernel(w, no_steel), w.steel_laws);
  const Grouped<InterfaceLinkForces, InterfaceLink> interface(interface_kernel(w, no_interface),
                                                              w.interface_laws);
  for_each_part(w.exec, part(w.steel.size(), by(steel),
                             part(w.interface.size(), by(interface),
                                  part(w.contacts.size(), by(contact_kernel(w)),
                                       part(w.concrete.size(), by(concrete), Parts<>{})))));
}

/// Forces and sums, and the least critical number.
template <class Number, class By>
void launch_forces(World& w, StepClock* clock, const By& by) {
  const Exec& exec = w.exec;
  const Index threads = w.elements.size() * GatherWide<Number>::width;
  launch_interactions<Number>(w, by);
  const auto gather = by(GatherWide<Number>{gather_rows_kernel<Number>(w)});
  if (w.walls.empty()) return for_each_noting(w.exec, threads, gather, NoteLeast{clock});
  for_each_part(w.exec, part(threads, gather, Parts<>{}));
  for (Index k = 0; k < w.device_walls.size(); ++k) {
    const auto wall = static_cast<std::size_t>(k);
    for_each(exec, w.wall_begin[wall + 1] - w.wall_begin[wall], by(wall_kernel(w, k)));
  }
  for_each_noting(w.exec, w.elements.size(), by(NoteCritical{std::as_const(w.critical).view()}),
                  NoteLeast{clock});
}

void launch_step(World& w, const StepClocks& clocks) {
  launch_move(w, clocks);
  with_number(w.exec.precision, [&](auto number) {
    launch_forces<decltype(number)>(
        w, clocks.now, [&](const auto& kernel) { return clocks.timed<Stand::after_move>(kernel); });
  });
}
void launch_rest(World& w, const StepClocks& clocks) {
  with_number(w.exec.precision, [&](auto number) {
    launch_forces<decltype(number)>(
        w, clocks.now, [&](const auto& kernel) { return clocks.timed<Stand::in_rest>(kernel); });
  });
}

}  // namespace

void move_on_device(World& w) {
  const ShadowLaunches launches;
  w.beyond.resize(1);
  w.clock.resize(1);
  const MoveAndWatch move{
      move_kernel(w),
      {w.elements.state.view(), w.travel.reference.view(), w.travel.margin.view()},
      0,
      w.beyond.data()};
  for_each_part(
      w.exec, part(w.elements.size(), AtOnce(MoveOwn{move, w.domain.owned_view(), w.clock.data()}),
                   Parts<>{}));
  mark_launches(w.exec.space);
}
void forces_on_device(World& w) {
  const ShadowLaunches launches;
  const StageTime timed(w.exec, "forces");
  for_each(w.exec, 1, Fence{});
  with_number(w.exec.precision, [&w](auto number) {
    using Gather = GatherWide<decltype(number)>;
    const auto at_once = [](const auto& kernel) { return AtOnce(kernel); };
    launch_interactions<decltype(number)>(w, at_once);
    const Index threads = w.elements.size() * Gather::width;
    const auto gather = at_once(Gather{gather_rows_kernel<decltype(number)>(w)});
    if (sums_note_least(w))
      for_each_noting(w.exec, threads, gather, NoteLeast{w.clock.data()});
    else
      for_each_part(w.exec, part(threads, gather, Parts<>{}));
  });
  mark_launches(w.exec.space);
}

Advanced advance_on_device(World& w, const StopAt& stop) {
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const bool walls = !w.walls.empty();
  if (walls) copy_to(w.device_walls, w.walls);
  const Advanced taken = run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks) { launch_step(w, clocks); },
      [&](const StepClocks& clocks) { launch_rest(w, clocks); },
      [&](std::int32_t) {
        if (walls) copy_to(w.walls, w.device_walls);
        find_contacts(w);
        if (walls) copy_to(w.device_walls, w.walls);
        return false;
      });
  if (walls) copy_to(w.walls, w.device_walls);
  return taken;
}

}  // namespace breccia::dem
