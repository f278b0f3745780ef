#pragma once
// Acoustic emission of joints that broke.

#include <vector>

#include "core/emission.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Where a joint lay at the start, from the first corner of its side a to the second.
struct JointLine {
  Vec2 begin, end;  ///<  [m]
};

/// The moment of a joint that opened by o and slid by s, for its length L and the thickness b: the
/// stress that the jump would give the rock, times its area (Aki and Richards 2002, 3.2),
///
///   M = L b (lambda o 1 + 2 mu o n n + mu s (n e + e n))
///
/// with the normal n from side b into side a and e along the edge; in plane stress nothing acts
/// across the plane.  [N m]
Sym3 moment_of(const ElasticTriangle& law, bool plane_strain, const Vec2& along, double area,
               double opening, double slip);

/// Events of the whole mesh. Openings and slips are the largest ones up to the break.
/// @param lines  of all joints at the start
std::vector<EmissionEvent> emission(const World& whole, const std::vector<JointLine>& lines);

}  // namespace breccia::fdem
