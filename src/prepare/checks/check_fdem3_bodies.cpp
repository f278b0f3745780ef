#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/most_names.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/shape_keys.hpp"
#include "prepare/tetrahedra/joint_discs.hpp"
#include "prepare/tetrahedra/tet_body.hpp"

namespace breccia::prepare {
namespace {

using TetBodyConfig = fdem3::BodyConfig;

constexpr double most_tetrahedra = 2e8;
/// Tetrahedra in a cube of the edge that is aimed at; of gmsh 4.8.4 it is 5 to 6.
constexpr double tetrahedra_in_cube = 6.0;
constexpr double least_tet_width = 1e-4;  ///< of a body, over mesh_size  [-]

/// Half of the edges of the box around a body whose shape its keys tell.  [m]
Vec3 half_of(const TetBodyConfig& b) {
  Vec3 half{b.radius, b.radius, b.radius};
  if (b.shape == "box") half = 0.5 * b.size;
  if (b.shape == "cylinder")
    (b.axis == "x" ? half.x : b.axis == "y" ? half.y : half.z) = 0.5 * b.height;
  return b.is_turned() ? half_around(frame_of(b), half) : half;
}
bool has_bounds(const TetBodyConfig& b) {
  return b.shape != "mesh" && b.shape != "stl" && b.shape != "part";
}

/// A coordinate along an axis, and the two across it.
double along(const std::string& axis, const Vec3& v) {
  return axis == "x" ? v.x : axis == "y" ? v.y : v.z;
}
double across(const std::string& axis, Vec3 v) {
  (axis == "x" ? v.x : axis == "y" ? v.y : v.z) = 0.0;
  return norm(v);
}

/// The space between two bodies; below 0 they share space by so much. Of cylinders with different
/// axes, that between the boxes around them, or 0.  [m]
double space_between(const TetBodyConfig& a, const TetBodyConfig& b) {
  const Vec3 apart = b.center - a.center, half = half_of(a) + half_of(b);
  const double boxes = std::max(
      {std::abs(apart.x) - half.x, std::abs(apart.y) - half.y, std::abs(apart.z) - half.z});
  if (a.is_turned() || b.is_turned()) return std::max(boxes, 0.0);  // the mesh tells the rest
  const auto is = [&](const char* one, const char* other) {
    return a.shape == one && b.shape == other;
  };
  if (is("sphere", "sphere")) return norm(apart) - a.radius - b.radius;
  if (is("cylinder", "cylinder") && a.axis == b.axis)
    return std::max(boxes, across(a.axis, apart) - a.radius - b.radius);
  if (a.shape == "sphere" || is("cylinder", "box")) return space_between(b, a);
  if (a.shape == "box" && b.shape != "box") {
    const Vec3 beyond{std::max(std::abs(apart.x) - 0.5 * a.size.x, 0.0),
                      std::max(std::abs(apart.y) - 0.5 * a.size.y, 0.0),
                      std::max(std::abs(apart.z) - 0.5 * a.size.z, 0.0)};
    return b.shape == "sphere" ? norm(beyond) - b.radius
                               : std::max(boxes, across(b.axis, beyond) - b.radius);
  }
  if (is("cylinder", "sphere")) {
    const double aside = std::max(across(a.axis, apart) - a.radius, 0.0);
    const double above = std::max(std::abs(along(a.axis, apart)) - 0.5 * a.height, 0.0);
    return std::sqrt(aside * aside + above * above) - b.radius;
  }
  return is("box", "box") ? boxes : std::max(boxes, 0.0);
}

class TetBodyChecks {
 public:
  explicit TetBodyChecks(const fdem3::Config& config) : config_(config) {
    if (config.bodies.empty())
      problems_.push_back("body: the case has no elements; at least one [[body]] is needed");
    add_too_many(config.bodies.size(), "bodies", problems_);
    std::set<std::string> seen;
    for (const TetBodyConfig& b : config.bodies) {
      path_ = "body." + b.name;
      require(seen.insert(b.name).second, "another body has this name");
      check(b);
    }
    seen.clear();
    for (const fdem3::DiscontinuityConfig& d : config.discontinuities) {
      path_ = "discontinuity." + d.name;
      require(seen.insert(d.name).second, "another discontinuity has this name");
      check(d);
    }
    std::vector<std::string> laws;
    for (const auto& law : config.joint_laws) laws.push_back(law.name);
    seen.clear();
    for (const fdem3::JointSetConfig& set : config.joint_sets) {
      path_ = "joint_set." + set.name;
      require(seen.insert(set.name).second, "another joint_set has this name");
      for (const std::string& problem : joint_set_problems(set, laws)) problems_.push_back(problem);
    }
  }
  std::vector<std::string> problems_;

