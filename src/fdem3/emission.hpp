#pragma once
// Acoustic emission of joints of tetrahedra that broke.

#include <vector>

#include "core/emission.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// A joint at the start.
struct JointPlace {
  Vec3 middle;         ///<  [m]
  Vec3 normal, along;  ///< unit, from side b into side a, and along its first edge
};

/// Events of the whole mesh. Openings and slips are the largest ones up to the break; a slip has
/// the direction in which its sides lie apart now, turned back with them.
/// @param places  of all joints at the start
std::vector<EmissionEvent> emission(const World& whole, const std::vector<JointPlace>& places);

}  // namespace breccia::fdem3
