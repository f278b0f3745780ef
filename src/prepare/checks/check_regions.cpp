#include "prepare/checks/check_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "dem/setup/walls.hpp"
#include "dem/wall_mesh.hpp"
#include "exec/error.hpp"
#include "fdem/setup/bolts.hpp"
#include "io/round_numbers.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/carve.hpp"
#include "prepare/shapes/wall_files.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

/// A box with sides along the axes; in the plane the third is of no extent.
struct Bounds {
  std::array<double, 3> low{}, high{};  ///<  [m]
};

/// A body as regions see it.
struct Outline {
  std::string name;
  std::optional<Bounds> bounds;  ///< none: only its file tells
  bool in_another = false;       ///< a part: its triangles are some of another body
};

Bounds around(const std::array<double, 3>& center, const std::array<double, 3>& half) {
  Bounds b;
  for (std::size_t k = 0; k < 3; ++k) {
    b.low[k] = center[k] - half[k];
    b.high[k] = center[k] + half[k];
  }
  return b;
}

/// Along the axis along which they are furthest apart; 0 if they meet.  [m]
std::pair<double, std::size_t> gap(const Bounds& a, const Bounds& b) {
  std::pair<double, std::size_t> most{0.0, 0};
  for (std::size_t k = 0; k < 3; ++k)
    most = std::max(most, {std::max(a.low[k] - b.high[k], b.low[k] - a.high[k]), k});
  return most;
}

std::string place(double x) {
  return x < 0.0 ? "-" + length_text(-x) : x > 0.0 ? length_text(x) : "0 m";
}

/// The problem of a region; empty: it may take something, or no outline is known.
std::string problem_of(const std::string& key, const Bounds& region, const std::string& on,
                       const std::vector<Outline>& outlines) {
  for (std::size_t k = 0; k < 3; ++k)
    if (region.low[k] > region.high[k]) return "";  // check_case tells
  const Outline* nearest = nullptr;
  std::pair<double, std::size_t> least{0.0, 0};
  for (const Outline& outline : outlines) {
    if (!on.empty() && outline.name != on) continue;
    if (outline.in_another && on.empty()) continue;
    if (!outline.bounds) return "";
    const auto apart = gap(region, *outline.bounds);
    if (apart.first <= 1e-9) return "";
    if (nearest == nullptr || apart < least) {
      least = apart;
      nearest = &outline;
    }
  }
  if (nearest == nullptr) return "";
  constexpr std::array<char, 3> axes{'x', 'y', 'z'};
  const std::size_t axis = least.second;
  const bool below = region.high[axis] < nearest->bounds->low[axis];
  return fmt::format(
      "{}.{} = {}: the region takes nothing; {} is nearest, {} away, with {} from {} to {}", key,
      below ? "max" : "min", place(below ? region.high[axis] : region.low[axis]), nearest->name,
      length_text(least.first), axes[axis], place(nearest->bounds->low[axis]),
      place(nearest->bounds->high[axis]));
}

const dem::BodyConfig* host_of(const dem::BodyConfig& body, const dem::Config& config) {
  return body.shape == "rebar" ? item_named(config.bodies, body.rebar.in) : &body;
}

void add_to(std::optional<Bounds>& b, const std::array<double, 3>& x, double reach = 0.0) {
  if (!b) b = Bounds{{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}};
  for (std::size_t k = 0; k < 3; ++k) {
    b->low[k] = std::min(b->low[k], x[k] - reach);
    b->high[k] = std::max(b->high[k], x[k] + reach);
  }
}
std::array<double, 3> moved(const Vec3& x, const Vec3& by) {
  return {x.x + by.x, x.y + by.y, x.z + by.z};
}
std::array<double, 3> moved(const Vec2& x, const Vec2& by) {
  return {x.x + by.x, x.y + by.y, 0.0};
}
std::string in_folder(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).string();
}
/// Bounds of a body by its file; none if it cannot be read, which its reader tells.
template <class Read>
std::optional<Bounds> told_by_file(const Read& read) {
  std::optional<Bounds> b;
  try {
    read(b);
  } catch (const Error&) {
    return {};
  }
  return b;
}

