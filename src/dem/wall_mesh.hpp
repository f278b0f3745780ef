#pragma once
// Rigid walls of triangles: all places where the distance to a surface is least in their
// surroundings.
//
// A sphere touches a surface where its centre is nearer than anywhere around: inside a face, on an
// edge or at a corner. On a face that is divided into triangles there is one such place, wherever
// the inner edges run; a convex edge is one only for centres between the normals of its faces, a
// concave edge never. So nothing is counted twice and nothing jumps.

#include "dem/wall.hpp"
#include "exec/buffer.hpp"

namespace breccia::dem {

/// A box of a tree of triangles, in the order in which a walk meets them.
struct MeshNode {
  Vec3 low, high;      ///< in the frame of the mesh  [m]
  Index next;          ///< where the walk goes on if this box is passed over
  Index first, count;  ///< triangles in it; none: the boxes that follow divide it
};

/// Edge k leads from corner k to the one that follows.
struct MeshTriangle {
  Vec3 corner[3];   ///< anticlockwise, seen from the side of the elements  [m]
  Vec3 across[3];   ///< of the triangle beyond each edge: the corner that is not on it  [m]
  Index vertex[3];  ///< numbers of the corners
  int neighbours;   ///< bit k: there is a triangle beyond edge k
};

/// A surface, as kernels see it. All walls of triangles share the arrays.
struct WallMesh {
  View<const MeshNode> nodes;
  View<const MeshTriangle> triangles;
  View<const Index> starts;   ///< first of the ends of edges at each vertex, and the end
  View<const Vec3> ends;      ///< other ends of edges  [m]
  View<const Vec3> out;       ///< of each vertex: sum of unit normals times angles  [-]
  Index first = 0, last = 0;  ///< nodes of this surface
  bool closed = false;        ///< it has an inside; else elements may be on both of its sides

  bool empty() const { return first == last; }
};

/// How many contacts an element may have with one surface.
inline constexpr int mesh_slots = 8;

/// Where a sphere touches a surface, in the frame of the mesh.
struct MeshTouch {
  Vec3 place;     ///<  [m]
  Vec3 normal;    ///< unit, towards the centre, or out of the inside
  double height;  ///< of the centre above the place  [m]
};

namespace mesh_detail {

/// Of a triangle, nearest to a point.
struct Nearest {
  Vec3 place;
  int on;  ///< 0 to 2: an edge, 3 to 5: a corner, 6: the face
};

/// Ericson 2005, "Real-Time Collision Detection", 5.1.5.
BR_HD inline Nearest nearest(const MeshTriangle& t, const Vec3& p) {
  const Vec3 &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, 3};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, 4};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + d1 / (d1 - d3) * ab, 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, 5};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + d2 / (d2 - d6) * ac, 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 1};
  const double all = va + vb + vc;
  return {a + vb / all * ab + vc / all * ac, 6};
}

BR_HD inline Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  return (1.0 / norm(n)) * n;
}

/// Squared distance of a point from a box.  [m2]
BR_HD inline double squared_from(const MeshNode& box, const Vec3& p) {
  const double x = max(0.0, max(box.low.x - p.x, p.x - box.high.x));
  const double y = max(0.0, max(box.low.y - p.y, p.y - box.high.y));
  const double z = max(0.0, max(box.low.z - p.z, p.z - box.high.z));
  return x * x + y * y + z * z;
}

/// Whether one comes nearer to the centre by moving from a place towards `end`. Within rounding of
/// a right angle one does not: both sides of an edge then claim the place, which counts once.
BR_HD inline bool comes_nearer(const Vec3& from, const Vec3& end) {
  const double slope = dot(from, end);
  return slope > 0.0 && slope * slope > 1e-18 * dot(from, from) * dot(end, end);
}

/// Whether the place is nearest in its surroundings, beyond the triangle as well.
BR_HD inline bool is_least(const WallMesh& mesh, const MeshTriangle& t, const Nearest& at,
                           const Vec3& away) {
  if (at.on == 6) return true;
  if (at.on < 3)
    return (t.neighbours >> at.on & 1) == 0 || !comes_nearer(away, t.across[at.on] - at.place);
  const Index v = t.vertex[at.on - 3];
  for (Index k = mesh.starts[v]; k < mesh.starts[v + 1]; ++k)
    if (comes_nearer(away, mesh.ends[k] - at.place)) return false;
  return true;
}

