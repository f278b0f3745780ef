#pragma once
// Frames of runs that have spheres and tetrahedra: both are written as if they were alone, and
// shown as one.

#include "io/frame.hpp"

namespace breccia {

/// Kinds of files of the tetrahedra in such a run; those of spheres have the usual names.
inline constexpr const char* frame_of_solids = "tetrahedra";
inline constexpr const char* joints_of_solids = "joints";
inline constexpr const char* contacts_of_solids = "joint_contacts";

/// Both in one frame: points of spheres come first; corners have the radius 0, and of fields of
/// spheres what their tetrahedron has. Groups of tetrahedra are numbered on from those of spheres.
Frame paired(const Frame& spheres, const Frame& solids);

/// Number of the first point of tetrahedra.
std::int32_t first_solid(const Frame& frame);

/// Adds contacts of tetrahedra to those of spheres; their ids count on behind these.
void join_contacts(Frame& all, const Frame& solids);

/// Whether a frame has both.
inline bool is_paired(const Frame& frame) {
  return !frame.radius.empty() && !frame.tetrahedra.empty();
}

}  // namespace breccia
