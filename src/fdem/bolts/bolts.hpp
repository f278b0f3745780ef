#pragma once
// Rock bolts in plane cases: bars tied to triangles, whose forces act on their corners as loads do.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "core/probe.hpp"
#include "exec/buffer.hpp"
#include "fdem/bolts/chain.hpp"
#include "fdem/triangles/loads.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem {

struct World;

/// A node of a bolt in a triangle: constant shares of its corners tell where it is.
struct BoltPlace {
  Index triangle;  ///< of the whole mesh  [-]
  std::array<double, 3> share;
  Vec2 point{};  ///< at the start  [m]
};

/// Constants of a bolt.
struct Bolt {
  std::string name;
  BoltLaw law;
  bool anchored[2] = {false, false};
  std::int32_t stage = 0;         ///< it is there from this stage on  [-]
  std::vector<BoltPlace> places;  ///< of its nodes
};

/// Bolts of a run: the same on all ranks.
struct BoltState {
  double time = -1.0;            ///< of the positions they are in balance with; below 0: none  [s]
  Buffer<BoltNode> nodes;        ///< of all bolts, one after the other
  std::vector<LoadedEdge> pull;  ///< on edges, by global id
};

/// Brings bolts into balance with the rock at the time of the world, and lists what they do to it.
/// All ranks call it in each step.
void pull_bolts(World& part);

/// How a node of a bolt is.
struct BoltRow {
  std::size_t bolt;
  Vec2 place;            ///<  [m]
  double force, across;  ///< of the segment that begins here; 0 at the end  [N/m]
  double slip;           ///<  [m]
};
std::vector<BoltRow> bolt_rows(const World& whole);

/// Forces of a bolt's segments in the probe's box; none: the probe reads no bolt. On
/// ranks the first one reads it.
std::optional<Readings> read_bolt(const World& part, const ProbeConfig& probe);

/// Energies of a bolt: stored, spent by yield, rubbed off in its bond, spent across.  [J/m]
struct BoltEnergy {
  double elastic = 0.0, yielded = 0.0, rubbed = 0.0, crushed = 0.0;
};
std::vector<BoltEnergy> bolt_energies(const World& whole);

}  // namespace breccia::fdem
