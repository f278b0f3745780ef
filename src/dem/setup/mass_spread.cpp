#include "dem/setup/mass_spread.hpp"

#include <algorithm>
#include <cmath>

#include "math/constants.hpp"

namespace breccia::dem {
namespace {

/// MassMoments of a solid of density one about the origin of its frame.
struct MassMoments {
  double volume = 0.0;  ///<  [m3]
  Vec3 first{};         ///< volume times centre  [m4]
  Sym3 second{};        ///< integral of x x^T  [m5]
};

/// A body of revolution about z, which lies from the tip at the origin to -length, of this radius
/// behind the tip; by Simpson's rule.
template <class RadiusOf>
MassMoments revolved(double length, const RadiusOf& radius_of) {
  constexpr int intervals = 2000;
  MassMoments m;
  for (int k = 0; k <= intervals; ++k) {
    const double behind = length * k / intervals, r2 = radius_of(behind) * radius_of(behind);
    const double share = k == 0 || k == intervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    const double slice = share * length / (3.0 * intervals) * pi * r2;
    m.volume += slice;
    m.first.z -= slice * behind;
    m.second.xx += 0.25 * slice * r2;
    m.second.yy += 0.25 * slice * r2;
    m.second.zz += slice * behind * behind;
  }
  return m;
}

MassMoments of_cylinder(const WallConfig& w) {
  const bool cone = w.nose == "cone";
  const double r = w.radius, nose = w.nose == "hemisphere" ? r : w.nose_length;
  if (!w.has_nose()) return revolved(w.length, [&](double) { return r; });
  const double arc = (r * r + nose * nose) / (2.0 * r);
  const MassMoments front = revolved(nose, [&](double behind) {
    const double back = nose - behind;
    return cone ? r * behind / nose : std::sqrt(std::max(0.0, arc * arc - back * back)) - (arc - r);
  });
  MassMoments all = front;
  const double length = w.length - nose, volume = pi * r * r * length;
  const double middle = nose + 0.5 * length;
  all.volume += volume;
  all.first.z -= volume * middle;
  all.second.xx += 0.25 * volume * r * r;
  all.second.yy += 0.25 * volume * r * r;
  all.second.zz += volume * (middle * middle + length * length / 12.0);
  return all;
}

MassMoments of_box(const WallConfig& w) {
  const double a = w.size.x, b = w.size.y, c = w.length, volume = a * b * c;
  return {volume,
          {0.0, 0.0, -0.5 * c * volume},
          {volume * a * a / 12.0, volume * b * b / 12.0, volume * c * c / 3.0, 0.0, 0.0, 0.0}};
}

MassMoments of_sphere(double r) {
  const double volume = 4.0 / 3.0 * pi * r * r * r, square = 0.2 * volume * r * r;
  return {volume, {}, {square, square, square, 0.0, 0.0, 0.0}};
}

/// Tetrahedra from the origin to each triangle.
MassMoments of_surface(const std::vector<Vec3>& corners) {
  MassMoments m;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const Vec3 &a = corners[t], &b = corners[t + 1], &c = corners[t + 2], sum = a + b + c;
    const double volume = dot(a, cross(b, c)) / 6.0;
    m.volume += volume;
    m.first += 0.25 * volume * sum;
    const auto part = [&](auto of, auto to) {
      return 0.05 * volume * (of(sum) * to(sum) + of(a) * to(a) + of(b) * to(b) + of(c) * to(c));
    };
    const auto x = [](const Vec3& v) { return v.x; };
    const auto y = [](const Vec3& v) { return v.y; };
    const auto z = [](const Vec3& v) { return v.z; };
    m.second.xx += part(x, x);
    m.second.yy += part(y, y);
    m.second.zz += part(z, z);
    m.second.yz += part(y, z);
    m.second.xz += part(x, z);
    m.second.xy += part(x, y);
  }
  return m;
}

Sym3 inverse_of(const Sym3& s) {
  const double xx = s.yy * s.zz - s.yz * s.yz, yy = s.xx * s.zz - s.xz * s.xz,
               zz = s.xx * s.yy - s.xy * s.xy, yz = s.xy * s.xz - s.xx * s.yz,
               xz = s.xy * s.yz - s.yy * s.xz, xy = s.xz * s.yz - s.zz * s.xy;
  const double over = 1.0 / (s.xx * xx + s.xy * xy + s.xz * xz);
  return {over * xx, over * yy, over * zz, over * yz, over * xz, over * xy};
}

/// Squares of how far the parts of a wall are at most from the axes through its centre.  [m2]
Vec3 reach_of(const WallConfig& w, const Vec3& centre, const std::vector<Vec3>& corners) {
  if (w.shape == "sphere") return w.radius * w.radius * Vec3{1.0, 1.0, 1.0};
  if (w.shape == "stl") {
    Vec3 most{};
    for (const Vec3& corner : corners) {
      const Vec3 d = corner - centre;
      most = {std::max(most.x, d.y * d.y + d.z * d.z), std::max(most.y, d.x * d.x + d.z * d.z),
              std::max(most.z, d.x * d.x + d.y * d.y)};
    }
    return most;
  }
  const double far = std::max(-centre.z, w.length + centre.z), z = far * far;
  const bool box = w.shape == "box";
  const double x = box ? 0.25 * w.size.x * w.size.x : w.radius * w.radius;
  const double y = box ? 0.25 * w.size.y * w.size.y : w.radius * w.radius;
  return {y + z, x + z, box ? x + y : x};
}

}  // namespace

double enclosed_volume(const std::vector<Vec3>& corners) {
  return of_surface(corners).volume;
}

MassSpread mass_spread(const WallConfig& wall, double mass, const std::vector<Vec3>& corners) {
  const MassMoments m = wall.shape == "stl"        ? of_surface(corners)
                        : wall.shape == "box"      ? of_box(wall)
                        : wall.shape == "cylinder" ? of_cylinder(wall)
                                                   : of_sphere(wall.radius);
  const double density = mass / m.volume;
  const Vec3 centre = (1.0 / m.volume) * m.first;
  const auto about = [&](double second, double p, double q) {
    return density * (second - m.volume * p * q);
  };
  const double xx = about(m.second.xx, centre.x, centre.x),
               yy = about(m.second.yy, centre.y, centre.y),
               zz = about(m.second.zz, centre.z, centre.z);
  MassSpread spread;
  spread.offset = -centre;
  spread.inertia = {yy + zz,
                    xx + zz,
                    xx + yy,
                    -about(m.second.yz, centre.y, centre.z),
                    -about(m.second.xz, centre.x, centre.z),
                    -about(m.second.xy, centre.x, centre.y)};
  spread.inverse = inverse_of(spread.inertia);
  const Vec3 reach = reach_of(wall, centre, corners);
  spread.least_mass = 1.0 / (1.0 / mass + reach.x * spread.inverse.xx +
                             reach.y * spread.inverse.yy + reach.z * spread.inverse.zz);
  return spread;
}

}  // namespace breccia::dem
