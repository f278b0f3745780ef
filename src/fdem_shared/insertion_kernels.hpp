#pragma once
// Extrinsic joints: where the stress between two elements that move as one reaches their joint's
// strength, what wakes then, and who moves with whom afterwards. A method says how large the stress
// is (`Sleeper`: joints/insertion_kernels.hpp of fdem and fdem3).

#include "core/incidence.hpp"
#include "core/kernel.hpp"
#include "core/rows.hpp"
#include "domain/domain.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/exposed.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Stress over strength of dormant joints.
/// @tparam Sleeper  a method's: stage, overshoot(i)
template <class Sleeper>
struct Overshoot {
  static constexpr const char* name = "fdem.overshoot";
  Sleeper sleeper;
  View<double> overshoot;
  View<std::uint8_t> reached;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index i) const {
    overshoot[i] = 0.0;
    if (!sleeper.sleeps(i)) return;
    overshoot[i] = sleeper.overshoot(i);
    if (overshoot[i] >= 1.0) set_flag(reached, 0);
  }
};

/// Asks the host to wake joints.
struct WatchReached {
  static constexpr const char* name = "fdem.watch_reached";
  View<const std::uint8_t> reached;
  std::int32_t* host_request;
  std::int32_t wanted;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index) const {
    if (reached[0] != 0) *host_request = wanted;
  }
};

/// Joints whose strength is reached.
struct IsReached {
  View<const double> overshoot;
  BR_HD bool operator()(Index i) const { return overshoot[i] >= 1.0; }
};

/// The vertices of joints.
template <class Shape>
struct VerticesOfJoints {
  View<const Index> side_a;
  View<const Index> vertex_of;  ///< of each node
  BR_HD Index operator()(Index i, int k) const {
    const Index side = side_a[i], first = Shape::corners * (side / Shape::corners);
    return vertex_of[first + Shape::corner_of_side(side % Shape::corners, k)];
  }
};

/// A joint whose strength is reached, and its vertices.
template <class Shape>
struct Candidate {
  double overshoot;
  Index joint, vertex[Shape::dimension];
};
template <class Shape>
struct ListCandidates {
  static constexpr const char* name = "fdem.list_candidates";
  View<const Index> joint;
  View<const double> overshoot;
  VerticesOfJoints<Shape> vertices;
  View<Candidate<Shape>> candidate;
  BR_HD void operator()(Index n) const {
    const Index i = joint[n];
    Candidate<Shape> c{};
    c.overshoot = overshoot[i];
    c.joint = i;
    for (int k = 0; k < Shape::dimension; ++k) c.vertex[k] = vertices(i, k);
    candidate[n] = c;
  }
};

/// A few of the vertices, ascending.
struct SomeVertices {
  View<const Index> some;
  BR_HD bool hold(Index vertex) const {
    const Index place = lower_bound(some.data, 0, some.size, vertex);
    return place < some.size && some[place] == vertex;
  }
};

/// Dormant joints with one of some vertices.
template <class Shape, class Stage>
struct SleepsAt {
  View<const Stage> stage;
  VerticesOfJoints<Shape> vertices;
  SomeVertices parted;
  BR_HD bool operator()(Index i) const {
    if (stage[i] != Stage::dormant) return false;
    for (int k = 0; k < Shape::dimension; ++k)
      if (parted.hold(vertices(i, k))) return true;
    return false;
  }
};

/// Wakes joints at the opening and slip at which they carry what was transmitted.
/// @tparam Sleeper  a method's: wake(i, share) does so with a share of it and tells what the joint
/// stores then
template <class Shape, class Sleeper>
struct Wake {
  static constexpr const char* name = "fdem.wake";
  Sleeper sleeper;
  View<const double> overshoot;
  View<const Index> side_a, side_b;
  VerticesOfJoints<Shape> vertices;
  OwnedView owned;
  View<const Index> joint;
  View<double> held;  ///< what each then stores, if this rank owns its side a  [J/m], [J]
  View<Index> elements, vertex;  ///< two, and `dimension`, of each

