#pragma once
// Extrinsic joints: where the stress between two elements that move as one reaches their joint's
// strength, the joint and those around its vertices wake, and carry from then on just what was
// transmitted. Made for each method in its joints/insertion.cpp.

#include <algorithm>
#include <set>

#include "core/select.hpp"
#include "domain/owned.hpp"
#include "domain/together.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/bundle_steps.hpp"
#include "fdem_shared/insertion_kernels.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem_shared {

template <class World>
using StageOf = std::remove_cvref_t<decltype(std::declval<World&>().joints.stage.view()[0])>;

template <class World>
VerticesOfJoints<ShapeOf<World>> vertices_of_joints(World& w) {
  return {ShapeOf<World>::side_a(std::as_const(w.joints)).view(), node_vertices(w)};
}

/// The joints of all ranks whose strength is reached, by their numbers in the whole mesh; each
/// tells of those whose side a it owns.
template <class World>
std::vector<Candidate<ShapeOf<World>>> candidates(World& w) {
  using Shape = ShapeOf<World>;
  const auto overshoot = std::as_const(w.overshoot).view();
  const VerticesOfJoints<Shape> vertices = vertices_of_joints(w);
  const Buffer<Index> reached =
      items_where(w.exec, w.joints.size(),
                  of_owned(w.domain, false, IsReached{overshoot},
                           ListedElement<Shape::corners>{vertices.side_a}));
  Buffer<Candidate<Shape>> listed(w.exec.space, reached.size());
  for_each(w.exec, reached.size(),
           ListCandidates<Shape>{reached.view(), overshoot, vertices, listed.view()});
  std::vector<Candidate<Shape>> own;
  copy_to(own, listed);
  if (w.domain.single_rank()) return own;
  for (Candidate<Shape>& c : own) c.joint = w.mesh.joint_number.data()[c.joint];
  return joined(*w.domain.ranks, own);
}

/// The vertices, ascending, of the most loaded of those joints, no two at one vertex: its waking
/// unloads the others around.
template <class World>
std::vector<Index> parted_vertices(World& w) {
  auto joints = candidates(w);
  std::sort(joints.begin(), joints.end(), [](const auto& a, const auto& b) {
    return a.overshoot != b.overshoot ? a.overshoot > b.overshoot : a.joint < b.joint;
  });
  std::set<Index> parted;
  for (const auto& c : joints)
    if (std::none_of(std::begin(c.vertex), std::end(c.vertex),
                     [&](Index vertex) { return parted.contains(vertex); }))
      parted.insert(std::begin(c.vertex), std::end(c.vertex));
  return {parted.begin(), parted.end()};
}

/// Which joints wake: all that share a vertex with the chosen ones. While the corners around a
/// vertex are tied, no joint opens there.
template <class World>
Buffer<Index> waking_joints(World& w) {
  Buffer<Index> parted(w.exec.space);
  copy_to(parted, parted_vertices(w));
  return items_where(w.exec, w.joints.size(),
                     SleepsAt<ShapeOf<World>, StageOf<World>>{std::as_const(w.joints.stage).view(),
                                                              vertices_of_joints(w),
                                                              {std::as_const(parted).view()}});
}

/// Elements and vertices whose joints have woken.
struct Woken {
  Buffer<Index> elements;       ///< where kernels can read them, some more than once
  std::vector<Index> vertices;  ///< ascending
};

/// Wakes joints and books what they then store.
template <class World>
Woken wake(World& w, const Buffer<Index>& joints) {
  using Shape = ShapeOf<World>;
  const Index count = joints.size();
  Buffer<double> held(w.exec.space, count);
  Buffer<Index> elements(w.exec.space, 2 * count), vertex(w.exec.space, Shape::dimension * count);
  const auto sleeper = sleeper_of(w);
  for_each(
      w.exec, count,
      Wake<Shape, std::remove_cv_t<decltype(sleeper)>>{
          sleeper, std::as_const(w.overshoot).view(), Shape::side_a(std::as_const(w.joints)).view(),
          Shape::side_b(std::as_const(w.joints)).view(), vertices_of_joints(w),
          w.domain.owned_view(), joints.view(), held.view(), elements.view(), vertex.view()});
  std::vector<double> stored;
  copy_to(stored, held);
  for (const double energy : stored) w.ledger.came_in.add(energy);
  std::vector<Index> vertices;
  copy_to(vertices, vertex);
  std::sort(vertices.begin(), vertices.end());
  return {std::move(elements), std::move(vertices)};
}

/// Marks the corners that rings hold.
template <class World>
void mark_ringed(World& w) {
  forget_apart(w);
  w.ringed.resize(0);
  if (w.bundles.nodes.size() == 0) return;
  w.ringed.resize(ShapeOf<World>::corners * ShapeOf<World>::elements(w).size());
  for_each(w.exec, w.bundles.nodes.size(), MarkRinged{w.bundles.nodes.view(), w.ringed.view()});
}

/// Ties the corners that move together, around all vertices or around changed ones.
template <class World>
void tie_corners(World& w, bool all, const std::vector<Index>& changed) {
  if (all) mark_ringed(w);
  if (w.bundles.starts.size() < 2) return;
  if (static_cast<std::size_t>(w.side_across.size()) != w.across.size())
    copy_to(w.side_across, w.across);
  Buffer<Index> there(w.exec.space);
  copy_to(there, changed);
  w.bundles.leader.resize(w.bundles.nodes.size());
  for_each(
      w.exec, w.bundles.starts.size() - 1,
      TieCorners<ShapeOf<World>, StageOf<World>>{w.bundles.starts.view(),
                                                 w.bundles.nodes.view(),
                                                 std::as_const(w.side_across).view(),
                                                 node_vertices(w),
                                                 std::as_const(ShapeOf<World>::sides(w)).view(),
                                                 std::as_const(w.joints.stage).view(),
                                                 all,
                                                 {std::as_const(there).view()},
                                                 w.bundles.leader.view()});
}

/// Wakes the joints whose strength the stress between their elements has reached.
template <class World>
void insert_mesh_joints(World& w) {
  if (!w.given->extrinsic) return;
  const StageTime timed(w.exec, "joint_insertion");
  for_each(w.exec, ShapeOf<World>::elements(w).size(), stress_kernel(w));
  for_each(w.exec, w.joints.size(), overshoot_kernel(w));
  std::vector<std::uint8_t> reached;
  copy_to(reached, w.reached);
  if (!w.domain.any(reached[0] != 0)) return;
  copy_to(w.reached, std::vector<std::uint8_t>{0});
  const Woken woken = wake(w, waking_joints(w));
  tie_corners(w, false, woken.vertices);
  // Their penalty shortens the step of the two elements that each of them joins.
  if (w.next_dt > 0.0) w.next_dt = shortened_time_step(w, woken.elements);
}

}  // namespace breccia::fdem_shared
