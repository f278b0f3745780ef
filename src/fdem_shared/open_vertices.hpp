#pragma once
// Vertices at which joints are damaged: who may touch there, and which will soon.
//
// A step marks vertices where joints have softened or broken (exposed.hpp); elements around them
// may touch from then on. A whole search for each such step would be most of all searches. So a
// search lists couples ahead: those that may touch once joints are damaged that are about to be.
// They wait, without forces, until their vertices are marked. A search is due where a vertex was
// not expected, and where a joint broke: its sides meet as a couple then.

#include "core/select.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/couple_phase.hpp"
#include "fdem_shared/exposed.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/shared_marks.hpp"

namespace breccia::fdem_shared {

/// How the vertices of the mesh are open.
struct OpenVertices {
  View<const Index> vertex_of;              ///< of each node
  View<const std::uint8_t> border, marked;  ///< Case::open_vertex, ExposedVertices::vertex
  int counts = vertex_damaged;              ///< marks that do

  /// Case::open_vertex, and bit 2: a joint here is damaged.
  BR_HD int open(Index vertex) const {
    return border[vertex] | ((marked[vertex] & counts) != 0 ? 4 : 0);
  }
  /// Of all corners of an element together.
  template <class Shape>
  BR_HD int open_at(Index t) const {
    int open_here = 0;
    for (Index k = 0; k < Shape::corners; ++k) open_here |= open(vertex_of[Shape::corners * t + k]);
    return open_here;
  }
};

/// Marks the vertices of damaged joints, and of those at which a body has been taken out.
template <class Shape, class Stage>
struct MarkDamaged {
  static constexpr const char* name = "fdem.mark_damaged";
  View<const Stage> stage;
  View<const Index> side_a, vertex_of;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const {
    if (!is_damaged(stage[i]) && stage[i] != Stage::cut) return;
    const Index first = Shape::corners * (side_a[i] / Shape::corners);
    for (int k = 0; k < Shape::dimension; ++k)
      set_flag(marked, vertex_of[first + Shape::corner_of_side(side_a[i] % Shape::corners, k)]);
  }
};

/// Elements with a corner at the border, at a side that nothing joins, or at a damaged joint, but
/// those that have been taken out.
template <class Shape, class Hold>
struct Touchable {
  OpenVertices vertices;
  View<const Index> hold;
  View<const Hold> holds;
  BR_HD bool operator()(Index t) const {
    return !is_gone<Shape>(holds, hold[t]) && vertices.template open_at<Shape>(t) != 0;
  }
};

/// Whether a couple of the search can touch: two elements that both do. Neighbours across a side do
/// once nothing joins them; neighbours at an edge or a vertex do once a joint around it is damaged.
template <class Shape, class Stage>
struct MayTouch {
  OpenVertices vertices;
  View<const typename Shape::Sides> sides;
  View<const Stage> stage;
  View<const std::uint8_t> exposed;  ///< bits of sides that press; empty: all do
  View<const Index> a, b;
  bool ahead = false;  ///< by expected marks

  BR_HD bool operator()(Index i) const {
    const Index p = a[i], q = b[i];
    // A joint that breaks exposes its sides and calls for a search.
    if (exposed.size > 0 && (exposed[p] | exposed[q]) == 0) return false;
    int shared = 0, open = 0, apart = 0;  // apart: the corner of p that q lacks
    for (int k = 0; k < Shape::corners; ++k) {
      const Index vertex = vertices.vertex_of[Shape::corners * p + k];
      bool common = false;
      for (int m = 0; m < Shape::corners; ++m)
        common = common || vertex == vertices.vertex_of[Shape::corners * q + m];
      if (!common) {
        apart = k;
        continue;
      }
      ++shared;
      open |= vertices.open(vertex);
    }
    if (shared == 0)
      return ahead ||
             (vertices.template open_at<Shape>(p) != 0 && vertices.template open_at<Shape>(q) != 0);
    if (shared < Shape::dimension) return (open & 6) != 0;
    const Index entry = sides[p].at[Shape::side_opposite(apart)];
    if (entry < 0) return entry == Shape::side_free;
    return is_parted(stage[pair_of(entry)]);
  }
};

/// The mesh where kernels can read it.
template <class World>
OpenVertices open_vertices(World& w) {
  if (static_cast<std::size_t>(w.border_vertex.size()) != w.given->open_vertex.size())
    copy_to(w.border_vertex, w.given->open_vertex);
  return {node_vertices(w), std::as_const(w.border_vertex).view(),
          std::as_const(w.exposed.vertex).view()};
}

/// The vertices of damaged joints, on all ranks.
template <class World>
Buffer<std::uint8_t> damaged_vertices(World& w) {
  using Shape = ShapeOf<World>;
  const OpenVertices vertices = open_vertices(w);
  Buffer<std::uint8_t> marked(w.exec.space, static_cast<Index>(w.given->open_vertex.size()));
  const auto stage = std::as_const(w.joints.stage).view();
  for_each(
      w.exec, w.joints.size(),
      MarkDamaged<Shape, std::remove_cvref_t<decltype(stage[0])>>{
          stage, std::as_const(Shape::side_a(w.joints)).view(), vertices.vertex_of, marked.view()});
  share_marks(w, marked);
  return marked;
}
/// Expected marks stay where nothing is damaged.
struct KeepExpected {
  static constexpr const char* name = "fdem.keep_expected";
  View<const std::uint8_t> known;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index v) const {
    if (marked[v] == 0) marked[v] = known[v] & vertex_expected;
  }
};
/// Takes the marks of this step over.
template <class World>
void mark_vertices(World& w, Buffer<std::uint8_t>& marked) {
  for_each(w.exec, marked.size(),
           KeepExpected{std::as_const(w.exposed.vertex).view(), marked.view()});
  w.exposed.vertex.swap(marked);
  w.exposed.changed.clear();
  w.exposed.changed.resize(2);
}

