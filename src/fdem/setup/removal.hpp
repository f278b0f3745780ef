#pragma once
// Bodies that a stage takes out of the model: fdem_shared/setup/removal.hpp for triangles.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Of each triangle of this world: 1 if it is gone.
std::vector<std::uint8_t> gone_triangles(const World& w);

/// Parts the bodies that are gone by now from all others: as their stage begins, and before a
/// checkpoint of a later time is loaded.
void open_around_removed(World& w);
/// Brings the bodies that are gone to a stop and cuts their joints, as their stage begins.
void cut_off_removed(World& w);

}  // namespace breccia::fdem
