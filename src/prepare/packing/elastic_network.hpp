#pragma once
// A body's concrete links as an elastic network at rest: forces, displacements and turns.

#include <array>
#include <vector>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// Displacement and turn of each element  [m, rad]
using Displacements = std::vector<std::array<double, 6>>;

/// Elements `members` of a model and the concrete links between them, small displacements:
///
///   F = K_n u n + K_t (du - n n.du),  du = u_b - u_a - (l_a w_a + l_b w_b) x n (docs/theory.md,
///   kinematics of a pair),  M = K_r (w_b - w_a)
///
/// Turns are counted times the mean radius, so that all unknowns are lengths.
class ElasticNetwork {
 public:
  /// @param members  ascending
  /// @param threads  any number of them gives the same bits
  ElasticNetwork(const dem::Model& model, const dem::Config& config, std::vector<Index> members,
                 int threads = 1);

  const std::vector<Index>& members() const { return members_; }
  double mean_radius() const { return mean_radius_; }

  /// Prescribed components of each element: six flags and their values, by member.
  struct Held {
    std::vector<std::array<bool, 6>> fixed;
    Displacements value;  ///< also a first guess of what is free
    explicit Held(std::size_t members) : fixed(members), value(members) {}
  };

  /// Displacements at which free components bear no force, by conjugate gradients.
  /// @param load       forces [N] and torques [N m] on the elements, by member; empty: none
  /// @param tolerance  of the residual forces, over the first ones  [-]
  Displacements relaxed(const Held& held, const Displacements& load = {},
                        double tolerance = 1e-6) const;

  /// Forces and torques that hold the elements at these displacements  [N, N m]
  Displacements forces(const Displacements& at) const;

 private:
  struct Spring {
    Index a, b;  ///< among the members
    Vec3 normal;
    double arm_a, arm_b, normal_stiffness, shear_stiffness, turn_stiffness;
  };
  /// Loads of a spring on its ends: the force on b, and torques over the mean radius.
  struct Action {
    Vec3 force, on_a, on_b;
  };
  Action action_of(const Spring& s, const Displacements& at) const;
  void add_forces(const Displacements& at, Displacements& sum) const;
  void add_forces_by_threads(const Displacements& at, Displacements& sum) const;
  /// work(begin, end) for blocks of `count` members or springs.
  template <class Work>
  void each_block(std::size_t count, const Work& work) const;
  Displacements diagonal() const;

  std::vector<Index> members_;
  std::vector<Spring> springs_;  ///< by a, then b
  int threads_;
  // By threads: first spring of each member as a, and all springs that have it as b, ascending.
  std::vector<std::size_t> first_, first_visitor_, visitor_;
  double mean_radius_ = 0.0;
};

}  // namespace breccia::prepare
