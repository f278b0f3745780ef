#include "fdem/ranks.hpp"

#include <algorithm>
#include <cmath>

#include "domain/sharing.hpp"
#include "exec/for_each.hpp"
#include "fdem/energy.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/joints/rings.hpp"
#include "fdem/relations.hpp"

namespace breccia::fdem {
namespace {

/// How a triangle lies in the mesh: by numbers of the whole mesh while it is on its way.
struct Neighbourhood {
  EdgeJoints edges;
  Index across[3], vertex[3];
  EdgeDashpots dashpots;
};

/// How far a triangle's corners lie from its centroid.  [m]
double radius(const TriangleNodes& nodes) {
  const Vec3 middle = centroid(nodes);
  double far = 0.0;
  for (const NodeState& n : nodes.at) {
    const Vec2 way = n.position - Vec2{middle.x, middle.y};
    far = std::max(far, dot(way, way));
  }
  return std::sqrt(far);
}

/// Sends everything to the ranks that need it: triangles and what ties them together.
class Migration {
 public:
  /// @param owner  rank that each local triangle will belong to
  Migration(World& w, const std::vector<int>& owner)
      : w_(w), triangles_(w.domain.ranks->size()), shared_items_(w.domain, owner, triangles_) {}

  /// Besides the owner, the ranks whose triangles may touch one get a copy.
  void add_copies(const std::vector<Sphere>& around) {
    for (Index t = 0; t < w_.triangles.size(); ++t)
      if (w_.domain.owns(t))
        w_.domain.each_sharer(around[at(t)], [&](int r) {
          if (r != shared_items_.owner_of(t)) triangles_.add(r, t);
        });
  }

  void go() {
    Communicator& all = *w_.domain.ranks;
    SendLists joints(all.size()), couples(all.size()), reach(all.size());
    for (Index t = 0; t < w_.triangles.size(); ++t)
      if (w_.domain.owns(t)) triangles_.add(shared_items_.owner_of(t), t);
    tie_all(joints, couples);
    const auto can_touch = w_.reach.triangle.host();
    for (Index i = 0; i < w_.reach.triangle.size(); ++i)
      if (w_.domain.owns(can_touch[at(i)])) reach.add(shared_items_.owner_of(can_touch[at(i)]), i);

    leave();
    Triangles& t = w_.triangles;
    auto lie = one_field(lies_);
    auto external = one_field(t.external);
    if (w_.mesh.loaded)
      redistribute(all, together(t, lie, external), triangles_, t.id);
    else
      redistribute(all, together(t, lie), triangles_, t.id);

    Joints& j = w_.joints;
    Buffer<Index>& number = w_.mesh.joint_number;
    auto numbers = one_field(number);
    auto preset = one_field(j.preset);
    with_number(w_.exec.precision, [&](auto of) {
      auto& forces = j.force.as<decltype(of)>();
      auto force = one_field(forces);
      forces.resize(j.size());
      if (w_.mesh.preset)
        redistribute(all, together(j, numbers, force, preset), joints, number);
      else
        redistribute(all, together(j, numbers, force), joints, number);
      forces.resize(j.size() + 1);  // the last one is zero
    });

    redistribute(all, w_.couples, couples, w_.couples.pairs.key);
    redistribute(all, w_.reach, reach, w_.reach.triangle);
    arrive();
  }

 private:
  void tie_all(SendLists& joints, SendLists& couples) {
    const Rings rings(w_);
    std::vector<Index> members;
    rings.each([&](const KeyedIndex* first, const KeyedIndex* end) {
      members.clear();
      for (; first != end; ++first) members.push_back(first->item / 3);
      shared_items_.keep_together(members);
    });
    for (Index i = 0; i < w_.joints.size(); ++i) {
      const Index a = w_.joints.edge_a.data()[i], b = w_.joints.edge_b.data()[i];
      members = {a / 3, b / 3};
      // Whether a joint around a vertex still holds decides who moves with whom there.
      for (const Index node : {a, JointEnds::next_corner(a)})
        if (w_.mesh.tied[at(w_.vertex[at(node)])] != 0)
          rings.add_elements(w_.vertex[at(node)], members);
      shared_items_.keep_together(members, i, joints);
    }
    shared_items_.keep_all_together(element_ends(w_, "couples"), w_.couples.size(), couples);
  }

  Index id_of(Index t) const { return w_.triangles.id.data()[t]; }
  Index global(Index edge) const { return edge < 0 ? edge : 3 * id_of(edge / 3) + edge % 3; }

