#pragma once
// Walls with mass, which move by the forces on them: by the same half steps as elements, on the
// host and on each rank alike.

#include "dem/world.hpp"

// A wall that turns keeps the velocity of its centre of mass and its angular momentum L, half a
// step before the positions:
//
//   L_+ = L_- + T dt,   w = R J^-1 R^T L_+ at half of the turn,   R <- Q(w dt) R
//
// with the torque T of contacts, the inertia J in the wall's frame R, and Cayley's rotation Q,
// which needs only + - * /: without torque L stays as it is, and the energy of the turn oscillates
// by the second order of the step. Test: physics/dem/turning_walls_test.cpp.

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

/// Velocity half a step on, by the forces at the time of the positions, and place a step on.
void move_free_wall(World& w, std::size_t wall);

/// At the start: a wall that turns has these velocities of its centre of mass and about it.
void start_turning(World& w, std::size_t wall, const Vec3& velocity, const Vec3& spin);

/// Velocity at the time of the positions; of a wall that turns that of its centre of mass.  [m/s]
Vec3 velocity_of_free_wall(const World& w, std::size_t wall);

/// Angular momentum about a point, at the time of the positions, of a wall that turns.  [kg m2/s]
Vec3 angular_momentum_of_wall(const World& w, std::size_t wall, const Vec3& about);

/// Kinetic energy at the time of the positions.  [J]
double kinetic_of_free_wall(const World& w, std::size_t wall);

/// Kinetic energy of walls with mass, work of given forces, weight times place: of the first rank,
/// of others nothing.
Energies held_by_free_walls(const World& w);

}  // namespace breccia::dem
