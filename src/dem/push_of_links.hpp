#pragma once
// The push in the step to come of links whose elements a servo leads.

#include "core/servo.hpp"
#include "dem/element_kernels.hpp"
#include "dem/links/all.hpp"

namespace breccia::dem {

BR_HD inline double part_along(int axis, const Vec3& v) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Elements that a servo leads along an axis.
struct LedElements {
  std::int16_t servo;
  int axis;
  View<const std::int16_t> motion;
  View<const LedBy> led;

  BR_HD bool operator()(Index e) const {
    return motion[e] >= 0 && led[motion[e]].servo[axis] == servo;
  }
};

/// Cohesive links and parallel bonds, looked at without a change of their state.
template <class Number>
BR_HD Vec3 force_now(const ConcreteLinkForces<Number>& of, Index i, const LinkEnd<double>& a,
                     const LinkEnd<double>& b) {
  LinkConstants<double> link{of.length[i], of.stiffness[i], of.area[i], 0.5 * (a.radius + b.radius),
                             a.radius + b.radius};
  if (of.law.rated())
    link.factor = of.law.template factor_of<double>(link, of.opening[i], of.rate[i]);
  return of.law.force_on_b(link, b.motion.position - a.motion.position, of.state_of(i));
}
template <class Number>
BR_HD Vec3 force_next(const ConcreteLinkForces<Number>& of, Index i, const LinkEnd<double>& a,
                      const LinkEnd<double>& b, double dt) {
  const LinkConstants<double> link{of.length[i], of.stiffness[i], of.area[i],
                                   0.5 * (a.radius + b.radius), a.radius + b.radius};
  LinkState<double> state = of.state_of(i);
  const PairMotion<double> motion =
      pair_motion<double>(a.motion, b.motion, a.radius - b.radius, dt);
  const LinkResponse<double> r = of.law.response(link, motion, state);
  return r.shear - r.normal * motion.normal;
}
BR_HD inline Vec3 force_now(const ParallelBondForces& of, Index i, const LinkEnd<double>& a,
                            const LinkEnd<double>& b) {
  const ParallelBondState state = of.state[i];
  const Vec3 way = b.motion.position - a.motion.position;
  const double distance = norm(way), stretch = distance - of.length[i];
  const bool acts = state.bond > 0.5 || (state.bond >= 0.0 && stretch < 0.0);
  return state.shear - ((acts ? of.stiffness[i] * stretch : 0.0) / distance) * way;
}
BR_HD inline Vec3 force_next(const ParallelBondForces& of, Index i, const LinkEnd<double>& a,
                             const LinkEnd<double>& b, double dt) {
  ParallelBondState state = of.state[i];
  const auto k =
      of.law.constants(of.length[i], of.stiffness[i], of.strength[i], a.radius, b.radius);
  const PairMotion<double> motion =
      pair_motion<double>(a.motion, b.motion, a.radius - b.radius, dt);
  const ParallelBondResponseOf<double> r = of.law.response(k, motion, state);
  return r.shear - r.normal * motion.normal;
}

/// Links with one end that the servo leads: by their law, softening and rupture included. With the
/// led end at the velocity v_0 that it has, and all else moved by the forces of the moment, they
/// will push with P_1 in the step to come instead of P_0 now, and with K dt more for each m/s more:
/// R' = R + (P_1 - P_0) + K (v - v_0) dt.
template <class Forces>
struct LinkPush {
  Forces links;
  Index first;      ///< of a law's links
  double dt;        ///< of the next step  [s]
  double velocity;  ///< v_0  [m/s]
  LedElements led;
  Kick kick;

  BR_HD ServoReading operator()(Index k) const {
    constexpr double share = 1e-6;  // of an element: how far it goes to feel the stiffness
    const Index i = first + k, a = links.a[i], b = links.b[i];
    ServoReading r;
    const bool by_a = led(a);
    if (by_a == led(b)) return r;
    LinkEnd<double> end_a = load_end<double>(kick.state, {a}),
                    end_b = load_end<double>(kick.state, {b});
    const double sign = by_a ? 1.0 : -1.0;
    const double now = sign * part_along(led.axis, force_now(links, i, end_a, end_b));
    move(a, end_a.motion);
    move(b, end_b.motion);
    const double next = sign * part_along(led.axis, force_next(links, i, end_a, end_b, dt));
    LinkEnd<double>& held = by_a ? end_a : end_b;
    const double way = share * held.radius;
    part_of(held.motion.position) += way;
    part_of(held.motion.velocity) += way / dt;
    const double farther = sign * part_along(led.axis, force_next(links, i, end_a, end_b, dt));
    const double stiffness = max(0.0, (farther - next) / way);
    r.stiffness.add(stiffness);
    r.flow.add(stiffness * velocity - (next - now) / dt);
    return r;
  }

 private:
  BR_HD void move(Index e, PairEnd<double>& end) const {
    const Kick::Result r = kick(e);
    end = {end.position + dt * r.velocity, r.velocity, r.spin};
  }
  BR_HD double& part_of(Vec3& v) const { return led.axis == 0 ? v.x : led.axis == 1 ? v.y : v.z; }
};

}  // namespace breccia::dem
