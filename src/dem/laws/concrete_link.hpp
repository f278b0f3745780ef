#pragma once
// The cohesive link of concrete: modified Mohr-Coulomb with softening and moment transfer.

#include "dem/laws/carried_force.hpp"
#include "dem/laws/concrete_parts.hpp"
#include "dem/laws/damping_branch.hpp"
#include "dem/laws/link_state.hpp"
#include "dem/laws/rate_curve.hpp"
#include "dem/laws/tension_softening.hpp"

namespace breccia::dem {

/// Cohesive link and, after rupture, the contact that is left of it (docs/theory.md, cohesive
/// links).
///
///   tension      N = K_n u                     up to the opening u_1 = S T / K_n
///                N = S T - (K_n / zeta)(u-u_1) up to u_2 = u_1 (1 + zeta), then rupture; u_2 may
///                be given instead of zeta
///                unloading along the secant to the largest opening kappa
///   compression  N = K_n u >= -S (Y + K p H/(1 - H)), p = (D_0 - D_eq) / D_0; beyond it D_eq
///                yields; Y = Y_c, H = H_c, of broken links that do not touch Y_b, H_b;
///                beyond p = p_c pores are closed, N = K_n u
///   shear        F_s += -K_t du_s, cut at S C (1 - damage) + min(-N tan phi, S s_F), or with
///                friction that fades, f = -N tan phi > 0: S C (1 - damage) + f S s_F / (f + S s_F)
///                or, intact, with that line L as the asymptote of a hyperbola through (T, 0):
///                sqrt(L^2 - V^2), V = (1 - damage) S (C - T tan phi), nothing where L < V
///   moment       M += -K_r dtheta, cut at eta r min(|N| in compression + S T (1 - damage), S s_M)
///   wear         plastic slip ds and turn dtheta_p: kappa += w_s |ds| + w_m r |dtheta_p|
///   rate         T grows to T DIF of the link's own strain rate, smoothed over some crossings of
///                waves and held from the peak on; u_2 stays
///   after rupture compression against D_eq, friction mu_b, no cohesion; parted for good beyond
///                1.5 times the larger of D_eq and R_a + R_b
///
/// Tension and opening are positive. Shear force and moment act on b; a gets the opposite.
/// Source: Durand 2012, section 2; law of the Rousseau 2008 family, completed in docs/theory.md.
/// @tparam N  of its constants: double, float for links in single precision
template <class N>
struct ConcreteLinkOf {
  N tensile_strength;      ///< T  [Pa]
  N cohesion;              ///< C  [Pa]
  N softening;             ///< zeta >= 0  [-]
  N rupture_opening;       ///< u_2, which rules instead of zeta; 0: zeta rules  [m]
  N friction;              ///< tan phi_i of the intact link  [-]
  N broken_friction;       ///< mu_b  [-]
  N friction_cap;          ///< s_F, 0: none  [Pa]
  N friction_fades;        ///< 1: friction nears s_F slowly; 0: it grows until it is s_F
  N hyperbolic;            ///< 1: shear strength ends at T by a hyperbola; 0: at a corner
  N shear_ratio;           ///< K_t / K_n  [-]
  N rolling_ratio;         ///< beta_r = K_r / (K_t r^2)  [-]
  N rolling_limit;         ///< eta of the intact link  [-]
  N broken_rolling_limit;  ///< eta_b  [-]
  N rolling_cap;           ///< s_M, 0: none  [Pa]
  N brittle_shear;         ///< 1: a link breaks at its shear strength; 0: it slides on  [-]
  N slip_wear;             ///< w_s  [-]
  N turn_wear;             ///< w_m  [-]
  N modulus;               ///< K = K_n D_0 / S  [Pa]
  N compaction_strength;   ///< Y_c, 0: none  [Pa]
  N compaction_slope;      ///< H_c < 1, tangent beyond it over K_n  [-]
  N crushing_strength;     ///< Y_b, 0: none  [Pa]
  N crushing_slope;        ///< H_b < 1  [-]
  N closing_strain;        ///< p_c at which D_eq shortens no further, 0: none  [-]
  RateCurve rate;          ///< of T
  SofteningKnee knee;      ///< of the falling branch in tension
  DampingBranch damping;

