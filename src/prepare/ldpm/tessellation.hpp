#pragma once
// Tetrahedra, facets and cells of the lattice discrete particle model.

#include <array>
#include <vector>

#include "exec/types.hpp"
#include "math/vec.hpp"

namespace breccia::prepare {

using Tetrahedron = std::array<Index, 4>;  ///< corners, ascending

/// Tetrahedra of Delaunay's triangulation of the convex hull of points, by Qhull, in ascending
/// order; flat ones, of four points of a plane face, are left out.
///
/// @param scale  a length like the distance of points: flat is below 1e-9 scale^3  [m]
/// @throws InputError if Qhull fails, or if a point is the corner of no tetrahedron
std::vector<Tetrahedron> tetrahedra_of(const std::vector<Vec3>& points, double scale);

/// Six times a volume, positive if d lies on the side of abc from which a, b, c turn clockwise.
double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// A triangle between the cells of two particles, in one tetrahedron.
struct LdpmFacet {
  Index a, b;                   ///< particles, corners of the tetrahedron, a < b
  Index c, d;                   ///< its other corners, c < d
  std::array<Vec3, 3> corners;  ///< inside the tetrahedron, on its face, on the edge  [m]
  Vec3 center;                  ///<  [m]
  double area;                  ///< projected on the plane across the edge  [m2]
};

/// Facets of tetrahedra, 12 each, sorted by (a, b), then by tetrahedron.
///
///   edge point   in the middle of the mortar between two spheres
///   face point   mean over a face's corners of the middle of the mortar between a corner and the
///                edge point opposite to it
///   inner point  the same in the tetrahedron, of corners and face points
///
/// @param diameter  of each particle, that of surface nodes included  [m]
/// Source: Cusatis, Pelessone, Mencarelli 2011, part I; docs/theory-ldpm.md.
std::vector<LdpmFacet> facets_of(const std::vector<Vec3>& points,
                                 const std::vector<double>& diameter,
                                 const std::vector<Tetrahedron>& tetrahedra);

/// Volume of a particle: the pyramids between it and its facets.
struct LdpmCell {
  double volume = 0.0;   ///<  [m3]
  double inertia = 0.0;  ///< about the particle, mean over three axes, over the density  [m5]
};
std::vector<LdpmCell> cells_of(const std::vector<Vec3>& points,
                               const std::vector<LdpmFacet>& facets);

}  // namespace breccia::prepare
