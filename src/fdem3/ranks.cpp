#include "fdem3/ranks.hpp"

#include <algorithm>
#include <cmath>

#include "domain/sharing.hpp"
#include "exec/for_each.hpp"
#include "fdem/joints/rings.hpp"
#include "fdem3/relations.hpp"

namespace breccia::fdem3 {
namespace {

using Rings = fdem::RingsOf<World, 4>;

/// How a tetrahedron lies in the mesh: by numbers of the whole mesh while it is on its way.
struct Neighbourhood {
  FaceJoints faces;
  Index across[4], vertex[4];
  FaceDashpots dashpots;
};

/// How far the corners lie from the centroid.  [m]
double radius(const TetrahedronNodes& nodes) {
  const Vec3 middle = centroid(nodes);
  double far = 0.0;
  for (const NodeState& n : nodes.at) {
    const Vec3 way = n.position - middle;
    far = std::max(far, dot(way, way));
  }
  return std::sqrt(far);
}

/// Sends everything to the ranks that need it: tetrahedra and what ties them together.
class Migration {
 public:
  /// @param owner  rank that each local tetrahedron will belong to
  Migration(World& w, const std::vector<int>& owner)
      : w_(w), elements_(w.domain.ranks->size()), shared_items_(w.domain, owner, elements_) {}

  /// Besides the owner, the ranks whose tetrahedra may touch one get a copy.
  void add_copies(const std::vector<Sphere>& around) {
    for (Index t = 0; t < w_.tetrahedra.size(); ++t)
      if (w_.domain.owns(t))
        w_.domain.each_sharer(around[at(t)], [&](int r) {
          if (r != shared_items_.owner_of(t)) elements_.add(r, t);
        });
  }

  void go() {
    Communicator& all = *w_.domain.ranks;
    SendLists joints(all.size()), couples(all.size()), reach(all.size());
    for (Index t = 0; t < w_.tetrahedra.size(); ++t)
      if (w_.domain.owns(t)) elements_.add(shared_items_.owner_of(t), t);
    tie_all(joints, couples);
    const auto can_touch = w_.reach.tetrahedron.host();
    for (Index i = 0; i < w_.reach.tetrahedron.size(); ++i)
      if (w_.domain.owns(can_touch[at(i)])) reach.add(shared_items_.owner_of(can_touch[at(i)]), i);

    leave();
    Tetrahedra& t = w_.tetrahedra;
    auto lie = one_field(lies_);
    auto external = one_field(t.external);
    if (w_.mesh.loaded)
      redistribute(all, together(t, lie, external), elements_, t.id);
    else
      redistribute(all, together(t, lie), elements_, t.id);

    Joints& j = w_.joints;
    Buffer<Index>& number = w_.mesh.joint_number;
    auto numbers = one_field(number);
    auto preset = one_field(j.preset);
    auto force = one_field(j.force);
    if (w_.mesh.preset)
      redistribute(all, together(j, numbers, force, preset), joints, number);
    else
      redistribute(all, together(j, numbers, force), joints, number);

    redistribute(all, w_.couples, couples, w_.couples.pairs.key);
    redistribute(all, w_.reach, reach, w_.reach.tetrahedron);
    arrive();
  }

 private:
  void tie_all(SendLists& joints, SendLists& couples) {
    const Rings rings(w_);
    std::vector<Index> members;
    rings.each([&](const KeyedIndex* first, const KeyedIndex* end) {
      members.clear();
      for (; first != end; ++first) members.push_back(first->item / 4);
      shared_items_.keep_together(members);
    });
    for (Index i = 0; i < w_.joints.size(); ++i) {
      members = {w_.joints.face_a.data()[i] / 4, w_.joints.face_b.data()[i] / 4};
      shared_items_.keep_together(members, i, joints);
    }
    shared_items_.keep_all_together(element_ends(w_, "couples"), w_.couples.size(), couples);
  }

  Index id_of(Index t) const { return w_.tetrahedra.id.data()[t]; }
  Index global(Index face) const { return face < 0 ? face : 4 * id_of(face / 4) + face % 4; }

  /// Places in memory become numbers of the whole mesh.
  void leave() {
    lies_.resize(w_.tetrahedra.size());
    for (Index t = 0; t < w_.tetrahedra.size(); ++t) {
      Neighbourhood& n = lies_.data()[t];
      n.faces = w_.faces.data()[t];
      if (w_.mesh.absorbs) n.dashpots = w_.dashpots.data()[t];
      for (int k = 0; k < 4; ++k) {
        Index& entry = n.faces.at[k];
        if (entry >= 0) entry = 2 * w_.mesh.joint_number.data()[pair_of(entry)] + side_of(entry);
        n.across[k] = global(w_.across[at(4 * t + k)]);
        n.vertex[k] = w_.vertex[at(4 * t + k)];
      }
    }
    renumber_relations(w_, [this](Index t) { return id_of(t); });
  }

