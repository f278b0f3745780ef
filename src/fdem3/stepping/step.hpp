#pragma once
// How the step of the FDEM (fdem_shared/step.hpp) is carried out with tetrahedra.

#include "fdem3/world.hpp"
#include "fdem_shared/step.hpp"

namespace breccia::fdem3 {

/// Loops on the host and launches of a device alike (exec/for_each.hpp): all tetrahedra move before
/// ghosts leave, and no joint wakes or goes ahead.
struct Run {
  void move_boundary(World& w) const;
  void send_ghosts(World& w) const;
  void move_interior(World& w) const;
  void ask_for_search(World& w) const;
  void inner_joint_forces(World&) const {}
  void receive_ghosts(World& w) const;
  void search_if_due(World& w) const;
  void insert_joints(World&) const {}
  void pair_forces(World& w) const;
  void sum_forces(World& w) const;
  void load_forces(World& w) const;
  void bundle_forces(World& w) const;
  void choose_step(World& w) const;
  void count_step(World& w) const { w.step += 1; }
};

// Parts of it, for runs of other methods too.
void move_elements(World& w);
void joint_forces(World& w);
void couple_forces(World& w);
void sum_forces(World& w);
void load_forces(World& w);
void bundle_forces(World& w);

}  // namespace breccia::fdem3
