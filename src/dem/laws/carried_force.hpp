#pragma once
// Shear forces and moments that a link keeps: carried with the pair, and cut back to their limits.

#include "dem/laws/link_state.hpp"

namespace breccia::dem {

/// A shear force or moment, carried to where the pair is, and with this step's increment.
template <class R>
struct Carried {
  Vec3Of<R> before, trial;
};
/// A shear force or moment after its limit.
template <class R>
struct Cut {
  Vec3Of<R> kept;
  R spent;    ///< [J]
  R plastic;  ///< slip, or turn, beyond the elastic one  [m or rad]
};

/// In single precision all that changes in a step is added at one go, and rounded by chance.
template <class R>
BR_HD inline Carried<R> carried_shear(const LinkConstants<R>& link, const PairMotion<R>& motion,
                                      const Vec3Of<R>& kept, const R& kt) {
  if constexpr (is_single<R>) {
    const Vec3Of<R> turned = motion.change_with_pair(kept);
    const Vec3Of<R> change = turned - dot(kept + turned, motion.normal) * motion.normal;
    return {kept + change, sum_by(link.chance, 0, kept, change - kt * motion.slip)};
  } else {
    const Vec3Of<R> before = motion.tangential(motion.rotated_with_pair(kept));
    return {before, before - kt * motion.slip};
  }
}
template <class R>
BR_HD inline Carried<R> carried_moment(const LinkConstants<R>& link, const PairMotion<R>& motion,
                                       const Vec3Of<R>& kept, const R& kr) {
  if constexpr (is_single<R>) {
    const Vec3Of<R> change = motion.change_with_pair(kept);
    return {kept + change, sum_by(link.chance, 16, kept, change - kr * motion.turn)};
  } else {
    const Vec3Of<R> before = motion.rotated_with_pair(kept);
    return {before, before - kr * motion.turn};
  }
}

/// Cuts a trial force or moment back to its limit, to +0 where the link does not act.
template <class R, class Truth>
BR_HD inline Cut<R> cut(const Vec3Of<R>& before, const Vec3Of<R>& trial, const R& limit,
                        const Truth& acts, const R& stiffness) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  Cut<R> c{trial, zero, zero};
  const R squared = dot(trial, trial);
  const auto beyond = squared > limit * limit || !acts;
  if (!any(beyond)) return c;
  // A link without load before and after keeps nothing: no root, no division.
  const auto idle = !acts && before.x == 0.0 && before.y == 0.0 && before.z == 0.0;
  if (!any(beyond && !idle)) {
    c.kept = select(beyond, Vec3Of<R>{zero, zero, zero}, trial);
    return c;
  }
  const R size = sqrt(squared);
  const R scale = select(acts, limit / select(size > zero, size, one), zero);
  c.kept = select(beyond, select(acts, scale * trial, Vec3Of<R>{zero, zero, zero}), trial);
  const R per_stiffness = constant<R>(0.5) / select(stiffness > zero, stiffness, one);
  c.spent = per_stiffness * dot(before + c.kept, trial - c.kept);
  c.plastic = select(beyond, 2.0 * per_stiffness * (size - scale * size), zero);
  return c;
}

}  // namespace breccia::dem
