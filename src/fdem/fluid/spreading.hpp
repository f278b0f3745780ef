#pragma once
// Fluid that spreads through a network of cracks: which of them are filled at a time.

#include <vector>

#include "exec/types.hpp"

namespace breccia::fdem {

/// A broken joint, or an edge that was open from the start, by numbers of the whole mesh.
struct CrackSide {
  Index a = 0, b = 0;      ///< its two edges, 3 triangle + k; a < b  [-]
  Index from = 0, to = 0;  ///< vertices at its ends  [-]
  double length = 0.0;     ///< at the start  [m]
  double since = 0.0;      ///< when it broke  [s]
};

/// How much of a crack is filled.
struct FilledCrack {
  Index a = 0, b = 0;   ///< its two edges  [-]
  double share = 0.0;   ///< of its length, in (0, 1]  [-]
  double length = 0.0;  ///< of the crack  [m]
};

/// Which cracks are filled. Fluid is at the sources from the start of the case on, enters a crack
/// when it has come to one of its ends and the crack is broken, and fills it with a given speed
/// from either end; where cracks share a vertex of the mesh they are connected. Times of arrival
/// are those of shortest ways, so that they depend neither on the order of cracks nor on how often
/// this is asked.
/// @param sources  vertices, in any order
/// @param speed    of the front; 0: cracks fill at once  [m/s]
/// @param now      [s]
std::vector<FilledCrack> filled_cracks(const std::vector<CrackSide>& cracks,
                                       const std::vector<Index>& sources, double speed, double now);

}  // namespace breccia::fdem
