#pragma once
// Where edges of the whole mesh are now, for what the host works out in each step.

#include <vector>

#include "exec/types.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem {

struct World;

/// An edge with the places of its ends.
struct EdgeNow {
  Index edge;  ///< 3 triangle + k of the whole mesh  [-]
  Vec2 from, to;
};

/// Edges of the whole mesh where they are now, ascending; on ranks all get all.
/// @param wanted  3 triangle + k
std::vector<EdgeNow> edges_now(World& part, const std::vector<Index>& wanted);
/// One of them.
const EdgeNow& edge_in(const std::vector<EdgeNow>& edges, Index number);

}  // namespace breccia::fdem
