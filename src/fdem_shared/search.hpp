#pragma once
// New couples: the shared search over the elements that can touch, less the neighbours that are
// still joined, with the history of those that stay. Made for each method in its
// contact/search.cpp.

#include <algorithm>

#include "core/broad_phase.hpp"
#include "core/energy.hpp"
#include "core/incidence.hpp"
#include "core/pair_list.hpp"
#include "core/travel.hpp"
#include "domain/drift.hpp"
#include "domain/owned.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/open_vertices.hpp"
#include "fdem_shared/ranks.hpp"
#include "fdem_shared/separated.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/wanted.hpp"

namespace breccia::fdem_shared {

/// Starts the travel of an element anew and boxes it with its margin and what counts as near.
template <class Shape>
struct BeginReach {
  using Vector = typename Shape::Vector;
  double skin, horizon, largest;  ///<  [m], [s], [m]
  DriftOf<Vector> drift;
  View<const Index> touchable;
  View<const typename Shape::Nodes> nodes;
  View<const typename Shape::Reference> shape;
  View<const GlobalId> id_of;
  View<typename Shape::CornersOfElement> reference;
  View<double> margin;
  View<Box> boxes;
  View<GlobalId> ids;
  BR_HD void operator()(Index i) const {
    const Index t = touchable[i];
    const typename Shape::Nodes& now = nodes[t];
    double fastest = 0.0, extent = 0.0;
    constexpr double far = 1e300;
    Vector low = from_space<Vector>({far, far, far}), high = -low;
    for (int k = 0; k < Shape::corners; ++k) {
      const Vector& x = now.at[k].position;
      fastest = max(fastest, norm(now.at[k].velocity - drift.velocity));
      for (int axis = 0; axis < Shape::dimension; ++axis) {
        const double along = part_of(x, axis);
        extent = max(extent, abs(along));
        part_of(low, axis) = min(part_of(low, axis), along);
        part_of(high, axis) = max(part_of(high, axis), along);
      }
      reference[i].at[k] = x;
    }
    const double own = min(0.5 * skin + fastest * horizon, largest);
    // covers rounding
    const double grown =
        (own + Shape::near(shape[t])) * (1.0 + 1e-12) + 1e-15 * (extent + drift.farthest);
    const Vector by = from_space<Vector>({grown, grown, grown});
    margin[i] = own;
    boxes[i] = {to_space(low - by), to_space(high + by)};
    ids[i] = id_of[t];
  }
};

/// From places in the list of elements that can touch to elements.
struct NameElements {
  static constexpr const char* name = "fdem.name_elements";
  View<const Index> touchable;
  View<Index> a, b;
  BR_HD void operator()(Index i) const {
    a[i] = touchable[a[i]];
    b[i] = touchable[b[i]];
  }
};

/// Contribution of an element's corners to the common motion.
template <class Shape>
struct MotionOf {
  View<const typename Shape::Nodes> nodes;
  BR_HD CommonMotion operator()(Index t) const {
    CommonMotion motion;
    for (const auto& n : nodes[t].at) motion.add(to_space(n.velocity));
    return motion;
  }
};

/// Energy spent by couples that leave the list.
template <class State>
struct SpentBy {
  View<const Index> couple;
  View<const State> state;
  BR_HD Energies operator()(Index k) const {
    Energies spent;
    const State& s = state[couple[k]];
    spent.friction.add(s.rubbed + (s.slid + s.sprung));
    spent.contact.add(s.lost + s.work - (s.slid + s.sprung));
    return spent;
  }
};

/// The joint between the elements of a couple, if it broke lately, or -1: sides that meet again
/// later begin anew.
template <class Shape, class Times>
struct ParentJoint {
  static constexpr const char* name = "fdem.parent_joint";
  double lately;  ///< the time from which on a break counts  [s]
  View<const Index> a, b;
  View<const typename Shape::Sides> sides;
  View<const Index> side_a, side_b;
  Times broke_at;
  View<Index> parent_joint;
  BR_HD void operator()(Index i) const {
    parent_joint[i] = -1;
    for (int k = 0; k < Shape::corners; ++k) {
      const Index entry = sides[a[i]].at[k];
      if (entry < 0) continue;
      const Index joint = pair_of(entry);
      const Index other = (side_of(entry) == 0 ? side_b[joint] : side_a[joint]) / Shape::corners;
      if (other == b[i] && broke_at[joint] >= lately) parent_joint[i] = joint;
    }
  }
};

struct NoPlace {
  View<Index> place;
  BR_HD void operator()(Index t) const { place[t] = -1; }
};
struct PlaceReach {
  View<const Index> touchable;
  View<Index> place;
  BR_HD void operator()(Index i) const { place[touchable[i]] = i; }
};

template <class World>
void book_dropped(World& w, const Pairs& found) {
  Buffer<Index> dropped(w.exec.space);
  find_dropped(w.exec, w.couples.pairs.key, found.key, dropped);
  if (dropped.empty()) return;
  const auto state = std::as_const(w.couples.history.state).view();
  const View<const Index> gone = std::as_const(dropped).view();
  w.ledger.book(fold_owned(w.exec, w.domain, dropped.size(), Energies{},
                           SpentBy<std::remove_cvref_t<decltype(state[0])>>{gone, state}, Sum{},
                           SelectedElement{gone, std::as_const(w.couples.pairs.a).view()}));
}

/// The drift from now on.
template <class World>
auto choose_drift(const World& w) {
  using Shape = ShapeOf<World>;
  const auto& e = Shape::elements(w);
  const CommonMotion own = fold_owned(w.exec, w.domain, e.size(), CommonMotion{},
                                      MotionOf<Shape>{e.nodes.view()}, Sum{});
  const Drift all = of_all_ranks(w.domain, own).drift(w.time, 1000.0 * w.given->mean_edge);
  using Vector = typename Shape::Vector;
  return DriftOf<Vector>{from_space<Vector>(all.velocity), all.since, all.farthest};
}

/// The place in `reach` of each element; -1: it has none.
/// @param ghosts  whether ghosts have places, too
template <class World>
void place_in_reach(World& w, bool ghosts, Buffer<Index>& place) {
  const auto touchable = std::as_const(w.reach.element).view();
  place.resize(ShapeOf<World>::elements(w).size());
  for_each(w.exec, place.size(), NoPlace{place.view()});
  const PlaceReach put{touchable, place.view()};
  if (ghosts)
    for_each(w.exec, touchable.size, put);
  else
    for_each_owned(w.exec, w.domain, touchable.size, put, ListedElement<>{touchable});
}

/// Boxes of the elements that can touch, and pairs of them whose boxes overlap.
template <class World>
Pairs boxes_that_overlap(World& w, const OpenVertices& vertices) {
  using Shape = ShapeOf<World>;
  auto& e = Shape::elements(w);
  Buffer<Index>& touchable = w.reach.element;
  const auto holds = w.given->holds.view();
  touchable = items_where(w.exec, e.size(),
                          Touchable<Shape, std::remove_cvref_t<decltype(holds[0])>>{
                              vertices, std::as_const(e.hold).view(), holds});
  const Index count = touchable.size();
  w.reach.reference.resize(count);
  w.reach.margin.resize(count);
  Buffer<Box> boxes(w.exec.space, count);
  Buffer<GlobalId> ids(w.exec.space, count);
  const MarginRule rule = margin_rule(w);
  for_each(
      w.exec, count,
      BeginReach<Shape>{rule.base, rule.horizon, rule.largest, w.reach.drift,
                        std::as_const(touchable).view(), std::as_const(e.nodes).view(),
                        std::as_const(Shape::reference(e)).view(), std::as_const(e.id).view(),
                        w.reach.reference.view(), w.reach.margin.view(), boxes.view(), ids.view()});
  Pairs found(w.exec.space);
  if (count > 0) w.broad_phase.search(w.exec, boxes, ids, found);
  for_each(w.exec, found.size(),
           NameElements{std::as_const(touchable).view(), found.a.view(), found.b.view()});
  return found;
}

/// Leaves out the pairs that cannot come near each other before the next search.
template <class World>
void drop_separated(World& w, Pairs& found) {
  using Shape = ShapeOf<World>;
  Buffer<Index> place(w.exec.space);
  place_in_reach(w, true, place);
  const auto& last = w.couples;
  const auto state = last.history.state.view();
  const Buffer<Index> near =
      items_where(w.exec, found.size(),
                  MayBeNear<Shape, std::remove_cvref_t<decltype(state[0])>>{
                      std::as_const(found.a).view(), std::as_const(found.b).view(),
                      std::as_const(found.key).view(), std::as_const(place).view(),
                      std::as_const(w.reach.reference).view(), std::as_const(w.reach.margin).view(),
                      std::as_const(Shape::reference(Shape::elements(w))).view(),
                      last.pairs.key.view(), state});
  gather_fields(w.exec, near, found);
}

/// The couples that may touch, or be near each other, until the next search, and those that may
/// once expected marks are there.
template <class World>
void search(World& w) {
  using Shape = ShapeOf<World>;
  expect_marks(w);
  const OpenVertices vertices = expected_vertices(w);
  Pairs found = boxes_that_overlap(w, vertices);
  const auto stage = std::as_const(w.joints.stage).view();
  const View<const Index> a = std::as_const(found.a).view(), b = std::as_const(found.b).view();
  const Buffer<Index> kept =
      items_where(w.exec, found.size(),
                  of_either_owned(w.domain, a, b,
                                  MayTouch<Shape, std::remove_cvref_t<decltype(stage[0])>>{
                                      vertices, std::as_const(Shape::sides(w)).view(), stage,
                                      Shape::exposed_sides(w), a, b, true}));
  gather_fields(w.exec, kept, found);
  if constexpr (Shape::drops_separated) drop_separated(w, found);
  book_dropped(w, found);
  w.couples.replace(w.exec, std::move(found));
  derive_couples(w);
  w.graph.clear();
  ++w.searches;
}

/// Flags of Change that are set, as bits.
template <class World>
std::uint64_t changed_bits(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.exposed.changed);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < changed.size(); ++i)
    if (changed[i] != 0) bits |= std::uint64_t{1} << i;
  return bits;
}
/// Of what ranks ask each other after a move: some margin is used up.
inline constexpr std::uint64_t margin_bit = 4;

