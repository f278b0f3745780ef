// The step of fdem/step.cpp on a device: the same kernels in the same order, launched ahead by the
// device's clock.

#include "core/device_run.hpp"
#include "exec/for_each.hpp"
#include "fdem/device_kernels.hpp"
#include "fdem/insertion_kernels.hpp"
#include "fdem/launches.hpp"

namespace breccia::fdem {
namespace {

/// Values of `wanted`: what the host does in the middle of a step.
enum Wanted : std::int32_t { wanted_search = 1, wanted_insertion = 2 };

/// Velocities of supports at the middle of the step to come.
struct ScaleMotions {
  static constexpr const char* name = "fdem.scale_motions";
  StepTime now;
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<const Vec2> velocity;
  View<Motion> motions;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    const double middle = now.time + 0.5 * now.next_dt;
    motions[i].velocity = tables[i].at(middle, times, factors) * velocity[i];
  }
};

/// ScaleMotions for the step to come, by a launch of the step before that comes when its least
/// number has been noted: it ends the step as the next one will.
struct ScaleMotionsAhead {
  static constexpr const char* name = "fdem.scale_motions";
  ScaleMotions scale;
  View<Motion> last;  ///< gets what was for this step
  EndOfStep<AllowedStep> end;
  const StepClock* clock;
  BR_HD void operator()(Index i) const {
    StepClock c = *clock;
    if (c.halted != 0 || c.wanted != 0) return;
    end(c);
    ScaleMotions next = scale;
    next.set(c.now);
    last[i] = next.motions[i];
    next(i);
  }
};

struct ScaleLoads {
  static constexpr const char* name = "fdem.scale_loads";
  StepTime now;
  Index first;  ///< amplitude of the first load
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<LoadLaw> laws;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    laws[i].factor = tables[first + i].at(now.time, times, factors);
  }
};

/// MoveTriangles, and the question whether a search is due.
struct MoveAndWatch {
  static constexpr const char* name = "fdem.move_and_watch";
  MoveTriangles move;
  UsedMargin used;
  View<const Index> reach_place;
  View<const std::uint8_t> changed;
  std::int32_t* wanted;
  std::int64_t step = 0;

  BR_HD void set(const StepTime& now) {
    move.set(now);
    used.set_time(now.time + now.next_dt);
    step = now.step;
  }
  /// What the sums of forces, which end while these are read, do not write; and then those sums.
  struct Loaded {
    Kick::Given given;
    WarpRecords<Corners> force;
    Corners from;
    double margin;
    Index place;
  };
  BR_HD void load_early(Index t, Loaded& loaded) const {
    loaded.place = read_now(&reach_place[t]);
    loaded.given.hold = read_now(&move.kick.hold[t]);
    loaded.given.mass = read_now(&move.kick.mass[t]);
    WarpRecords<TriangleNodes> nodes;
    nodes.read(move.kick.nodes, t);
    loaded.margin = 0.0;
    if (loaded.place >= 0) {
      loaded.from = read_record_now(&used.reference[loaded.place]);
      loaded.margin = read_now(&used.margin[loaded.place]);
    }
    loaded.given.nodes = nodes.own();
  }
  BR_HD void load_late(Index t, Loaded& loaded) const { loaded.force.read(move.kick.force, t); }
  /// @returns whether the triangle has used its margin up
  BR_HD bool moves(Index t, Loaded& loaded) const {
    Kick::Given& given = loaded.given;
    given.force = loaded.force.own();
    if (move.kick.damping > 0.0 || move.external.size > 0 || given.hold >= 0) {
      given.nodes = move.moved_driven(t, given);
    } else {
      double c[12], f[6];
      __builtin_memcpy(c, &given.nodes, sizeof c);
      __builtin_memcpy(f, &given.force, sizeof f);
      move.move_free(c, f, given.mass);
      __builtin_memcpy(&given.nodes, c, sizeof c);
    }
    wait_for_warp();
    WarpRecords<TriangleNodes>::write(move.nodes, t, given.nodes);
    return loaded.place >= 0 && used.beyond(given.nodes, loaded.from, loaded.margin);
  }
  BR_HD void update(Index t, Loaded& loaded) const {
    if (moves(t, loaded)) *wanted = wanted_search;
    if (t == 0 && marking_due(changed[change_softened], changed[change_broken], step))
      *wanted = wanted_search;
  }
};

/// The same on ranks, which vote. Copies are moved, too, and then follow their owners.
struct MoveAndTell : MoveAndWatch {
  OwnedView owned;
  View<std::int32_t> news;
  BR_HD void update(Index t, Loaded& loaded) const {
    if (moves(t, loaded) && owned(t)) news[0] = 1;
    if (t == 0) news[1] = (changed[0] != 0 ? 1 : 0) | (changed[1] != 0 ? 2 : 0);
  }
};

