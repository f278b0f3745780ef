#include "run/machine/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "dem/setup/materials.hpp"
#include "io/round_numbers.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/build_fdem.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/ldpm/body.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/packing/body_packing.hpp"
#include "prepare/packing/fracture_energy.hpp"
#include "prepare/packing/rebar.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/carve.hpp"
#include "run/machine/forecast_parts.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace {

constexpr double most_elements = 700.0;   // of a specimen
constexpr double most_triangles = 500.0;  // likewise

// --- DEM

double ball(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

/// A body of elements that may be packed, with its numbers.
struct Packed {
  dem::BodyConfig body;
  double count, volume;    ///< elements, of the body  [m3]
  std::string folder{};    ///< of a body that is read, not cut
  bool particles = false;  ///< of LDPM: its mix says how many
  bool read = false;       ///< of a file: nothing is packed
};

bool is_ldpm(const dem::Config& config, const dem::BodyConfig& body) {
  const dem::MaterialConfig* const of = prepare::item_named(config.materials, body.material);
  return of != nullptr && of->law == "ldpm";
}
double surface(const dem::BodyConfig& b) {
  return b.shape == "box" ? 2.0 * (b.size.x * b.size.y + b.size.y * b.size.z + b.size.z * b.size.x)
                          : 2.0 * pi * b.radius * (b.radius + b.length);
}
/// Grains of a mix, and nodes on faces: discs thrown at random until none fits cover 0.547 of them.
Packed particles(const dem::Config& config, const dem::BodyConfig& body,
                 const std::string& folder) {
  if (body.shape == "file") {
    const auto mesh = prepare::read_ldpm_mesh(folder + "/" + body.file);
    return {body, static_cast<double>(mesh.position.size()), 0.0, folder, true, true};
  }
  const prepare::MixDesign mix =
      prepare::mix_of(*prepare::item_named(config.materials, body.material));
  const double volume = prepare::container_of(body).volume();
  const double sample = 3000.0 * mix.largest * mix.largest * mix.largest;
  const auto grains = static_cast<double>(prepare::grain_diameters(mix, sample, {1, 0}).size());
  const double nodes = 0.547 / (0.25 * pi) * surface(body) / (mix.smallest * mix.smallest);
  return {body, std::round(grains * volume / sample + nodes), volume, "", true};
}

Packed packed(const dem::Config& config, const dem::BodyConfig& body, const std::string& folder) {
  if (is_ldpm(config, body)) return particles(config, body, folder);
  if (body.shape != "file") {
    const double volume = body.shape == "box"      ? body.size.x * body.size.y * body.size.z
                          : body.shape == "sphere" ? ball(body.radius)
                                                   : pi * body.radius * body.radius * body.length;
    return {body, prepare::elements_in(body.pack, volume), volume};
  }
  const prepare::Spheres spheres = prepare::read_spheres(folder + "/" + body.file);
  const auto [least, most] = std::minmax_element(spheres.radius.begin(), spheres.radius.end());
  double solid = 0.0;
  for (const double r : spheres.radius) solid += ball(r);
  const auto count = static_cast<double>(spheres.radius.size());
  constexpr double most_read = 20000.0;  // a file of no more is its own specimen
  if (count <= most_read) return {body, count, solid / 0.6, folder, false, true};
  Packed p{body, count, solid / 0.6};
  p.read = true;
  p.body.shape = "box";
  p.body.file.clear();
  p.body.pack.count = static_cast<int>(spheres.radius.size());
  p.body.pack.size_ratio = std::clamp(*most / *least, 1.0, 10.0);
  p.body.size = std::cbrt(p.volume) * Vec3{1.0, 1.0, 1.0};
  return p;
}

/// A union or the inside of a surface is packed as the box around it: what is left of that.
Packed packed_around(const dem::Config& config, const dem::BodyConfig& body,
                     const std::string& folder) {
  const dem::BodyConfig whole = prepare::whole_of(body, folder);
  Packed p = packed(config, whole, folder);
  if (p.particles || body.pack.count < 1 || whole.pack.count <= body.pack.count) return p;
  const double left = static_cast<double>(body.pack.count) / whole.pack.count;
  p.count = body.pack.count;
  p.volume *= left;
  return p;
}

/// A part of the body with elements of the same sizes: as thick as the body where that is thin.
dem::BodyConfig cut(const Packed& p) {
  dem::BodyConfig body = p.body;
  body.center = {};
  body.velocity = body.spin = {};
  if (p.count <= most_elements || !p.folder.empty()) return body;
  Vec3 size = body.shape == "box" ? body.size : std::cbrt(p.volume) * Vec3{1.0, 1.0, 1.0};
  const double wanted = p.volume * most_elements / p.count;
  for (int turn = 0; turn < 200 && size.x * size.y * size.z > wanted; ++turn) {
    double& longest = size.x >= size.y && size.x >= size.z ? size.x
                      : size.y >= size.z                   ? size.y
                                                           : size.z;
    longest *= 0.97;
  }
  body.shape = "box";
  body.size = size;
  if (p.particles) return body;
  body.pack.compactness = prepare::compactness_of(body.pack);
  body.pack.porosity = 0.0;  // a small specimen may not reach it
  body.pack.periodic.clear();
  body.pack.cell = {};
  if (!body.pack.sieves.empty()) return body;  // their sizes say how many
  body.pack.count = static_cast<int>(std::round(p.count * size.x * size.y * size.z / p.volume));
  return body;
}

double least_radius(const dem::Model& model) {
  return *std::min_element(model.radius.begin(), model.radius.end());
}

constexpr double packing_of_one = 0.15e-3;  // element  [s]
constexpr double bytes_of_read = 2400.0;    // element of a file, which memory_plan does not open

constexpr double least_elements = 20.0;  // of a specimen that stands for a body

/// Materials and rules of a case, with these bodies alone.
dem::Config specimen_of(const dem::Config& config, std::vector<dem::BodyConfig> bodies) {
  dem::Config specimen = config;
  specimen.bodies = std::move(bodies);
  for (dem::MaterialConfig& m : specimen.materials)
    m.fracture_energy = 0.0;  // its step is the same
  specimen.walls.clear();
  specimen.supports.clear();
  specimen.probes.clear();
  specimen.checks.clear();
  return specimen;
}

/// Adds what single elements and bodies of few tell: they are their own specimen.
double add_few(Forecast& f, const dem::Config& config, const std::vector<dem::BodyConfig>& bodies,
               const std::string& folder) {
  if (bodies.empty()) return 0.0;
  dem::Config specimen = specimen_of(config, bodies);
  specimen.links.count = 0;
  const dem::Model model = build_model(specimen, folder);
  const auto count = static_cast<double>(model.size());
  const std::unique_ptr<Method> method = make_method(specimen, model, Exec{});
  take_step(f, method->time_step(),
            fmt::format("{} of {}{}: elements of radius {}",
                        model.links.empty() ? "contacts" : "links", bodies.front().name,
                        bodies.size() > 1 ? " and others" : "", length_text(least_radius(model))));
  take_size(f, least_radius(model), "radius");
  f.items += count;
  f.bonds += static_cast<double>(model.links.size());
  return pace_of(*method, count) * count;
}

/// Adds what a specimen of one packed body tells.
double add_body(Forecast& f, const dem::Config& config, const Packed& p) {
  f.items += p.count;
  dem::Config specimen = specimen_of(config, {cut(p)});
  if (config.links.count > 0) {
    double all = 0.0;
    for (const dem::BodyConfig& body : config.bodies)
      all += prepare::elements_in(body.pack, prepare::container_of(body).volume());
    specimen.links.count = 0;
    specimen.links.per_element = 2.0 * config.links.count / std::max(all, 1.0);
  }
  dem::Model model = build_model(specimen, p.folder);
  const auto count = static_cast<double>(model.size());
  const double bonds = static_cast<double>(model.links.size()) / count;
  if (bonds == 0.0)  // grains: as pressed together, since contacts alone rule
    for (Vec3& x : model.position) x = 0.97 * x;
  const std::unique_ptr<Method> method = make_method(specimen, model, Exec{});
  const double step = method->time_step();
  const double pace = pace_of(*method, count);
  take_size(f, least_radius(model), "radius");
  const std::string of = p.body.name + ": elements of radius " + length_text(least_radius(model));
  take_step(f, step, (bonds > 0.0 ? "links of " : "contacts of ") + of);
  f.bonds += bonds * p.count;
  if (!p.read && !p.particles) f.setup_s += packing_of_one * p.count;
  if (p.read && !p.particles) f.memory += bytes_of_read * p.count;
  const dem::MaterialConfig* const of_body = prepare::item_named(config.materials, p.body.material);
  if (of_body != nullptr && of_body->fracture_energy > 0.0)
    f.setup_s += prepare::fracture_energy_steps(p.count / p.volume) * pace;
  return pace * p.count;
}

/// Bars: a step shorter than sqrt(m / 2 K) of a piece of them, K = E A / L.
void add_bars(Forecast& f, const dem::Config& config, const dem::BodyConfig& body) {
  const dem::BodyConfig* const host = prepare::item_named(config.bodies, body.rebar.in);
  const dem::MaterialConfig* const steel = prepare::item_named(config.materials, body.material);
  if (host == nullptr || steel == nullptr) return;
  constexpr double bonded = 5.0;  // links of a bar's element with the concrete around it
  for (const prepare::Chain& chain : prepare::chains_through(body.rebar, host->size)) {
    const auto count = static_cast<double>(chain.centres.size());
    f.items += count;
    f.bonds += count * (1.0 + bonded) - 1.0;
    const double piece = *std::min_element(chain.spacing.begin(), chain.spacing.end());
    take_step(f, config.time.safety * piece * std::sqrt(0.5 * steel->density / steel->young),
              "bars of " + body.name + " (pieces of " + length_text(piece) + ")");
  }
}

// --- FDEM

/// A body of triangles: how many, and the edge of one.
struct Meshed {
  double triangles = 0.0, edge = 0.0, border = 0.0;  ///< -, [m], [m]
};

double area_of(const std::vector<Vec2>& polygon, double& border) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& next = polygon[(k + 1) % polygon.size()];
    twice += cross(polygon[k], next);
    border += norm(next - polygon[k]);
  }
  return 0.5 * std::abs(twice);
}

