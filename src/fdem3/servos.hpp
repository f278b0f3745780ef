#pragma once
// Servos of supports.

#include <vector>

#include "core/servo.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// The force with which each support of a part pushes; of those without servo nothing.
std::vector<ServoReading> read_servos(World& part, const Config& now);

/// Corrects the velocities of all servos. @param sums  over all parts, as of read_servos()
void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums);

/// Gives supports the velocities of their servos.
void place_servos(World& w);

}  // namespace breccia::fdem3
