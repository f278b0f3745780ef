#pragma once
// How contacts of elements with walls are ordered: by wall, then by global id, then by slot.

#include "dem/wall_mesh.hpp"
#include "exec/types.hpp"

namespace breccia::dem {

/// @param slot  below mesh_slots; 0: of a wall that is no mesh
BR_HD constexpr PairKey wall_key(Index wall, GlobalId id, int slot) {
  static_assert(mesh_slots <= 8);
  return static_cast<PairKey>(wall) << 35 |
         static_cast<PairKey>(static_cast<std::uint32_t>(id)) << 3 | static_cast<PairKey>(slot);
}

}  // namespace breccia::dem
