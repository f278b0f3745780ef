#include "prepare/checks/check_between.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/round_numbers.hpp"
#include "prepare/checks/outlines.hpp"

namespace breccia::prepare {
namespace {

/// How far a body of spheres reaches into a box; 0: it does not, or its shape is another one.  [m]
double depth_in(const dem::BodyConfig& body, const Bounds& own, const Bounds& box) {
  double depth = no_limit;
  if (body.shape == "box") {
    for (std::size_t k = 0; k < 3; ++k)
      depth = std::min({depth, own.high[k] - box.low[k], box.high[k] - own.low[k]});
    return std::max(depth, 0.0);
  }
  if (body.shape != "sphere" && body.shape != "element") return 0.0;
  const double at[] = {body.center.x, body.center.y, body.center.z};
  double away = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double out = std::max({box.low[k] - at[k], at[k] - box.high[k], 0.0});
    away += out * out;
    depth = std::min({depth, at[k] - box.low[k], box.high[k] - at[k]});
  }
  return std::max(body.radius + (away > 0.0 ? -std::sqrt(away) : depth), 0.0);
}

}  // namespace

std::vector<std::string> doubtful_bodies(const coupled::Config& config, const std::string& folder) {
  const coupled::Parts parts = coupled::parts_of(config);
  const std::vector<Outline> balls = outlines_of(parts.spheres, &folder),
                             solids = outlines_of(parts.tetrahedra, &folder);
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t j = 0; j < solids.size(); ++j) {
      const dem::BodyConfig& body = parts.spheres.bodies[i];
      const fdem3::BodyConfig& other = parts.tetrahedra.bodies[j];
      const bool is_tied =
          std::any_of(config.bonds.begin(), config.bonds.end(), [&](const auto& bond) {
            return bond.spheres == body.name && bond.tetrahedra == other.name;
          });
      if (is_tied || !balls[i].bounds || !solids[j].bounds || other.shape != "box" ||
          other.is_turned())
        continue;
      const Bounds& own = *balls[i].bounds;
      double size = body.shape == "box" ? no_limit : 2.0 * body.radius;
      for (std::size_t k = 0; k < 3 && body.shape == "box"; ++k)
        size = std::min(size, own.high[k] - own.low[k]);
      const double depth = depth_in(body, own, *solids[j].bounds);
      if (depth > 0.02 * size)
        doubts.push_back(fmt::format(
            "spheres.body.{}: it reaches {} into the tetrahedra of {} at the start; what lies "
            "there will be thrown out, or stays inside",
            body.name, length_text(depth), other.name));
    }
  return doubts;
}

}  // namespace breccia::prepare
