#pragma once
// Simple solids in the coordinates of the case, and what they enclose together.

#include <vector>

#include "dem/setup/config.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia::prepare {

/// Directions of a turned frame in the case: unit vectors, at right angles.
struct Frame3 {
  Vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};

  Vec3 out(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 in(const Vec3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

/// The frame whose z is along `axis`, and whose x is along `across` less its part along z; where
/// `across` is zero, the frame of the case turned the shortest way.
Frame3 frame_of(const Vec3& axis, const Vec3& across);

/// Half the edges of the box along the axes of the case around one of such half edges in a frame.
/// [m]
Vec3 half_around(const Frame3& frame, const Vec3& half);

/// A box, sphere or cylinder; all are convex.
struct Solid {
  Container container;
  Vec3 center{};  ///<  [m]
  Frame3 frame{};

  /// From a point inside to the nearest face; below 0 outside.  [m]
  double depth(const Vec3& point) const { return container.depth(frame.in(point - center)); }
  /// Half the edges of the box along the axes of the case around it  [m]
  Vec3 half() const;

  /// The part of a segment from a to b that lies within, as shares of its length; low > high: none.
  struct Span {
    double low = 1.0, high = 0.0;
  };
  Span span(const Vec3& a, const Vec3& b) const;
};

/// Of a cut or a join; not of a file.
Solid solid_of(const dem::CutConfig& config);

/// The union of solids.
class Union {
 public:
  explicit Union(std::vector<Solid> solids);
  /// Of a body with joins.
  explicit Union(const dem::BodyConfig& body);

  const Vec3& low() const { return low_; }  ///< of the box around it  [m]
  const Vec3& high() const { return high_; }
  /// By a million points spread evenly in that box: to about 0.1 %.  [m3]
  double volume() const;
  /// From a point inside to the nearest face, at least; below 0 outside.  [m]
  double depth(const Vec3& point) const;
  /// Whether some of the segment from a to b, both inside, lies outside.
  bool parts(const Vec3& a, const Vec3& b) const;

 private:
  std::vector<Solid> solids_;
  Vec3 low_{}, high_{};
};

}  // namespace breccia::prepare
