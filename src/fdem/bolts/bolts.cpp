#include "fdem/bolts/bolts.hpp"

#include <algorithm>
#include <cmath>

#include "core/gauge.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/sides_now.hpp"

namespace breccia::fdem {
namespace {

/// A node of a bolt, and the triangle that it is in.
struct NodeNow {
  Vec2 place;
  Vec2 corner[3];

  NodeNow(const BoltPlace& at, const Vec2& a, const Vec2& b, const Vec2& c)
      : place(at.share[0] * a + at.share[1] * b + at.share[2] * c), corner{a, b, c} {}
  /// A way by its parts along edges 0 to 1 and 0 to 2, and back.
  Vec2 parts(const Vec2& way) const {
    const Vec2 p = corner[1] - corner[0], q = corner[2] - corner[0];
    const double over = 1.0 / cross(p, q);
    return {over * cross(way, q), over * cross(p, way)};
  }
  Vec2 carried(const Vec2& parts) const {
    return parts.x * (corner[1] - corner[0]) + parts.y * (corner[2] - corner[0]);
  }
};

/// Where all nodes of all bolts are, one after the other.
std::vector<NodeNow> nodes_now(World& part) {
  std::vector<Index> wanted;
  for (const Bolt& bolt : part.given->bolts)
    for (const BoltPlace& place : bolt.places)
      wanted.insert(wanted.end(), {3 * place.triangle, 3 * place.triangle + 1});
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const std::vector<EdgeNow> edges = fdem_shared::sides_now(part, wanted);
  std::vector<NodeNow> nodes;
  for (const Bolt& bolt : part.given->bolts)
    for (const BoltPlace& place : bolt.places) {
      const EdgeNow &first = side_in(edges, 3 * place.triangle),
                    &second = side_in(edges, 3 * place.triangle + 1);
      nodes.emplace_back(place, first.at[0], first.at[1], second.at[1]);
    }
  return nodes;
}

std::vector<double> lengths(const NodeNow* now, std::size_t nodes) {
  std::vector<double> length;
  for (std::size_t j = 0; j + 1 < nodes; ++j)
    length.push_back(norm(now[j + 1].place - now[j].place));
  return length;
}

/// A bolt comes: its segments begin without force.
void begin_segments(const Bolt& bolt, BoltNode* nodes, const NodeNow* now,
                    const std::vector<double>& length) {
  for (std::size_t j = 0; j < length.size(); ++j) {
    if (nodes[j].rest > 0.0) continue;
    nodes[j].rest = length[j];
    if (!(bolt.law.dowel.stiffness > 0.0)) continue;
    const Vec2 way = now[j + 1].place - now[j].place;
    nodes[j].begin = now[j].parts(way);
    nodes[j].end = now[j + 1].parts(way);
  }
}

/// How far segment j lies out of line.
Offset offset_of(const BoltNode& node, const NodeNow& from, const NodeNow& to) {
  return Offset::of(to.place - from.place, from.carried(node.begin), to.carried(node.end));
}

/// Calls visit(bolt, its chain, its nodes, where they are) for bolts that are there.
/// @param stage  of the run
template <class Visit>
void each_chain(const std::vector<Bolt>& bolts, std::int32_t stage, BoltNode* nodes,
                const NodeNow* now, const Visit& visit) {
  for (std::size_t b = 0; b < bolts.size(); ++b) {
    const Bolt& bolt = bolts[b];
    const std::vector<double> length = lengths(now, bolt.places.size());
    if (stage >= bolt.stage) {
      begin_segments(bolt, nodes, now, length);
      BoltChain chain(bolt.law, bolt.anchored[0], bolt.anchored[1], nodes, length);
      visit(b, chain, nodes, now);
    }
    nodes += bolt.places.size();
    now += bolt.places.size();
  }
}

/// Visits each chain of a whole world, which stays as it is.
template <class Visit>
void each_chain_of(const World& whole, const Visit& visit) {
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, whole.triangles.nodes);
  std::vector<NodeNow> now;
  for (const Bolt& bolt : whole.given->bolts)
    for (const BoltPlace& place : bolt.places) {
      const auto& corner = nodes[at(place.triangle)].at;
      now.emplace_back(place, corner[0].position, corner[1].position, corner[2].position);
    }
  std::vector<BoltNode> copy;
  copy_to(copy, whole.bolts.nodes);
  each_chain(whole.given->bolts, whole.stage.index, copy.data(), now.data(), visit);
}

/// Forces on the corners of a triangle, each its share of one force, as forces of its edges: half
/// of each goes to each of its ends.
/// @param all  the sum of the shares
void add_pull(std::vector<LoadedEdge>& pull, std::int16_t load, Index triangle,
              const std::array<double, 3>& share, double all, const Vec2& force) {
  for (std::int16_t k = 0; k < 3; ++k)
    pull.push_back({triangle, k, load, all - 2.0 * share[at((k + 2) % 3)], force.x, force.y});
}

/// The force across of a segment: keeps it and the lasting part of its offset, and lists its
/// action.
/// @param settled  it has kept what stays at this time already
void push_across(const Dowel& law, bool settled, BoltNode& node, const BoltPlace (&place)[2],
                 const NodeNow& from, const NodeNow& to, std::int16_t load,
                 std::vector<LoadedEdge>& pull) {
  const Offset offset = offset_of(node, from, to);
  node.across = law.force(offset.way, node.sheared);
  if (!settled) {
    const double beyond = offset.way - node.sheared - node.across / law.stiffness;
    node.sheared += beyond;
    node.crushed += node.across * beyond;
  }
  const Vec2 push = node.across * offset.across;
  const auto turning = [&](const Vec2& parts) {
    return std::array<double, 3>{-offset.lever * (parts.x + parts.y), offset.lever * parts.x,
                                 offset.lever * parts.y};
  };
  add_pull(pull, load, place[0].triangle, place[0].share, 1.0, push);
  add_pull(pull, load, place[0].triangle, turning(node.begin), 0.0, push);
  add_pull(pull, load, place[1].triangle, place[1].share, 1.0, -push);
  add_pull(pull, load, place[1].triangle, turning(node.end), 0.0, push);
}

}  // namespace

