#include "prepare/checks/check_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/gauge.hpp"
#include "dem/setup/walls.hpp"
#include "dem/wall_mesh.hpp"
#include "exec/error.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "io/round_numbers.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/cracks_beside.hpp"
#include "prepare/checks/nearest_body.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/shapes/solid.hpp"
#include "prepare/shapes/wall_files.hpp"

namespace breccia::prepare {
namespace {

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
    add_to(b, {x.x, x.y, x.z});
  }
  return b;
}

/// Whether a body is a box, a ball or an upright cylinder, as its outline tells it.
bool is_plain(const dem::BodyConfig& body) {
  return body.shape == "box" || body.shape == "sphere" || body.shape == "cylinder";
}
/// Whether a place within the box around such a body lies in it.
bool lies_in(const dem::BodyConfig& body, const Vec3& x) {
  Vec3 out = x - body.center;
  if (body.shape == "cylinder") out.z = 0.0;
  return body.shape == "box" || norm(out) <= body.radius * (1.0 + 1e-9);
}

/// Whether the middle of a wall that is no plane lies in a body.
bool begins_in(const dem::Wall& wall, const dem::BodyConfig& body, const Bounds& b) {
  if (wall.shape == dem::WallShape::plane || wall.shape == dem::WallShape::mesh || !is_plain(body))
    return false;
  const double depth = wall.shape == dem::WallShape::sphere ? 0.0 : 0.5 * wall.length;
  const Vec3 x = wall.point - depth * wall.normal, near = nearest_in(b, x);
  return norm(x - near) == 0.0 && lies_in(body, x);
}

