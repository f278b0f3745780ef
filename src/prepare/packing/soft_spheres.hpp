#pragma once
// Overlapping spheres pushed apart: forces of soft spheres, energy minimised by FIRE.

#include <vector>

#include "prepare/packing/packing.hpp"

namespace breccia::prepare {

/// Spheres of unit mass; an overlap of one unit pushes with one unit of force, one with the
/// container or an obstacle with two. Units of time follow: a period of a pair is about 4.
class SoftSpheres {
 public:
  /// @param threads  any number of them gives the same bits
  SoftSpheres(const PackingTask& task, std::vector<Vec3> position, std::vector<double> radius,
              int threads = 1);

  /// Forces at the present positions, and the energy if it is asked for. Returns the largest
  /// overlap over the smaller radius; walls and obstacles count as mirrors, so that their overlap
  /// is twice the depth  [-]
  double push(bool with_energy = true);
  /// Elastic energy at the last push that was asked for it  [m2]
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
  void list_visitors();
  void push_pairs();
  void push_pairs_by_threads(bool with_energy);
  void meet(std::size_t i, Index pair);
  Vec3 sum_of(std::size_t i) const;
  double worst_of(std::size_t begin, std::size_t end, double worst) const;
  void push_walls();
  void push_obstacles();

  const PackingTask& task_;
  double period_[3] = {};  ///< edge of the cell in periodic directions, 0 in others  [m]
  std::vector<Vec3> position_, velocity_, force_;
  std::vector<double> radius_;
  double margin_;               ///< pairs closer than this are neighbours  [m]
  std::vector<Vec3> searched_;  ///< where the spheres were when neighbours were found  [m]
  std::vector<Index> first_, neighbour_;  ///< of each sphere, each pair once
  int threads_;
  // By threads: what pairs do, and then the pairs that have a sphere as neighbour, ascending.
  std::vector<Vec3> push_;       ///< on the neighbour, of each pair  [m]
  std::vector<double> overlap_;  ///< of each pair; below 0: apart  [m]
  std::vector<Index> first_visitor_, visitor_;
  struct NearObstacle {
    Index sphere, obstacle;
  };
  std::vector<NearObstacle> near_obstacle_;
  double energy_ = 0.0, worst_ = 0.0;
  double dt_, mixing_;
  int downhill_ = 0;  ///< steps since motion was last against the force
};

}  // namespace breccia::prepare
