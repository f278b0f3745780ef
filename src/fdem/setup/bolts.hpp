#pragma once
// Rock bolts of a case: their nodes in the triangles of a model.

#include <string>
#include <vector>

#include "fdem/world.hpp"

namespace breccia::fdem {

/// @throws InputError naming a bolt with a point outside all triangles, in a body that a stage
/// takes out, or with segments stiffer than the rock that they are tied to
void set_up_bolts(World& w, const Config& config, const Model& model);

/// The points that a bolt runs along, of a ring the first one last, too.
std::vector<Vec2> corners_of(const BoltConfig& bolt);

/// Problems of bolts that a case file alone tells of.
std::vector<std::string> bolt_problems(const Config& config);

}  // namespace breccia::fdem
