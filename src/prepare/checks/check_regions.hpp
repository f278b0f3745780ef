#pragma once
// Supports, loads and bolts beside every body: told before a model is built.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Holds each region against the outlines of the bodies that it may take from. Bodies whose outline
/// only their file tells are not looked at, nor are regions that miss elements by less than their
/// size: the built model is tested again.
/// @throws InputError naming each region that takes nothing and each point of a bolt that lies in
/// no body, the nearest body and how far it is
void check_regions(const dem::Config& config);
void check_regions(const fdem::Config& config);
void check_regions(const fdem3::Config& config);

/// Walls that no body touches at the start: which body is nearest, and how far it is; and bodies
/// that reach behind a wall, which will throw out what lies there. Bodies whose outline only their
/// file tells are not looked at; of walls from a file the box around them is, for what is nearest.
std::vector<std::string> doubtful_walls(const dem::Config& config, const std::string& case_folder);

}  // namespace breccia::prepare
