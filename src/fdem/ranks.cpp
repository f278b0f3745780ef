#include "fdem/ranks.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::fdem {
namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// How a triangle lies in the mesh: by numbers of the whole mesh while it is on its way.
struct Neighbourhood {
  EdgeJoints edges;
  Index across[3], vertex[3];
  EdgeDashpots dashpots;
};

/// Triangles around each vertex where corners move as one: what one of them does, all must know.
class Rings {
 public:
  explicit Rings(const World& w) {
    for (Index n = 0; n < static_cast<Index>(w.vertex.size()); ++n)
      if (w.mesh.tied[at(w.vertex[at(n)])] != 0) corners_.push_back({w.vertex[at(n)], n});
    std::sort(corners_.begin(), corners_.end());
  }
  /// Calls visit(first corner, end) for each ring; corners ascend.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < corners_.size();) {
      std::size_t end = i;
      while (end < corners_.size() && corners_[end].first == corners_[i].first) ++end;
      visit(corners_.data() + i, corners_.data() + end);
      i = end;
    }
  }
  void add_triangles(Index vertex, std::vector<Index>& triangles) const {
    const auto first =
        std::lower_bound(corners_.begin(), corners_.end(), std::pair<Index, Index>{vertex, -1});
    for (auto c = first; c != corners_.end() && c->first == vertex; ++c)
      triangles.push_back(c->second / 3);
  }

 private:
  std::vector<std::pair<Index, Index>> corners_;  ///< vertex and corner
};

/// How far a triangle's corners lie from its centroid.  [m]
double radius(const TriangleNodes& nodes) {
  const Vec3 middle = centroid(nodes);
  double far = 0.0;
  for (const NodeState& n : nodes.at)
    far = std::max(far, norm(n.position - Vec2{middle.x, middle.y}));
  return far;
}

std::vector<int> owners(const World& w) {
  std::vector<int> owner;
  for (const TriangleNodes& nodes : w.triangles.nodes.host())
    owner.push_back(w.domain.partition.owner(centroid(nodes)));
  return owner;
}

/// Sends everything to the ranks that need it: triangles and what ties them together.
class Journey {
 public:
  /// @param owner  rank that each local triangle will belong to
  Journey(World& w, const std::vector<int>& owner)
      : w_(w), owner_(owner), triangles_(w.domain.ranks->size()) {}

  /// Besides the owner, the ranks whose rectangle is within `width` of a triangle get a copy.
  void add_copies(double width) {
    for (Index t = 0; t < w_.triangles.size(); ++t) {
      if (!w_.domain.owns(t)) continue;
      const TriangleNodes& nodes = w_.triangles.nodes.data()[t];
      w_.domain.partition.each_near(centroid(nodes), radius(nodes) + width,
                                    [&](int r) { triangles_.add(r, t); });
    }
  }

  void go() {
    const int ranks = w_.domain.ranks->size();
    Deliveries joints(ranks), couples(ranks), reach(ranks);
    for (Index t = 0; t < w_.triangles.size(); ++t)
      if (w_.domain.owns(t)) triangles_.add(owner_of(t), t);
    tie_all(joints, couples);
    const auto can_touch = w_.reach.triangle.host();
    for (Index i = 0; i < w_.reach.triangle.size(); ++i)
      if (w_.domain.owns(can_touch[at(i)])) reach.add(owner_of(can_touch[at(i)]), i);

    leave();
    Triangles& t = w_.triangles;
    auto lie = one_field(lies_);
    auto external = one_field(t.external);
    triangles_.settle();
    const auto send_triangles = [&](auto&& state) {
      deal(*w_.domain.ranks, state, triangles_);
      sort_by(state, t.id);
    };
    if (w_.mesh.loaded.empty())
      send_triangles(together(t, lie));
    else
      send_triangles(together(t, lie, external));

    Joints& j = w_.joints;
    Buffer<Index>& number = w_.mesh.joint_number;
    auto numbers = one_field(number);
    auto force = one_field(j.force);
    auto preset = one_field(j.preset);
    j.force.resize(j.size());
    joints.settle();
    const auto send_joints = [&](auto&& state) {
      deal(*w_.domain.ranks, state, joints);
      sort_by(state, number);
    };
    if (w_.mesh.preset)
      send_joints(together(j, numbers, force, preset));
    else
      send_joints(together(j, numbers, force));
    j.force.resize(j.size() + 1);  // the last one is zero

    couples.settle();
    deal(*w_.domain.ranks, w_.couples, couples);
    sort_by(w_.couples, w_.couples.pairs.key);
    reach.settle();
    deal(*w_.domain.ranks, w_.reach, reach);
    sort_by(w_.reach, w_.reach.triangle);
    arrive();
  }

