#pragma once
// What is done to each element by itself: its sum of forces, its critical step, its motion.

#include "core/incidence.hpp"
#include "core/step_clock.hpp"
#include "dem/contacts.hpp"
#include "dem/elements.hpp"

namespace breccia::dem {

/// Prescribed motion of a support: a velocity that grows from zero, linearly.
struct Motion {
  Vec3 velocity;  ///<  [m/s]
  double ramp;    ///< time to reach it  [s]

  BR_HD Vec3 at(double time) const {
    const double share = ramp > 0.0 ? smaller(1.0, larger(0.0, time / ramp)) : 1.0;
    return share * velocity;
  }
};

/// 1 where an element has used its margin up: the list of pairs is no longer valid.
struct UsedMargin {
  View<const ElementState> state;
  View<const Vec3> reference;
  View<const double> margin;
  BR_HD double operator()(Index e) const {
    return beyond(state[e].position, reference[e], margin[e]) ? 1.0 : 0.0;
  }
  BR_HD static bool beyond(const Vec3& position, const Vec3& from, double allowed) {
    const Vec3 moved = position - from;
    return !(dot(moved, moved) <= allowed * allowed);  // NaN counts as beyond
  }
};

/// What the concrete links of an element have added up to so far. Zero between two steps.
struct LinkSums {
  SixSums as_b;              ///< force, then torque, of links that end at the element  [N, N m]
  SixFloatSums stiffness_b;  ///< K, then K^theta  [N/m, N m]
  SixSums as_a;              ///< torque, then minus the force, of links that start there
  SixFloatSums stiffness_a;  ///< K^theta, then K
};

/// addForce of Durand 2012, 4.2: each element sums over its own interactions: concrete links in
/// their order (already in `sums`), then bars and contacts in the order of the partners' global
/// ids, so no thread or device changes a bit. Also the element's smallest inertia over stiffness
/// (section 4.4).
struct GatherForces {
  static constexpr const char* name = "dem.gather";
  View<LinkSums> sums;
  IncidenceView bars, contacts;
  View<const Action> bar_actions, contact_actions;
  View<const double> mass, inertia;
  View<const std::uint8_t> fixed;
  View<Vec3> force, torque;
  View<double> critical;  ///< min over free coordinates of inertia / stiffness  [s2]

  BR_HD static void add(LinkSums& sums, const IncidenceView& incidence,
                        const View<const Action>& actions, Index element) {
    for (Index k = incidence.first(element); k < incidence.last(element); ++k) {
      const Entry entry = incidence.entries[k];
      const Action& action = actions[pair_of(entry)];
      if (side_of(entry) == 0) {
        sums.as_a.add(action.numbers);
        sums.stiffness_a.add(action.stiffness);
      } else {
        sums.as_b.add(action.numbers + 3);
        sums.stiffness_b.add(action.stiffness + 3);
      }
    }
  }

  BR_WHOLE BR_HD void operator()(Index e) const {
    LinkSums& s = sums[e];
    add(s, bars, bar_actions, e);
    add(s, contacts, contact_actions, e);
    finish(e, s);
    s.as_b = s.as_a = {};
    s.stiffness_b = s.stiffness_a = {};
  }

  /// What follows for an element from all its sums.
  BR_HD void finish(Index e, const LinkSums& s) const {
    force[e] = {s.as_b[0] - s.as_a[3], s.as_b[1] - s.as_a[4], s.as_b[2] - s.as_a[5]};
    torque[e] = {s.as_b[3] + s.as_a[0], s.as_b[4] + s.as_a[1], s.as_b[5] + s.as_a[2]};
    float straight = 0.0F, turning = 0.0F;  // largest stiffness of a free coordinate
    for (int c = 0; c < 3; ++c) {
      const float k = s.stiffness_a[3 + c] + s.stiffness_b[c];
      const float k_theta = s.stiffness_a[c] + s.stiffness_b[3 + c];
      if ((fixed[e] >> c & 1) == 0 && k > straight) straight = k;
      if ((fixed[e] >> (3 + c) & 1) == 0 && k_theta > turning) turning = k_theta;
    }
    const double slowest =
        larger(static_cast<double>(straight) / mass[e], static_cast<double>(turning) / inertia[e]);
    critical[e] = slowest > 0.0 ? 1.0 / slowest : 1e300;
  }
};

/// For each element the concrete links that it is one end of, in the order of their sums.
struct LinkRows {
  Buffer<Index> starts, links;

  explicit LinkRows(Space space = Space::host) : starts(space), links(space) {}

  struct Seen {
    View<const Index> starts, links;
  };
  Seen view() const { return {starts.view(), links.view()}; }
};

/// GatherForces where every link has an action: on a device.
struct GatherRows {
  static constexpr const char* name = "dem.gather_rows";
  GatherForces gather;
  LinkRows::Seen rows_a, rows_b;
  View<const Action> actions;

  BR_HD void operator()(Index e) const {
    LinkSums s{};
    for (Index k = rows_a.starts[e]; k < rows_a.starts[e + 1]; ++k) {
      const Action& action = actions[rows_a.links[k]];
      s.as_a.add(action.numbers);
      s.stiffness_a.add(action.stiffness);
    }
    for (Index k = rows_b.starts[e]; k < rows_b.starts[e + 1]; ++k) {
      const Action& action = actions[rows_b.links[k]];
      s.as_b.add(action.numbers + 3);
      s.stiffness_b.add(action.stiffness + 3);
    }
    GatherForces::add(s, gather.bars, gather.bar_actions, e);
    GatherForces::add(s, gather.contacts, gather.contact_actions, e);
    gather.finish(e, s);
  }
  BR_HD void set(const Moment&) {}
};

/// How the forces of this time change velocities (leapfrog with a variable step, Durand 2012, 3.3).
struct Kick {
  double time;              ///< of the forces  [s]
  double last_dt, next_dt;  ///< steps before and after  [s]
  Vec3 gravity;             ///<  [m/s2]
  double damping;           ///< lambda of Cundall's local damping  [-]
  View<const Motion> motions;
  View<const double> mass, inertia;
  View<const ElementState> state;
  View<const Vec3> force, torque;
  View<const std::uint8_t> fixed;
  View<const std::int16_t> motion;

