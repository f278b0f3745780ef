#pragma once
// How elements change ranks, with all that ties them: the text of fdem_shared/ranks.hpp. Each
// method's ranks.cpp includes it together with its relations and makes the functions for its world.

#include <algorithm>
#include <cmath>

#include "core/energy.hpp"
#include "core/relation.hpp"
#include "domain/drift.hpp"
#include "domain/ghosts.hpp"
#include "domain/owned.hpp"
#include "domain/together.hpp"
#include "fdem_shared/ranks.hpp"
#include "fdem_shared/rings.hpp"

namespace breccia::fdem_shared {

/// How an element lies in the mesh: by numbers of the whole mesh while it is on its way.
template <class Shape>
struct Neighbourhood {
  typename Shape::Sides sides;
  Index across[Shape::corners], vertex[Shape::corners];
  typename Shape::Dashpots dashpots;
};

/// Sends everything to the ranks that need it: elements and what ties them together.
template <class World>
class Migration {
  using Shape = ShapeOf<World>;
  static constexpr Index corners = Shape::corners;

 public:
  /// @param owner  rank that each local element will belong to
  Migration(World& w, const std::vector<int>& owner)
      : w_(w), elements_(w.domain.ranks->size()), shared_items_(w.domain, owner, elements_) {}

  /// Besides the owner, the ranks whose elements may touch one get a copy.
  void add_copies(const std::vector<Sphere>& around) {
    add_ghosts(w_.domain, around, shared_items_, elements_);
  }

  void go() {
    Communicator& all = *w_.domain.ranks;
    SendLists joints(all.size()), couples(all.size()), reach(all.size());
    auto& e = Shape::elements(w_);
    for (Index t = 0; t < e.size(); ++t)
      if (w_.domain.owns(t)) elements_.add(shared_items_.owner_of(t), t);
    tie_all(joints, couples);
    Buffer<Index>& can_touch = w_.reach.element;
    for (Index i = 0; i < can_touch.size(); ++i) {
      const Index t = can_touch.data()[i];
      if (w_.domain.owns(t)) reach.add(shared_items_.owner_of(t), i);
    }

    leave();
    auto lie = one_field(lies_);
    auto external = one_field(e.external);
    if (w_.mesh.loaded)
      redistribute(all, together(e, lie, external), elements_, e.id);
    else
      redistribute(all, together(e, lie), elements_, e.id);

    auto& j = w_.joints;
    Buffer<Index>& number = w_.mesh.joint_number;
    auto numbers = one_field(number);
    auto preset = one_field(j.preset);
    Shape::with_joint_forces(w_, [&, this](auto& forces) {
      auto force = one_field(forces);
      if (w_.mesh.preset)
        redistribute(all, together(j, numbers, force, preset), joints, number);
      else
        redistribute(all, together(j, numbers, force), joints, number);
    });

    redistribute(all, w_.couples, couples, w_.couples.pairs.key);
    redistribute(all, w_.reach, reach, can_touch);
    arrive();
  }

 private:
  void tie_all(SendLists& joints, SendLists& couples) {
    const Rings<World> rings(w_);
    std::vector<Index> members;
    rings.each([&](const KeyedIndex* first, const KeyedIndex* end) {
      members.clear();
      for (; first != end; ++first) members.push_back(first->item / corners);
      shared_items_.keep_together(members);
    });
    for (Index i = 0; i < w_.joints.size(); ++i) {
      members = {Shape::side_a(w_.joints).data()[i] / corners,
                 Shape::side_b(w_.joints).data()[i] / corners};
      add_around_joint(rings, i, members);
      shared_items_.keep_together(members, i, joints);
    }
    shared_items_.keep_all_together(element_ends(w_, "couples"), w_.couples.size(), couples);
  }

  /// Whether a joint around a vertex sleeps decides who moves with whom there.
  void add_around_joint(const Rings<World>& rings, Index joint, std::vector<Index>& members) const {
    if (!w_.given->extrinsic) return;
    const Index side = Shape::side_a(w_.joints).data()[joint];
    for (int k = 0; k < Shape::dimension; ++k) {
      const Index node = corners * (side / corners) + Shape::corner_of_side(side % corners, k);
      const Index vertex = w_.vertex[at(node)];
      if (w_.mesh.tied[at(vertex)] != 0) rings.add_elements(vertex, members);
    }
  }
  Index id_of(Index t) const { return Shape::elements(w_).id.data()[t]; }
  Index global(Index side) const {
    return side < 0 ? side : corners * id_of(side / corners) + side % corners;
  }