 private:
  int owner_of(Index t) const { return owner_[at(t)]; }

  void tie_all(Deliveries& joints, Deliveries& couples) {
    const Rings rings(w_);
    std::vector<Index> members;
    rings.each([&](const std::pair<Index, Index>* first, const std::pair<Index, Index>* end) {
      members.clear();
      for (; first != end; ++first) members.push_back(first->second / 3);
      tie(members);
    });
    for (Index i = 0; i < w_.joints.size(); ++i) {
      const Index a = w_.joints.edge_a.data()[i], b = w_.joints.edge_b.data()[i];
      members = {a / 3, b / 3};
      // Whether a joint around a vertex still holds decides who moves with whom there.
      for (const Index node : {a, JointEnds::next_corner(a)})
        if (w_.mesh.tied[at(w_.vertex[at(node)])] != 0)
          rings.add_triangles(w_.vertex[at(node)], members);
      tie(members);
      if (w_.domain.owns(a / 3))
        for (const Index t : members) joints.add(owner_of(t), i);
    }
    const Pairs& pairs = w_.couples.pairs;
    for (Index i = 0; i < pairs.size(); ++i) {
      members = {pairs.a.data()[i], pairs.b.data()[i]};
      tie(members);
      if (w_.domain.owns(members[0]))
        for (const Index t : members) couples.add(owner_of(t), i);
    }
  }

  /// What refers to several triangles lives wherever one of them is owned, and so do all of them.
  void tie(const std::vector<Index>& members) {
    for (const Index t : members) {
      if (!w_.domain.owns(t)) continue;
      for (const Index other : members)
        if (owner_of(other) != owner_of(t)) triangles_.add(owner_of(other), t);
    }
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
    for (Buffer<Index>* edges : {&w_.joints.edge_a, &w_.joints.edge_b})
      for (Index& edge : edges->host()) edge = global(edge);
    for (Buffer<Index>* ends : {&w_.couples.pairs.a, &w_.couples.pairs.b, &w_.reach.triangle})
      for (Index& t : ends->host()) t = id_of(t);
  }

  Index place(Index id) const { return place_of(w_.triangles.id, id); }
  Index local(Index edge) const { return 3 * place(edge / 3) + edge % 3; }

  /// And back again. Edges whose joint or neighbour is not here are those of copies.
  void arrive() {
    for (Buffer<Index>* edges : {&w_.joints.edge_a, &w_.joints.edge_b})
      for (Index& edge : edges->host()) edge = local(edge);
    for (Buffer<Index>* ends : {&w_.couples.pairs.a, &w_.couples.pairs.b, &w_.reach.triangle})
      for (Index& t : ends->host()) t = place(t);
    const Index count = w_.triangles.size();
    w_.edges.resize(count);
    if (w_.mesh.absorbs) w_.dashpots.resize(count);
    w_.across.resize(at(3 * count));
    w_.vertex.resize(at(3 * count));
    w_.node_vertex.clear();
    for (Index t = 0; t < count; ++t) {
      const Neighbourhood& n = lies_.data()[t];
      if (w_.mesh.absorbs) w_.dashpots.data()[t] = n.dashpots;
      for (int k = 0; k < 3; ++k) {
        Index entry = n.edges.at[k];
        if (entry >= 0) {
          const Index joint = find_place(w_.mesh.joint_number, pair_of(entry));
          entry = joint < 0 ? edge_free : 2 * joint + side_of(entry);
        }
        w_.edges.data()[t].at[k] = entry;
        const Index other = n.across[k] < 0 ? -1 : find_place(w_.triangles.id, n.across[k] / 3);
        w_.across[at(3 * t + k)] = other < 0 ? -1 : 3 * other + n.across[k] % 3;
        w_.vertex[at(3 * t + k)] = n.vertex[k];
      }
    }
  }

