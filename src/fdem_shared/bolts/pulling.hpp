#pragma once
// The action of bolts on the elements that they are tied to: fdem_shared/bolts/bolts.hpp.

#include <algorithm>
#include <cmath>

#include "core/gauge.hpp"
#include "core/quantity.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/sides_now.hpp"

namespace breccia::fdem_shared {

/// A way by its parts along edges that meet at a corner.
inline Vec2 parts_along(const Vec2 (&edge)[2], const Vec2& way) {
  const Vec2 &p = edge[0], &q = edge[1];
  const double over = 1.0 / cross(p, q);
  return {over * cross(way, q), over * cross(p, way)};
}
inline Vec3 parts_along(const Vec3 (&edge)[3], const Vec3& way) {
  const Vec3 &p = edge[0], &q = edge[1], &r = edge[2];
  const double over = 1.0 / dot(p, cross(q, r));
  return {over * dot(way, cross(q, r)), over * dot(p, cross(way, r)), over * dot(p, cross(q, way))};
}

/// A node of a bolt, and the element that it is in.
template <class Shape>
struct BoltNodeNow {
  using Vector = typename Shape::Vector;
  static constexpr int dimension = Shape::dimension;
  Vector place;
  Vector corner[dimension + 1];

  void put(const BoltPlaceOf<Vector>& at) {
    place = at.share[0] * corner[0];
    for (int k = 1; k <= dimension; ++k)
      place = place + at.share[static_cast<std::size_t>(k)] * corner[k];
  }
  /// A way by its parts along the edges from corner 0, and back.
  Vector parts(const Vector& way) const {
    Vector edge[dimension];
    for (int k = 0; k < dimension; ++k) edge[k] = corner[k + 1] - corner[0];
    return parts_along(edge, way);
  }
  Vector carried(const Vector& parts) const {
    Vector way = parts.x * (corner[1] - corner[0]);
    for (int k = 1; k < dimension; ++k) way = way + part_of(parts, k) * (corner[k + 1] - corner[0]);
    return way;
  }
  CarriedOf<Vec2> carried(const CarriedOf<Vec2>& parts) const { return {carried(parts.along)}; }
  CarriedOf<Vec3> carried(const CarriedOf<Vec3>& parts) const {
    return {carried(parts.along), carried(parts.side)};
  }
  /// The directions that the rock here carries of a segment that comes now.
  void carry(const Vec2& way, CarriedOf<Vec2>& carried) const { carried.along = parts(way); }
  void carry(const Vec3& way, CarriedOf<Vec3>& carried) const {
    const double x = std::abs(way.x), y = std::abs(way.y), z = std::abs(way.z);
    const Vec3 aside = x <= y && x <= z ? Vec3{1.0, 0.0, 0.0}
                       : y <= z         ? Vec3{0.0, 1.0, 0.0}
                                        : Vec3{0.0, 0.0, 1.0};
    const Vec3 across = cross(way, aside);
    carried = {parts(way), parts((1.0 / norm(across)) * across)};
  }
};

/// Where all nodes of all bolts are, one after the other.
template <class World>
auto bolt_nodes_now(const World& part) {
  using Shape = ShapeOf<World>;
  std::vector<Index> wanted;  // two sides of an element have all of its corners
  for (const auto& bolt : part.given->bolts)
    for (const auto& place : bolt.places)
      wanted.insert(wanted.end(),
                    {Shape::corners * place.element, Shape::corners * place.element + 1});
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const std::vector<SideNow<Shape>> sides = sides_now(part, wanted);
  std::vector<BoltNodeNow<Shape>> nodes;
  for (const auto& bolt : part.given->bolts)
    for (const auto& place : bolt.places) {
      BoltNodeNow<Shape> now;
      for (Index k = 0; k < 2; ++k) {
        const SideNow<Shape>& side = side_in(sides, Shape::corners * place.element + k);
        for (Index c = 0; c < Shape::dimension; ++c)
          now.corner[Shape::corner_of_side(k, c)] = side.at[c];
      }
      now.put(place);
      nodes.push_back(now);
    }
  return nodes;
}

template <class Shape>
std::vector<double> lengths_of_segments(const BoltNodeNow<Shape>* now, std::size_t nodes) {
  std::vector<double> length;
  for (std::size_t j = 0; j + 1 < nodes; ++j)
    length.push_back(norm(now[j + 1].place - now[j].place));
  return length;
}

/// A bolt comes: its segments begin without force.
template <class Vector, class Shape>
void begin_segments(const BoltOf<Vector>& bolt, BoltNodeOf<Vector>* nodes,
                    const BoltNodeNow<Shape>* now, const std::vector<double>& length) {
  for (std::size_t j = 0; j < length.size(); ++j) {
    if (nodes[j].rest > 0.0) continue;
    nodes[j].rest = length[j];
    if (!(bolt.law.dowel.stiffness > 0.0)) continue;
    const Vector way = now[j + 1].place - now[j].place;
    now[j].carry(way, nodes[j].begin);
    now[j + 1].carry(way, nodes[j].end);
  }
}

/// How far a segment lies out of line.
template <class Vector, class Shape>
OffsetOf<Vector> offset_of(const BoltNodeOf<Vector>& node, const BoltNodeNow<Shape>& from,
                           const BoltNodeNow<Shape>& to) {
  return OffsetOf<Vector>::of(to.place - from.place, from.carried(node.begin),
                              to.carried(node.end));
}

/// Calls visit(bolt, its chain, its nodes, where they are) for bolts that are there.
/// @param stage  of the run
template <class Vector, class Shape, class Visit>
void each_chain(const std::vector<BoltOf<Vector>>& bolts, std::int32_t stage,
                BoltNodeOf<Vector>* nodes, const BoltNodeNow<Shape>* now, const Visit& visit) {
  for (std::size_t b = 0; b < bolts.size(); ++b) {
    const BoltOf<Vector>& bolt = bolts[b];
    const std::vector<double> length = lengths_of_segments(now, bolt.places.size());
    if (stage >= bolt.stage) {
      begin_segments(bolt, nodes, now, length);
      BoltChain<BoltNodeOf<Vector>> chain(bolt.law, bolt.anchored[0], bolt.anchored[1], nodes,
                                          length);
      visit(b, chain, nodes, now);
    }
    nodes += bolt.places.size();
    now += bolt.places.size();
  }
}

/// Visits each chain of a whole world, which stays as it is.
template <class World, class Visit>
void each_chain_of(const World& whole, const Visit& visit) {
  using Shape = ShapeOf<World>;
  std::vector<typename Shape::Nodes> nodes;
  copy_to(nodes, Shape::elements(whole).nodes);
  std::vector<BoltNodeNow<Shape>> now;
  for (const auto& bolt : whole.given->bolts)
    for (const auto& place : bolt.places) {
      BoltNodeNow<Shape> node;
      for (Index k = 0; k < Shape::corners; ++k)
        node.corner[k] = nodes[at(place.element)].at[k].position;
      node.put(place);
      now.push_back(node);
    }
  std::vector<BoltNodeOf<typename Shape::Vector>> copy;
  copy_to(copy, whole.bolts.nodes);
  each_chain(whole.given->bolts, whole.stage.index, copy.data(), now.data(), visit);
}

/// Lists forces on corners as those of sides.
template <class Shape>
struct PullsOnSides {
  using Vector = typename Shape::Vector;
  std::int16_t load;
  std::vector<typename Shape::LoadedSide>& pull;