  /// Places in memory become numbers of the whole mesh.
  void leave() {
    const Index count = Shape::elements(w_).size();
    lies_.resize(count);
    for (Index t = 0; t < count; ++t) {
      Neighbourhood<Shape>& n = lies_.data()[t];
      n.sides = Shape::sides(w_).data()[t];
      if (w_.mesh.absorbs) n.dashpots = w_.dashpots.data()[t];
      for (int k = 0; k < corners; ++k) {
        Index& entry = n.sides.at[k];
        if (entry >= 0) entry = 2 * w_.mesh.joint_number.data()[pair_of(entry)] + side_of(entry);
        n.across[k] = global(w_.across[at(corners * t + k)]);
        n.vertex[k] = w_.vertex[at(corners * t + k)];
      }
    }
    renumber_relations(w_, [this](Index t) { return id_of(t); });
  }

  /// And back again. Sides whose joint or neighbour is not here are those of ghosts.
  void arrive() {
    Places elements(Shape::elements(w_).id), joints(w_.mesh.joint_number);
    renumber_relations(w_, [&elements](Index id) { return elements.of(id); });
    const Index count = Shape::elements(w_).size();
    Shape::sides(w_).resize(count);
    if (w_.mesh.absorbs) w_.dashpots.resize(count);
    w_.across.resize(at(corners * count));
    w_.vertex.resize(at(corners * count));
    Shape::forget_mesh_for_kernels(w_);
    for (Index t = 0; t < count; ++t) {
      const Neighbourhood<Shape>& n = lies_.data()[t];
      if (w_.mesh.absorbs) w_.dashpots.data()[t] = n.dashpots;
      for (int k = 0; k < corners; ++k) {
        Index entry = n.sides.at[k];
        if (entry >= 0) {
          const Index joint = joints.find(pair_of(entry));
          entry = joint < 0 ? Shape::side_free : 2 * joint + side_of(entry);
        }
        Shape::sides(w_).data()[t].at[k] = entry;
        const Index other = n.across[k] < 0 ? -1 : elements.find(n.across[k] / corners);
        w_.across[at(corners * t + k)] = other < 0 ? -1 : corners * other + n.across[k] % corners;
        w_.vertex[at(corners * t + k)] = n.vertex[k];
      }
    }
  }

  World& w_;
  SendLists elements_;
  SharedItems shared_items_;
  Buffer<Neighbourhood<Shape>> lies_;
};

/// Derives arrays from the elements and joints of this rank.
/// @param space  where the elements go when they have settled in
template <class World>
void settle_in(World& w, Space space) {
  using Shape = ShapeOf<World>;
  constexpr Index corners = Shape::corners;
  Shape::derive_part(w, space);

  // Rings without an owned element may be incomplete; nobody here needs them.
  std::vector<Index> first{0}, nodes;
  Rings<World>(w).each([&](const KeyedIndex* begin, const KeyedIndex* end) {
    const auto owned = [&](const KeyedIndex& c) { return w.domain.owns(c.item / corners); };
    if (std::none_of(begin, end, owned)) return;
    for (; begin != end; ++begin) nodes.push_back(begin->item);
    first.push_back(static_cast<Index>(nodes.size()));
  });
  copy_to(w.bundles.starts, first);
  copy_to(w.bundles.nodes, nodes);

  Domain& d = w.domain;
  d.tied.assign(at(Shape::elements(w).size()), 0);
  if (w.mesh.bundled) {
    for (const Index node : nodes) d.tied[at(node / corners)] = 1;
    std::vector<Ghost> in_rings;
    for (const Ghost& ghost : d.ghosts)
      if (d.tied[at(ghost.element)] != 0) in_rings.push_back(ghost);
    w.tied_forces.build(*d.ranks, Shape::elements(w).id, in_rings, space);
  }
  mark_joined(w, d.tied);
}

/// Square of an element's largest speed.
template <class Shape>
struct LargestSpeed {
  typename Shape::Vector drift;  ///<  [m/s]
  View<const typename Shape::Nodes> nodes;
  BR_HD double operator()(Index t) const {
    double fastest = 0.0;
    for (const auto& n : nodes[t].at) {
      const typename Shape::Vector velocity = n.velocity - drift;
      fastest = max(fastest, dot(velocity, velocity));
    }
    return fastest;
  }
};

/// 1 where a corner has left the buffer.
template <class Shape>
struct HasLeftBuffer {
  double allowed;  ///< square of the way that it may go  [m2]
  Vec3 drifted;    ///< common to all since they were placed  [m]
  View<const typename Shape::Nodes> nodes;
  View<const Vec3> reference;
  BR_HD double operator()(Index t) const {
    bool left = false;
    for (int k = 0; k < Shape::corners; ++k) {
      const Vec3 moved =
          (to_space(nodes[t].at[k].position) - reference[Shape::corners * t + k]) - drifted;
      if (!(dot(moved, moved) <= allowed)) left = true;
    }
    return left ? 1.0 : 0.0;
  }
};

/// A world's elements as a re-partition sees them.
template <class World>
class SharedMesh final : public Shareable {
  using Shape = ShapeOf<World>;

