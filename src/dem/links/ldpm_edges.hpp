#pragma once
// Edges of the lattice discrete particle model: one action for all facets of an edge.

#include "dem/laws/ldpm_facet.hpp"
#include "dem/links/link_set.hpp"
#include "math/records.hpp"

namespace breccia::dem {

/// Where a facet lies, in the frame n, m, l = n x m of its edge.
struct LdpmPlace {
  double length;  ///< L of the edge  [m]
  double area;    ///< A, projected across the edge  [m2]
  Vec3 center;    ///< from particle a, along n, m, l  [m]
  double volume;  ///< six times V_0 of its tetrahedron, signed (six_volumes)  [m3]
};
/// How the frame of a facet's edge has turned, and whether the facet holds.
template <class R>
struct LdpmFrameOf {
  Vec3Of<R> m;  ///< unit vector across the edge  [-]
  R bond;       ///< 1; 0 once cracked; ldpm_released when its ends have parted  [-]
};
using LdpmFrame = LdpmFrameOf<double>;
inline constexpr double ldpm_released = -1.0;

/// Action of a facet in a step, in the frame of its edge: force on b, its moment about a; a pack
/// is eight numbers long.
struct LdpmShare {
  double numbers[8];  ///<  [N], [N m], none
};
/// Stiffness of an edge: sums over its facets, with k = max(E_0, E_d) A / L and the centre c.
struct LdpmStiffness {
  double straight;  ///< of k  [N/m]
  double first;     ///< of k c_n  [N]
  double second;    ///< of k c_n^2  [N m]
  double aside;     ///< of k (c_m^2 + c_l^2)  [N m]
  double alpha;     ///<  [-]
  double fill;      ///< an even number
};

/// Edges of facets [0, count): neighbours of one law with both ends in common.
struct LdpmEdges {
  Buffer<Index> of;                 ///< edge of each facet  [-]
  Buffer<Index> leads;              ///< first facet of each edge, and the end  [-]
  Buffer<LdpmStiffness> stiffness;  ///< of each edge
  Buffer<LdpmShare> shares;         ///< of each facet, on a device; the host adds them as they come

  Index size() const { return stiffness.size(); }
};

/// Forces of edges from what their facets do (LdpmFacetForces), one edge or a pack of neighbours at
/// a time: shares are added in the order of facets. The action is that of the first facet, all
/// others have none.
struct LdpmEdgeForces {
  static constexpr const char* name = "dem.ldpm_edges";
  using Law = LdpmFacet;
  View<const ElementState> elements;
  View<const Index> a, b, leads;
  View<const LdpmFrame> frame;
  View<const LdpmStiffness> stiffness;
  View<const LdpmShare> shares;
  Index first_share;  ///< share of facet 0
  View<PairForce> actions;
  Index first_action;  ///< action of facet 0