  BR_HD void operator()(Index n) const {
    const Index i = joint[n];
    // just below its strength, where that is reached
    const double stored = sleeper.wake(i, min(1.0, (1.0 - 1e-6) / overshoot[i]));
    const Index a = side_a[i] / Shape::corners;
    held[n] = owned(a) ? stored : 0.0;
    elements[2 * n] = a;
    elements[2 * n + 1] = side_b[i] / Shape::corners;
    for (int k = 0; k < Shape::dimension; ++k) vertex[Shape::dimension * n + k] = vertices(i, k);
  }
};

/// Who moves with whom around a vertex: corners of elements whose common side is bonded or whose
/// joint sleeps; never across vertices, or edges of tetrahedra, alone.
template <class Shape, class Stage>
struct TieCorners {
  static constexpr const char* name = "fdem.tie_corners";
  View<const Index> starts, nodes, across, vertex_of;
  View<const typename Shape::Sides> sides;
  View<const Stage> stage;
  bool all;              ///< vertices; otherwise only
  SomeVertices changed;  ///< these
  View<Index> leader;

  BR_HD void operator()(Index ring) const {
    const Index begin = starts[ring], end = starts[ring + 1];
    const Index vertex = vertex_of[nodes[begin]];
    if (!all && !changed.hold(vertex)) return;
    for (Index k = begin; k < end; ++k) leader[k] = k;
    for (Index k = begin; k < end; ++k) {
      const Index node = nodes[k], first = Shape::corners * (node / Shape::corners);
      for (Index s = 0; s < Shape::corners; ++s) {
        const Index side = first + s;
        // Both elements would find their common side: once is enough.
        if (!has(s, node - first) || across[side] < side || !ties(side)) continue;
        const Index other = corner_at(across[side] / Shape::corners, vertex);
        const Index a = first_of(k), b = first_of(lower_bound(nodes.data, begin, end, other));
        leader[a < b ? b : a] = a < b ? a : b;
      }
    }
    for (Index k = begin; k < end; ++k) leader[k] = first_of(k);
  }

 private:
  BR_HD static bool has(Index side, Index corner) {
    for (int k = 0; k < Shape::dimension; ++k)
      if (Shape::corner_of_side(side, k) == corner) return true;
    return false;
  }
  BR_HD bool ties(Index side) const {
    const Index entry = sides[side / Shape::corners].at[side % Shape::corners];
    return entry == Shape::side_bonded || (entry >= 0 && stage[pair_of(entry)] == Stage::dormant);
  }
  BR_HD Index corner_at(Index element, Index vertex) const {
    Index node = Shape::corners * element;
    for (int k = 1; k < Shape::corners && vertex_of[node] != vertex; ++k) ++node;
    return node;
  }
  BR_HD Index first_of(Index k) const {
    while (leader[k] != k) k = leader[k];
    return k;
  }
};

/// The kernel that looks which joints must wake.
template <class World>
auto overshoot_kernel(World& w) {
  const auto sleeper = sleeper_of(w);
  return Overshoot<std::remove_cv_t<decltype(sleeper)>>{sleeper, w.overshoot.view(),
                                                        w.reached.view()};
}

/// Launches ahead that look which joints must wake, and ask the host to do it.
template <class World, class By>
void watch_for_waking(World& w, const By& by, std::int32_t* host_request, std::int32_t wanted) {
  if (!w.given->extrinsic) return;
  for_each(w.exec, ShapeOf<World>::elements(w).size(), by(stress_kernel(w)));
  for_each(w.exec, w.joints.size(), by(overshoot_kernel(w)));
  for_each(w.exec, 1, by(WatchReached{std::as_const(w.reached).view(), host_request, wanted}));
}

}  // namespace breccia::fdem_shared
