// The step of fdem/step.cpp on a device: the same kernels in the same order, launched ahead by the
// device's clock.

#include "core/device_run.hpp"
#include "exec/early.hpp"
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
  std::int32_t* wanted;
  std::int64_t step = 0;

  BR_HD void set(const Moment& now) {
    move.set(now);
    used.set_time(now.time + now.next_dt);
    step = now.step;
  }
#if defined(__CUDACC__)
  /// What the sums of forces, which end while these are read, do not write; and then those sums.
  struct Ready {
    Kick::Given given;
    Corners from;
    double margin;
    Index place;
  };
  __device__ void prepare(Index t, Ready& ready) const {
    ready.place = read_now(&reach_place[t]);
    ready.given.hold = read_now(&move.kick.hold[t]);
    ready.given.mass = read_now(&move.kick.mass[t]);
    ready.given.nodes = read_record_now(&move.kick.nodes[t]);
    ready.margin = 0.0;
    if (ready.place >= 0) {
      ready.from = read_record_now(&used.reference[ready.place]);
      ready.margin = read_now(&used.margin[ready.place]);
    }
  }
  __device__ void fetch(Index t, Ready& ready) const {
    ready.given.force = read_record_now(&move.kick.force[t]);
  }
  __device__ void operator()(Index t, Ready& ready) const {
    Kick::Given& given = ready.given;
    if (move.kick.damping > 0.0 || move.external.size > 0 || given.hold >= 0) {
      given.nodes = move.move_driven(t, given);
    } else {
      double c[12], f[6];
      __builtin_memcpy(c, &given.nodes, sizeof c);
      __builtin_memcpy(f, &given.force, sizeof f);
      move.move_free(t, c, f, given.mass);
      __builtin_memcpy(&given.nodes, c, sizeof c);
    }
    if (ready.place >= 0 && used.beyond(given.nodes, ready.from, ready.margin))
      *wanted = wanted_search;
    if (t == 0 && marking_due(changed[change_softened], changed[change_broken], step))
      *wanted = wanted_search;
  }
#endif
};

/// Of so many joints on, whole ones have a launch of their own: the rare work on the others needs
/// so many registers that few whole ones run at once beside it. With fewer a launch more costs
/// more.
constexpr Index fewest_joints_apart = 250'000;

/// Joints that are whole and stay so; the others are listed for DamagedJoints, in any order.
template <class Number>
struct WholeJoints {
  static constexpr const char* name = "fdem.whole_joints";
  JointForces<Number> all;
  View<Index> listed;
  Index *count, *next_count;  ///< listed in this step, and in the next, which begins with none

  BR_HD void set(const Moment& now) { all.set(now); }
#if defined(__CUDACC__)
  struct Ready {
    JointEnds ends;
    Index law;
    double length, strength;
    JointStage stage;
    double corner[4][4];
  };
  __device__ void prepare(Index i, Ready& ready) const {
    ready.ends = all.ends[i];
    ready.stage = all.stage[i];
    ready.law = read_now(&all.law[i]);
    ready.length = read_now(&all.length[i]);
    ready.strength = read_now(&all.strength[i]);
  }
  __device__ void fetch(Index, Ready& ready) const {
    const JointEnds& e = ready.ends;
    const Index at[4] = {e.a0, e.a1, e.b0, e.b1};
    for (int k = 0; k < 4; ++k) {
      const NodeState node = read_record_now(&all.nodes[at[k]]);
      __builtin_memcpy(ready.corner[k], &node, sizeof node);
    }
  }
  __device__ void operator()(Index i, const Ready& ready) const {
    if (i == 0) *next_count = 0;
    if (ready.stage == JointStage::dormant) return;
    if (ready.stage == JointStage::whole &&
        all.elastic_at(i, ready.corner, Indices<double>{ready.law}, ready.strength, ready.length))
      return;
    listed[atomicAdd(count, 1)] = i;
  }
#endif
};

/// The listed joints, by so many threads in all.
template <class Number>
struct DamagedJoints {
  static constexpr const char* name = "fdem.damaged_joints";
  static constexpr Index threads = 132 * 128;
  JointForces<Number> all;
  View<const Index> listed;
  const Index* count;

  BR_HD void set(const Moment& now) { all.set(now); }
  BR_HD void operator()(Index i) const {
    for (Index k = i; k < *count; k += threads) all.damaged_at(listed[k]);
  }
};

#if defined(__CUDACC__)
/// TriangleForces that read ahead what joints and couples do not write.
template <class Number>
struct TrianglesAhead {
  static constexpr const char* name = "fdem.triangles_ahead";
  TriangleForces<Number> all;

