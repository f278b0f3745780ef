#pragma once
// Contact of two tetrahedra by a potential: the distance to the nearest face of the one that is
// entered (docs/theory-fdem3.md, 3).

#include "math/mat3.hpp"

namespace breccia::fdem3 {

/// A tetrahedron as the points of another see it.
struct Target {
  Vec3 x[4];         ///< corners  [m]
  Vec3 slope[4];     ///< gradients of the corners' coordinates  [1/m]
  double height[4];  ///< of each corner over its face  [m]
  double six_volumes;

  /// @param corner  as of Model::tetrahedron
  BR_HD static Target of(const Vec3 (&corner)[4]) {
    Target t;
    for (int k = 0; k < 4; ++k) t.x[k] = corner[k];
    const Mat3 edges{corner[1] - corner[0], corner[2] - corner[0], corner[3] - corner[0]};
    const Mat3 c = cofactors(edges);
    t.six_volumes = dot(edges.a, c.a);
    const double scale = 1.0 / t.six_volumes;
    t.slope[1] = scale * c.a;
    t.slope[2] = scale * c.b;
    t.slope[3] = scale * c.c;
    t.slope[0] = -(t.slope[1] + t.slope[2] + t.slope[3]);
    return t;
  }
  /// For overlaps; whether two can touch is known without them.
  BR_HD void measure_heights() {
    for (int k = 0; k < 4; ++k) height[k] = 1.0 / norm(slope[k]);
  }
  /// Coordinates of a point: its share of each corner.
  BR_HD void coordinates(const Vec3& p, double (&lambda)[4]) const {
    const Vec3 way = p - x[0];
    lambda[1] = dot(slope[1], way);
    lambda[2] = dot(slope[2], way);
    lambda[3] = dot(slope[3], way);
    lambda[0] = 1.0 - (lambda[1] + lambda[2] + lambda[3]);
  }
};

/// Coordinates of the corners of one tetrahedron in another.
struct CornersInside {
  double lambda[4][4];

  BR_HD static CornersInside of(const Vec3 (&corner)[4], const Target& target) {
    CornersInside c;
    for (int k = 0; k < 4; ++k) target.coordinates(corner[k], c.lambda[k]);
    return c;
  }
  /// Whether a face of the target has all of them on its outer side.
  BR_HD bool beyond_a_face() const {
    for (int k = 0; k < 4; ++k)
      if (lambda[0][k] <= 0.0 && lambda[1][k] <= 0.0 && lambda[2][k] <= 0.0 && lambda[3][k] <= 0.0)
        return true;
    return false;
  }
};

/// A face of one tetrahedron in another.
struct FaceOverlap {
  double region_area[4];  ///< of the part nearest to each face of the target, over the face's area
                          ///< twice  [-]
  double region_sum[4];   ///< integral of the potential there, likewise  [m]
  double moment[3];       ///< integrals of the potential times the share of each corner, over the
                          ///< face's area twice  [m]
  double area;            ///< of the face inside, over its area twice  [-]
  double lambda[3][4];    ///< coordinates of its corners in the target  [-]
};

namespace detail {

/// A linear function on a face, by its corners: at + u along_u + v along_v.
struct Linear {
  double at, along_u, along_v;
  BR_HD double operator()(double u, double v) const { return at + u * along_u + v * along_v; }
};
BR_HD inline Linear operator-(const Linear& a, const Linear& b) {
  return {a.at - b.at, a.along_u - b.along_u, a.along_v - b.along_v};
}

/// A convex polygon on a face; of a triangle cut by seven lines.
struct Polygon {
  static constexpr int most = 12;
  double u[most], v[most];
  int count = 0;

