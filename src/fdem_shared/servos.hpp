#pragma once
// Servos of supports: they push with a given force. Written in fdem_shared/servo_forces.hpp; made
// for each method in its servos.cpp.

#include <vector>

#include "core/servo.hpp"

namespace breccia::fdem_shared {

/// Force of each support of a part, for its servo; zero for supports without one that is due.
/// @param now  the case as it is in this stage
template <class World, class Config>
std::vector<ServoReading> read_servos(World& part, const Config& now);

/// Corrects the velocities of servos that are due. @param sums  over all parts, as of read_servos()
template <class World, class Config>
void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums);

/// Gives supports the velocities of their servos.
template <class World>
void place_servos(World& w);

}  // namespace breccia::fdem_shared