/// How far a body reaches behind a wall's face; 0 where it does not, and of bodies whose outline is
/// no box, ball or upright cylinder.  [m]
double depth_behind(const dem::Wall& wall, const dem::BodyConfig& body, const Bounds& b) {
  if (!is_plain(body)) return 0.0;
  constexpr int steps = 16;  // along each side; its ends are looked at, too
  double depth = 0.0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      for (int k = 0; k <= steps; ++k) {
        const auto at = [&](std::size_t axis, int n) {
          return b.low[axis] + (b.high[axis] - b.low[axis]) * n / steps;
        };
        const Vec3 x{at(0, i), at(1, j), at(2, k)};
        if (lies_in(body, x)) depth = std::max(depth, -dem::touch(wall, x).height);
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
template <class Vector>
std::string problem_of_point(const std::string& key, const Vector& point,
                             const std::vector<Outline>& outlines) {
  const Vec3 x = fdem_shared::to_space(point);
  const Bounds here{{x.x, x.y, x.z}, {x.x, x.y, x.z}};
  const Outline* nearest = nullptr;
  double least = no_limit;
  for (const Outline& outline : outlines) {
    if (outline.in_another) continue;
    if (!outline.bounds) return "";
    const double apart = gap(here, *outline.bounds).first;
    if (apart <= 1e-9) return "";
    if (apart < least) least = apart, nearest = &outline;
  }
  if (nearest == nullptr) return "";
  const std::string z = std::is_same_v<Vector, Vec2> ? "" : ", " + place(x.z);
  return fmt::format("{}: ({}, {}{}) lies in no body; {} is nearest, {} away", key, place(x.x),
                     place(x.y), z, nearest->name, length_text(least));
}

/// Cuts that lie beside the body that they are of.
void add_idle_cuts(const dem::BodyConfig& body, std::vector<std::string>& problems) {
  if (body.cuts.empty() || body.shape == "stl" || !(norm(body.axis) > 0.0)) return;
  const Union whole(body);
  const std::vector<Outline> outline{
      {body.name, Bounds{{whole.low().x, whole.low().y, whole.low().z},
                         {whole.high().x, whole.high().y, whole.high().z}}}};
  for (std::size_t k = 0; k < body.cuts.size(); ++k) {
    const dem::CutConfig& cut = body.cuts[k];
    if (cut.shape == "stl" || !(norm(cut.axis) > 0.0)) continue;
    const Vec3 half = solid_of(cut).half(), low = cut.center - half, high = cut.center + half;
    const Nearest nearest =
        nearest_to({{low.x, low.y, low.z}, {high.x, high.y, high.z}}, "", outline);
    if (nearest.body != nullptr)
      problems.push_back(fmt::format("body.{}.cut[{}].center: it takes nothing out of {}, {} away",
                                     body.name, k, body.name, length_text(nearest.away)));
  }
}

/// The problem of a load whose region meets no body that its stage takes out; empty: there is none.
template <class Config, class Load>
std::string problem_of_dug(const Config& config, const Load& load,
                           const std::vector<Outline>& outlines) {
  const auto* const stage = load.dug_by.empty() ? nullptr : item_named(config.stages, load.dug_by);
  if (stage == nullptr) return "";
  std::vector<Outline> taken;
  for (Outline outline : outlines) {
    if (std::count(stage->remove.begin(), stage->remove.end(), outline.name) == 0) continue;
    outline.in_another = false;
    taken.push_back(outline);
  }
  return problem_of("load." + load.name, region_bounds(load.region), "", taken);
}

/// Supports, loads, bolts and sets of joints of meshes.
template <class Config>
void check_faces_and_corners(const Config& config, const std::string* folder) {
  const std::vector<Outline> outlines = outlines_of(config, folder);
  std::vector<std::string> problems;
  for (const auto& s : config.supports)
    problems.push_back(
        problem_of("support." + s.name, region_bounds(s.region), s.region.on, outlines));
  for (const auto& load : config.loads) {
    problems.push_back(
        problem_of("load." + load.name, region_bounds(load.region), load.region.on, outlines));
    if (problems.back().empty()) problems.back() = problem_of_dug(config, load, outlines);
  }
  for (const auto& bolt : config.bolts)
    for (const auto& point : fdem_shared::corners_of(bolt)) {
      problems.push_back(problem_of_point("bolt." + bolt.name + ".points", point, outlines));
      if (bolt.is_ring() && !problems.back().empty()) break;
    }
  for (const auto& d : config.discontinuities)
    problems.push_back(problem_of_discontinuity(d, outlines));
  for (const auto& set : config.joint_sets)
    problems.push_back(problem_of_set(set, folder, outlines));
  std::erase(problems, "");
  refuse(problems, "in the case");
}

/// The warning that a wall will throw out a body, or a part of it; empty: it will not.
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
  if (!(depth > slight * side)) {
    if (!begins_in(wall, body, b)) return "";
    return fmt::format(
        "wall.{}.point: it begins inside of {}; what lies there will be thrown out, unless a cut "
        "([[body.cut]]) makes room for it",
        asked.name, outline.name);
  }
  return fmt::format(
      "wall.{}.point: {} reaches {} behind the wall's face at the start; what lies there will be "
      "thrown out",
      asked.name, outline.name, length_text(depth));
}

/// That a wall led at one velocity does not get as far as a body that rests; empty if it may.
std::string short_of(const dem::WallConfig& wall, const dem::Config& config, double gap) {
  const bool led = wall.shape == "plane" && !wall.velocity.is_table() && !wall.servo.is_on() &&
                   !wall.has_mass() && norm(wall.velocity.value) > 0.0;
  const bool rests =
      std::all_of(config.bodies.begin(), config.bodies.end(),
                  [](const dem::BodyConfig& body) { return norm(body.velocity) == 0.0; });
  if (!led || !rests || !config.stages.empty()) return "";
  const double way = dot(wall.velocity.value, wall.normal) / norm(wall.normal) * config.time.end;
  if (way >= gap) return "";
  return way > 0.0 ? fmt::format(", and it goes {} until time.end", length_text(way))
                   : ", and it does not come nearer";
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
      if (height >= least || config.bodies[b].shape == "rebar")
        continue;  // bars lie in another body
      least = height;
      nearest = &outline;
    }
    const bool falls =
        dot(config.gravity.at(0.0), asked.normal) < 0.0;  // what is not there will come
    if (nearest != nullptr && least > 1e-9 && !falls)
      doubts.push_back(fmt::format(
          "wall.{}.point: no body touches the wall at the start; {} is nearest, {} away{}",
          asked.name, nearest->name, length_text(least), short_of(asked, config, least)));
  }
  return doubts;
}

void check_regions(const dem::Config& config, const std::string* folder) {
  const std::vector<Outline> outlines = outlines_of(config, folder);
  std::vector<std::string> problems;
  for (const dem::SupportConfig& s : config.supports)
    problems.push_back(problem_of("support." + s.name, region_bounds(s), s.on, outlines));
  for (const dem::BodyConfig& body : config.bodies) add_idle_cuts(body, problems);
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
    if (p.min.empty() && p.max.empty()) continue;
    const ReadBox read(p.min, p.max);
    Bounds box{};
    box.low = {read.min.x, read.min.y, read.min.z};
    box.high = {read.max.x, read.max.y, read.max.z};
    const bool of_body = item_named(config.bodies, p.on) != nullptr;
    const std::string doubt = problem_of("probe." + p.name, box, of_body ? p.on : "", outlines);
    if (!doubt.empty()) doubts.push_back(doubt + ", at the start");
  }
  return doubts;
}

