#pragma once
// Bodies that a stage takes out of the model. Their elements stay in memory, where they are, held
// and without contact, so that numbers of elements are for ever.

#include "dem/world.hpp"

namespace breccia::dem {

/// Elements that are gone need nothing of a mesh.
inline void open_around_removed(World&) {}
/// Brings the elements that are gone to a stop and lets go of the links that join them to others,
/// as their stage begins. @throws InputError if such a link is none of concrete, of a parallel bond
/// or of a bar in concrete
void cut_off_removed(World& w);

}  // namespace breccia::dem
