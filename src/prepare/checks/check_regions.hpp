#pragma once
// Supports, loads and bolts beside every body: told before a model is built.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Holds each region against the outlines of the bodies that it may take from. Regions that miss
/// elements by less than their size are not told of: the built model is tested again.
/// @param folder  of the case; null: bodies whose outline only their file tells are not looked at
/// @throws InputError naming each region that takes nothing and each point of a bolt that lies in
/// no body, the nearest body and how far it is
void check_regions(const dem::Config& config, const std::string* folder = nullptr);
void check_regions(const fdem::Config& config, const std::string* folder = nullptr);
void check_regions(const fdem3::Config& config, const std::string* folder = nullptr);

/// Probes whose box holds nothing at the start, with the nearest body; something may come later.
std::vector<std::string> doubtful_probes(const dem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_probes(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_probes(const fdem3::Config& config, const std::string& folder);

/// Notes on the lines that `merge` moves before meshes follow them, a sentence a body.
std::vector<std::string> merged_lines(const fdem::Config& config, const std::string& case_folder);

/// Loads whose region is narrower than the sides of elements are long: it may take none of them.
std::vector<std::string> doubtful_loads(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_loads(const fdem3::Config& config, const std::string& folder);

/// Walls that no body touches at the start: which body is nearest, and how far it is; and bodies
/// that reach behind a wall, which will throw out what lies there. Of walls from a file the box
/// around them is looked at, for what is nearest.
std::vector<std::string> doubtful_walls(const dem::Config& config, const std::string& case_folder);

}  // namespace breccia::prepare
