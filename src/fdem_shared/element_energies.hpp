#pragma once
// Energies of elements, one by one, and of free ones by packs.

#include "core/energy.hpp"
#include "exec/lanes.hpp"
#include "fdem_shared/motion.hpp"

namespace breccia::fdem_shared {

/// @tparam Stored  a method's: kick, elastic(t); for packs also lanes, elastic(t, nodes), and
/// add_energies() of these shares
template <class Stored>
struct ElementShares {
  using Kick = decltype(Stored::kick);
  using Vector = typename Kick::Vector;
  using Nodes = typename Kick::Nodes;
  using Corners = typename Kick::Corners;
  Stored stored;
  View<const Corners> external;
  View<const double> viscous_work, damping_work, load_work;

  BR_HD void add_to(Energies& s, Index t) const {
    const auto& kick = stored.kick;
    double kinetic = 0.0, damping = viscous_work[t] + damping_work[t], work = load_work[t];
    if (kick.is_gone(t)) {
      s.damping.add(damping);
      s.work.add(work);
      return;
    }
    const auto next = kick(t);
    const double over_span = kick.span() > 0.0 ? 1.0 / kick.span() : 0.0;
    for (int k = 0; k < Kick::corners; ++k) {
      // m/2 (v.v - dt_- dt_+ a.a / 4): the leapfrog's own balance closes with it
      const Vector before = kick.nodes[t].at[k].velocity;
      const Vector a = over_span * (next.velocity[k] - before);
      const Vector now = before + (0.5 * kick.last_dt) * a;
      kinetic +=
          0.5 * kick.mass[t] * (dot(now, now) - 0.25 * kick.last_dt * kick.next_dt * dot(a, a));
      // Moving books the work of these forces in the last and the next step; half is done.
      const Vector came = (0.5 * kick.last_dt) * before;
      damping += dot(next.damped[k], came);
      if (external.size > 0) work += dot(external[t].at[k], came);
      if (kick.hold[t] >= 0) work += dot(kick.reaction(kick.given(t), k, next), came);
    }
    s.kinetic.add(kinetic);
    s.damping.add(damping);
    s.work.add(work);
    s.elastic.add(stored.elastic(t));
  }
  /// Of elements [begin, end).
  void add_run(Energies& s, Index begin, Index end) const requires requires { stored.lanes; }
  { add_energies(stored.lanes, *this, begin, end, s); }

  /// Whether nothing holds t and its neighbours in a pack.
  template <class R>
  bool are_free(Index t) const {
    for (Index k = 0; k < width_of<R>; ++k)
      if (stored.kick.hold[t + k] >= 0) return false;
    return true;
  }
  /// Adds free ones, as add_to() adds each of them.
  template <class R>
  void add_free(EnergiesOf<R>& s, Index t) const {
    const auto& kick = stored.kick;
    Columns<R, Nodes> nodes;
    Columns<R, Corners> force, loads;
    nodes.read(kick.nodes, t);
    force.read(kick.force, t);
    if (external.size > 0) loads.read(external, t);
    const R m = load<R>(kick.mass, t), half = constant<R>(0.5 * kick.last_dt);
    const R over_span = constant<R>(kick.span() > 0.0 ? 1.0 / kick.span() : 0.0);
    R kinetic = constant<R>(0.0), work = load<R>(load_work, t);
    R damping = load<R>(viscous_work, t) + load<R>(damping_work, t);
    for (int k = 0; k < Kick::corners; ++k) {
      constexpr int dimension = Kick::dimension;
      R square, square_a, off, in;
      for (int axis = 0; axis < dimension; ++axis) {
        const int c = dimension * k + axis;
        const R before = nodes.numbers[2 * dimension * k + dimension + axis];
        const auto next = kick.template free_part<R>(axis, before, force.numbers[c], m);
        const R a = over_span * (next.velocity - before), now = before + half * a;
        const R came = half * before;
        const auto add = [axis](R& sum, const R& term) { sum = axis == 0 ? term : sum + term; };
        add(square, now * now);
        add(square_a, a * a);
        add(off, next.damped * came);
        if (external.size > 0) add(in, loads.numbers[c] * came);
      }
      kinetic += 0.5 * m * (square - 0.25 * kick.last_dt * kick.next_dt * square_a);
      damping += off;
      if (external.size > 0) work += in;
    }
    s.kinetic.add(kinetic);
    s.damping.add(damping);
    s.work.add(work);
    s.elastic.add(stored.elastic(t, nodes.numbers));
  }
};

}  // namespace breccia::fdem_shared
