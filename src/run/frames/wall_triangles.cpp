#include "run/frames/wall_triangles.hpp"

#include <cmath>
#include <utility>

#include "math/constants.hpp"

namespace breccia {
namespace {

constexpr int sides = 32;

/// Two triangles of a patch with corners in this order.
void add_patch(std::vector<Vec3>& to, const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  to.insert(to.end(), {p, q, r, p, r, s});
}

/// Unit vectors across a direction.
struct Across {
  Vec3 u, v;
  explicit Across(const Vec3& n) {
    const Vec3 other = std::fabs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 first = other - dot(other, n) * n;
    u = (1.0 / norm(first)) * first;
    v = cross(n, u);
  }
  Vec3 at(int side) const {
    const double angle = 2.0 * pi * (side % sides) / sides;
    return std::cos(angle) * u + std::sin(angle) * v;
  }
};

std::vector<Vec3> of_cylinder(const dem::Wall& wall) {
  const Across across(wall.normal);
  const Vec3 back = wall.point - wall.length * wall.normal;
  std::vector<Vec3> all;
  for (int k = 0; k < sides; ++k) {
    const Vec3 here = wall.radius * across.at(k), next = wall.radius * across.at(k + 1);
    add_patch(all, back + here, back + next, wall.point + next, wall.point + here);
    all.insert(all.end(), {wall.point, wall.point + here, wall.point + next});
    all.insert(all.end(), {back, back + next, back + here});
  }
  return all;
}

/// A body of revolution, from its tip to the middle of its back.
std::vector<Vec3> of_nosed(const dem::Wall& wall) {
  constexpr int rings = sides / 2;
  const bool cone = wall.shape == dem::WallShape::cone;
  const double nose = wall.half[0];
  const double arc = (wall.radius * wall.radius + nose * nose) / (2.0 * wall.radius);
  std::vector<std::pair<double, double>> outline{{0.0, 0.0}};  // behind the tip, off the axis  [m]
  for (int ring = 1; ring < rings && !cone; ++ring) {
    const double behind = nose * ring / rings, left = nose - behind;
    outline.emplace_back(behind, std::sqrt(arc * arc - left * left) - (arc - wall.radius));
  }
  outline.emplace_back(nose, wall.radius);
  outline.emplace_back(wall.length, wall.radius);
  outline.emplace_back(wall.length, 0.0);
  const Across across(wall.normal);
  std::vector<Vec3> all;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](std::size_t on, int side) {
        return wall.point - outline[on].first * wall.normal + outline[on].second * across.at(side);
      };
      const Vec3 p = at(i + 1, k), q = at(i + 1, k + 1), r = at(i, k + 1), s = at(i, k);
      if (outline[i + 1].second > 0.0) all.insert(all.end(), {p, q, r});
      if (outline[i].second > 0.0) all.insert(all.end(), {p, r, s});
    }
  return all;
}

std::vector<Vec3> of_box(const dem::Wall& wall) {
  const Vec3 a = wall.half[0] * wall.along;
  const Vec3 b = wall.half[1] * cross(wall.normal, wall.along);
  const Vec3 c = -0.5 * wall.length * wall.normal, middle = wall.point + c;
  std::vector<Vec3> all;
  const auto add = [&](const Vec3& out, const Vec3& u, const Vec3& v) {
    const Vec3 at = middle + out;
    add_patch(all, at - u - v, at + u - v, at + u + v, at - u + v);
  };
  add(a, b, c);
  add(-a, c, b);
  add(b, c, a);
  add(-b, a, c);
  add(c, b, a);
  add(-c, a, b);
  return all;
}

std::vector<Vec3> of_sphere(const dem::Wall& wall) {
  constexpr int rings = sides / 2;
  const Across across({0.0, 0.0, 1.0});
  const auto at = [&](int ring, int side) {
    const double angle = pi * ring / rings;
    return wall.point +
           wall.radius * (std::sin(angle) * across.at(side) + Vec3{0.0, 0.0, std::cos(angle)});
  };
  std::vector<Vec3> all;
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < sides; ++k) {
      const Vec3 p = at(ring, k), q = at(ring + 1, k), r = at(ring + 1, k + 1), s = at(ring, k + 1);
      if (ring + 1 < rings) all.insert(all.end(), {p, q, r});
      if (ring > 0) all.insert(all.end(), {p, r, s});
    }
  return all;
}

}  // namespace

std::vector<Vec3> wall_triangles(const dem::Wall& wall) {
  switch (wall.shape) {
    case dem::WallShape::cylinder:
      return of_cylinder(wall);
    case dem::WallShape::cone:
    case dem::WallShape::ogive:
      return of_nosed(wall);
    case dem::WallShape::box:
      return of_box(wall);
    case dem::WallShape::sphere:
      return of_sphere(wall);
    default:
      return {};
  }
}

}  // namespace breccia
