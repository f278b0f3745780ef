#include "prepare/meshing/body_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/region.hpp"
#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/csv_numbers.hpp"
#include "prepare/meshing/clean_lines.hpp"
#include "prepare/meshing/holes.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/meshing/meshing.hpp"
#include "prepare/meshing/structured.hpp"

namespace breccia::prepare {
namespace {

using fdem::BodyConfig;
using Line = std::array<Vec2, 2>;

/// Streams of random numbers of a body begin here; packings of the DEM use those below.
constexpr std::uint32_t jitter_stream = 0x10000;

/// Which side of a line a point is on.
double side(const Vec2& a, const Vec2& b, const Vec2& p) {
  return cross(b - a, p - a);
}
bool cross_each_other(const Line& s, const Line& t) {
  return side(s[0], s[1], t[0]) * side(s[0], s[1], t[1]) < 0.0 &&
         side(t[0], t[1], s[0]) * side(t[0], t[1], s[1]) < 0.0;
}

/// The corners of a slot, and how far it reaches.
std::vector<Line> lines_of(const BodyConfig& body, const MeshingContext& context) {
  std::vector<Line> lines = context.lines;
  for (const fdem::NotchConfig& notch : body.notches)
    if (notch.width == 0.0) lines.push_back({notch.from, notch.to});
  return lines;
}

/// The straight sides of a region's outline and slots.
std::vector<Line> straight_rim(const Region& region) {
  std::vector<Line> rim;
  const auto add = [&rim](const auto& corners) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      rim.push_back({corners[k], corners[(k + 1) % corners.size()]});
  };
  const Vec2 half = 0.5 * region.size, other{half.x, -half.y}, middle = region.center;
  if (region.shape == Region::Shape::rectangle)
    add(std::array{middle - half, middle + other, middle + half, middle - other});
  if (region.shape == Region::Shape::polygon) add(region.polygon);
  for (const auto& slot : region.slots) add(slot);
  return rim;
}

/// The region that gmsh meshes, with its lines as they are given.
Region region_of(const BodyConfig& body, const MeshingContext& context) {
  Region region{.center = body.center, .size = body.size, .edge = body.mesh_size};
  if (body.shape == "disc" || body.shape == "ring") {
    region.shape = Region::Shape::disc;
    region.disc = {body.center, body.radius};
  }
  if (body.shape == "ring") region.holes.push_back({body.center, body.inner_radius});
  if (body.shape == "outline") {
    region.shape = Region::Shape::polygon;
    region.polygon = read_outline((std::filesystem::path(context.folder) / body.file).string());
    for (Vec2& corner : region.polygon) corner += body.center;
    if (const auto problems = missing_cuts(body, region.polygon); !problems.empty())
      throw InputError(problems.front());
  }
  for (const fdem::HoleConfig& hole : body.holes) {
    if (hole.corners.empty()) {
      region.holes.push_back({hole.center, hole.radius});
      continue;
    }
    region.slots.push_back(hole.corners);
    for (Vec2& corner : region.slots.back()) corner += hole.center;
  }
  for (const fdem::NotchConfig& notch : body.notches)
    if (notch.width > 0.0) region.slots.push_back(slot_corners(notch));
  region.lines = lines_of(body, context);
  return region;
}

Mesh meshed_by_gmsh(const BodyConfig& body, const MeshingContext& context) {
  Region region = region_of(body, context);
  if (body.merge > 0.0)
    region.lines = cleaned(region.lines, straight_rim(region), body.merge * body.mesh_size);
  return mesh_region(region, context.seed);
}

Mesh regular(const BodyConfig& body) {
  if (body.shape == "disc") return ringed_disc(body.center, body.radius, body.mesh_size);
  const Rectangle rectangle{body.center, body.size};
  return body.pattern == "crossed" ? crossed_rectangle(rectangle, body.mesh_size)
                                   : equilateral_rectangle(rectangle, body.mesh_size);
}

Mesh hexagon_field(const BodyConfig& body, const Random& random) {
  return hexagons({.center = body.center,
                   .size = body.size,
                   .count = body.hexagons.count,
                   .side = body.hexagons.side,
                   .gap = body.hexagons.gap,
                   .jitter = body.jitter,
                   .random = random});
}

}  // namespace

bool in_part(const BodyConfig& part, const Vec2& x) {
  if (!part.corners.empty()) return in_polygon(part.corners, x - part.center);
  if (part.radius > 0.0) return in_circle(part.center, part.radius, x);
  const Vec2 away = x - part.center;
  return std::abs(away.x) <= 0.5 * part.size.x && std::abs(away.y) <= 0.5 * part.size.y;
}

void add_outline(const BodyConfig& part, double edge, std::vector<Line>& lines) {
  std::vector<Vec2> corners = part.corners;
  const Vec2 half = 0.5 * part.size;
  if (corners.empty() && part.radius > 0.0) {
    const double pieces = 2.0 * pi * part.radius / std::max(edge, 0.02 * part.radius);
    const int count = std::max(12, static_cast<int>(std::lround(pieces)));
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * pi * k / count;
      corners.push_back(part.radius * Vec2{std::cos(angle), std::sin(angle)});
    }
  } else if (corners.empty()) {
    corners = {-half, {half.x, -half.y}, half, {-half.x, half.y}};
  }
  for (std::size_t k = 0; k < corners.size(); ++k)
    lines.push_back({part.center + corners[k], part.center + corners[(k + 1) % corners.size()]});
}

double distance(const Vec2& point, const Line& line) {
  const Vec2 along = line[1] - line[0];
  const double share = std::clamp(dot(point - line[0], along) / dot(along, along), 0.0, 1.0);
  return norm(point - (line[0] + share * along));
}

