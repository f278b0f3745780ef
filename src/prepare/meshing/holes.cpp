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

Polygon of_notch(const fdem::NotchConfig& notch) {
  return notch.width > 0.0 ? slot_corners(notch) : Polygon{notch.from, notch.to};
}

Polygon of_part(const fdem::BodyConfig& part) {
  if (part.radius > 0.0) return round(part.center, part.radius);
  const Vec2 half = 0.5 * part.size;
  Polygon polygon = part.corners;
  if (polygon.empty()) polygon = {-half, {half.x, -half.y}, half, {-half.x, half.y}};
  for (Vec2& corner : polygon) corner += part.center;
  return polygon;
}

/// No corners: its keys do not tell, or are told of elsewhere.
Polygon of_body(const fdem::BodyConfig& body, const Polygon& outline) {
  const bool round_body = body.shape == "disc" || body.shape == "ring";
  const bool rectangle = body.shape == "plate" || body.shape == "beam";
  if (round_body && !(body.radius > 0.0)) return {};
  if (rectangle && !(body.size.x > 0.0 && body.size.y > 0.0)) return {};
  if (!round_body && !rectangle && outline.size() < 3) return {};
  if (round_body) return round(body.center, body.radius);
  if (!rectangle) return outline;
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

/// Whether they have an area, or a length of a crack, in common; to rounding, if one touches the
/// other.
bool overlap(const Polygon& a, const Polygon& b) {
  constexpr int looks = 16;  // along a side: one whose ends lie on the rim may cross all of it
  const auto holds = [](const Polygon& polygon, const Polygon& other) {
    for (std::size_t k = 0; k < other.size(); ++k)
      for (int j = 0; j < looks; ++j) {
        const Vec2 way = other[(k + 1) % other.size()] - other[k];
        if (in_polygon(polygon, other[k] + (1.0 * j / looks) * way)) return true;
      }
    return false;
  };
  return sides_cross(a, b) || holds(a, b) || holds(b, a);
}

/// Whether a ring has it in its middle.
bool in_the_middle(const fdem::BodyConfig& body, const Polygon& polygon) {
  return body.shape == "ring" && std::all_of(polygon.begin(), polygon.end(), [&](const Vec2& x) {
           return norm(x - body.center) <= body.inner_radius;
         });
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

std::vector<Vec2> slot_corners(const fdem::NotchConfig& notch) {
  const Vec2 along = notch.to - notch.from;
  const Vec2 across = (0.5 * notch.width / norm(along)) * Vec2{-along.y, along.x};
  return {notch.from - across, notch.to - across, notch.to + across, notch.from + across};
}

std::vector<std::string> missing_cuts(const fdem::BodyConfig& body, const Polygon& outline) {
  std::vector<std::string> problems;
  const Polygon whole = of_body(body, outline);
  if (whole.empty()) return problems;
  const auto look = [&](const char* word, std::size_t k, const Polygon& taken) {
    const bool within = in_the_middle(body, taken);
    if (!within && overlap(whole, taken)) return;
    problems.push_back(fmt::format(
        "{0}[{1}] lies wholly {2} of the body: it is at {3}, the body at {4}; a {0} must take "
        "something of it",
        word, k, within ? "in the empty middle" : "outside", reach_of(taken), reach_of(whole)));
  };
  for (std::size_t k = 0; k < body.holes.size(); ++k)
    if ((body.holes[k].radius > 0.0) != !body.holes[k].corners.empty())  // else told elsewhere
      look("hole", k, of_hole(body.holes[k]));
  for (std::size_t k = 0; k < body.notches.size(); ++k)
    if (norm(body.notches[k].to - body.notches[k].from) > 0.0)  // likewise
      look("notch", k, of_notch(body.notches[k]));
  return problems;
}

std::string missing_part(const fdem::BodyConfig& part, const fdem::BodyConfig& body,
                         const Polygon& outline) {
  const Polygon whole = of_body(body, outline), taken = of_part(part);
  if (whole.empty()) return "";
  const bool within = in_the_middle(body, taken);
  if (!within && overlap(whole, taken)) return "";
  return fmt::format(
      "lies wholly {} of body.{}: it is at {}, that body at {}; a part must take something of it",
      within ? "in the empty middle" : "outside", body.name, reach_of(taken), reach_of(whole));
}

}  // namespace breccia::prepare
