#pragma once
// One moment of a run as output sees it: spheres, lines and, in two dimensions, triangles, with
// fields.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/vec.hpp"

namespace breccia {

/// The items that a quantity is given for.
enum class Carrier : std::uint8_t { points, lines, triangles, none };

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
inline FrameField whole_numbers(const char* name, std::vector<std::int32_t> numbers) {
  FrameField field{name, "-", 1, {numbers.begin(), numbers.end()}};
  field.integers = std::move(numbers);
  return field;
}

/// Geometry and fields of one moment. Lines and triangles index `position`.
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
  std::vector<std::string> groups;          ///< names for the point field "group"; may be empty
  std::vector<FrameWall> walls;
};

/// Where the items of a part of a frame stand in the whole. Such a part has the items of one rank;
/// its lines and triangles index the points of the whole, and all parts have fields alike.
struct FramePlaces {
  bool whole = false;        ///< it has all items, and no places are listed
  bool has_spheres = false;  ///< the whole frame has radii
  std::int64_t points = 0, lines = 0, triangles = 0;  ///< in the whole
  std::vector<std::int32_t> point, line, triangle;    ///< of each item here, ascending
};

/// Places of a frame that is whole.
FramePlaces places_in(const Frame& whole);

/// A rank's part of a frame; of a single rank the whole.
struct FramePart {
  Frame frame;
  FramePlaces places;
  std::vector<FrameContact> contacts;  ///< of this rank
};

}  // namespace breccia
