// New couples: the shared search over the triangles that can touch, less the neighbours that are
// still joined, with the history of those that stay.

#include <algorithm>

#include "core/select.hpp"
#include "fdem/contact/search_kernels.hpp"
#include "fdem/contact/shared_marks.hpp"
#include "fdem/ranks.hpp"

namespace breccia::fdem {
namespace {

/// Starts the travel of a triangle anew and boxes it with its margin and what counts as near.
struct BeginReach {
  double skin, horizon, largest;  ///<  [m], [s], [m]
  PlaneDrift drift;
  View<const Index> triangle;
  View<const TriangleNodes> nodes;
  View<const Mat2> shape_inverse;
  View<const GlobalId> id_of;
  View<Corners> reference;
  View<double> margin;
  View<Box> boxes;
  View<GlobalId> ids;
  BR_HD void operator()(Index i) const {
    const TriangleNodes& now = nodes[triangle[i]];
    double fastest = 0.0, extent = 0.0;
    for (const NodeState& n : now.at) {
      fastest = max(fastest, norm(n.velocity - drift.velocity));
      extent = max(extent, max(abs(n.position.x), abs(n.position.y)));
    }
    const double own = min(0.5 * skin + fastest * horizon, largest);
    Box box{{1e300, 1e300, 0.0}, {-1e300, -1e300, 0.0}};
    // covers rounding
    const double grown = (own + near_reach(shape_inverse[triangle[i]])) * (1.0 + 1e-12) +
                         1e-15 * (extent + drift.farthest);
    for (int k = 0; k < 3; ++k) {
      const Vec2& x = now.at[k].position;
      reference[i].at[k] = x;
      box.low.x = min(box.low.x, x.x - grown);
      box.low.y = min(box.low.y, x.y - grown);
      box.high.x = max(box.high.x, x.x + grown);
      box.high.y = max(box.high.y, x.y + grown);
    }
    margin[i] = own;
    boxes[i] = box;
    ids[i] = id_of[triangle[i]];
  }
};

/// The mesh where kernels can read it.
OpenVertices open_vertices(World& w) {
  if (static_cast<std::size_t>(w.border_vertex.size()) != w.given->open_vertex.size())
    copy_to(w.border_vertex, w.given->open_vertex);
  return {node_vertices(w), w.border_vertex.view(), std::as_const(w.exposed.vertex).view()};
}

/// Marks the vertices of damaged joints.
void mark_opened(World& w) {
  const OpenVertices vertices = open_vertices(w);
  Buffer<std::uint8_t> marked(w.exec.space, static_cast<Index>(w.given->open_vertex.size()));
  for_each(w.exec, w.joints.size(),
           MarkDamaged{std::as_const(w.joints.stage).view(), w.joints.edge_a.view(),
                       vertices.vertex_of, marked.view()});
  share_marks(w, marked);
  w.exposed.vertex.swap(marked);
  copy_to(w.exposed.changed, std::vector<std::uint8_t>{0, 0});
}

/// Whether vertices must be marked now: at once when a joint breaks, since its triangles touch from
/// the next step on; when one softens, at the next of these steps.
bool marking_is_due(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.exposed.changed);
  return marking_due(changed[change_softened], changed[change_broken], w.step);
}

void book_dropped(World& w, const Pairs& found) {
  Buffer<Index> dropped(w.exec.space);
  find_dropped(w.exec, w.couples.pairs.key, found.key, dropped);
  if (dropped.empty()) return;
  w.ledger.book(fold(w.exec, dropped.size(), Energies{},
                     SpentBy{std::as_const(dropped).view(), w.couples.pairs.a.view(),
                             std::as_const(w.couples.history.state).view(), w.domain.owned_view()},
                     Sum{}));
}

/// The drift from now on.
PlaneDrift choose_drift(const World& w) {
  const CommonMotion own = fold(w.exec, w.triangles.size(), CommonMotion{},
                                MotionOf{w.triangles.nodes.view(), w.domain.owned_view()}, Sum{});
  const Drift all = of_all_ranks(w.domain, own).drift(w.time, 1000.0 * w.given->mean_edge);
  return {{all.velocity.x, all.velocity.y}, all.since, all.farthest};
}

/// Flags of Change that are set, as bits.
std::uint64_t changed_bits(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.exposed.changed);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < changed.size(); ++i)
    if (changed[i] != 0) bits |= std::uint64_t{1} << i;
  return bits;
}

/// Change bits on a device, as its move has noted them, and whether a margin is used up.
std::uint64_t noted_bits(World& w) {
  std::int32_t flags[2];
  peek_marked_bytes(flags, w.device_flags.data(), w.exec.space, sizeof flags);
  w.margin_used = flags[0] != 0;
  if (w.margin_used) clear_bytes(w.device_flags.data(), w.exec.space, sizeof flags[0]);
  return static_cast<std::uint64_t>(flags[1]);
}

