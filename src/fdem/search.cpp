// New couples: the shared search over the triangles that can touch, less the neighbours that are
// still joined, with the history of those that stay.

#include <algorithm>
#include <array>

#include "exec/for_each.hpp"
#include "fdem/ranks.hpp"

namespace breccia::fdem {
namespace {

/// Starts the travel of a triangle anew and boxes it with its margin.
struct BeginReach {
  double skin, horizon, largest;  ///<  [m], [s], [m]
  View<const Index> triangle;
  View<const TriangleNodes> nodes;
  View<const GlobalId> id_of;
  View<Corners> reference;
  View<double> margin;
  View<Box> boxes;
  View<GlobalId> ids;
  BR_HD void operator()(Index i) const {
    const TriangleNodes& now = nodes[triangle[i]];
    double fastest = 0.0, extent = 0.0;
    for (const NodeState& n : now.at) {
      fastest = larger(fastest, norm(n.velocity));
      extent = larger(extent, larger(absolute(n.position.x), absolute(n.position.y)));
    }
    const double own = smaller(0.5 * skin + fastest * horizon, largest);
    Box box{{1e300, 1e300, 0.0}, {-1e300, -1e300, 0.0}};
    const double grown = own * (1.0 + 1e-12) + 1e-15 * extent;  // covers rounding
    for (int k = 0; k < 3; ++k) {
      const Vec2& x = now.at[k].position;
      reference[i].at[k] = x;
      box.low.x = smaller(box.low.x, x.x - grown);
      box.low.y = smaller(box.low.y, x.y - grown);
      box.high.x = larger(box.high.x, x.x + grown);
      box.high.y = larger(box.high.y, x.y + grown);
    }
    margin[i] = own;
    boxes[i] = box;
    ids[i] = id_of[triangle[i]];
  }
};

/// Marks the vertices that some rank has marked and this one has not.
void share_marks(const World& w, std::vector<std::uint8_t>& vertex) {
  if (w.domain.alone()) return;
  std::vector<std::uint8_t> known;
  copy_to(known, w.opened.vertex);
  Message news;
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    if (vertex[v] == 0 || known[v] != 0) continue;
    const auto number = static_cast<Index>(v);
    const auto* bytes = reinterpret_cast<const std::byte*>(&number);
    news.insert(news.end(), bytes, bytes + sizeof number);
  }
  for (std::size_t v = 0; v < vertex.size(); ++v) vertex[v] |= known[v];  // damage stays
  for (const Message& message : w.domain.ranks->from_all(news))
    for (std::size_t at = 0; at < message.size(); at += sizeof(Index)) {
      Index number = 0;
      std::memcpy(&number, message.data() + at, sizeof number);
      vertex[static_cast<std::size_t>(number)] = 1;
    }
}

/// Marks the vertices of damaged joints.
void mark_opened(World& w) {
  std::vector<JointStage> stage;
  std::vector<Index> edge_a;
  copy_to(stage, w.joints.stage);
  copy_to(edge_a, w.joints.edge_a);
  std::vector<std::uint8_t> vertex(w.open_vertex.size(), 0);
  for (std::size_t i = 0; i < stage.size(); ++i) {
    if (!is_damaged(stage[i])) continue;
    for (const Index node : {edge_a[i], JointEnds::next_corner(edge_a[i])})
      vertex[static_cast<std::size_t>(w.vertex[static_cast<std::size_t>(node)])] = 1;
  }
  share_marks(w, vertex);
  copy_to(w.opened.vertex, vertex);
  copy_to(w.opened.changed, std::vector<std::uint8_t>{0, 0});
}

/// Whether vertices must be marked now: at once when a joint breaks, since its triangles touch from
/// the next step on; when one softens, at the next of these steps.
bool marking_is_due(const World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.opened.changed);
  return marking_due(changed[change_softened], changed[change_broken], w.step);
}

/// What a search reads of the mesh on the host.
struct Topology {
  std::vector<EdgeJoints> edges;
  std::vector<JointStage> stage;
  std::vector<std::uint8_t> open;  ///< World::open_vertex, and bit 2: a joint here is damaged

