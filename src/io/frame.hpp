#pragma once
// One moment of a run as output sees it, with fields: spheres and lines; in two dimensions
// triangles; or solid bodies of tetrahedra with their cracks.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/vec.hpp"

namespace breccia {

/// The items that a quantity is given for.
enum class Carrier : std::uint8_t { points, lines, triangles, tetrahedra, none };

/// A named quantity, one value or vector an item.
struct FrameField {
  std::string name;  ///< "damage", "velocity", ...
  std::string unit;
  int components = 1;         ///< 1, 3, or 6: xx, yy, zz, xy, yz, xz of a symmetric tensor
  std::vector<float> values;  ///< components of item 0, then of item 1, ...
  /// Of ids, kinds and the like: `values` as they are before they are rounded.
  std::optional<std::vector<std::int32_t>> integers = {};
};

/// A rigid wall.
struct FrameWall {
  Vec3 point;                      ///< on its face  [m]
  Vec3 normal;                     ///< unit, out of the wall
  std::vector<Vec3> corners = {};  ///< of triangles, three each; empty: a plane without end  [m]
};

/// Two items that press on each other without a link between them.
struct FrameContact {
  std::int32_t a = 0, b = 0;  ///< global ids; b = -1 - k: wall k
  Vec3 at_a, at_b;            ///< centres, or the place on the wall  [m]
  Vec3 force;                 ///< on b  [N; in 2D N/m]
};

/// A field of whole numbers, one an item.
inline FrameField whole_numbers(std::string name, std::vector<std::int32_t> numbers) {
  FrameField field{std::move(name), "-", 1, {numbers.begin(), numbers.end()}};
  field.integers = std::move(numbers);
  return field;
}

/// A piece of a bolt between two of its nodes.
struct FrameBar {
  Vec3 begin, end;        ///<  [m]
  float force;            ///< along it, positive pulls  [N; in 2D N/m]
  float across;           ///<  [N; in 2D N/m]
  float slip;             ///< of its begin along the rock  [m]
  std::int32_t bolt = 0;  ///< its number in the case
};

/// Corners of the faces of a tetrahedron, counter-clockwise as seen from outside.
constexpr int tetrahedron_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Geometry and fields of one moment. Lines, triangles and tetrahedra index `position`.
///
/// In two dimensions triangles are the bodies, and lines the softened and broken joints. In three,
/// tetrahedra are the bodies, and triangles the joints: flat faces between both sides. The
/// points of bodies come first, then those of joints; no two items share one.
///
/// A tetrahedron with the corners 0 1 2 3 has a positive volume, (1 - 0) x (2 - 0) . (3 - 0) > 0.
/// Face k lies opposite corner k (`tetrahedron_faces`). The tetrahedron field "exposed" of whole
/// numbers, where there is one, has bit k set if face k is free or its joint has softened or
/// broken; without it all faces are taken for exposed.
struct Frame {
  std::int64_t step = 0;
  double time = 0.0;                        ///<  [s]
  std::vector<Vec3> position;               ///< centres of spheres, or nodes of triangles  [m]
  std::vector<double> radius;               ///< of the spheres; empty: none are drawn  [m]
  std::vector<FrameField> point_fields;     ///< one item a position
  std::vector<std::int32_t> lines;          ///< two indices a line
  std::vector<FrameField> line_fields;      ///< one item a line
  std::vector<std::int32_t> triangles;      ///< three indices a triangle
  std::vector<FrameField> triangle_fields;  ///< one item a triangle
  std::vector<std::int32_t> tetrahedra;     ///< four indices a tetrahedron
  /// One item a tetrahedron. A tensor is six fields that follow each other: NAME_xx, NAME_yy,
  /// NAME_zz, NAME_xy, NAME_yz, NAME_xz.
  std::vector<FrameField> tetrahedron_fields;
  std::vector<std::string> groups;  ///< names for the point field "group"; may be empty
  std::vector<FrameWall> walls;
  std::vector<FrameContact> contacts;  ///< of a part: those of its rank
  bool bolted = false;                 ///< the case has bolts, which may come later
  std::vector<FrameBar> bars;          ///< of bolts that are there; on each rank all of them
};

/// Where the items of a part of a frame stand in the whole. Such a part has the items of one rank;
/// its lines, triangles and tetrahedra index the points of the whole, and all parts have fields
/// alike.
struct FramePlaces {
  bool whole = false;        ///< it has all items, and no places are listed
  bool has_spheres = false;  ///< the whole frame has radii
  std::int64_t points = 0, lines = 0, triangles = 0, tetrahedra = 0;  ///< in the whole
  /// Of each item here, ascending.
  std::vector<std::int32_t> point, line, triangle, tetrahedron;

  /// Items in the whole; 0 without a carrier.
  std::int64_t count(Carrier carrier) const;
  const std::vector<std::int32_t>& of(Carrier carrier) const;
  /// Triangles are the bodies.
  bool plane() const { return triangles > 0 && tetrahedra == 0; }
};

inline std::int64_t FramePlaces::count(Carrier carrier) const {
  switch (carrier) {
    case Carrier::points:
      return points;
    case Carrier::lines:
      return lines;
    case Carrier::triangles:
      return triangles;
    case Carrier::tetrahedra:
      return tetrahedra;
    case Carrier::none:
      break;
  }
  return 0;
}
inline const std::vector<std::int32_t>& FramePlaces::of(Carrier carrier) const {
  switch (carrier) {
    case Carrier::points:
      return point;
    case Carrier::lines:
      return line;
    case Carrier::tetrahedra:
      return tetrahedron;
    case Carrier::triangles:
    case Carrier::none:
      break;
  }
  return triangle;
}

/// Places of a frame that is whole.
FramePlaces places_in(const Frame& whole);

/// A rank's part of a frame; of a single rank the whole.
struct FramePart {
  Frame frame;
  FramePlaces places;
};

}  // namespace breccia
