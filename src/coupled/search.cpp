// Faces near spheres: the shared search over what can touch of both methods.

#include <algorithm>

#include "coupled/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::coupled {
namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

struct Candidates {
  std::vector<Box> boxes;
  std::vector<Index> item;  ///< sphere or tetrahedron
};

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}
Box around(const std::vector<Box>& boxes) {
  Box all{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (const Box& b : boxes) {
    all.low = {std::min(all.low.x, b.low.x), std::min(all.low.y, b.low.y),
               std::min(all.low.z, b.low.z)};
    all.high = {std::max(all.high.x, b.high.x), std::max(all.high.y, b.high.y),
                std::max(all.high.z, b.high.z)};
  }
  return all;
}
void keep_within(Candidates& of, const Box& box) {
  Candidates kept;
  for (std::size_t i = 0; i < of.boxes.size(); ++i)
    if (overlap(of.boxes[i], box)) {
      kept.boxes.push_back(of.boxes[i]);
      kept.item.push_back(of.item[i]);
    }
  of = std::move(kept);
}

/// Where a sphere may come until its method searches again, as the drifts stand now, and half the
/// way by which these may part.
Candidates boxes_of_spheres(const World& w, double more) {
  const dem::World& s = *w.spheres;
  const Vec3 way = s.travel.drift.way(s.time);
  Candidates of;
  for (Index e = 0; e < s.elements.size(); ++e) {
    if (dem::is_gone(s.elements.fixed.data()[e])) continue;
    const Vec3 centre = s.travel.reference.data()[e] + way;
    const double extent = norm(centre) + norm(way);
    const double grown =
        (s.elements.state.data()[e].radius + s.travel.margin.data()[e] + more) * (1.0 + 1e-12) +
        1e-15 * extent;
    const Vec3 by{grown, grown, grown};
    of.boxes.push_back({centre - by, centre + by});
    of.item.push_back(e);
  }
  return of;
}
/// Whether face k of a tetrahedron presses on spheres. Live joints are no border of matter: what
/// tells of them on both sides cancels but for what their opening takes (docs/theory-coupled.md,
/// 1).
bool presses(const fdem3::World& t, Index tetrahedron, Index k) {
  return (t.tetrahedra.exposed.data()[tetrahedron] >> k & 1) != 0 ||
         t.faces.data()[tetrahedron].at[k] >= 0;
}
bool presses(const fdem3::World& t, Index tetrahedron) {
  bool some = false;
  for (Index k = 0; k < 4; ++k) some = some || presses(t, tetrahedron, k);
  return some;
}
/// The faces of a tetrahedron that press, and those on the other side of its joints.
template <class List>
void list_faces(const fdem3::World& t, Index tetrahedron, const List& list) {
  for (Index k = 0; k < 4; ++k) {
    if (!presses(t, tetrahedron, k)) continue;
    list(4 * tetrahedron + k);
    const Index entry = t.faces.data()[tetrahedron].at[k];
    if (entry < 0) continue;
    const Index joint = pair_of(entry);
    const Index across =
        side_of(entry) == 0 ? t.joints.face_b.data()[joint] : t.joints.face_a.data()[joint];
    if (t.given->removed[at(t.tetrahedra.group.data()[across / 4])] == 0) list(across);
  }
}

Candidates boxes_of_tetrahedra(const World& w, double more) {
  const fdem3::World& t = *w.tetrahedra;
  const Vec3 way = t.reach.drift.way(t.time);
  Candidates of;
  for (Index i = 0; i < t.reach.element.size(); ++i) {
    const Index tetrahedron = t.reach.element.data()[i];
    if (!presses(t, tetrahedron)) continue;
    Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    double extent = 0.0;
    for (const Vec3& corner : t.reach.reference.data()[i].at) {
      const Vec3 x = corner + way;
      extent = std::max(extent, norm(x) + norm(way));
      box.low = {std::min(box.low.x, x.x), std::min(box.low.y, x.y), std::min(box.low.z, x.z)};
      box.high = {std::max(box.high.x, x.x), std::max(box.high.y, x.y), std::max(box.high.z, x.z)};
    }
    const double grown = (t.reach.margin.data()[i] + more) * (1.0 + 1e-12) + 1e-15 * extent;
    const Vec3 by{grown, grown, grown};
    of.boxes.push_back({box.low - by, box.high + by});
    of.item.push_back(tetrahedron);
  }
  return of;
}

/// How fast both drifts part.
double parting(const World& w) {
  return norm(w.spheres->travel.drift.velocity - w.tetrahedra->reach.drift.velocity);
}

/// Energies of touches that are no longer listed.
void book_dropped(World& w, const Buffer<PairKey>& kept) {
  Buffer<Index> dropped;
  find_dropped(w.spheres->exec, w.touches.pairs.key, kept, dropped);
  for (const Index i : dropped.host()) {
    const TouchState& state = w.touches.history.state.data()[i];
    w.ledger.friction.add(state.slid + state.rubbed);
    w.ledger.contact.add(state.lost + (state.work - state.slid));
  }
}

PairKey key_of(Index sphere, Index other) {
  return (static_cast<PairKey>(static_cast<std::uint32_t>(sphere)) << 32) |
         static_cast<std::uint32_t>(other);
}
Pairs pairs_of(const std::vector<PairKey>& keys) {
  std::vector<Index> a, b;
  for (const PairKey key : keys) {
    a.push_back(low_id(key));
    b.push_back(high_id(key));
  }
  Pairs pairs;
  copy_to(pairs.key, keys);
  copy_to(pairs.a, a);
  copy_to(pairs.b, b);
  return pairs;
}
void sort_once(std::vector<PairKey>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

}  // namespace

bool faces_are_due(const World& w) {
  const dem::World& s = *w.spheres;
  return w.last.of_spheres != s.searches || w.last.of_tetrahedra != w.tetrahedra->searches ||
         parting(w) * (s.time - w.last.time) > w.last.reach;
}

void find_faces(World& w) {
  const dem::World& s = *w.spheres;
  const fdem3::World& t = *w.tetrahedra;
  const StageTime timed(s.exec, "coupling_search");
  constexpr double horizon = 50.0;  // steps that drifts may part for
  const double reach = std::max(w.given->skin, horizon * s.next_dt * parting(w));
  w.last = {s.searches, t.searches, s.time, reach};
  Candidates spheres = boxes_of_spheres(w, 0.5 * reach);
  Candidates solids = boxes_of_tetrahedra(w, 0.5 * reach);
  keep_within(spheres, around(solids.boxes));
  keep_within(solids, around(spheres.boxes));

  std::vector<Box> boxes = spheres.boxes;
  boxes.insert(boxes.end(), solids.boxes.begin(), solids.boxes.end());
  const auto first = static_cast<Index>(spheres.boxes.size());
  std::vector<GlobalId> ids;
  for (std::size_t i = 0; i < boxes.size(); ++i) ids.push_back(static_cast<GlobalId>(i));
  Buffer<Box> all_boxes;
  Buffer<GlobalId> all_ids;
  copy_to(all_boxes, boxes);
  copy_to(all_ids, ids);
  Pairs found;
  BroadPhase broad_phase;
  if (!boxes.empty()) broad_phase.search(s.exec, all_boxes, all_ids, found);

  std::vector<PairKey> faces, touches;
  for (Index i = 0; i < found.size(); ++i) {
    const Index a = found.a.data()[i], b = found.b.data()[i];
    if (a >= first || b < first) continue;  // of one kind
    const Index sphere = spheres.item[at(a)], tetrahedron = solids.item[at(b - first)];
    list_faces(t, tetrahedron, [&](Index face) {
      faces.push_back(key_of(sphere, face));
      touches.push_back(key_of(sphere, t.tetrahedra.group.data()[face / 4]));
    });
  }
  sort_once(faces);
  sort_once(touches);
  Pairs near = pairs_of(faces), touching = pairs_of(touches);
  book_dropped(w, touching.key);
  w.faces.replace(s.exec, std::move(near));
  w.touches.replace(s.exec, std::move(touching));
  derive(w);
  ++w.searches;
}

namespace {

/// Lists rows of places: those with number r of `of`, for each r of `rows`, ascending.
void list_rows(const std::vector<Index>& rows, const std::vector<Index>& of, Buffer<Index>& starts,
               Buffer<Index>& places) {
  std::vector<Index> order(of.size()), first;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return of[at(a)] < of[at(b)]; });
  auto next = order.begin();
  for (const Index row : rows) {
    first.push_back(static_cast<Index>(next - order.begin()));
    while (next != order.end() && of[at(*next)] == row) ++next;
  }
  first.push_back(static_cast<Index>(next - order.begin()));
  copy_to(starts, first);
  copy_to(places, order);
}

