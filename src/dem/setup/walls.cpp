#include "dem/setup/walls.hpp"

#include <cmath>

namespace breccia::dem {
namespace {

bool is_along(const Vec3& a, const Vec3& b) {
  return norm(cross(a, b)) <= 1e-9 * norm(a) * norm(b);
}

/// Unit, across a normal, as near as can be to what is asked.
Vec3 across(const Vec3& normal, Vec3 asked) {
  if (!(norm(asked) > 0.0))
    asked = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 sideways = asked - dot(asked, normal) * normal;
  return (1.0 / norm(sideways)) * sideways;
}

}  // namespace

std::vector<std::string> wall_problems(const WallConfig& w) {
  std::vector<std::string> problems;
  const std::string where = "wall." + w.name;
  const auto needs = [&](const char* key, bool has, bool wanted) {
    if (has != wanted)
      problems.push_back(
          where + "." + key +
          (wanted ? ": a " + w.shape + " needs it" : ": a " + w.shape + " has none"));
  };
  const bool sphere = w.shape == "sphere", cylinder = w.shape == "cylinder", box = w.shape == "box";
  if (!(norm(w.normal) > 0.0))
    problems.push_back(where + ".normal has length 0; it must point somewhere");
  needs("radius", w.radius > 0.0, sphere || cylinder);
  needs("length", w.length > 0.0, cylinder || box);
  needs("size", w.size.x > 0.0 && w.size.y > 0.0, box);
  if (!box) needs("along", norm(w.along) > 0.0, false);
  if (box && norm(w.along) > 0.0 && is_along(w.along, w.normal))
    problems.push_back(where + ".along must not lead along the normal");
  if (w.shape == "plane" && norm(w.spin) > 0.0 && !is_along(w.spin, w.normal))
    problems.push_back(where +
                       ".spin: a plane without end turns about its normal only; a cylinder "
                       "or box may turn about any axis");
  return problems;
}

Wall wall_of(const WallConfig& config, const Vec3& velocity) {
  Wall wall{config.point, (1.0 / norm(config.normal)) * config.normal, velocity, config.stiffness,
            0.0};
  wall.spin = config.spin;
  wall.radius = config.radius;
  wall.length = config.length;
  if (config.shape == "cylinder") wall.shape = WallShape::cylinder;
  if (config.shape == "sphere") wall.shape = WallShape::sphere;
  if (config.shape == "box") {
    wall.shape = WallShape::box;
    wall.along = across(wall.normal, config.along);
    wall.half[0] = 0.5 * config.size.x;
    wall.half[1] = 0.5 * config.size.y;
  }
  return wall;
}

}  // namespace breccia::dem