std::string merged_lines(const BodyConfig& body, const MeshingContext& context) {
  if (!(body.merge > 0.0) || !needs_gmsh(body)) return "";
  const double tolerance = body.merge * body.mesh_size;
  const Region region = region_of(body, context);
  const std::vector<Line> made = cleaned(region.lines, straight_rim(region), tolerance);
  const auto is_gone = [&](const Vec2& place) {
    return std::none_of(made.begin(), made.end(),
                        [&](const Line& line) { return distance(place, line) < tolerance; });
  };
  std::size_t moved = 0, short_lines = 0;
  double farthest = 0.0, left_out = 0.0;
  for (const Line& line : region.lines) {
    const double length = norm(line[1] - line[0]);
    if (length < tolerance && is_gone(0.5 * (line[0] + line[1]))) {
      ++short_lines;  // both its ends became one point
      left_out += length;
      continue;
    }
    for (const Vec2& end : line) {
      double nearest = 1e300;
      for (const Line& other : made)
        nearest = std::min({nearest, norm(end - other[0]), norm(end - other[1])});
      if (!(nearest > 1e-6 * tolerance)) continue;
      ++moved;
      farthest = std::max(farthest, nearest);
    }
  }
  if (moved == 0 && short_lines == 0) return "";
  return fmt::format(
      "merge moves {} of {} ends of the {} lines that its mesh follows, by {:.3g} m at most, since "
      "they lie nearer than {:.3g} m to others or to its outline{}; {} parts are left",
      moved, 2 * region.lines.size(), region.lines.size(), farthest, tolerance,
      short_lines == 0
          ? ""
          : fmt::format(", and leaves out {} line{} shorter than that, {:.3g} m in all",
                        short_lines, short_lines == 1 ? "" : "s", left_out),
      made.size());
}

bool needs_gmsh(const BodyConfig& body) {
  if (body.shape == "hexagons" || body.shape == "mesh" || body.shape == "part") return false;
  return body.shape == "geo" || !body.structured;
}

Mesh mesh_of(const BodyConfig& body, const MeshingContext& context) {
  const Random random{static_cast<std::uint64_t>(context.seed), jitter_stream + context.number};
  if (body.shape == "hexagons") return hexagon_field(body, random);
  Mesh mesh;
  if (body.shape == "geo" || body.shape == "mesh") {
    const std::string path = (std::filesystem::path(context.folder) / body.file).string();
    mesh = body.shape == "mesh" ? read_mesh(path, body.seams == "open")
                                : mesh_geo_file(path, body.mesh_size, context.seed);
    for (Vec2& p : mesh.point) p += body.center;
  } else {
    mesh = body.structured ? regular(body) : meshed_by_gmsh(body, context);
  }
  if (body.jitter > 0.0) {
    const std::vector<Line> lines = lines_of(body, context);
    std::vector<bool> fixed(mesh.point.size());
    for (std::size_t i = 0; i < fixed.size(); ++i)
      for (const Line& line : lines)
        if (distance(mesh.point[i], line) < 1e-6 * body.mesh_size) fixed[i] = true;
    jitter(mesh, body.jitter, random, fixed);
  }
  return mesh;
}

std::vector<Index> triangles_of(const BodyConfig& body, const Mesh& mesh) {
  std::vector<Index> triangles;
  if (body.parts.empty())
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
      triangles.push_back(static_cast<Index>(t));
  for (const std::string& name : body.parts) {
    const auto found = std::find_if(mesh.parts.begin(), mesh.parts.end(),
                                    [&](const Part& part) { return part.name == name; });
    if (found != mesh.parts.end()) {
      triangles.insert(triangles.end(), found->triangles.begin(), found->triangles.end());
      continue;
    }
    std::string there;
    for (const Part& part : mesh.parts) there += (there.empty() ? "" : ", ") + part.name;
    throw InputError(fmt::format("parts: {} has no part \"{}\"; it has: {}", body.file, name,
                                 there.empty() ? "none" : there));
  }
  return triangles;
}

std::vector<Vec2> read_outline(const std::string& path) {
  std::vector<Vec2> corners;
  read_csv(path, 2, "x,y in metres", [&](const std::vector<double>& v) {
    corners.push_back({v[0], v[1]});
    return true;
  });
  if (corners.size() > 1 && norm(corners.front() - corners.back()) == 0.0) corners.pop_back();
  if (corners.size() < 3)
    throw InputError(
        fmt::format("{}: an outline needs at least 3 corners; it has {}", path, corners.size()));
  if (corners.size() > 10000)
    throw InputError(fmt::format("{}: an outline can have at most 10000 corners; it has {}", path,
                                 corners.size()));
  double area = 0.0, longest = 0.0;
  const auto line = [&](std::size_t k) {
    return Line{corners[k], corners[(k + 1) % corners.size()]};
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Line s = line(k);
    area += 0.5 * cross(s[0] - corners[0], s[1] - corners[0]);
    longest = std::max(longest, norm(s[1] - s[0]));
    if (norm(s[1] - s[0]) == 0.0)
      throw InputError(fmt::format("{}: corner {} at ({:.6g}, {:.6g}) m is there twice in a row",
                                   path, k + 1, s[0].x, s[0].y));
  }
  for (std::size_t j = 0; j < corners.size(); ++j)
    for (std::size_t k = j + 1; k < corners.size(); ++k)
      if (cross_each_other(line(j), line(k)))
        throw InputError(fmt::format("{}: the outline crosses itself between corners {} and {}",
                                     path, j + 1, k + 1));
  if (!(std::abs(area) > 1e-9 * longest * longest))
    throw InputError(fmt::format("{}: the outline encloses no area", path));
  if (area < 0.0) std::ranges::reverse(corners);  // listed clockwise
  return corners;
}

}  // namespace breccia::prepare