  struct Ready {
    TriangleNodes nodes;
    Mat2 inverse;
    double viscosity;
    Index material, couples, couples_end;
    Index edge[3];
    JointForceOf<Number> joint[3];
  };
  BR_HD void set(const Moment& now) { all.set(now); }
  __device__ void prepare(Index t, Ready& ready) const {
    for (int k = 0; k < 3; ++k) ready.edge[k] = read_now(&all.edges[t].at[k]);
    ready.material = read_now(&all.material[t]);
    ready.viscosity = read_now(&all.viscosity[t]);
    ready.couples = read_now(&all.couples.starts[t]);
    ready.couples_end = read_now(&all.couples.starts[t + 1]);
    ready.nodes = read_record_now(&all.nodes[t]);
    ready.inverse = read_record_now(&all.shape_inverse[t]);
  }
  __device__ void fetch(Index, Ready& ready) const {
    for (int k = 0; k < 3; ++k)
      ready.joint[k] = read_record_now(&all.joint_force[all.joint_of(ready.edge[k])]);
  }
  __device__ void operator()(Index t, const Ready& ready) const {
    double c[12], inverse[4];
    __builtin_memcpy(c, &ready.nodes, sizeof c);
    __builtin_memcpy(inverse, &ready.inverse, sizeof inverse);
    Vec2 sum[3];
    all.template deform<double>(t, CornersOf<double>(c), inverse, Indices<double>{ready.material},
                                ready.viscosity, sum);
    for (int k = 0; k < 3; ++k) {
      double f[4];
      const JointForce own = converted<double>(ready.joint[k]);
      __builtin_memcpy(f, &own, sizeof f);
      const Index entry = ready.edge[k];
      all.add_force(entry >= 0 && side_of(entry) != 0, f, sum[k], sum[k == 2 ? 0 : k + 1]);
    }
    all.template store_sum<double>(t, sum);
    all.add_couples(t, ready.couples, ready.couples_end);
  }
};
#endif

struct WatchReached {
  static constexpr const char* name = "fdem.watch_reached";
  View<const std::uint8_t> reached;
  std::int32_t* wanted;
  BR_HD void set(const Moment&) {}
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
  BR_HD void set(const Moment& now) { step = now.step; }
  BR_HD void operator()(Index i) const {
    if (step % evaluate_every != 0) return;
    double least = largest_least;
    for (Index t = i; t < triangles; t += threads) least = smaller(least, stable(t));
    note(least);
  }
};

