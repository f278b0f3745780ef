#include "prepare/checks/outlines.hpp"

#include <algorithm>
#include <filesystem>

#include "exec/error.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/carve.hpp"
#include "prepare/shapes/wall_files.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

Bounds around(const std::array<double, 3>& center, const std::array<double, 3>& half) {
  Bounds b;
  for (std::size_t k = 0; k < 3; ++k) {
    b.low[k] = center[k] - half[k];
    b.high[k] = center[k] + half[k];
  }
  return b;
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

Outline outline_of(const dem::BodyConfig& body, const dem::Config& config,
                   const std::string* folder, bool radii) {
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
                const Vec3 low = surface.low(), high = surface.high();
                const Frame3 frame = frame_of(b);
                for (int k = 0; k < 8; ++k) {
                  const Vec3 corner{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                                    (k & 4) != 0 ? high.z : low.z};
                  add_to(all, moved(frame.out(corner), b.center));
                }
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
  if (b.is_turned()) {
    const Vec3 around_it = half_around(frame_of(b), {half[0], half[1], half[2]});
    half = {around_it.x, around_it.y, around_it.z};
  }
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

}  // namespace

Bounds region_bounds(const fdem::RegionConfig& r) {
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
Bounds region_bounds(const dem::SupportConfig& s) {
  return bounds_in_space(s);
}
Bounds region_bounds(const fdem3::RegionConfig& r) {
  return bounds_in_space(r);
}

std::vector<Outline> outlines_of(const dem::Config& config, const std::string* folder, bool radii) {
  std::vector<Outline> all;
  for (const auto& body : config.bodies) all.push_back(outline_of(body, config, folder, radii));
  return all;
}
std::vector<Outline> outlines_of(const fdem::Config& config, const std::string* folder) {
  std::vector<Outline> all;
  for (const auto& body : config.bodies) all.push_back(outline_of(body, folder));
  return all;
}
std::vector<Outline> outlines_of(const fdem3::Config& config, const std::string* folder) {
  std::vector<Outline> all;
  for (const auto& body : config.bodies) all.push_back(outline_of(body, folder));
  return all;
}

}  // namespace breccia::prepare