  explicit Topology(const World& w) : open(w.open_vertex) {
    copy_to(edges, w.edges);
    copy_to(stage, w.joints.stage);
    std::vector<std::uint8_t> damaged;
    copy_to(damaged, w.opened.vertex);
    for (std::size_t v = 0; v < open.size(); ++v)
      if (damaged[v] != 0) open[v] |= 4;
  }
  static std::size_t vertex(const World& w, Index node) {
    return static_cast<std::size_t>(w.vertex[static_cast<std::size_t>(node)]);
  }
};

/// Triangles with a corner at the border, at an edge that nothing joins, or at a damaged joint.
std::vector<Index> touchable(const World& w, const Topology& topology) {
  std::vector<Index> triangles;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (Index k = 0; k < 3; ++k)
      if (topology.open[Topology::vertex(w, 3 * t + k)] != 0) {
        triangles.push_back(t);
        break;
      }
  return triangles;
}

/// Whether a couple can touch. Neighbours across an edge do once nothing joins them; neighbours at
/// a vertex do once a joint around it is damaged.
bool may_touch(const World& w, const Topology& topology, Index a, Index b) {
  int shared = 0, edge = 0;
  std::uint8_t open = 0;
  std::array<bool, 3> common{};
  for (Index k = 0; k < 3; ++k)
    for (Index m = 0; m < 3; ++m) {
      const std::size_t v = Topology::vertex(w, 3 * a + k);
      if (v != Topology::vertex(w, 3 * b + m)) continue;
      ++shared;
      open |= topology.open[v];
      common[static_cast<std::size_t>(k)] = true;
    }
  if (shared == 0) return true;
  if (shared == 1) return (open & 6) != 0;
  while (
      !(common[static_cast<std::size_t>(edge)] && common[static_cast<std::size_t>((edge + 1) % 3)]))
    ++edge;
  const Index entry = topology.edges[static_cast<std::size_t>(a)].at[edge];
  if (entry < 0) return entry == edge_free;
  return topology.stage[static_cast<std::size_t>(pair_of(entry))] == JointStage::broken;
}

void book_dropped(World& w, const Pairs& found) {
  Buffer<Index> dropped(w.exec.space);
  find_dropped(w.exec, w.couples.pairs.key, found.key, dropped);
  if (dropped.empty()) return;
  std::vector<Index> places;
  std::vector<CoupleState> states;
  std::vector<Index> a;
  copy_to(places, dropped);
  copy_to(a, w.couples.pairs.a);
  copy_to(states, w.couples.history.state);
  for (const Index place : places) {
    if (!w.domain.owns(a[static_cast<std::size_t>(place)])) continue;  // the owner of a books it
    const CoupleState& s = states[static_cast<std::size_t>(place)];
    w.ledger.rubbed.add(s.rubbed + s.slid);
    w.ledger.lost.add(s.lost + s.work - s.slid);
  }
}

bool margin_is_used(const World& w) {
  const double used = fold(w.exec, w.reach.triangle.size(), 0.0,
                           UsedMargin{w.reach.triangle.view(), w.reach.reference.view(),
                                      w.reach.margin.view(), w.triangles.nodes.view()},
                           Largest{});
  return used > 0.0;
}

/// Whether a search is due on some rank; what joints tell becomes known to all.
bool any_rank_is_due(World& w) {
  std::vector<std::uint8_t> changed;
  copy_to(changed, w.opened.changed);
  std::uint64_t bits = margin_is_used(w) ? 4 : 0;
  for (std::size_t i = 0; i < changed.size(); ++i)
    if (changed[i] != 0) bits |= std::uint64_t{1} << i;
  bits = w.domain.any_of(bits);
  for (std::size_t i = 0; i < changed.size(); ++i) changed[i] = (bits >> i & 1) != 0 ? 1 : 0;
  copy_to(w.opened.changed, changed);
  return marking_is_due(w) || (bits & 4) != 0;
}

