// The step of dem/step.cpp on a device: the same kernels in the same order, launched ahead by the
// device's clock.

#include "dem/launches.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// MoveElements, and the question whether a search is due.
struct MoveAndWatch {
  static constexpr const char* name = "dem.move_and_watch";
  MoveElements move;
  UsedMargin used;
  int search_every;  ///< the paper's rule: steps between searches; 0: by travel
  View<StepClock> clock;

  BR_HD void set(const Moment& now) { move.set(now); }
  BR_HD void operator()(Index e) const {
    move(e);
    StepClock& c = clock[0];
    if (search_every > 0) {
      if (e == 0 && c.step % search_every == 0) c.wanted = 1;
    } else if (used(e) > 0.0) {
      c.wanted = 1;
    }
  }
};

struct MoveWalls {
  static constexpr const char* name = "dem.move_walls";
  double dt, largest_travel;
  int search_every;
  View<Wall> walls;
  View<StepClock> clock;

  BR_HD void set(const Moment& now) { dt = now.next_dt; }
  BR_HD void operator()(Index k) const {
    Wall& wall = walls[k];
    wall.point += dt * wall.velocity;
    wall.travelled += dt * norm(wall.velocity);
    if (search_every == 0 && wall.travelled > largest_travel) clock[0].wanted = 1;
  }
};

/// GatherRows by sixteen threads an element, of which twelve each add up one number and one
/// stiffness, in the same order; six then write force and torque.
struct GatherWide {
  static constexpr const char* name = "dem.gather_wide";
  static constexpr Index width = 16;
  GatherRows all;

  BR_HD void set(const Moment&) {}
#if defined(__CUDA_ARCH__)
  struct Sums {
    double number = 0.0;
    float stiffness = 0.0F;
    __device__ void add(const Action& action, int column) {
      number += action.numbers[column];
      stiffness += action.stiffness[column];
    }
  };
  __device__ static void add(Sums& sums, const IncidenceView& rows,
                             const View<const Action>& actions, Index e, int side, int column) {
    const Index end = rows.last(e);
    for (Index k = rows.first(e); k < end; ++k) {
      const Entry entry = rows.entries[k];
      if (side_of(entry) == side) sums.add(actions[pair_of(entry)], column);
    }
  }
  /// @returns the critical number of the element, once
  __device__ double operator()(Index i) const {
    const GatherForces& gather = all.gather;
    const Index e = i / width;
    const int part = i % width, side = part < 6 ? 0 : 1, column = side == 0 ? part : part - 3;
    Sums sums;
    if (part < 12) {
      // Pointers are chosen, not structs: a struct with an address would move to local memory.
      const Index* const starts = side == 0 ? all.rows_a.starts.data : all.rows_b.starts.data;
      const Index* const links = side == 0 ? all.rows_a.links.data : all.rows_b.links.data;
      const Index end = starts[e + 1];
#pragma unroll 4
      for (Index k = starts[e]; k < end; ++k) sums.add(all.actions.data[links[k]], column);
      add(sums, gather.bars, gather.bar_actions, e, side, column);
      add(sums, gather.contacts, gather.contact_actions, e, side, column);
    }
    // Force x y z, then torque: what the element gets as b, and as a (with the opposite force).
    const unsigned group = 0xffffU << (threadIdx.x / width * width % 32);
    const int as_b = 6 + part % 6, as_a = part % 6 < 3 ? 3 + part % 6 : part % 6 - 3;
    const double from_b = __shfl_sync(group, sums.number, as_b, width);
    const double from_a = __shfl_sync(group, sums.number, as_a, width);
    const float stiffness_b = __shfl_sync(group, sums.stiffness, as_b, width);
    float stiffness = __shfl_sync(group, sums.stiffness, as_a, width) + stiffness_b;
    if (part < 3) reinterpret_cast<double*>(&gather.force[e])[part] = from_b - from_a;
    if (part >= 3 && part < 6)
      reinterpret_cast<double*>(&gather.torque[e])[part - 3] = from_b + from_a;
    if (part >= 6 || (gather.fixed[e] >> part & 1) != 0 || !(stiffness > 0.0F)) stiffness = 0.0F;
    float largest = stiffness;  // of three neighbours
    largest = fmaxf(largest, __shfl_down_sync(group, stiffness, 1, width));
    largest = fmaxf(largest, __shfl_down_sync(group, stiffness, 2, width));
    const float turning = __shfl_sync(group, largest, 3, width);
    if (part != 0) return largest_least;
    const double slowest = larger(static_cast<double>(largest) / gather.mass[e],
                                  static_cast<double>(turning) / gather.inertia[e]);
    const double critical = slowest > 0.0 ? 1.0 / slowest : largest_least;
    gather.critical[e] = critical;
    return critical;
  }
#else
  double operator()(Index) const {
    return largest_least;
  }
#endif
};
struct NoteCritical {
  static constexpr const char* name = "dem.note_critical";
  View<const double> critical;
  BR_HD void set(const Moment&) {}
  BR_HD double operator()(Index e) const { return critical[e]; }
};