/// @param folder  of the case; null: files are not looked at
/// @param radii   whether spheres of a file reach beyond their centres
Outline outline_of(const dem::BodyConfig& body, const dem::Config& config,
                   const std::string* folder, bool radii = false) {
  const dem::BodyConfig* const b = host_of(body, config);
  if (b == nullptr || is_shaped(*b)) return {body.name, {}};
  if (b->shape == "file") {
    const dem::MaterialConfig* const of = item_named(config.materials, b->material);
    if (folder == nullptr || (of != nullptr && of->law == "ldpm")) return {body.name, {}};
    return {body.name, told_by_file([&](std::optional<Bounds>& all) {
              const Spheres spheres = read_spheres(in_folder(*folder, b->file));
              for (std::size_t i = 0; i < spheres.radius.size(); ++i)
                add_to(all, moved(spheres.position[i], b->center), radii ? spheres.radius[i] : 0.0);
            })};
  }
  const std::array<double, 3> center{b->center.x, b->center.y, b->center.z};
  std::array<double, 3> half{b->radius, b->radius, b->radius};
  if (b->shape == "box") half = {0.5 * b->size.x, 0.5 * b->size.y, 0.5 * b->size.z};
  if (b->shape == "cylinder") half[2] = 0.5 * b->length;
  if (b->shape == "element") half = {};
  return {body.name, around(center, half)};
}

Outline outline_of(const fdem::BodyConfig& b, const std::string* folder) {
  if (b.shape == "part") return {b.name, {}, true};
  const bool of_file = b.shape == "outline" || b.shape == "mesh";
  if (of_file && folder != nullptr)
    return {b.name, told_by_file([&](std::optional<Bounds>& all) {
              const std::string path = in_folder(*folder, b.file);
              if (b.shape == "outline") {
                for (const Vec2& x : read_outline(path)) add_to(all, moved(x, b.center));
                return;
              }
              const Mesh mesh = read_mesh(path, b.seams == "open");
              for (const Index t : triangles_of(b, mesh))
                for (const Index v : mesh.triangle[static_cast<std::size_t>(t)])
                  add_to(all, moved(at(mesh.point, v), b.center));
            })};
  const bool round = b.shape == "disc" || b.shape == "ring";
  if (!round && b.shape != "plate" && b.shape != "beam") return {b.name, {}};
  const Vec2 half = round ? Vec2{b.radius, b.radius} : 0.5 * b.size;
  return {b.name, around({b.center.x, b.center.y, 0.0}, {half.x, half.y, 0.0})};
}

Outline outline_of(const fdem3::BodyConfig& b, const std::string* folder) {
  if (b.shape == "part") return {b.name, {}, true};
  if (b.shape == "mesh" || b.shape == "stl") {
    if (folder == nullptr) return {b.name, {}};
    return {b.name, told_by_file([&](std::optional<Bounds>& all) {
              const std::string path = in_folder(*folder, b.file);
              if (b.shape == "stl") {
                const Surface surface = read_surface(path, 1.0);
                add_to(all, moved(surface.low(), b.center));
                add_to(all, moved(surface.high(), b.center));
                return;
              }
              const TetMesh mesh = read_tet_mesh(path);
              for (const Index t : tetrahedra_of(b, mesh))
                for (const Index v : mesh.tetrahedron[static_cast<std::size_t>(t)])
                  add_to(all, moved(mesh.point[static_cast<std::size_t>(v)], b.center));
            })};
  }
  std::array<double, 3> half{b.radius, b.radius, b.radius};
  if (b.shape == "box") half = {0.5 * b.size.x, 0.5 * b.size.y, 0.5 * b.size.z};
  if (b.shape == "cylinder") half[b.axis == "x" ? 0U : b.axis == "y" ? 1U : 2U] = 0.5 * b.height;
  return {b.name, around({b.center.x, b.center.y, b.center.z}, half)};
}

