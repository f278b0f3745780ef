#pragma once
// A closed surface of triangles, read from an STL file: what lies in it, how deep, what it parts.

#include <array>
#include <string>
#include <vector>

#include "math/vec.hpp"
#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {

class Surface {
 public:
  using Triangle = std::array<Vec3, 3>;

  /// @param triangles  anticlockwise seen from outside, or all clockwise  [m]
  /// @param name       what messages call it
  /// @throws InputError if the triangles do not enclose a space: an edge that not exactly two of
  ///                    them share, one each way
  Surface(std::vector<Triangle> triangles, const std::string& name);

  double volume() const { return volume_; }  ///<  [m3]
  const Vec3& low() const { return low_; }   ///< of the box around it  [m]
  const Vec3& high() const { return high_; }
  bool holds(const Vec3& point) const;
  /// From a point inside to the surface, or `reach` where it is farther.  [m]
  double distance(const Vec3& point, double reach) const;
  /// Where a segment is nearest to the surface.
  struct Clearance {
    double distance;  ///< 0 where they meet  [m]
    Vec3 at;          ///< of the segment  [m]
  };
  /// Of the segment from a to b; `reach` at a where all of it is farther.
  Clearance clearance(const Vec3& a, const Vec3& b, double reach) const;
  /// Whether the segment from a to b meets a triangle.
  bool parts(const Vec3& a, const Vec3& b) const;

 private:
  /// visit(triangle) for those whose boxes come within `reach` of the box around the segment, and
  /// some more.
  template <class Visit>
  void each_near(const Vec3& a, const Vec3& b, double reach, Visit&& visit) const;

  std::vector<Triangle> triangles_;
  Vec3 low_{}, high_{};
  double volume_ = 0.0;
  double widest_ = 0.0;        ///< half of the longest edge of a box around a triangle  [m]
  std::vector<Vec3> centres_;  ///< of the boxes around the triangles  [m]
  CellGrid near_;              ///< of the centres
  CellGrid columns_;           ///< of the centres, without their height
};

/// The triangles of a binary STL file, or one of text, whether they enclose a space or not.  [m]
/// @param unit  length of one unit of its coordinates  [m]
/// @throws as read_surface
std::vector<Surface::Triangle> read_triangles(const std::string& path, double unit);

/// A binary STL file, or one of text.
/// @param unit  length of one unit of its coordinates  [m]
/// @throws IoError    if it cannot be read
/// @throws InputError names the file, and the line or the triangle that is wrong
Surface read_surface(const std::string& path, double unit);

}  // namespace breccia::prepare
