#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/most_names.hpp"
#include "core/nearest_name.hpp"
#include "math/constants.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/meshing/holes.hpp"

namespace breccia::prepare {
namespace {

using fdem::BodyConfig;
using fdem::DiscontinuityConfig;

constexpr double most_triangles = 2e8;
constexpr double least_width = 1e-4;  ///< of a body, over mesh_size: nobody meshes thinner ones [-]

/// All names, and the one that a name which is none of them may have meant.
std::string list_of(const std::vector<std::string>& names, const std::string& unknown) {
  return (names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))) +
         meant_name(unknown, names);
}

bool is_plain(const BodyConfig& b) {
  const bool plain = b.shape == "plate" || b.shape == "beam" || b.shape == "disc";
  const bool slotted = std::any_of(b.notches.begin(), b.notches.end(),
                                   [](const fdem::NotchConfig& n) { return n.width > 0.0; });
  return plain && b.holes.empty() && !slotted;
}

/// By how much sides of a disc's mesh may lie within its circle, and a hundredth of an edge that
/// shares no area to speak of.  [m]
double within_circle(const BodyConfig& disc) {
  const double r = disc.radius, edge = disc.mesh_size;
  const double sides = disc.structured ? 6.0 * std::max(1.0, std::round(r / edge))
                                       : std::max(3.0, std::floor(2.0 * pi * r / edge));
  return r * (1.0 - std::cos(pi / sides)) + 0.01 * std::min(edge, r);
}

/// The space between two plain bodies; below 0 they share space by so much.  [m]
double gap(const BodyConfig& a, const BodyConfig& b) {
  const Vec2 apart = b.center - a.center;
  if (a.shape == "disc" && b.shape == "disc") return norm(apart) - a.radius - b.radius;
  Vec2 half{};  // of the rectangles
  for (const BodyConfig* each : {&a, &b})
    if (each->shape != "disc") half += 0.5 * each->size;
  const Vec2 beyond{std::abs(apart.x) - half.x, std::abs(apart.y) - half.y};
  if (a.shape != "disc" && b.shape != "disc") return std::max(beyond.x, beyond.y);
  const double radius = a.shape == "disc" ? a.radius : b.radius;
  return norm(Vec2{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0)}) - radius;
}

class BodyChecks {
 public:
  BodyChecks(const std::vector<BodyConfig>& bodies,
             const std::vector<DiscontinuityConfig>& discontinuities, const FdemNames& names)
      : names_(names) {
    if (bodies.empty())
      problems_.push_back("body: the case has no elements; at least one [[body]] is needed");
    add_too_many(bodies.size(), "bodies", problems_);
    std::set<std::string> seen;
    for (const BodyConfig& b : bodies) {
      path_ = "body." + b.name;
      require(seen.insert(b.name).second, "another body has this name");
      check(b);
      if (b.shape == "part") check_part(b, bodies);
    }
    for (const DiscontinuityConfig& d : discontinuities) check(d);
  }
  std::vector<std::string> problems_;

 private:
  template <class... Args>
  void require(bool holds, fmt::format_string<Args...> text, Args&&... args) {
    if (!holds) problems_.push_back(path_ + ": " + fmt::format(text, std::forward<Args>(args)...));
  }
  void require_material(const char* key, const std::string& name) {
    const auto& all = names_.materials;
    require(std::find(all.begin(), all.end(), name) != all.end(),
            "{} = \"{}\" is not a material; there are: {}", key, name, list_of(all, name));
  }

