#pragma once
// Holes in tetrahedra that gas fills: how large they are now.

#include <array>
#include <string>
#include <vector>

#include "fdem3/fluid/fluid.hpp"
#include "fdem3/setup/model.hpp"

namespace breccia::fdem3 {

/// The holes that these faces are the walls of.
/// @param faces  4 tetrahedron + k  @param capped  whether rims may be closed
/// @param where  begins the message
/// @throws InputError if they do not close, or run around the outside of a body
std::vector<HoleWall> holes_along(const Model& model, const std::vector<Index>& faces, bool capped,
                                  const std::string& where);

/// Volume within a wall now. Where faces have parted, the wall runs through the mean place of the
/// corners that lay at a vertex.  [m3]
double volume_within(const HoleWall& hole, const std::vector<FaceNow>& faces);

}  // namespace breccia::fdem3
