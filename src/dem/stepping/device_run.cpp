// The step of dem/stepping/step.hpp by launches of a device. In Space::shadow the processor carries
// them out.

#include "core/device_run.hpp"

#include "dem/stepping/launches.hpp"
#include "dem/stepping/step.hpp"
#include "dem/tiles/tile_run.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// MoveElements of what this rank owns, ghosts follow their owners; and the question whether a
/// search is due.
struct MoveAndWatch {
  static constexpr const char* name = "dem.move_and_watch";
  MoveElements move;
  int search_every;  ///< the paper's rule: steps between searches; 0: by travel
  std::int32_t* host_request;
  OwnedView owned;
  StepClock* noted;  ///< for the sums to note their least number in; null: the clock does it
  std::int64_t step = 0;

  using Loaded = MoveElements::Loaded<double>;
  BR_HD void set(const StepTime& now) {
    move.set(now);
    step = now.step;
  }
  BR_HD void load_early(Index e, Loaded& loaded) const { move.load_early(e, loaded); }
  BR_HD void load_late(Index e, Loaded& loaded) const { move.load_late(e, loaded); }
  BR_HD void update(Index e, const Loaded& loaded) const {
    if (e == 0 && noted != nullptr) noted->least = ordered_bits(largest_least);
    if (!owned(e)) return;
    const bool used_up = move.update(e, loaded);
    if (search_every > 0 ? e == 0 && step % search_every == 0 : used_up) *host_request = 1;
  }
};

struct MoveWalls {
  static constexpr const char* name = "dem.move_walls";
  StepTime now;
  double largest_travel;
  Vec3 drift;  ///<  [m/s]
  int search_every;
  View<Wall> walls;
  View<const Motion> motions;  ///< the last ones are those of walls
  View<const double> times, factors;
  std::int32_t* host_request;

  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index k) const {
    Wall& wall = walls[k];
    const double dt = now.next_dt;
    wall.velocity = motions[motions.size - walls.size + k].at(now.time + 0.5 * dt, times, factors);
    wall.move(dt, drift);
    if (search_every == 0 && wall.travelled > largest_travel) *host_request = 1;
  }
};

/// Links of all groups in one launch, each by its group's law.
/// @tparam parts  of the law of concrete, those that some group may have
template <class Kernel, ConcreteParts parts = concrete_all>
struct Grouped {
  static constexpr const char* name = Kernel::name;
  using Law = typename Kernel::Law;
  Kernel kernel;
  View<const Index> ends;  ///< of each group
  View<const Law> laws;

  template <class Groups>
  Grouped(const Kernel& all, const Groups& groups)
      : kernel(all), ends(groups.ends.view()), laws(groups.template as<Law>().view()) {}
  struct Loaded {
    typename LoadedBy<Kernel>::Loaded link;
    Index group;
  };
  BR_HD void set(const StepTime& now) { kernel.set(now); }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    kernel.load_early(i, loaded.link);
    loaded.group = group_of(ends, i);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const { kernel.load_late(i, loaded.link); }
  BR_HD void update(Index i, const Loaded& loaded) const {
    const Law& law = laws[loaded.group];  // by reference: a copy fills registers
    if constexpr (requires { kernel.template update<parts>(law, i, loaded.link); })
      kernel.template update<parts>(law, i, loaded.link);
    else
      kernel.update(law, i, loaded.link);
  }
};

EndOfStep<StepRule> end_of_step(const World& w) {
  return {step_rule(w), w.given->time.evaluate_every};
}

/// A step by launches. `By` wraps each kernel: to run at once, or by the device's clock.
template <class By>
class LaunchedForces {
 public:
  /// @param clock  in which sums note their least number; null: not noted
  LaunchedForces(const By& by, StepClock* clock) : by_(by), clock_(clock) {}

  /// All links and contacts in one launch.
  void pair_forces(World& w) const {
    with_arithmetic(w.exec.precision, [&](auto number) { pair_forces<decltype(number)>(w); });
  }
  void sum_forces(World& w) const {
    if (w.ldpm.size() > 0)
      for_each_part(w.exec, part(w.ldpm.edges.size(), by_(edge_kernel(w)), Parts<>{}));
    with_number(w.exec.precision, [&](auto number) {
      using Sums = GatherWide<decltype(number)>;
      const Index threads = w.elements.size() * Sums::width;
      const auto sums = by_(gather_wide_kernel<decltype(number)>(w));
      if (clock_ != nullptr && w.walls.empty())
        for_each_noting(w.exec, threads, sums, NoteLeast{clock_});
      else
        for_each_part(w.exec, part(threads, sums, Parts<>{}));
    });
  }

