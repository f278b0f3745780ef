#include "prepare/meshing/holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/region.hpp"
#include "math/constants.hpp"

namespace breccia::prepare {
namespace {

using Polygon = std::vector<Vec2>;

Polygon round(const Vec2& center, double radius) {
  constexpr int sides = 96;
  Polygon polygon;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * pi * k / sides;
    polygon.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

Polygon of_hole(const fdem::HoleConfig& hole) {
  if (hole.corners.empty()) return round(hole.center, hole.radius);
  Polygon polygon = hole.corners;
  for (Vec2& corner : polygon) corner += hole.center;
  return polygon;
}

Polygon of_body(const fdem::BodyConfig& body, const Polygon& outline) {
  if (body.shape == "disc" || body.shape == "ring") return round(body.center, body.radius);
  if (body.shape != "plate" && body.shape != "beam") return outline;
  const Vec2 half = 0.5 * body.size, other{half.x, -half.y}, middle = body.center;
  return {middle - half, middle + other, middle + half, middle - other};
}

bool sides_cross(const Polygon& a, const Polygon& b) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& x) { return cross(q - p, x - p); };
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) {
      const Vec2 &p = a[i], &q = a[(i + 1) % a.size()], &r = b[k], &s = b[(k + 1) % b.size()];
      if (side(p, q, r) * side(p, q, s) < 0.0 && side(r, s, p) * side(r, s, q) < 0.0) return true;
    }
  return false;
}

/// Whether they have an area in common; to rounding, if one touches the other.
bool overlap(const Polygon& a, const Polygon& b) {
  const auto holds = [](const Polygon& polygon, const Polygon& points) {
    return std::any_of(points.begin(), points.end(),
                       [&](const Vec2& x) { return in_polygon(polygon, x); });
  };
  return sides_cross(a, b) || holds(a, b) || holds(b, a);
}

std::string reach_of(const Polygon& polygon) {
  Vec2 low = polygon.front(), high = low;
  for (const Vec2& x : polygon) {
    low = {std::min(low.x, x.x), std::min(low.y, x.y)};
    high = {std::max(high.x, x.x), std::max(high.y, x.y)};
  }
  return fmt::format("x {:.4g} to {:.4g} m, y {:.4g} to {:.4g} m", low.x, high.x, low.y, high.y);
}

}  // namespace

std::vector<std::string> missing_holes(const fdem::BodyConfig& body, const Polygon& outline) {
  std::vector<std::string> problems;
  const Polygon whole = of_body(body, outline);
  const bool round_body = body.shape == "disc" || body.shape == "ring";
  const bool sized = round_body ? body.radius > 0.0
                                : whole.size() != 4 || (body.size.x > 0.0 && body.size.y > 0.0) ||
                                      body.shape == "outline";
  if (whole.size() < 3 || !sized) return problems;  // told elsewhere
  for (std::size_t k = 0; k < body.holes.size(); ++k) {
    const fdem::HoleConfig& hole = body.holes[k];
    if ((hole.radius > 0.0) == !hole.corners.empty()) continue;  // told elsewhere
    const Polygon taken = of_hole(hole);
    if (overlap(whole, taken)) continue;
    problems.push_back(
        fmt::format("hole[{}] lies wholly outside of the body: it is at {}, the body at {}; a hole "
                    "must take something of it",
                    k, reach_of(taken), reach_of(whole)));
  }
  return problems;
}

}  // namespace breccia::prepare