void cut_to(Bounds& b, const std::array<double, 3>& low, const std::array<double, 3>& high) {
  for (std::size_t k = 0; k < 3; ++k) {
    b.low[k] = std::max(b.low[k], low[k]);
    b.high[k] = std::min(b.high[k], high[k]);
  }
}
constexpr std::array<double, 3> nowhere_low{-no_limit, -no_limit, -no_limit},
    nowhere_high{no_limit, no_limit, no_limit};

Bounds bounds_of(const fdem::RegionConfig& r) {
  if (r.outside) return {nowhere_low, nowhere_high};
  Bounds b{{r.min.x, r.min.y, 0.0}, {r.max.x, r.max.y, 0.0}};
  if (r.radius > 0.0)
    cut_to(b, {r.center.x - r.radius, r.center.y - r.radius, 0.0},
           {r.center.x + r.radius, r.center.y + r.radius, 0.0});
  if (r.polygon.empty()) return b;
  Vec2 low = r.polygon[0], high = low;
  for (const Vec2& p : r.polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  cut_to(b, {low.x, low.y, 0.0}, {high.x, high.y, 0.0});
  return b;
}
/// Of a box in space and a sphere or cylinder.
template <class Region>
Bounds bounds_in_space(const Region& s) {
  if (s.outside) return {nowhere_low, nowhere_high};
  Bounds b{{s.min.x, s.min.y, s.min.z}, {s.max.x, s.max.y, s.max.z}};
  if (!(s.radius > 0.0)) return b;
  std::array<double, 3> low{s.center.x - s.radius, s.center.y - s.radius, s.center.z - s.radius},
      high{s.center.x + s.radius, s.center.y + s.radius, s.center.z + s.radius};
  for (std::size_t k = 0; k < 3; ++k)
    if (s.around == std::string(1, "xyz"[k])) {
      low[k] = -no_limit;
      high[k] = no_limit;
    }
  cut_to(b, low, high);
  return b;
}

Bounds bounds_of(const dem::SupportConfig& s) {
  return bounds_in_space(s);
}
Bounds bounds_of(const fdem3::RegionConfig& r) {
  return bounds_in_space(r);
}

Vec3 nearest_in(const Bounds& b, const Vec3& x) {
  return {std::clamp(x.x, b.low[0], b.high[0]), std::clamp(x.y, b.low[1], b.high[1]),
          std::clamp(x.z, b.low[2], b.high[2])};
}

/// Height of a box's nearest point above a wall, by projecting to and fro: both are convex.  [m]
double height_above(const dem::Wall& wall, const Bounds& b) {
  Vec3 x = nearest_in(b, wall.point);
  double height = 0.0;
  for (int i = 0; i < 200; ++i) {
    const dem::WallTouch at = dem::touch(wall, x);
    height = at.height;
    if (height <= 0.0) break;
    x = nearest_in(b, x - height * at.normal);
  }
  return height;
}

/// The box around a wall of triangles.
Bounds bounds_of(const dem::Wall& wall, const std::vector<Vec3>& corners) {
  Bounds b{{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}};
  for (const Vec3& corner : corners) {
    const Vec3 x = wall.point + dem::out_of_mesh(wall, corner);
    const std::array<double, 3> at{x.x, x.y, x.z};
    for (std::size_t k = 0; k < 3; ++k) {
      b.low[k] = std::min(b.low[k], at[k]);
      b.high[k] = std::max(b.high[k], at[k]);
    }
  }
  return b;
}

/// How far a body reaches behind a wall's face; 0 where it does not, and of bodies whose outline is
/// no box, ball or upright cylinder.  [m]
double depth_behind(const dem::Wall& wall, const dem::BodyConfig& body, const Bounds& b) {
  const bool ball = body.shape == "sphere", round = body.shape == "cylinder";
  if (!ball && !round && body.shape != "box") return 0.0;
  constexpr int steps = 16;  // along each side; its ends are looked at, too
  double depth = 0.0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      for (int k = 0; k <= steps; ++k) {
        const auto at = [&](std::size_t axis, int n) {
          return b.low[axis] + (b.high[axis] - b.low[axis]) * n / steps;
        };
        const Vec3 x{at(0, i), at(1, j), at(2, k)};
        Vec3 out = x - body.center;
        if (round) out.z = 0.0;
        if ((ball || round) && norm(out) > body.radius * (1.0 + 1e-9)) continue;
        depth = std::max(depth, -dem::touch(wall, x).height);
      }
  return depth;
}

/// Height of a box's farthest corner above a plane.  [m]
double farthest_above(const dem::Wall& plane, const Bounds& b) {
  const Vec3 corner{plane.normal.x > 0.0 ? b.high[0] : b.low[0],
                    plane.normal.y > 0.0 ? b.high[1] : b.low[1],
                    plane.normal.z > 0.0 ? b.high[2] : b.low[2]};
  return dot(corner - plane.point, plane.normal);
}

/// The problem of a point that no body can hold; empty: one may.
std::string problem_of_point(const std::string& key, const Vec2& point,
                             const std::vector<Outline>& outlines) {
  const Bounds here{{point.x, point.y, 0.0}, {point.x, point.y, 0.0}};
  const Outline* nearest = nullptr;
  double least = no_limit;
  for (const Outline& outline : outlines) {
    if (outline.in_another) continue;
    if (!outline.bounds) return "";
    const double apart = gap(here, *outline.bounds).first;
    if (apart <= 1e-9) return "";
    if (apart >= least) continue;
    least = apart;
    nearest = &outline;
  }
  if (nearest == nullptr) return "";
  return fmt::format("{}: ({}, {}) lies in no body; {} is nearest, {} away", key, place(point.x),
                     place(point.y), nearest->name, length_text(least));
}

std::vector<Outline> outlines_of(const dem::Config& config, const std::string* folder,
                                 bool radii = false) {
  std::vector<Outline> all;
  for (const auto& body : config.bodies) all.push_back(outline_of(body, config, folder, radii));
  return all;
}
template <class Config>
std::vector<Outline> outlines_of(const Config& config, const std::string* folder) {
  std::vector<Outline> all;
  for (const auto& body : config.bodies) all.push_back(outline_of(body, folder));
  return all;
}

/// Supports and loads of meshes, bolts of plane ones.
template <class Config>
void check_faces_and_corners(const Config& config, const std::string* folder) {
  const std::vector<Outline> outlines = outlines_of(config, folder);
  std::vector<std::string> problems;
  for (const auto& s : config.supports)
    problems.push_back(problem_of("support." + s.name, bounds_of(s.region), s.region.on, outlines));
  for (const auto& load : config.loads)
    problems.push_back(
        problem_of("load." + load.name, bounds_of(load.region), load.region.on, outlines));
  if constexpr (requires { config.bolts; })
    for (const auto& bolt : config.bolts)
      for (const Vec2& point : fdem::corners_of(bolt))
        problems.push_back(problem_of_point("bolt." + bolt.name + ".points", point, outlines));
  std::erase(problems, "");
  refuse(problems, "in the case");
}

/// What of a body a wall will throw out; empty: none of it.
std::string behind(const dem::Wall& wall, const dem::WallConfig& asked, const dem::BodyConfig& body,
                   const Outline& outline) {
  const Bounds& b = *outline.bounds;
  if (asked.shape == "plane" && farthest_above(wall, b) < 0.0)
    return fmt::format(
        "wall.{}.normal: all of {} lies behind the wall, which will throw it out; does the normal "
        "point away from it?",
        asked.name, outline.name);
  constexpr double slight = 0.02;  // of the smallest side: elements settle by themselves
  double side = no_limit;
  for (std::size_t k = 0; k < 3; ++k) side = std::min(side, b.high[k] - b.low[k]);
  const double depth = depth_behind(wall, body, b);
  if (!(depth > slight * side)) return "";
  return fmt::format(
      "wall.{}.point: {} reaches {} behind the wall's face at the start; what lies there will be "
      "thrown out",
      asked.name, outline.name, length_text(depth));
}

}  // namespace

