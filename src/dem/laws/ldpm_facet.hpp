#pragma once
// The facet of the lattice discrete particle model of concrete (LDPM).

#include <type_traits>

#include "math/elementary.hpp"
#include "math/vec.hpp"

namespace breccia::dem {

/// State of a facet from step to step.
template <class R>
struct LdpmFacetStateOf {
  Vec3Of<R> strain;  ///< e_N, e_M, e_L in the frame of the edge  [-]
  Vec3Of<R> stress;  ///< s_N, s_M, s_L likewise  [Pa]
  R largest_normal;  ///< largest e_N so far, at least 0  [-]
  R largest_square;  ///< largest e_T^2 so far  [-]
};
using LdpmFacetState = LdpmFacetStateOf<double>;

/// Energies that a facet has spent in one step, over its volume A L.  [J/m3]
template <class R>
struct LdpmSpentOf {
  R fracture;  ///< opened
  R plastic;   ///< closed, by its normal strain: pore collapse and compaction
  R friction;  ///< closed, by its tangential strain
};

/// Constitutive law of a facet between two particles: tension and its strains are positive.
///
///   e_T = sqrt(e_M^2 + e_L^2),  E_T = alpha E_0
///   open, e_N > 0: fracture and cohesion along the effective strain
///     e   = sqrt(e_N^2 + alpha e_T^2),  tan omega = e_N / (sqrt(alpha) e_T)
///     s_0 = 2 s_t / (sin omega + sqrt(sin^2 omega + 4 alpha cos^2 omega / r_st^2))
///     s_b = s_0 exp(-H_0 <e_max - s_0 / E_0> / s_0),  H_0 = H_t (2 omega / pi)^n_t
///     s   = min(s_b, <s_old + E_0 (e - e_old)>);  s_N = s e_N / e,  s_T = alpha s e_T / e
///   closed: pore collapse and compaction, bounded by the volumetric strain e_V
///     s_N = max(-bound, min(0, s_N_old + E_Nc de_N)),  E_Nc = E_d beyond -s_c0, else E_0
///     bound = s_c0 + <x - e_c0> H_c, x = -e_V;  beyond e_c1 = k_c0 e_c0 exponential, same slope
///     H_c = (H_c0 - H_c1) / (1 + k_c2 <r_DV - k_c1>) + H_c1,  r_DV = |e_N - e_V| / (e_v0 + <-e_V>)
///   and friction
///     |s_T| <= s_s + (mu_0 - mu_inf) s_N0 (1 - exp(s_N / s_N0)) - mu_inf s_N
///
///   rate, if asked for: s_0 and s_s are F = 1 + c_1 asinh(e' / c_0) times themselves, e' = <de> /
///   dt of the step
///
/// H_t = 2 E_0 / (l_t / L - 1) makes the energy of a whole rupture in tension s_t^2 l_t / (2 E_0)
/// for edges of any length L < l_t. Source: Cusatis, Pelessone, Mencarelli 2011, Cem. Concr.
/// Compos. 33 (9), part I; docs/theory-ldpm.md. The quotient of s_0 is the published one, regular
/// at omega = 0.
struct LdpmFacet {
  double young;                  ///< E_0, normal modulus  [Pa]
  double shear_ratio;            ///< alpha  [-]
  double tensile_strength;       ///< s_t  [Pa]
  double tensile_length;         ///< l_t = 2 E_0 G_t / s_t^2  [m]
  double strength_ratio;         ///< r_st = s_s / s_t  [-]
  double softening_exponent;     ///< n_t  [-]
  double unloading;              ///< k_t: reopening starts at k_t (e_max - s_b / E_0)  [-]
  double yield;                  ///< s_c0, start of pore collapse  [Pa]
  double hardening;              ///< H_c0  [Pa]
  double final_hardening;        ///< H_c1  [Pa]
  double compaction_strain;      ///< k_c0: start of compaction over s_c0 / E_0  [-]
  double deviatoric_start;       ///< k_c1  [-]
  double deviatoric_slope;       ///< k_c2  [-]
  double friction;               ///< mu_0  [-]
  double final_friction;         ///< mu_inf  [-]
  double friction_stress;        ///< s_N0  [Pa]
  double densified;              ///< E_d, unloading modulus beyond s_c0  [Pa]
  double rate_factor = 0.0;      ///< c_1; 0: strengths do not depend on rate  [-]
  double rate_reference = 1e-5;  ///< c_0  [1/s]

  static constexpr double deviatoric_strain = 0.1;  ///< k_c3 = e_v0 E_0 / s_c0  [-]