  World& w_;
  const std::vector<int>& owner_;
  Deliveries triangles_;
  Buffer<Neighbourhood> lies_;
};

/// The largest margin that a search now would give a triangle that this rank owns.  [m]
double margin_now(const World& w) {
  double fastest = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t) {
    if (!w.domain.owns(t)) continue;
    for (const NodeState& n : w.triangles.nodes.data()[t].at)
      fastest = std::max(fastest, norm(n.velocity));
  }
  return margin_rule(w).margin({fastest, 0.0, 0.0});
}

/// How far beyond their own corners triangles reach others of the same rank, until they are shared
/// out again (docs/theory-domain.md, section 2).
double halo_width(const World& w) {
  double largest = 0.0;
  for (const TriangleNodes& nodes : w.triangles.nodes.host())
    largest = std::max(largest, radius(nodes));
  largest = -w.domain.least(-largest);
  return (largest + 2.0 * w.domain.margin + 2.0 * w.domain.buffer) * (1.0 + 1e-6);
}

/// What a triangle costs: itself, and each of its joints and couples; shared ones by half.
std::vector<Load> loads_of(const World& w) {
  std::vector<std::int64_t> weight(at(w.triangles.size()), 2);
  for (const Buffer<Index>* edges : {&w.joints.edge_a, &w.joints.edge_b})
    for (const Index edge : edges->host()) ++weight[at(edge / 3)];
  for (const Buffer<Index>* ends : {&w.couples.pairs.a, &w.couples.pairs.b})
    for (const Index t : ends->host()) ++weight[at(t)];
  std::vector<Load> loads;
  for (Index t = 0; t < w.triangles.size(); ++t)
    if (w.domain.owns(t)) loads.push_back({centroid(w.triangles.nodes.data()[t]), weight[at(t)]});
  return loads;
}

/// What follows from the triangles and joints that are here.
void settle_in(World& w) {
  const Index count = w.triangles.size(), joints = w.joints.size();
  std::vector<JointEnds> ends;
  for (Index i = 0; i < joints; ++i)
    ends.push_back(JointEnds::of(w.joints.edge_a.data()[i], w.joints.edge_b.data()[i]));
  copy_to(w.joint_ends, ends);
  if (w.extrinsic) {
    w.stress.resize(count);
    w.overshoot.resize(joints);
  }
  std::vector<LoadedEdge> loaded;
  std::vector<Index> starts;
  for (LoadedEdge edge : w.mesh.loaded) {
    edge.triangle = find_place(w.triangles.id, edge.triangle);
    if (edge.triangle < 0) continue;
    if (loaded.empty() || loaded.back().triangle != edge.triangle)
      starts.push_back(static_cast<Index>(loaded.size()));
    loaded.push_back(edge);
  }
  starts.push_back(static_cast<Index>(loaded.size()));
  copy_to(w.loaded_edges, loaded);
  copy_to(w.load_starts, starts);

  // Rings without an owned triangle may be incomplete; nobody here needs them.
  std::vector<Index> first{0}, nodes;
  Rings(w).each([&](const std::pair<Index, Index>* begin, const std::pair<Index, Index>* end) {
    if (std::none_of(begin, end, [&](const auto& c) { return w.domain.owns(c.second / 3); }))
      return;
    for (; begin != end; ++begin) nodes.push_back(begin->second);
    first.push_back(static_cast<Index>(nodes.size()));
  });
  copy_to(w.bundles.starts, first);
  copy_to(w.bundles.nodes, nodes);
  derive(w);
}