  /// With constants rounded to another type.
  template <class Other>
  ConcreteLinkOf<Other> as() const {
    const auto to = [](N number) { return static_cast<Other>(number); };
    return {to(tensile_strength),
            to(cohesion),
            to(softening),
            to(rupture_opening),
            to(friction),
            to(broken_friction),
            to(friction_cap),
            to(friction_fades),
            to(hyperbolic),
            to(shear_ratio),
            to(rolling_ratio),
            to(rolling_limit),
            to(broken_rolling_limit),
            to(rolling_cap),
            to(brittle_shear),
            to(slip_wear),
            to(turn_wear),
            to(modulus),
            to(compaction_strength),
            to(compaction_slope),
            to(crushing_strength),
            to(crushing_slope),
            to(closing_strain),
            rate,
            knee,
            damping};
  }

  /// One step of a link (R = double) or of a pack of links.
  /// @tparam parts  those that this law may have: parts() and any more
  template <ConcreteParts parts = concrete_all, class R>
  BR_HD LinkResponse<R> response(const LinkConstants<R>& link, const PairMotion<R>& motion,
                                 LinkState<R>& state) const {
    if (!rated<parts>()) return response_at<parts & ~concrete_rated>(link, motion, state);
    LinkConstants<R> dynamic = link;
    quicken(dynamic, motion, state);
    return response_at<parts>(dynamic, motion, state);
  }

  /// Whether a link answers nothing in a step and keeps nothing, as it did before: a broken one
  /// whose ends are apart.
  template <ConcreteParts parts, class R>
  BR_HD auto is_idle(const LinkConstants<R>& link, const R& distance,
                     const LinkState<R>& state) const {
    const auto none = [](const Vec3Of<R>& v) { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; };
    auto idle = state.opening < 0.0 && !(stretch_of(link, distance) < 0.0);
    idle = idle && none(state.shear) && none(state.moment);
    if (damps<parts>()) idle = idle && state.branch.normal == 0.0 && none(state.branch.shear);
    return idle;
  }
  /// Whether the ends of a broken link have parted for good.
  template <class R>
  BR_HD static auto is_parted(const LinkConstants<R>& link, const R& distance, const R& opening) {
    return opening < 0.5 * (link_broken + link_released) ||
           (opening < 0.0 && distance > 1.5 * max(link.length, link.touching));
  }
  /// Whether sliding and rolling use links up.
  template <ConcreteParts parts = concrete_all>
  BR_HD bool wears() const {
    return (parts & concrete_wears) != 0 && (is_given(slip_wear) || is_given(turn_wear));
  }
  /// Whether T depends on the strain rate.
  template <ConcreteParts parts = concrete_all>
  BR_HD bool rated() const {
    return (parts & concrete_rated) != 0 && is_given(rate.exponent);
  }
  /// Whether links are damped.
  template <ConcreteParts parts = concrete_all>
  BR_HD bool damps() const {
    return (parts & concrete_damps) != 0 && damping.acts();
  }
  /// Parts that this law has.
  ConcreteParts parts() const {
    return (compacts<concrete_all>() ? concrete_compacts : 0) | (wears() ? concrete_wears : 0) |
           (is_given(friction_cap) ? concrete_caps_friction : 0) |
           (is_given(rolling_cap) ? concrete_caps_rolling : 0) |
           (is_given(hyperbolic) ? concrete_is_hyperbolic : 0) |
           (knee.bends() ? concrete_knee : 0) | (rated() ? concrete_rated : 0) |
           (damps() ? concrete_damps : 0);
  }

