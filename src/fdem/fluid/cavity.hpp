#pragma once
// Gas of explosives in holes: how large holes are now, and what presses in them.

#include <vector>

#include "fdem/setup/model.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Border edges in the order in which they run around holes, a list for each hole.
/// @param edges  3 triangle + k  @param where  begins the message
/// @throws InputError if they do not close, or run around the outside of a body
std::vector<std::vector<Index>> holes_along(const Model& model, const std::vector<Index>& edges,
                                            const std::string& where);

/// Volume per thickness of the holes of a source now, and of the cracks that its gas has filled.
/// All ranks call it.  [m2]
double gas_volume(World& part, const FluidSource& source);

/// Pressures of gas by its volume now. All ranks call it.
void expand_gas(World& part);

/// Whether a case has explosives.
inline bool has_gas(const World& w) {
  for (const FluidSource& source : w.given->fluids)
    if (!source.holes.empty()) return true;
  return false;
}

}  // namespace breccia::fdem
