#pragma once
// Edges of a mesh along given lines.

#include <vector>

#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

/// The edges between two triangles that follow a polyline most closely.
///
/// For each straight line and each connected region of the mesh within three edges of it, the
/// cheapest path of edges from one end to the other, where an edge costs its length times
/// 1 + 10 (d / h)^2; d is its distance from the line, h the mean edge. An end of the line that lies
/// in the mesh is taken to its nearest vertex; one outside, to where the line enters the mesh.
/// Edges at the rim are left out: nothing is joined there. Sorted by ends, each once.
std::vector<Edge> edges_along(const std::vector<Vec2>& polyline, const std::vector<Vec2>& point,
                              const std::vector<Triangle>& triangles);

}  // namespace breccia::prepare
