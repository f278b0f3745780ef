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

  /// A step of a facet between begin and end. What decays in it takes longest to wait for, so that
  /// packs may be taken side by side there (Two).
  template <class R>
  struct Step {
    Vec3Of<R> strain, growth;  ///< new; new less old  [-]
    Vec3Of<R> stress;          ///< old  [Pa]
    R largest_normal;          ///< new  [-]
    R largest_square;          ///< new  [-]
    R over{}, elastic{};       ///< open: 1 / e  [-], s without a bound  [Pa]
    R strength{};              ///< open: s_0  [Pa]
    R normal{};                ///< closed: s_N  [Pa]
    R exponent{};              ///< open: -H_t <e_max - s_0 / E_0> / s_0; closed: s_N / s_N0
    R half_tangent{};          ///< open: tan(omega / 2)
    R effective{}, largest{};  ///< open, if asked for by k_t: e, e_max  [-]
    R faster{};                ///< F, if strengths depend on rate
    bool softens = false;      ///< an open one is beyond s_0: the exponent lacks (2 omega / pi)^n_t
    bool slides = false;       ///< a closed one may slide beyond its cohesion

    BR_HD bool decays() const { return softens || slides; }
  };

  /// Brings a facet of an edge of reference length `length` to a strain.
  /// @param volumetric  e_V, a third of the volumetric strain of its tetrahedron, or a function
  ///                    that gives it and is called only where pores collapse  [-]
  /// @param dt          time in which it comes there; 0: slowly  [s]
  template <class R, class Volumetric>
  BR_HD LdpmSpentOf<R> update(const R& length, const Vec3Of<R>& strain,
                              const Volumetric& volumetric, LdpmFacetStateOf<R>& state,
                              double dt = 0.0) const {
    Step<R> step;
    begin(length, strain, volumetric, state, dt, step);
    return end(step, decay_of(step), state);
  }
  /// All of a step that does not need to know what decays.
  template <class R, class Volumetric>
  BR_HD void begin(const R& length, const Vec3Of<R>& strain, const Volumetric& volumetric,
                   const LdpmFacetStateOf<R>& old, double dt, Step<R>& step) const {
    const R square = strain.y * strain.y + strain.z * strain.z;  // e_T^2
    step.strain = strain;
    step.growth = strain - old.strain;
    step.stress = old.stress;
    step.largest_normal = max(old.largest_normal, strain.x);
    step.largest_square = max(old.largest_square, square);
    if (rate_factor > 0.0)
      step.faster = dt > 0.0 ? dynamic_factor(old.strain, strain, dt) : constant<R>(1.0);
    const auto open = strain.x > 0.0;
    if (any(open)) step.softens = opens(length, square, old, step);
    if (any(!open)) step.slides = closes(volumetric, step);
  }
  /// Factor of softening and friction in this step, 1 where neither acts.  [-]
  template <class R>
  BR_HD R decay_of(const Step<R>& step) const {
    if (!step.decays()) return constant<R>(1.0);
    return decay_of(step.softens, step.strain.x > 0.0, step.half_tangent, step.exponent);
  }
  /// exp(-H_0 <e_max - s_0 / E_0> / s_0) of open facets, exp(s_N / s_N0) of closed ones.
  /// @param softens  whether any of the former is beyond s_0
  template <class R, class Truth>
  BR_HD R decay_of(bool softens, const Truth& open, const R& half_tangent,
                   const R& exponent) const {
    if (!softens) return exponential(exponent);
    const R share = 1.2732395447351628 * arc_tangent(half_tangent);  // 2 omega / pi
    return exponential(select(open, exponent * power_of(share, softening_exponent), exponent));
  }
  /// The rest of a step.
  /// @param state  new
  template <class R>
  BR_HD LdpmSpentOf<R> end(const Step<R>& step, const R& decay, LdpmFacetStateOf<R>& state) const {
    const Vec3Of<R>& old = step.stress;
    const Vec3Of<R>& de = step.growth;
    state.strain = step.strain;
    state.largest_normal = step.largest_normal;
    state.largest_square = step.largest_square;
    const auto open = step.strain.x > 0.0;
    const auto closed = !open;
    if (any(open)) state.stress = opened(step, decay);
    if (any(closed)) state.stress = select(open, state.stress, pressed(step, decay));

    const R normal_work = 0.5 * (old.x + state.stress.x) * de.x;
    const R tangential_work =
        0.5 * ((old.y + state.stress.y) * de.y + (old.z + state.stress.z) * de.z);
    const R normal = normal_work - (stored_normal(state.stress.x) - stored_normal(old.x));
    const R sliding = tangential_work - (stored_tangential(state.stress) - stored_tangential(old));
    const R none = constant<R>(0.0);
    return {select(open, normal + sliding, none), select(open, none, normal),
            select(open, none, sliding)};
  }

  /// Stored energy over the volume A L.  [J/m3]
  template <class R>
  BR_HD R stored(const Vec3Of<R>& stress) const {
    return stored_normal(stress.x) + stored_tangential(stress);
  }

  /// The parts of the strains that are not elastic, over an edge: across the facet, 0 where pores
  /// have collapsed, and along it.  [m]
  BR_HD double opening(double length, const LdpmFacetState& s) const {
    return length * max(0.0, s.strain.x - s.stress.x / young);
  }
  BR_HD double slip(double length, const LdpmFacetState& s) const {
    const double over = 1.0 / (shear_ratio * young);
    const double m = s.strain.y - over * s.stress.y, l = s.strain.z - over * s.stress.z;
    return length * sqrt(m * m + l * l);
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

  /// An open facet. Sine and cosine of omega are e_N / e and sqrt(alpha) e_T / e.
  /// @returns whether any may exceed s_b and is beyond s_0
  template <class R>
  BR_HD bool opens(const R& length, const R& square, const LdpmFacetStateOf<R>& old,
                   Step<R>& step) const {
    const R one = constant<R>(1.0), none = constant<R>(0.0);
    const auto open = step.strain.x > 0.0;
    // Its square is a number still; in closed lanes too, or else the processor stops at it.
    const R normal = max(step.strain.x, constant<R>(1e-150));
    const R along = normal * normal, across = shear_ratio * square;
    const R e = select(open, sqrt(along + across), one), over_e = 1.0 / e;
    const double softer = 4.0 * shear_ratio / (strength_ratio * strength_ratio);
    const R divisor = normal + sqrt(along + softer * across);
    R s0 = 2.0 * tensile_strength * e / divisor;
    if (rate_factor > 0.0) s0 = step.faster * s0;
    const R largest = sqrt(effective_square(step.largest_normal, step.largest_square));
    const R beyond = largest - (1.0 / young) * s0;
    const R old_square = old.strain.y * old.strain.y + old.strain.z * old.strain.z;
    const R old_e = sqrt(effective_square(old.strain.x, old_square));
    const R old_s =
        sqrt(old.stress.x * old.stress.x +
             (1.0 / shear_ratio) * (old.stress.y * old.stress.y + old.stress.z * old.stress.z));
    const R elastic = max(none, old_s + young * (e - old_e));
    step.over = over_e;
    step.elastic = elastic;
    step.strength = s0;
    if (unloading > 0.0) step.effective = e, step.largest = largest;
    auto softened = open && beyond > 0.0;
    if (!any(softened)) return false;
    R fall = (young / tensile_strength) * (beyond * divisor * over_e) *
             (length / (tensile_length - length));
    if (rate_factor > 0.0) fall = fall / step.faster;
    // exp(-x) >= 1 - x: a facet that has unloaded below that needs no more.
    if (!(unloading > 0.0)) softened = softened && elastic > s0 * (0.999999 - fall);
    if (!any(softened)) return false;
    step.half_tangent = min(normal / (e + sqrt(across)), one);
    step.exponent = select(softened, -fall, none);
    return true;
  }
  /// Stress of an open facet.
  template <class R>
  BR_HD Vec3Of<R> opened(const Step<R>& step, const R& decay) const {
    R bound = step.strength;
    if (step.softens) bound = bound * decay;
    if (unloading > 0.0)
      bound = select(step.effective < unloading * (step.largest - (1.0 / young) * bound),
                     constant<R>(0.0), bound);
    const R over = min(bound, step.elastic) * step.over, tangential = shear_ratio * over;
    return {over * step.strain.x, tangential * step.strain.y, tangential * step.strain.z};
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

  /// A closed facet. @returns whether any may slide beyond its cohesion
  template <class R, class Volumetric>
  BR_HD bool closes(const Volumetric& volumetric, Step<R>& step) const {
    const auto closed = !(step.strain.x > 0.0);
    R normal = min(constant<R>(0.0), trial(step.stress.x, step.growth.x));
    // The bound is nowhere below s_c0.
    if (any(closed && normal < -yield)) {
      if constexpr (std::is_invocable_v<const Volumetric&>)
        normal = max(-bound<R>(volumetric(), step.strain.x, closed), normal);
      else
        normal = max(-bound<R>(volumetric, step.strain.x, closed), normal);
    }
    step.normal = normal;
    const R square = square_of_shear(step);
    const double cohesion = strength_ratio * tensile_strength;
    const auto beyond = closed && square > cohesion * cohesion;
    if (!any(beyond)) return false;
    const R exponent = normal / friction_stress;
    step.exponent = step.softens ? select(closed, exponent, step.exponent) : exponent;
    return true;
  }
  /// s_M and s_L of a closed facet without a bound.
  template <class R>
  BR_HD Vec3Of<R> shear_of(const Step<R>& step) const {
    const double shear = shear_ratio * young;
    return {step.normal, step.stress.y + shear * step.growth.y,
            step.stress.z + shear * step.growth.z};
  }
  template <class R>
  BR_HD R square_of_shear(const Step<R>& step) const {
    const Vec3Of<R> s = shear_of(step);
    return s.y * s.y + s.z * s.z;
  }
  /// Stress of a closed facet.
  template <class R>
  BR_HD Vec3Of<R> pressed(const Step<R>& step, const R& decay) const {
    const Vec3Of<R> s = shear_of(step);
    if (!step.slides) return s;
    const R square = s.y * s.y + s.z * s.z;
    const double cohesion = strength_ratio * tensile_strength;
    R limit = cohesion - final_friction * step.normal +
              (friction - final_friction) * friction_stress * (1.0 - decay);
    if (rate_factor > 0.0) limit = limit + (step.faster - 1.0) * cohesion;
    const R size = sqrt(square);
    const R scale = select(square > cohesion * cohesion && size > limit,
                           limit / max(size, constant<R>(1e-300)), constant<R>(1.0));
    return {s.x, scale * s.y, scale * s.z};
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
