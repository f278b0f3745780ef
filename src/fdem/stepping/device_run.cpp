// The step of fdem_shared/step.hpp by launches of a device. In Space::shadow the processor
// carries them out.

#include "core/device_run.hpp"

#include "exec/for_each.hpp"
#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"
#include "fdem/stepping/wide_kernels.hpp"

namespace breccia::fdem {
namespace {

/// Values of `host_request`: what the host does in the middle of a step.
enum Wanted : std::int32_t { request_search = 1, request_insertion = 2 };

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
    motions[i].velocity = {tables[2 * i].at(middle, times, factors) * velocity[i].x,
                           tables[2 * i + 1].at(middle, times, factors) * velocity[i].y};
  }
};

/// ScaleMotions for the step to come, by a launch of the step before that comes when its least
/// number has been noted: it ends the step as the next one will.
struct ScaleNextMotions {
  static constexpr const char* name = "fdem.scale_motions";
  ScaleMotions scale;
  View<Motion> last;  ///< gets what was for this step
  EndOfStep<AllowedStep> end;
  const StepClock* clock;
  BR_HD void operator()(Index i) const {
    StepClock c = *clock;
    if (c.halted != 0 || c.host_request != 0) return;
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
  Index first;  ///< first amplitude of the first load
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<LoadLaw> laws;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    laws[i].factor = {tables[first + 2 * i].at(now.time, times, factors),
                      tables[first + 2 * i + 1].at(now.time, times, factors)};
  }
};

/// MoveTriangles, and the question whether a search is due. Ghosts are moved, too, and then follow
/// their owners.
struct MoveAndWatch {
  static constexpr const char* name = "fdem.move_and_watch";
  MoveTriangles move;
  View<const std::uint8_t> changed;  ///< flags of Change
  std::int32_t* host_request;        ///< gets request_search where a margin is used up
  std::int32_t* told;  ///< ranks: gets the flags, which all vote on; none: one device holds all
  std::int64_t step = 0;

  using Loaded = MoveTriangles::Loaded<double>;
  BR_HD void set(const StepTime& now) {
    move.set(now);
    step = now.step;
  }
  BR_HD void load_early(Index t, Loaded& loaded) const { move.load_early(t, loaded); }
  BR_HD void load_late(Index t, Loaded& loaded) const { move.load_late(t, loaded); }
  BR_HD void update(Index t, Loaded& loaded) const {
    if (move.update(t, loaded) == Moved::beyond) *host_request = request_search;
    if (t != 0) return;
    const std::uint8_t softened = changed[change_softened], broken = changed[change_broken];
    if (told != nullptr)
      *told = (softened != 0 ? 1 << change_softened : 0) | (broken != 0 ? 1 << change_broken : 0);
    else if (marking_due(softened, broken, step))
      *host_request = request_search;
  }
};

/// From so many joints or couples on, each have a launch of their own: they take longer then than a
/// launch more, and can have the registers that suit them.
constexpr Index fewest_joints_apart = 250'000, fewest_couples_apart = 60'000;

struct WatchReached {
  static constexpr const char* name = "fdem.watch_reached";
  View<const std::uint8_t> reached;
  std::int32_t* host_request;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index) const {
    if (reached[0] != 0) *host_request = request_insertion;
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
    for (Index t = i; t < triangles; t += threads) least = min(least, stable(t));
    note(least);
  }
};

/// Whether supports get their velocities at the end of the step before: a launch less in each step.
bool scales_next(const World& w) {
  return !w.prescribed.empty() && w.bundles.starts.size() > 1;
}

EndOfStep<AllowedStep> end_of_step(const World& w) {
  return {allowed_step(w), w.given->time.evaluate_every};
}

