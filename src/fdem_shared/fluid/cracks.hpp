#pragma once
// Cracks as a fluid meets them: a line of the plane that it enters at its two ends, a face in space
// that it enters at its three edges.

#include <algorithm>
#include <cstdint>

#include "exec/types.hpp"

namespace breccia::fdem_shared {

/// Where a fluid passes from crack to crack, by numbers of the whole mesh: a vertex of the plane,
/// an edge in space.
using Port = std::int64_t;
/// The edge between two vertices.
BR_HD inline Port port_between(Index p, Index q) {
  return static_cast<Port>(pair_key(p, q));
}

/// A broken joint, or an edge that was open from the start, by numbers of the whole mesh.
struct LineCrack {
  static constexpr int ports = 2;
  Index a = 0, b = 0;     ///< its two edges, 3 triangle + k; a < b  [-]
  Port port[ports] = {};  ///< vertices at its ends  [-]
  double length = 0.0;    ///< at the start  [m]
  double since = 0.0;     ///< when it broke  [s]

  /// From one port to another, and from a port until all of it is filled.  [m]
  double way(int, int) const { return length; }
  double depth(int) const { return length; }
};

/// Such a joint or face in space: corner k is that of face b, edge k leads from it to the next one.
struct FaceCrack {
  static constexpr int ports = 3;
  Index a = 0, b = 0;       ///< its two faces, 4 tetrahedron + k; a < b  [-]
  Index turn = 0;           ///< place in a's list of the corner that lies at b's first one
  Port port[ports] = {};    ///< edges  [-]
  double edge[ports] = {};  ///< their lengths at the start  [m]
  double length = 0.0;      ///< h of its joint  [m]
  double since = 0.0;       ///< when it broke  [s]

  /// Between the middles of two edges, and from an edge to the corner that lies opposite.  [m]
  double way(int from, int to) const { return 0.5 * edge[3 - from - to]; }
  double depth(int from) const { return 2.0 * area() / edge[from]; }
  double area() const {
    const double p = edge[0], q = edge[1], r = edge[2];
    const double four = (p + q + r) * (q + r - p) * (p + r - q) * (p + q - r);  // Heron
    return 0.25 * __builtin_sqrt(std::max(four, 0.0));
  }
};

}  // namespace breccia::fdem_shared