  BR_HD void add(double at_u, double at_v) {
    if (count == most) return;  // rounding cannot make more
    u[count] = at_u;
    v[count] = at_v;
    ++count;
  }
};

/// Leaves the part where f >= 0 or, if not `closed`, f > 0. Most lines do not cross.
BR_HD inline void cut(Polygon& p, const Linear& f, bool closed) {
  double value[Polygon::most];
  unsigned in = 0;
  for (int i = 0; i < p.count; ++i) {
    value[i] = f(p.u[i], p.v[i]);
    if (closed ? value[i] >= 0.0 : value[i] > 0.0) in |= 1U << i;
  }
  if (in == (1U << p.count) - 1U) return;
  Polygon kept;
  for (int i = 0; in != 0 && i < p.count; ++i) {
    const int j = i + 1 == p.count ? 0 : i + 1;
    const bool in_i = (in >> i & 1) != 0, in_j = (in >> j & 1) != 0;
    if (in_i) kept.add(p.u[i], p.v[i]);
    if (in_i == in_j) continue;
    const double s = value[i] / (value[i] - value[j]);
    kept.add(p.u[i] + s * (p.u[j] - p.u[i]), p.v[i] + s * (p.v[j] - p.v[i]));
  }
  p.count = kept.count;
  for (int i = 0; i < kept.count; ++i) {
    p.u[i] = kept.u[i];
    p.v[i] = kept.v[i];
  }
}

/// Adds the integrals of f, f u, f v and 1 over a polygon.
BR_HD inline void integrate(const Polygon& p, const Linear& f, double (&sum)[3], double& area) {
  for (int i = 1; i + 1 < p.count; ++i) {
    const int corner[3] = {0, i, i + 1};
    const double twice =
        (p.u[i] - p.u[0]) * (p.v[i + 1] - p.v[0]) - (p.u[i + 1] - p.u[0]) * (p.v[i] - p.v[0]);
    double value[3], values = 0.0, us = 0.0, vs = 0.0, fu = 0.0, fv = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double u = p.u[corner[k]], v = p.v[corner[k]];
      value[k] = f(u, v);
      values += value[k];
      us += u;
      vs += v;
      fu += value[k] * u;
      fv += value[k] * v;
    }
    area += 0.5 * twice;
    sum[0] += twice * values / 6.0;
    sum[1] += twice * (values * us + fu) / 24.0;
    sum[2] += twice * (values * vs + fv) / 24.0;
  }
}

/// The part of a face that lies in a target, and its distances there from the target's faces.
/// @param lambda  coordinates of its corners in the target  [-]
/// @returns whether any of it does, which rounding may say of one that only touches
BR_HD inline bool part_inside(const Target& target, const double (&lambda)[3][4], Linear (&g)[4],
                              Polygon& inside) {
  bool cuts[4];
  for (int k = 0; k < 4; ++k) {
    const double a = lambda[0][k], b = lambda[1][k], c = lambda[2][k];
    if (a <= 0.0 && b <= 0.0 && c <= 0.0) return false;
    cuts[k] = a < 0.0 || b < 0.0 || c < 0.0;
    const double h = target.height[k];
    g[k] = {h * a, h * (b - a), h * (c - a)};
  }
  inside.add(0.0, 0.0);
  inside.add(1.0, 0.0);
  inside.add(0.0, 1.0);
  for (int k = 0; k < 4; ++k)
    if (cuts[k]) cut(inside, g[k], true);
  return inside.count >= 3;
}

}  // namespace detail

/// Whether a face reaches into a target: true wherever overlap_of_face is, at a quarter of its
/// cost.
BR_HD inline bool face_reaches_into(const Target& target, const double (&lambda)[3][4]) {
  detail::Linear g[4];
  detail::Polygon inside;
  return detail::part_inside(target, lambda, g, inside);
}

/// A face that lies in the plane of one of the target, as those of a flat side of a body do, bounds
/// the overlap together with it: but for rounding both are in each other or none is. So that it
/// counts once, that of a is taken as inside, that of b as outside; both as outside where the
/// tetrahedra lie on two sides of the plane, as beside a crack, and have no volume together.
/// @param apex  coordinates of the corner that is not of the face
BR_HD inline void settle_plane(bool of_a, const double (&apex)[4], double (&lambda)[3][4]) {
  constexpr double rounding = 1e-12;
  for (int m = 0; m < 4; ++m) {
    const double most = max(abs(lambda[0][m]), max(abs(lambda[1][m]), abs(lambda[2][m])));
    if (most > rounding) continue;
    for (int k = 0; k < 3; ++k) lambda[k][m] = of_a && apex[m] > 0.0 ? rounding : 0.0;
  }
}

/// The potential of a target over the part of a face that lies in it: exact.
/// @param o  lambda is given
/// @returns whether any of it does
BR_HD inline bool overlap_of_face(const Target& target, FaceOverlap& o) {
  using detail::Linear;
  Linear g[4];
  detail::Polygon inside;
  if (!detail::part_inside(target, o.lambda, g, inside)) return false;

  double sum[3] = {};
  o.area = 0.0;
  for (int k = 0; k < 4; ++k) {  // where face k of the target is the nearest
    detail::Polygon region = inside;
    for (int m = 0; m < 4 && region.count >= 3; ++m)
      // Of a face in the plane between two regions one takes all.
      if (m != k) detail::cut(region, g[m] - g[k], m > k);
    const double area = o.area, whole = sum[0];
    if (region.count >= 3) detail::integrate(region, g[k], sum, o.area);
    o.region_area[k] = o.area - area;
    o.region_sum[k] = sum[0] - whole;
  }
  o.moment[1] = sum[1];
  o.moment[2] = sum[2];
  o.moment[0] = sum[0] - sum[1] - sum[2];
  return sum[0] > 0.0;
}