void share_anew(World& w, bool first) {
  Domain& d = w.domain;
  const std::vector<Load> loads = loads_of(w);
  std::int64_t load = 0;
  for (const Load& l : loads) load += l.weight;
  if (first || (d.config.balance && imbalance(*d.ranks, load) > d.config.imbalance)) {
    d.partition.cut(*d.ranks, loads);
    ++d.counts.cuts;
  }
  std::vector<GlobalId> mine;  // before
  for (Index t = 0; t < w.triangles.size(); ++t)
    if (d.owns(t)) mine.push_back(w.triangles.id.data()[t]);
  // Elements may become faster until they are shared out again.
  d.margin = std::min(margin_rule(w).largest, -1.5 * d.least(-margin_now(w)));
  const std::vector<int> next_owner = owners(w);
  Journey journey(w, next_owner);
  journey.add_copies(halo_width(w));
  journey.go();

  const std::vector<int> owner = owners(w);
  const Index count = w.triangles.size();
  d.owned.resize(count);
  d.placed.clear();
  for (Index t = 0; t < count; ++t) {
    const bool own = owner[at(t)] == d.ranks->rank();
    d.owned.data()[t] = own ? 1 : 0;
    for (const NodeState& n : w.triangles.nodes.data()[t].at)
      d.placed.push_back({n.position.x, n.position.y, 0.0});
    if (own && !std::binary_search(mine.begin(), mine.end(), w.triangles.id.data()[t]))
      ++d.counts.moved;
  }
  d.halo.build(*d.ranks, w.triangles.id, owner);
  d.counts.copies = d.halo.copies();
  d.counts.owned = count - d.halo.copies();
  d.counts.load = 0;
  for (const Load& l : loads_of(w)) d.counts.load += l.weight;
  ++d.counts.migrations;
  settle_in(w);
}

/// Whether some corner has left the buffer; nowhere (NaN) counts as left.
bool has_left(const World& w) {
  const double allowed = w.domain.buffer * w.domain.buffer;
  for (Index t = 0; t < w.triangles.size(); ++t) {
    if (!w.domain.owns(t)) continue;
    for (Index k = 0; k < 3; ++k) {
      const Vec2& x = w.triangles.nodes.data()[t].at[k].position;
      const Vec3 moved = Vec3{x.x, x.y, 0.0} - w.domain.placed[at(3 * t + k)];
      if (!(dot(moved, moved) <= allowed)) return true;
    }
  }
  return false;
}

/// What all ranks know alike, as rank 0 has it.
void take_common(World& w, Communicator& ranks) {
  for (double* time : {&w.time, &w.last_dt, &w.next_dt}) take_from_first(ranks, *time);
  take_from_first(ranks, w.step);
  take_from_first(ranks, w.searches);
  for (Buffer<std::uint8_t>* flags : {&w.opened.changed, &w.opened.vertex}) {
    Message message(static_cast<std::size_t>(flags->size()));
    std::memcpy(message.data(), flags->data(), message.size());
    message = ranks.from_first(std::move(message));
    std::memcpy(flags->data(), message.data(), message.size());
  }
}

void note_mesh(World& whole) {
  WholeMesh& mesh = whole.mesh;
  mesh.tied.assign(whole.open_vertex.size(), 0);
  for (const Index node : whole.bundles.nodes.host()) mesh.tied[at(whole.vertex[at(node)])] = 1;
  mesh.bundled = whole.bundles.nodes.size() > 0;
  copy_to(mesh.loaded, whole.loaded_edges);
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
  w.joints.force.resize(0);
  w.joints.preset.resize(0);
  w.edges.resize(0);
  w.dashpots.resize(0);
  w.across.clear();
  w.vertex.clear();
}

void refresh_copies(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh(w.triangles.nodes);
}