/// The couples that may touch until the next search.
void search(World& w) {
  const Topology topology(w);
  const std::vector<Index> triangles = touchable(w, topology);
  const auto count = static_cast<Index>(triangles.size());
  copy_to(w.reach.triangle, triangles);
  w.reach.reference.resize(count);
  w.reach.margin.resize(count);
  Buffer<Box> boxes(w.exec.space, count);
  Buffer<GlobalId> ids(w.exec.space, count);
  const MarginRule rule = margin_rule(w);
  for_each(w.exec, count,
           BeginReach{rule.base, rule.horizon, rule.largest, std::as_const(w.reach.triangle).view(),
                      std::as_const(w.triangles.nodes).view(), std::as_const(w.triangles.id).view(),
                      w.reach.reference.view(), w.reach.margin.view(), boxes.view(), ids.view()});
  Pairs found(w.exec.space);
  if (count > 0) w.broad_phase.search(w.exec, boxes, ids, found);

  std::vector<PairKey> key, kept_key;
  std::vector<Index> a, b, kept_a, kept_b;
  copy_to(key, found.key);
  copy_to(a, found.a);
  copy_to(b, found.b);
  for (std::size_t i = 0; i < key.size(); ++i) {
    const Index first = triangles[static_cast<std::size_t>(a[i])];
    const Index second = triangles[static_cast<std::size_t>(b[i])];
    if (!w.domain.owns(first) && !w.domain.owns(second)) continue;
    if (!may_touch(w, topology, first, second)) continue;
    kept_key.push_back(key[i]);
    kept_a.push_back(first);
    kept_b.push_back(second);
  }
  copy_to(found.key, kept_key);
  copy_to(found.a, kept_a);
  copy_to(found.b, kept_b);
  book_dropped(w, found);
  w.couples.replace(w.exec, std::move(found));
  derive_couples(w);
  w.graphs.clear();
  ++w.searches;
}

}  // namespace

MarginRule margin_rule(const World& w) {
  constexpr double horizon = 30.0;  // steps for which a fast triangle's margin shall last
  return {w.parameters.skin, horizon * w.next_dt, 0.5 * w.parameters.mean_edge};
}

bool couples_are_due(World& w) {
  const StageTime timed(w.exec, "travel");
  if (!w.domain.alone()) return any_rank_is_due(w);
  return marking_is_due(w) || margin_is_used(w);
}

void find_couples(World& w) {
  migrate(w);
  const StageTime timed(w.exec, "contact_detection");
  const bool joints_changed = marking_is_due(w);
  if (joints_changed) mark_opened(w);
  together_or_not(w.domain.ranks, [&w] { search(w); });
  if (joints_changed && w.next_dt > 0.0) w.next_dt = shortened_time_step(w, w.reach.triangle);
}

void derive_couples(World& w) {
  const Pairs& pairs = w.couples.pairs;
  build_incidence(w.exec, pairs.a, pairs.b, w.triangles.id, w.couple_incidence);
  std::vector<Index> a, b;
  std::vector<EdgeJoints> edges;
  std::vector<double> pressing, broke_at;
  copy_to(a, pairs.a);
  copy_to(b, pairs.b);
  copy_to(edges, w.edges);
  copy_to(pressing, w.joints.pressing);
  copy_to(broke_at, w.joints.broke_at);
  // Faces that meet again later begin anew: only a joint that broke in the last step counts.
  const double lately = w.time - 1.5 * w.last_dt;
  std::vector<Index> edge_a, edge_b;
  copy_to(edge_a, w.joints.edge_a);
  copy_to(edge_b, w.joints.edge_b);
  std::vector<double> born(a.size(), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (const Index entry : edges[static_cast<std::size_t>(a[i])].at) {
      if (entry < 0) continue;
      const auto joint = static_cast<std::size_t>(pair_of(entry));
      const Index other = (side_of(entry) == 0 ? edge_b[joint] : edge_a[joint]) / 3;
      if (other == b[i] && broke_at[joint] >= lately) born[i] = pressing[joint];
    }
  copy_to(w.born, born);
}

}  // namespace breccia::fdem
