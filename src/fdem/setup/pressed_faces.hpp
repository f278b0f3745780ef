#pragma once
// Faces that lie on each other where the rock is under stress in situ from the start.

#include <vector>

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Two edges, or parts of them, that press on each other as the stress in situ asks.
struct PressedFace {
  Index edge_a, edge_b;  ///< 3 triangle + edge; the triangle of a is the lower one
  JointHandover bears;   ///< its forces, and work without bound: it is there from the start
};

/// Finds faces of open cracks and of touching bodies, and moves their triangles into each other by
/// the overlap at which contact bears the stress: each as a whole, so that no triangle is strained;
/// joints around it are told. Faces that cannot bear it, because it pulls at them or rubs more than
/// their friction holds, stay as they are, and World::warnings tells of them. To be called before
/// couples are searched.
std::vector<PressedFace> press_faces(World& w);

/// Gives the couples of those faces their forces.
void load_faces(World& w, const std::vector<PressedFace>& faces);

}  // namespace breccia::fdem
