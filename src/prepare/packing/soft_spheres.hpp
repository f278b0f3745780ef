#pragma once
// Overlapping spheres pushed apart: forces of soft spheres, energy minimised by FIRE.

#include <vector>

#include "prepare/packing/packing.hpp"

namespace breccia::prepare {

/// Spheres of unit mass; an overlap of one unit pushes with one unit of force, one with the
/// container or an obstacle with two. Units of time follow: a period of a pair is about 4.
class SoftSpheres {
 public:
  SoftSpheres(const PackingTask& task, std::vector<Vec3> position, std::vector<double> radius);

  /// Forces at the present positions. Returns the largest overlap over the smaller radius; walls
  /// and obstacles count as mirrors, so that their overlap is twice the depth  [-]
  double push();
  /// Elastic energy at the last push  [m2]
  double energy() const { return energy_; }
  /// One step of FIRE under the forces of the last push.
  void move();

  /// Brings what left a periodic cell back on its other side.
  void wrap();

  const std::vector<Vec3>& position() const { return position_; }
  const std::vector<double>& radius() const { return radius_; }

 private:
  bool neighbours_hold() const;
  Vec3 nearest_image(const Vec3& apart) const;
  void find_neighbours();
  void push_pairs();
  void push_walls();
  void push_obstacles();

  const PackingTask& task_;
  double period_[3] = {};  ///< edge of the cell in periodic directions, 0 in others  [m]
  std::vector<Vec3> position_, velocity_, force_;
  std::vector<double> radius_;
  double margin_;               ///< pairs closer than this are neighbours  [m]
  std::vector<Vec3> searched_;  ///< where the spheres were when neighbours were found  [m]
  std::vector<Index> first_, neighbour_;  ///< of each sphere, each pair once
  struct NearObstacle {
    Index sphere, obstacle;
  };
  std::vector<NearObstacle> near_obstacle_;
  double energy_ = 0.0, worst_ = 0.0;
  double dt_, mixing_;
  int downhill_ = 0;  ///< steps since motion was last against the force
};

}  // namespace breccia::prepare