  template <class R>
  BR_HD TensionSoftening<R> tension(const LinkConstants<R>& link) const {
    constexpr ConcreteParts slow = concrete_all & ~concrete_rated;
    return rated() ? tension_of<concrete_all>(link) : tension_of<slow>(link);
  }
  /// DIF of a link as it stands. Until its peak it is undamaged: its strength is at least what it
  /// has borne.  [-]
  template <class R>
  BR_HD R factor_of(const LinkConstants<R>& link, const R& opening, const R& kept_rate) const {
    const R one = constant<R>(1.0);
    if (!rated()) return one;
    const R borne = (1.0 + (is_single<R> ? 1e-6 : 1e-9)) * link.stiffness * opening /
                    (tensile_strength * link.area);
    return select(kept_rate < 0.0, -1.0 * kept_rate, max(one, borne));
  }
  /// 1 - secant stiffness / K_n of an intact link after a largest opening >= 0.  [-]
  template <class R>
  BR_HD R damage(const LinkConstants<R>& link, const R& opening) const {
    const TensionSoftening<R> t = tension(link);
    const auto torn = !t.whole(opening);
    return any(torn) ? select(torn, t.damage(opening), constant<R>(0.0)) : constant<R>(0.0);
  }
  /// Energy that an intact link has spent on its opening so far.  [J]
  template <class R>
  BR_HD R spent(const LinkConstants<R>& link, const R& opening) const {
    const TensionSoftening<R> t = tension(link);
    const auto torn = !t.whole(opening);
    return any(torn) ? select(torn, t.spent(opening), constant<R>(0.0)) : constant<R>(0.0);
  }
  /// N of a link at a stretch u, tension positive.  [N]
  BR_HD double normal_force(const LinkConstants<double>& link, double stretch,
                            double opening) const {
    const double elastic = link.stiffness * stretch;
    if (opening < 0.5 * (link_broken + link_released)) return 0.0;
    if (stretch < 0.0) return elastic;
    return opening >= 0.0 ? (1.0 - damage(link, opening)) * elastic : 0.0;
  }
  /// Force on b, at the end of a way, as a link stands.  [N]
  BR_HD Vec3 force_on_b(const LinkConstants<double>& link, const Vec3& way,
                        const LinkState<double>& state) const {
    const double distance = norm(way);
    const double normal = normal_force(link, distance - link.length, state.opening);
    if (!damps()) return state.shear - (normal / distance) * way;
    const BranchForce<double>& branch = state.branch;
    return state.shear + branch.shear - ((normal + branch.normal) / distance) * way;
  }
  /// Energy a link stores at a stretch u.  [J]
  template <class R>
  BR_HD R stored(const LinkConstants<R>& link, const R& stretch, const LinkState<R>& state) const {
    const R zero = constant<R>(0.0), one = constant<R>(1.0);
    const R kn = link.stiffness, kt = shear_ratio * kn;
    const R along = 0.5 * kn * (1.0 - damage(link, state.opening)) * stretch * stretch;
    R energy = select(stretch < 0.0, 0.5 * kn * stretch * stretch,
                      select(state.opening >= 0.0, along, zero));
    const auto add = [&](const Vec3Of<R>& carried, const R& k) {
      const auto acts = k > 0.0;
      energy = select(acts, energy + dot(carried, carried) / (2.0 * select(acts, k, one)), energy);
    };
    add(state.shear, kt);
    add(state.moment, rolling_ratio * kt * link.radius * link.radius);
    if (damps()) energy += damping.stored(link, kt, state.branch);
    return select(state.opening < 0.5 * (link_broken + link_released), zero, energy);
  }

 private:
  /// How a link stands in a step.
  template <class R>
  struct Stand {
    using Truth = decltype(R{} < R{});
    Truth intact;   ///< when the step began
    Truth torn;     ///< in this step, by tension or wear
    Truth sheared;  ///< broken in this step by shear
    Truth holds;    ///< intact and not torn
    Truth pressed, parted;
    R stretch;    ///< u = D - D_eq, before compaction  [m]
    R opening;    ///< kappa  [m]
    R health;     ///< 1 - damage  [-]
    R normal;     ///< N  [N]
    R shortened;  ///< by compaction  [m]
    R crushed;    ///< energy that compaction spent  [J]
  };
  template <ConcreteParts parts>
  BR_HD bool compacts() const {
    return (parts & concrete_compacts) != 0 &&
           (is_given(compaction_strength) || is_given(crushing_strength));
  }
  template <ConcreteParts parts, class R>
  BR_HD TensionSoftening<R> tension_of(const LinkConstants<R>& link) const {
    const R slow = tensile_strength * link.area;  // S T
    TensionSoftening<R> t{link.stiffness, slow, softening, is_given(rupture_opening),
                          constant<R>(rupture_opening)};
    if constexpr ((parts & concrete_knee) != 0) t.knee = knee;
    if constexpr ((parts & concrete_rated) != 0) {
      if (!t.ends_given) t.last = slow * (N(1) + softening) / link.stiffness;
      t.ends_given = true;
      t.strength = link.factor * slow;
      t.last = max(t.last, 1.02 * t.onset());  // a link that is brittle at this rate
    }
    return t;
  }