/// Whether a search is due on some rank; what joints tell becomes known to all.
template <class World>
bool any_rank_is_due(World& w) {
  const std::uint64_t bits = w.domain.ranks->finish_any_of();
  std::vector<std::uint8_t> changed(static_cast<std::size_t>(w.exposed.changed.size()));
  for (std::size_t i = 0; i < changed.size(); ++i) changed[i] = (bits >> i & 1) != 0 ? 1 : 0;
  copy_to(w.exposed.changed, changed);
  w.margin_used = (bits & margin_bit) != 0;
  return marking_is_due(w) || w.margin_used;
}

/// Change bits on a device, as its move has noted them, and whether a margin is used up.
template <class World>
std::uint64_t noted_bits(World& w) {
  std::int32_t flags[2];
  peek_marked_bytes(flags, w.device_flags.data(), w.exec.space, sizeof flags);
  w.margin_used = flags[0] == request_search;
  w.marks_due = flags[0] == request_marks;
  if (flags[0] != 0) clear_bytes(w.device_flags.data(), w.exec.space, sizeof flags[0]);
  return static_cast<std::uint64_t>(flags[1]);
}

/// Asks all ranks whether couples must be searched for,
template <class World>
void ask_mesh_for_search(World& w) {
  const bool on_device = w.exec.space != Space::host;
  if (w.domain.single_rank() && !on_device) return;
  const StageTime timed(w.exec, "travel");
  const std::uint64_t changed = on_device ? noted_bits(w) : changed_bits(w);
  if (!w.domain.single_rank())
    w.domain.ranks->start_any_of(changed | (w.margin_used ? margin_bit : 0));
}
/// and hears what they say.
template <class World>
bool mesh_couples_are_due(World& w) {
  const StageTime timed(w.exec, "travel");
  if (!w.domain.single_rank()) return any_rank_is_due(w);
  // On a device the move has looked at the marks, too.
  return w.margin_used || (w.exec.space == Space::host ? marking_is_due(w) : w.marks_due);
}