 private:
  template <class... Args>
  void require(bool holds, fmt::format_string<Args...> text, Args&&... args) {
    if (!holds) problems_.push_back(path_ + ": " + fmt::format(text, std::forward<Args>(args)...));
  }
  void require_material(const std::string& key, const std::string& name) {
    require(item_named(config_.materials, name) != nullptr,
            "{} = \"{}\" is not a material; there are: {}", key, name,
            all_names(config_.materials, name));
  }

  void check_part(const TetBodyConfig& b) {
    const auto host = std::find_if(config_.bodies.begin(), config_.bodies.end(),
                                   [&](const TetBodyConfig& each) { return each.name == b.of; });
    require(host != config_.bodies.end() && host->shape != "part",
            "of = \"{}\" must name a body that is no part", b.of);
    const bool box = b.size.x > 0.0 && b.size.y > 0.0 && b.size.z > 0.0;
    require(box != (b.radius > 0.0),
            "a part needs size, or a radius (with a height it is a cylinder), one of them");
    require(!b.is_turned(), "a part is not turned; leave direction and across out");
    require(norm(b.velocity) == 0.0, "a part moves as the body that it is of");
    require(b.mesh_size == 0.0 && b.file.empty() && b.parts.empty() && !b.structured,
            "a part has the mesh of the body that it is of");
    if (!b.grains.kind.empty()) check_grains(b);
    if (host == config_.bodies.end() || box == (b.radius > 0.0)) return;
    const std::string problem = missing_part(b, *host);
    require(problem.empty(), "{}", problem);
  }

  void check(const TetBodyConfig& b) {
    require_material("material", b.material);
    if (b.shape == "part") return check_part(b);
    const bool box = b.shape == "box", cylinder = b.shape == "cylinder",
               sphere = b.shape == "sphere", file = b.shape == "mesh" || b.shape == "stl";
    if (box)
      require(b.size.x > 0.0 && b.size.y > 0.0 && b.size.z > 0.0,
              "shape box needs size, three lengths above 0");
    if (cylinder || sphere) require(b.radius > 0.0, "shape {} needs a radius above 0", b.shape);
    if (cylinder) require(b.height > 0.0, "shape cylinder needs a height above 0");
    for (const std::string& problem : keys_of_other_shapes(b)) problems_.push_back(problem);
    require(!b.is_turned() || box || cylinder || b.shape == "stl",
            "direction and across turn boxes, cylinders and STL surfaces; shape is {}", b.shape);
    require(!b.is_turned() || b.axis == "z",
            "axis = \"{}\" and direction both say where its axis points; give direction alone",
            b.axis);
    const Vec3 z = norm(b.direction) > 0.0 ? b.direction : Vec3{0.0, 0.0, 1.0};
    require(norm(b.across) == 0.0 || norm(cross(z, b.across)) > 1e-6 * norm(z) * norm(b.across),
            "across lies along its own z: it says nothing of how the body is turned");
    require(!b.structured || box, "structured = true is for boxes, not for {}", b.shape);
    if (b.shape == "mesh")
      require(b.mesh_size == 0.0, "mesh_size has no use: the file is the mesh");
    else
      require(b.mesh_size > 0.0, "shape {} needs mesh_size, the edge length of its tetrahedra",
              b.shape);
    if (b.mesh_size > 0.0 && !file) check_size(b);
    const char* ending = b.shape == "stl" ? ".stl" : ".msh or .inp";
    const bool fits = b.shape == "stl" ? b.file.ends_with(".stl")
                                       : b.file.ends_with(".msh") || b.file.ends_with(".inp");
    require(!file || fits, "shape {} needs file, the name of a {} file; it is \"{}\"", b.shape,
            ending, b.file);
    require(file || b.file.empty(), "shape {} reads no file", b.shape);
    require(b.parts.empty() || b.shape == "mesh", "parts are of a mesh file; shape is {}", b.shape);
    if (!b.grains.kind.empty()) check_grains(b);
  }

  void check_size(const TetBodyConfig& b) {
    const Vec3 size = 2.0 * half_of(b);
    const double width = std::min({size.x, size.y, size.z});
    const double cubes = size.x * size.y * size.z / (b.mesh_size * b.mesh_size * b.mesh_size);
    require(tetrahedra_in_cube * cubes < most_tetrahedra,
            "mesh_size = {} m would give more than {:.0e} tetrahedra", b.mesh_size,
            most_tetrahedra);
    require(!(width > 0.0) || width >= least_tet_width * b.mesh_size,
            "{} m is too thin for mesh_size = {} m: at least {} of it is needed", width,
            b.mesh_size, least_tet_width);
  }