  /// One step at the strength that `link` has now.
  /// @tparam parts  rated: that strength is another than the static one
  template <ConcreteParts parts, class R>
  BR_HD LinkResponse<R> response_at(const LinkConstants<R>& link, const PairMotion<R>& motion,
                                    LinkState<R>& state) const {
    const R zero = constant<R>(0.0);
    const R kt = shear_ratio * link.stiffness;
    const R kr = rolling_ratio * kt * link.radius * link.radius;

    // 1. Normal force.
    Stand<R> s = stretched<parts>(link, motion, state.opening);
    if (compacts<parts>()) compact(s, link, motion);

    // 2. Shear force and moment: carried with the pair, then this step's increment.
    const Carried<R> shear = carried_shear(link, motion, state.shear, kt);
    const Carried<R> moment = carried_moment(link, motion, state.moment, kr);

    // 3. Their limits.
    const R shear_limit = limit_shear<parts>(s, link, dot(shear.trial, shear.trial));
    const auto survives = s.holds && !s.sheared;
    const auto acts = survives || (s.pressed && !s.parted);
    const R moment_limit = limit_moment<parts>(s, link, survives);
    const Cut<R> slide = cut(shear.before, shear.trial, shear_limit, acts, kt);
    const Cut<R> roll = cut(moment.before, moment.trial, moment_limit, acts, kr);

    LinkResponse<R> r;
    r.normal = select(acts, s.normal, zero);
    r.shear = slide.kept;
    r.moment = roll.kept;
    r.active = select(acts, constant<R>(1.0), zero);
    r.shortened = s.shortened;
    r.slid = slide.spent;
    r.yielded = roll.spent;
    r.broke = zero;

    // 4. New state.
    state.opening = select(s.intact, s.opening, state.opening);
    if (wears<parts>()) {
      const R wear = slip_wear * slide.plastic + turn_wear * link.radius * roll.plastic;
      wear_out<parts>(s, link, motion, select(survives, wear, zero), state, r);
    }
    if (any(s.torn || s.sheared)) rupture<parts>(s, link, state, r);
    r.yielded = r.yielded + s.crushed;
    state.opening = select(s.parted, constant<R>(link_released), state.opening);
    state.shear = r.shear;
    state.moment = r.moment;
    r.damped = zero;
    if (damps<parts>()) damp(s, survives, acts, link, kt, motion, state, r);
    return r;
  }

  /// The strength of this step by the strain rate: e' = (e + dD/(D tau)) / (1 + dt/tau), held from
  /// the step on in which the link is stretched beyond it. The curve is asked only by links beyond
  /// their static strength.
  template <class R>
  BR_HD void quicken(LinkConstants<R>& link, const PairMotion<R>& motion,
                     LinkState<R>& state) const {
    const R crossed = rate.speed * motion.time / link.length;  // dt / tau
    const R gained = rate.speed * motion.extension / (link.length * link.length);
    const auto waits = state.opening >= 0.0 && state.rate >= 0.0;
    const R smooth = max(constant<R>(0.0), (state.rate + gained) / (1.0 + crossed));
    state.rate = select(waits, smooth, state.rate);
    link.factor = factor_of(link, state.opening, state.rate);
    const R stretch = max(state.opening, stretch_of(link, motion.distance));
    hold_factor(link, waits, stretch, state);
  }
  /// Holds the factor of waiting links whose opening reaches beyond their dynamic strength.
  template <class R, class Truth>
  BR_HD void hold_factor(LinkConstants<R>& link, const Truth& waits, const R& opening,
                         LinkState<R>& state) const {
    const R slow = tensile_strength * link.area, elastic = link.stiffness * opening;
    const auto beyond = waits && elastic > link.factor * slow;
    if (!any(beyond)) return;
    const R dynamic = max(link.factor, rate.factor(state.rate));
    link.factor = select(beyond, dynamic, link.factor);
    state.rate = select(beyond && elastic > link.factor * slow, -1.0 * link.factor, state.rate);
  }

  /// Tension with softening, compression without limit.
  template <ConcreteParts parts, class R>
  BR_HD Stand<R> stretched(const LinkConstants<R>& link, const PairMotion<R>& motion,
                           const R& opening_before) const {
    const R zero = constant<R>(0.0), one = constant<R>(1.0), kn = link.stiffness;
    const TensionSoftening<R> t = tension_of<parts>(link);
    Stand<R> s;
    s.stretch = stretch_of(link, motion.distance);
    s.intact = opening_before >= 0.0;
    s.opening = max(opening_before, s.stretch);
    s.torn = s.intact && kn * s.opening >= t.elastic_at_rupture();
    s.health = one;
    const auto softened = s.intact && kn * s.opening > t.strength;
    if (any(softened)) s.health = select(softened, one - t.damage(s.opening), one);
    s.pressed = s.stretch < 0.0;
    s.holds = s.intact && !s.torn;
    const auto released = opening_before < 0.5 * (link_broken + link_released);
    const R reach = 1.5 * max(link.length, link.touching);
    s.parted = released || (!s.intact && motion.distance > reach);
    const auto resists = s.holds || (s.pressed && !s.parted);
    const R elastic = kn * s.stretch;
    s.normal = select(resists, select(s.pressed, elastic, s.health * elastic), zero);
    s.shortened = s.crushed = zero;
    return s;
  }

