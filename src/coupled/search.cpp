// Faces near spheres: the shared search over what can touch of both methods.

#include <algorithm>

#include "core/select.hpp"
#include "coupled/sorted_keys.hpp"
#include "coupled/world.hpp"
#include "domain/owned.hpp"
#include "domain/together.hpp"
#include "exec/for_each.hpp"
#include "exec/timers.hpp"

namespace breccia::coupled {
namespace {

constexpr double far = 1e300;

BR_HD bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}
/// Overlaps none.
BR_HD Box no_box() {
  return {{far, far, far}, {-far, -far, -far}};
}
/// The box around both; of no numbers nothing is taken.
struct Around {
  BR_HD Box operator()(const Box& a, const Box& b) const {
    return {{min(b.low.x, a.low.x), min(b.low.y, a.low.y), min(b.low.z, a.low.z)},
            {max(b.high.x, a.high.x), max(b.high.y, a.high.y), max(b.high.z, a.high.z)}};
  }
};
/// @param margin  [m]  @param extent  coordinates, whose rounding is covered  [m]
BR_HD Box grown(const Box& box, double margin, double extent) {
  const double by = margin * (1.0 + 1e-12) + 1e-15 * extent;
  return {box.low - Vec3{by, by, by}, box.high + Vec3{by, by, by}};
}

/// Where a sphere may come until its method searches again, as the drifts stand now, and half the
/// way by which these may part.
struct BoxOfSphere {
  Vec3 way;     ///< of the drift  [m]
  double more;  ///< [m]
  View<const std::uint8_t> fixed;
  View<const Vec3> reference;
  View<const double> margin;
  View<const dem::ElementState> state;

  BR_HD Box operator()(Index e) const {
    if (dem::is_gone(fixed[e])) return no_box();
    const Vec3 centre = reference[e] + way;
    return grown({centre, centre}, state[e].radius + margin[e] + more, norm(centre) + norm(way));
  }
};

/// The faces that press on spheres. Live joints are no border of matter: what tells of them on both
/// sides cancels but for what their opening takes (docs/theory-coupled.md, 1).
struct PressingFaces {
  static constexpr int most = 8;  ///< of a tetrahedron and on the other side of its joints
  View<const std::uint8_t> exposed;
  View<const fdem3::FaceJoints> joints;
  View<const Index> face_a, face_b;
  View<const std::int16_t> body;
  View<const std::uint8_t> gone;  ///< 1: the body has been taken out

  BR_HD bool presses(Index tetrahedron, Index k) const {
    return (exposed[tetrahedron] >> k & 1) != 0 || joints[tetrahedron].at[k] >= 0;
  }
  BR_HD bool some(Index tetrahedron) const {
    return presses(tetrahedron, 0) || presses(tetrahedron, 1) || presses(tetrahedron, 2) ||
           presses(tetrahedron, 3);
  }
  /// @returns how many there are
  BR_HD int list(Index tetrahedron, Index (&faces)[most]) const {
    int count = 0;
    for (Index k = 0; k < 4; ++k) {
      if (!presses(tetrahedron, k)) continue;
      faces[count++] = 4 * tetrahedron + k;
      const Index entry = joints[tetrahedron].at[k];
      if (entry < 0) continue;
      const Index joint = pair_of(entry),
                  across = side_of(entry) == 0 ? face_b[joint] : face_a[joint];
      if (gone[body[across / 4]] == 0) faces[count++] = across;
    }
    return count;
  }
};

/// As BoxOfSphere, of a tetrahedron that can touch.
struct BoxOfTetrahedron {
  Vec3 way;     ///< of the drift  [m]
  double more;  ///< [m]
  PressingFaces pressing;
  View<const Index> tetrahedron;
  View<const fdem3::Corners> reference;
  View<const double> margin;

