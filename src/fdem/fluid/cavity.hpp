#pragma once
// Holes in triangles that gas fills: how large they are now.

#include <vector>

#include "fdem/fluid/fluid.hpp"
#include "fdem/setup/model.hpp"

namespace breccia::fdem {

/// Border edges in the order in which they run around holes, a list for each hole.
/// @param edges  3 triangle + k  @param where  begins the message
/// @throws InputError if they do not close, or run around the outside of a body
std::vector<std::vector<Index>> holes_along(const Model& model, const std::vector<Index>& edges,
                                            const std::string& where);

/// Area of a hole now: of a polygon that runs clockwise, as its border does; where edges have
/// parted, it runs straight from one to the next.  [m2]
double volume_within(const std::vector<Index>& hole, const std::vector<EdgeNow>& edges);

}  // namespace breccia::fdem
