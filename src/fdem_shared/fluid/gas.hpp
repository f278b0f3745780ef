#pragma once
// Gas of explosives in holes, of a world: how much room it has, and how it presses.
//
// A method's cavity.hpp has, for a hole of its sources (GasSourceOf),
//
//   sides_of_hole(hole)          of its wall
//   volume_within(hole, sides)   by where sides are now; in the plane per thickness

#include <algorithm>
#include <iterator>
#include <vector>

#include "fdem_shared/fluid/fluid.hpp"
#include "fdem_shared/fluid/gas_source.hpp"

namespace breccia::fdem_shared {

inline const std::vector<Index>& sides_of_hole(const std::vector<Index>& hole) {
  return hole;
}

/// Area that an edge sweeps outward of its element, each corner straight on.  [m2]
inline double swept(const Vec2 (&from)[2], const Vec2 (&to)[2]) {
  const Vec2 way = 0.5 * ((to[0] - from[0]) + (to[1] - from[1]));
  const Vec2 line = 0.5 * ((to[1] - to[0]) + (from[1] - from[0]));
  return way.x * line.y - way.y * line.x;
}
/// Volume that a face sweeps so; its area is a square of time on the way.  [m3]
inline double swept(const Vec3 (&from)[3], const Vec3 (&to)[3]) {
  const Vec3 e = from[1] - from[0], f = from[2] - from[0];
  const Vec3 g = (to[1] - to[0]) - e, h = (to[2] - to[0]) - f;
  const Vec3 twice = cross(e, f) + 0.5 * (cross(e, h) + cross(g, f)) + (1.0 / 3.0) * cross(g, h);
  const Vec3 way = (to[0] - from[0]) + (to[1] - from[1]) + (to[2] - from[2]);
  return dot(way, twice) / 6.0;
}

/// Room of a gas, in the plane per thickness.  [m3; in 2D m2]
struct GasRoom {
  double volume = 0.0;  ///< of its holes, and of the cracks that it has filled
  /// Swept by sides of its holes since the start, and of cracks that it has filled. As this grows
  /// gas works; where walls part nothing bears its pressure in between.
  double pushed = 0.0;
};

/// Sides of all holes of a source.
template <class Source>
std::vector<Index> sides_of_holes(const Source& source) {
  std::vector<Index> all;
  for (const auto& hole : source.holes)
    all.insert(all.end(), sides_of_hole(hole).begin(), sides_of_hole(hole).end());
  return all;
}

/// Keeps where the walls of its holes are at the start.
template <class World, class Source>
void note_walls_of_gas(const World& part, Source& source) {
  for (const auto& now : sides_now(part, sides_of_holes(source))) {
    auto& wall = source.start.emplace_back();
    wall.side = now.side;
    std::copy(std::begin(now.at), std::end(now.at), wall.at);
  }
}

/// All ranks call it.
template <class World, class Source>
GasRoom room_of_gas(const World& part, const Source& source) {
  std::vector<Index> wanted = sides_of_holes(source);
  const auto& wet = part.fluid.wet;
  const auto& filled = part.fluid.filled;
  for (const auto& side : wet)
    if (side.load == source.load) wanted.push_back(side.number());
  const auto sides = sides_now(part, wanted);
  GasRoom room;
  for (const auto& hole : source.holes) room.volume += volume_within(hole, sides);
  for (const auto& wall : source.start) room.pushed -= swept(wall.at, side_in(sides, wall.side).at);
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (wet[2 * i].load != source.load) continue;
    const auto now = opened(filled[i], side_in(sides, wet[2 * i].number()),
                            side_in(sides, wet[2 * i + 1].number()));
    const double volume = wet[2 * i].share * now.extent() * std::max(now.opening, 0.0);
    room.volume += volume;
    room.pushed += volume;
  }
  return room;
}
/// Of all sources: empty ones of those that are no gas.
template <class World>
std::vector<GasRoom> rooms_of_gas(const World& part) {
  std::vector<GasRoom> all;
  for (const auto& source : part.given->fluids)
    all.push_back(source.holes.empty() ? GasRoom{} : room_of_gas(part, source));
  return all;
}

/// Lets gas expand (docs/theory-fdem.md, 6): it has worked on the walls of what it filled, and runs
/// on into what it has entered since without work, with the energy that is left to it.
/// @param before  rooms now, of what it filled at the last time
/// @param all     and with what it has entered since
/// @param since   the last time; below 0: there was none  [s]
template <class World>
void expand_gas(World& part, const std::vector<GasRoom>& before, const std::vector<GasRoom>& all,
                double since) {
  const auto& sources = part.given->fluids;
  auto& gas = part.fluid.gas;
  const bool begins = gas.size() == 0;
  if (begins) {
    gas = Buffer<SourceNow>(Space::host, static_cast<Index>(sources.size()));
    std::fill_n(gas.data(), gas.size(), SourceNow{});
  }
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto& source = sources[k];
    if (source.holes.empty()) continue;
    SourceNow& now = gas.data()[k];
    const double volume = std::max(all[k].volume / source.charge, 1e-3);
    if (begins) {
      now.energy = source.law.energy(volume);
    } else {
      // Work of the forces that acted since then; a ramp holds a part of them back.
      const auto& ramp = part.given->load_amplitudes[static_cast<std::size_t>(source.load)];
      const double acts = 0.5 * (ramp.at(since).x + ramp.at(part.time).x);
      now.energy -= acts * now.pressure * (before[k].pushed - now.pushed) / source.charge;
    }
    now.pushed = all[k].pushed;
    now.pressure = source.law.pressure(volume, now.energy);
  }
}

/// Lets cracks bear the pressure of gas, and adds the walls of its holes.
template <class World, class Side>
void list_gas(const World& w, std::vector<Side>& all) {
  const auto& sources = w.given->fluids;
  for (std::size_t k = 0; k < sources.size() && w.fluid.gas.size() > 0; ++k) {
    if (sources[k].holes.empty()) continue;
    const double pressure = w.fluid.gas.data()[k].pressure;
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
/// @param expands  whether gas expands to its volume now, or keeps the pressure that it has
template <class World>
void spread_with_gas(World& part, double now, bool expands) {
  const bool expands_gas = expands && has_gas(part);
  const double since = part.fluid.time;
  const auto before = expands_gas ? rooms_of_gas(part) : std::vector<GasRoom>{};
  const bool changes = spread_until(part, now);
  if (!changes && !has_gas(part)) return;
  if (expands_gas) expand_gas(part, before, changes ? rooms_of_gas(part) : before, since);
  list_loaded(part);
}

}  // namespace breccia::fdem_shared
