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

/// Events of the whole mesh. Openings and slips are the largest ones up to the break.
/// @param lines  of all joints at the start
std::vector<EmissionEvent> emission(const World& whole, const std::vector<JointLine>& lines);

}  // namespace breccia::fdem
