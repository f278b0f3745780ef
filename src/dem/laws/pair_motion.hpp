#pragma once
// How a pair of elements has moved in the last step, as every law of the DEM sees it.

#include "math/lanes.hpp"
#include "math/single.hpp"

namespace breccia::dem {

/// One end of a pair.
template <class R>
struct PairEnd {
  Vec3Of<R> position;  ///<  [m]
  Vec3Of<R> velocity;  ///< that moved it to its position  [m/s]
  Vec3Of<R> spin;      ///< likewise  [rad/s]
};

/// Both ends of a pair, as its motion depends on them.
template <class R>
struct PairEnds {
  Vec3Of<R> way;             ///< from a to b  [m]
  Vec3Of<R> parting;         ///< velocity of b less that of a  [m/s]
  Vec3Of<R> spin_a, spin_b;  ///<  [rad/s]

  BR_HD Vec3Of<R> both_spins() const { return spin_a + spin_b; }
  BR_HD Vec3Of<R> turning() const { return spin_b - spin_a; }
  /// Sum of the spins, each times its arm; their velocities of the contact point are across it.
  BR_HD Vec3Of<R> by_arms(const R& arm_a, const R& arm_b) const {
    return arm_b * spin_b + arm_a * spin_a;
  }
};
/// Both ends in single precision: differences are taken in double before they are rounded.
template <class V>
struct PairEnds<SingleOf<V>> {
  using R = SingleOf<V>;
  Vec3Of<R> way, parting;
  Vec3Of<R> spins, turns;  ///< spin of b with, and less, that of a  [rad/s]

  BR_HD Vec3Of<R> both_spins() const { return spins; }
  BR_HD Vec3Of<R> turning() const { return turns; }
  BR_HD Vec3Of<R> by_arms(const R& arm_a, const R& arm_b) const {
    return 0.5 * (arm_a + arm_b) * spins + 0.5 * (arm_b - arm_a) * turns;
  }
};
template <class R>
BR_HD PairEnds<R> ends_of(const PairEnd<R>& a, const PairEnd<R>& b) {
  return {b.position - a.position, b.velocity - a.velocity, a.spin, b.spin};
}

/// Kinematics of a pair a, b over the step that brought it here (docs/theory.md, pair kinematics).
///
/// The normal n points from a to b. The contact point divides the distance into the arms of a and
/// b, arm_a + arm_b = distance exactly, so that the pair's torques conserve angular momentum.
template <class R>
struct PairMotion {
  Vec3Of<R> normal;     ///< n  [-]
  R distance;           ///< D  [m]
  R extension;          ///< change of D in this step, to first order  [m]
  R arm_a, arm_b;       ///< from the centres to the contact point, along n  [m]
  Vec3Of<R> slip;       ///< of b against a at the contact point, across n, in this step  [m]
  Vec3Of<R> turn;       ///< rotation of b against a in this step  [rad]
  Vec3Of<R> half_turn;  ///< h = tan(angle / 2) axis: how the pair's frame turned in this step  [-]
  R turn_scale;         ///< 2 / (1 + h.h)  [-]
  R time;               ///< the step that brought the pair here  [s]

  /// A vector kept by the pair (shear force, moment), turned with the pair: Cayley's form of the
  /// rotation that brings the old normal to the new one and spins about it by the mean spin. It
  /// keeps the length.
  BR_HD Vec3Of<R> rotated_with_pair(const Vec3Of<R>& v) const { return v + change_with_pair(v); }
  /// The change of the vector by it.
  BR_HD Vec3Of<R> change_with_pair(const Vec3Of<R>& v) const {
    const Vec3Of<R> w = cross(half_turn, v);
    return turn_scale * (w + cross(half_turn, w));
  }
  /// Part of a vector across the normal.
  BR_HD Vec3Of<R> tangential(const Vec3Of<R>& v) const { return v - dot(v, normal) * normal; }
};

/// 2 / (1 + h.h) by its series: h is half the angle of one step, h^8 below rounding.
template <class R>
BR_HD R turn_scale(const Vec3Of<R>& half_turn) {
  const R h = dot(half_turn, half_turn);
  return 2.0 * (1.0 - h * (1.0 - h * (1.0 - h)));
}

/// @param excess  radius of a minus radius of b: puts the contact point into the middle of the gap
/// [m]
/// @param dt      the step that moved the ends to where they are; 0 at the start  [s]
///
/// The old normal follows from velocities: d_old = d - dt (v_b - v_a), so none is stored, and
/// tan(angle) axis = (d_old x n) / (d_old . n) = dt (n x dv) / (D - dt dv.n) holds exactly.
/// Rotations are Cayley's: a spin w turns by 2 atan(|w| dt / 2) in a step (math/vec.hpp, turned).
template <class R>
BR_HD PairMotion<R> pair_motion(const PairEnds<R>& ends, const R& excess, double dt) {
  PairMotion<R> m;
  const Vec3Of<R>& d = ends.way;
  m.distance = norm(d);
  const R inverse = 1.0 / m.distance;
  m.normal = inverse * d;
  m.arm_a = 0.5 * (m.distance + excess);
  m.arm_b = 0.5 * (m.distance - excess);

  const R step = constant<R>(dt);
  const Vec3Of<R>& dv = ends.parting;
  m.extension = step * dot(dv, m.normal);
  // 1 / (D - e D) with the stretch e of one step, by its series: e^4 is below rounding
  const R stretch = step * inverse * dot(dv, m.normal);
  const R tangent_scale = step * inverse * (1.0 + stretch * (1.0 + stretch * (1.0 + stretch)));
  const Vec3Of<R> tangent = tangent_scale * cross(m.normal, dv);  // tan(angle) axis
  const R half = constant<R>(0.5), quarter = constant<R>(0.25);
  const R square = dot(tangent, tangent);
  // tan(angle / 2) from tan(angle): t / (1 + sqrt(1 + t^2)) by its series
  const Vec3Of<R> swing =
      half * (1.0 - quarter * square * (1.0 - square * (half - 0.3125 * square))) * tangent;
  const Vec3Of<R> middle = m.normal + cross(m.normal, swing);  // along old + new normal
  const R spin =
      quarter * step * dot(m.normal, ends.both_spins());  // tan of half the mean spin's angle
  m.half_turn = swing + spin * middle;                    // the spin first, then the swing

  // Slip with the levers of the middle of the step: a rigid turn of the pair slips by exactly
  // nothing.
  const R bend = dot(swing, swing);
  const Vec3Of<R> lever = (1.0 - bend * (1.0 - bend)) * middle;  // (old + new normal) / 2
  const Vec3Of<R> sliding = dv - cross(ends.by_arms(m.arm_a, m.arm_b), lever);
  m.slip = step * m.tangential(sliding);
  m.turn = step * ends.turning();
  m.turn_scale = turn_scale(m.half_turn);
  m.time = step;
  return m;
}
template <class R>
BR_HD PairMotion<R> pair_motion(const PairEnd<R>& a, const PairEnd<R>& b, const R& excess,
                                double dt) {
  return pair_motion<R>(ends_of(a, b), excess, dt);
}

}  // namespace breccia::dem