ScaleMotions scale_motions(World& w) {
  return {{},
          w.amplitudes.view(),
          w.amplitude_times.view(),
          w.amplitude_factors.view(),
          w.prescribed_velocity.view(),
          w.motions.view()};
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

/// Launches at once.
class DeviceRun : public StepwiseRun {
 public:
  void move_boundary(World& w) const {
    const StageTime timed(w.exec, "integration");
    list_motions(w);
    const ShadowLaunches launches;
    w.device_flags.resize(2);
    const MoveAndWatch move{move_kernel(w), w.exposed.changed.view(), w.device_flags.data(),
                            w.device_flags.data() + 1};
    for_each_part(w.exec, part(w.triangles.size(), PlainLaunch(move), Parts<>{}));
    mark_launches(w.exec.space);
  }
  void move_interior(World& w) const { advance_time(w); }
  void pair_forces(World& w) {
    const StageTime timed(w.exec, "forces");
    launches_.emplace();
    for_each(w.exec, 1, Fence{});
    with_number(w.exec.precision,
                [&](auto number) { launch_pairs<decltype(number)>(w, AtOnce{}); });
  }
  void sum_forces(World& w) {
    const StageTime timed(w.exec, "forces");
    with_number(w.exec.precision, [&](auto number) {
      const auto sums = AtOnce{}(triangle_kernel<decltype(number)>(w));
      for_each_part(w.exec, part(w.triangles.size(), sums, Parts<>{}));
    });
    launches_.reset();
  }

 private:
  std::optional<ShadowLaunches> launches_;
};

/// Launches that a device's clock leads; after a search take_forces() goes on by a run that stands
/// `after_search`.
template <Phase phase>
class ClockedRun : public ClockLed {
 public:
  explicit ClockedRun(const StepClocks& clocks) : clocks_(clocks), timed_{clocks} {}

  void move_boundary(World& w) const {
    const auto motions = static_cast<Index>(w.prescribed.size());
    const EndOfStep<AllowedStep> end = end_of_step(w);
    const MoveAndWatch move{move_kernel(w), w.exposed.changed.view(), &clocks_.now->host_request,
                            nullptr};
    const Index triangles = w.triangles.size();
    if (motions == 0 || scales_next(w))
      return for_each_part(w.exec, part(triangles, clocks_.opening(move, end, true), Parts<>{}));
    for_each(w.exec, motions, clocks_.opening(scale_motions(w), end, true));
    for_each_part(w.exec, part(triangles, clocks_.timed<Phase::in_move>(move), Parts<>{}));
  }
  void insert_joints(World& w) const {
    if (!w.given->extrinsic) return;
    for_each(w.exec, w.triangles.size(), timed_(stress_kernel(w)));
    for_each(w.exec, w.joints.size(), timed_(overshoot_kernel(w)));
    for_each(w.exec, 1, timed_(WatchReached{w.reached.view(), &clocks_.now->host_request}));
  }
  void pair_forces(World& w) const {
    with_number(w.exec.precision, [&](auto number) { launch_pairs<decltype(number)>(w, timed_); });
  }
  /// Notes the stable step, too.
  void sum_forces(World& w) const {
    constexpr Index most_threads = 132 * 128;
    const Index triangles = w.triangles.size();
    const Index threads = triangles < most_threads ? triangles : most_threads;
    const NoteStable stable{
        stable_step(w), triangles, threads, w.given->time.evaluate_every, {clocks_.now}};
    with_number(w.exec.precision, [&](auto number) {
      const auto sums = timed_(triangle_kernel<decltype(number)>(w));
      for_each_part(w.exec, part(threads, timed_(stable), part(triangles, sums, Parts<>{})));
    });
  }
  void load_forces(World& w) const {
    if (w.load_starts.size() < 2) return;
    const ScaleLoads scale{{},
                           2 * static_cast<Index>(w.prescribed.size()),
                           w.amplitudes.view(),
                           w.amplitude_times.view(),
                           w.amplitude_factors.view(),
                           w.load_laws.view()};
    for_each(w.exec, w.load_laws.size(), timed_(scale));
    for_each(w.exec, w.load_starts.size() - 1, timed_(load_kernel(w)));
  }
  void bundle_forces(World& w) const {
    if (w.bundles.starts.size() < 2) return;
    const ScaleNextMotions next{scale_motions(w), w.last_motions.view(), end_of_step(w),
                                clocks_.now};
    const Index threads = (w.bundles.starts.size() - 1) * BundlesWide::width;
    for_each_part(w.exec, part(scales_next(w) ? w.motions.size() : 0, next,
                               part(threads, timed_(BundlesWide{bundle_kernel(w)}), Parts<>{})));
  }

 private:
  StepClocks clocks_;
  ByClock<phase> timed_;
};

/// Tables that the launches read besides the state.
void list_amplitudes(World& w) {
  std::vector<AmplitudeTable> tables;
  std::vector<Vec2> velocity;
  AmplitudeTables all;
  const auto append = [&](const auto& both) {
    for (const Amplitude* a : {&both.x, &both.y}) tables.push_back(all.append(*a));
  };
  for (const PrescribedMotion& p : w.prescribed) {
    append(p.over);
    velocity.push_back(p.velocity);
  }
  for (const LoadAmplitude& a : w.given->load_amplitudes) append(a);
  copy_to(w.amplitudes, tables);
  copy_to(w.amplitude_times, all.times);
  copy_to(w.amplitude_factors, all.factors);
  copy_to(w.prescribed_velocity, velocity);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
  if (w.load_starts.size() > 1) copy_to(w.load_laws, w.given->loads);
}

/// Velocities of supports for the step to come.
void scale_motions_now(World& w) {
  if (!scales_next(w)) return;
  copy_to(w.last_motions, w.motions);
  list_motions(w);
}

}  // namespace

void take_step_on_device(World& w) {
  take_step(DeviceRun{}, w);
}
void take_forces_on_device(World& w) {
  take_forces(DeviceRun{}, w);
}

Advanced advance_on_device(World& w, const StopAt& stop) {
  if (w.amplitudes.empty() && w.clock.empty()) list_amplitudes(w);
  scale_motions_now(w);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const Advanced taken = run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks) { take_step(ClockedRun<Phase::after_move>(clocks), w); },
      [&](const StepClocks& clocks) { take_forces(ClockedRun<Phase::after_search>(clocks), w); },
      [&](std::int32_t host_request) {
        const bool insertion = host_request == request_insertion;
        insertion ? evaluate_forces(w) : find_couples(w);
        if (insertion) scale_motions_now(w);
        return insertion;
      });
  if (scales_next(w)) copy_to(w.motions, w.last_motions);
  return taken;
}

}  // namespace breccia::fdem
