#pragma once
// The step of fdem_shared/step.hpp by launches of a device. In Space::shadow the processor carries
// them out.
//
// A method's `Launches` says what they are made of:
//
//   pairs(w, by)             joints and couples; at least one launch
//   with_sums(w, visit)      visit(kernel) with the kernel of the sums of forces
//   blocks_of_sums           blocks of it that must fit a multiprocessor at once, where many
//                            elements have a launch of it without the stable step; 0: never
//   bundles(w)               the kernel of corners that move as one, and `lanes`, its threads for
//                            each vertex
//
// by(kernel) wraps a kernel for a launch.

#include <type_traits>

#include "core/device_run.hpp"
#include "fdem_shared/exposed.hpp"
#include "fdem_shared/insertion_kernels.hpp"
#include "fdem_shared/motion.hpp"
#include "fdem_shared/over_time.hpp"
#include "fdem_shared/step.hpp"
#include "fdem_shared/stepping.hpp"
#include "fdem_shared/wanted.hpp"

namespace breccia::fdem_shared {

/// Velocities of supports at the middle of the step to come.
template <class Shape>
struct ScaleMotions {
  static constexpr const char* name = "fdem.scale_motions";
  StepTime now;
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<const typename Shape::Vector> velocity;
  View<typename Shape::Motion> motions;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    const double middle = now.time + 0.5 * now.next_dt;
    typename Shape::Vector scaled{};
    for (int axis = 0; axis < Shape::dimension; ++axis)
      part_of(scaled, axis) = tables[Shape::dimension * i + axis].at(middle, times, factors) *
                              part_of(velocity[i], axis);
    motions[i].velocity = scaled;
  }
};

/// ScaleMotions for the step to come, by a launch of the step before that comes when its least
/// number has been noted: it ends the step as the next one will.
template <class Shape>
struct ScaleNextMotions {
  static constexpr const char* name = "fdem.scale_motions";
  ScaleMotions<Shape> scale;
  View<typename Shape::Motion> last;  ///< gets what was for this step
  EndOfStep<AllowedStep> end;
  const StepClock* clock;
  BR_HD void operator()(Index i) const {
    StepClock c = *clock;
    if (c.halted != 0 || c.host_request != 0) return;
    end(c);
    ScaleMotions<Shape> next = scale;
    next.set(c.now);
    last[i] = next.motions[i];
    next(i);
  }
};

template <class Shape>
struct ScaleLoads {
  static constexpr const char* name = "fdem.scale_loads";
  StepTime now;
  Index first;  ///< first amplitude of the first load
  View<const AmplitudeTable> tables;
  View<const double> times, factors;
  View<LoadLawOf<typename Shape::Vector>> laws;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index i) const {
    for (int axis = 0; axis < Shape::dimension; ++axis)
      part_of(laws[i].factor, axis) =
          tables[first + Shape::dimension * i + axis].at(now.time, times, factors);
  }
};

/// The move, and the question whether a search is due. Ghosts are moved, too, and then follow their
/// owners.
template <class Move>
struct MoveAndWatch {
  static constexpr const char* name = "fdem.move_and_watch";
  static constexpr int least_blocks = least_blocks_of<Move>();
  Move move;
  View<const std::uint8_t> changed;  ///< flags of Change
  std::int32_t* host_request;        ///< gets request_search where a margin is used up, or
                                     ///< request_marks
  std::int32_t* told;  ///< ranks: gets the flags, which all vote on; none: one device holds all
  std::int64_t step = 0;

  using Loaded = typename Move::template Loaded<double>;
  BR_HD void set(const StepTime& now) {
    move.set(now);
    step = now.step;
  }
  BR_HD void load_early(Index t, Loaded& loaded) const { move.load_early(t, loaded); }
  BR_HD void load_late(Index t, Loaded& loaded) const { move.load_late(t, loaded); }
  BR_HD void update(Index t, Loaded& loaded) const {
    if (move.update(t, loaded) == Moved::beyond) ask_host(request_search);
    if (t != 0) return;
    const std::uint8_t softened = changed[change_softened], broken = changed[change_broken];
    if (told != nullptr)
      *told = (softened != 0 ? 1 << change_softened : 0) | (broken != 0 ? 1 << change_broken : 0);
    else if (marking_due(softened, broken, step))
      ask_host(request_marks);
  }

