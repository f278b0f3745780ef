#pragma once
// A stage that changes the modulus of a material.

#include "dem/setup/config.hpp"

namespace breccia::dem {

struct World;

/// Lets links and contacts bear what they bear with other moduli at the same strain: stiffnesses,
/// shear forces and moments grow alike, and softened links keep their damage. As a stage begins, on
/// each rank, before configure().
/// @param before, after  the case before the stage, and in it
void change_moduli(World& w, const Config& before, const Config& after);
/// Whether a stage gives a modulus: forces are then to be evaluated anew.
bool changes_moduli(const StageConfig& stage);

}  // namespace breccia::dem
