#include <algorithm>
#include <cmath>
#include <memory>

#include "io/round_numbers.hpp"
#include "prepare/build_fdem3.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_file.hpp"
#include "run/machine/forecast_parts.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/method/fdem3_method.hpp"

namespace breccia {
namespace {

/// A body with the edges of its tetrahedra, and how many they are: of a file by what it holds.
struct Meshed {
  fdem3::BodyConfig body;
  double count = 0.0;
};
Meshed meshed(fdem3::BodyConfig body, const std::string& folder) {
  if (body.shape == "stl") {
    const double volume = prepare::read_surface(folder + "/" + body.file, 1.0).volume();
    body.shape = "box";  // as large
    body.size = std::cbrt(volume) * Vec3{1.0, 1.0, 1.0};
  }
  if (body.shape != "mesh") {
    const double count = tetrahedra_of(body);  // below one where they would be larger than it
    return {body, count > 0.0 ? std::max(6.0, count) : 0.0};
  }
  const prepare::TetMesh mesh = prepare::read_tet_mesh(folder + "/" + body.file);
  const std::vector<Index> own = prepare::tetrahedra_of(body, mesh);
  double volume = 0.0;
  for (const Index t : own)
    volume += prepare::signed_volume(mesh.point, mesh.tetrahedron[static_cast<std::size_t>(t)]);
  const auto count = static_cast<double>(own.size());
  if (own.empty()) return {body, 0.0};
  body.mesh_size = std::cbrt(6.0 * volume / count);  // six regular ones fill a cube
  return {body, count};
}

/// A box of regular tetrahedra of the body's size, above those that are there.
fdem3::BodyConfig box_of(const fdem3::BodyConfig& body, double& top) {
  constexpr double cubes = 4.0;  // along each side
  fdem3::BodyConfig box;
  box.name = body.name;
  box.material = body.material;
  box.grains = body.grains;
  box.weibull = body.weibull;
  box.structured = true;
  box.mesh_size = body.mesh_size;
  const double side = cubes * body.mesh_size;
  box.size = {side, side, side};
  box.center = {0.0, 0.0, top + 0.5 * side};
  top += side * (1.0 + 1e-3);
  return box;
}

/// Half the height and the damping of tetrahedra twice as high: the flattest of a free mesh, which
/// rule its step.
constexpr double least_of_free_mesh = 0.5;
double step_of_flattest(fdem3::Config specimen, const std::string& folder) {
  for (fdem3::BodyConfig& body : specimen.bodies) {
    body.mesh_size *= least_of_free_mesh;
    body.size = least_of_free_mesh * body.size;
    body.center = least_of_free_mesh * body.center;
  }
  for (fdem::MaterialConfig& material : specimen.materials) material.damping /= least_of_free_mesh;
  const fdem3::Model model = build_model(specimen, folder);
  return make_method(specimen, model, Exec{})->time_step();
}

}  // namespace

Forecast forecast(const fdem3::Config& config, const std::string& folder, const ModelStep& known) {
  Forecast f;
  f.item_name = "tetrahedra";
  f.bond_name = "joints";
  fdem3::Config specimen = without_bodies(config);
  specimen.stages.clear();
  double top = 0.0, finest = 0.0;
  bool free_mesh = false, by_gmsh = false;
  constexpr double begun_mesh = 0.3, meshing_of_one = 25e-6;  // measured  [s]
  std::string of;
  for (const fdem3::BodyConfig& given : config.bodies) {
    if (given.shape == "part") continue;  // counted with the body that it is of
    const auto [body, count] = meshed(given, folder);
    if (count < 1.0) {  // gmsh alone knows
      f.items = 0.0;
      return f;
    }
    specimen.bodies.push_back(box_of(body, top));
    f.items += count;
    const fdem::MaterialConfig* const m = prepare::item_named(config.materials, body.material);
    if (m == nullptr || m->joints == "intrinsic") f.bonds += 1.9 * count;
    free_mesh = free_mesh || !body.structured;
    by_gmsh = by_gmsh || (!body.structured && body.shape != "mesh");
    if (finest == 0.0 || body.mesh_size < finest) {
      finest = body.mesh_size;
      of = body.name + ", edges of " + length_text(body.mesh_size);
    }
  }
  const fdem3::Model model = build_model(specimen, folder);
  const std::unique_ptr<Method> method = make_method(specimen, model, Exec{});
  const std::string rule = method->step_rule();
  take_size(f, finest, "edge");
  take_step(f, free_mesh ? step_of_flattest(specimen, folder) : method->time_step(),
            (rule.empty() ? "tetrahedra" : rule) + " (finest mesh: " + of + ")");
  f.cut_by_lines = free_mesh && (!config.joint_sets.empty() || config.discontinuities.size() > 1);
  finish(f, config.time, end_of(config.stages, config.time.end), known);
  // Bodies that press on each other and joints that broke cost contacts, which specimens lack.
  const double contacts = config.bodies.size() > 1 || f.bonds > 0.0 ? 1.5 : 1.0;
  f.here_s =
      contacts * wall_of(f.steps, f.items, pace_of(*method, static_cast<double>(model.size())));
  f.gpu_s = f.steps * (0.4e-3 + 0.67e-9 * f.items);  // bench/notes/gpu.md, four sizes
  f.joined = can_crack(config.materials);
  f.may_end_early = may_end_early(config.stages);
  const double pixels = pixels_of(config.output);
  f.memory = own_memory + memory_plan(config).run_bytes;
  if (draws(config.output)) f.memory += pixel_of_faces * pixels;
  if (by_gmsh) f.setup_s = begun_mesh + meshing_of_one * f.items;
  add_output(f, config, pixels, {200e-9, 1.0e-6, 100e-9});
  add_disk(f, config, pixels, 14 + config.probes.size(), {90.0, 20.0, 4500.0, 0.0, 0.1});
  return f;
}

}  // namespace breccia