/// Links of all groups in one launch.
template <class Kernel, class Law>
struct Grouped {
  static constexpr int most = 8;
  Kernel kernel;
  Index end[most];  ///< of each group
  View<const Law> laws;

  Grouped(const Kernel& all, const std::vector<LinkGroup<Law>>& groups,
          const Buffer<Law>& group_laws)
      : kernel(all), laws(group_laws.view()) {
    for (std::size_t g = 0; g < most; ++g) end[g] = g < groups.size() ? groups[g].end : 0;
  }
  BR_HD void set(const Moment& now) { kernel.set(now); }
  BR_HD void operator()(Index i) const {
    int group = 0;  // counted, not sought: an index into a parameter would move it to local memory
    for (int g = 0; g < most - 1; ++g) group += i >= end[g] && end[g] > 0 ? 1 : 0;
    Kernel own = kernel;
    own.law = laws[group];
    own(i);
  }
};

#if defined(__CUDACC__)
/// All links and contacts.
void launch_interactions(World& w) {
  const auto after = [&](const auto& kernel) { return timed<true>(kernel, w.clock); };
  const LinkGroup<ConcreteLink> no_concrete{};
  const LinkGroup<SteelLink> no_steel{};
  const LinkGroup<InterfaceLink> no_interface{};
  const Grouped<ConcreteLinkForces, ConcreteLink> concrete(concrete_kernel(w, no_concrete),
                                                           w.concrete_groups, w.concrete_laws);
  const Grouped<SteelLinkForces, SteelLink> steel(steel_kernel(w, no_steel), w.steel_groups,
                                                  w.steel_laws);
  const Grouped<InterfaceLinkForces, InterfaceLink> interface(interface_kernel(w, no_interface),
                                                              w.interface_groups, w.interface_laws);
  for_each_part(part(w.steel.size(), after(steel),
                     part(w.interface.size(), after(interface),
                          part(w.contacts.size(), after(contact_kernel(w)),
                               part(w.concrete.size(), after(concrete), Parts<>{})))));
}

void launch_step(World& w) {
  const Exec& exec = w.exec;
  const Index elements = w.elements.size();
  const int every = w.parameters.search.every;
  if (!w.walls.empty())
    for_each(exec, w.device_walls.size(),
             timed<false>(MoveWalls{0.0, w.parameters.largest_margin, every, w.device_walls.view(),
                                    w.clock.view()},
                          w.clock));
  for_each(exec, elements,
           timed<false>(MoveAndWatch{move_kernel(w),
                                     {w.elements.state.view(), w.travel.reference.view(),
                                      w.travel.margin.view()},
                                     every,
                                     w.clock.view()},
                        w.clock));
  launch_interactions(w);
  const FinishStep<StepRule> finish{step_rule(w), w.parameters.time.evaluate_every, w.clock.view()};
  if (w.walls.empty()) {
    for_each_then(elements * GatherWide::width,
                  timed<true>(GatherWide{gather_rows_kernel(w)}, w.clock), w.blocks_done, finish);
    return;
  }
  for_each(exec, elements * GatherWide::width,
           timed<true>(GatherWide{gather_rows_kernel(w)}, w.clock));
  for (Index k = 0; k < w.device_walls.size(); ++k) {
    const auto wall = static_cast<std::size_t>(k);
    for_each(exec, w.wall_begin[wall + 1] - w.wall_begin[wall],
             timed<true>(wall_kernel(w, k), w.clock));
  }
  for_each_then(elements, timed<true>(NoteCritical{std::as_const(w.critical).view()}, w.clock),
                w.blocks_done, finish);
}
#else
void launch_step(World&) {}
#endif

}  // namespace

Advanced advance_on_device(World& w, const StopAt& stop) {
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const bool walls = !w.walls.empty();
  if (walls) copy_to(w.device_walls, w.walls);
  const Advanced taken = run_ahead(
      w.clock, w.graphs, host, stop, [&] { launch_step(w); },
      [&](std::int32_t) {
        if (walls) copy_to(w.walls, w.device_walls);
        find_contacts(w);
        if (walls) copy_to(w.device_walls, w.walls);
        evaluate_forces(w);
      });
  if (walls) copy_to(w.walls, w.device_walls);
  return taken;
}

}  // namespace breccia::dem
