// The step of fdem/step.cpp on a device: the same kernels in the same order, launched ahead by the
// device's clock.

#include "exec/for_each.hpp"
#include "fdem/insertion_kernels.hpp"
#include "fdem/launches.hpp"

namespace breccia::fdem {
namespace {

/// Values of `wanted`: what the host does in the middle of a step.
enum Wanted : std::int32_t { wanted_search = 1, wanted_insertion = 2 };

/// Velocities of supports at the middle of the step to come.
struct ScaleMotions {
  static constexpr const char* name = "fdem.scale_motions";
  Moment now;
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<const Vec2> velocity;
  View<Motion> motions;
  BR_HD void set(const Moment& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    const double middle = now.time + 0.5 * now.next_dt;
    motions[i].velocity = tables[i].at(middle, times, factors) * velocity[i];
  }
};

struct ScaleLoads {
  static constexpr const char* name = "fdem.scale_loads";
  Moment now;
  Index first;  ///< amplitude of the first load
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<LoadLaw> laws;
  BR_HD void set(const Moment& moment) { now = moment; }
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
  View<StepClock> clock;

  BR_HD void set(const Moment& now) {
    move.set(now);
    used.set_time(now.time + now.next_dt);
  }
  BR_HD void operator()(Index t) const {
    move(t);
    StepClock& c = clock[0];
    const Index place = reach_place[t];
    if (place >= 0 && used(place) > 0.0) c.wanted = wanted_search;
    if (t == 0 && marking_due(changed[change_softened], changed[change_broken], c.step))
      c.wanted = wanted_search;
  }
};

struct WatchReached {
  static constexpr const char* name = "fdem.watch_reached";
  View<const std::uint8_t> reached;
  View<StepClock> clock;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index) const {
    if (reached[0] != 0) clock[0].wanted = wanted_insertion;
  }
};

/// The stable step of every n-th triangle, n threads in all; nothing between two evaluations.
struct NoteStable {
  static constexpr const char* name = "fdem.note_stable";
  StableStep stable;
  Index triangles, threads;
  FinishStep<AllowedStep> finish;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index i) const {
    if (finish.clock[0].step % finish.evaluate_every != 0) return;
    double least = largest_least;
    for (Index t = i; t < triangles; t += threads) least = smaller(least, stable(t));
    finish.note(least);
  }
};

/// A kernel that notes nothing, before the end of the step.
template <class Kernel>
struct NotingNothing {
  Kernel kernel;
  BR_HD void set(const Moment& now) { kernel.set(now); }
  BR_HD double operator()(Index i) const {
    kernel(i);
    return largest_least;
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

#if defined(__CUDACC__)
void launch_step(World& w) {
  const Exec& exec = w.exec;
  const Index triangles = w.triangles.size();
  const auto motions = static_cast<Index>(w.prescribed.size());
  const auto after = [&](const auto& kernel) { return timed<true>(kernel, w.clock); };
  const View<const AmplitudeTable> tables = w.amplitudes.view();
  const View<const double> times = w.amplitude_times.view(), factors = w.amplitude_factors.view();
  for_each(
      exec, motions,
      timed<false>(
          ScaleMotions{{}, tables, times, factors, w.prescribed_velocity.view(), w.motions.view()},
          w.clock));
  for_each(exec, triangles,
           timed<false>(MoveAndWatch{move_kernel(w),
                                     {w.reach.triangle.view(), w.reach.reference.view(),
                                      w.reach.margin.view(), w.triangles.nodes.view(),
                                      w.reach.drift, Vec2{}},
                                     w.reach_place.view(),
                                     w.opened.changed.view(),
                                     w.clock.view()},
                        w.clock));
  if (w.extrinsic) {
    for_each(exec, triangles, after(stress_kernel(w)));
    for_each(exec, w.joints.size(), after(overshoot_kernel(w)));
    for_each(exec, 1, after(WatchReached{w.reached.view(), w.clock.view()}));
  }
  for_each_part(part(w.couples.size(), after(couple_kernel(w)),
                     part(w.joints.size(), after(joint_kernel(w)), Parts<>{})));
  const FinishStep<AllowedStep> finish{allowed_step(w), w.parameters.time.evaluate_every,
                                       w.clock.view()};
  constexpr Index most_threads = 132 * 128;
  const Index threads = triangles < most_threads ? triangles : most_threads;
  for_each_part(part(threads, after(NoteStable{stable_step(w), triangles, threads, finish}),
                     part(triangles, after(triangle_kernel(w)), Parts<>{})));
  if (w.load_starts.size() > 1) {
    for_each(exec, w.load_laws.size(),
             after(ScaleLoads{{}, motions, tables, times, factors, w.load_laws.view()}));
    for_each(exec, w.load_starts.size() - 1, after(load_kernel(w)));
  }
  if (w.bundles.starts.size() > 1)
    for_each_then(w.bundles.starts.size() - 1, after(NotingNothing<BundleForces>{bundle_kernel(w)}),
                  w.blocks_done, finish);
  else
    for_each(exec, 1, finish);
}
#else
void launch_step(World&) {}
#endif

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
  w.blocks_done.resize(1);
}

void place_reach(World& w) {
  w.reach_place.resize(w.triangles.size());
  for_each(w.exec, w.triangles.size(), FillNone{w.reach_place.view()});
  for_each(w.exec, w.reach.triangle.size(),
           PlaceReach{std::as_const(w.reach.triangle).view(), w.reach_place.view()});
}

}  // namespace

Advanced advance_on_device(World& w, const StopAt& stop) {
  if (w.amplitudes.empty() && w.blocks_done.empty()) list_amplitudes(w);
  if (w.graphs.stale()) place_reach(w);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  return run_ahead(
      w.clock, w.graphs, host, stop, [&] { launch_step(w); },
      [&](std::int32_t wanted) {
        if (wanted == wanted_search) find_couples(w);
        evaluate_forces(w);
        w.graphs.clear();
        place_reach(w);
      });
}

}  // namespace breccia::fdem
