#pragma once
// Which corners and edges of a model a case means.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem/setup/model.hpp"
#include "fdem_shared/setup/removal.hpp"

namespace breccia::fdem {

/// Corners 3 t + k in a region, by where they are at the start.
/// @throws InputError naming `where` if there are none, or a name does not exist
std::vector<Index> corners_in(const Model& model, const RegionConfig& region,
                              const std::string& where);

/// Edges 3 t + k with both ends in a region: on the border of the mesh, or laid bare by a stage.
/// @param needed  whether there must be some
/// @throws InputError as corners_in(); for no edges only if some are needed
std::vector<Index> edges_in(const Model& model, const RegionConfig& region,
                            const std::string& where, const fdem_shared::LaidBare& bare,
                            bool needed);

/// Vertices in a region. @throws InputError as corners_in()
std::vector<Index> vertices_in(const Model& model, const RegionConfig& region,
                               const std::string& where);

}  // namespace breccia::fdem
