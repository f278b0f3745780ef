#pragma once
// Tools of meshes: bodies that a support holds as a whole and moves, or lets go where forces lead.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Tools that touch no other body at the start, by the boxes around bodies: which is nearest, and
/// how far it is; a sentence each.
std::vector<std::string> doubtful_tools(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_tools(const fdem3::Config& config, const std::string& folder);

}  // namespace breccia::prepare
