#pragma once
// Steps of a model that fits the multiprocessors' own memory: one launch takes many.

#include "dem/world.hpp"

namespace breccia::dem {

/// Exec::tiles where the model decides: tiles if it fits them and has enough links for them to pay.
constexpr Index tiles_where_they_pay = -1;
/// Exec::tiles where steps are to be taken by tiles or not at all. @throws InputError at the first
/// step of a model that cannot
constexpr Index tiles_in_any_case = 1 << 16;

/// Whether a world's steps are taken by tiles; shares it out if that is not known yet.
bool runs_by_tiles(World& w);

/// As advance_on_device().
Advanced advance_by_tiles(World& w, const StopAt& stop);

}  // namespace breccia::dem