 protected:
  /// Concrete that is bounded alone has a kernel without spilled registers (bench/notes/gpu.md).
  template <class Number>
  void pair_forces(World& w) const {
    if ((parts_of(w.concrete) & ~concrete_bounded) == 0)
      pair_forces<Number, concrete_bounded>(w);
    else
      pair_forces<Number, concrete_all>(w);
  }
  template <class Number, ConcreteParts parts>
  void pair_forces(World& w) const {
    const auto grouped = [&](const auto& kernel, const auto& groups) {
      return by_(Grouped<std::decay_t<decltype(kernel)>, parts>(kernel, groups));
    };
    const auto of = [&](auto& set, Index first_action) {
      return grouped(link_kernel<Number>(w, set, {}, first_action), set.on_device);
    };
    const Index before_parallel = w.steel.size() + w.interface.size();
    for_each_part(
        w.exec,
        part(w.steel.size(), of(w.steel, 0),
             part(w.interface.size(), of(w.interface, w.steel.size()),
                  part(w.parallel.size(), of(w.parallel, before_parallel),
                       part(w.ldpm.size(), of(w.ldpm, before_parallel + w.parallel.size()),
                            part(w.contacts.size(), by_(contact_kernel(w)),
                                 part(w.concrete.size(),
                                      grouped(split_link_kernel<Number>(w), w.concrete.on_device),
                                      Parts<>{})))))));
  }
  By by_;
  StepClock* clock_;
};

/// Forces by launches at once.
LaunchedForces<AtOnce> forces_at_once(World& w) {
  return {{}, sums_note_least(w) ? w.clock.data() : nullptr};
}

/// Launches that a device's clock leads; after a search take_forces() goes on by a run that stands
/// `after_search`.
template <Phase phase>
class ClockedRun : public LaunchedForces<ByClock<phase>>, public ClockLed {
 public:
  explicit ClockedRun(const StepClocks& clocks)
      : LaunchedForces<ByClock<phase>>({clocks}, clocks.now), clocks_(clocks) {}

  void move_boundary(World& w) const {
    const int every = w.given->search.every;
    std::int32_t* const host_request = &clocks_.now->host_request;
    const EndOfStep<StepRule> end = end_of_step(w);
    const MoveAndWatch move{move_kernel(w), every, host_request, w.domain.owned_view(), nullptr};
    const MoveWalls walls{{},
                          w.given->largest_margin,
                          w.travel.drift.velocity,
                          every,
                          w.device_walls.view(),
                          w.motions.view(),
                          w.motion_times.view(),
                          w.motion_factors.view(),
                          host_request};
    for_each_part(w.exec,
                  part(w.device_walls.size(), clocks_.opening(walls, end, false),
                       part(w.elements.size(), clocks_.opening(move, end, true), Parts<>{})));
  }
  void coupling_forces(World&) const {}
  void wall_forces(World& w) const {
    if (w.walls.empty()) return;
    each_wall_kernel(
        w, [&](Index count, const auto& kernel) { for_each(w.exec, count, this->by_(kernel)); });
    for_each_noting(w.exec, w.elements.size(),
                    this->by_(NoteCritical{std::as_const(w.critical).view()}),
                    NoteLeast{clocks_.now});
  }

 private:
  StepClocks clocks_;
};

}  // namespace

void DeviceRun::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  const ShadowLaunches launches;
  w.beyond.resize(1);
  w.clock.resize(1);
  const MoveAndWatch move{move_kernel(w), 0, w.beyond.data(), w.domain.owned_view(),
                          w.clock.data()};
  for_each_part(w.exec, part(w.elements.size(), PlainLaunch(move), Parts<>{}));
  mark_launches(w.exec.space);
}
void DeviceRun::move_interior(World& w) const {
  move_walls(w);
}
void DeviceRun::pair_forces(World& w) {
  const StageTime timed(w.exec, "forces");
  launches_.emplace();
  for_each(w.exec, 1, Fence{});
  forces_at_once(w).pair_forces(w);
}
void DeviceRun::sum_forces(World& w) {
  const StageTime timed(w.exec, "forces");
  forces_at_once(w).sum_forces(w);
  mark_launches(w.exec.space);
  launches_.reset();
}

void take_step_on_device(World& w) {
  take_step(DeviceRun{}, w);
}
void take_forces_on_device(World& w) {
  take_forces(DeviceRun{}, w);
}

Advanced advance_on_device(World& w, const StopAt& stop) {
  if (runs_by_tiles(w)) return advance_by_tiles(w, stop);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const bool walls = !w.walls.empty();
  if (walls) copy_to(w.device_walls, w.walls);
  const Advanced taken = run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks) { take_step(ClockedRun<Phase::after_move>(clocks), w); },
      [&](const StepClocks& clocks) { take_forces(ClockedRun<Phase::after_search>(clocks), w); },
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