  /// Places in memory become numbers of the whole mesh.
  void leave() {
    lies_.resize(w_.triangles.size());
    for (Index t = 0; t < w_.triangles.size(); ++t) {
      Neighbourhood& n = lies_.data()[t];
      n.edges = w_.edges.data()[t];
      if (w_.mesh.absorbs) n.dashpots = w_.dashpots.data()[t];
      for (int k = 0; k < 3; ++k) {
        Index& entry = n.edges.at[k];
        if (entry >= 0) entry = 2 * w_.mesh.joint_number.data()[pair_of(entry)] + side_of(entry);
        n.across[k] = global(w_.across[at(3 * t + k)]);
        n.vertex[k] = w_.vertex[at(3 * t + k)];
      }
    }
    renumber_relations(w_, [this](Index t) { return id_of(t); });
  }

  /// And back again. Edges whose joint or neighbour is not here are those of ghosts.
  void arrive() {
    Places triangles(w_.triangles.id), joints(w_.mesh.joint_number);
    renumber_relations(w_, [&triangles](Index id) { return triangles.of(id); });
    const Index count = w_.triangles.size();
    w_.edges.resize(count);
    if (w_.mesh.absorbs) w_.dashpots.resize(count);
    w_.across.resize(at(3 * count));
    w_.vertex.resize(at(3 * count));
    w_.node_vertex.clear();
    w_.edge_across.clear();
    for (Index t = 0; t < count; ++t) {
      const Neighbourhood& n = lies_.data()[t];
      if (w_.mesh.absorbs) w_.dashpots.data()[t] = n.dashpots;
      for (int k = 0; k < 3; ++k) {
        Index entry = n.edges.at[k];
        if (entry >= 0) {
          const Index joint = joints.find(pair_of(entry));
          entry = joint < 0 ? edge_free : 2 * joint + side_of(entry);
        }
        w_.edges.data()[t].at[k] = entry;
        const Index other = n.across[k] < 0 ? -1 : triangles.find(n.across[k] / 3);
        w_.across[at(3 * t + k)] = other < 0 ? -1 : 3 * other + n.across[k] % 3;
        w_.vertex[at(3 * t + k)] = n.vertex[k];
      }
    }
  }

