// Extrinsic joints: where the stress between two triangles that move as one reaches their joint's
// strength, the joint and those around its two vertices wake, and carry from then on just what was
// transmitted.

#include <algorithm>
#include <set>

#include "core/select.hpp"
#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/stepping/launches.hpp"

namespace breccia::fdem {
namespace {

SomeVertices some_vertices(World& w, const Buffer<Index>& some) {
  return {node_vertices(w), some.view()};
}

/// The joints of all ranks whose strength is reached, by their numbers in the whole mesh; each
/// tells of those whose side a it owns.
std::vector<Candidate> candidates(World& w) {
  const auto overshoot = std::as_const(w.overshoot).view();
  const auto ends = std::as_const(w.joint_ends).view();
  const Buffer<Index> reached =
      items_where(w.exec, w.joints.size(), IsReached{overshoot, ends, w.domain.owned_view()});
  Buffer<Candidate> listed(w.exec.space, reached.size());
  for_each(w.exec, reached.size(),
           ListCandidates{reached.view(), overshoot, ends, node_vertices(w), listed.view()});
  std::vector<Candidate> own;
  copy_to(own, listed);
  if (w.domain.single_rank()) return own;
  for (Candidate& c : own) c.joint = w.mesh.joint_number.data()[c.joint];
  return joined(*w.domain.ranks, own);
}

/// The vertices, ascending, of the most loaded of those joints, no two at one vertex: its waking
/// unloads the others around.
std::vector<Index> parted_vertices(World& w) {
  std::vector<Candidate> joints = candidates(w);
  std::sort(joints.begin(), joints.end(), [](const Candidate& a, const Candidate& b) {
    return a.overshoot != b.overshoot ? a.overshoot > b.overshoot : a.joint < b.joint;
  });
  std::set<Index> parted;
  for (const Candidate& c : joints)
    if (parted.count(c.first) == 0 && parted.count(c.second) == 0)
      parted.insert({c.first, c.second});
  return {parted.begin(), parted.end()};
}

/// Which joints wake: all that share a vertex with the chosen ones. While the corners around a
/// vertex are tied, no joint opens there.
Buffer<Index> waking_joints(World& w) {
  Buffer<Index> parted(w.exec.space);
  copy_to(parted, parted_vertices(w));
  return items_where(w.exec, w.joints.size(),
                     SleepsAt{std::as_const(w.joints.stage).view(),
                              std::as_const(w.joint_ends).view(), some_vertices(w, parted)});
}

/// Triangles and vertices whose joints have woken.
struct Woken {
  Buffer<Index> triangles;      ///< where kernels can read them, some more than once
  std::vector<Index> vertices;  ///< ascending
};

/// Wakes joints and books what they then store.
Woken wake(World& w, const Buffer<Index>& joints) {
  const Index count = joints.size();
  Buffer<double> held(w.exec.space, count);
  Buffer<Index> triangles(w.exec.space, 2 * count), vertex(w.exec.space, 2 * count);
  for_each(w.exec, count,
           Wake{overshoot_kernel(w).stress, w.given->bonds.view(), w.joints.law.view(),
                w.joints.strength.view(), w.joints.length.view(), std::as_const(w.overshoot).view(),
                node_vertices(w), w.domain.owned_view(), joints.view(), w.joints.stage.view(),
                w.joints.preset.view(), held.view(), triangles.view(), vertex.view()});
  std::vector<double> stored;
  copy_to(stored, held);
  for (const double energy : stored) w.ledger.came_in.add(energy);
  std::vector<Index> vertices;
  copy_to(vertices, vertex);
  std::sort(vertices.begin(), vertices.end());
  return {std::move(triangles), std::move(vertices)};
}

void tie_corners(World& w, bool all, const std::vector<Index>& changed) {
  if (w.bundles.starts.empty()) return;
  if (static_cast<std::size_t>(w.edge_across.size()) != w.across.size())
    copy_to(w.edge_across, w.across);
  Buffer<Index> there(w.exec.space);
  copy_to(there, changed);
  w.bundles.leader.resize(w.bundles.nodes.size());
  for_each(w.exec, w.bundles.starts.size() - 1,
           TieCorners{w.bundles.starts.view(), w.bundles.nodes.view(), w.edge_across.view(),
                      w.edges.view(), std::as_const(w.joints.stage).view(), all,
                      some_vertices(w, there), w.bundles.leader.view()});
}

}  // namespace

void insert_joints(World& w) {
  if (!w.given->extrinsic) return;
  const StageTime timed(w.exec, "joint_insertion");
  for_each(w.exec, w.triangles.size(), stress_kernel(w));
  for_each(w.exec, w.joints.size(), overshoot_kernel(w));
  std::vector<std::uint8_t> reached;
  copy_to(reached, w.reached);
  if (!w.domain.any(reached[0] != 0)) return;
  copy_to(w.reached, std::vector<std::uint8_t>{0});
  const Woken woken = wake(w, waking_joints(w));
  tie_corners(w, false, woken.vertices);
  // Their penalty shortens the step of the two triangles that each of them joins.
  if (w.next_dt > 0.0) w.next_dt = shortened_time_step(w, woken.triangles);
}

void derive_bundles(World& w) {
  tie_corners(w, true, {});
}

View<const Index> node_vertices(World& w) {
  if (static_cast<std::size_t>(w.node_vertex.size()) != w.vertex.size())
    copy_to(w.node_vertex, w.vertex);
  return std::as_const(w.node_vertex).view();
}

}  // namespace breccia::fdem
