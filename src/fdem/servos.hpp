#pragma once
// Servos of supports.

#include <vector>

#include "core/servo.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Force of each support of a part, for its servo; zero for supports without one.
std::vector<ServoReading> read_servos(World& part, const Config& now);

/// Corrects the velocities of all servos. @param sums  over all parts, as of read_servos()
void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums);

/// Gives supports the velocities of their servos.
void place_servos(World& w);

}  // namespace breccia::fdem
