#pragma once
// Rigid walls: half-spaces, cylinders with and without a nose, boxes, spheres and surfaces of
// triangles, which move and turn as they are told, or move by the forces on them.

#include <cstdint>

#include "dem/wall_nose.hpp"
#include "math/vec.hpp"

namespace breccia::dem {

/// Of a plane all that lies behind its face; a cylinder's axis and a box's depth lead back from the
/// face; a sphere is around its point. A cylinder that ends in a cone or an ogive has its tip for a
/// face; an ogive as long as the radius is a hemisphere. The triangles of a mesh are constants of
/// the case (dem/wall_mesh.hpp).
enum class WallShape : std::int64_t { plane, cylinder, box, sphere, cone, ogive, mesh };

struct Wall {
  Vec3 point;        ///< of the face; of cylinder and box its middle, of a nose its tip; centre of
                     ///< a sphere; origin of a mesh; now  [m]
  Vec3 normal;       ///< unit, out of the face; z of a mesh
  Vec3 velocity;     ///< of the point, half a step before now  [m/s]
  double stiffness;  ///< factor on linear contacts  [-]
  double travelled;  ///< of its farthest part since the last search  [m]
  WallShape shape = WallShape::plane;
  double radius = 0.0;  ///< of cylinder or sphere  [m]
  double length = 0.0;  ///< of cylinder or box behind the face, the nose included  [m]
  Vec3 along{};         ///< box, cone, ogive, x of a mesh: unit, across the normal  [-]
  double half[2] = {};  ///< box: half of its sides along `along` and across; cone, ogive: the
                        ///< nose's length, and nothing; mesh: its farthest corner from its
                        ///< origin, and nothing  [m]
  Vec3 spin{};          ///< [rad/s]

  BR_HD bool turns() const { return dot(spin, spin) > 0.0; }
  /// How far its parts are from its point; of a plane 0, as it turns about its normal only.  [m]
  BR_HD double extent() const {
    switch (shape) {
      case WallShape::cylinder:
      case WallShape::cone:
      case WallShape::ogive:
        return sqrt(radius * radius + length * length);
      case WallShape::box:
        return sqrt(half[0] * half[0] + half[1] * half[1] + length * length);
      case WallShape::mesh:
        return half[0];
      default:
        return 0.0;
    }
  }
  /// R* of an element on it, as flat it is but for a sphere; Hertz asks for it.  [m]
  BR_HD double curved(double of_element) const {
    return shape == WallShape::sphere ? of_element * radius / (of_element + radius) : of_element;
  }
  /// Velocity of what is at a place on it.  [m/s]
  BR_HD Vec3 velocity_at(const Vec3& place) const {
    return turns() ? velocity + cross(spin, place - point) : velocity;
  }
  /// Moves and turns it by a step. Turned by the first two terms of the rotation and made unit
  /// again: the angle is off by (w dt)^3/6.
  BR_HD void move(double dt, const Vec3& drift) {
    point += dt * velocity;
    travelled += dt * norm(velocity - drift);
    if (!turns()) return;
    travelled += dt * norm(spin) * extent();
    normal = turned(normal, dt);
    if (dot(along, along) > 0.0) along = turned(along - dot(along, normal) * normal, dt);
  }

 private:
  BR_HD Vec3 turned(const Vec3& v, double dt) const {
    const Vec3 half_way = v + (0.5 * dt) * cross(spin, v);
    const Vec3 there = v + dt * cross(spin, half_way);
    return (1.0 / norm(there)) * there;
  }
};

/// Where a wall is nearest to a point.
struct WallTouch {
  Vec3 normal;    ///< unit, out of the wall, towards the point
  double height;  ///< of the point above the wall; below 0: inside  [m]
};

namespace wall_detail {

/// From the nearest point of a solid, given how far a point lies beyond it along unit directions.
BR_HD inline WallTouch outside_of(const Vec3& away) {
  const double height = norm(away);
  return {(1.0 / height) * away, height};
}

BR_HD inline WallTouch of_cylinder(const Wall& wall, const Vec3& from) {
  const double above = dot(from, wall.normal);
  const Vec3 sideways = from - above * wall.normal;
  const double off = norm(sideways), beside = off - wall.radius, below = -wall.length - above;
  const Vec3 out = off > 0.0 ? (1.0 / off) * sideways : wall.normal;
  const double over = max(above, below);
  const Vec3 end = above >= below ? wall.normal : -wall.normal;
  if (beside <= 0.0 && (over >= 0.0 || over >= beside)) return {end, over};
  if (over <= 0.0) return {out, beside};
  return outside_of(beside * out + over * end);
}

BR_HD inline WallTouch of_nosed(const Wall& wall, const Vec3& from) {
  const double above = dot(from, wall.normal);
  const Vec3 sideways = from - above * wall.normal;
  const double off = norm(sideways);
  const Vec3 out = off > 0.0 ? (1.0 / off) * sideways : wall.along;
  const NearestOutline at = nearest_outline(-above, off, wall.radius, wall.length, wall.half[0],
                                            wall.shape == WallShape::cone);
  return {at.outward * out - at.behind * wall.normal, at.height};
}

BR_HD inline WallTouch of_box(const Wall& wall, const Vec3& from) {
  const Vec3 axes[3] = {wall.along, cross(wall.normal, wall.along), wall.normal};
  Vec3 away{};
  double deepest = -1e300;
  Vec3 nearest = wall.normal;
  bool inside = true;
  for (int k = 2; k >= 0; --k) {
    const double middle = k == 2 ? -0.5 * wall.length : 0.0;
    const double size = k == 2 ? 0.5 * wall.length : wall.half[k];
    const double at = dot(from, axes[k]) - middle, beyond = abs(at) - size;
    const Vec3 out = at < 0.0 ? -axes[k] : axes[k];
    if (beyond > deepest) {
      deepest = beyond;
      nearest = out;
    }
    if (beyond > 0.0) {
      away += beyond * out;
      inside = false;
    }
  }
  if (inside) return {nearest, deepest};
  return outside_of(away);
}

}  // namespace wall_detail

/// The point of a wall nearest to x. All shapes but meshes, which are not asked, are convex: there
/// is one, and where it goes from face to edge neither normal nor height jumps.
BR_HD inline WallTouch touch(const Wall& wall, const Vec3& x) {
  const Vec3 from = x - wall.point;
  switch (wall.shape) {
    case WallShape::cylinder:
      return wall_detail::of_cylinder(wall, from);
    case WallShape::box:
      return wall_detail::of_box(wall, from);
    case WallShape::cone:
    case WallShape::ogive:
      return wall_detail::of_nosed(wall, from);
    case WallShape::sphere: {
      const double way = norm(from);
      return {way > 0.0 ? (1.0 / way) * from : wall.normal, way - wall.radius};
    }
    default:
      return {wall.normal, dot(from, wall.normal)};
  }
}

}  // namespace breccia::dem
