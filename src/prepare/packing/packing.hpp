#pragma once
// Disordered packings of spheres in a box, a sphere or a cylinder.

#include <array>
#include <vector>

#include "core/random.hpp"
#include "dem/setup/config.hpp"
#include "math/vec.hpp"
#include "prepare/packing/grading.hpp"

namespace breccia::prepare {

/// The space that a packing fills; centred at the origin.
struct Container {
  enum class Shape { box, sphere, cylinder } shape = Shape::box;
  Vec3 size{};          ///< edge lengths of a box  [m]
  double radius = 0.0;  ///< of a sphere or cylinder  [m]
  double length = 0.0;  ///< of a cylinder, along z  [m]

  double volume() const;  ///<  [m3]
  /// Half the edges of the box around it  [m]
  Vec3 half() const;
  /// Whether a sphere about `center` lies inside.
  bool holds(const Vec3& center, double sphere_radius) const;
  /// From a point inside to the nearest face; below 0 outside.  [m]
  double depth(const Vec3& point) const;
  /// From a point inside to the nearest face in each direction that has one: three of a box, that
  /// around and an end of a cylinder.  [m]
  std::array<double, 3> depths(const Vec3& point) const;
};

/// The container of a body; of a file, the box that its spheres fill.
Container container_of(const dem::BodyConfig& body);

/// A fixed obstacle: all points within `radius` of the segment from a to b.
struct Capsule {
  Vec3 a, b;      ///<  [m]
  double radius;  ///<  [m]
};

/// The vector to `point` from the nearest point of the capsule's segment  [m]
Vec3 from_axis(const Capsule& capsule, const Vec3& point);

struct PackingTask {
  Container container;
  std::vector<Capsule> obstacles;
  int count = 0;              ///< spheres, > 0  [-]
  double size_ratio = 2.0;    ///< largest over smallest radius; radii spread uniformly  [-]
  double solid_volume = 0.0;  ///< of all spheres together  [m3]
  Random random;
  /// Directions in which the container has no faces: what leaves it on one side comes back on the
  /// other. All of a box; z of a cylinder; none of a sphere.
  std::array<bool, 3> periodic{};
  Grading grading{};  ///< of diameters; empty: by size_ratio

  bool is_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
};

struct Packing {
  std::vector<Vec3> position;  ///<  [m]
  std::vector<double> radius;  ///<  [m]
  double overlap = 0.0;  ///< largest that remains, over the smaller radius (at walls twice)  [-]
  int iterations = 0;
};

/// Overlaps up to this share of the smaller radius are what a packing may keep  [-]
inline constexpr double overlap_tolerance = 5e-3;

/// Radii uniform in [1, q], one from each of `count` equal parts of that range, or one from each of
/// `count` equal parts of the numbers of a grading; scaled to the wanted solid volume  [m]
std::vector<double> packing_radii(const PackingTask& task);

/// Why the largest sphere does not fit into the container, or meets its own image across a periodic
/// cell; empty: it does.
/// @param radius  those of packing_radii  [m]
std::string misfit(const PackingTask& task, const std::vector<double>& radius);

/// Spheres of exactly the wanted number and volume inside the container and outside the obstacles,
/// from random centres pushed apart until none overlap, or until pushing helps no more (compactness
/// near that of random close packing, 0.61 to 0.64). No random direction is preferred. Periodic
/// ones have their centres in [-half, half).
///
/// Soft spheres in the container (docs/theory.md, packing), energy minimised by FIRE: Bitzek et al.
/// 2006, "Structural relaxation made simple". Only + - * / sqrt: same bits on any machine.
/// Cost: about 0.1 ms a sphere at compactness 0.6.
///
/// @param threads  any number of them gives the same bits
/// @throws InputError if the largest sphere does not fit into the container
Packing pack(const PackingTask& task, int threads = 1);

}  // namespace breccia::prepare