  /// And back again. Faces whose joint or neighbour is not here are those of ghosts.
  void arrive() {
    Places elements(w_.tetrahedra.id), joints(w_.mesh.joint_number);
    renumber_relations(w_, [&elements](Index id) { return elements.of(id); });
    const Index count = w_.tetrahedra.size();
    w_.faces.resize(count);
    if (w_.mesh.absorbs) w_.dashpots.resize(count);
    w_.across.resize(at(4 * count));
    w_.vertex.resize(at(4 * count));
    w_.node_vertex.clear();
    for (Index t = 0; t < count; ++t) {
      const Neighbourhood& n = lies_.data()[t];
      if (w_.mesh.absorbs) w_.dashpots.data()[t] = n.dashpots;
      for (int k = 0; k < 4; ++k) {
        Index entry = n.faces.at[k];
        if (entry >= 0) {
          const Index joint = joints.find(pair_of(entry));
          entry = joint < 0 ? face_free : 2 * joint + side_of(entry);
        }
        w_.faces.data()[t].at[k] = entry;
        const Index other = n.across[k] < 0 ? -1 : elements.find(n.across[k] / 4);
        w_.across[at(4 * t + k)] = other < 0 ? -1 : 4 * other + n.across[k] % 4;
        w_.vertex[at(4 * t + k)] = n.vertex[k];
      }
    }
  }

  World& w_;
  SendLists elements_;
  SharedItems shared_items_;
  Buffer<Neighbourhood> lies_;
};

/// Arrays that follow from the tetrahedra and joints of this rank.
/// @param space  where they go when they have settled in
void settle_in(World& w, Space space) {
  const Index count = w.tetrahedra.size();
  list_loaded_faces(w);
  // Rings without an owned tetrahedron may be incomplete; nobody here needs them.
  std::vector<Index> first{0}, nodes;
  Rings(w).each([&](const KeyedIndex* begin, const KeyedIndex* end) {
    if (std::none_of(begin, end, [&](const auto& c) { return w.domain.owns(c.item / 4); })) return;
    for (; begin != end; ++begin) nodes.push_back(begin->item);
    first.push_back(static_cast<Index>(nodes.size()));
  });
  copy_to(w.bundles.starts, first);
  copy_to(w.bundles.nodes, nodes);

  Domain& d = w.domain;
  d.tied.assign(at(count), 0);
  if (w.mesh.bundled) {
    for (const Index node : nodes) d.tied[at(node / 4)] = 1;
    std::vector<Ghost> in_rings;
    for (const Ghost& ghost : d.ghosts)
      if (d.tied[at(ghost.element)] != 0) in_rings.push_back(ghost);
    w.tied_forces.build(*d.ranks, w.tetrahedra.id, in_rings, space);
  }
  mark_joined(w, d.tied);
  derive_bundles(w);
}

/// Square of the largest speed of a tetrahedron.
struct Fastest {
  Vec3 drift;  ///<  [m/s]
  OwnedView owned;
  View<const TetrahedronNodes> nodes;
  BR_HD double operator()(Index t) const {
    double fastest = 0.0;
    if (owned(t))
      for (const NodeState& n : nodes[t].at) {
        const Vec3 velocity = n.velocity - drift;
        fastest = max(fastest, dot(velocity, velocity));
      }
    return fastest;
  }
};

/// 1 where a corner has left the buffer.
struct HasLeft {
  double allowed;  ///< square of the way that it may go  [m2]
  OwnedView owned;
  Vec3 drifted;  ///< common to all since they were placed  [m]
  View<const TetrahedronNodes> nodes;
  View<const Vec3> reference;
  BR_HD double operator()(Index t) const {
    bool left = false;
    for (int k = 0; k < 4; ++k) {
      const Vec3 moved = (nodes[t].at[k].position - reference[4 * t + k]) - drifted;
      if (!(dot(moved, moved) <= allowed)) left = true;
    }
    return owned(t) && left ? 1.0 : 0.0;
  }
};

class Mesh final : public Shareable {
 public:
  /// @param space  where the tetrahedra go when they have settled in
  Mesh(World& w, Space space) : w_(w), space_(space) {}

