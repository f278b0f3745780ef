#pragma once
// Findings of set-up that are doubtful, though they can be run.

#include <string>
#include <vector>

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Sentences for people, each with its numbers and a place:
/// - a triangle whose stable step is less than a tenth of the median one rules the run;
/// - edges are too long for the process zone of a joint law.
/// @param w  as it was set up, its couples found
std::vector<std::string> doubts(const World& w, const Config& config);

}  // namespace breccia::fdem