 private:
  /// The largest of what threads ask for.
  BR_HD void ask_host(std::int32_t wanted) const {
#if defined(__CUDA_ARCH__)
    atomicMax(host_request, wanted);
#else
    if (*host_request < wanted) *host_request = wanted;
#endif
  }
};

/// The stable step of every n-th element, or ring, n threads in all; nothing between two
/// evaluations.
template <class StableStep>
struct NoteStable {
  static constexpr const char* name = "fdem.note_stable";
  StableStep stable;
  Index elements, threads;
  int evaluate_every;
  NoteLeast note;
  std::int64_t step = 0;
  BR_HD void set(const StepTime& now) {
    step = now.step;
    if constexpr (requires { stable.set(now); }) stable.set(now);
  }
  BR_HD void operator()(Index i) const {
    if (step % evaluate_every != 0) return;
    double least = largest_least;
    for (Index t = i; t < elements; t += threads) least = min(least, stable(t));
    note(least);
  }
};

/// From so many elements on, sums of forces are launched without the stable step, which needs more
/// registers (bench/notes/gpu.md, Tetrahedra): a launch more. Tests in Space::shadow see both ways.
inline Index fewest_summed_apart(Space space) {
  return space == Space::shadow ? 200 : 100'000;
}

/// A kernel of which so many blocks fit a multiprocessor at once: a bound on its registers.
template <class Kernel, int blocks>
struct Bounded : Kernel {
  static constexpr int least_blocks = blocks;
};

/// Whether supports get their velocities at the end of the step before: a launch less in each step.
template <class World>
bool scales_next(const World& w) {
  return !w.prescribed.empty() && w.bundles.starts.size() > 1;
}

template <class World>
EndOfStep<AllowedStep> end_of_step(const World& w) {
  return {allowed_step(w), w.given->time.evaluate_every};
}

template <class World>
ScaleMotions<ShapeOf<World>> scale_motions(World& w) {
  return {{},
          w.amplitudes.view(),
          w.amplitude_times.view(),
          w.amplitude_factors.view(),
          w.prescribed_velocity.view(),
          w.motions.view()};
}

template <class Launches, class Base, class World>
void DeviceRunOf<Launches, Base, World>::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  const ShadowLaunches launches;
  w.device_flags.resize(2);
  std::int32_t* const told = w.domain.single_rank() ? nullptr : w.device_flags.data() + 1;
  const MoveAndWatch<typename ShapeOf<World>::Move> move{world_move(w), w.exposed.changed.view(),
                                                         w.device_flags.data(), told, w.step};
  for_each_part(w.exec, part(ShapeOf<World>::elements(w).size(), PlainLaunch(move), Parts<>{}));
  mark_launches(w.exec.space);
}
template <class Launches, class Base, class World>
void DeviceRunOf<Launches, Base, World>::move_interior(World& w) const {
  advance_time(w);
}
template <class Launches, class Base, class World>
void DeviceRunOf<Launches, Base, World>::pair_forces(World& w) {
  const StageTime timed(w.exec, "forces");
  launches_.emplace();
  for_each(w.exec, 1, Fence{});
  Launches::pairs(w, AtOnce{});
}
template <class Launches, class Base, class World>
void DeviceRunOf<Launches, Base, World>::sum_forces(World& w) {
  const StageTime timed(w.exec, "forces");
  Launches::with_sums(w, [&w](const auto& kernel) {
    for_each_part(w.exec, part(ShapeOf<World>::elements(w).size(), AtOnce{}(kernel), Parts<>{}));
  });
  launches_.reset();
}