/// Boxes that are empty, and openings of a case without joints.
template <class Config>
std::vector<std::string> doubtful_probes_of_mesh(const Config& config, const std::string& folder) {
  std::vector<std::string> doubts = empty_boxes(config, outlines_of(config, &folder));
  const bool joined = !config.joint_laws.empty() ||
                      std::any_of(config.materials.begin(), config.materials.end(),
                                  [](const fdem::MaterialConfig& m) { return m.joints != "none"; });
  for (const ProbeConfig& p : config.probes)
    if (!joined && (p.quantity == "opening" || p.quantity == "slip"))
      doubts.push_back(fmt::format(
          "probe.{}.quantity = \"{}\" is of joints, and nothing in this case has any: it reads 0. "
          "How far an open discontinuity gapes is the difference of displacement of two boxes, one "
          "on each side",
          p.name, p.quantity));
  return doubts;
}

/// Whether a region holds a piece as long as an edge of the mesh, each way, on a side of a body;
/// true of one that reaches none of its outermost sides.
bool holds_an_edge(const Bounds& region, const Bounds& body, double edge, std::size_t dimension) {
  bool on_a_side = false;
  for (std::size_t k = 0; k < dimension; ++k) {
    if (region.low[k] > body.low[k] && region.high[k] < body.high[k]) continue;
    on_a_side = true;
    bool wide = true;
    for (std::size_t j = 0; j < dimension; ++j)
      wide = wide && (j == k || std::min(region.high[j], body.high[j]) -
                                        std::max(region.low[j], body.low[j]) >=
                                    0.99 * std::min(edge, body.high[j] - body.low[j]));
    if (wide) return true;
  }
  return !on_a_side;
}

/// A load takes the sides of elements that lie in its region whole: edges of triangles, faces of
/// tetrahedra. Of a region narrower than these are long it may take none.
template <class Config>
std::vector<std::string> narrow_regions(const Config& config, const std::string& folder,
                                        std::size_t dimension, const char* sides) {
  const std::vector<Outline> outlines = outlines_of(config, &folder);
  std::vector<std::string> doubts;
  for (const auto& load : config.loads) {
    if (!load.dug_by.empty()) continue;
    const Bounds region = region_bounds(load.region);
    std::string narrow;
    bool wide = false;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      const Outline& outline = outlines[i];
      if (!load.region.on.empty() && outline.name != load.region.on) continue;
      const double edge = config.bodies[i].mesh_size;
      wide = wide || !outline.bounds || !(edge > 0.0);
      if constexpr (requires { config.bodies[i].is_turned(); })
        wide = wide || config.bodies[i].is_turned();  // its sides lie aslant
      if (wide || gap(region, *outline.bounds).first > 1e-9) continue;
      wide = holds_an_edge(region, *outline.bounds, edge, dimension);
      narrow = fmt::format(
          "load.{}: the region is narrower on {} than {} are long there, {}; it takes those that "
          "lie in it whole, perhaps none",
          load.name, outline.name, sides, length_text(edge));
    }
    if (!wide && !narrow.empty()) doubts.push_back(narrow);
  }
  return doubts;
}

}  // namespace

std::vector<std::string> doubtful_probes(const dem::Config& config, const std::string& folder) {
  return empty_boxes(config, outlines_of(config, &folder, true));
}
std::vector<std::string> doubtful_probes(const fdem::Config& config, const std::string& folder) {
  return doubtful_probes_of_mesh(config, folder);
}
std::vector<std::string> doubtful_probes(const fdem3::Config& config, const std::string& folder) {
  return doubtful_probes_of_mesh(config, folder);
}

std::vector<std::string> doubtful_loads(const fdem::Config& config, const std::string& folder) {
  return narrow_regions(config, folder, 2, "edges");
}
std::vector<std::string> doubtful_loads(const fdem3::Config& config, const std::string& folder) {
  return narrow_regions(config, folder, 3, "faces");
}

std::vector<std::string> merged_lines(const fdem::Config& config, const std::string& case_folder) {
  MeshingContext context{.seed = config.seed, .number = 0, .folder = case_folder, .lines = {}};
  const auto add = [&](const std::vector<fdem::DiscontinuityConfig>& all) {
    for (const fdem::DiscontinuityConfig& d : all)
      for (std::size_t k = 1; d.embedded && k < d.points.size(); ++k)
        context.lines.push_back({d.points[k - 1], d.points[k]});
  };
  add(config.discontinuities);
  for (std::size_t k = 0; k < config.joint_sets.size(); ++k)
    add(lines_of_set(config.joint_sets[k], config.seed, k, case_folder));
  for (const fdem::BodyConfig& part : config.bodies)
    if (part.shape == "part") {
      const fdem::BodyConfig* const host = item_named(config.bodies, part.of);
      add_outline(part, host != nullptr ? host->mesh_size : 0.0, context.lines);
    }
  std::vector<std::string> notes;
  for (const fdem::BodyConfig& body : config.bodies)
    if (const std::string note = merged_lines(body, context); !note.empty())
      notes.push_back("body." + body.name + ".merge: " + note.substr(6));
  return notes;
}

}  // namespace breccia::prepare
