#pragma once
// Benchmark scenes of equal tiles: each rank builds its own, so that a model may be larger than
// what one rank could hold, and is the same, to the bit, for any number of ranks.

#include "bench/scenes.hpp"
#include "dem/world.hpp"
#include "fdem/world.hpp"

namespace breccia {

/// About as many for each rank; all when alone.
TileRun tiles_of(int count, const Communicator* ranks);

/// Slabs side by side, without supports, forces evaluated: a rank's share of them.
/// @param slab   a scene as slab_scene() makes them
/// @param ranks  null: alone
/// @param exec   of the share; built on the host
dem::World tiled_slabs(dem::Config slab, int count, Communicator* ranks, const Exec& exec);

/// How a plate is cut into tiles.
struct PlateTiles {
  int columns = 1, rows = 1;  ///< of tiles  [-]
  Index triangles = 10'000;   ///< of each tile, about  [-]
};
/// Tiles of 10,000 to 40,000 triangles, or one that is smaller.
/// @param triangles  of each part, about  [-]
/// @param parts      of the plate; it has as many tiles for each  [-]
PlateTiles plate_tiles(std::int64_t triangles, int parts);

/// A plate of granite whose triangles are all joined, across the sides of tiles as well. It rings:
/// it starts at 1 m/s and its lower side is held. A rank's share of it, forces evaluated.
fdem::World tiled_plate(const PlateTiles& tiles, Communicator* ranks, const Exec& exec);

}  // namespace breccia