/// Launches that a device's clock leads; after a search take_forces() goes on by a run that stands
/// `after_search`.
/// @param sums_due     whether the move sums forces up, as the step before has left it to do
/// @param leaves_sums  whether the step leaves that to the move of the next one
template <class Launches, Phase phase, class World>
class ClockedRun : public ClockLed {
 public:
  using Shape = ShapeOf<World>;
  ClockedRun(const StepClocks& clocks, bool sums_due, bool leaves_sums)
      : clocks_(clocks), timed_{clocks}, sums_due_(sums_due), leaves_sums_(leaves_sums) {}

  void move_boundary(World& w) const {
    if constexpr (moves_at_once<World>)
      if (sums_due_)
        return Launches::with_sums(w,
                                   [&](const auto& sums) { move_all(w, sum_and_move(w, sums)); });
    move_all(w, world_move(w));
  }
  void insert_joints(World& w) const {
    watch_for_waking(w, timed_, &clocks_.now->host_request, request_insertion);
  }
  void pair_forces(World& w) const { Launches::pairs(w, timed_); }
  /// Notes the stable step, too.
  void sum_forces(World& w) const {
    const Index elements = Shape::elements(w).size();
    if (bundles_bound(w))
      sum_and_note(w, noting(w, list_rows_kernel(w, w.rows, 0.0, Pressed::soon), elements));
    else
      sum_and_note(w, noting(w, stable_step(w), elements));
  }
  template <class Stable>
  void sum_and_note(World& w, const NoteStable<Stable>& stable) const {
    const Index elements = Shape::elements(w).size(), threads = stable.threads;
    Launches::with_sums(w, [&](const auto& kernel) {
      using Kernel = std::remove_cvref_t<decltype(kernel)>;
      if constexpr (moves_at_once<World>)
        if (leaves_sums_)
          return for_each_part(w.exec, part(threads, timed_(stable),
                                            part(w.summed_apart.threads(),
                                                 timed_(sum_apart(w, kernel)), Parts<>{})));
      if constexpr (Launches::blocks_of_sums > 0)
        if (elements >= fewest_summed_apart(w.exec.space)) {
          const Bounded<Kernel, Launches::blocks_of_sums> sums{kernel};
          for_each_part(w.exec, part(elements, timed_(sums), Parts<>{}));
          return for_each_part(w.exec, part(threads, timed_(stable), Parts<>{}));
        }
      for_each_part(w.exec,
                    part(threads, timed_(stable), part(elements, timed_(kernel), Parts<>{})));
    });
  }
  void coupling_forces(World&) const {}
  void load_forces(World& w) const {
    if (w.load_starts.size() < 2) return;
    const ScaleLoads<Shape> scale{{},
                                  Shape::dimension * static_cast<Index>(w.prescribed.size()),
                                  w.amplitudes.view(),
                                  w.amplitude_times.view(),
                                  w.amplitude_factors.view(),
                                  w.load_laws.view()};
    for_each(w.exec, w.load_laws.size(), timed_(scale));
    for_each(w.exec, w.load_starts.size() - 1, timed_(load_kernel(w)));
  }
  void bundle_forces(World& w) const {
    if (w.bundles.starts.size() < 2) return;
    const ScaleNextMotions<Shape> next{scale_motions(w), w.last_motions.view(), end_of_step(w),
                                       clocks_.now};
    const Index threads = (w.bundles.starts.size() - 1) * Launches::lanes;
    const auto noted = noting(w, least_of_ring_kernel(w, w.rows), count_rings(w));
    for_each_part(w.exec, part(noted.threads, timed_(noted),
                               part(threads, timed_(Launches::bundles(w)), Parts<>{})));
    if (scales_next(w)) for_each(w.exec, w.motions.size(), next);
  }