  Space space() const override { return space_; }
  void come_to_host() override { move_to(w_, Space::host); }

  const Buffer<GlobalId>& ids() const override { return w_.tetrahedra.id; }
  void look() override {
    if (on_host()) return;
    copy_to(seen_, w_.tetrahedra.nodes);
    copy_to(seen_shapes_, w_.tetrahedra.shape);
  }
  Vec3 centre(Index t) const override { return centroid(nodes().data()[t]); }
  /// With what counts as near to it.
  double radius(Index t) const override {
    return fdem3::radius(nodes().data()[t]) + near_reach(shapes().data()[t]);
  }
  std::vector<Vec3> points() const override {
    std::vector<Vec3> points;
    points.reserve(at(4 * w_.tetrahedra.size()));
    for (const TetrahedronNodes& n : w_.tetrahedra.nodes.host())
      for (const NodeState& corner : n.at) points.push_back(corner.position);
    return points;
  }
  std::vector<std::int64_t> weights() const override {
    // By what they cost on one core, in units of some 10 ns (bench/notes/cpu.md).
    constexpr std::int64_t element = 8, end_of_joint = 4, end_of_couple = 6, tied_corner = 3;
    std::vector<std::int64_t> weight(at(w_.tetrahedra.size()), element);
    for (const Buffer<Index>* faces : {&w_.joints.face_a, &w_.joints.face_b})
      for (const Index face : faces->host()) weight[at(face / 4)] += end_of_joint;
    for (const Buffer<Index>* ends : {&w_.couples.pairs.a, &w_.couples.pairs.b})
      for (const Index t : ends->host()) weight[at(t)] += end_of_couple;
    for (std::size_t corner = 0; w_.mesh.bundled && corner < w_.vertex.size(); ++corner)
      if (w_.mesh.tied[at(w_.vertex[corner])] != 0) weight[corner / 4] += tied_corner;
    return weight;
  }
  double margin() const override {
    const double fastest = fold(w_.exec, w_.tetrahedra.size(), 0.0,
                                Fastest{w_.reach.drift.velocity, w_.domain.owned_view(),
                                        std::as_const(w_.tetrahedra.nodes).view()},
                                Largest{});
    return margin_rule(w_).margin({std::sqrt(fastest), 0.0, 0.0});
  }
  bool has_left() const override {
    return fold(w_.exec, w_.tetrahedra.size(), 0.0,
                HasLeft{w_.domain.buffer * w_.domain.buffer, w_.domain.owned_view(),
                        w_.domain.drifted, std::as_const(w_.tetrahedra.nodes).view(),
                        std::as_const(w_.domain.migration_reference).view()},
                Largest{}) > 0.0;
  }
  double largest_margin() const override { return margin_rule(w_).largest; }
  void send(const std::vector<int>& owner, const std::vector<Sphere>& around) override {
    Migration journey(w_, owner);
    journey.add_copies(around);
    journey.go();
  }
  void settle_in() override {
    fdem3::settle_in(w_, space_);
    move_to(w_, space_);
  }

 private:
  bool on_host() const { return w_.tetrahedra.nodes.space() == Space::host; }
  const Buffer<TetrahedronNodes>& nodes() const { return on_host() ? w_.tetrahedra.nodes : seen_; }
  const Buffer<ShapeGradients>& shapes() const {
    return on_host() ? w_.tetrahedra.shape : seen_shapes_;
  }

  World& w_;
  Space space_;
  Buffer<TetrahedronNodes> seen_;  ///< on the host, while they are elsewhere
  Buffer<ShapeGradients> seen_shapes_;
};

/// Arrays that follow from couples that came with their tetrahedra. A search finds it for its own.
void go_on_with_couples(World& w) {
  derive_couples(w);
  select_active_ghosts(w);
}

/// Values that all ranks share, as rank 0 has them.
void take_common(World& w, Communicator& ranks) {
  take_time_from_first(ranks, w);
  take_from_first(ranks, w.reach.drift);
  for (ServoState& servo : w.servos) take_from_first(ranks, servo);
  for (Buffer<std::uint8_t>* flags : {&w.exposed.changed, &w.exposed.vertex}) {
    Message message;
    put_bytes(message, flags->data(), at(flags->size()));
    message = ranks.from_first(std::move(message));
    std::copy_n(reinterpret_cast<const std::uint8_t*>(message.data()), message.size(),
                flags->data());
  }
}

void note_mesh(World& whole) {
  WholeMesh& mesh = whole.mesh;
  mesh.tied.assign(whole.given->open_vertex.size(), 0);
  for (const Index node : whole.bundles.nodes.host()) mesh.tied[at(whole.vertex[at(node)])] = 1;
  mesh.bundled = whole.bundles.nodes.size() > 0;
  mesh.loaded = whole.tetrahedra.external.size() > 0;
  mesh.absorbs = whole.dashpots.size() > 0;
  mesh.preset = whole.joints.preset.size() > 0;
}

}  // namespace

void drop_state(World& w) {
  resize_fields(w.tetrahedra, 0);
  resize_fields(w.joints, 0);
  resize_fields(w.couples, 0);
  resize_fields(w.reach, 0);
  w.tetrahedra.external.resize(0);
  w.joints.force.resize(0);
  w.joints.preset.resize(0);
  w.faces.resize(0);
  w.dashpots.resize(0);
  w.across.clear();
  w.vertex.clear();
}

void start_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.start_refresh(w.exec, w.tetrahedra.nodes);
}
void finish_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.finish_refresh(w.exec, w.tetrahedra.nodes);
}
void refresh_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh_all(w.exec, w.tetrahedra.nodes);
}