/// Out of the surface at a place of a triangle; of any length (Baerentzen and Aanaes 2005 for edges
/// and corners).
BR_HD inline Vec3 outward(const WallMesh& mesh, const MeshTriangle& t, int on) {
  if (on >= 3 && on < 6) return mesh.out[t.vertex[on - 3]];
  const Vec3 own = unit_normal(t.corner[0], t.corner[1], t.corner[2]);
  if (on == 6 || (t.neighbours >> on & 1) == 0) return own;
  return own + unit_normal(t.corner[(on + 1) % 3], t.corner[on], t.across[on]);
}

}  // namespace mesh_detail

/// Calls visit(triangle) for the triangles whose boxes come within `reach` of a point, until it
/// returns true. @returns whether it did
template <class Visit>
BR_HD bool any_near(const WallMesh& mesh, const Vec3& p, double reach, Visit&& visit) {
  for (Index n = mesh.first; n < mesh.last;) {
    const MeshNode& node = mesh.nodes[n];
    if (mesh_detail::squared_from(node, p) > reach * reach) {
      n = node.next;
      continue;
    }
    for (Index t = node.first; t < node.first + node.count; ++t)
      if (visit(mesh.triangles[t])) return true;
    ++n;
  }
  return false;
}

/// Whether a point in the frame of the mesh is within `reach` of it.
BR_HD inline bool is_near(const WallMesh& mesh, const Vec3& p, double reach) {
  return any_near(mesh, p, reach, [&](const MeshTriangle& t) {
    const Vec3 away = p - mesh_detail::nearest(t, p).place;
    return dot(away, away) <= reach * reach;
  });
}

/// The places of a surface within a sphere that are nearest to its centre in their surroundings; of
/// more than mesh_slots the nearest. A centre inside of a closed surface is pushed out at the
/// nearest place of all.
struct MeshTouches {
  MeshTouch item[mesh_slots];
  int count = 0;

  BR_HD MeshTouches(const WallMesh& mesh, const Vec3& centre, double radius) {
    double least = radius * radius;
    bool inside = false;
    MeshTouch nearest{};
    any_near(mesh, centre, radius, [&](const MeshTriangle& t) {
      const mesh_detail::Nearest at = mesh_detail::nearest(t, centre);
      const Vec3 away = centre - at.place;
      const double squared = dot(away, away);
      if (squared > radius * radius || !mesh_detail::is_least(mesh, t, at, away)) return false;
      const Vec3 out = mesh_detail::outward(mesh, t, at.on);
      const double side = mesh.closed || squared == 0.0 ? dot(away, out) : 1.0;
      const double height = sqrt(squared);
      const Vec3 normal =
          at.on == 6 || squared == 0.0
              ? (dot(away, out) < 0.0 && !mesh.closed ? -1.0 : 1.0) / norm(out) * out
              : (side < 0.0 ? -1.0 : 1.0) / height * away;
      const MeshTouch touch{at.place, normal, side < 0.0 ? -height : height};
      if (squared < least) {
        least = squared;
        inside = side < 0.0;
        nearest = touch;
      }
      if (side >= 0.0) add(touch, 1e-8 * radius);
      return false;
    });
    if (!inside) return;
    item[0] = nearest;
    count = 1;
  }

 private:
  BR_HD void add(const MeshTouch& touch, double same) {
    int farthest = 0;
    for (int k = 0; k < count; ++k) {
      const Vec3 apart = item[k].place - touch.place;
      if (dot(apart, apart) <= same * same) return;
      if (item[k].height > item[farthest].height) farthest = k;
    }
    if (count < mesh_slots)
      item[count++] = touch;
    else if (touch.height < item[farthest].height)
      item[farthest] = touch;
  }
};

/// A vector of the case in the frame of a wall of triangles, and back.
BR_HD inline Vec3 into_mesh(const Wall& wall, const Vec3& v) {
  return {dot(v, wall.along), dot(v, cross(wall.normal, wall.along)), dot(v, wall.normal)};
}
BR_HD inline Vec3 out_of_mesh(const Wall& wall, const Vec3& v) {
  return v.x * wall.along + v.y * cross(wall.normal, wall.along) + v.z * wall.normal;
}

/// Where an element touches a wall.
/// @param kept  of a wall of triangles: the place in its frame  [m]
BR_HD inline Vec3 foot_on(const Wall& wall, const Vec3& centre, const Vec3& kept) {
  if (wall.shape == WallShape::mesh) return wall.point + out_of_mesh(wall, kept);
  const WallTouch at = touch(wall, centre);
  return centre - at.height * at.normal;
}

}  // namespace breccia::dem
