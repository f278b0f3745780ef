#pragma once
// State, constants and response of a cohesive link.

#include "dem/laws/pair_motion.hpp"
#include "math/rounding.hpp"

namespace breccia::dem {

/// Forces of the damping branch of a link.
template <class R>
struct BranchForce {
  R normal;         ///< tension positive  [N]
  Vec3Of<R> shear;  ///< on b, world frame  [N]
};

/// State of a link, kept from step to step.
template <class R>
struct LinkState {
  R opening;         ///< largest opening so far, >= 0; link_broken or link_released afterwards  [m]
  Vec3Of<R> shear;   ///< F_s on b, world frame  [N]
  Vec3Of<R> moment;  ///< M on b, world frame  [N m]
  R rate = {};  ///< smoothed strain rate [1/s]; minus DIF [-] from the peak on; rated laws only
  BranchForce<R> branch = {};  ///< damped laws only
};
inline constexpr double link_broken =
    -1.0;  ///< LinkState::opening of a link that answers as a contact
inline constexpr double link_released = -2.0;  ///< ... of a link whose ends have parted for good

/// Response of the law in one step.
template <class R>
struct LinkResponse {
  R normal;          ///< N, tension positive  [N]
  Vec3Of<R> shear;   ///< F_s on b  [N]
  Vec3Of<R> moment;  ///< M on b  [N m]
  R active;          ///< 1 where the link resists, 0 where it does not: share of its stiffness  [-]
  R shortened;       ///< what compaction took off D_eq in this step  [m]
  R slid;            ///< energy spent on sliding in this step  [J]
  R yielded;         ///< energy spent on plastic moments and compaction in this step  [J]
  R broke;           ///< energy spent on rupture in this step, and what wear corrects of it  [J]
  R damped;          ///< energy that the damping branch took in this step  [J]
};

/// Constants of one link.
template <class R>
struct LinkConstants {
  R length;                     ///< D_eq, at which it is free of force  [m]
  R stiffness;                  ///< K_n  [N/m]
  R area;                       ///< S, pi min(R_a, R_b)^2 times the share of fabric  [m2]
  R radius;                     ///< r, mean of the two  [m]
  R touching;                   ///< R_a + R_b  [m]
  R factor = constant<R>(1.0);  ///< DIF: dynamic over static tensile strength  [-]
  R stretch = {};         ///< u = D - D_eq; in single precision only, which cannot subtract  [m]
  BitsOf<R> chance = {};  ///< in single precision only: rounds what grows by small steps
};
/// u = D - D_eq  [m]
template <class R>
BR_HD R stretch_of(const LinkConstants<R>& link, const R& distance) {
  if constexpr (is_single<R>)
    return link.stretch;
  else
    return distance - link.length;
}

}  // namespace breccia::dem
