#pragma once
// Energies of elements, one by one or by packs.

#include "core/energy.hpp"
#include "dem/element_kernels.hpp"

namespace breccia::dem {

/// Kinetic energy at the time of the forces, m/2 (v.v - dt_- dt_+ a.a / 4) with v = v_- + a dt_-/2:
/// for equal steps m/2 v_-.v_+, with which the scheme's own balance closes to rounding
/// (docs/theory.md, ledger).
struct KineticEnergy {
  Kick kick;

  BR_HD void add_to(Energies& sum, Index e) const { add<double>(sum, e); }
  template <class R>
  bool add_pack(EnergiesOf<R>& sum, Index e) const {
    add<R>(sum, e);
    return true;
  }

 private:
  template <class R>
  BR_HD void add(EnergiesOf<R>& sum, Index e) const {
    const ElementStateOf<R> now = element_state<R>(kick.state, e);
    const Kick::GivenOf<R> given = kick.given<R>(e);
    const Kick::ResultOf<R> next = kick(e, now, given);
    sum.kinetic.add(0.5 * given.mass * square(now.velocity, next.velocity) +
                    0.5 * given.inertia * square(now.spin, next.spin));
  }
  template <class R>
  BR_HD R square(const Vec3Of<R>& before, const Vec3Of<R>& after) const {
    const double span = 0.5 * (kick.last_dt + kick.next_dt);
    const R over = constant<R>(span > 0.0 ? 1.0 / span : 0.0);
    const Vec3Of<R> a = over * (after - before);
    const Vec3Of<R> now = before + constant<R>(0.5 * kick.last_dt) * a;
    return dot(now, now) - 0.25 * kick.last_dt * kick.next_dt * dot(a, a);
  }
};

/// Work that damping has taken from elements, and that supports have put into them.
struct ElementShares {
  Kick kick;
  View<const double> damping_work, load_work;

  BR_HD void add_to(Energies& sum, Index e) const { add<double>(sum, e); }
  template <class R>
  bool add_pack(EnergiesOf<R>& sum, Index e) const {
    add<R>(sum, e);
    return true;
  }

 private:
  template <class R>
  BR_HD void add(EnergiesOf<R>& s, Index e) const {
    s.damping.add(load<R>(damping_work, e));
    s.work.add(load<R>(load_work, e));
    // Moving books the work of these forces in the last and the next step; half is done.
    const Kick::GivenOf<R> of = kick.given<R>(e);
    if (of.fixed == 0 && !(kick.damping > 0.0)) return;
    const ElementStateOf<R> now = element_state<R>(kick.state, e);
    const Kick::ResultOf<R> next = kick(e, now, of);
    const R half = constant<R>(0.5 * kick.last_dt);
    const Vec3Of<R> came = half * now.velocity;
    s.damping.add(dot(next.damped_force, came));
    s.damping.add(dot(next.damped_torque, half * now.spin));
    if (of.fixed != 0) s.work.add(dot(kick.reaction(e, now.velocity, next, of), came));
  }
};

}  // namespace breccia::dem