  void check_grains(const TetBodyConfig& b) {
    const fdem::GrainsConfig& g = b.grains;
    require(g.kind != "picture",
            "grains.kind = \"picture\" is for plane cases; allowed are voronoi and random");
    require(g.boundary.empty() || g.kind == "voronoi",
            "grains.boundary is between Voronoi grains; kind is {}", g.kind);
    require(g.boundary.empty() || item_named(config_.joint_laws, g.boundary) != nullptr,
            "grains.boundary = \"{}\" is not a joint law; there are: {}", g.boundary,
            all_names(config_.joint_laws, g.boundary));
    require(!g.minerals.empty(), "grains need at least one [[body.grains.mineral]]");
    require(g.kind != "voronoi" || g.size > 0.0, "grains.size must be above 0 for Voronoi grains");
    double sum = 0.0;
    for (std::size_t k = 0; k < g.minerals.size(); ++k) {
      require_material(fmt::format("grains.mineral[{}].material", k), g.minerals[k].material);
      sum += g.minerals[k].fraction;
    }
    require(g.kind == "picture" || std::abs(sum - 1.0) <= 1e-6,
            "the fractions of grains add up to {:.6g}; they must add up to 1", sum);
  }

  void check(const fdem3::DiscontinuityConfig& d) {
    if (d.points.empty()) {
      require(d.radius > 0.0, "a disc needs a radius above 0, and a polygon points");
      require(norm(d.normal) > 0.0, "normal has no length");
    } else {
      require(d.radius == 0.0, "points make it a polygon, and radius a disc; leave one out");
      require(d.points.size() >= 3, "points must be three or more corners; there are {}",
              d.points.size());
      if (d.points.size() >= 3) check_flat(d.points);
    }
    if (d.kind == "cohesive")
      require(item_named(config_.joint_laws, d.material) != nullptr,
              "material = \"{}\" is not a joint law; there are: {}", d.material,
              all_names(config_.joint_laws, d.material));
  }

  void check_flat(const std::vector<Vec3>& points) {
    Vec3 normal{};
    double span = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      normal += 0.5 * cross(points[k] - points[0], points[(k + 1) % points.size()] - points[0]);
      span = std::max(span, norm(points[k] - points[0]));
    }
    const double area = norm(normal);
    require(area > 1e-9 * span * span, "the polygon has no area");
    if (!(area > 1e-9 * span * span)) return;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double off = dot(points[k] - points[0], normal) / area;
      require(std::abs(off) <= 1e-6 * span,
              "points[{}] lies {:.3g} m off the plane of the others; a discontinuity is flat", k,
              std::abs(off));
    }
  }

  const fdem3::Config& config_;
  std::string path_;
};

std::string reach_of(const TetBodyConfig& b) {
  const Vec3 low = b.center - half_of(b), high = b.center + half_of(b);
  return fmt::format("x {:.4g} to {:.4g} m, y {:.4g} to {:.4g} m, z {:.4g} to {:.4g} m", low.x,
                     high.x, low.y, high.y, low.z, high.z);
}

}  // namespace

std::string missing_part(const fdem3::BodyConfig& part, const fdem3::BodyConfig& body) {
  const Vec3 half = half_of(body);
  if (!has_bounds(body) || !(half.x > 0.0 && half.y > 0.0 && half.z > 0.0)) return "";
  TetBodyConfig taken = part;
  taken.shape = !(part.radius > 0.0) ? "box" : part.height > 0.0 ? "cylinder" : "sphere";
  const double space = space_between(taken, body);
  const bool crossed = body.is_turned() || (taken.shape == "cylinder" && body.shape == "cylinder" &&
                                            taken.axis != body.axis);
  const double tolerance = crossed ? 0.0 : 1e-9 * (norm(half) + norm(body.center));
  if (space < -tolerance || (crossed && space == 0.0)) return "";
  return fmt::format(
      "lies wholly outside of body.{}: it is at {}, that body at {}; a part must take something of "
      "it",
      body.name, reach_of(taken), reach_of(body));
}

std::vector<std::string> body_problems(const fdem3::Config& config) {
  return TetBodyChecks(config).problems_;
}

std::vector<std::string> overlap_problems(const std::vector<fdem3::BodyConfig>& bodies) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const TetBodyConfig &a = bodies[i], &b = bodies[j];
      if (!has_bounds(a) || !has_bounds(b)) continue;
      double tolerance =
          1e-9 * (norm(half_of(a)) + norm(half_of(b)) + norm(a.center) + norm(b.center));
      // Meshes lie inside round surfaces, by less than an edge.
      for (const TetBodyConfig* each : {&a, &b})
        if (each->shape != "box") tolerance = std::max(tolerance, each->mesh_size);
      if (space_between(a, b) < -tolerance) problems.push_back(overlap_problem(a.name, b.name));
    }
  return problems;
}

}  // namespace breccia::prepare