  /// Forces on the corners of an element, each its share of one force: each side gives even parts
  /// of its own to its corners, so that corner c, opposite one side, gets what the others bear.
  /// @param all  the sum of the shares
  void add(Index element, const std::array<double, at(Shape::corners)>& share, double all,
           const Vector& force) {
    for (Index k = 0; k < Shape::corners; ++k)
      pull.push_back(Shape::LoadedSide::pulled(
          Shape::corners * element + k, load,
          all - double{Shape::dimension} * share[at(Shape::corner_opposite(k))], force));
  }
  /// Forces of no sum that turn the rock: a size times the parts of what it carries.
  void add_turn(Index element, double size, const Vector& parts, const Vector& force) {
    std::array<double, at(Shape::corners)> share{};
    double sum = parts.x;
    for (int k = 1; k < Shape::dimension; ++k) sum += part_of(parts, k);
    share[0] = -size * sum;
    for (int k = 0; k < Shape::dimension; ++k) share[at(Index{k + 1})] = size * part_of(parts, k);
    add(element, share, 0.0, force);
  }
};

/// The force across of a segment: keeps it and the lasting part of its offset, and lists its
/// action.
/// @param settled  it has kept what stays at this time already
template <class Shape, class Vector>
void push_across(const Dowel& law, bool settled, BoltNodeOf<Vector>& node,
                 const BoltPlaceOf<Vector> (&place)[2], const BoltNodeNow<Shape>& from,
                 const BoltNodeNow<Shape>& to, PullsOnSides<Shape>& pulls) {
  const OffsetOf<Vector> offset = offset_of(node, from, to);
  node.across = law.force(offset.way, node.sheared);
  if (!settled) {
    const AcrossOf<Vector> beyond = law.beyond(offset.way, node.sheared, node.across);
    node.sheared += beyond;
    node.crushed += times(node.across, beyond);
  }
  const Vector push = offset.push(node.across);
  const auto turn = [&](Index element, const CarriedOf<Vector>& parts) {
    offset.each_turn(node.across, parts,
                     [&](double size, const Vector& along, const Vector& direction) {
                       pulls.add_turn(element, size, along, direction);
                     });
  };
  pulls.add(place[0].element, place[0].share, 1.0, push);
  turn(place[0].element, node.begin);
  pulls.add(place[1].element, place[1].share, 1.0, -push);
  turn(place[1].element, node.end);
}

template <class World>
void pull_bolts(World& part) {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  const StageTime timed(part.exec, "bolts");
  const std::vector<BoltNodeNow<Shape>> all = bolt_nodes_now(part);
  const bool settled = part.bolts.time == part.time;
  std::vector<typename Shape::LoadedSide> pull;
  PullsOnSides<Shape> pulls{static_cast<std::int16_t>(part.given->loads.size() - 1), pull};
  each_chain(part.given->bolts, part.stage.index, part.bolts.nodes.data(), all.data(),
             [&](std::size_t b, BoltChain<BoltNodeOf<Vector>>& chain, BoltNodeOf<Vector>* nodes,
                 const BoltNodeNow<Shape>* now) {
               if (!settled) chain.settle();
               const BoltOf<Vector>& bolt = part.given->bolts[b];
               for (std::size_t j = 0; j + 1 < bolt.places.size(); ++j) {
                 const BoltPlaceOf<Vector> ties[2] = {bolt.places[j], bolt.places[j + 1]};
                 const Vector way = now[j + 1].place - now[j].place;
                 nodes[j].force = chain.force(j);
                 const Vector force = (nodes[j].force / norm(way)) * way;
                 pulls.add(ties[0].element, ties[0].share, 1.0, force);
                 pulls.add(ties[1].element, ties[1].share, 1.0, -force);
                 if (bolt.law.dowel.stiffness > 0.0)
                   push_across(bolt.law.dowel, settled, nodes[j], ties, now[j], now[j + 1], pulls);
               }
             });
  part.bolts.time = part.time;
  part.bolts.pull = std::move(pull);
  list_loaded(part);
}

template <class World>
std::optional<Readings> read_bolt(const World& part, const ProbeConfig& probe) {
  const Quantity quantity = quantity_named(probe.quantity).quantity;
  const bool across = quantity.kind == Quantity::Kind::shear_force;
  if (!across && quantity.kind != Quantity::Kind::axial_force) return std::nullopt;
  Readings all;
  if (!part.domain.single_rank() && part.domain.ranks->rank() != 0) return all;
  const ReadBox box(probe.min, probe.max);
  Index node = 0;
  for (const auto& bolt : part.given->bolts)
    for (std::size_t i = 0; i < bolt.places.size(); ++i, ++node) {
      const auto& of = part.bolts.nodes.data()[node];
      if (bolt.name != probe.on || i + 1 == bolt.places.size() || !(of.rest > 0.0)) continue;
      if (box.holds(to_space(0.5 * (bolt.places[i].point + bolt.places[i + 1].point))))
        all = all + Readings(across ? as_one(of.across) : of.force, node);
    }
  return all;
}

/// The force across of a segment by where its ends are.
template <class Vector, class Shape>
AcrossOf<Vector> across_now(const Dowel& law, const BoltNodeOf<Vector>& node,
                            const BoltNodeNow<Shape>& from, const BoltNodeNow<Shape>& to) {
  if (!(law.stiffness > 0.0)) return {};
  return law.force(offset_of(node, from, to).way, node.sheared);
}

template <class World>
std::vector<BoltRowOf<typename ShapeOf<World>::Vector>> bolt_rows(const World& whole) {
  std::vector<BoltRowOf<typename ShapeOf<World>::Vector>> rows;
  each_chain_of(whole, [&](std::size_t b, const auto& chain, const auto* nodes, const auto* now) {
    const auto& bolt = whole.given->bolts[b];
    const std::size_t count = bolt.places.size();
    for (std::size_t i = 0; i < count; ++i) {
      const bool last = i + 1 == count;
      const double across =
          last ? 0.0 : as_one(across_now(bolt.law.dowel, nodes[i], now[i], now[i + 1]));
      rows.push_back({b, now[i].place, last ? 0.0 : chain.force(i), across, nodes[i].slip});
    }
  });
  return rows;
}

template <class World>
std::vector<BoltSegmentOf<typename ShapeOf<World>::Vector>> bolt_segments(const World& part) {
  std::vector<BoltSegmentOf<typename ShapeOf<World>::Vector>> segments;
  if (part.given->bolts.empty()) return segments;
  const auto now = bolt_nodes_now(part);
  std::size_t node = 0;
  for (std::size_t b = 0; b < part.given->bolts.size(); ++b) {
    const std::size_t count = part.given->bolts[b].places.size();
    for (std::size_t i = 0; i < count; ++i, ++node) {
      const auto& of = part.bolts.nodes.data()[node];
      if (i + 1 == count || !(of.rest > 0.0)) continue;
      segments.push_back(
          {b, now[node].place, now[node + 1].place, of.force, as_one(of.across), of.slip});
    }
  }
  return segments;
}

template <class World>
std::vector<BoltEnergy> bolt_energies(const World& whole) {
  std::vector<BoltEnergy> energies(whole.given->bolts.size());
  const auto rows = bolt_rows(whole);
  each_chain_of(whole, [&](std::size_t b, const auto& chain, const auto* nodes, const auto*) {
    energies[b].elastic = chain.elastic();
    for (std::size_t i = 0; i < whole.given->bolts[b].places.size(); ++i) {
      energies[b].yielded += nodes[i].yielded;
      energies[b].rubbed += nodes[i].rubbed;
      energies[b].crushed += nodes[i].crushed;
    }
  });
  for (const auto& row : rows)
    if (const Dowel& dowel = whole.given->bolts[row.bolt].law.dowel; dowel.stiffness > 0.0)
      energies[row.bolt].elastic += dowel.stored(row.across);
  return energies;
}

}  // namespace breccia::fdem_shared