World share_out(World& whole, Communicator& ranks, const DomainConfig& config) {
  if (whole.mesh.tied.empty()) note_mesh(whole);
  World w = whole;
  Domain& d = w.domain;
  d.ranks = &ranks;
  d.config = config;
  d.buffer = config.buffer * w.parameters.mean_edge;
  w.mesh.joint_number.resize(w.joints.size());
  for (Index i = 0; i < w.joints.size(); ++i) w.mesh.joint_number.data()[i] = i;
  if (ranks.rank() != 0) {
    drop_state(w);
    w.mesh.joint_number.resize(0);
  }
  take_common(w, ranks);
  w.ledger = {};  // what this rank books from here on
  d.owned.resize(w.triangles.size());
  std::fill(d.owned.host().begin(), d.owned.host().end(), std::uint8_t{1});

  Vec3 low{no_limit, no_limit, 0.0}, minus_high = low;
  for (const TriangleNodes& nodes : w.triangles.nodes.host()) {
    const Vec3 x = centroid(nodes);
    low = {std::min(low.x, x.x), std::min(low.y, x.y), 0.0};
    minus_high = {std::min(minus_high.x, -x.x), std::min(minus_high.y, -x.y), 0.0};
  }
  low = {ranks.least(low.x), ranks.least(low.y), 0.0};
  minus_high = {ranks.least(minus_high.x), ranks.least(minus_high.y), 0.0};
  d.partition = Partition(ranks.size(), low, -minus_high - low,
                          w.parameters.mean_edge / config.refinement, 2);
  share_anew(w, true);
  return w;
}

void migrate(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "migration");
  const bool beyond = has_left(w) || !(margin_now(w) <= w.domain.margin);
  if (w.domain.any(beyond)) share_anew(w, false);
}

void collect(World& part, World& whole) {
  World copy(part.exec);
  copy.triangles = part.triangles;
  copy.joints = part.joints;
  copy.couples = part.couples;
  copy.reach = part.reach;
  copy.edges = part.edges;
  copy.dashpots = part.dashpots;
  copy.across = part.across;
  copy.vertex = part.vertex;
  copy.mesh = part.mesh;
  copy.domain.ranks = part.domain.ranks;
  copy.domain.owned = part.domain.owned;
  // What lies around a triangle stays: rank 0 knows the whole mesh.
  Journey(copy, std::vector<int>(at(part.triangles.size()), 0)).go();

  Communicator& ranks = *part.domain.ranks;
  Message booked(sizeof part.ledger);
  std::memcpy(booked.data(), &part.ledger, sizeof part.ledger);
  const std::vector<Message> all = ranks.from_all(booked);
  part.ledger = {};
  std::uint64_t changed = 0;
  for (Index i = 0; i < part.opened.changed.size(); ++i)
    if (part.opened.changed.data()[i] != 0) changed |= std::uint64_t{1} << i;
  changed = ranks.any_of(changed);
  if (ranks.rank() != 0) return;
  for (const Message& message : all) {
    Ledger ledger;
    std::memcpy(&ledger, message.data(), sizeof ledger);
    whole.ledger.rubbed.add(ledger.rubbed);
    whole.ledger.lost.add(ledger.lost);
    whole.ledger.inserted.add(ledger.inserted);
  }
  whole.triangles = std::move(copy.triangles);
  whole.joints = std::move(copy.joints);
  whole.couples = std::move(copy.couples);
  whole.reach = std::move(copy.reach);
  whole.opened = part.opened;
  for (Index i = 0; i < whole.opened.changed.size(); ++i)
    whole.opened.changed.data()[i] = (changed >> i & 1) != 0 ? 1 : 0;
  whole.motions = part.motions;
  whole.load_laws = part.load_laws;
  whole.domain.partition = part.domain.partition;
  whole.time = part.time;
  whole.last_dt = part.last_dt;
  whole.next_dt = part.next_dt;
  whole.step = part.step;
  whole.searches = part.searches;
}

}  // namespace breccia::fdem