/// BundleForces by sixteen threads a vertex, each with a corner: all see every corner's force and
/// add those of their own bundle up, in the same order.
struct BundlesWide {
  static constexpr const char* name = "fdem.bundles_wide";
  static constexpr Index width = 16;
  BundleForces all;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()([[maybe_unused]] Index i) const {
#if defined(__CUDA_ARCH__)
    const Index vertex = i / width, part = i % width;
    const Index first = all.starts[vertex], count = all.starts[vertex + 1] - first;
    if (count > width) {
      if (part == 0) all(vertex);
      return;
    }
    Index leader = -1, node = 0;
    Vec2 force{};
    double mass = 0.0;
    if (part < count) {
      leader = all.leader[first + part];
      node = all.nodes[first + part];
      force = all.force[node / 3].at[node % 3];
      mass = all.mass[node / 3];
    }
    const unsigned group = 0xffffU << (threadIdx.x / width * width % 32);
    Vec2 sum{};
    double total = 0.0;
    for (int k = 0; k < count; ++k) {
      const Vec2 other{__shfl_sync(group, force.x, k, width),
                       __shfl_sync(group, force.y, k, width)};
      const double other_mass = __shfl_sync(group, mass, k, width);
      if (__shfl_sync(group, leader, k, width) != leader) continue;
      sum += other;
      total += other_mass;
    }
    if (part < count) all.force[node / 3].at[node % 3] = mass * ((1.0 / total) * sum);
#endif
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

EndOfStep<AllowedStep> end_of_step(const World& w) {
  return {allowed_step(w), w.parameters.time.evaluate_every};
}

#if defined(__CUDACC__)
MoveAndWatch move_and_watch(World& w, std::int32_t* wanted) {
  return {move_kernel(w),
          {w.reach.triangle.view(), w.reach.reference.view(), w.reach.margin.view(),
           w.triangles.nodes.view(), w.reach.drift, Vec2{}},
          w.reach_place.view(),
          w.opened.changed.view(),
          wanted};
}

void launch_move(World& w, const StepClocks& clocks) {
  const auto motions = static_cast<Index>(w.prescribed.size());
  const EndOfStep<AllowedStep> end = end_of_step(w);
  const MoveAndWatch move = move_and_watch(w, &clocks.now->wanted);
  const Index triangles = w.triangles.size();
  if (motions == 0)
    return for_each_part(part(triangles, clocks.opening(move, end, true), Parts<>{}));
  const ScaleMotions scale{{},
                           w.amplitudes.view(),
                           w.amplitude_times.view(),
                           w.amplitude_factors.view(),
                           w.prescribed_velocity.view(),
                           w.motions.view()};
  for_each(w.exec, motions, clocks.opening(scale, end, true));
  for_each_part(part(triangles, clocks.timed<Stand::in_move>(move), Parts<>{}));
}

/// Joints and couples. Damaged joints are counted in turn 0 or 1.
template <class Number, class By>
void launch_pairs(World& w, Index turn, const By& by) {
  const Index joints = w.joints.size();
  if (joints + w.couples.size() == 0) {  // triangles read corners ahead, which the move writes
    for_each(w.exec, 1, by(Fence{}));
  } else if (joints < fewest_joints_apart) {
    for_each_part(part(w.couples.size(), by(couple_kernel<Number>(w)),
                       part(joints, by(joint_kernel<Number>(w)), Parts<>{})));
  } else {
    Index* const counts = w.damaged_count.data();
    for_each_part(part(joints,
                       by(WholeJoints<Number>{joint_kernel<Number>(w), w.damaged.view(),
                                              counts + turn, counts + 1 - turn}),
                       Parts<>{}));
    const DamagedJoints<Number> damaged{joint_kernel<Number>(w), std::as_const(w.damaged).view(),
                                        counts + turn};
    for_each_part(part(w.couples.size(), by(couple_kernel<Number>(w)),
                       part(DamagedJoints<Number>::threads, by(damaged), Parts<>{})));
  }
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
  launch_pairs<Number>(w, clock == w.clock.data() ? 0 : 1, by);
  constexpr Index most_threads = 132 * 128;
  const Index threads = triangles < most_threads ? triangles : most_threads;
  for_each_part(part(
      threads,
      by(NoteStable{stable_step(w), triangles, threads, w.parameters.time.evaluate_every, {clock}}),
      part(triangles, by(TrianglesAhead<Number>{triangle_kernel<Number>(w)}), Parts<>{})));
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
    for_each(exec, (w.bundles.starts.size() - 1) * BundlesWide::width,
             by(BundlesWide{bundle_kernel(w)}));
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
#else
void launch_step(World&, const StepClocks&) {}
void launch_rest(World&, const StepClocks&) {}
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
}

void place_reach(World& w) {
  w.reach_place.resize(w.triangles.size());
  for_each(w.exec, w.triangles.size(), FillNone{w.reach_place.view()});
  for_each(w.exec, w.reach.triangle.size(),
           PlaceReach{std::as_const(w.reach.triangle).view(), w.reach_place.view()});
}

/// Before launches outside those of the clock, and after.
void forget_damaged(World& w) {
  w.damaged.resize(w.joints.size() < fewest_joints_apart ? 0 : w.joints.size());
  w.damaged_count.resize(2);
  clear_bytes(w.damaged_count.data(), w.exec.space, 2 * sizeof(Index));
}

}  // namespace

#if defined(__CUDACC__)
void forces_on_device(World& w) {
  const StageTime timed(w.exec, "forces");
  const auto at_once = [](const auto& kernel) { return AtOnce(kernel); };
  forget_damaged(w);
  for_each(w.exec, 1, Fence{});
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    launch_pairs<Number>(w, 0, at_once);
    for_each_part(part(w.triangles.size(),
                       at_once(TrianglesAhead<Number>{triangle_kernel<Number>(w)}), Parts<>{}));
  });
}
#else
void forces_on_device(World&) {}
#endif

Advanced advance_on_device(World& w, const StopAt& stop) {
  if (w.amplitudes.empty() && w.clock.empty()) list_amplitudes(w);
  if (w.graph.empty()) place_reach(w);
  forget_damaged(w);
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  return run_ahead(
      w.clock, w.graph, end_of_step(w), host, stop,
      [&](const StepClocks& clocks) { launch_step(w, clocks); },
      [&](const StepClocks& clocks) { launch_rest(w, clocks); },
      [&](std::int32_t wanted) {
        const bool insertion = wanted == wanted_insertion;
        insertion ? evaluate_forces(w) : find_couples(w);
        w.graph.clear();
        place_reach(w);
        forget_damaged(w);
        return insertion;
      });
}

}  // namespace breccia::fdem