/// Whether a search is due on some rank; what joints tell becomes known to all.
bool any_rank_is_due(World& w) {
  const std::uint64_t bits = w.domain.ranks->finish_any_of();
  std::vector<std::uint8_t> changed(static_cast<std::size_t>(w.exposed.changed.size()));
  for (std::size_t i = 0; i < changed.size(); ++i) changed[i] = (bits >> i & 1) != 0 ? 1 : 0;
  copy_to(w.exposed.changed, changed);
  return marking_is_due(w) || (bits & 4) != 0;
}

struct NoPlace {
  View<Index> place;
  BR_HD void operator()(Index t) const { place[t] = -1; }
};
struct PlaceReach {
  View<const Index> triangle;
  OwnedView owned;
  View<Index> place;
  BR_HD void operator()(Index i) const {
    if (owned(triangle[i])) place[triangle[i]] = i;
  }
};
/// The place in `reach` of each triangle. Ghosts have none: their owners tell of them.
void place_reach(World& w) {
  w.reach_place.resize(w.triangles.size());
  for_each(w.exec, w.triangles.size(), NoPlace{w.reach_place.view()});
  for_each(w.exec, w.reach.triangle.size(),
           PlaceReach{std::as_const(w.reach.triangle).view(), w.domain.owned_view(),
                      w.reach_place.view()});
}

/// The couples that may touch, or be near each other, until the next search.
void search(World& w) {
  const OpenVertices vertices = open_vertices(w);
  w.reach.triangle = items_where(
      w.exec, w.triangles.size(),
      Touchable{vertices, std::as_const(w.triangles.hold).view(), w.given->holds.view()});
  const Index count = w.reach.triangle.size();
  w.reach.reference.resize(count);
  w.reach.margin.resize(count);
  Buffer<Box> boxes(w.exec.space, count);
  Buffer<GlobalId> ids(w.exec.space, count);
  const MarginRule rule = margin_rule(w);
  for_each(
      w.exec, count,
      BeginReach{rule.base, rule.horizon, rule.largest, w.reach.drift,
                 std::as_const(w.reach.triangle).view(), std::as_const(w.triangles.nodes).view(),
                 w.triangles.shape_inverse.view(), std::as_const(w.triangles.id).view(),
                 w.reach.reference.view(), w.reach.margin.view(), boxes.view(), ids.view()});
  Pairs found(w.exec.space);
  if (count > 0) w.broad_phase.search(w.exec, boxes, ids, found);

  for_each(w.exec, found.size(),
           NameTriangles{std::as_const(w.reach.triangle).view(), found.a.view(), found.b.view()});
  const Buffer<Index> kept =
      items_where(w.exec, found.size(),
                  MayTouch{vertices, w.edges.view(), std::as_const(w.joints.stage).view(),
                           w.domain.owned_view(), std::as_const(found.a).view(),
                           std::as_const(found.b).view()});
  gather_fields(w.exec, kept, found);
  book_dropped(w, found);
  w.couples.replace(w.exec, std::move(found));
  derive_couples(w);
  w.graph.clear();
  ++w.searches;
}

}  // namespace

MarginRule margin_rule(const World& w) {
  constexpr double horizon = 30.0;  // steps for which a fast triangle's margin shall last
  return {w.given->skin, horizon * w.next_dt, 0.5 * w.given->mean_edge};
}

void ask_for_search(World& w) {
  const bool on_device = w.exec.space != Space::host;
  if (w.domain.single_rank() && !on_device) return;
  const StageTime timed(w.exec, "travel");
  const std::uint64_t changed = on_device ? noted_bits(w) : changed_bits(w);
  if (!w.domain.single_rank()) w.domain.ranks->start_any_of(changed | (w.margin_used ? 4 : 0));
}

bool couples_are_due(World& w) {
  const StageTime timed(w.exec, "travel");
  if (!w.domain.single_rank()) return any_rank_is_due(w);
  return w.margin_used || marking_is_due(w);
}

void find_couples(World& w) {
  const Vec2 drift = w.reach.drift.velocity;  // up to now
  w.domain.drift({drift.x, drift.y, 0.0}, w.time);
  w.reach.drift = choose_drift(w);
  migrate(w);
  const StageTime timed(w.exec, "contact_detection");
  const bool joints_changed = marking_is_due(w);
  if (joints_changed) mark_opened(w);
  collective_try(w.domain.ranks, [&w] { search(w); });
  select_active_ghosts(w);
  if (joints_changed && w.next_dt > 0.0) w.next_dt = shortened_time_step(w, w.reach.triangle);
}

void derive_couples(World& w) {
  const Pairs& pairs = w.couples.pairs;
  build_incidence(w.exec, pairs.a, pairs.b, w.triangles.id, w.couple_incidence);
  w.parent_joint.resize(pairs.size());
  const Joints& j = w.joints;
  for_each(w.exec, pairs.size(),
           BornOf{w.time - 1.5 * w.last_dt, pairs.a.view(), pairs.b.view(), w.edges.view(),
                  j.edge_a.view(), j.edge_b.view(), j.broke_at.view(), w.parent_joint.view()});
  place_reach(w);
}

}  // namespace breccia::fdem
