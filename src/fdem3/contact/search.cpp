// New couples: the shared search over the tetrahedra that can touch, less the neighbours that are
// still joined, with the history of those that stay.

#include <algorithm>

#include "core/select.hpp"
#include "fdem/contact/shared_marks.hpp"
#include "fdem3/contact/search_kernels.hpp"
#include "fdem3/ranks.hpp"

namespace breccia::fdem3 {
namespace {

std::vector<std::uint8_t> flags_of(const Buffer<std::uint8_t>& array) {
  std::vector<std::uint8_t> flags;
  copy_to(flags, array);
  return flags;
}

/// The mesh where kernels can read it.
OpenVertices open_vertices(World& w) {
  if (static_cast<std::size_t>(w.border_vertex.size()) != w.given->open_vertex.size())
    copy_to(w.border_vertex, w.given->open_vertex);
  if (static_cast<std::size_t>(w.node_vertex.size()) != w.vertex.size())
    copy_to(w.node_vertex, w.vertex);
  return {std::as_const(w.node_vertex).view(), std::as_const(w.border_vertex).view(),
          std::as_const(w.exposed.vertex).view()};
}

/// Marks the vertices of damaged joints.
void mark_opened(World& w) {
  const OpenVertices vertices = open_vertices(w);
  Buffer<std::uint8_t> marked(w.exec.space, static_cast<Index>(w.given->open_vertex.size()));
  for_each(w.exec, w.joints.size(),
           MarkDamaged{std::as_const(w.joints.stage).view(), std::as_const(w.joints.face_a).view(),
                       vertices.vertex_of, marked.view()});
  fdem::share_marks(w, marked);
  w.exposed.vertex.swap(marked);
  copy_to(w.exposed.changed, std::vector<std::uint8_t>{0, 0});
}

/// Ghosts hear from their owners which of their faces are exposed: not all their joints are here.
void note_exposed(World& w) {
  Tetrahedra& t = w.tetrahedra;
  for_each(w.exec, t.size(),
           NoteExposed{std::as_const(w.faces).view(), std::as_const(w.joints.stage).view(),
                       w.domain.owned_view(), t.exposed.view()});
  if (!w.domain.single_rank()) w.domain.halo.refresh(w.exec, *w.domain.ranks, t.exposed);
}

/// Whether vertices must be marked now.
bool marking_is_due(const World& w) {
  const std::vector<std::uint8_t> changed = flags_of(w.exposed.changed);
  return fdem::marking_due(changed[fdem::change_softened], changed[fdem::change_broken], w.step);
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
Drift choose_drift(const World& w) {
  const CommonMotion own = fold(w.exec, w.tetrahedra.size(), CommonMotion{},
                                MotionOf{w.tetrahedra.nodes.view(), w.domain.owned_view()}, Sum{});
  return of_all_ranks(w.domain, own).drift(w.time, 1000.0 * w.given->mean_edge);
}

struct NoPlace {
  View<Index> place;
  BR_HD void operator()(Index t) const { place[t] = -1; }
};
struct PlaceReach {
  View<const Index> tetrahedron;
  OwnedView owned;
  View<Index> place;
  BR_HD void operator()(Index i) const {
    if (owned(tetrahedron[i])) place[tetrahedron[i]] = i;
  }
};
/// The place in `reach` of each. Ghosts have none: their owners tell of them.
void place_reach(World& w) {
  w.reach_place.resize(w.tetrahedra.size());
  for_each(w.exec, w.tetrahedra.size(), NoPlace{w.reach_place.view()});
  for_each(w.exec, w.reach.tetrahedron.size(),
           PlaceReach{std::as_const(w.reach.tetrahedron).view(), w.domain.owned_view(),
                      w.reach_place.view()});
}

/// The couples that may touch, or be near each other, until the next search.
void search(World& w) {
  const OpenVertices vertices = open_vertices(w);
  w.reach.tetrahedron = items_where(w.exec, w.tetrahedra.size(), Touchable{vertices});
  const Index count = w.reach.tetrahedron.size();
  w.reach.reference.resize(count);
  w.reach.margin.resize(count);
  Buffer<Box> boxes(w.exec.space, count);
  Buffer<GlobalId> ids(w.exec.space, count);
  const MarginRule rule = margin_rule(w);
  for_each(w.exec, count,
           BeginReach{
               rule.base, rule.horizon, rule.largest, w.reach.drift,
               std::as_const(w.reach.tetrahedron).view(), std::as_const(w.tetrahedra.nodes).view(),
               std::as_const(w.tetrahedra.shape).view(), std::as_const(w.tetrahedra.id).view(),
               w.reach.reference.view(), w.reach.margin.view(), boxes.view(), ids.view()});
  Pairs found(w.exec.space);
  if (count > 0) w.broad_phase.search(w.exec, boxes, ids, found);

  for_each(w.exec, found.size(),
           fdem::NameTriangles{std::as_const(w.reach.tetrahedron).view(), found.a.view(),
                               found.b.view()});
  const Buffer<Index> kept = items_where(
      w.exec, found.size(),
      MayTouch{vertices, std::as_const(w.faces).view(), std::as_const(w.joints.stage).view(),
               std::as_const(w.tetrahedra.exposed).view(), w.domain.owned_view(),
               std::as_const(found.a).view(), std::as_const(found.b).view()});
  gather_fields(w.exec, kept, found);
  book_dropped(w, found);
  w.couples.replace(w.exec, std::move(found));
  derive_couples(w);
  ++w.searches;
}

}  // namespace

MarginRule margin_rule(const World& w) {
  constexpr double horizon = 30.0;  // steps for which a fast one's margin shall last
  return {w.given->skin, horizon * w.next_dt, 0.5 * w.given->mean_edge};
}

void ask_for_search(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "travel");
  const std::vector<std::uint8_t> changed = flags_of(w.exposed.changed);
  std::uint64_t bits = flags_of(w.beyond)[0] != 0 ? 4 : 0;
  for (std::size_t i = 0; i < changed.size(); ++i)
    if (changed[i] != 0) bits |= std::uint64_t{1} << i;
  w.domain.ranks->start_any_of(bits);
}

bool couples_are_due(World& w) {
  const StageTime timed(w.exec, "travel");
  if (w.domain.single_rank()) return flags_of(w.beyond)[0] != 0 || marking_is_due(w);
  const std::uint64_t bits = w.domain.ranks->finish_any_of();
  std::vector<std::uint8_t> changed(static_cast<std::size_t>(w.exposed.changed.size()));
  for (std::size_t i = 0; i < changed.size(); ++i) changed[i] = (bits >> i & 1) != 0 ? 1 : 0;
  copy_to(w.exposed.changed, changed);
  return marking_is_due(w) || (bits & 4) != 0;
}

void find_couples(World& w) {
  w.domain.drift(w.reach.drift.velocity, w.time);  // up to now
  w.reach.drift = choose_drift(w);
  migrate(w);
  const StageTime timed(w.exec, "contact_detection");
  const bool joints_changed = marking_is_due(w);
  if (joints_changed) {
    mark_opened(w);
    note_exposed(w);
  }
  collective_try(w.domain.ranks, [&w] { search(w); });
  select_active_ghosts(w);
  if (joints_changed && w.next_dt > 0.0) w.next_dt = shortened_time_step(w, w.reach.tetrahedron);
}

void derive_couples(World& w) {
  const Pairs& pairs = w.couples.pairs;
  build_incidence(w.exec, pairs.a, pairs.b, w.tetrahedra.id, w.couple_incidence);
  w.parent_joint.resize(pairs.size());
  const Joints& j = w.joints;
  for_each(w.exec, pairs.size(),
           BornOf{w.time - 1.5 * w.last_dt, pairs.a.view(), pairs.b.view(),
                  std::as_const(w.faces).view(), j.face_a.view(), j.face_b.view(),
                  j.broke_at.view(), w.parent_joint.view()});
  place_reach(w);
  w.beyond.resize(1);
}

}  // namespace breccia::fdem3
