#pragma once
// Kernels of single elements: sum of forces, critical step, motion.

#include "core/drift.hpp"
#include "core/incidence.hpp"
#include "core/kernel.hpp"
#include "core/table_over_time.hpp"
#include "dem/contacts.hpp"
#include "dem/elements.hpp"
#include "dem/link_sums.hpp"

namespace breccia::dem {

/// Prescribed motion: in each direction a velocity times a factor over time.
struct Motion {
  Vec3 velocity;           ///<  [m/s]
  AmplitudeTable x, y, z;  ///< factors of its parts
  std::int32_t load = 0;   ///< 1: what is given is no velocity, but a load over mass  [m/s2]
  double friction = 0.0;   ///< of a platen that presses along its only held direction  [-]

  /// @param times, factors  of all tables
  BR_HD Vec3 at(double time, const View<const double>& times,
                const View<const double>& factors) const {
    return {x.at(time, times, factors) * velocity.x, y.at(time, times, factors) * velocity.y,
            z.at(time, times, factors) * velocity.z};
  }
};

/// Whether elements have used their margins up: the list of pairs is no longer valid.
struct UsedMargin {
  View<const Vec3> reference;
  View<const double> margin;
  Drift drift;
  Vec3 drifted;  ///< since the search  [m]
  bool too_far;  ///< for rounding

  /// @param time  of the positions  [s]
  BR_HD void set_time(double time) {
    drifted = drift.way(time);
    too_far = !(dot(drifted, drifted) <= drift.farthest * drift.farthest);
  }
  template <class R>
  BR_HD auto beyond(const Vec3Of<R>& position, const Vec3Of<R>& from, const R& allowed) const {
    const Vec3Of<R> way = position - from;
    const Vec3Of<R> moved{way.x - drifted.x, way.y - drifted.y, way.z - drifted.z};
    return !(dot(moved, moved) <= allowed * allowed);  // NaN counts as beyond
  }
};

/// addForce of Durand 2012, 4.2: each element sums over its own interactions: concrete links in
/// their order (already in `sums`), then bars and contacts in the order of the partners' global
/// ids, so no thread or device changes a bit. Also the element's smallest inertia over stiffness
/// (section 4.4).
struct GatherForces {
  static constexpr const char* name = "dem.gather";
  View<LinkSums> sums;
  IncidenceView bars, contacts;
  View<const PairForce> bar_actions, contact_actions;
  View<const double> mass, inertia;
  View<const std::uint8_t> fixed;
  View<Vec3> force, torque;
  View<double> critical;  ///< inertia over a bound of the largest stiffness, in any axes  [s2]
  bool evaluates;         ///< as StepTime: otherwise critical numbers stay as they are

  BR_HD void add_as_b(Index e, const PairForce& action) const {
    sums[e].as_b.add(action.numbers + 3);
    if (evaluates) sums[e].stiffness_b.add(action.stiffness);
  }
  BR_HD void add(const IncidenceView& incidence, const View<const PairForce>& actions,
                 Index e) const {
    for (Index k = incidence.first(e); k < incidence.last(e); ++k) {
      const Entry entry = incidence.entries[k];
      const PairForce& action = actions[pair_of(entry)];
      if (side_of(entry) != 0) {
        add_as_b(e, action);
        continue;
      }
      sums[e].as_a.add(action.numbers);
      if (evaluates) sums[e].stiffness_a.add(action.stiffness);
    }
  }

  BR_WHOLE BR_HD void operator()(Index e) const { at<double>(e); }
  /// Element e and its neighbours in a pack.
  template <class R>
  BR_HD void at(Index e) const {
    add_all<R>(bars, bar_actions, e);
    add_all<R>(contacts, contact_actions, e);
    finish(e, totals<R>(sums, e));
    for (Index k = 0; k < width_of<R>; ++k) sums[e + k].as_a = sums[e + k].as_b = {};
    if (!evaluates) return;
    R straight, turning;
    find_stiffest(sums, fixed, e, straight, turning);
    const R slowest = max(straight / load<R>(mass, e), turning / load<R>(inertia, e));
    store(critical, e, select(slowest > 0.0, 1.0 / slowest, constant<R>(largest_least)));
    for (Index k = 0; k < width_of<R>; ++k) sums[e + k].clear_stiffness();
  }
  template <class R>
  BR_HD void add_all(const IncidenceView& incidence, const View<const PairForce>& actions,
                     Index e) const {
    if (incidence.first(e) == incidence.first(e + width_of<R>)) return;
    for (Index k = 0; k < width_of<R>; ++k) add(incidence, actions, e + k);
  }

