#pragma once
// The stable step where corners move as one: the rows of all that are tied, over their whole mass.
//
// In the stiffness of the whole, K = sum of K_e, a row's absolute values add up to no more than
// those of its elements do, so omega^2 <= max over bundles of (sum of rows)/(sum of masses). First
// each element lists the rows of its corners, then each bundle adds up.

#include <type_traits>

#include "core/kernel.hpp"
#include "core/stepping.hpp"
#include "domain/owned.hpp"
#include "exec/buffer.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/stable_parts.hpp"

namespace breccia::fdem_shared {

/// The bound that rows give.
template <class Rows>
using BoundOf = decltype(bound_of(Rows{}, 1.0));

/// No step until the next evaluation is longer. That contact may come sooner makes steps shorter,
/// so the steps that there would be without it bound it, not those that there were: these would
/// swing.
struct LongestStep {
  double free;  ///< Case::free_step  [s]
  AllowedStep allowed;
  BR_HD double operator()(double last_dt) const {
    return last_dt > 0.0 ? max(free, allowed(largest_least, last_dt)) : free;
  }
};
template <class World>
LongestStep longest_step(const World& w) {
  return {w.given->free_step, allowed_step(w)};
}

/// Marks the corners that rings hold.
struct MarkRinged {
  static constexpr const char* name = "fdem.mark_ringed";
  View<const Index> nodes;
  View<std::uint8_t> ringed;
  BR_HD void operator()(Index k) const { ringed[nodes[k]] = 1; }
};

/// Lists the rows of an element's corners.
/// @returns the least bound of those that move by themselves
template <class StableStep, class Rows, int corners>
struct ListRows {
  static constexpr const char* name = "fdem.list_rows";
  StableStep stable;
  View<const std::uint8_t> ringed;  ///< 1: of each corner that a ring holds; empty: no ring does
  View<RowsOfCorners<Rows, corners>> rows;
  LongestStep longest_after;
  double longest;  ///< no step until the next evaluation is longer  [s]
  Pressed where;

  BR_HD void set(const StepTime& now) { longest = longest_after(now.last_dt); }
  BR_HD bool goes_with_others(Index t, int corner) const {
    return ringed.size > 0 && ringed[corners * t + corner] != 0;
  }
  BR_HD BoundOf<Rows> operator()(Index t) const {
    StepParts parts[corners];
    stable.list(t, longest, where, parts);
    BoundOf<Rows> least = no_bound(Rows{});
    for (int k = 0; k < corners; ++k) {
      const Rows own(parts[k]);
      rows[t].at[k] = own;
      if (goes_with_others(t, k) || stable.is_held(t, k)) continue;
      const BoundOf<Rows> bound = bound_of(own, stable.mass[t]);
      if (bound < least) least = bound;
    }
    return least;
  }
};

/// Calls visit(first, bound, mass, rows) for the bundles at a vertex: the place of the first corner
/// in Bundles::nodes, and of all of its corners the bound, mass and sum of rows. None is of corners
/// that all go where they are told.
template <class StableStep, class Rows, int corners>
struct EachBundle {
  StableStep stable;
  View<const Index> starts, nodes, leader;
  View<RowsOfCorners<Rows, corners>> rows;

  template <class Visit>
  BR_HD void operator()(Index ring, const Visit& visit) const {
    const Index end = starts[ring + 1];
    for (Index first = starts[ring]; first < end; ++first) {
      if (leader[first] != first) continue;
      Rows sum;
      double mass = 0.0;
      bool held = true;
      for (Index k = first; k < end; ++k) {
        if (leader[k] != first) continue;
        const Index t = nodes[k] / corners;
        const int corner = static_cast<int>(nodes[k] % corners);
        sum.add(rows[t].at[corner]);
        mass += stable.mass[t];
        held = held && stable.is_held(t, corner);
      }
      if (!held) visit(first, bound_of(sum, mass), mass, sum);
    }
  }
};

/// The least bound of the bundles at a vertex.
template <class Each, class Rows>
struct LeastOfRing {
  static constexpr const char* name = "fdem.least_of_rings";
  Each each;
  BR_HD BoundOf<Rows> operator()(Index ring) const {
    BoundOf<Rows> least = no_bound(Rows{});
    each(ring, [&least](Index, const BoundOf<Rows>& bound, double, const Rows&) {
      if (bound < least) least = bound;
    });
    return least;
  }
};

/// Both kernels over the arrays of a world.
/// @param rows  gets the rows of all corners
/// @param longest, where  see ListRows
template <class World, class Rows, int corners>
auto list_rows_kernel(const World& w, Buffer<RowsOfCorners<Rows, corners>>& rows, double longest,
                      Pressed where) {
  rows.resize(ShapeOf<World>::elements(w).size());
  return ListRows<decltype(stable_step(w)), Rows, corners>{
      stable_step(w), w.ringed.view(), rows.view(), longest_step(w), longest, where};
}
template <class World, class Rows, int corners>
auto each_bundle(const World& w, Buffer<RowsOfCorners<Rows, corners>>& rows) {
  return EachBundle<decltype(stable_step(w)), Rows, corners>{
      stable_step(w), w.bundles.starts.view(), w.bundles.nodes.view(), w.bundles.leader.view(),
      rows.view()};
}
template <class World, class Rows, int corners>
auto least_of_ring_kernel(const World& w, Buffer<RowsOfCorners<Rows, corners>>& rows) {
  const auto each = each_bundle(w, rows);
  return LeastOfRing<std::remove_cv_t<decltype(each)>, Rows>{each};
}
template <class World>
Index count_rings(const World& w) {
  return w.bundles.starts.size() > 0 ? w.bundles.starts.size() - 1 : 0;
}

/// Whether corners move as one somewhere, on any rank.
template <class World>
bool has_bundles(const World& w) {
  return w.mesh.bundled || count_rings(w) > 0;
}

/// Whether bundles bound the step as a whole. Spheres add to the rows of the elements that they
/// meet: there each element bears its rows alone.
template <class World>
bool bundles_bound(const World& w) {
  return has_bundles(w) && !ShapeOf<World>::meets_spheres(w);
}

/// The least stable step of all corners on all ranks.  [s]
template <class World>
double least_step_of_corners(World& w, Pressed where) {
  const double longest = longest_step(w)(w.last_dt);
  const double alone =
      fold_owned(w.exec, w.domain, ShapeOf<World>::elements(w).size(), largest_least,
                 list_rows_kernel(w, w.rows, longest, where), Least{});
  if (!w.domain.single_rank()) w.tied_forces.refresh(w.exec, *w.domain.ranks, w.rows);
  const double tied =
      fold(w.exec, count_rings(w), largest_least, least_of_ring_kernel(w, w.rows), Least{});
  return w.domain.least(tied < alone ? tied : alone);
}

/// Case::free_step of a whole model.  [s]
template <class World>
double world_free_step(World& w) {
  return has_bundles(w) ? least_step_of_corners(w, Pressed::nowhere) : 0.0;
}

}  // namespace breccia::fdem_shared
