#pragma once
// From the links of a model to those of a world.

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Fills all sets of links, with their groups and laws. @throws InputError naming what does not fit
void set_links(World& w, const Config& config, const Model& model);

}  // namespace breccia::dem
