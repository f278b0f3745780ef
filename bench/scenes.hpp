#pragma once
// Scenes that benchmarks run, built without a file.

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "fdem/setup/config.hpp"
#include "fdem/world.hpp"

namespace breccia {

/// The scene of cases/rc_slab (Durand et al. 2012, section 5) with a slab `scale` times as long and
/// wide: elements, bars and links grow so that their sizes and densities stay. The rock is always
/// the same and strikes at 30 m/s, 0.1 ms after the start. Laws and speed stay as they are here,
/// whatever the case becomes, so that numbers compare over time.
/// @param scale  1: 14,274 elements; 2.7: 99,262  [-]
dem::Config slab_scene(double scale);
/// When the rock has met that slab and links break.  [s]
inline constexpr double slab_impact_at = 0.2e-3;

/// Tiles [first, last) of `count` equal ones.
struct TileRun {
  int first = 0, last = 1, count = 1;
};

/// So many copies of a model in rows, 2 m apart.
dem::Model side_by_side(const dem::Model& one, int copies, int threads = 1);
/// Only those of them that a rank builds.
dem::Model side_by_side(const dem::Model& one, const TileRun& copies, int threads = 1);

/// Granite, as in cases/brazilian_disc. Laws stay as they are here, so that numbers compare over
/// time.
fdem::Config granite();

/// A plate of about so many triangles, all joined, that rings.
fdem::World plate_world(const Exec& exec, int count);

/// So many hexagons of six free triangles that fly together, 4.4 couples within reach a triangle.
/// @param mingled  hexagons beside each other lie anywhere in memory
fdem::World heap_world(const Exec& exec, int count, bool mingled = false);

}  // namespace breccia
