#pragma once
// Steps of a model that fits the multiprocessors' own memory: one launch takes many.

#include "dem/world.hpp"

namespace breccia::dem {

/// Whether a world's steps are taken by tiles; shares it out if that is not known yet.
bool runs_by_tiles(World& w);

/// As advance_on_device().
Advanced advance_by_tiles(World& w, const StopAt& stop);

}  // namespace breccia::dem