  struct Result {
    Vec3 velocity, spin;               ///< half a step later
    Vec3 damped_force, damped_torque;  ///< what damping took off
  };

  BR_HD void set(const Moment& now) {
    time = now.time;
    last_dt = now.last_dt;
    next_dt = now.next_dt;
  }
  BR_HD static double opposed(double force, double velocity) {
    return velocity > 0.0 ? absolute(force) : velocity < 0.0 ? -absolute(force) : 0.0;
  }
  /// Share of a force that opposes the motion it is about to drive.
  BR_HD Vec3 local_damping(const Vec3& f, const Vec3& v, double over_inertia) const {
    const double half = 0.5 * next_dt * over_inertia;
    return {damping * opposed(f.x, v.x + half * f.x), damping * opposed(f.y, v.y + half * f.y),
            damping * opposed(f.z, v.z + half * f.z)};
  }

  /// What acts on an element, and what it is.
  struct Given {
    Vec3 force, torque;
    double mass, inertia;
    int fixed;
  };
  BR_HD Given given(Index e) const { return {force[e], torque[e], mass[e], inertia[e], fixed[e]}; }

  BR_HD Result operator()(Index e) const { return (*this)(e, read_record(state, e), given(e)); }
  BR_HD Result operator()(Index e, const ElementState& now, const Given& of) const {
    Result r{};
    const Vec3 velocity = now.velocity, spin = now.spin;
    const double span = 0.5 * (last_dt + next_dt);
    Vec3 f = of.force + of.mass * gravity, t = of.torque;
    if (damping > 0.0) {
      r.damped_force = local_damping(f, velocity, 1.0 / of.mass);
      r.damped_torque = local_damping(t, spin, 1.0 / of.inertia);
      f -= r.damped_force;
      t -= r.damped_torque;
    }
    r.velocity = velocity + (span / of.mass) * f;
    r.spin = spin + (span / of.inertia) * t;
    const int held = of.fixed;
    if (held != 0) {
      const Vec3 given = motion[e] >= 0 ? motions[motion[e]].at(time + 0.5 * next_dt) : Vec3{};
      if ((held & fixed_x) != 0) r.velocity.x = given.x;
      if ((held & fixed_y) != 0) r.velocity.y = given.y;
      if ((held & fixed_z) != 0) r.velocity.z = given.z;
      if ((held & fixed_spin_x) != 0) r.spin.x = 0.0;
      if ((held & fixed_spin_y) != 0) r.spin.y = 0.0;
      if ((held & fixed_spin_z) != 0) r.spin.z = 0.0;
    }
    return r;
  }
};

/// accelerationsFromForces, velocitiesFromAccelerations and positionsFromVelocities of Durand
/// 2012, 4.4.
struct MoveElements {
  static constexpr const char* name = "dem.move";
  Kick kick;
  View<ElementState> state;
  View<Quaternion> orientation;
  View<double> damping_work, load_work;

  BR_HD void set(const Moment& now) { kick.set(now); }
  BR_WHOLE BR_HD void operator()(Index e) const { moved(e); }
  /// @returns where it is then
  BR_HD Vec3 moved(Index e) const {
    return moved(e, read_record(kick.state, e), read_record(View<const Quaternion>(orientation), e),
                 kick.given(e));
  }
  BR_HD Vec3 moved(Index e, ElementState moved, const Quaternion& before_turn,
                   const Kick::Given& of) const {
    const Kick::Result r = kick(e, moved, of);
    const Vec3 before = kick.last_dt * moved.velocity, after = kick.next_dt * r.velocity;
    if (kick.damping > 0.0)
      damping_work[e] +=
          0.5 * dot(r.damped_force, before + after) +
          0.5 * dot(r.damped_torque, kick.last_dt * moved.spin + kick.next_dt * r.spin);
    if (of.fixed != 0) load_work[e] += reaction_work(e, r, before + after);
    moved.velocity = r.velocity;
    moved.spin = r.spin;
    moved.position += after;
    write_record(state, e, moved);
    write_record(orientation, e, turned(before_turn, kick.next_dt * r.spin));
    return moved.position;
  }

 private:
  /// Work of the force that holds an element to its prescribed motion.
  BR_HD double reaction_work(Index e, const Kick::Result& r, const Vec3& twice_moved) const {
    const double span = 0.5 * (kick.last_dt + kick.next_dt);
    if (!(span > 0.0)) return 0.0;
    const Vec3 gained = (kick.mass[e] / span) * (r.velocity - state[e].velocity);
    const Vec3 given = kick.force[e] + kick.mass[e] * kick.gravity - r.damped_force;
    const Vec3 held = gained - given;  // zero in free directions, up to rounding
    double work = 0.0;
    if ((kick.fixed[e] & fixed_x) != 0) work += 0.5 * held.x * twice_moved.x;
    if ((kick.fixed[e] & fixed_y) != 0) work += 0.5 * held.y * twice_moved.y;
    if ((kick.fixed[e] & fixed_z) != 0) work += 0.5 * held.z * twice_moved.z;
    return work;
  }
};

}  // namespace breccia::dem