  /// Compaction: pressed beyond its yield force, a link shortens D_eq until its force lies on the
  /// line of slope H K_n, or until its pores are closed. Energy in the trapezoidal form of the
  /// ledger, -dD_eq (N_before + N_after)/2, N_before from the change of distance.
  template <class R>
  BR_HD void compact(Stand<R>& s, const LinkConstants<R>& link, const PairMotion<R>& motion) const {
    const R zero = constant<R>(0.0), kn = link.stiffness;
    const auto filled = s.holds || link.touching >= link.length;
    const R onset =
        select(filled, constant<R>(compaction_strength), constant<R>(crushing_strength));
    // Hardening only raises the yield force, rounding included: most links need no division.
    if (!any(s.pressed && -s.normal - link.area * onset > 0.0)) return;
    const R first = modulus * link.area / kn;  // D_0
    const R p = max(zero, first - link.length) / first;
    const R slope = select(filled, constant<R>(compaction_slope), constant<R>(crushing_slope));
    const R excess = -s.normal - link.area * (onset + modulus * p * slope / (1.0 - slope));
    const auto yields = s.pressed && !s.parted && excess > 0.0 && onset > 0.0;
    if (!any(yields)) return;
    R by = excess * (1.0 - slope) / kn;
    if (is_given(closing_strain))
      by = min(by, max(zero, link.length - (1.0 - closing_strain) * first));
    s.shortened = select(yields, by, zero);
    const R before = min(zero, s.normal - kn * motion.extension);
    s.normal = s.normal + kn * s.shortened;
    s.crushed = -0.5 * s.shortened * (before + s.normal);
  }

  /// Modified Mohr-Coulomb limit of the shear force; finds links that break at it.
  template <ConcreteParts parts, class R>
  BR_HD R limit_shear(Stand<R>& s, const LinkConstants<R>& link, const R& trial_squared) const {
    const R zero = constant<R>(0.0);
    const R cohesive = select(s.holds, s.health, zero);
    const R slope = select(s.holds, constant<R>(friction), constant<R>(broken_friction));
    R limit =
        max(zero, cohesion * link.area * cohesive + friction_limit<parts>(link, s.normal, slope));
    if ((parts & concrete_is_hyperbolic) != 0 && is_given(hyperbolic))
      limit = select(s.holds, hyperbola<parts>(s, link, limit), limit);
    const auto beyond = trial_squared > zero && trial_squared > limit * limit;
    s.sheared = s.holds && beyond && constant<R>(brittle_shear) > 0.5;
    if (any(s.sheared))
      limit = select(s.sheared,
                     max(zero, friction_limit<parts>(link, s.normal, constant<R>(broken_friction))),
                     limit);
    return limit;
  }
  /// The limit of an intact link by the hyperbola; `line`: its asymptote, cohesion and friction.
  template <ConcreteParts parts, class R>
  BR_HD R hyperbola(const Stand<R>& s, const LinkConstants<R>& link, const R& line) const {
    const R zero = constant<R>(0.0);
    R strength = tensile_strength * link.area;
    if constexpr ((parts & concrete_rated) != 0) strength = link.factor * strength;
    const R vertex = max(zero, s.health * (cohesion * link.area - friction * strength));
    return sqrt(max(zero, line - vertex) * (line + vertex));
  }
  /// Shear force that friction bears, below zero in tension.  [N]
  template <ConcreteParts parts, class R>
  BR_HD R friction_limit(const LinkConstants<R>& link, const R& normal, const R& slope) const {
    const R force = -1.0 * (normal * slope);
    if ((parts & concrete_caps_friction) == 0 || !is_given(friction_cap)) return force;
    const R cap = friction_cap * link.area;
    if (friction_fades < 0.5) return min(force, cap);
    // f S s_F / (f + S s_F), in a form that divides no zero
    const R pressed = max(force, constant<R>(0.0));
    return min(force, cap * (1.0 - cap / (pressed + cap)));
  }