Meshed meshed(const fdem::BodyConfig& body, const std::string& folder) {
  constexpr double equilateral = 0.433;  // area over the square of the edge
  if (body.shape == "hexagons")
    return {6.0 * body.hexagons.count, body.hexagons.side,
            6.0 * body.hexagons.side * body.hexagons.count};
  if (body.shape == "mesh") {
    const prepare::Mesh mesh = prepare::read_mesh(folder + "/" + body.file, body.seams == "open");
    double area = 0.0;
    const std::vector<Index> own = prepare::triangles_of(body, mesh);
    for (const Index t : own)
      area += prepare::signed_area(mesh.point, mesh.triangle[static_cast<std::size_t>(t)]);
    const auto count = static_cast<double>(own.size());
    return {count, std::sqrt(area / (count * equilateral)), 4.0 * std::sqrt(area)};
  }
  double area = 0.0, border = 0.0;
  if (body.shape == "outline") {
    area = area_of(prepare::read_outline(folder + "/" + body.file), border);
  } else if (body.shape == "disc" || body.shape == "ring") {
    area = pi * (body.radius * body.radius - body.inner_radius * body.inner_radius);
    border = 2.0 * pi * (body.radius + body.inner_radius);
  } else {
    area = body.size.x * body.size.y;
    border = 2.0 * (body.size.x + body.size.y);
  }
  for (const fdem::HoleConfig& hole : body.holes) area -= pi * hole.radius * hole.radius;
  if (!(body.mesh_size > 0.0) || !(area > 0.0)) return {};
  // Two at least: also where triangles are asked for that are larger than their body.
  return {std::max(2.0, area / (equilateral * body.mesh_size * body.mesh_size)), body.mesh_size,
          border};
}

