#pragma once
// Flat cracks in space that keep clear of each other, so that a mesh can follow all of them.

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "math/vec.hpp"

namespace breccia::prepare {

/// Corners of a flat convex polygon, around it.
using Corners3 = std::vector<Vec3>;

/// Half of the sum of the cross products of its sides: area times normal.  [m2]
Vec3 area_vector(const Corners3& polygon);
/// The part of a convex polygon inside a box; fewer than three corners: none of it is inside.
Corners3 clipped(Corners3 polygon, const Vec3& low, const Vec3& high);

/// Cracks and faces of bodies. Another crack fits in if with each of them it
///
///   misses   it by `clear` at least, or
///   meets    it at 20 degrees or more, along a line of `clear` at least, which ends on the border
///            of one of the two and no nearer than `clear` to that of the other
///
/// where corners of neither lie nearer than `clear` to the other, and lines in which a crack meets
/// others end no nearer than that to each other. (After the feature rejection of Hyman et al. 2014,
/// with angles besides.) What lies on a face to rounding, as the rim of a crack that is cut there,
/// is no fault.
class CrackNetwork {
 public:
  /// @param clear  0: all fits  [m]
  explicit CrackNetwork(double clear) : clear_(clear) {}

  void add_crack(Corners3 polygon) { add(std::move(polygon), false); }
  void add_face(Corners3 polygon) { add(std::move(polygon), true); }
  bool fits(const Corners3& polygon) const;

 private:
  struct Polygon {
    Corners3 corners;
    Vec3 normal, low, high;
    bool face = false;
  };
  using Line = std::array<Vec3, 2>;
  struct Meeting {
    std::size_t first, second;  ///< polygons
    Line line;
  };

  static Polygon polygon_of(Corners3 corners, bool face);
  void add(Corners3 corners, bool face);
  /// The line in which two meet, if any. @returns whether they keep clear of each other
  bool keep_clear(const Polygon& p, const Polygon& q, std::vector<Line>& lines) const;
  bool far_from_border(const Vec3& point, const Polygon& of) const;

  double clear_;
  std::vector<Polygon> polygons_;
  std::vector<Meeting> meetings_;
};

}  // namespace breccia::prepare