std::vector<std::string> doubtful_walls(const dem::Config& config, const std::string& case_folder) {
  std::vector<Outline> outlines = outlines_of(config, &case_folder, true);
  for (std::size_t b = 0; b < outlines.size(); ++b) {
    if (!outlines[b].bounds) return {};
    if (config.bodies[b].shape != "element") continue;
    for (std::size_t k = 0; k < 3; ++k) {
      outlines[b].bounds->low[k] -= config.bodies[b].radius;
      outlines[b].bounds->high[k] += config.bodies[b].radius;
    }
  }
  std::vector<std::string> doubts;
  for (const dem::WallConfig& asked : config.walls) {
    const dem::Wall wall = dem::wall_of(asked, {});
    std::optional<Bounds> mesh;
    if (asked.shape == "stl") mesh = bounds_of(wall, corners_of_wall(asked, case_folder));
    const Outline* nearest = nullptr;
    double least = no_limit;
    for (std::size_t b = 0; b < outlines.size(); ++b) {
      const Outline& outline = outlines[b];
      const double height =
          mesh ? gap(*mesh, *outline.bounds).first : height_above(wall, *outline.bounds);
      const std::string doubt = mesh ? "" : behind(wall, asked, config.bodies[b], outline);
      if (!doubt.empty()) doubts.push_back(doubt);
      if (height >= least) continue;
      least = height;
      nearest = &outline;
    }
    const bool falls = dot(config.gravity, asked.normal) < 0.0;  // what is not there will come
    if (nearest != nullptr && least > 1e-9 && !falls)
      doubts.push_back(fmt::format(
          "wall.{}.point: no body touches the wall at the start; {} is nearest, {} away",
          asked.name, nearest->name, length_text(least)));
  }
  return doubts;
}

