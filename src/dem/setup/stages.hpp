#pragma once
// A case as it is in one of its stages.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"

namespace breccia::dem {

struct World;

/// The case with what its stages up to the present one have changed.
Config config_at(Config config, const StageProgress& progress);

/// Constants of contacts by the moduli of the case.
void set_contact_pairs(World& w, const Config& config);

/// Adds the motion of wall k to World::prescribed. Returns its number.
std::size_t add_motion(World& w, const WallConfig& wall, std::size_t k);

/// Problems of the stages of a case, as sentences.
std::vector<std::string> stage_problems(const Config& config);

}  // namespace breccia::dem
