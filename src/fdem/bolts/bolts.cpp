#include "fdem/bolts/bolts.hpp"

#include <algorithm>
#include <cmath>

#include "fdem/edges_now.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {
namespace {

/// Where all nodes of all bolts are, one after the other.
std::vector<Vec2> nodes_now(World& part) {
  std::vector<Index> wanted;
  for (const Bolt& bolt : part.given->bolts)
    for (const BoltPlace& place : bolt.places)
      wanted.insert(wanted.end(), {3 * place.triangle, 3 * place.triangle + 1});
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const std::vector<EdgeNow> edges = edges_now(part, wanted);
  std::vector<Vec2> places;
  for (const Bolt& bolt : part.given->bolts)
    for (const BoltPlace& place : bolt.places) {
      const EdgeNow &first = edge_in(edges, 3 * place.triangle),
                    &second = edge_in(edges, 3 * place.triangle + 1);
      places.push_back(place.share[0] * first.from + place.share[1] * first.to +
                       place.share[2] * second.to);
    }
  return places;
}

std::vector<double> lengths(const Vec2* places, std::size_t nodes) {
  std::vector<double> length;
  for (std::size_t j = 0; j + 1 < nodes; ++j) length.push_back(norm(places[j + 1] - places[j]));
  return length;
}

/// Calls visit(bolt, its chain, its nodes, their places) for bolts that are there.
/// @param stage  of the run
template <class Visit>
void each_chain(const std::vector<Bolt>& bolts, std::int32_t stage, BoltNode* nodes,
                const Vec2* places, const Visit& visit) {
  for (std::size_t b = 0; b < bolts.size(); ++b) {
    const Bolt& bolt = bolts[b];
    const std::vector<double> length = lengths(places, bolt.places.size());
    if (stage >= bolt.stage) {
      for (std::size_t j = 0; j < length.size(); ++j)
        if (!(nodes[j].rest > 0.0)) nodes[j].rest = length[j];
      BoltChain chain(bolt.law, bolt.anchored[0], bolt.anchored[1], nodes, length);
      visit(b, chain, nodes, places);
    }
    nodes += bolt.places.size();
    places += bolt.places.size();
  }
}

/// Visits each chain of a whole world, which stays as it is.
template <class Visit>
void each_chain_of(const World& whole, const Visit& visit) {
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, whole.triangles.nodes);
  std::vector<Vec2> places;
  for (const Bolt& bolt : whole.given->bolts)
    for (const BoltPlace& place : bolt.places) {
      const auto& corner = nodes[at(place.triangle)].at;
      places.push_back(place.share[0] * corner[0].position + place.share[1] * corner[1].position +
                       place.share[2] * corner[2].position);
    }
  std::vector<BoltNode> copy;
  copy_to(copy, whole.bolts.nodes);
  each_chain(whole.given->bolts, whole.stage.index, copy.data(), places.data(), visit);
}

/// A force at a place within a triangle, as forces of two of its edges: half of each goes to each
/// of its ends, so that corner k gets its share.
void add_pull(std::vector<LoadedEdge>& pull, std::int16_t load, const BoltPlace& place,
              const Vec2& force) {
  for (std::int16_t k = 0; k < 3; ++k)
    pull.push_back(
        {place.triangle, k, load, 1.0 - 2.0 * place.share[at((k + 2) % 3)], force.x, force.y});
}

}  // namespace

void pull_bolts(World& part) {
  const StageTime timed(part.exec, "bolts");
  const std::vector<Vec2> places = nodes_now(part);
  const bool settled = part.bolts.time == part.time;
  const auto load = static_cast<std::int16_t>(part.given->loads.size() - 1);
  std::vector<LoadedEdge> pull;
  each_chain(part.given->bolts, part.stage.index, part.bolts.nodes.data(), places.data(),
             [&](std::size_t b, BoltChain& chain, const BoltNode*, const Vec2* place) {
               if (!settled) chain.settle();
               const std::vector<BoltPlace>& ties = part.given->bolts[b].places;
               for (std::size_t j = 0; j + 1 < ties.size(); ++j) {
                 const Vec2 way = place[j + 1] - place[j];
                 const Vec2 force = (chain.force(j) / norm(way)) * way;
                 add_pull(pull, load, ties[j], force);
                 add_pull(pull, load, ties[j + 1], -force);
               }
             });
  part.bolts.time = part.time;
  part.bolts.pull = std::move(pull);
  list_loaded_edges(part);
}

std::vector<BoltRow> bolt_rows(const World& whole) {
  std::vector<BoltRow> rows;
  each_chain_of(
      whole, [&](std::size_t b, const BoltChain& chain, const BoltNode* nodes, const Vec2* place) {
        const std::size_t count = whole.given->bolts[b].places.size();
        for (std::size_t i = 0; i < count; ++i)
          rows.push_back({b, place[i], i + 1 < count ? chain.force(i) : 0.0, nodes[i].slip});
      });
  return rows;
}

std::vector<BoltEnergy> bolt_energies(const World& whole) {
  std::vector<BoltEnergy> energies(whole.given->bolts.size());
  each_chain_of(whole,
                [&](std::size_t b, const BoltChain& chain, const BoltNode* nodes, const Vec2*) {
                  energies[b].elastic = chain.elastic();
                  for (std::size_t i = 0; i < whole.given->bolts[b].places.size(); ++i) {
                    energies[b].yielded += nodes[i].yielded;
                    energies[b].rubbed += nodes[i].rubbed;
                  }
                });
  return energies;
}

}  // namespace breccia::fdem