std::vector<Index> merged(std::vector<Index> a, const std::vector<Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

}  // namespace

void derive(World& w) {
  std::vector<Index> of_faces, tied_spheres, tied;
  for (const Index face : w.faces.pairs.b.host()) of_faces.push_back(face / 4);
  for (const BallBond& bond : w.bonds.tie.host()) {
    tied_spheres.push_back(bond.sphere);
    tied.push_back(bond.tetrahedron);
  }
  const std::vector<Index> around_spheres = merged(of_faces, tied);
  copy_to(w.around.tetrahedron, around_spheres);
  list_rows(around_spheres, of_faces, w.around.face_starts, w.around.faces);
  list_rows(around_spheres, tied, w.around.bond_starts, w.around.bonds);

  const auto touching = w.touches.pairs.a.host(), near = w.faces.pairs.a.host();
  const std::vector<Index> spheres = merged({touching.begin(), touching.end()}, tied_spheres);
  std::vector<SphereRow> rows;
  std::vector<Index> row_of(touching.size());
  std::size_t touch = 0, face = 0, bond = 0;
  for (const Index sphere : spheres) {
    SphereRow row{sphere, static_cast<Index>(touch), 0, static_cast<Index>(face),
                  0,      static_cast<Index>(bond),  0};
    for (; touch < touching.size() && touching[touch] == sphere; ++touch)
      row_of[touch] = static_cast<Index>(rows.size());
    while (face < near.size() && near[face] == sphere) ++face;
    while (bond < tied_spheres.size() && tied_spheres[bond] == sphere) ++bond;
    row.touch_end = static_cast<Index>(touch);
    row.face_end = static_cast<Index>(face);
    row.bond_end = static_cast<Index>(bond);
    rows.push_back(row);
  }
  copy_to(w.rows, rows);
  copy_to(w.row_of_touch, row_of);
  w.bonded.resize(w.rows.size());
  w.pressed.clear();
  w.pressed.resize(w.faces.size());
  w.step.resize(w.around.tetrahedron.size());
}

}  // namespace breccia::coupled