  template <ConcreteParts parts, class R>
  BR_HD R limit_moment(const Stand<R>& s, const LinkConstants<R>& link,
                       const typename Stand<R>::Truth& survives) const {
    const R zero = constant<R>(0.0);
    const auto counts = s.pressed || !survives;
    R force = select(counts, abs(s.normal), zero) +
              select(survives, tensile_strength * link.area * s.health, zero);
    if ((parts & concrete_caps_rolling) != 0 && is_given(rolling_cap))
      force = min(force, rolling_cap * link.area);
    const R eta = select(survives, constant<R>(rolling_limit), constant<R>(broken_rolling_limit));
    return eta * link.radius * force;
  }

  /// Wear opens a link, until it is torn in the next step. It spends nothing of its own: sliding
  /// and rolling have been booked, so that `broke` takes back what the ledger reads off the opening
  /// (TensionSoftening::spent), but for what a stretched link stored.
  template <ConcreteParts parts, class R>
  BR_HD void wear_out(const Stand<R>& s, LinkConstants<R> link, const PairMotion<R>& motion,
                      const R& wear, LinkState<R>& state, LinkResponse<R>& r) const {
    const auto worn = wear > 0.0;
    if (!any(worn)) return;
    if constexpr ((parts & concrete_rated) != 0)
      hold_factor(link, worn && state.rate >= 0.0, s.opening + wear, state);
    const TensionSoftening<R> t = tension_of<parts>(link);
    // a little beyond u_2, so that rounding cannot keep the link whole
    const R last = (1.0 + 1e-6) * t.rupture();
    const R after = max(s.opening, min(opened_by(link, s.opening, wear), last));
    const R softer = s.health - (1.0 - t.damage(after));
    const R next = max(constant<R>(0.0), s.stretch + motion.extension);
    const R released =
        select(s.pressed, constant<R>(0.0), 0.5 * link.stiffness * softer * s.stretch * next);
    r.broke = select(worn, t.spent(s.opening) - t.spent(after) + released, r.broke);
    state.opening = select(worn, after, state.opening);
  }

  template <class R>
  BR_HD static R opened_by(const LinkConstants<R>& link, const R& opening, const R& wear) {
    if constexpr (is_single<R>) return sum_by(link.chance, 29, opening, wear);
    return opening + wear;
  }

  /// The branch beside the springs. A link that has softened is without it while it is stretched,
  /// so that cracks open freely; a broken one that is pressed has the part along the normal,
  /// without attraction.
  template <class R, class Truth>
  BR_HD void damp(const Stand<R>& s, const Truth& survives, const Truth& acts,
                  const LinkConstants<R>& link, const R& kt, const PairMotion<R>& motion,
                  LinkState<R>& state, LinkResponse<R>& r) const {
    const R zero = constant<R>(0.0), one = constant<R>(1.0);
    const BranchForce<R> trial = damping.moved(link, kt, motion, state.branch);
    const auto whole = survives && (s.pressed || s.health >= one);
    const R push = select(acts && !survives, min(trial.normal, -1.0 * r.normal), zero);
    const BranchForce<R> force{select(whole, trial.normal, push),
                               select(whole, trial.shear, Vec3Of<R>{zero, zero, zero})};
    r.damped = damping.taken(link, kt, motion, state.branch, force);
    r.normal = r.normal + force.normal;
    r.shear = r.shear + force.shear;
    r.active = (1.0 + damping.share) * r.active;
    state.branch = force;
  }

  template <ConcreteParts parts, class R>
  BR_HD void rupture(const Stand<R>& s, const LinkConstants<R>& link, LinkState<R>& state,
                     LinkResponse<R>& r) const {
    const R zero = constant<R>(0.0);
    const TensionSoftening<R> t = tension_of<parts>(link);
    const auto ends = s.torn || s.sheared;
    const R stored = constant<R>(0.5) * s.health * link.stiffness * s.stretch * s.stretch;
    const R spent =
        select(s.torn, t.toughness(), t.spent(s.opening) + select(s.pressed, zero, stored));
    r.broke = select(ends, spent + r.slid + r.yielded, r.broke);
    r.slid = select(ends, zero, r.slid);
    r.yielded = select(ends, zero, r.yielded);
    state.opening = select(ends, constant<R>(link_broken), state.opening);
  }
};

using ConcreteLink = ConcreteLinkOf<double>;

}  // namespace breccia::dem