template <class World>
MarginRule mesh_margin_rule(const World& w) {
  constexpr double horizon = 30.0;  // steps for which a fast element's margin shall last
  return {w.given->skin, horizon * w.next_dt, 0.5 * w.given->mean_edge};
}

/// Shares elements out anew where some have left their buffer, and searches.
template <class World>
void find_mesh_couples(World& w) {
  using Shape = ShapeOf<World>;
  w.domain.drift(to_space(w.reach.drift.velocity), w.time);  // up to now
  w.reach.drift = choose_drift(w);
  migrate(w);
  const StageTime timed(w.exec, "contact_detection");
  const bool joints_changed = marking_is_due(w);
  if (joints_changed) {
    Buffer<std::uint8_t> marked = damaged_vertices(w);
    mark_vertices(w, marked);
    Shape::note_exposed(w);
  }
  collective_try(w.domain.ranks, [&w] { search(w); });
  select_active_ghosts(w);
  if (joints_changed && w.next_dt > 0.0) w.next_dt = step_shortened_by_marks(w);
}

template <class World>
auto parent_joints(World& w) {
  using Shape = ShapeOf<World>;
  const Pairs& pairs = std::as_const(w.couples).pairs;
  const auto& j = std::as_const(w.joints);
  const auto broke = times_of_break(j);
  return ParentJoint<Shape, std::remove_const_t<decltype(broke)>>{
      w.time - 1.5 * w.last_dt,
      pairs.a.view(),
      pairs.b.view(),
      std::as_const(Shape::sides(w)).view(),
      Shape::side_a(j).view(),
      Shape::side_b(j).view(),
      broke,
      w.parent_joint.view()};
}
/// Takes the marks of this step over without a search, if all were expected and no margin is used
/// up; a joint that broke asks for a search. All ranks answer alike.
/// @returns false, with nothing done, if a search is due
template <class World>
bool follow_mesh_marks(World& w) {
  if (w.margin_used) return false;
  const StageTime timed(w.exec, "contact_detection");
  if (any_joint_broke(w)) return false;
  Buffer<std::uint8_t> marked = damaged_vertices(w);
  if (fold(w.exec, marked.size(), 0,
           NotExpected{std::as_const(marked).view(), std::as_const(w.exposed.vertex).view()},
           Sum{}) != 0)
    return false;
  mark_vertices(w, marked);
  const auto may_touch = may_touch_now(w);
  const auto parents = parent_joints(w);
  for_each(
      w.exec, w.couples.size(),
      OpenWaiting<std::remove_const_t<decltype(may_touch)>, std::remove_const_t<decltype(parents)>>{
          may_touch, parents, w.couple_phase.view()});
  w.held_couples.known = false;
  if (w.next_dt > 0.0) w.next_dt = step_shortened_by_marks(w);
  return true;
}

/// Fills what follows from the couples.
template <class World>
void derive_mesh_couples(World& w) {
  using Shape = ShapeOf<World>;
  const Pairs& pairs = w.couples.pairs;
  build_incidence(w.exec, pairs.a, pairs.b, Shape::elements(w).id, w.couple_incidence);
  w.held_couples.known = false;
  w.parent_joint.resize(pairs.size());
  for_each(w.exec, pairs.size(), parent_joints(w));
  w.couple_phase.resize(pairs.size());
  const auto state = std::as_const(w.couples.history.state).view();
  const auto may_touch = may_touch_now(w);
  for_each(w.exec, pairs.size(),
           BeginPhases<std::remove_const_t<decltype(may_touch)>,
                       std::remove_cvref_t<decltype(state[0])>>{may_touch, state,
                                                                w.couple_phase.view()});
  // Ghosts have none in it: their owners tell of them.
  place_in_reach(w, false, w.reach_place);
}

}  // namespace breccia::fdem_shared