/// Marks the vertices of joints that are about to be damaged.
template <class Shape, class Joints>
struct MarkExpected {
  static constexpr const char* name = "fdem.mark_expected";
  Joints joints;
  View<const Index> side_a, vertex_of;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const {
    if (!joints.is_about_to_soften(i)) return;
    const Index first = Shape::corners * (side_a[i] / Shape::corners);
    for (int k = 0; k < Shape::dimension; ++k)
      set_flag(marked, vertex_of[first + Shape::corner_of_side(side_a[i] % Shape::corners, k)]);
  }
};

struct NoteExpected {
  static constexpr const char* name = "fdem.note_expected";
  View<const std::uint8_t> expected;
  View<std::uint8_t> vertex;
  BR_HD void operator()(Index v) const {
    if ((vertex[v] & vertex_damaged) == 0) vertex[v] = expected[v] != 0 ? vertex_expected : 0;
  }
};
/// Notes where marks are expected before the next search; all ranks know of the same vertices.
/// @param joints  the kernel of their forces
template <class World, class Joints>
void expect_marks_of(World& w, const Joints& joints) {
  using Shape = ShapeOf<World>;
  Buffer<std::uint8_t> expected(w.exec.space, w.exposed.vertex.size());
  for_each(w.exec, w.joints.size(),
           MarkExpected<Shape, Joints>{joints, std::as_const(Shape::side_a(w.joints)).view(),
                                       node_vertices(w), expected.view()});
  share_marks(w, expected);
  for_each(w.exec, expected.size(),
           NoteExpected{std::as_const(expected).view(), w.exposed.vertex.view()});
}
/// As open_vertices(), with the marks that are expected beside those that are there.
template <class World>
OpenVertices expected_vertices(World& w) {
  OpenVertices vertices = open_vertices(w);
  vertices.counts = vertex_damaged | vertex_expected;
  return vertices;
}

/// Whether a mark was not expected.
struct NotExpected {
  View<const std::uint8_t> marked, known;
  BR_HD int operator()(Index v) const { return marked[v] != 0 && known[v] == 0 ? 1 : 0; }
};

/// The couples that may touch, by the marks of now.
template <class World>
auto may_touch_now(World& w) {
  using Shape = ShapeOf<World>;
  const auto stage = std::as_const(w.joints.stage).view();
  return MayTouch<Shape, std::remove_cvref_t<decltype(stage[0])>>{
      open_vertices(w),
      std::as_const(Shape::sides(w)).view(),
      stage,
      Shape::exposed_sides(w),
      w.couples.pairs.a.view(),
      w.couples.pairs.b.view()};
}

/// Whether an element can touch by the marks of now.
template <class World>
auto touchable_now(World& w) {
  const auto holds = w.given->holds.view();
  return Touchable<ShapeOf<World>, std::remove_cvref_t<decltype(holds[0])>>{
      open_vertices(w), std::as_const(ShapeOf<World>::elements(w).hold).view(), holds};
}

/// Couples that waited and may touch from now on. All that waits is new.
template <class Couples, class Parents>
struct OpenWaiting {
  static constexpr const char* name = "fdem.open_waiting";
  Couples may_touch;
  Parents parents;
  View<CouplePhase> phase;
  BR_HD void operator()(Index i) const {
    if (phase[i] != CouplePhase::waits || !may_touch(i)) return;
    phase[i] = CouplePhase::acts;
    parents(i);
  }
};
/// The phases of couples that a search has listed.
template <class Couples, class State>
struct BeginPhases {
  static constexpr const char* name = "fdem.begin_phases";
  Couples may_touch;
  View<const State> state;
  View<CouplePhase> phase;
  BR_HD void operator()(Index i) const {
    phase[i] = state[i].scale == 0.0 && !may_touch(i) ? CouplePhase::waits : CouplePhase::acts;
  }
};

template <class World>
bool any_joint_broke(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.exposed.changed);
  return changed[change_broken] != 0;
}
/// Whether vertices must be marked now.
template <class World>
bool marking_is_due(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.exposed.changed);
  return marking_due(changed[change_softened], changed[change_broken], w.step);
}

}  // namespace breccia::fdem_shared