void check_regions(const dem::Config& config, const std::string* folder) {
  const std::vector<Outline> outlines = outlines_of(config, folder);
  std::vector<std::string> problems;
  for (const dem::SupportConfig& s : config.supports)
    problems.push_back(problem_of("support." + s.name, bounds_of(s), s.on, outlines));
  std::erase(problems, "");
  refuse(problems, "in the case");
}

void check_regions(const fdem::Config& config, const std::string* folder) {
  check_faces_and_corners(config, folder);
}
void check_regions(const fdem3::Config& config, const std::string* folder) {
  check_faces_and_corners(config, folder);
}

namespace {

template <class Config>
std::vector<std::string> empty_boxes(const Config& config, const std::vector<Outline>& outlines) {
  std::vector<std::string> doubts;
  for (const ProbeConfig& p : config.probes) {
    if (p.min.size() < 2 || p.max.size() != p.min.size()) continue;
    Bounds box{};
    for (std::size_t k = 0; k < p.min.size(); ++k) {
      box.low[k] = p.min[k];
      box.high[k] = p.max[k];
    }
    const bool of_body = item_named(config.bodies, p.on) != nullptr;
    const std::string doubt = problem_of("probe." + p.name, box, of_body ? p.on : "", outlines);
    if (!doubt.empty()) doubts.push_back(doubt + ", at the start");
  }
  return doubts;
}

}  // namespace

std::vector<std::string> doubtful_probes(const dem::Config& config, const std::string& folder) {
  return empty_boxes(config, outlines_of(config, &folder, true));
}
std::vector<std::string> doubtful_probes(const fdem::Config& config, const std::string& folder) {
  return empty_boxes(config, outlines_of(config, &folder));
}
std::vector<std::string> doubtful_probes(const fdem3::Config& config, const std::string& folder) {
  return empty_boxes(config, outlines_of(config, &folder));
}

}  // namespace breccia::prepare
