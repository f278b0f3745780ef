#pragma once
// Scenes for ranks: a slab of spheres, triangles that break, triangles that fly.

#include <memory>
#include <string>
#include <vector>

#include "core/precision.hpp"
#include "dem/observe.hpp"
#include "domain/domain.hpp"
#include "paths.hpp"
#include "physics/fdem/scene.hpp"
#include "prepare/build.hpp"
#include "prepare/build_fdem.hpp"
#include "run/case_keys.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia::mpi_testing {

/// A case of spheres.
struct Slab {
  dem::Config config;
  std::shared_ptr<const dem::Model> model;

  dem::World world(int threads = 1) const {
    Exec exec = in_precision({}, config.precision);
    exec.threads = threads;
    return dem::make_world(config, *model, exec);
  }
};

/// The small slab; its model is built once.
inline Slab slab(const std::vector<std::string>& overrides = {}) {
  const auto config = [](const std::vector<std::string>& changed) {
    return read_case<dem::Config>(std::string(source_dir) + "/cases/rc_slab/small.toml", changed);
  };
  static const auto model = std::make_shared<const dem::Model>(build_model(config({}), ""));
  return {config(overrides), model};
}

/// The small array of spheres between six walls, five of which press by servos.
inline Slab spheres_between_walls() {
  const std::string folder = std::string(source_dir) + "/cases/triaxial";
  Slab array;
  array.config = read_case<dem::Config>(folder + "/small.toml", {});
  array.model = std::make_shared<const dem::Model>(build_model(array.config, folder));
  return array;
}

/// A piece of the slab, free at its edges, with a bar each way.
inline Slab slab_piece() {
  Slab piece;
  piece.config = read_case<dem::Config>(std::string(source_dir) + "/cases/rc_slab/small.toml", {});
  piece.config.supports.clear();
  piece.config.probes.clear();
  dem::BodyConfig &plate = piece.config.bodies[0], &bars = piece.config.bodies[1],
                  &rock = piece.config.bodies[2];
  plate.size = {0.18, 0.18, 0.1};
  plate.pack.count = 412;
  bars.rebar.bars = 1;
  bars.rebar.elements = 5;
  rock.radius = 0.04;
  rock.pack.count = 33;
  rock.center = {0.01, 0.02, 0.0905};
  rock.velocity = {0.0, 0.0, -60.0};
  piece.model = std::make_shared<const dem::Model>(build_model(piece.config, ""));
  return piece;
}

using fdem::testing::Scene;

/// A brittle disc that breaks on a plate. Extrinsic: its triangles move as one until joints wake.
inline Scene impact(const char* joints) {
  Scene scene = fdem::testing::brittle_disc(60.0);
  scene.config.materials[0].joints = joints;
  scene.config.gravity = {0.0, -9.81};
  scene.load("push", "pressure", {-1.0, -1.0}, {-0.0299, 1.0}, "plate").pressure = 1e5;
  scene.load("quiet", "absorbing", {0.0299, -1.0}, {1.0, 1.0}, "plate");
  return scene;
}

/// Hexagons of six triangles that move as one, flying into the corner of a room.
inline Scene box() {
  Scene scene;
  scene.config =
      read_case<fdem::Config>(std::string(source_dir) + "/cases/moving_box/small.toml", {});
  fdem::BodyConfig& blocks = scene.config.bodies[0];
  blocks.hexagons.count = 100;
  blocks.size = {19.0, 19.0};
  blocks.center = {39.0, 38.0};
  FdemNames names;
  for (const fdem::MaterialConfig& m : scene.config.materials) names.materials.push_back(m.name);
  scene.model = build_fdem_model(scene.config.bodies, {}, names, 1, "");
  return scene;
}

/// A small disc that flies far, from one plate past others to the last.
inline Scene shot() {
  Scene scene;
  fdem::MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.joint.tension = 20e6;
  m.joint.cohesion = 60e6;
  m.joint.energy_open = 20.0;
  m.joint.energy_slide = 60.0;
  scene.config.time.evaluate_every = 50;
  const auto block = [&](const char* name, const Vec2& middle, const Vec2& size) {
    scene.body(name, prepare::equilateral_rectangle({middle, size}, 5e-3));
  };
  scene.body("disc", prepare::ringed_disc({-0.045, 0.0}, 4e-3, 4e-3), 0, {100.0, 0.0});
  block("muzzle", {-0.065, 0.0}, {0.02, 0.04});
  block("above", {-0.03, 0.016}, {0.02, 0.02});
  block("below", {-0.03, -0.016}, {0.02, 0.02});
  block("plate", {0.0, 0.0}, {0.02, 0.04});
  return scene;
}

inline std::unique_ptr<Method> method_of(const Slab& slab, const Exec& exec, Communicator* ranks) {
  return make_method(slab.config, *slab.model, exec, ranks);
}
inline std::unique_ptr<Method> method_of(const Scene& scene, const Exec& exec,
                                         Communicator* ranks) {
  return make_method(scene.config, scene.model, exec, ranks);
}

/// State and energies after a run.
struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t searches = 0;
  double energies[5] = {};
  std::size_t cracks = 0;
  Index candidates = 0;
  double dt = 0.0;
  bool operator==(const Outcome&) const = default;
};
inline void PrintTo(const Outcome& o, std::ostream* out) {
  *out << std::hex << o.hash << std::dec << ", " << o.searches << " searches, " << o.cracks
       << " cracks, " << o.candidates << " candidates, step " << std::hexfloat << o.dt
       << ", energies";
  for (const double energy : o.energies) *out << ' ' << energy;
  *out << std::defaultfloat;
}
inline Outcome outcome_of(dem::World& w) {
  const EnergyBalance e = dem::balance(w);
  return {dem::state_hash(w),
          w.searches,
          {e.kinetic, e.elastic, e.friction, e.fracture, e.work},
          static_cast<std::size_t>(dem::count(w).broken_of(dem::LinkKind::concrete)),
          w.contacts.size(),
          w.next_dt};
}
inline Outcome outcome_of(fdem::World& w) {
  const EnergyBalance e = fdem::energies(w).balance;
  return {fdem::state_hash(w),
          w.searches,
          {e.kinetic, e.elastic, e.friction, e.fracture, e.work},
          fdem::cracks(w).size(),
          w.couples.size(),
          w.next_dt};
}

}  // namespace breccia::mpi_testing