  World& w_;
  SendLists triangles_;
  SharedItems shared_items_;
  Buffer<Neighbourhood> lies_;
};

/// Derives arrays from the triangles and joints of this rank.
/// @param space  where the triangles go when they have settled in
void settle_in(World& w, Space space) {
  const Index count = w.triangles.size(), joints = w.joints.size();
  std::vector<JointEnds> ends;
  ends.reserve(at(joints));
  for (Index i = 0; i < joints; ++i)
    ends.push_back(JointEnds::of(w.joints.edge_a.data()[i], w.joints.edge_b.data()[i]));
  copy_to(w.joint_ends, ends);
  if (w.given->extrinsic) {
    w.stress.resize(count);
    w.overshoot.resize(joints);
  }
  list_loaded_edges(w);

  // Rings without an owned triangle may be incomplete; nobody here needs them.
  std::vector<Index> first{0}, nodes;
  Rings(w).each([&](const KeyedIndex* begin, const KeyedIndex* end) {
    if (std::none_of(begin, end, [&](const auto& c) { return w.domain.owns(c.item / 3); })) return;
    for (; begin != end; ++begin) nodes.push_back(begin->item);
    first.push_back(static_cast<Index>(nodes.size()));
  });
  copy_to(w.bundles.starts, first);
  copy_to(w.bundles.nodes, nodes);

  Domain& d = w.domain;
  d.tied.assign(at(count), 0);
  if (w.mesh.bundled) {
    for (const Index node : nodes) d.tied[at(node / 3)] = 1;
    std::vector<Ghost> in_rings;
    for (const Ghost& ghost : d.ghosts)
      if (d.tied[at(ghost.element)] != 0) in_rings.push_back(ghost);
    w.tied_forces.build(*d.ranks, w.triangles.id, in_rings, space);
  }
  mark_joined(w, d.tied);
  w.joint_packs.clear();
  if (space != Space::host) return;
  w.joint_packs.assign(at((joints + joint_pack - 1) / joint_pack), JointPack::inner);
  for (const Buffer<Index>* edges : {&w.joints.edge_a, &w.joints.edge_b})
    for (Index i = 0; i < joints; ++i)
      if (!d.owns(edges->data()[i] / 3)) w.joint_packs[at(i / joint_pack)] = JointPack::outer;
}

/// Square of a triangle's largest speed.
struct Fastest {
  Vec2 drift;  ///<  [m/s]
  OwnedView owned;
  View<const TriangleNodes> nodes;
  BR_HD double operator()(Index t) const {
    double fastest = 0.0;
    if (owned(t))
      for (const NodeState& n : nodes[t].at) {
        const Vec2 velocity = n.velocity - drift;
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
  View<const TriangleNodes> nodes;
  View<const Vec3> reference;
  BR_HD double operator()(Index t) const {
    bool left = false;
    for (int k = 0; k < 3; ++k) {
      const Vec2& x = nodes[t].at[k].position;
      const Vec3 moved = (Vec3{x.x, x.y, 0.0} - reference[3 * t + k]) - drifted;
      if (!(dot(moved, moved) <= allowed)) left = true;
    }
    return owned(t) && left ? 1.0 : 0.0;
  }
};

class Mesh final : public Shareable {
 public:
  /// @param space  where the triangles go when they have settled in
  Mesh(World& w, Space space) : w_(w), space_(space) {}

  Space space() const override { return space_; }
  void come_to_host() override { move_to(w_, Space::host); }

  const Buffer<GlobalId>& ids() const override { return w_.triangles.id; }
  void look() override {
    if (w_.triangles.nodes.space() == Space::host) return;
    copy_to(seen_, w_.triangles.nodes);
    copy_to(seen_shapes_, w_.triangles.shape_inverse);
  }
  Vec3 centre(Index t) const override { return centroid(nodes().data()[t]); }
  /// With what counts as near to it.
  double radius(Index t) const override {
    return fdem::radius(nodes().data()[t]) + near_reach(shapes().data()[t]);
  }
  std::vector<Vec3> points() const override {
    std::vector<Vec3> points;
    points.reserve(at(3 * w_.triangles.size()));
    for (const TriangleNodes& nodes : w_.triangles.nodes.host())
      for (const NodeState& n : nodes.at) points.push_back({n.position.x, n.position.y, 0.0});
    return points;
  }
  std::vector<std::int64_t> weights() const override {
    // By what they cost, in units of some 3 ns on one core (bench/notes/cpu.md).
    constexpr std::int64_t triangle = 8, end_of_joint = 3, end_of_couple = 16, tied_corner = 3;
    std::vector<std::int64_t> weight(at(w_.triangles.size()), triangle);
    for (const Buffer<Index>* edges : {&w_.joints.edge_a, &w_.joints.edge_b})
      for (const Index edge : edges->host()) weight[at(edge / 3)] += end_of_joint;
    for (const Buffer<Index>* ends : {&w_.couples.pairs.a, &w_.couples.pairs.b})
      for (const Index t : ends->host()) weight[at(t)] += end_of_couple;
    for (std::size_t corner = 0; w_.mesh.bundled && corner < w_.vertex.size(); ++corner)
      if (w_.mesh.tied[at(w_.vertex[corner])] != 0) weight[corner / 3] += tied_corner;
    return weight;
  }
  double margin() const override {
    const double fastest = fold(w_.exec, w_.triangles.size(), 0.0,
                                Fastest{w_.reach.drift.velocity, w_.domain.owned_view(),
                                        std::as_const(w_.triangles.nodes).view()},
                                Largest{});
    return margin_rule(w_).margin({std::sqrt(fastest), 0.0, 0.0});
  }
  bool has_left() const override {
    return fold(w_.exec, w_.triangles.size(), 0.0, has_left_kernel(), Largest{}) > 0.0;
  }
  double largest_margin() const override { return margin_rule(w_).largest; }
  void send(const std::vector<int>& owner, const std::vector<Sphere>& around) override {
    Migration journey(w_, owner);
    journey.add_copies(around);
    journey.go();
  }
  void settle_in() override {
    fdem::settle_in(w_, space_);
    move_to(w_, space_);
    derive_bundles(w_);
  }

 private:
  const Buffer<TriangleNodes>& nodes() const {
    return w_.triangles.nodes.space() == Space::host ? w_.triangles.nodes : seen_;
  }
  const Buffer<Mat2>& shapes() const {
    return w_.triangles.nodes.space() == Space::host ? w_.triangles.shape_inverse : seen_shapes_;
  }
  HasLeft has_left_kernel() const {
    return {w_.domain.buffer * w_.domain.buffer, w_.domain.owned_view(), w_.domain.drifted,
            std::as_const(w_.triangles.nodes).view(),
            std::as_const(w_.domain.migration_reference).view()};
  }

  World& w_;
  Space space_;
  Buffer<TriangleNodes> seen_;  ///< on the host, while triangles are elsewhere
  Buffer<Mat2> seen_shapes_;    ///< likewise
};

/// Derives arrays from couples that came with their triangles. A search finds them for its own.
void go_on_with_couples(World& w) {
  derive_couples(w);
  select_active_ghosts(w);
}

/// Data that all ranks share, as rank 0 has them.
void take_common(World& w, Communicator& ranks) {
  take_time_from_first(ranks, w);
  take_from_first(ranks, w.reach.drift);
  for (ServoState& servo : w.servos) take_from_first(ranks, servo);
  take_from_first(ranks, w.fluid.time);
  if (w.given->flow.on) {
    take_from_first(ranks, w.fluid.injected);
    take_from_first(ranks, w.fluid.pressure);
    const bool begun = w.fluid.volume.size() > 0;
    BR_ASSERT(begun);
    Message message;
    put_bytes(message, reinterpret_cast<const std::uint8_t*>(w.fluid.volume.data()),
              begun ? at(w.fluid.volume.size()) * sizeof(double) : 0);
    message = ranks.from_first(std::move(message));
    __builtin_memcpy(w.fluid.volume.data(), message.data(), message.size());
  }
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
  mesh.loaded = whole.triangles.external.size() > 0;
  mesh.absorbs = whole.dashpots.size() > 0;
  mesh.preset = whole.joints.preset.size() > 0;
}

}  // namespace

Vec3 centroid(const TriangleNodes& nodes) {
  const Vec2 sum = nodes.at[0].position + nodes.at[1].position + nodes.at[2].position;
  return {sum.x / 3.0, sum.y / 3.0, 0.0};
}
void drop_state(World& w) {
  resize_fields(w.triangles, 0);
  resize_fields(w.joints, 0);
  resize_fields(w.couples, 0);
  resize_fields(w.reach, 0);
  w.triangles.external.resize(0);
  w.joints.force.in_double.resize(0);
  w.joints.force.in_single.resize(0);
  w.joints.preset.resize(0);
  w.edges.resize(0);
  w.dashpots.resize(0);
  w.across.clear();
  w.vertex.clear();
}

void start_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.start_refresh(w.exec, w.triangles.nodes);
}
void finish_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.finish_refresh(w.exec, w.triangles.nodes);
}
void refresh_ghosts(World& w) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh_all(w.exec, w.triangles.nodes);
}

