#pragma once
// Acoustic emission of joints of tetrahedra that broke.

#include <functional>
#include <vector>

#include "core/emission.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// A joint at the start.
struct JointPlace {
  Vec3 middle;         ///<  [m]
  Vec3 normal, along;  ///< unit, from side b into side a, and along its first edge
};

/// @param x  corners of the face on side b
JointPlace place_of(const Vec3 (&x)[3]);
/// Of a joint by its face on side b.
using PlaceOfFace = std::function<JointPlace(Index)>;

/// Events of the whole mesh. Openings and slips are the largest ones up to the break; a slip has
/// the direction in which its sides lie apart now, turned back with them.
std::vector<EmissionEvent> emission(const World& whole, const PlaceOfFace& place_at_start);

}  // namespace breccia::fdem3
