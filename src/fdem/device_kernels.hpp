#pragma once
// Kernels that only launches ahead on a device have: those of the step that read ahead, watch for
// what the host must do, or put the work of several into one launch.

#include "core/timed.hpp"
#include "exec/early.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

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
  BR_HD Vec2 velocity_of(Index i) const {
    const double middle = now.time + 0.5 * now.next_dt;
    return tables[i].at(middle, times, factors) * velocity[i];
  }
  BR_HD void operator()(Index i) const { motions[i].velocity = velocity_of(i); }
};

/// What ScaleMotions notes, for those that do not wait for it.
struct Scaled {
  ScaleMotions motions;
  BR_HD Vec2 operator()(Index i) const { return motions.velocity_of(i); }
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
  ScaleMotions motions;
  UsedMargin used;
  View<const Index> reach_place;
  View<const std::uint8_t> changed;
  std::int32_t* wanted;
  std::int64_t step = 0;

  BR_HD void set(const Moment& now) {
    move.set(now);
    motions.set(now);
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
      given.nodes = move.move_driven(t, given, Scaled{motions});
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
/// BundleForces in the launch that adds up forces: whoever brings the last sum of a vertex shares
/// them out. For a model few of whose corners are tied: the others' threads wait for theirs.
struct BundlesInPassing {
  BundleForces all;
  View<const Index> row;     ///< of a triangle with tied corners in `vertex`, -1; empty: not here
  View<const Index> vertex;  ///< of each of its three corners among `all`, -1
  View<Index> missing;       ///< sums that each vertex waits for

  __device__ Index row_of(Index t) const { return row.size == 0 ? -1 : read_now(&row[t]); }
  /// @param place  row_of a triangle whose sums are written
  __device__ void note(Index place) const {
    __threadfence();
    for (int k = 0; k < 3; ++k) {
      const Index v = vertex[3 * place + k];
      if (v < 0 || atomicSub(&missing[v], 1) != 1) continue;
      __threadfence();
      const Index first = all.starts[v], count = all.starts[v + 1] - first;
      missing[v] = count;  // for the next step
      if (count <= most)
        share(first, count);
      else
        share_slowly(first, first + count);
    }
  }

 private:
  static constexpr int most = 8;

  __device__ Vec2 force_now(Index node) const {
    const Vec2& f = all.force[node / 3].at[node % 3];
    return {__ldcg(&f.x), __ldcg(&f.y)};
  }
  /// As BundleForces, all corners read at once.
  __device__ void share(Index first, Index count) const {
    Index node[most], leader[most];
    Vec2 force[most];
    double mass[most];
#pragma unroll
    for (int k = 0; k < most; ++k) {
      const Index at = first + (k < count ? k : 0);
      node[k] = all.nodes[at];
      leader[k] = k < count ? all.leader[at] : -1;
    }
#pragma unroll
    for (int k = 0; k < most; ++k) {
      force[k] = force_now(node[k]);
      mass[k] = all.mass[node[k] / 3];
    }
#pragma unroll
    for (int own = 0; own < most; ++own) {
      Vec2 sum{};
      double total = 0.0;
#pragma unroll
      for (int k = 0; k < most; ++k)
        if (leader[k] == leader[own]) {
          sum += force[k];
          total += mass[k];
        }
      if (own < count)
        all.force[node[own] / 3].at[node[own] % 3] = mass[own] * ((1.0 / total) * sum);
    }
  }
  __device__ void share_slowly(Index begin, Index end) const {
    for (Index first = begin; first < end; ++first) {
      if (all.leader[first] != first) continue;
      Vec2 sum{};
      double total = 0.0;
      for (Index k = first; k < end; ++k) {
        if (all.leader[k] != first) continue;
        sum += force_now(all.nodes[k]);
        total += all.mass[all.nodes[k] / 3];
      }
      const Vec2 acceleration = (1.0 / total) * sum;
      for (Index k = first; k < end; ++k)
        if (all.leader[k] == first)
          all.force[all.nodes[k] / 3].at[all.nodes[k] % 3] =
              all.mass[all.nodes[k] / 3] * acceleration;
    }
  }
};

/// TriangleForces that read ahead what joints and couples do not write.
template <class Number>
struct TrianglesAhead {
  static constexpr const char* name = "fdem.triangles_ahead";
  TriangleForces<Number> all;
  BundlesInPassing bundles;

  struct Ready {
    TriangleNodes nodes;
    Mat2 inverse;
    double viscosity;
    Index material, couples, couples_end, bundled;
    Index edge[3];
    JointForceOf<Number> joint[3];
  };
  BR_HD void set(const Moment& now) { all.set(now); }
  __device__ void prepare(Index t, Ready& ready) const {
    for (int k = 0; k < 3; ++k) ready.edge[k] = read_now(&all.edges[t].at[k]);
    ready.bundled = bundles.row_of(t);
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
    if (ready.bundled >= 0) bundles.note(ready.bundled);
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

}  // namespace breccia::fdem
