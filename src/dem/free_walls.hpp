#pragma once
// Walls with mass, which move by the forces on them: by the same half steps as elements, on the
// host and on each rank alike.

#include "dem/world.hpp"

namespace breccia::dem {

/// Whether a wall has mass.
inline bool is_free(const World& w, std::size_t wall) {
  return !w.free_walls.empty() && w.given->free_walls[wall].is_free();
}

/// Forces of elements' contacts on walls with mass, at the time of the positions. Sums are
/// exact: every rank, which all call it, finds the same bits.
void sum_on_free_walls(World& w);

/// The least mass over stiffness of its contacts among walls with mass.  [s2]
double least_of_free_walls(const World& w);

/// Velocity half a step on, by the forces at the time of the positions.
void kick_free_wall(World& w, std::size_t wall);

/// Velocity at the time of the positions.  [m/s]
Vec3 velocity_of_free_wall(const World& w, std::size_t wall);

/// Kinetic energy of walls with mass, work of given forces, weight times place: of the first rank,
/// of others nothing.
Energies held_by_free_walls(const World& w);

}  // namespace breccia::dem
