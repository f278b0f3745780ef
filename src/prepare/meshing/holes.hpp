#pragma once
// Holes of plane bodies that miss them.

#include <string>
#include <vector>

#include "fdem/setup/body_config.hpp"

namespace breccia::prepare {

/// Holes that take nothing of their body, as sentences.
/// @param outline  corners of a body of shape outline where it stands; other shapes are known  [m]
std::vector<std::string> missing_holes(const fdem::BodyConfig& body,
                                       const std::vector<Vec2>& outline);

}  // namespace breccia::prepare
