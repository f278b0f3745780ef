#pragma once
// Holes, notches and parts of plane bodies that miss them.

#include <string>
#include <vector>

#include "fdem/setup/body_config.hpp"

namespace breccia::prepare {

/// The corners of a notch with a width.  [m]
std::vector<Vec2> slot_corners(const fdem::NotchConfig& notch);

/// Holes and notches that take nothing of their body, as sentences.
/// @param outline  corners of a body of shape outline where it stands; other shapes are known  [m]
std::vector<std::string> missing_cuts(const fdem::BodyConfig& body,
                                      const std::vector<Vec2>& outline);

/// The problem of a part that takes nothing of its body; empty: it may take some.
/// @param outline  of the body, as above
std::string missing_part(const fdem::BodyConfig& part, const fdem::BodyConfig& body,
                         const std::vector<Vec2>& outline);

}  // namespace breccia::prepare
