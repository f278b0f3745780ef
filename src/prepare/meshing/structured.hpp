#pragma once
// Regular meshes that need no mesh generator.

#include "core/random.hpp"
#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

/// Where a rectangle or lattice lies, and how large it is.
struct Rectangle {
  Vec2 center, size;  ///<  [m]
};

/// Rows of triangles that are equilateral as nearly as whole numbers of rows and columns allow.
Mesh equilateral_rectangle(const Rectangle& rectangle, double edge);

/// Squares, as nearly as whole numbers allow, each cut into four by its diagonals.
Mesh crossed_rectangle(const Rectangle& rectangle, double edge);

/// n = radius / edge rings around the centre, 6 n^2 triangles.
Mesh ringed_disc(const Vec2& center, double radius, double edge);

struct HexagonField {
  Vec2 center;          ///<  [m]
  Vec2 size{};          ///< the hexagons fill this rectangle; 0: as close as `gap` allows  [m]
  int count = 1;        ///<  [-]
  double side = 0.0;    ///<  [m]
  double gap = 0.0;     ///< least distance between two hexagons  [m]
  double jitter = 0.0;  ///< each is moved by up to this share of its distance to the next  [-]
  Random random;
};
/// Hexagons of six triangles around their centre, each with seven vertices of its own, on a lattice
/// of staggered rows.
/// @throws InputError if they do not fit
Mesh hexagons(const HexagonField& field);

/// Moves vertices that are not on the rim by up to `share` of the shortest edge there. No triangle
/// loses more than half of its area at one vertex's move; `fixed` vertices stay (may be empty).
void jitter(Mesh& mesh, double share, const Random& random, const std::vector<bool>& fixed);

}  // namespace breccia::prepare