/// @param face  corners, counter-clockwise seen from outside  [m]
BR_HD inline bool overlap_of_face(const Vec3 (&face)[3], const Target& target, FaceOverlap& o) {
  for (int i = 0; i < 3; ++i) target.coordinates(face[i], o.lambda[i]);
  return overlap_of_face(target, o);
}

/// Normal forces of an overlap on the corners of the face, F_i = -k J_i N, and on those of the
/// target.
/// @param penalty  k_n  [Pa/m]
BR_HD inline void push(const FaceOverlap& o, const Vec3 (&face)[3], double penalty,
                       Vec3 (&on_face)[3], Vec3 (&on_target)[4]) {
  const Vec3 twice_area = cross(face[1] - face[0], face[2] - face[0]);
  for (int i = 0; i < 3; ++i) on_face[i] = (-penalty * o.moment[i]) * twice_area;
  for (int m = 0; m < 4; ++m)
    on_target[m] =
        -(o.lambda[0][m] * on_face[0] + o.lambda[1][m] * on_face[1] + o.lambda[2][m] * on_face[2]);
}

/// Integrals of the potential of a target over its part inside another tetrahedron, by the regions
/// of its faces: what the deformation of the target changes the energy of contact by.
///
/// Region k is a cone with its apex in the incentre and face k as its base. With s = 0 at the apex
/// and 1 at the base the potential is rho (1 - s), rho the inradius, and the divergence of
/// rho (1/3 - s/4) (x - incentre), which crosses no side of the cone. So the integral follows from
/// areas and integrals on faces alone: those of the other one, and the base's own part in it.
struct Inside {
  double area = 0.0, face_sum = 0.0;  ///< of faces in the target: area, integral of the potential
                                      ///< [m2], [m3]
  Vec3 incentre;
  double radius;              ///<  [m]
  double volume_sum[4] = {};  ///<  [m4]

  BR_HD explicit Inside(const Target& t) {
    double sum = 0.0;
    Vec3 weighted{};
    for (int k = 0; k < 4; ++k) {
      sum += 1.0 / t.height[k];
      weighted += (1.0 / t.height[k]) * t.x[k];
    }
    radius = 1.0 / sum;
    incentre = radius * weighted;
  }
  /// Of a face of the other one that is partly in the target: what add_other() adds.
  struct FaceShare {
    double volume_sum[4], area, face_sum;
  };
  BR_HD FaceShare share_of(const FaceOverlap& o, const Vec3 (&face)[3]) const {
    FaceShare share;
    const Vec3 twice = cross(face[1] - face[0], face[2] - face[0]);
    const double height = dot(face[0] - incentre, twice);  // times twice the area
    for (int k = 0; k < 4; ++k)
      share.volume_sum[k] = height * (radius / 12.0 * o.region_area[k] + 0.25 * o.region_sum[k]);
    const double size = norm(twice);
    share.area = size * o.area;
    share.face_sum = size * (o.moment[0] + o.moment[1] + o.moment[2]);
    return share;
  }
  BR_HD void add_other(const FaceShare& share) {
    for (int k = 0; k < 4; ++k) volume_sum[k] += share.volume_sum[k];
    area += share.area;
    face_sum += share.face_sum;
  }
  /// Whether the integrals are more than rounding: they are small differences where the overlap is
  /// shallow. Forces of shape are to those of `push` as its depth to the inradius.
  BR_HD bool is_deep() const { return face_sum > 1e-6 * radius * area; }

  /// Its own face k, of which this area is in the other one.  [m2]
  BR_HD void add_own(int k, double inside) { volume_sum[k] += radius * radius / 12.0 * inside; }

  /// Adds -k dE/dx of the corners of the target at a fixed overlap: with the forces of `push` they
  /// are the slope of an energy.
  BR_HD void add_shape_forces(const Target& t, double penalty, Vec3 (&on_target)[4]) const {
    if (!is_deep()) return;
    const double whole = volume_sum[0] + volume_sum[1] + volume_sum[2] + volume_sum[3];
    for (int b = 0; b < 4; ++b) {
      Vec3 sum = whole * t.slope[b];
      for (int k = 0; k < 4; ++k)
        sum +=
            (volume_sum[k] * t.height[k] * t.height[k] * dot(t.slope[b], t.slope[k])) * t.slope[k];
      on_target[b] -= penalty * sum;
    }
  }
  BR_HD double energy(double penalty) const {
    if (!is_deep()) return 0.0;
    return penalty * (volume_sum[0] + volume_sum[1] + volume_sum[2] + volume_sum[3]);
  }
};

}  // namespace breccia::fdem3