  /// Brings a facet of an edge of reference length `length` to a strain.
  /// @param volumetric  e_V, a third of the volumetric strain of its tetrahedron, or a function
  ///                    that gives it and is called only where pores collapse  [-]
  /// @param dt          time in which it comes there; 0: slowly  [s]
  template <class R, class Volumetric>
  BR_HD LdpmSpentOf<R> update(const R& length, const Vec3Of<R>& strain,
                              const Volumetric& volumetric, LdpmFacetStateOf<R>& state,
                              double dt = 0.0) const {
    const LdpmFacetStateOf<R> old = state;
    const R square = strain.y * strain.y + strain.z * strain.z;  // e_T^2
    state.strain = strain;
    state.largest_normal = max(old.largest_normal, strain.x);
    state.largest_square = max(old.largest_square, square);
    const auto open = strain.x > 0.0;
    const auto closed = !open;
    R faster = constant<R>(1.0);  // F
    if (rate_factor > 0.0 && dt > 0.0) faster = dynamic_factor(old.strain, strain, dt);
    if (any(open)) state.stress = opened(length, square, old, state, faster);
    if (any(closed))
      state.stress = select(open, state.stress, pressed(volumetric, old, strain, faster));

    const Vec3Of<R> de = strain - old.strain;
    const R normal_work = 0.5 * (old.stress.x + state.stress.x) * de.x;
    const R tangential_work =
        0.5 * ((old.stress.y + state.stress.y) * de.y + (old.stress.z + state.stress.z) * de.z);
    const R normal = normal_work - (stored_normal(state.stress.x) - stored_normal(old.stress.x));
    const R sliding =
        tangential_work - (stored_tangential(state.stress) - stored_tangential(old.stress));
    const R none = constant<R>(0.0);
    return {select(open, normal + sliding, none), select(open, none, normal),
            select(open, none, sliding)};
  }

  /// Stored energy over the volume A L.  [J/m3]
  template <class R>
  BR_HD R stored(const Vec3Of<R>& stress) const {
    return stored_normal(stress.x) + stored_tangential(stress);
  }

  /// Whether the largest strains, less s_t / E_0, have opened an edge by `times` s_t l_t / E_0.
  template <class R>
  BR_HD auto has_opened_by(double times, const R& length, const LdpmFacetStateOf<R>& s) const {
    const R limit = (tensile_strength / young) * (length + times * tensile_length);
    return length * length * effective_square(s.largest_normal, s.largest_square) > limit * limit;
  }
  /// Whether a facet has opened, or slid, so far that it bears 5 % of s_t in tension: by three
  /// times G_t / s_t.
  template <class R>
  BR_HD auto has_cracked(const R& length, const LdpmFacetStateOf<R>& s) const {
    return has_opened_by(1.5, length, s);
  }
  /// Whether a facet has lost 5 % of s_t.
  BR_HD bool has_softened(double length, const LdpmFacetState& s) const {
    return has_opened_by(0.025, length, s);
  }

 private:
  template <class R>
  BR_HD R stored_normal(const R& stress) const {
    const R beyond = min(stress + yield, constant<R>(0.0));  // below -s_c0
    const R within = stress - beyond;
    // u = s_c0^2 / (2 E_0) + (s^2 - s_c0^2) / (2 E_d) below
    return (0.5 / young) * (within * within) + (0.5 / densified) * (beyond * (stress - yield));
  }
  template <class R>
  BR_HD R stored_tangential(const Vec3Of<R>& stress) const {
    return (0.5 / (shear_ratio * young)) * (stress.y * stress.y + stress.z * stress.z);
  }

  /// Stress of an open facet. Sine and cosine of omega are e_N / e and sqrt(alpha) e_T / e.
  template <class R>
  BR_HD Vec3Of<R> opened(const R& length, const R& square, const LdpmFacetStateOf<R>& old,
                         const LdpmFacetStateOf<R>& now, const R& faster) const {
    const R one = constant<R>(1.0), none = constant<R>(0.0);
    const auto open = now.strain.x > 0.0;
    const R normal = max(now.strain.x, constant<R>(1e-300));
    const R along = normal * normal, across = shear_ratio * square;
    const R e = select(open, sqrt(along + across), one), over_e = 1.0 / e;
    const double softer = 4.0 * shear_ratio / (strength_ratio * strength_ratio);
    const R divisor = normal + sqrt(along + softer * across);
    R s0 = 2.0 * tensile_strength * e / divisor;
    if (rate_factor > 0.0) s0 = faster * s0;
    const R largest = sqrt(effective_square(now.largest_normal, now.largest_square));
    const R beyond = largest - (1.0 / young) * s0;
    const R old_square = old.strain.y * old.strain.y + old.strain.z * old.strain.z;
    const R old_e = sqrt(effective_square(old.strain.x, old_square));
    const R old_s =
        sqrt(old.stress.x * old.stress.x +
             (1.0 / shear_ratio) * (old.stress.y * old.stress.y + old.stress.z * old.stress.z));
    const R elastic = max(none, old_s + young * (e - old_e));
    R bound = s0;
    auto softened = open && beyond > 0.0;
    if (any(softened)) {
      // H_t beyond / s_0. exp(-x) >= 1 - x: a facet that has unloaded below that needs no more.
      R fall = (young / tensile_strength) * (beyond * divisor * over_e) *
               (length / (tensile_length - length));
      if (rate_factor > 0.0) fall = fall / faster;
      if (!(unloading > 0.0)) softened = softened && elastic > s0 * (0.999999 - fall);
      if (any(softened)) {
        const R half_tangent = min(normal / (e + sqrt(across)), one);    // tan(omega / 2)
        const R share = 1.2732395447351628 * arc_tangent(half_tangent);  // 2 omega / pi
        const R softening = exponential<R>(-fall * power_of(share, softening_exponent));
        bound = select(softened, s0 * softening, s0);
      }
    }
    if (unloading > 0.0)
      bound = select(e < unloading * (largest - (1.0 / young) * bound), none, bound);
    const R s = min(bound, elastic);
    const R over = s * over_e, tangential = shear_ratio * over;
    return {over * now.strain.x, tangential * now.strain.y, tangential * now.strain.z};
  }
  /// e_N^2 + alpha e_T^2
  template <class R>
  BR_HD R effective_square(const R& normal, const R& tangential_square) const {
    return normal * normal + shear_ratio * tangential_square;
  }