 public:
  /// @param space  where the elements go when they have settled in
  SharedMesh(World& w, Space space) : w_(w), space_(space) {}

  Space space() const override { return space_; }
  void come_to_host() override { move_to(w_, Space::host); }

  const Buffer<GlobalId>& ids() const override { return elements().id; }
  void look() override {
    if (on_host()) return;
    copy_to(seen_, elements().nodes);
    copy_to(seen_references_, Shape::reference(elements()));
  }
  Vec3 centre(Index t) const override { return centroid(nodes().data()[t]); }
  /// With what counts as near to it.
  double radius(Index t) const override {
    const Vec3 middle = centre(t);
    double far = 0.0;
    for (const auto& n : nodes().data()[t].at) {
      const Vec3 way = to_space(n.position) - middle;
      far = std::max(far, dot(way, way));
    }
    return std::sqrt(far) + Shape::near(references().data()[t]);
  }
  std::vector<Vec3> points() const override {
    std::vector<Vec3> points;
    points.reserve(at(Shape::corners * elements().size()));
    for (const auto& nodes : elements().nodes.host())
      for (const auto& n : nodes.at) points.push_back(to_space(n.position));
    return points;
  }
  std::vector<std::int64_t> weights() const override {
    constexpr auto cost = Shape::costs;
    std::vector<std::int64_t> weight(at(elements().size()), cost.element);
    for (const Buffer<Index>* sides : {&Shape::side_a(w_.joints), &Shape::side_b(w_.joints)})
      for (const Index side : sides->host()) weight[at(side / Shape::corners)] += cost.end_of_joint;
    for (const Buffer<Index>* ends : {&w_.couples.pairs.a, &w_.couples.pairs.b})
      for (const Index t : ends->host()) weight[at(t)] += cost.end_of_couple;
    for (std::size_t corner = 0; w_.mesh.bundled && corner < w_.vertex.size(); ++corner)
      if (w_.mesh.tied[at(w_.vertex[corner])] != 0)
        weight[corner / at(Shape::corners)] += cost.tied_corner;
    return weight;
  }
  double margin() const override {
    const double fastest = fold_owned(
        w_.exec, w_.domain, elements().size(), 0.0,
        LargestSpeed<Shape>{w_.reach.drift.velocity, std::as_const(elements()).nodes.view()},
        Largest{});
    return margin_rule(w_).margin({std::sqrt(fastest), 0.0, 0.0});
  }
  bool has_left() const override {
    const HasLeftBuffer<Shape> left{w_.domain.buffer * w_.domain.buffer, w_.domain.drifted,
                                    std::as_const(elements()).nodes.view(),
                                    std::as_const(w_.domain.migration_reference).view()};
    return fold_owned(w_.exec, w_.domain, elements().size(), 0.0, left, Largest{}) > 0.0;
  }
  double largest_margin() const override { return margin_rule(w_).largest; }
  void send(const std::vector<int>& owner, const std::vector<Sphere>& around) override {
    Migration<World> migration(w_, owner);
    migration.add_copies(around);
    migration.go();
  }
  void settle_in() override {
    fdem_shared::settle_in(w_, space_);
    move_to(w_, space_);
    derive_bundles(w_);
  }

 private:
  auto& elements() const { return Shape::elements(w_); }
  bool on_host() const { return elements().nodes.space() == Space::host; }
  const auto& nodes() const { return on_host() ? elements().nodes : seen_; }
  const auto& references() const {
    return on_host() ? Shape::reference(elements()) : seen_references_;
  }

