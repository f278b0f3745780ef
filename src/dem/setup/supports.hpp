#pragma once
// Which elements supports hold, and how these must move.

#include <array>
#include <vector>

#include "core/servo.hpp"
#include "dem/element_kernels.hpp"
#include "dem/setup/model.hpp"

namespace breccia::dem {

struct Config;

/// Motions that supports and walls prescribe.
struct GivenMotions {
  std::vector<Motion> motions;
  AmplitudeTables tables;
  std::vector<ServoMotion> servos;

  Vec3 velocity(std::size_t motion, double time) const {
    return motions[motion].at(time, tables.times_view(), tables.factors_view());
  }
  /// Whether it is, or may come to be, other than rest.
  bool moves(std::size_t motion) const;
  /// Adds a motion of such velocities along x, y, z. Returns its number.
  /// @param load      0, or 1: they are loads over mass
  /// @param friction  Motion::friction
  std::int16_t add(const std::array<ScaledAmplitude, 3>& velocity, std::int32_t load = 0,
                   double friction = 0.0);
};

/// Directions and motions that the supports of a case prescribe, by element.
struct Prescribed {
  std::vector<std::uint8_t> fixed;          ///< bits of Fixed  [-]
  std::vector<std::int16_t> motion;         ///< index into motions, -1: stands still  [-]
  GivenMotions motions;                     ///< each combination of supports that there is
  std::vector<std::vector<Index>> members;  ///< of each support, ascending

  /// Of an element, with one of its own: what is held starts with the motion of its support, so
  /// that no jump of velocity at the start does work.  [m/s], [rad/s]
  Vec3 velocity_at_start(std::size_t element, const Vec3& own) const;
  Vec3 spin_at_start(std::size_t element, const Vec3& own) const;
};

/// The elements in the region of each support at the start, ascending.
/// @throws InputError naming supports that hold none, with the nearest element
std::vector<std::vector<Index>> support_members(const Config& config, const Model& model,
                                                int threads);

/// The members of a support that links join to elements that it does not hold.
std::vector<Index> tied_members(const Model& model, const std::vector<Index>& members);

/// Several supports may hold one element, if they prescribe different directions or the same
/// motion.
/// @param members   of each support
/// @param elements  how many there are in the whole model
/// @param dashpots, masses  Case::dashpots, Case::masses
/// @throws InputError naming supports that contradict each other
Prescribed prescribed(const Config& config, std::vector<std::vector<Index>> members,
                      std::size_t elements, const std::vector<Vec3>& dashpots,
                      const std::vector<double>& masses);

/// Dashpots of absorbing supports: impedance rho c of the material times the face's area, shared by
/// the squares of radii. @throws InputError where a support has elements of several materials
std::vector<Vec3> dashpots_of(const Config& config, const Model& model,
                              const std::vector<std::vector<Index>>& members);

}  // namespace breccia::dem