  void check(const BodyConfig& b) {
    require_material("material", b.material);
    const bool rectangle = b.shape == "plate" || b.shape == "beam";
    const bool from_file = b.shape == "outline" || b.shape == "geo" || b.shape == "mesh";
    const bool cut = rectangle || b.shape == "disc" || b.shape == "ring" || b.shape == "outline";
    double area = 0.0;
    if (rectangle) {
      require(b.size.x > 0.0 && b.size.y > 0.0, "shape {} needs size, two lengths above 0",
              b.shape);
      area = b.size.x * b.size.y;
    }
    if (b.shape == "disc" || b.shape == "ring") {
      require(b.radius > 0.0, "shape {} needs a radius above 0", b.shape);
      area = 3.2 * b.radius * b.radius;
    }
    if (b.shape == "ring")
      require(b.inner_radius > 0.0 && b.inner_radius < b.radius,
              "inner_radius = {} m must be between 0 and radius = {} m", b.inner_radius, b.radius);
    if (b.shape == "hexagons") {
      require(b.hexagons.count > 0 && b.hexagons.side > 0.0,
              "shape hexagons needs the table [body.hexagons] with count and side");
      require((b.size.x > 0.0) == (b.size.y > 0.0),
              "size must be two lengths above 0, or left out");
    } else if (b.shape != "geo" && b.shape != "mesh" && b.shape != "part") {
      require(b.mesh_size > 0.0, "shape {} needs mesh_size, the edge length of its triangles",
              b.shape);
      if (b.mesh_size > 0.0)
        require(area / (0.433 * b.mesh_size * b.mesh_size) < most_triangles,
                "mesh_size = {} m would give more than {:.0e} triangles", b.mesh_size,
                most_triangles);
      const double width = rectangle ? std::min(b.size.x, b.size.y) : b.radius;
      if (rectangle || b.shape == "disc" || b.shape == "ring")
        require(!(width > 0.0) || width >= least_width * b.mesh_size,
                "{} = {} m is too thin for mesh_size = {} m: at least {} of it is needed",
                rectangle ? "size" : "radius", width, b.mesh_size, least_width);
    }
    if (from_file) check_file(b);
    require(from_file || b.file.empty(), "shape {} reads no file", b.shape);
    require(b.parts.empty() || b.shape == "geo" || b.shape == "mesh",
            "parts are of a mesh or geo file; shape is {}", b.shape);
    if (b.structured) {
      require(rectangle || b.shape == "disc",
              "structured = true is for plate, beam and disc, not for {}", b.shape);
      require(b.holes.empty(), "a structured mesh can have no holes");
      for (const fdem::NotchConfig& n : b.notches)
        require(n.width == 0.0, "a structured mesh can have open cracks (width 0), but no slots");
    }
    require(cut || b.holes.empty(), "a body of shape {} can have no holes", b.shape);
    for (const fdem::HoleConfig& hole : b.holes) {
      require((hole.radius > 0.0) != !hole.corners.empty(),
              "a hole needs a radius or corners, one of them");
      require(hole.corners.empty() || hole.corners.size() >= 3,
              "a hole with straight sides has three corners or more");
    }
    for (const std::string& problem : prepare::missing_cuts(b, {})) require(false, "{}", problem);
    check_notches(b, cut);
    if (!b.grains.kind.empty()) check_grains(b);
  }

  void check_part(const BodyConfig& b, const std::vector<BodyConfig>& bodies) {
    const auto host = std::find_if(bodies.begin(), bodies.end(),
                                   [&](const BodyConfig& each) { return each.name == b.of; });
    require(host != bodies.end() && host->shape != "part",
            "of = \"{}\" must name a body that is no part", b.of);
    const int ways = (b.corners.empty() ? 0 : 1) + (b.radius > 0.0 ? 1 : 0) +
                     (b.size.x > 0.0 && b.size.y > 0.0 ? 1 : 0);
    require(ways == 1, "a part needs radius, size or corners, one of them");
    require(b.corners.empty() || b.corners.size() >= 3, "a polygon has three corners or more");
    require(norm(b.velocity) == 0.0, "a part moves as the body that it is of");
    if (host == bodies.end() || ways != 1 || (!b.corners.empty() && b.corners.size() < 3)) return;
    const std::string problem = prepare::missing_part(b, *host, {});
    require(problem.empty(), "{}", problem);
  }

