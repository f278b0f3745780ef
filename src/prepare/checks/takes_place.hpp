#pragma once
// Whether regions of supports and loads take places on the borders of bodies.

#include <algorithm>
#include <string>
#include <vector>

#include "core/region.hpp"
#include "fdem_shared/shape.hpp"
#include "prepare/checks/outlines.hpp"

namespace breccia::prepare {

/// Whether a region takes a place, to a slack; sides that a mesh names may be there.
template <class Region>
bool takes_place(const Region& region, const Vec3& x, double slack) {
  if constexpr (requires { region.edges; }) {
    if (!region.edges.empty()) return true;
  } else {
    if (!region.faces.empty()) return true;
  }
  const Vec3 low = fdem_shared::to_space(region.min), high = fdem_shared::to_space(region.max);
  constexpr int axes = requires {
    region.min.z;
  }
  ? 3 : 2;
  const double wider = region.outside ? -slack : slack;
  bool inside = true;
  for (int k = 0; k < axes; ++k)
    inside = inside && fdem_shared::part_of(x, k) >= fdem_shared::part_of(low, k) - wider &&
             fdem_shared::part_of(x, k) <= fdem_shared::part_of(high, k) + wider;
  if constexpr (requires { region.around; }) {
    if (region.radius > 0.0)
      inside = inside && in_round(region.center, region.radius + wider, region.around, x);
    if (!region.polygon.empty())
      inside = inside && in_polygon(region.polygon, seen_along(region.around, x));
  } else {
    if (region.radius > 0.0)
      inside = inside && in_circle(region.center, region.radius + wider, {x.x, x.y});
    if (!region.polygon.empty()) inside = inside && in_polygon(region.polygon, {x.x, x.y});
  }
  return inside != region.outside;
}

/// Whether a region takes a place of a body: it may be of that body, or of a part of some other.
template <class Region>
bool reaches(const Region& region, const std::string& body, const std::vector<Outline>& outlines,
             const Vec3& x, double slack) {
  const bool on_part = std::any_of(outlines.begin(), outlines.end(), [&](const Outline& o) {
    return o.in_another && o.name == region.on;
  });
  return (region.on.empty() || region.on == body || on_part) && takes_place(region, x, slack);
}

}  // namespace breccia::prepare
