// The step of dem/step.cpp on a device: the same kernels in the same order, launched ahead by the
// device's clock.

#include "core/device_run.hpp"
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

constexpr bool moved = true;

void launch_step(World& w) {
  const Exec& exec = w.exec;
  const Index elements = w.elements.size();
  const auto before = [&](Index count, const auto& kernel) {
    for_each(exec, count, timed<!moved>(kernel, w.clock));
  };
  const auto after = [&](Index count, const auto& kernel) {
    for_each(exec, count, timed<moved>(kernel, w.clock));
  };
  const int every = w.parameters.search.every;
  if (!w.walls.empty())
    before(w.device_walls.size(), MoveWalls{0.0, w.parameters.largest_margin, every,
                                            w.device_walls.view(), w.clock.view()});
  before(elements,
         MoveAndWatch{move_kernel(w),
                      {w.elements.state.view(), w.travel.reference.view(), w.travel.margin.view()},
                      every,
                      w.clock.view()});

  for (const auto& group : w.steel_groups)
    after(group.end - group.begin, Shifted<SteelLinkForces>{steel_kernel(w, group), group.begin});
  for (const auto& group : w.interface_groups)
    after(group.end - group.begin,
          Shifted<InterfaceLinkForces>{interface_kernel(w, group), group.begin});
  after(w.contacts.size(), contact_kernel(w));
  for (const auto& group : w.concrete_groups)
    after(group.end - group.begin,
          Shifted<ConcreteLinkForces>{concrete_kernel(w, group), group.begin});
  if (w.walls.empty()) {
    after(elements, GatherAndNote{gather_rows_kernel(w), w.clock.view()});
  } else {
    after(elements, gather_rows_kernel(w));
    for (Index k = 0; k < w.device_walls.size(); ++k) {
      const auto wall = static_cast<std::size_t>(k);
      after(w.wall_begin[wall + 1] - w.wall_begin[wall], wall_kernel(w, k));
    }
    after(elements, NoteCritical{std::as_const(w.critical).view(), w.clock.view()});
  }
  for_each(exec, 1,
           FinishStep<StepRule>{step_rule(w), w.parameters.time.evaluate_every, w.clock.view()});
}

}  // namespace

Advanced advance_on_device(World& w, const StopAt& stop) {
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const bool walls = !w.walls.empty();
  if (walls) copy_to(w.device_walls, w.walls);
  const Advanced taken = run_ahead(
      w.clock, w.graph, host, stop, [&] { launch_step(w); },
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