/// Height over width of all bodies together; 0: their meshes alone tell.
double aspect_of(const std::vector<fdem::BodyConfig>& bodies, const std::string& folder) {
  Vec2 least{1e300, 1e300}, most{-1e300, -1e300};
  const auto take = [&](const Vec2& x) {
    least = {std::min(least.x, x.x), std::min(least.y, x.y)};
    most = {std::max(most.x, x.x), std::max(most.y, x.y)};
  };
  for (const fdem::BodyConfig& body : bodies) {
    if (body.shape == "part") continue;
    if (body.shape == "mesh" || body.shape == "geo") return 0.0;
    const bool round = body.shape == "disc" || body.shape == "ring";
    const Vec2 half = round ? Vec2{body.radius, body.radius} : 0.5 * body.size;
    if (body.shape == "outline") {
      for (const Vec2& corner : prepare::read_outline(folder + "/" + body.file))
        take(body.center + corner);
    } else {
      take(body.center - half);
      take(body.center + half);
    }
  }
  return most.x > least.x ? (most.y - least.y) / (most.x - least.x) : 0.0;
}

/// A plate, or a few hexagons, with triangles of the body's size, above those that are there.
fdem::BodyConfig plate_of(const fdem::BodyConfig& body, const Meshed& mesh, double& top) {
  fdem::BodyConfig plate;
  plate.name = body.name;
  plate.material = body.material;
  plate.grains = body.grains;
  plate.weibull = body.weibull;
  if (body.grains.kind == "picture") plate.grains.kind = "random";
  const double share = std::min(1.0, most_triangles / mesh.triangles);
  if (body.shape == "hexagons") {
    plate.shape = "hexagons";
    plate.jitter = body.jitter;
    plate.hexagons = body.hexagons;
    plate.hexagons.count = std::max(1, static_cast<int>(share * body.hexagons.count));
    plate.size = std::sqrt(share) * body.size;
  } else {
    plate.shape = "plate";
    plate.structured = true;
    plate.pattern = body.pattern;
    plate.mesh_size = mesh.edge;
    const double side = std::sqrt(0.433 * share * mesh.triangles) * mesh.edge;
    plate.size = {std::max(side, 2.0 * mesh.edge), std::max(side, 2.0 * mesh.edge)};
  }
  plate.center = {0.0, top + 0.5 * plate.size.y};
  top += plate.size.y + 1e-3 * mesh.edge;
  return plate;
}

}  // namespace