/// From so many joints or couples on, each have a launch of their own: they take longer then than a
/// launch more, and can have the registers that suit them.
constexpr Index fewest_joints_apart = 250'000, fewest_couples_apart = 60'000;

struct WatchReached {
  static constexpr const char* name = "fdem.watch_reached";
  View<const std::uint8_t> reached;
  std::int32_t* wanted;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index) const {
    if (reached[0] != 0) *wanted = wanted_insertion;
  }
};

/// The stable step of every n-th triangle, n threads in all; nothing between two evaluations.
struct NoteStable {
  static constexpr const char* name = "fdem.note_stable";
  StableStep stable;
  Index triangles, threads;
  int evaluate_every;
  NoteLeast note;
  std::int64_t step = 0;
  BR_HD void set(const StepTime& now) { step = now.step; }
  BR_HD void operator()(Index i) const {
    if (step % evaluate_every != 0) return;
    double least = largest_least;
    for (Index t = i; t < triangles; t += threads) least = smaller(least, stable(t));
    note(least);
  }
};

struct PlaceReach {
  View<const Index> triangle;
  View<Index> place;
  BR_HD void operator()(Index i) const { place[triangle[i]] = i; }
};
struct FillNone {
  View<Index> place;
  BR_HD void operator()(Index t) const { place[t] = -1; }
};

/// Whether supports know their velocities when a step begins: a launch less in each step.
bool scales_ahead(const World& w) {
  return !w.prescribed.empty() && w.bundles.starts.size() > 1;
}

EndOfStep<AllowedStep> end_of_step(const World& w) {
  return {allowed_step(w), w.parameters.time.evaluate_every};
}

MoveAndWatch move_and_watch(World& w, std::int32_t* wanted) {
  return {move_kernel(w),
          {w.reach.triangle.view(), w.reach.reference.view(), w.reach.margin.view(),
           w.triangles.nodes.view(), w.reach.drift, Vec2{}},
          w.reach_place.view(),
          w.opened.changed.view(),
          wanted};
}

ScaleMotions scale_motions(World& w) {
  return {{},
          w.amplitudes.view(),
          w.amplitude_times.view(),
          w.amplitude_factors.view(),
          w.prescribed_velocity.view(),
          w.motions.view()};
}

void launch_move(World& w, const StepClocks& clocks) {
  const auto motions = static_cast<Index>(w.prescribed.size());
  const EndOfStep<AllowedStep> end = end_of_step(w);
  const MoveAndWatch move = move_and_watch(w, &clocks.now->wanted);
  const Index triangles = w.triangles.size();
  if (motions == 0 || scales_ahead(w))
    return for_each_part(w.exec, part(triangles, clocks.opening(move, end, true), Parts<>{}));
  for_each(w.exec, motions, clocks.opening(scale_motions(w), end, true));
  for_each_part(w.exec, part(triangles, clocks.timed<Stand::in_move>(move), Parts<>{}));
}

/// Joints and couples.
template <class Number, class By>
void launch_pairs(World& w, const By& by) {
  const Index joints = w.joints.size(), couples = w.couples.size();
  const CouplesWide<Number> wide{couple_kernel<Number>(w)};
  if (joints + couples == 0)  // triangles read corners ahead, which the move writes
    return for_each(w.exec, 1, by(Fence{}));
  if (joints < fewest_joints_apart && couples < fewest_couples_apart)
    return for_each_part(
        w.exec, part(couples * CouplesWide<Number>::width, by(wide),
                     part(joints, by(Bounded<JointForces<Number>, 4>{joint_kernel<Number>(w)}),
                          Parts<>{})));
  for_each_part(w.exec, part(joints, by(Bounded<JointForces<Number>, 8>{joint_kernel<Number>(w)}),
                             Parts<>{}));
  if (couples < fewest_couples_apart)
    for_each_part(w.exec, part(couples * CouplesWide<Number>::width, by(wide), Parts<>{}));
  else
    for_each_part(
        w.exec,
        part(couples, by(Bounded<CoupleForces<Number>, 5>{couple_kernel<Number>(w)}), Parts<>{}));
}