  /// Dynamic over static strength, by the rate of the effective strain.  [-]
  template <class R>
  BR_HD R dynamic_factor(const Vec3Of<R>& old, const Vec3Of<R>& now, double dt) const {
    const auto effective = [&](const Vec3Of<R>& e) {
      return sqrt(effective_square(e.x, e.y * e.y + e.z * e.z));
    };
    const R gained = max(effective(now) - effective(old), constant<R>(0.0));
    const R y = min((1.0 / (dt * rate_reference)) * gained, constant<R>(1e100));
    return 1.0 + rate_factor * logarithm<R>(y + sqrt(y * y + 1.0));
  }

  /// Stress of a closed facet.
  template <class R, class Volumetric>
  BR_HD Vec3Of<R> pressed(const Volumetric& volumetric, const LdpmFacetStateOf<R>& old,
                          const Vec3Of<R>& strain, const R& faster) const {
    const R none = constant<R>(0.0);
    const auto closed = !(strain.x > 0.0);
    const R de_m = strain.y - old.strain.y, de_l = strain.z - old.strain.z;
    R normal = min(none, trial(old.stress.x, strain.x - old.strain.x));
    // The bound is nowhere below s_c0.
    if (any(closed && normal < -yield)) {
      if constexpr (std::is_invocable_v<const Volumetric&>)
        normal = max(-bound<R>(volumetric(), strain.x, closed), normal);
      else
        normal = max(-bound<R>(volumetric, strain.x, closed), normal);
    }

    const double shear = shear_ratio * young;
    const R m = old.stress.y + shear * de_m, l = old.stress.z + shear * de_l;
    const R square = m * m + l * l;
    const double cohesion = strength_ratio * tensile_strength;
    const auto beyond = closed && square > cohesion * cohesion;
    if (!any(beyond)) return {normal, m, l};
    R limit = cohesion - final_friction * normal +
              (friction - final_friction) * friction_stress *
                  (1.0 - exponential<R>(normal / friction_stress));
    if (rate_factor > 0.0) limit = limit + (faster - 1.0) * cohesion;
    const R size = sqrt(square);
    const R scale =
        select(beyond && size > limit, limit / max(size, constant<R>(1e-300)), constant<R>(1.0));
    return {normal, scale * m, scale * l};
  }
  /// s_N + E_Nc de: a step that crosses -s_c0 changes its modulus there.
  template <class R>
  BR_HD R trial(const R& stress, const R& de) const {
    if (!(densified > young) && !(densified < young)) return stress + young * de;
    const R beyond = min(stress + yield, constant<R>(0.0));
    // elastic strain from the kink at -s_c0, where both branches are zero
    const R from = beyond / densified + (stress + yield - beyond) / young;
    const R to = from + de;
    return select(to < 0.0, densified * to, young * to) - yield;
  }
  /// Largest compressive normal stress.
  template <class R, class Truth>
  BR_HD R bound(const R& volumetric, const R& strain, const Truth& closed) const {
    const R none = constant<R>(0.0);
    const double e_c0 = yield / young, e_c1 = compaction_strain * e_c0;
    const R x = -volumetric;
    // r_DV = deviator / scale
    const R deviator = abs(strain - volumetric);
    const R scale = deviatoric_strain * e_c0 + max(x, none);
    const R excess = max(deviator - deviatoric_start * scale, none);
    const R slope = (hardening - final_hardening) * scale / (scale + deviatoric_slope * excess) +
                    final_hardening;
    const R line = yield + max(x - e_c0, none) * slope;
    const auto compacted = closed && x > e_c1;
    if (!any(compacted)) return line;
    const R start = yield + (e_c1 - e_c0) * slope;  // s_c1
    return select(compacted, start * exponential<R>((x - e_c1) * slope / start), line);
  }
};

}  // namespace breccia::dem