  BR_HD Box operator()(Index i) const {
    if (!pressing.some(tetrahedron[i])) return no_box();
    Box box = no_box();
    double extent = 0.0;
    for (int k = 0; k < 4; ++k) {
      const Vec3 x = reference[i].at[k] + way;
      extent = max(extent, norm(x) + norm(way));
      box = Around{}(box, {x, x});
    }
    return grown(box, margin[i] + more, extent);
  }
};

template <class Boxes>
struct Reaches {
  Boxes boxes;
  Box into;
  BR_HD bool operator()(Index i) const { return overlap(boxes(i), into); }
};
template <class Boxes>
struct BoxOfListed {
  Boxes boxes;
  View<const Index> listed;
  BR_HD Box operator()(Index i) const { return boxes(listed[i]); }
};
/// A sphere that may reach a tetrahedron.
struct NearSphere {
  Box box;
  Index number;
};
/// A tetrahedron that may be reached, with the faces that press on spheres.
struct NearSolid {
  Box box;
  Index number, count;
  Index face[PressingFaces::most];  ///< 4 number + k
  Index body[PressingFaces::most];
};
struct ListSpheres {
  static constexpr const char* name = "coupled.list_spheres";
  BoxOfListed<BoxOfSphere> boxes;
  View<const GlobalId> id;
  View<NearSphere> near;
  BR_HD void operator()(Index i) const { near[i] = {boxes(i), id[boxes.listed[i]]}; }
};
struct ListSolids {
  static constexpr const char* name = "coupled.list_solids";
  BoxOfListed<BoxOfTetrahedron> boxes;
  View<const GlobalId> id;
  View<NearSolid> near;
  BR_HD void operator()(Index i) const {
    const BoxOfTetrahedron& of = boxes.boxes;
    const Index t = of.tetrahedron[boxes.listed[i]];
    NearSolid solid{};
    solid.box = boxes(i);
    solid.number = id[t];
    Index faces[PressingFaces::most];
    solid.count = of.pressing.list(t, faces);
    for (Index k = 0; k < solid.count; ++k) {
      solid.face[k] = 4 * id[faces[k] / 4] + faces[k] % 4;
      solid.body[k] = of.pressing.body[faces[k] / 4];
    }
    near[i] = solid;
  }
};
/// Of all ranks, in the order of their numbers.
template <class Near>
void bring_together(const Domain& domain, Buffer<Near>& near) {
  if (domain.single_rank()) return;
  std::vector<Near> own;
  copy_to(own, near);
  std::vector<Near> all = joined(*domain.ranks, own);
  std::sort(all.begin(), all.end(),
            [](const Near& a, const Near& b) { return a.number < b.number; });
  copy_to(near, all);
}
/// Around the boxes of all ranks.
Box around_all(const Domain& domain, const Box& own) {
  if (domain.single_rank()) return own;
  Communicator& ranks = *domain.ranks;
  const auto least = [&](const Vec3& v) {
    return Vec3{ranks.least(v.x), ranks.least(v.y), ranks.least(v.z)};
  };
  return {least(own.low), -least(-own.high)};
}

template <class Near>
struct PlaceBoxes {
  static constexpr const char* name = "coupled.place_boxes";
  View<const Near> near;
  Index first;
  View<Box> boxes;
  View<GlobalId> ids;
  BR_HD void operator()(Index i) const {
    boxes[first + i] = near[i].box;
    ids[first + i] = first + i;
  }
};

/// Spheres and tetrahedra of all ranks whose boxes overlap, as pairs of boxes: first the spheres'.
struct Candidates {
  Buffer<NearSphere> spheres;
  Buffer<NearSolid> solids;
  Pairs pairs;
};

Candidates candidates(World& w, const BoxOfSphere& spheres, const BoxOfTetrahedron& solids) {
  const Exec& exec = w.spheres->exec;
  const Domain &of_spheres = w.spheres->domain, &of_solids = w.tetrahedra->domain;
  const Index balls = w.spheres->elements.size(), reaching = w.tetrahedra->reach.element.size();
  const ListedElement<> tetrahedron{solids.tetrahedron};
  Candidates c{Buffer<NearSphere>(exec.space), Buffer<NearSolid>(exec.space), Pairs(exec.space)};

  const Box around_solids = around_all(
      of_solids, fold_owned(exec, of_solids, reaching, no_box(), solids, Around{}, tetrahedron));
  const Buffer<Index> balls_near = items_where(
      exec, balls, of_owned(of_spheres, false, Reaches<BoxOfSphere>{spheres, around_solids}));
  const BoxOfListed<BoxOfSphere> near{spheres, balls_near.view()};
  const Box around_spheres =
      around_all(of_spheres, fold(exec, balls_near.size(), no_box(), near, Around{}));
  const Buffer<Index> solids_near = items_where(
      exec, reaching,
      of_owned(of_solids, false, Reaches<BoxOfTetrahedron>{solids, around_spheres}, tetrahedron));

  c.spheres.resize(balls_near.size());
  for_each(exec, c.spheres.size(),
           ListSpheres{near, std::as_const(w.spheres->elements.id).view(), c.spheres.view()});
  c.solids.resize(solids_near.size());
  for_each(exec, c.solids.size(),
           ListSolids{{solids, solids_near.view()},
                      std::as_const(w.tetrahedra->tetrahedra.id).view(),
                      c.solids.view()});
  bring_together(of_spheres, c.spheres);
  bring_together(of_solids, c.solids);

  const Index first = c.spheres.size(), all = first + c.solids.size();
  Buffer<Box> boxes(exec.space, all);
  Buffer<GlobalId> ids(exec.space, all);
  for_each(exec, first,
           PlaceBoxes<NearSphere>{std::as_const(c.spheres).view(), 0, boxes.view(), ids.view()});
  for_each(exec, c.solids.size(),
           PlaceBoxes<NearSolid>{std::as_const(c.solids).view(), first, boxes.view(), ids.view()});
  if (all > 0) w.broad_phase.search(exec, boxes, ids, c.pairs);
  return c;
}

/// The tetrahedron of each pair of a sphere and a tetrahedron.
struct SolidOfPairs {
  Index first;  ///< box of a tetrahedron
  View<const Index> a, b;
  View<const NearSphere> spheres;
  View<const NearSolid> solids;

