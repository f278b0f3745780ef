#pragma once
// Bodies that a stage takes out of the model. Their triangles stay in memory, where they are, held
// and without contact, so that numbers of triangles are for ever.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Which vertices bodies have that some stage takes out.
std::vector<NodeSet> removable_bodies(const Config& config, const Model& model);
/// Of each body whether it is gone in this stage.
std::vector<std::uint8_t> removed_bodies(const Config& config,
                                         const std::vector<std::string>& bodies);

/// Of each triangle of this world: 1 if it is gone.
std::vector<std::uint8_t> gone_triangles(const World& w);

/// Parts the bodies that are gone by now from all others, where the mesh never changes otherwise:
/// as their stage begins, and before a checkpoint of a later time is loaded.
void open_around_removed(World& w);
/// Brings the bodies that are gone to a stop and cuts their joints, as their stage begins.
void cut_off_removed(World& w);

}  // namespace breccia::fdem
