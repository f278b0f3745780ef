#pragma once
// Which corners and faces of a model a case means.

#include <string>
#include <vector>

#include "fdem3/setup/config.hpp"
#include "fdem3/setup/model.hpp"
#include "fdem_shared/fluid/cracks.hpp"
#include "fdem_shared/setup/removal.hpp"

namespace breccia::fdem3 {

/// Corners 4 t + k in a region, by where they are at the start.
/// @throws InputError naming `where` if there are none, or a name does not exist
std::vector<Index> corners_in(const Model& model, const RegionConfig& region,
                              const std::string& where);

/// Faces 4 t + k with all corners in a region: on the border of the mesh, or laid bare by a stage.
/// @param across  sides_across() of the model
/// @throws InputError likewise, if any are needed
std::vector<Index> faces_in(const Model& model, const std::vector<Index>& across,
                            const RegionConfig& region, const std::string& where,
                            const fdem_shared::LaidBare& bare, bool needed);

/// Edges of tetrahedra with both ends in a region, ascending. @throws InputError likewise
std::vector<fdem_shared::Port> ports_in(const Model& model, const RegionConfig& region,
                                        const std::string& where);

}  // namespace breccia::fdem3