/// All forces and their sums, and the stable step. `by` wraps a kernel by the clock.
template <class Number, class By>
void launch_forces(World& w, StepClock* clock, const By& by) {
  const Exec& exec = w.exec;
  const Index triangles = w.triangles.size();
  if (w.extrinsic) {
    for_each(exec, triangles, by(stress_kernel(w)));
    for_each(exec, w.joints.size(), by(overshoot_kernel(w)));
    for_each(exec, 1, by(WatchReached{w.reached.view(), &clock->wanted}));
  }
  launch_pairs<Number>(w, by);
  constexpr Index most_threads = 132 * 128;
  const Index threads = triangles < most_threads ? triangles : most_threads;
  for_each_part(
      w.exec,
      part(threads,
           by(NoteStable{
               stable_step(w), triangles, threads, w.parameters.time.evaluate_every, {clock}}),
           part(triangles, by(triangle_kernel<Number>(w)), Parts<>{})));
  if (w.load_starts.size() > 1) {
    for_each(exec, w.load_laws.size(),
             by(ScaleLoads{{},
                           static_cast<Index>(w.prescribed.size()),
                           w.amplitudes.view(),
                           w.amplitude_times.view(),
                           w.amplitude_factors.view(),
                           w.load_laws.view()}));
    for_each(exec, w.load_starts.size() - 1, by(load_kernel(w)));
  }
  if (w.bundles.starts.size() > 1)
    for_each_part(w.exec, part(scales_ahead(w) ? w.motions.size() : 0,
                               ScaleMotionsAhead{scale_motions(w), w.last_motions.view(),
                                                 end_of_step(w), clock},
                               part((w.bundles.starts.size() - 1) * BundlesWide::width,
                                    by(BundlesWide{bundle_kernel(w)}), Parts<>{})));
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

/// What the launches read besides the state.
void list_amplitudes(World& w) {
  std::vector<AmplitudeTable> tables;
  std::vector<double> times, factors;
  std::vector<Vec2> velocity;
  const auto append = [&](const Amplitude& a) {
    const auto first = static_cast<Index>(times.size());
    times.insert(times.end(), a.times.begin(), a.times.end());
    factors.insert(factors.end(), a.factors.begin(), a.factors.end());
    tables.push_back({a.ramp, first, static_cast<Index>(times.size())});
  };
  for (const PrescribedMotion& p : w.prescribed) {
    append(p.amplitude);
    velocity.push_back(p.velocity);
  }
  for (const Amplitude& a : w.load_amplitudes) append(a);
  copy_to(w.amplitudes, tables);
  copy_to(w.amplitude_times, times);
  copy_to(w.amplitude_factors, factors);
  copy_to(w.prescribed_velocity, velocity);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
  if (w.load_starts.size() > 1) copy_to(w.load_laws, w.loads);
}

/// Velocities of supports for the step to come.
void scale_motions_now(World& w) {
  if (!scales_ahead(w)) return;
  copy_to(w.last_motions, w.motions);
  list_motions(w);
}

}  // namespace

void place_reach(World& w) {
  w.reach_place.resize(w.triangles.size());
  for_each(w.exec, w.triangles.size(), FillNone{w.reach_place.view()});
  for_each(w.exec, w.reach.triangle.size(),
           PlaceReach{std::as_const(w.reach.triangle).view(), w.reach_place.view()});
}

void move_on_device(World& w) {
  const ShadowLaunches launches;
  w.news.resize(2);
  MoveAndTell move{move_and_watch(w, nullptr), w.domain.owned_view(), w.news.view()};
  move.used.set_time(w.time + w.next_dt);
  for_each_part(w.exec, part(w.triangles.size(), AtOnce(move), Parts<>{}));
  mark_launches(w.exec.space);
}
void forces_on_device(World& w) {
  const ShadowLaunches launches;
  const StageTime timed(w.exec, "forces");
  const auto at_once = [](const auto& kernel) { return AtOnce(kernel); };
  for_each(w.exec, 1, Fence{});
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    launch_pairs<Number>(w, at_once);
    for_each_part(w.exec, part(w.triangles.size(), at_once(triangle_kernel<Number>(w)), Parts<>{}));
  });
}

Advanced advance_on_device(World& w, const StopAt& stop) {
  if (w.amplitudes.empty() && w.clock.empty()) list_amplitudes(w);
  scale_motions_now(w);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const Advanced taken = run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks) { launch_step(w, clocks); },
      [&](const StepClocks& clocks) { launch_rest(w, clocks); },
      [&](std::int32_t wanted) {
        const bool insertion = wanted == wanted_insertion;
        insertion ? evaluate_forces(w) : find_couples(w);
        if (insertion) scale_motions_now(w);
        return insertion;
      });
  if (scales_ahead(w)) copy_to(w.motions, w.last_motions);
  return taken;
}

}  // namespace breccia::fdem
