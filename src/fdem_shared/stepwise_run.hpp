#pragma once
// Parts of a step of the FDEM that runs share. StepwiseRun is written in stepping.hpp and made for
// each method in its stepping/step.cpp; MovingRun is written in host_run.hpp and made in its
// stepping/host_run.cpp; DeviceRunOf in device_run.hpp and stepping/device_run.cpp.

#include <optional>
#include <vector>

#include "core/step_clock.hpp"
#include "domain/domain.hpp"
#include "exec/shadow_launches.hpp"

namespace breccia::fdem_shared {

/// Of all runs of one step at a time: ghosts, the search, loads, corners that move as one, the time
/// step.
template <class World>
struct StepwiseRun {
  void send_ghosts(World& w) const;
  void ask_for_search(World& w) const;
  void inner_joint_forces(World&) const {}
  void receive_ghosts(World& w) const;
  void search_if_due(World& w) const;
  void insert_joints(World& w) const;
  void coupling_forces(World&) const {}
  void load_forces(World& w) const;
  /// Corners that move as one share their force.
  void bundle_forces(World& w) const;
  void choose_step(World& w) const;
  void count_step(World& w) const { w.step += 1; }
};

/// Loops on the host that move elements, first those that other ranks wait for, then the others,
/// and sum forces up.
template <class Base, class World>
struct MovingRun : Base {
  void move_boundary(World& w) const;
  void move_interior(World& w);
  void sum_up(World& w);

  /// Whether another step follows the one whose forces are evaluated at the time of `w`.
  bool goes_on(const World& w) const { return w.time < until.time && w.step + 1 < until.step; }

  StopAt until{0.0, 0};   ///< steps follow each other at once before that
  bool sums_due = false;  ///< the next move sums forces up
};

/// Launches at once, of a device. @tparam Launches  see device_run.hpp
template <class Launches, class Base, class World>
class DeviceRunOf : public Base {
 public:
  void move_boundary(World& w) const;
  void move_interior(World& w) const;
  void pair_forces(World& w);
  void sum_forces(World& w);

 private:
  std::optional<ShadowLaunches> launches_;
};

}  // namespace breccia::fdem_shared