  World& w_;
  Space space_;
  Buffer<typename Shape::Nodes> seen_;  ///< on the host, while elements are elsewhere
  Buffer<typename Shape::Reference> seen_references_;  ///< likewise
};

/// Derives arrays from couples that came with their elements. A search finds them for its own.
template <class World>
void go_on_with_couples(World& w) {
  derive_couples(w);
  select_active_ghosts(w);
}

/// Data that all ranks share, as rank 0 has them.
template <class World>
void take_common(World& w, Communicator& ranks) {
  take_time_from_first(ranks, w);
  take_from_first(ranks, w.reach.drift);
  for (auto& servo : w.servos) take_from_first(ranks, servo);
  for (auto& body : w.rigid) take_from_first(ranks, body);
  ShapeOf<World>::take_common(w, ranks);
  for (Buffer<std::uint8_t>* flags : {&w.exposed.changed, &w.exposed.vertex}) {
    Message message;
    put_bytes(message, flags->data(), at(flags->size()));
    message = ranks.from_first(std::move(message));
    std::copy_n(reinterpret_cast<const std::uint8_t*>(message.data()), message.size(),
                flags->data());
  }
}

/// Stores mesh-wide data where they are not known yet.
template <class World>
void note_mesh(World& whole) {
  auto& mesh = whole.mesh;
  if (!mesh.tied.empty()) return;
  mesh.tied.assign(whole.given->open_vertex.size(), 0);
  for (const Index node : whole.bundles.nodes.host()) mesh.tied[at(whole.vertex[at(node)])] = 1;
  mesh.bundled = whole.bundles.nodes.size() > 0;
  mesh.loaded = ShapeOf<World>::elements(whole).external.size() > 0;
  mesh.absorbs = whole.dashpots.size() > 0;
  mesh.preset = whole.joints.preset.size() > 0;
}

template <class World>
void drop_state(World& w) {
  using Shape = ShapeOf<World>;
  resize_fields(Shape::elements(w), 0);
  resize_fields(w.joints, 0);
  resize_fields(w.couples, 0);
  resize_fields(w.reach, 0);
  Shape::elements(w).external.resize(0);
  Shape::drop_joint_forces(w.joints);
  w.joints.preset.resize(0);
  Shape::sides(w).resize(0);
  w.dashpots.resize(0);
  w.across.clear();
  w.vertex.clear();
}

template <class World>
World share_out(World& whole, Communicator& ranks, const DomainConfig& config, Space space) {
  note_mesh(whole);
  World w = whole;
  w.mesh.joint_number.resize(w.joints.size());
  for (Index i = 0; i < w.joints.size(); ++i) w.mesh.joint_number.data()[i] = i;
  if (ranks.rank() != 0) {
    drop_state(w);
    w.mesh.joint_number.resize(0);
  }
  const std::vector<std::uint8_t> all(at(ShapeOf<World>::elements(w).size()), 1);
  return share_parts(std::move(w), all, ranks, config, space);
}

template <class World>
World share_parts(World part, const std::vector<std::uint8_t>& own, Communicator& ranks,
                  const DomainConfig& config, Space space) {
  note_mesh(part);
  take_common(part, ranks);
  part.ledger = {};  // what this rank books from here on
  SharedMesh mesh(part, space);
  begin_sharing(part.domain, ranks, config, mesh, part.given->mean_edge, ShapeOf<World>::dimension);
  copy_to(part.domain.owned, own);
  part.domain.drifted_until = part.time;
  share_anew(part.domain, mesh, true);
  go_on_with_couples(part);
  return part;
}

template <class World>
void migrate(World& w) {
  if (w.domain.single_rank()) return;
  SharedMesh mesh(w, w.exec.space);
  breccia::migrate(w, mesh);
}

template <class World>
void rebalance(World& w) {
  if (!is_uneven(w.domain)) return;
  SharedMesh mesh(w, w.exec.space);
  breccia::rebalance(w, to_space(w.reach.drift.velocity), mesh);
  go_on_with_couples(w);
}

template <class World>
void collect(World& part, World& whole) {
  using Shape = ShapeOf<World>;
  World copy = part;
  move_to(copy, Space::host);
  // Neighbours of an element stay: rank 0 knows the whole mesh.
  Migration(copy, std::vector<int>(at(Shape::elements(part).size()), 0)).go();

  Communicator& ranks = *part.domain.ranks;
  const std::vector<Ledger> booked = from_each(ranks, part.ledger);
  part.ledger = {};
  std::uint64_t changed = 0;
  for (Index i = 0; i < copy.exposed.changed.size(); ++i)
    if (copy.exposed.changed.data()[i] != 0) changed |= std::uint64_t{1} << i;
  changed = ranks.any_of(changed);
  if (ranks.rank() != 0) return;
  for (const Ledger& ledger : booked) whole.ledger.add(ledger);
  Shape::elements(whole) = std::move(Shape::elements(copy));
  whole.joints = std::move(copy.joints);
  whole.couples = std::move(copy.couples);
  whole.reach = std::move(copy.reach);
  whole.exposed = std::move(copy.exposed);
  for (Index i = 0; i < whole.exposed.changed.size(); ++i)
    whole.exposed.changed.data()[i] = (changed >> i & 1) != 0 ? 1 : 0;
  whole.motions = std::move(copy.motions);
  whole.load_laws = std::move(copy.load_laws);
  whole.domain.partition =
      partition_at(part.domain, to_space(part.reach.drift.velocity), part.time);
  whole.servos = part.servos;
  whole.rigid = part.rigid;
  Shape::collect_common(part, whole);
  copy_time(part, whole);
  derive_couples(whole);
}

}  // namespace breccia::fdem_shared