  template <class R>
  struct Loaded {
    Index lead[width_of<R>], end[width_of<R>];
    R constants[6], at_a[4], at_b[4], frame[4], sum[6];
  };
  BR_HD void set(const StepTime&) {}
  template <class R>
  BR_HD void load_early(Index k, Loaded<R>& loaded) const {
    for (Index j = 0; j < width_of<R>; ++j) {
      loaded.lead[j] = read_now(&leads[k + j]);
      loaded.end[j] = read_now(&leads[k + j + 1]);
    }
    gather_records(stiffness, consecutive<R>(k), loaded.constants);
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    Index from[width_of<R>], to[width_of<R>];
    for (Index j = 0; j < width_of<R>; ++j) {
      const Index lead = loaded.lead[j];
      from[j] = a[lead], to[j] = b[lead];
    }
    add_shares(loaded);
    gather_records(elements, indices<R>(from), loaded.at_a);
    gather_records(elements, indices<R>(to), loaded.at_b);
    gather_records(frame, indices<R>(loaded.lead), loaded.frame);
  }
  BR_WHOLE BR_HD void operator()(Index k) const { run_at<double>(*this, k); }
  /// The sums of edges side by side: to those that have fewer facets nothing is added at the end,
  /// for where each ends could not be foreseen.
  template <class R>
  BR_HD void add_shares(Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1) {
      SixSums sum;
      for (Index i = loaded.lead[0]; i < loaded.end[0]; ++i)
        sum.add(shares[first_share + i].numbers);
      for (int c = 0; c < 6; ++c) loaded.sum[c] = sum[c];
    } else {
      constexpr Index width = width_of<R>, parts = 8 / width;
      static constexpr LdpmShare nothing{};
      const LdpmShare* at[width];
      Index count[width], most = 0;
      R sums[parts][width] = {};
      for (Index j = 0; j < width; ++j) {
        at[j] = &shares[first_share + loaded.lead[j]];
        count[j] = loaded.end[j] - loaded.lead[j];
        most = count[j] > most ? count[j] : most;
      }
      for (Index i = 0; i < most; ++i)
        for (Index j = 0; j < width; ++j) {
          const double* const numbers = (i < count[j] ? at[j] + i : &nothing)->numbers;
          for (Index part = 0; part < parts; ++part) {
            R some;
            __builtin_memcpy(&some, numbers + width * part, sizeof some);
            sums[part][j] += some;
          }
        }
      for (Index part = 0; part < parts; ++part) {
        transpose(sums[part]);
        for (Index c = 0; c < width && width * part + c < 6; ++c)
          loaded.sum[width * part + c] = sums[part][c];
      }
    }
  }

  /// Force and torques, and a stiffness: with k of each facet and r from a particle to it, K = k
  /// (alpha I + (1 - alpha) n n^T), and K^theta is at most k (alpha r.r + (1 - alpha) |r x n|^2) I.
  template <class R>
  BR_HD void update(Index, const Loaded<R>& of) const {
    const Vec3Of<R> d{of.at_b[0] - of.at_a[0], of.at_b[1] - of.at_a[1], of.at_b[2] - of.at_a[2]};
    const R distance = norm(d);
    const Vec3Of<R> n = (1.0 / distance) * d, m{of.frame[0], of.frame[1], of.frame[2]};
    const Vec3Of<R> l = cross(n, m);
    const auto outward = [&](const R& x, const R& y, const R& z) { return x * n + y * m + z * l; };
    const R* const force = of.sum;
    const R* const turn = of.sum + 3;
    const Vec3Of<R> on_b = outward(force[0], force[1], force[2]);
    const Vec3Of<R> turn_a = -outward(turn[0], turn[1], turn[2]);
    // about b: distance n x force less
    const Vec3Of<R> turn_b =
        outward(turn[0], turn[1] + distance * force[2], turn[2] - distance * force[1]);
    const R numbers[9] = {turn_a.x, turn_a.y, turn_a.z, on_b.x,  on_b.y,
                          on_b.z,   turn_b.x, turn_b.y, turn_b.z};

    const R none = constant<R>(0.0);
    const R holds = select(of.frame[3] < 0.0, none, constant<R>(1.0));
    const R k = holds * of.constants[0], alpha = of.constants[4];
    const R first = holds * of.constants[1], second = holds * of.constants[2];
    const R aside = holds * of.constants[3];
    const R across = alpha * k;
    const Vec3Of<R> along = (k - across) * n;
    const R from_b = second + distance * (distance * k - 2.0 * first);
    const R matrices[9] = {alpha * second + aside, across + along.x * n.x, across + along.y * n.y,
                           across + along.z * n.z, along.x * n.y,          along.x * n.z,
                           along.y * n.z,          alpha * from_b + aside, none};
    if constexpr (width_of<R> == 1) {
      write_action(actions[first_action + of.lead[0]], numbers, matrices);
    } else {
      write_actions_to(
          [&, this](Index j) -> PairForce& { return actions[first_action + of.lead[j]]; }, numbers,
          matrices);
    }
  }
};

}  // namespace breccia::dem