Forecast forecast(const dem::Config& config, const std::string& folder, const ModelStep& model) {
  Forecast f;
  double pace = 0.0;  // of all items, each step  [s]
  double facets = 0.0;
  std::vector<dem::BodyConfig> few;
  for (const dem::BodyConfig& body : config.bodies) {
    const double bonds = f.bonds;
    if (body.shape == "rebar") {
      add_bars(f, config, body);
    } else if (body.shape == "element") {
      few.push_back(body);
    } else {
      const Packed p = packed_around(config, body, folder);
      if (p.count < least_elements)
        few.push_back(body);
      else
        pace += add_body(f, config, p);
    }
    if (is_ldpm(config, body)) facets += f.bonds - bonds;
  }
  pace += add_few(f, config, few, folder);
  finish(f, config.time, end_of(config.stages, config.time.end), model);
  f.here_s = wall_of(f.steps, f.items, pace / std::max(f.items, 1.0));
  if (facets == 0.0) f.gpu_s = f.steps * (14e-6 + 0.93e-9 * f.items);
  f.may_end_early = may_end_early(config.stages);
  const double pixels = pixels_of(config.output);
  f.memory += own_memory + memory_plan(config).run_bytes + bytes_of_facet * facets;
  if (draws(config.output)) f.memory += pixel_of_spheres * pixels;
  add_output(f, config, pixels, {45e-9, 0.3e-6, 45e-9});
  add_disk(f, config, pixels, 14 + config.probes.size(), {42.0, 9.1, 830.0, 178.0, 0.65}, facets);
  return f;
}

