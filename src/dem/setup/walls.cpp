#include "dem/setup/walls.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::dem {
namespace {

bool is_along(const Vec3& a, const Vec3& b) {
  return norm(cross(a, b)) <= 1e-9 * norm(a) * norm(b);
}

/// Where the x axis goes if z is turned the shortest way to a unit normal.
Vec3 turned_x(const Vec3& n) {
  if (!(n.z > -1.0)) return {1.0, 0.0, 0.0};
  return {1.0 - n.x * n.x / (1.0 + n.z), -n.x * n.y / (1.0 + n.z), -n.x};
}

/// Unit, across a normal, as near as can be to what is asked.
Vec3 across(const Vec3& normal, Vec3 asked) {
  if (!(norm(asked) > 0.0))
    asked = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 sideways = asked - dot(asked, normal) * normal;
  return (1.0 / norm(sideways)) * sideways;
}

void add_nose_problems(const WallConfig& w, std::vector<std::string>& problems) {
  const auto add = [&](const std::string& text) { problems.push_back("wall." + w.name + text); };
  const bool long_nose = w.nose == "cone" || w.nose == "ogive";
  if (w.has_nose() && w.shape != "cylinder") return add(".nose: only a cylinder has one");
  if (!long_nose && w.nose_length > 0.0)
    add(w.has_nose() ? ".nose_length: a hemisphere is as long as its radius; leave it out"
                     : ".nose_length: a flat end has none");
  if (long_nose && !(w.nose_length > 0.0)) add(".nose_length: a nose of this kind needs it");
  if (w.nose == "ogive" && w.nose_length > 0.0 && w.nose_length < w.radius)
    add(".nose_length: an ogive that meets the flank without a bend is at least as long as its "
        "radius");
  if (w.has_nose() && w.length > 0.0 &&
      w.length < (w.nose == "hemisphere" ? w.radius : w.nose_length))
    add(".length counts the nose, too; it must not be below the nose's length");
}

void add_mass_problems(const WallConfig& w, std::vector<std::string>& problems) {
  const auto add = [&](const std::string& text) { problems.push_back("wall." + w.name + text); };
  if (!w.has_mass()) {
    if (!w.free.empty()) add(".free is for a wall with mass; this one moves as it is told");
    if (w.force.is_table() || norm(w.force.value) > 0.0)
      add(".force acts on a wall with mass; this one moves as it is told");
    return;
  }
  if (w.velocity.is_table())
    add(".velocity: a wall with mass moves by the forces on it; one value, with which it begins, "
        "may be given, no table");
  if (w.servo.is_on())
    add(".servo: a wall with mass moves by the forces on it; give force instead");
  if (w.spin.is_table())
    add(".spin: a wall with mass turns by the torques on it; one value, with which it begins, may "
        "be given, no table");
  if (norm(w.spin.value) > 0.0 && !w.is_turning())
    add(".spin: a wall with mass turns only where free names turn");
  if (w.is_turning() && w.shape == "plane")
    add(".free: a plane has no end and no inertia; a box, cylinder, sphere or stl may turn");
  for (const std::string& word : w.free) {
    if (word != "normal" && word != "x" && word != "y" && word != "z" && word != "turn")
      return add(".free: \"" + word + "\" is no direction; allowed are normal, x, y, z, turn");
    if (word == "normal" && (w.free.size() > 1 || w.shape == "sphere"))
      return add(w.shape == "sphere" ? ".free: a sphere has no normal; allowed are x, y, z"
                                     : ".free: normal stands alone, or x, y, z are given");
  }
  const Vec3 begins = w.velocity.value;
  if (!w.velocity.is_table() && norm(w.normal) > 0.0 &&
      norm(begins - free_wall_of(w, 1.0).allowed(begins)) > 1e-9 * norm(begins))
    add(".velocity leads where free does not let the wall go");
}

}  // namespace