  /// Null: both are of one kind.
  BR_HD const NearSolid* operator()(Index i) const {
    return a[i] >= first || b[i] < first ? nullptr : &solids[b[i] - first];
  }
};
struct CountFaces {
  static constexpr const char* name = "coupled.count_faces";
  SolidOfPairs of;
  View<Index> count;
  BR_HD void operator()(Index i) const {
    const NearSolid* const solid = of(i);
    count[i] = solid == nullptr ? 0 : solid->count;
  }
};
struct ListFaces {
  static constexpr const char* name = "coupled.list_faces";
  SolidOfPairs of;
  View<const Index> starts;
  View<PairKey> faces, touches;
  BR_HD void operator()(Index i) const {
    const NearSolid* const solid = of(i);
    if (solid == nullptr) return;
    const Index sphere = of.spheres[of.a[i]].number;
    for (Index k = 0; k < solid->count; ++k) {
      faces[starts[i] + k] = key_of(sphere, solid->face[k]);
      touches[starts[i] + k] = key_of(sphere, solid->body[k]);
    }
  }
};

/// How fast both drifts part.
double parting(const World& w) {
  return norm(w.spheres->travel.drift.velocity - w.tetrahedra->reach.drift.velocity);
}

struct SpentByTouches {
  View<const Index> touch;
  View<const TouchState> state;
  BR_HD Energies operator()(Index i) const {
    const TouchState& kept = state[touch[i]];
    Energies spent;
    spent.friction.add(kept.slid + kept.rubbed);
    spent.contact.add(kept.lost + (kept.work - kept.slid));
    return spent;
  }
};
/// Energies of touches that are no longer listed.
void book_dropped(World& w, const Buffer<PairKey>& kept) {
  const Exec& exec = w.spheres->exec;
  Buffer<Index> dropped(exec.space);
  find_dropped(exec, w.touches.pairs.key, kept, dropped);
  if (dropped.empty()) return;
  w.ledger.book(fold(
      exec, dropped.size(), Energies{},
      SpentByTouches{std::as_const(dropped).view(), std::as_const(w.touches.history.state).view()},
      Sum{}));
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
  const Exec& exec = s.exec;
  tell_states(w);
  const StageTime timed(exec, "coupling_search");
  constexpr double horizon = 50.0;  // steps that drifts may part for
  const double reach = std::max(w.given->skin, horizon * s.next_dt * parting(w));
  w.last = {s.searches, t.searches, s.time, reach};

  Buffer<std::uint8_t> gone(exec.space);
  copy_to(gone, t.given->removed);
  const PressingFaces pressing{t.tetrahedra.exposed.view(), t.faces.view(),
                               t.joints.face_a.view(),      t.joints.face_b.view(),
                               t.tetrahedra.group.view(),   std::as_const(gone).view()};
  const Candidates near =
      candidates(w,
                 {s.travel.drift.way(s.time), 0.5 * reach, s.elements.fixed.view(),
                  s.travel.reference.view(), s.travel.margin.view(), s.elements.state.view()},
                 {t.reach.drift.way(t.time), 0.5 * reach, pressing, t.reach.element.view(),
                  t.reach.reference.view(), t.reach.margin.view()});

  const SolidOfPairs of{near.spheres.size(), near.pairs.a.view(), near.pairs.b.view(),
                        near.spheres.view(), near.solids.view()};
  Buffer<Index> starts(exec.space, near.pairs.size() + 1);
  for_each(exec, near.pairs.size(), CountFaces{of, starts.view()});
  const Index count = exclusive_scan(exec, starts);
  Buffer<PairKey> faces(exec.space, count), touches(exec.space, count);
  for_each(exec, near.pairs.size(),
           ListFaces{of, std::as_const(starts).view(), faces.view(), touches.view()});
  Pairs near_faces = pairs_of(exec, std::move(faces), w.given->spheres);
  Pairs touching = pairs_of(exec, std::move(touches), w.given->spheres);
  book_dropped(w, touching.key);
  w.faces.replace(exec, std::move(near_faces));
  w.touches.replace(exec, std::move(touching));
  derive(w);
  ++w.searches;
}

}  // namespace breccia::coupled