 private:
  template <class Move>
  void move_all(World& w, const Move& how) const {
    const auto motions = static_cast<Index>(w.prescribed.size());
    const EndOfStep<AllowedStep> end = end_of_step(w);
    const MoveAndWatch<Move> move{how, w.exposed.changed.view(), &clocks_.now->host_request,
                                  nullptr};
    const Index elements = Shape::elements(w).size();
    if (motions == 0 || scales_next(w))
      return for_each_part(w.exec, part(elements, clocks_.opening(move, end, true), Parts<>{}));
    for_each(w.exec, motions, clocks_.opening(scale_motions(w), end, true));
    for_each_part(w.exec, part(elements, clocks_.timed<Phase::in_move>(move), Parts<>{}));
  }
  template <class Stable>
  NoteStable<Stable> noting(const World& w, const Stable& stable, Index count) const {
    constexpr Index most_threads = 132 * 128;
    return {
        stable, count, std::min(count, most_threads), w.given->time.evaluate_every, {clocks_.now}};
  }

  StepClocks clocks_;
  ByClock<phase> timed_;
  bool sums_due_, leaves_sums_;
};

/// Tables that the launches read besides the state.
template <class World>
void list_amplitudes(World& w) {
  std::vector<AmplitudeTable> tables;
  std::vector<typename ShapeOf<World>::Vector> velocity;
  AmplitudeTables all;
  const auto append = [&](const auto& parts) {
    tables.push_back(all.append(parts.x));
    tables.push_back(all.append(parts.y));
    if constexpr (requires { parts.z; }) tables.push_back(all.append(parts.z));
  };
  for (const auto& p : w.prescribed) {
    append(p.over);
    velocity.push_back(p.velocity);
  }
  for (const auto& a : w.given->load_amplitudes) append(a);
  copy_to(w.amplitudes, tables);
  copy_to(w.amplitude_times, all.times);
  copy_to(w.amplitude_factors, all.factors);
  copy_to(w.prescribed_velocity, velocity);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
  if (w.load_starts.size() > 1) copy_to(w.load_laws, w.given->loads);
}

/// Velocities of supports for the step to come.
template <class World>
void scale_motions_now(World& w) {
  if (!scales_next(w)) return;
  copy_to(w.last_motions, w.motions);
  list_motions(w);
}

/// The sums that steps have left to a move that does not come.
template <class Launches, class World>
void sum_others_at_once(World& w) {
  const ShadowLaunches launches;
  for_each(w.exec, 1, Fence{});
  Launches::with_sums(w, [&w](const auto& kernel) {
    for_each_part(w.exec, part(ShapeOf<World>::elements(w).size(), AtOnce{}(sum_others(w, kernel)),
                               Parts<>{}));
  });
}

/// Takes steps by launches ahead, led by the device's clock.
template <class Launches, class World>
Advanced advance_mesh(World& w, const StopAt& stop) {
  if (w.amplitudes.empty() && w.clock.empty()) list_amplitudes(w);
  scale_motions_now(w);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  bool at_once = false;
  if constexpr (moves_at_once<World>) at_once = moves_most_at_once(w);
  std::int64_t summed_up = w.step;  // all forces are in memory after so many steps
  using AfterMove = ClockedRun<Launches, Phase::after_move, World>;
  using AfterSearch = ClockedRun<Launches, Phase::after_search, World>;
  const Advanced taken = run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks, bool follows_host) {
        take_step(AfterMove(clocks, at_once && !follows_host, at_once), w);
      },
      [&](const StepClocks& clocks) { take_forces(AfterSearch(clocks, false, at_once), w); },
      [&](std::int32_t host_request) {
        if (host_request == request_marks || host_request == request_search) {
          w.margin_used = host_request == request_search;
          if (!follow_marks(w)) find_couples(w);
          return false;
        }
        if constexpr (requires { Launches::go_on(w); })
          if (host_request == request_room) Launches::go_on(w);
        evaluate_forces(w);
        scale_motions_now(w);
        summed_up = w.step + 1;
        return true;
      });
  if constexpr (moves_at_once<World>)
    if (at_once && w.step > summed_up) sum_others_at_once<Launches>(w);
  if (scales_next(w)) copy_to(w.motions, w.last_motions);
  return taken;
}

}  // namespace breccia::fdem_shared