void select_active_ghosts(World& w) {
  // Waking joints look at triangles that nothing ties yet; on a device the list costs more than
  // it saves.
  if (w.domain.single_rank() || w.given->extrinsic || w.exec.space != Space::host) return;
  w.domain.select_active_ghosts(w.triangles.id, w.couples.pairs.a, w.couples.pairs.b);
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
  const std::vector<std::uint8_t> all(at(w.triangles.size()), 1);
  return share_parts(std::move(w), all, ranks, config, space);
}

World share_parts(World part, const std::vector<std::uint8_t>& own, Communicator& ranks,
                  const DomainConfig& config, Space space) {
  if (part.mesh.tied.empty()) note_mesh(part);
  take_common(part, ranks);
  part.ledger = {};  // what this rank books from here on
  Mesh mesh(part, space);
  begin_sharing(part.domain, ranks, config, mesh, part.given->mean_edge, 2);
  copy_to(part.domain.owned, own);
  part.domain.drifted_until = part.time;
  share_anew(part.domain, mesh, true);
  go_on_with_couples(part);
  return part;
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
  const Vec2 drift = w.reach.drift.velocity;
  w.domain.drift({drift.x, drift.y, 0.0}, w.time);
  Mesh mesh(w, w.exec.space);
  mesh.come_to_host();
  share_anew(w.domain, mesh, false);
  go_on_with_couples(w);
}

void collect(World& part, World& whole) {
  World copy = part;
  move_to(copy, Space::host);
  // Neighbours of a triangle stay: rank 0 knows the whole mesh.
  Migration(copy, std::vector<int>(at(part.triangles.size()), 0)).go();

  Communicator& ranks = *part.domain.ranks;
  const std::vector<Ledger> booked = from_each(ranks, part.ledger);
  part.ledger = {};
  std::uint64_t changed = 0;
  for (Index i = 0; i < copy.exposed.changed.size(); ++i)
    if (copy.exposed.changed.data()[i] != 0) changed |= std::uint64_t{1} << i;
  changed = ranks.any_of(changed);
  if (ranks.rank() != 0) return;
  for (const Ledger& ledger : booked) whole.ledger.add(ledger);
  whole.triangles = std::move(copy.triangles);
  whole.joints = std::move(copy.joints);
  whole.couples = std::move(copy.couples);
  whole.reach = std::move(copy.reach);
  whole.exposed = std::move(copy.exposed);
  for (Index i = 0; i < whole.exposed.changed.size(); ++i)
    whole.exposed.changed.data()[i] = (changed >> i & 1) != 0 ? 1 : 0;
  whole.motions = std::move(copy.motions);
  whole.load_laws = std::move(copy.load_laws);
  Domain moved = part.domain;
  moved.drift({whole.reach.drift.velocity.x, whole.reach.drift.velocity.y, 0.0}, part.time);
  moved.partition.move(moved.drifted);
  whole.domain.partition = moved.partition;
  whole.servos = part.servos;
  whole.fluid = part.fluid;
  copy_time(part, whole);
  derive_couples(whole);
}

}  // namespace breccia::fdem
