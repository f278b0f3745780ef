// Extrinsic joints: where the stress between two triangles that move as one reaches their joint's
// strength, the joint and those around its two vertices wake, and carry from then on just what was
// transmitted.

#include <algorithm>
#include <array>
#include <cstring>

#include "exec/for_each.hpp"
#include "fdem/insertion_kernels.hpp"
#include "fdem/launches.hpp"
#include "fdem/materials.hpp"

namespace breccia::fdem {
namespace {

/// A joint whose strength is reached, by its number in the whole mesh.
struct Candidate {
  double overshoot;
  Index joint, first, second;  ///< and its two vertices
};

/// Of all ranks; each tells of the joints whose side a it owns.
std::vector<Candidate> candidates(const World& w, const std::vector<double>& overshoot) {
  std::vector<JointEnds> ends;
  copy_to(ends, w.joint_ends);
  std::vector<Candidate> own;
  for (std::size_t i = 0; i < overshoot.size(); ++i) {
    if (overshoot[i] < 1.0 || !w.domain.owns(ends[i].a0 / 3)) continue;
    const auto place = static_cast<Index>(i);
    own.push_back({overshoot[i], w.domain.alone() ? place : w.mesh.joint_number.data()[place],
                   w.vertex[static_cast<std::size_t>(ends[i].a0)],
                   w.vertex[static_cast<std::size_t>(ends[i].a1)]});
  }
  if (w.domain.alone()) return own;
  Message message(own.size() * sizeof(Candidate));
  if (!own.empty()) std::memcpy(message.data(), own.data(), message.size());
  std::vector<Candidate> all;
  for (const Message& came : w.domain.ranks->from_all(message)) {
    const std::size_t before = all.size();
    all.resize(before + came.size() / sizeof(Candidate));
    if (!came.empty()) std::memcpy(all.data() + before, came.data(), came.size());
  }
  return all;
}

/// Of the joints whose strength is reached the most loaded ones, no two at one vertex: its waking
/// unloads the others around. With each of them wake all that share a vertex with it: while the
/// corners around a vertex are tied, no joint opens there.
std::vector<Index> chosen(const World& w, const std::vector<double>& overshoot) {
  std::vector<Candidate> joints = candidates(w, overshoot);
  std::sort(joints.begin(), joints.end(), [](const Candidate& a, const Candidate& b) {
    return a.overshoot != b.overshoot ? a.overshoot > b.overshoot : a.joint < b.joint;
  });
  std::vector<Index> parted;
  for (const Candidate& c : joints) {
    const auto is_parted = [&](Index v) {
      return std::find(parted.begin(), parted.end(), v) != parted.end();
    };
    if (!is_parted(c.first) && !is_parted(c.second))
      parted.insert(parted.end(), {c.first, c.second});
  }
  std::sort(parted.begin(), parted.end());
  std::vector<JointEnds> ends;
  std::vector<JointStage> stage;
  copy_to(ends, w.joint_ends);
  copy_to(stage, w.joints.stage);
  const auto parts_at = [&](Index node) {
    return std::binary_search(parted.begin(), parted.end(),
                              w.vertex[static_cast<std::size_t>(node)]);
  };
  std::vector<Index> waking;
  for (std::size_t i = 0; i < stage.size(); ++i)
    if (stage[i] == JointStage::dormant && (parts_at(ends[i].a0) || parts_at(ends[i].a1)))
      waking.push_back(static_cast<Index>(i));
  return waking;
}

/// Wakes joints at the opening and slip at which they carry what was transmitted; books what they
/// then store.
void wake(World& w, const std::vector<Index>& joints, const std::vector<double>& overshoot) {
  std::vector<JointStage> stage;
  std::vector<Vec2> preset;
  std::vector<double> strength, length;
  std::vector<Index> law;
  std::vector<JointBond> bonds;
  copy_to(stage, w.joints.stage);
  copy_to(preset, w.joints.preset);
  copy_to(strength, w.joints.strength);
  copy_to(length, w.joints.length);
  copy_to(law, w.joints.law);
  copy_to(bonds, w.bonds);
  Buffer<TriangleNodes> nodes;
  Buffer<JointEnds> ends;
  Buffer<Sym2> stress;
  copy_to(nodes, w.triangles.nodes);
  copy_to(ends, w.joint_ends);
  copy_to(stress, w.stress);
  const EdgeTraction traction{by_number(std::as_const(nodes).view()), std::as_const(ends).view(),
                              std::as_const(stress).view()};
  for (const Index joint : joints) {
    const auto i = static_cast<std::size_t>(joint);
    const JointBond& bond = bonds[static_cast<std::size_t>(law[i])];
    // just below its strength, where that is reached
    const double share = std::min(1.0, (1.0 - 1e-6) / overshoot[i]);
    const Vec2 t = share * traction(joint);
    preset_opening(bond, strength[i], length[i], t.x, t.y, preset[i]);
    stage[i] = JointStage::whole;
    const JointOpening<double> closed{};
    const StoredEnergy held =
        stored_in(bond, strength[i], length[i], preset[i], closed, JointPoints{});
    if (w.domain.owns(ends.data()[joint].a0 / 3)) w.ledger.inserted.add(held.open + held.slide);
  }
  copy_to(w.joints.stage, stage);
  copy_to(w.joints.preset, preset);
}

}  // namespace

void insert_joints(World& w) {
  if (!w.extrinsic) return;
  const StageTime timed(w.exec, "joint_insertion");
  for_each(w.exec, w.triangles.size(), stress_kernel(w));
  for_each(w.exec, w.joints.size(), overshoot_kernel(w));
  std::vector<std::uint8_t> reached;
  copy_to(reached, w.reached);
  if (!w.domain.any(reached[0] != 0)) return;
  copy_to(w.reached, std::vector<std::uint8_t>{0});
  std::vector<double> overshoot;
  copy_to(overshoot, w.overshoot);
  const std::vector<Index> joints = chosen(w, overshoot);
  wake(w, joints, overshoot);
  derive_bundles(w);

  // Their penalty shortens the step of the two triangles that each of them joins.
  Buffer<Index> triangles(w.exec.space);
  std::vector<JointEnds> ends;
  std::vector<Index> changed;
  copy_to(ends, w.joint_ends);
  for (const Index i : joints)
    changed.insert(changed.end(), {ends[static_cast<std::size_t>(i)].a0 / 3,
                                   ends[static_cast<std::size_t>(i)].b0 / 3});
  copy_to(triangles, changed);
  if (w.next_dt > 0.0) w.next_dt = shortened_time_step(w, triangles);
}

void derive_bundles(World& w) {
  if (w.bundles.starts.empty()) return;
  std::vector<Index> starts, nodes;
  std::vector<EdgeJoints> edges;
  std::vector<JointStage> stage;
  copy_to(starts, w.bundles.starts);
  copy_to(nodes, w.bundles.nodes);
  copy_to(edges, w.edges);
  copy_to(stage, w.joints.stage);
  const auto tied = [&](Index edge) {
    const Index entry = edges[static_cast<std::size_t>(edge / 3)].at[edge % 3];
    return entry == edge_bonded ||
           (entry >= 0 && stage[static_cast<std::size_t>(pair_of(entry))] == JointStage::dormant);
  };
  std::vector<Index> leader(nodes.size());
  for (std::size_t v = 0; v + 1 < starts.size(); ++v) {
    const Index begin = starts[v], end = starts[v + 1];
    const auto place = [&](Index node) {
      const auto first = nodes.begin() + begin, last = nodes.begin() + end;
      return static_cast<Index>(std::lower_bound(first, last, node) - nodes.begin());
    };
    for (Index k = begin; k < end; ++k) leader[static_cast<std::size_t>(k)] = k;
    const auto root = [&](Index k) {
      while (leader[static_cast<std::size_t>(k)] != k) k = leader[static_cast<std::size_t>(k)];
      return k;
    };
    for (Index k = begin; k < end; ++k) {
      // The edge that leaves this corner: across it the same vertex ends the neighbour's edge.
      const Index edge = nodes[static_cast<std::size_t>(k)];
      if (!tied(edge)) continue;
      const Index other = JointEnds::next_corner(w.across[static_cast<std::size_t>(edge)]);
      const Index a = root(k), b = root(place(other));
      leader[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
    for (Index k = begin; k < end; ++k) leader[static_cast<std::size_t>(k)] = root(k);
  }
  copy_to(w.bundles.leader, leader);
}

}  // namespace breccia::fdem
