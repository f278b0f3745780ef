#pragma once
// The motion of tetrahedra: what acts on their corners, and how far they may go.

#include "core/drift.hpp"
#include "core/step_clock.hpp"
#include "fdem/joints/joint_kernels.hpp"
#include "fdem3/elements/tetrahedra.hpp"

namespace breccia::fdem3 {

/// Prescribed motion of a tetrahedron's corners: bits 3 k, 3 k + 1, 3 k + 2 fix x, y, z of corner
/// k, whose motion is motion[k].
struct Hold {
  std::uint16_t fixed = 0;
  std::int16_t motion[4] = {-1, -1, -1, -1};
};

/// A velocity that follows a table of factors over time, here and now.
struct Motion {
  Vec3 velocity;  ///< over the step to come  [m/s]
};

/// Newton's second law for every corner, by leapfrog with a variable step (Munjiza 2004, 5.12).
struct Kick {
  double last_dt, next_dt;  ///< steps before and after the forces  [s]
  Vec3 gravity;             ///<  [m/s2]
  double damping;           ///< of Cundall's local damping  [-]
  View<const Hold> holds;
  View<const Motion> motions;
  View<const double> mass;
  View<const TetrahedronNodes> nodes;
  View<const Corners> force;
  View<const Index> hold;

  struct Result {
    Vec3 velocity[4];  ///< half a step later
    Vec3 damped[4];    ///< force that damping took off
  };

  BR_HD double span() const { return 0.5 * (last_dt + next_dt); }
  BR_HD static double opposed(double force, double velocity) {
    return velocity > 0.0 ? abs(force) : velocity < 0.0 ? -abs(force) : 0.0;
  }
  /// A velocity at the time of the forces, from those half a step before and after.
  BR_HD Vec3 between(const Vec3& before, const Vec3& after) const {
    return span() > 0.0 ? before + (0.5 * last_dt / span()) * (after - before) : before;
  }
  BR_HD Result operator()(Index t) const {
    Result r{};
    const double m = mass[t], scale = span() / m;
    for (int k = 0; k < 4; ++k) {
      const Vec3 before = nodes[t].at[k].velocity;
      Vec3 f = force[t].at[k] + m * gravity;
      if (damping > 0.0) {
        const Vec3 drift = before + (0.5 * scale) * f;
        r.damped[k] = {damping * opposed(f.x, drift.x), damping * opposed(f.y, drift.y),
                       damping * opposed(f.z, drift.z)};
        f -= r.damped[k];
      }
      r.velocity[k] = before + scale * f;
    }
    if (hold[t] < 0) return r;
    const Hold& h = holds[hold[t]];
    for (int k = 0; k < 4; ++k) {
      const int bits = h.fixed >> (3 * k) & 7;
      if (bits == 0) continue;
      const Vec3 given = h.motion[k] >= 0 ? motions[h.motion[k]].velocity : Vec3{};
      r.velocity[k] = held(bits, given, r.velocity[k]);
      r.damped[k] = held(bits, Vec3{}, r.damped[k]);  // what is held is not damped
    }
    return r;
  }
  /// The components that are held, and the others as they are.
  BR_HD static Vec3 held(int bits, const Vec3& given, const Vec3& other) {
    return {(bits & 1) != 0 ? given.x : other.x, (bits & 2) != 0 ? given.y : other.y,
            (bits & 4) != 0 ? given.z : other.z};
  }
  /// Force that holds a corner to its prescribed motion; zero in free directions.  [N]
  BR_HD Vec3 reaction(Index t, int k, const Result& r) const {
    if (hold[t] < 0 || !(span() > 0.0)) return {};
    const int bits = holds[hold[t]].fixed >> (3 * k) & 7;
    const Vec3 gained = (mass[t] / span()) * (r.velocity[k] - nodes[t].at[k].velocity);
    const Vec3 given = force[t].at[k] + mass[t] * gravity - r.damped[k];
    return held(bits, gained - given, Vec3{});
  }
};

/// Whether tetrahedra have used their margins up: the list of couples is no longer valid.
struct UsedMargin {
  View<const Index> place;  ///< of each in the other two; -1: a ghost, or it cannot touch
  View<const Corners> reference;
  View<const double> margin;
  Drift drift;
  Vec3 drifted;  ///< since the search  [m]

  /// @param time  of the positions  [s]
  BR_HD void set_time(double time) { drifted = drift.way(time); }
  BR_HD bool operator()(Index t, const TetrahedronNodes& now) const {
    const Index i = place[t];
    if (i < 0) return false;
    bool inside = dot(drifted, drifted) <= drift.farthest * drift.farthest;
    for (int k = 0; k < 4; ++k) {
      const Vec3 moved = (now.at[k].position - reference[i].at[k]) - drifted;
      inside = inside && dot(moved, moved) <= margin[i] * margin[i];
    }
    return !inside;  // NaN counts as beyond
  }
};

/// Moves the corners and books the work of loads, supports and local damping; and the question
/// whether margins still hold.
struct MoveTetrahedra {
  static constexpr const char* name = "fdem3.move";
  Kick kick;
  View<const Corners> external;
  View<TetrahedronNodes> nodes;
  View<double> damping_work, load_work;
  UsedMargin used;
  View<std::uint8_t> beyond;  ///< 1: some margin is used up  [-]  (1)

  BR_HD void operator()(Index t) const {
    const Kick::Result r = kick(t);
    TetrahedronNodes moved = nodes[t];
    const bool held = kick.hold[t] >= 0;
    double damped = 0.0, booked = 0.0;
    for (int k = 0; k < 4; ++k) {
      NodeState& n = moved.at[k];
      const Vec3 after = kick.next_dt * r.velocity[k];
      const Vec3 both = kick.last_dt * n.velocity + after;
      if (kick.damping > 0.0) damped += 0.5 * dot(r.damped[k], both);
      if (external.size > 0) booked += 0.5 * dot(external[t].at[k], both);
      if (held) booked += 0.5 * dot(kick.reaction(t, k, r), both);
      n.velocity = r.velocity[k];
      n.position += after;
    }
    if (kick.damping > 0.0) damping_work[t] += damped;
    if (held || external.size > 0) load_work[t] += booked;
    nodes[t] = moved;
    if (used(t, moved)) fdem::set_flag(beyond, 0);
  }
};

}  // namespace breccia::fdem3