std::vector<std::string> wall_problems(const WallConfig& w) {
  std::vector<std::string> problems;
  const std::string where = "wall." + w.name;
  const auto needs = [&](const char* key, bool has, bool wanted) {
    const std::string it = w.shape == "stl" ? "a wall of shape stl" : "a " + w.shape;
    if (has != wanted)
      problems.push_back(where + "." + key + ": " + it + (wanted ? " needs it" : " has none"));
  };
  const bool sphere = w.shape == "sphere", cylinder = w.shape == "cylinder", box = w.shape == "box";
  const bool mesh = w.shape == "stl";
  if (!(norm(w.normal) > 0.0))
    problems.push_back(where + ".normal has length 0; it must point somewhere");
  needs("radius", w.radius > 0.0, sphere || cylinder);
  needs("length", w.length > 0.0, cylinder || box);
  needs("size", w.size.x > 0.0 && w.size.y > 0.0, box);
  needs("file", !w.file.empty(), mesh);
  if (!box && !mesh) needs("along", norm(w.along) > 0.0, false);
  if ((box || mesh) && norm(w.along) > 0.0 && is_along(w.along, w.normal))
    problems.push_back(where + ".along must not lead along the normal");
  std::vector<Vec3> spins = w.spin.values;
  spins.push_back(w.spin.value);
  const auto is_aside = [&](const Vec3& spin) {
    return norm(spin) > 0.0 && !is_along(spin, w.normal);
  };
  if (w.shape == "plane" && std::any_of(spins.begin(), spins.end(), is_aside))
    problems.push_back(where +
                       ".spin: a plane without end turns about its normal only; a cylinder "
                       "or box may turn about any axis");
  add_nose_problems(w, problems);
  add_mass_problems(w, problems);
  return problems;
}

std::vector<WallSpin> wall_spins(const std::vector<WallConfig>& walls) {
  const auto is_table = [](const WallConfig& wall) { return wall.spin.is_table(); };
  if (std::none_of(walls.begin(), walls.end(), is_table)) return {};
  std::vector<WallSpin> all;
  for (const WallConfig& wall : walls) {
    WallSpin& own = all.emplace_back();
    for (int axis = 0; axis < 3; ++axis)
      own.about[static_cast<std::size_t>(axis)] =
          scaled_amplitude(wall.spin, axis, 0.0, wall.begin);
  }
  return all;
}

Wall wall_of(const WallConfig& config, const Vec3& velocity) {
  Wall wall{config.point, (1.0 / norm(config.normal)) * config.normal, velocity, config.stiffness,
            0.0};
  wall.spin = config.spin.at(-config.begin);
  wall.radius = config.radius;
  wall.length = config.length;
  if (config.shape == "cylinder") wall.shape = WallShape::cylinder;
  if (config.is_turning()) wall.along = across(wall.normal, {});
  if (config.has_nose()) {
    wall.shape = config.nose == "cone" ? WallShape::cone : WallShape::ogive;
    wall.half[0] = config.nose == "hemisphere" ? config.radius : config.nose_length;
    wall.along = across(wall.normal, {});
  }
  if (config.shape == "sphere") wall.shape = WallShape::sphere;
  if (config.shape == "stl") {
    wall.shape = WallShape::mesh;
    wall.along =
        across(wall.normal, norm(config.along) > 0.0 ? config.along : turned_x(wall.normal));
  }
  if (config.shape == "box") {
    wall.shape = WallShape::box;
    wall.along = across(wall.normal, config.along);
    wall.half[0] = 0.5 * config.size.x;
    wall.half[1] = 0.5 * config.size.y;
  }
  return wall;
}

FreeWall free_wall_of(const WallConfig& config, double mass_scaling) {
  FreeWall free;
  if (!config.has_mass()) return free;
  free.mass = mass_scaling * config.mass;
  const auto has = [&](const char* axis) {
    return std::find(config.free.begin(), config.free.end(), axis) != config.free.end() ? 1.0 : 0.0;
  };
  free.axes = {has("x"), has("y"), has("z")};
  if (config.free.empty() && config.shape == "sphere") free.axes = {1.0, 1.0, 1.0};
  free.turns = config.is_turning();
  if (!(norm(free.axes) > 0.0) && !free.turns)
    free.normal = (1.0 / norm(config.normal)) * config.normal;
  for (int axis = 0; axis < 3; ++axis)
    free.load[static_cast<std::size_t>(axis)] =
        scaled_amplitude(config.force, axis, 0.0, config.begin);
  return free;
}

}  // namespace breccia::dem
