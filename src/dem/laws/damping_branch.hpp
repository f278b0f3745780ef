#pragma once
// Damping of links: a spring and a dashpot in line, beside the springs of a link.

#include "dem/laws/concrete_parts.hpp"
#include "dem/laws/link_state.hpp"

namespace breccia::dem {

/// A Maxwell branch of springs m K_n and m K_t, each in line with a dashpot, that relaxes within
/// tau (docs/theory.md, damped links):
///
///   V' - V = m K du - (dt / tau) (V + V') / 2
///
/// Slow motion meets none of it; at the angular frequency w it takes pi m K w tau / (1 + w^2 tau^2)
/// a cycle of amplitude 1, and a stable step is shorter by sqrt(1 + m). tau goes with the length of
/// the link, so that waves of some elements' length are damped whatever their size.
struct DampingBranch {
  double share;  ///< m, 0: none  [-]
  double speed;  ///< D / tau  [m/s]

  BR_HD bool acts() const { return is_given(share); }
  /// The forces after a step, as if nothing bounded them.
  template <class R>
  BR_HD BranchForce<R> moved(const LinkConstants<R>& link, const R& kt, const PairMotion<R>& motion,
                             const BranchForce<R>& before) const {
    const R a = 0.5 * speed * motion.time / link.length;  // dt / 2 tau
    const R over = 1.0 / (1.0 + a), keep = over * (1.0 - a), stretched = share * over;
    return {keep * before.normal + stretched * link.stiffness * motion.extension,
            keep * motion.tangential(before.shear) - (stretched * kt) * motion.slip};
  }
  /// Energy of its springs.  [J]
  template <class R>
  BR_HD R stored(const LinkConstants<R>& link, const R& kt, const BranchForce<R>& force) const {
    const R along = force.normal * force.normal / link.stiffness;
    const auto slides = kt > 0.0;
    const R across = dot(force.shear, force.shear) / select(slides, kt, constant<R>(1.0));
    return 0.5 / share * (along + across);
  }
  /// Energy that its dashpots took, and a branch that let go lost, in a step.  [J]
  template <class R>
  BR_HD R taken(const LinkConstants<R>& link, const R& kt, const PairMotion<R>& motion,
                const BranchForce<R>& before, const BranchForce<R>& after) const {
    const R work = 0.5 * ((before.normal + after.normal) * motion.extension -
                          dot(motion.tangential(before.shear) + after.shear, motion.slip));
    return work + stored(link, kt, before) - stored(link, kt, after);
  }
};

}  // namespace breccia::dem