  void check_file(const BodyConfig& b) {
    const char* ending = b.shape == "outline" ? ".csv" : b.shape == "geo" ? ".geo" : ".msh or .inp";
    const bool fits = b.shape == "outline" ? b.file.ends_with(".csv")
                      : b.shape == "geo"   ? b.file.ends_with(".geo")
                                           : b.file.ends_with(".msh") || b.file.ends_with(".inp");
    require(fits, "shape {} needs file, the name of a {} file; it is \"{}\"", b.shape, ending,
            b.file);
  }

  void check_notches(const BodyConfig& b, bool cut) {
    for (std::size_t k = 0; k < b.notches.size(); ++k) {
      const fdem::NotchConfig& n = b.notches[k];
      require(norm(n.to - n.from) > 0.0, "notch[{}] has no length: from and to are one point", k);
      require(cut || n.width == 0.0,
              "notch[{}] has a width; a body of shape {} can only have open cracks (width 0)", k,
              b.shape);
    }
  }

  void check_grains(const BodyConfig& b) {
    const fdem::GrainsConfig& g = b.grains;
    require(!g.minerals.empty(), "grains need at least one [[body.grains.mineral]]");
    require(g.kind != "voronoi" || g.size > 0.0, "grains.size must be above 0 for Voronoi grains");
    const auto& joints = names_.joints;
    require(g.boundary.empty() || g.kind == "voronoi",
            "grains.boundary is between Voronoi grains; kind is {}", g.kind);
    require(
        g.boundary.empty() || std::find(joints.begin(), joints.end(), g.boundary) != joints.end(),
        "grains.boundary = \"{}\" is not a joint law; there are: {}", g.boundary,
        list_of(joints, g.boundary));
    const bool picture = g.kind == "picture";
    require(!picture || g.file.ends_with(".png"), "grains.file must name a .png file; it is \"{}\"",
            g.file);
    double sum = 0.0;
    for (std::size_t k = 0; k < g.minerals.size(); ++k) {
      const fdem::MineralConfig& m = g.minerals[k];
      require_material(fmt::format("grains.mineral[{}].material", k).c_str(), m.material);
      sum += m.fraction;
      const bool is_color =
          m.color.size() == 6 &&
          m.color.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
      require(!picture || is_color,
              "grains.mineral[{}].color = \"{}\" is no colour; needed is rrggbb, as in \"ff8800\"",
              k, m.color);
    }
    require(picture || std::abs(sum - 1.0) <= 1e-6,
            "the fractions of grains add up to {:.6g}; they must add up to 1", sum);
  }

  void check(const DiscontinuityConfig& d) {
    path_ = "discontinuity." + d.name;
    require(d.points.size() >= 2, "points must be two or more points; there are {}",
            d.points.size());
    for (std::size_t k = 1; k < d.points.size(); ++k)
      require(norm(d.points[k] - d.points[k - 1]) > 0.0, "points {} and {} are one point", k - 1,
              k);
    const auto& joints = names_.joints;
    if (d.kind == "cohesive")
      require(std::find(joints.begin(), joints.end(), d.material) != joints.end(),
              "material = \"{}\" is not a joint law; there are: {}", d.material,
              list_of(joints, d.material));
  }

  const FdemNames& names_;
  std::string path_;
};

}  // namespace

std::vector<std::string> body_problems(const std::vector<BodyConfig>& bodies,
                                       const std::vector<DiscontinuityConfig>& discontinuities,
                                       const FdemNames& names) {
  return BodyChecks(bodies, discontinuities, names).problems_;
}

std::vector<std::string> overlap_problems(const std::vector<BodyConfig>& bodies) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const BodyConfig &a = bodies[i], &b = bodies[j];
      if (!is_plain(a) || !is_plain(b)) continue;
      double tolerance = 1e-9 * (norm(a.size) + norm(b.size) + norm(a.center) + norm(b.center));
      for (const BodyConfig* each : {&a, &b})
        if (each->shape == "disc") tolerance += within_circle(*each);
      if (gap(a, b) < -tolerance) problems.push_back(overlap_problem(a.name, b.name));
    }
  return problems;
}

}  // namespace breccia::prepare
