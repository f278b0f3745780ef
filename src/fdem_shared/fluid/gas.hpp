#pragma once
// Gas of explosives in holes, of a world: how much room it has, and how it presses.
//
// A method's cavity.hpp has, for a hole of its sources (GasSourceOf),
//
//   sides_of_hole(hole)          of its wall
//   volume_within(hole, sides)   by where sides are now; in the plane per thickness

#include <algorithm>

#include "fdem_shared/fluid/fluid.hpp"
#include "fdem_shared/fluid/gas_source.hpp"

namespace breccia::fdem_shared {

inline const std::vector<Index>& sides_of_hole(const std::vector<Index>& hole) {
  return hole;
}

/// Volume of the holes of a source now, and of the cracks that its gas has filled; in the plane per
/// thickness. All ranks call it.  [m3; in 2D m2]
template <class World, class Source>
double volume_of_gas(World& part, const Source& source) {
  std::vector<Index> wanted;
  for (const auto& hole : source.holes)
    wanted.insert(wanted.end(), sides_of_hole(hole).begin(), sides_of_hole(hole).end());
  const auto& wet = part.fluid.wet;
  const auto& filled = part.fluid.filled;
  for (const auto& side : wet)
    if (side.load == source.load) wanted.push_back(side.number());
  const auto sides = sides_now(part, wanted);
  double volume = 0.0;
  for (const auto& hole : source.holes) volume += volume_within(hole, sides);
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (wet[2 * i].load != source.load) continue;
    const auto now = opened(filled[i], side_in(sides, wet[2 * i].number()),
                            side_in(sides, wet[2 * i + 1].number()));
    volume += wet[2 * i].share * now.extent() * std::max(now.opening, 0.0);
  }
  return volume;
}

/// Pressures of gas by its volume now. All ranks call it.
template <class World>
void expand_gas(World& part) {
  const auto& sources = part.given->fluids;
  if (part.fluid.gas.size() == 0)
    part.fluid.gas = Buffer<double>(Space::host, static_cast<Index>(sources.size()));
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto& source = sources[k];
    part.fluid.gas.data()[k] =
        source.holes.empty()
            ? 1.0
            : source.law.pressure(std::max(volume_of_gas(part, source) / source.charge, 1e-3));
  }
}

/// Lets cracks bear the pressure of gas, and adds the walls of its holes.
template <class World, class Side>
void list_gas(const World& w, std::vector<Side>& all) {
  const auto& sources = w.given->fluids;
  for (std::size_t k = 0; k < sources.size() && w.fluid.gas.size() > 0; ++k) {
    if (sources[k].holes.empty()) continue;
    const double pressure = w.fluid.gas.data()[k];
    for (Side& side : all)
      if (side.load == sources[k].load) side.share *= pressure;
    for (Side side : sources[k].borders) {
      side.share = pressure;
      all.push_back(side);
    }
  }
}

/// All sides of a world that bear loads.
template <class World>
void list_all_loaded(World& w) {
  auto all = w.given->loaded;
  all.insert(all.end(), w.fluid.wet.begin(), w.fluid.wet.end());
  all.insert(all.end(), w.fluid.border.begin(), w.fluid.border.end());
  list_gas(w, all);
  all.insert(all.end(), w.bolts.pull.begin(), w.bolts.pull.end());
  list_here(w, all, ShapeOf<World>::loaded_sides(w), w.load_starts);
}

/// Lets a fluid that does not flow spread to where it is at a time: from then on it presses there.
/// @param expands  whether gas takes the pressure of its volume now, or keeps that which it has
template <class World>
void spread_with_gas(World& part, double now, bool expands) {
  const bool changes = spread_until(part, now), gas = has_gas(part);
  if (!changes && !gas) return;
  if (gas && expands) expand_gas(part);
  list_loaded(part);
}

}  // namespace breccia::fdem_shared
