#pragma once
// The step of the FDEM in space: the only text of the order of its work. Loops on the host and
// launches of a device carry it out alike (exec/for_each.hpp).

#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Forces at the time of the positions, and the step that follows.
void take_forces(World& w);

/// One step: the points of Lukas 2014, section 2.
void take_step(World& w);

// Parts of it.
void move_elements(World& w);
void joint_forces(World& w);
void couple_forces(World& w);
void sum_forces(World& w);
void load_forces(World& w);
void bundle_forces(World& w);

}  // namespace breccia::fdem3
