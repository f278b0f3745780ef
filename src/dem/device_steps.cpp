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

/// GatherRows, noting the least inertia over stiffness where nothing is added to it later.
struct GatherAndNote {
  static constexpr const char* name = "dem.gather_and_note";
  GatherRows gather;
  View<StepClock> clock;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index e) const {
    gather(e);
    note_least(clock[0], gather.gather.critical[e]);
  }
};
struct NoteCritical {
  static constexpr const char* name = "dem.note_critical";
  View<const double> critical;
  View<StepClock> clock;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index e) const { note_least(clock[0], critical[e]); }
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
    int group = 0;
    while (i >= end[group]) ++group;
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
    for_each_then(elements,
                  timed<true>(GatherAndNote{gather_rows_kernel(w), w.clock.view()}, w.clock),
                  w.blocks_done, finish);
    return;
  }
  for_each(exec, elements, timed<true>(gather_rows_kernel(w), w.clock));
  for (Index k = 0; k < w.device_walls.size(); ++k) {
    const auto wall = static_cast<std::size_t>(k);
    for_each(exec, w.wall_begin[wall + 1] - w.wall_begin[wall],
             timed<true>(wall_kernel(w, k), w.clock));
  }
  for_each_then(
      elements,
      timed<true>(NoteCritical{std::as_const(w.critical).view(), w.clock.view()}, w.clock),
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
      [&] {
        if (walls) copy_to(w.walls, w.device_walls);
        find_contacts(w);
        if (walls) copy_to(w.device_walls, w.walls);
        evaluate_forces(w);
      });
  if (walls) copy_to(w.walls, w.device_walls);
  return taken;
}

}  // namespace breccia::dem