void select_active_ghosts(World& w) {
  // On a device the list costs more than it saves.
  if (w.domain.single_rank() || w.exec.space != Space::host) return;
  w.domain.select_active_ghosts(w.tetrahedra.id, w.couples.pairs.a, w.couples.pairs.b);
}

World share_out(World& whole, Communicator& ranks, const DomainConfig& config, Space space) {
  if (whole.mesh.tied.empty()) note_mesh(whole);
  World w = whole;
  w.mesh.joint_number.resize(w.joints.size());
  for (Index i = 0; i < w.joints.size(); ++i) w.mesh.joint_number.data()[i] = i;
  if (ranks.rank() != 0) {
    drop_state(w);
    w.mesh.joint_number.resize(0);
  }
  const std::vector<std::uint8_t> all(at(w.tetrahedra.size()), 1);
  take_common(w, ranks);
  w.ledger = {};  // what this rank books from here on
  Mesh mesh(w, space);
  begin_sharing(w.domain, ranks, config, mesh, w.given->mean_edge, 3);
  copy_to(w.domain.owned, all);
  w.domain.drifted_until = w.time;
  share_anew(w.domain, mesh, true);
  go_on_with_couples(w);
  return w;
}

void migrate(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "migration");
  Mesh mesh(w, w.exec.space);
  share_if_needed(w.domain, mesh);
}

void rebalance(World& w) {
  if (!is_uneven(w.domain)) return;
  const StageTime timed(w.exec, "migration");
  // Otherwise the way since the last search would be taken off what comes next.
  w.domain.drift(w.reach.drift.velocity, w.time);
  Mesh mesh(w, w.exec.space);
  mesh.come_to_host();
  share_anew(w.domain, mesh, false);
  go_on_with_couples(w);
}

void collect(World& part, World& whole) {
  World copy = part;
  move_to(copy, Space::host);
  // How a tetrahedron lies in the mesh stays: rank 0 knows the whole mesh.
  Migration(copy, std::vector<int>(at(part.tetrahedra.size()), 0)).go();

  Communicator& ranks = *part.domain.ranks;
  const std::vector<Ledger> booked = from_each(ranks, part.ledger);
  part.ledger = {};
  std::uint64_t changed = 0;
  for (Index i = 0; i < copy.exposed.changed.size(); ++i)
    if (copy.exposed.changed.data()[i] != 0) changed |= std::uint64_t{1} << i;
  changed = ranks.any_of(changed);
  if (ranks.rank() != 0) return;
  for (const Ledger& ledger : booked) whole.ledger.add(ledger);
  whole.tetrahedra = std::move(copy.tetrahedra);
  whole.joints = std::move(copy.joints);
  whole.couples = std::move(copy.couples);
  whole.reach = std::move(copy.reach);
  whole.exposed = std::move(copy.exposed);
  for (Index i = 0; i < whole.exposed.changed.size(); ++i)
    whole.exposed.changed.data()[i] = (changed >> i & 1) != 0 ? 1 : 0;
  whole.motions = std::move(copy.motions);
  whole.load_laws = std::move(copy.load_laws);
  Domain moved = part.domain;
  moved.drift(whole.reach.drift.velocity, part.time);
  moved.partition.move(moved.drifted);
  whole.domain.partition = moved.partition;
  whole.servos = part.servos;
  copy_time(part, whole);
  derive_couples(whole);
}

}  // namespace breccia::fdem3