Forecast forecast(const fdem::Config& config, const std::string& folder, const ModelStep& known) {
  Forecast f;
  f.item_name = "triangles";
  f.bond_name = "joints";
  fdem::Config specimen = without_bodies(config);
  double top = 0.0, finest = 0.0;
  bool free_mesh = false, by_gmsh = false;
  constexpr double begun_mesh = 0.3, meshing_of_one = 60e-6;  // measured  [s]
  std::string of;
  for (const fdem::BodyConfig& body : config.bodies) {
    if (body.shape == "part") continue;  // counted with the body that it is of
    const Meshed mesh = meshed(body, folder);
    if (mesh.triangles < 1.0) {  // gmsh alone knows
      f.items = 0.0;
      return f;
    }
    specimen.bodies.push_back(plate_of(body, mesh, top));
    f.items += mesh.triangles;
    const fdem::MaterialConfig* const m = prepare::item_named(config.materials, body.material);
    if (m == nullptr || m->joints == "intrinsic")
      f.bonds += 1.5 * mesh.triangles - 0.5 * mesh.border / mesh.edge;
    const bool free = body.shape != "hexagons" && !body.structured;
    free_mesh = free_mesh || free;
    by_gmsh = by_gmsh || (free && body.shape != "mesh");
    if (finest == 0.0 || mesh.edge < finest) {
      finest = mesh.edge;
      of = body.name + ", edges of " + length_text(mesh.edge);
    }
  }
  const fdem::Model model = build_model(specimen, folder);
  const std::unique_ptr<Method> method = make_method(specimen, model, Exec{});
  // The smallest triangle and sharpest corner of a free mesh rule its step.
  constexpr double least_of_free_mesh = 0.75;
  const std::string rule = method->step_rule();
  take_size(f, finest, "edge");
  take_step(f, (free_mesh ? least_of_free_mesh : 1.0) * method->time_step(),
            (rule.empty() ? "triangles" : rule) + " (finest mesh: " + of + ")");
  f.cut_by_lines = free_mesh && (!config.joint_sets.empty() || config.discontinuities.size() > 1);
  finish(f, config.time, end_of(config.stages, config.time.end), known);
  // Bodies that press on each other cost contacts, which specimens lack.
  const double contacts = config.bodies.size() > 1 ? 1.5 : 1.0;
  f.here_s =
      contacts * wall_of(f.steps, f.items, pace_of(*method, static_cast<double>(model.size())));
  f.gpu_s = f.steps * std::max(16e-6, 4.7e-6 + 0.22e-9 * f.items);
  f.joined = can_crack(config.materials);
  constexpr double of_triangle = 1700.0;  // as in memory_plan, which counts no outlines  [bytes]
  f.may_end_early = may_end_early(config.stages);
  const double pixels = pixels_of(config.output, aspect_of(config.bodies, folder));
  f.memory = own_memory + of_triangle * f.items;
  if (draws(config.output)) f.memory += pixel_of_faces * pixels;
  if (by_gmsh) f.setup_s = begun_mesh + meshing_of_one * f.items;
  add_output(f, config, pixels, {100e-9, 0.6e-6, 100e-9});
  add_disk(f, config, pixels, 14 + config.probes.size(), {45.0, 35.0, 300.0, 740.0, 0.12}, f.bonds);
  return f;
}

std::string rough_duration(double seconds) {
  if (seconds < 1.0) return "under 1 s";
  if (seconds < 100.0) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.2g} min", seconds / 60.0);
  if (seconds < 172800.0) return fmt::format("{:.2g} h", seconds / 3600.0);
  return fmt::format("{:.0f} days", seconds / 86400.0);
}

}  // namespace breccia