  /// Stores the totals of an element, or a pack, from all its sums.
  template <class R>
  BR_HD void finish(Index e, const TotalsOf<R>& of) const {
    store_vectors(force, e, of.force);
    store_vectors(torque, e, of.torque);
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

/// State of element e, or of a pack.
template <class R>
BR_HD inline ElementStateOf<R> element_state(const View<const ElementState>& state, Index e) {
  if constexpr (width_of<R> == 1) {
    return read_record(state, e);
  } else {
    R s[10];
    gather_records(state, consecutive<R>(e), s);
    return {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, {s[6], s[7], s[8]}, s[9]};
  }
}

/// How the forces of this time change velocities (leapfrog with a variable step, Durand 2012, 3.3).
struct Kick {
  double time;              ///< of the forces  [s]
  double last_dt, next_dt;  ///< steps before and after  [s]
  Vec3 gravity;             ///<  [m/s2]
  double damping;           ///< lambda of Cundall's local damping  [-]
  View<const Motion> motions;
  View<const double> motion_times, motion_factors;  ///< tables of their factors
  View<const double> mass, inertia;
  View<const ElementState> state;
  View<const Vec3> force, torque;
  View<const std::uint8_t> fixed;
  View<const std::int16_t> motion;

  template <class R>
  struct ResultOf {
    Vec3Of<R> velocity, spin;               ///< half a step later
    Vec3Of<R> damped_force, damped_torque;  ///< what damping took off
  };
  using Result = ResultOf<double>;

  BR_HD void set(const StepTime& now) {
    time = now.time;
    last_dt = now.last_dt;
    next_dt = now.next_dt;
  }
  template <class R>
  BR_HD static R opposed(const R& force, const R& velocity) {
    const R size = abs(force);
    return select(velocity > 0.0, size, select(velocity < 0.0, -size, constant<R>(0.0)));
  }
  /// Share of a force that opposes the motion it is about to drive.
  template <class R>
  BR_HD Vec3Of<R> local_damping(const Vec3Of<R>& f, const Vec3Of<R>& v,
                                const R& over_inertia) const {
    const R half = 0.5 * next_dt * over_inertia;
    return {damping * opposed<R>(f.x, v.x + half * f.x),
            damping * opposed<R>(f.y, v.y + half * f.y),
            damping * opposed<R>(f.z, v.z + half * f.z)};
  }

  /// Forces on an element or on each of a pack, and its constants.
  template <class R>
  struct GivenOf {
    Vec3Of<R> force, torque;
    R mass, inertia;
    int fixed;  ///< of any of them, bits of Fixed
  };
  using Given = GivenOf<double>;
  template <class R>
  BR_HD GivenOf<R> given(Index e) const {
    int any_fixed = 0;
    for (Index k = 0; k < width_of<R>; ++k) any_fixed |= fixed[e + k];
    return {load_vectors<R>(force, e), load_vectors<R>(torque, e), load<R>(mass, e),
            load<R>(inertia, e), any_fixed};
  }
  template <class R>
  BR_HD Vec3Of<R> weight(const R& of_mass) const {
    return {of_mass * gravity.x, of_mass * gravity.y, of_mass * gravity.z};
  }

  BR_HD Result operator()(Index e) const {
    return (*this)(e, read_record(state, e), given<double>(e));
  }
  template <class R>
  BR_HD ResultOf<R> operator()(Index e, const ElementStateOf<R>& now, const GivenOf<R>& of) const {
    ResultOf<R> r{};
    const double span = 0.5 * (last_dt + next_dt);
    Vec3Of<R> f = of.force + weight(of.mass), t = of.torque;
    if ((of.fixed & fixed_driven) != 0) f += load_on<R>(e, of.mass);
    if (damping > 0.0) {
      r.damped_force = local_damping<R>(f, now.velocity, 1.0 / of.mass);
      r.damped_torque = local_damping<R>(t, now.spin, 1.0 / of.inertia);
      f -= r.damped_force;
      t -= r.damped_torque;
    }
    r.velocity = now.velocity + (span / of.mass) * f;
    r.spin = now.spin + (span / of.inertia) * t;
    if (of.fixed != 0) hold(e, now, of, r);
    return r;
  }

  /// A velocity or spin at the time of the forces, from those half a step before and after.
  BR_HD Vec3 between(const Vec3& before, const Vec3& after) const {
    const double span = 0.5 * (last_dt + next_dt);
    return span > 0.0 ? before + (0.5 * last_dt / span) * (after - before) : before;
  }
  /// Force that holds an element to its prescribed motion; zero in free directions.  [N]
  template <class R>
  BR_HD Vec3Of<R> reaction(Index e, const Vec3Of<R>& before, const ResultOf<R>& r,
                           const GivenOf<R>& of) const {
    const double span = 0.5 * (last_dt + next_dt);
    if (!(span > 0.0)) return {};
    const Vec3Of<R> gained = (of.mass / span) * (r.velocity - before);
    const Vec3Of<R> given = of.force + weight(of.mass) - r.damped_force;
    const Vec3Of<R> held = gained - given;
    const R none = constant<R>(0.0);
    return {select(holds<R>(e, fixed_x | fixed_driven), held.x, none),
            select(holds<R>(e, fixed_y | fixed_driven), held.y, none),
            select(holds<R>(e, fixed_z | fixed_driven), held.z, none)};
  }
  /// Of the first half step, from the velocity at the start: held elements gain
  /// m (v_+^2 - v_0^2) / 2 there, and reaction() times the way of a half step is
  /// m (v_+ - v_0)^2 / 2 more.  [J]
  template <class R>
  BR_HD R of_start(Index e, const Vec3Of<R>& before, const ResultOf<R>& r,
                   const GivenOf<R>& of) const {
    const Vec3Of<R> gained = r.velocity - before;
    const R none = constant<R>(0.0);
    const Vec3Of<R> held{select(holds<R>(e, fixed_x | fixed_driven), gained.x, none),
                         select(holds<R>(e, fixed_y | fixed_driven), gained.y, none),
                         select(holds<R>(e, fixed_z | fixed_driven), gained.z, none)};
    return 0.5 * of.mass * dot(held, held);
  }
  /// Where one of the bits `which` of Fixed is set, of element e and its neighbours in a pack.
  template <class R>
  BR_HD auto holds(Index e, int which) const {
    double set[width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) set[k] = (fixed[e + k] & which) != 0 ? 1.0 : 0.0;
    return pack_of<R>(set) > 0.5;
  }

 private:
  /// Prescribed degrees of freedom move as they must; dashpots C take up C (v_- + v_+) / 2, which
  /// is stable for all of them; platens rub.
  template <class R>
  BR_HD void hold(Index e, const ElementStateOf<R>& now, const GivenOf<R>& of,
                  ResultOf<R>& r) const {
    double x[width_of<R>], y[width_of<R>], z[width_of<R>], rough[width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) {
      const Index way = motion[e + k];
      const Vec3 v = way >= 0 && motions[way].load == 0
                         ? motions[way].at(time + 0.5 * next_dt, motion_times, motion_factors)
                         : Vec3{};
      rough[k] = way >= 0 && is_rubbed(fixed[e + k]) ? motions[way].friction : 0.0;
      x[k] = v.x;
      y[k] = v.y;
      z[k] = v.z;
    }
    const R still = constant<R>(0.0);
    if ((of.fixed & fixed_driven) != 0) {
      double dashed[width_of<R>];
      for (Index k = 0; k < width_of<R>; ++k)
        dashed[k] = (fixed[e + k] & fixed_driven) != 0 && !is_rubbed(fixed[e + k]) ? 1.0 : 0.0;
      const auto absorbs = pack_of<R>(dashed) > 0.5;
      const R square = (0.25 * (last_dt + next_dt)) * (now.radius * now.radius) / of.mass;
      const auto slow = [&](const R& dashpot, const R& before, R& after) {
        const R half = square * dashpot;
        after = select(absorbs, (after - half * before) / (1.0 + half), after);
      };
      slow(pack_of<R>(x), now.velocity.x, r.velocity.x);
      slow(pack_of<R>(y), now.velocity.y, r.velocity.y);
      slow(pack_of<R>(z), now.velocity.z, r.velocity.z);
    }
    const Vec3Of<R> alone = r.velocity + ((0.5 * (last_dt + next_dt)) / of.mass) * r.damped_force;
    prescribe(holds<R>(e, fixed_x), pack_of<R>(x), r.velocity.x, r.damped_force.x);
    prescribe(holds<R>(e, fixed_y), pack_of<R>(y), r.velocity.y, r.damped_force.y);
    prescribe(holds<R>(e, fixed_z), pack_of<R>(z), r.velocity.z, r.damped_force.z);
    if ((of.fixed & fixed_driven) != 0) rub(e, pack_of<R>(rough), alone, r);
    prescribe(holds<R>(e, fixed_spin_x), still, r.spin.x, r.damped_torque.x);
    prescribe(holds<R>(e, fixed_spin_y), still, r.spin.y, r.damped_torque.y);
    prescribe(holds<R>(e, fixed_spin_z), still, r.spin.z, r.damped_torque.z);
  }
  /// Friction of platens, which stand still across the direction that they hold: it takes the
  /// velocity there, but no more of it than friction times what the platen adds along.
  /// @param alone  velocities without any platen or damping  [m/s]
  template <class R>
  BR_HD void rub(Index e, const R& friction, const Vec3Of<R>& alone, ResultOf<R>& r) const {
    const R none = constant<R>(0.0);
    const auto along_x = holds<R>(e, fixed_x), along_y = holds<R>(e, fixed_y),
               along_z = holds<R>(e, fixed_z);
    const R pushed = select(along_x, abs(r.velocity.x - alone.x),
                            select(along_y, abs(r.velocity.y - alone.y),
                                   select(along_z, abs(r.velocity.z - alone.z), none)));
    const Vec3Of<R> across{select(along_x, none, r.velocity.x), select(along_y, none, r.velocity.y),
                           select(along_z, none, r.velocity.z)};
    const R size = norm(across), most = friction * pushed;
    const R left = select(size > most, (size - most) / max(size, constant<R>(1e-300)), none);
    const R kept = select(friction > 0.0, left, constant<R>(1.0));
    r.velocity = {select(along_x, r.velocity.x, kept * across.x),
                  select(along_y, r.velocity.y, kept * across.y),
                  select(along_z, r.velocity.z, kept * across.z)};
  }
  /// Dead load on an element, or on each of a pack.  [N]
  template <class R>
  BR_HD Vec3Of<R> load_on(Index e, const R& of_mass) const {
    double x[width_of<R>], y[width_of<R>], z[width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) {
      const Index way = (fixed[e + k] & fixed_driven) != 0 ? motion[e + k] : -1;
      const Vec3 a = way >= 0 && motions[way].load != 0
                         ? motions[way].at(time, motion_times, motion_factors)
                         : Vec3{};
      x[k] = a.x;
      y[k] = a.y;
      z[k] = a.z;
    }
    return of_mass * Vec3Of<R>{pack_of<R>(x), pack_of<R>(y), pack_of<R>(z)};
  }
  /// Local damping leaves held directions out.
  template <class R, class Truth>
  BR_HD static void prescribe(const Truth& held, const R& given, R& velocity, R& damped) {
    velocity = select(held, given, velocity);
    damped = select(held, constant<R>(0.0), damped);
  }
};

/// accelerationsFromForces, velocitiesFromAccelerations and positionsFromVelocities of Durand
/// 2012, 4.4; and the question whether margins still hold.
struct MoveElements {
  static constexpr const char* name = "dem.move";
  Kick kick;
  View<ElementState> state;
  View<Quaternion> orientation;
  View<double> damping_work, load_work;
  UsedMargin used;

  template <class R>
  struct Loaded {
    ElementStateOf<R> state;
    QuaternionOf<R> turn;
    Kick::GivenOf<R> given;
    Vec3Of<R> reference;
    R margin;
  };
  BR_HD void set(const StepTime& now) {
    kick.set(now);
    used.set_time(now.time + now.next_dt);
  }
  /// All but the sums of forces.
  template <class R>
  BR_HD void load_early(Index e, Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1) {
      loaded.state = read_record_now(&kick.state[e]);
      loaded.turn = read_record_now(&orientation[e]);
    } else {
      R q[4];
      gather_records(View<const Quaternion>(orientation), consecutive<R>(e), q);
      loaded.state = element_state<R>(kick.state, e);
      loaded.turn = {q[0], q[1], q[2], q[3]};
    }
    loaded.given.mass = load_now<R>(kick.mass, e);
    loaded.given.inertia = load_now<R>(kick.inertia, e);
    loaded.given.fixed = 0;
    for (Index k = 0; k < width_of<R>; ++k) loaded.given.fixed |= kick.fixed[e + k];
    loaded.reference = load_vectors_now<R>(used.reference, e);
    loaded.margin = load_now<R>(used.margin, e);
  }
  template <class R>
  BR_HD void load_late(Index e, Loaded<R>& loaded) const {
    loaded.given.force = load_vectors_now<R>(kick.force, e);
    loaded.given.torque = load_vectors_now<R>(kick.torque, e);
  }
  /// @returns whether element e or one of its neighbours in a pack has used its margin up
  template <class R>
  BR_HD bool update(Index e, const Loaded<R>& loaded) const {
    const ElementStateOf<R>& now = loaded.state;
    const Kick::GivenOf<R>& of = loaded.given;
    const Kick::ResultOf<R> r = kick(e, now, of);
    const R last = constant<R>(kick.last_dt), next = constant<R>(kick.next_dt);
    const Vec3Of<R> before = last * now.velocity, after = next * r.velocity;
    const Vec3Of<R> turned_by = next * r.spin;
    if (kick.damping > 0.0)
      store(damping_work, e,
            load<R>(damping_work, e) + (0.5 * dot(r.damped_force, before + after) +
                                        0.5 * dot(r.damped_torque, last * now.spin + turned_by)));
    if (of.fixed != 0) {
      R booked = 0.5 * dot(kick.reaction(e, now.velocity, r, of), before + after);
      if (!(kick.last_dt > 0.0)) booked = booked - kick.of_start(e, now.velocity, r, of);
      store(load_work, e, load<R>(load_work, e) + booked);
    }
    const Vec3Of<R> position = place_after(now, r);
    const R s[10] = {position.x,   position.y, position.z, r.velocity.x, r.velocity.y,
                     r.velocity.z, r.spin.x,   r.spin.y,   r.spin.z,     now.radius};
    store_records(state, e, s);
    const QuaternionOf<R> q = rotated(loaded.turn, turned_by);
    const R numbers[4] = {q.w, q.x, q.y, q.z};
    store_records(orientation, e, numbers);
    return used.too_far || any(used.beyond<R>(position, loaded.reference, loaded.margin));
  }
  /// Where an element goes.  [m]
  template <class R>
  BR_HD Vec3Of<R> place_after(const ElementStateOf<R>& now, const Kick::ResultOf<R>& r) const {
    return now.position + constant<R>(kick.next_dt) * r.velocity;
  }
  BR_WHOLE BR_HD bool operator()(Index e) const { return run_at<double>(*this, e); }
};

}  // namespace breccia::dem
