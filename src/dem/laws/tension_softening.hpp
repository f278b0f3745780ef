#pragma once
// The falling branch in tension that concrete links and the steel-concrete interface share.

#include "math/single.hpp"

namespace breccia::dem {

/// Where a falling branch of two lines bends.
struct SofteningKnee {
  double steep = 0.0;  ///< (1 - s) / x, slope before it over that of one line; 0: one line  [-]
  double flat = 0.0;   ///< s / (1 - x), slope beyond it, likewise  [-]
  double area = 1.0;   ///< s + x, area below the falling branch over that of one line  [-]

  BR_HD bool bends() const { return steep > 0.0; }
};

/// Linear up to the strength, then linear softening; unloading along the secant (u > 0: opened).
///
///   F = K u                        u <= u_1 = F_t / K
///   F = F_t - (K / zeta)(u - u_1)  u_1 < u < u_2 = u_1 (1 + zeta), then rupture
///
/// or with u_2 given instead of zeta. With a knee the falling branch is the larger of two lines, a
/// steep one and a flat one, which meet at s F_t and u_1 + x (u_2 - u_1), s + x < 1:
///
///   F = F_t - (K / zeta)(u - u_1) (1 - s) / x,     F = (K / zeta)(u_2 - u) s / (1 - x)
///
/// Source: docs/theory.md, cohesive links; envelope of Durand 2012's reference law (Rousseau 2008);
/// two lines: Petersson 1981.
template <class R>
struct TensionSoftening {
  R stiffness;              ///< K  [N/m]
  R strength;               ///< F_t  [N]
  ConstantOf<R> softening;  ///< zeta >= 0, elastic over softening stiffness; 0 is brittle  [-]
  bool ends_given = false;  ///< whether u_2 is given, which rules instead of zeta
  R last = {};              ///< u_2 > u_1, if given  [m]
  SofteningKnee knee = {};

  BR_HD R onset() const { return strength / stiffness; }
  BR_HD R rupture() const { return ends_given ? last : onset() * (ConstantOf<R>(1) + softening); }
  /// K u_2  [N]
  BR_HD R elastic_at_rupture() const {
    return ends_given ? last * stiffness : strength * (ConstantOf<R>(1) + softening);
  }

  /// Whether an opening is surely below u_1, without a division: nothing is damaged or spent.
  BR_HD auto whole(const R& opening) const {
    return stiffness * opening < (1.0 - 1e-12) * strength;
  }
  /// 1 - secant stiffness / K after a largest opening.  [-]
  BR_HD R damage(const R& opening) const {
    const R u1 = onset();
    R envelope =
        u1 - (opening - u1) * (knee.bends() ? knee.steep * inverse() : inverse());  // over K
    if (knee.bends()) envelope = max(envelope, (rupture() - opening) * (knee.flat * inverse()));
    const R lost = min(constant<R>(1.0), 1.0 - envelope / opening);
    return select(opening > u1, lost, constant<R>(0.0));
  }
  /// Energy spent up to a largest opening: the area under the envelope less what the secant stores.
  /// With b = u - u_1 it is K b u_1 (1 + 1/zeta) / 2, at most that of a whole rupture.  [J]
  BR_HD R spent(const R& opening) const {
    const R beyond = max(opening - onset(), constant<R>(0.0));
    if (!knee.bends()) return min(0.5 * strength * beyond * (1.0 + inverse()), toughness());
    // Beyond the knee: all but the triangle below u_2 that the secant and the flat line leave.
    const R steep = 0.5 * strength * beyond * (1.0 + knee.steep * inverse());
    const R left = max(rupture() - opening, constant<R>(0.0)) * (knee.flat * inverse());
    return min(steep, toughness() - 0.5 * stiffness * rupture() * left);
  }
  /// Energy of a whole rupture, F_t u_2 / 2; with a knee F_t (u_1 + (s + x)(u_2 - u_1)) / 2.  [J]
  BR_HD R toughness() const {
    if (!knee.bends()) return 0.5 * strength * rupture();
    return 0.5 * strength * (onset() + knee.area * (rupture() - onset()));
  }

 private:
  /// 1 / zeta
  BR_HD R inverse() const {
    if (ends_given) return strength / (last * stiffness - strength);
    return constant<R>(softening > ConstantOf<R>(1e-12) ? ConstantOf<R>(1) / softening
                                                        : ConstantOf<R>(1e12));
  }
};

}  // namespace breccia::dem
