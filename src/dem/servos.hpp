#pragma once
// Servos of walls and supports.

#include <vector>

#include "core/servo.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Force of each wall and then each support of a part, for its servo; zero for those without one
/// that is due.
std::vector<ServoReading> read_servos(World& part, const Config& now);

/// Corrects the velocities of servos that are due. @param sums  over all parts, as of read_servos()
void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums);

/// Gives walls and supports the velocities of their servos.
void place_servos(World& w);

}  // namespace breccia::dem