void pull_bolts(World& part) {
  const StageTime timed(part.exec, "bolts");
  const std::vector<NodeNow> all = nodes_now(part);
  const bool settled = part.bolts.time == part.time;
  const auto load = static_cast<std::int16_t>(part.given->loads.size() - 1);
  std::vector<LoadedEdge> pull;
  each_chain(part.given->bolts, part.stage.index, part.bolts.nodes.data(), all.data(),
             [&](std::size_t b, BoltChain& chain, BoltNode* nodes, const NodeNow* now) {
               if (!settled) chain.settle();
               const Bolt& bolt = part.given->bolts[b];
               for (std::size_t j = 0; j + 1 < bolt.places.size(); ++j) {
                 const BoltPlace ties[2] = {bolt.places[j], bolt.places[j + 1]};
                 const Vec2 way = now[j + 1].place - now[j].place;
                 nodes[j].force = chain.force(j);
                 const Vec2 force = (nodes[j].force / norm(way)) * way;
                 add_pull(pull, load, ties[0].triangle, ties[0].share, 1.0, force);
                 add_pull(pull, load, ties[1].triangle, ties[1].share, 1.0, -force);
                 if (bolt.law.dowel.stiffness > 0.0)
                   push_across(bolt.law.dowel, settled, nodes[j], ties, now[j], now[j + 1], load,
                               pull);
               }
             });
  part.bolts.time = part.time;
  part.bolts.pull = std::move(pull);
  list_loaded(part);
}

std::optional<Readings> read_bolt(const World& part, const ProbeConfig& probe) {
  const Quantity quantity = quantity_named(probe.quantity).quantity;
  const bool across = quantity.kind == Quantity::Kind::shear_force;
  if (!across && quantity.kind != Quantity::Kind::axial_force) return std::nullopt;
  Readings all;
  if (!part.domain.single_rank() && part.domain.ranks->rank() != 0) return all;
  const ReadBox box(probe.min, probe.max);
  Index node = 0;
  for (const Bolt& bolt : part.given->bolts)
    for (std::size_t i = 0; i < bolt.places.size(); ++i, ++node) {
      const BoltNode& of = part.bolts.nodes.data()[node];
      if (bolt.name != probe.on || i + 1 == bolt.places.size() || !(of.rest > 0.0)) continue;
      const Vec2 middle = 0.5 * (bolt.places[i].point + bolt.places[i + 1].point);
      if (box.holds({middle.x, middle.y, 0.0}))
        all = all + Readings(across ? of.across : of.force, node);
    }
  return all;
}

std::vector<BoltRow> bolt_rows(const World& whole) {
  std::vector<BoltRow> rows;
  each_chain_of(whole, [&](std::size_t b, const BoltChain& chain, const BoltNode* nodes,
                           const NodeNow* now) {
    const Bolt& bolt = whole.given->bolts[b];
    const std::size_t count = bolt.places.size();
    for (std::size_t i = 0; i < count; ++i) {
      const bool last = i + 1 == count;
      const double across =
          last || !(bolt.law.dowel.stiffness > 0.0)
              ? 0.0
              : bolt.law.dowel.force(offset_of(nodes[i], now[i], now[i + 1]).way, nodes[i].sheared);
      rows.push_back({b, now[i].place, last ? 0.0 : chain.force(i), across, nodes[i].slip});
    }
  });
  return rows;
}

std::vector<BoltEnergy> bolt_energies(const World& whole) {
  std::vector<BoltEnergy> energies(whole.given->bolts.size());
  const std::vector<BoltRow> rows = bolt_rows(whole);
  each_chain_of(whole,
                [&](std::size_t b, const BoltChain& chain, const BoltNode* nodes, const NodeNow*) {
                  energies[b].elastic = chain.elastic();
                  for (std::size_t i = 0; i < whole.given->bolts[b].places.size(); ++i) {
                    energies[b].yielded += nodes[i].yielded;
                    energies[b].rubbed += nodes[i].rubbed;
                    energies[b].crushed += nodes[i].crushed;
                  }
                });
  for (const BoltRow& row : rows)
    if (const double stiffness = whole.given->bolts[row.bolt].law.dowel.stiffness; stiffness > 0.0)
      energies[row.bolt].elastic += 0.5 * row.across * row.across / stiffness;
  return energies;
}

}  // namespace breccia::fdem
