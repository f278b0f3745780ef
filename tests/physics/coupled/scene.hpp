#pragma once
// Small worlds of spheres and tetrahedra made in code.

#include <algorithm>
#include <cmath>
#include <memory>

#include "coupled/world.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia::coupled::testing {

/// Both worlds and what is between them.
struct Both {
  dem::World spheres;
  fdem3::World tetrahedra;
  World between;

  Both(const Config& config, const Parts& parts, const dem::Model& balls,
       const fdem3::Model& solids, const Exec& exec)
      : spheres(dem::make_world(parts.spheres, balls, exec)),
        tetrahedra(fdem3::make_world(parts.tetrahedra, solids, exec)),
        between(make_world(config, spheres, tetrahedra)) {}
  Both(const Both&) = delete;
};

/// A case and its models under construction.
struct Scene {
  dem::testing::Scene balls;
  fdem3::testing::Scene solids;
  CouplingConfig coupling;
  std::vector<BondConfig> bonds;
  Vec3 gravity{};
  double max_step = 1.0, safety = 0.7;

  Config config() const {
    Config config;
    static_cast<dem::Config&>(config.spheres) = balls.config;
    static_cast<fdem3::Config&>(config.tetrahedra) = solids.config;
    config.coupling = coupling;
    config.bonds = bonds;
    config.gravity = gravity;
    config.time.max_step = max_step;
    config.time.safety = safety;
    return config;
  }
  std::unique_ptr<Both> world(int threads = 1, Space space = Space::host) const {
    const Config whole = config();
    Exec exec;
    exec.threads = threads;
    exec.space = space;
    return std::make_unique<Both>(whole, parts_of(whole), balls.model, solids.model, exec);
  }
};

/// Of both, at the end of a step.
inline EnergyBalance energies(Both& w) {
  const EnergyBalance a = dem::balance(w.spheres), b = fdem3::energies(w.tetrahedra).balance;
  const Energies c = held(w.between);
  EnergyBalance all;
  all.kinetic = a.kinetic + b.kinetic;
  all.elastic = a.elastic + b.elastic + c.elastic.value();
  all.fracture = a.fracture + b.fracture + c.fracture.value();
  all.friction = a.friction + b.friction + (c.friction + w.between.ledger.friction).value();
  all.damping = a.damping + b.damping;
  all.contact = a.contact + b.contact + (c.contact + w.between.ledger.contact).value();
  all.work = a.work + b.work;
  all.start = a.start + b.start;
  return all;
}

/// Momentum and moment of momentum, of velocities half a step before: what the scheme keeps.
inline dem::testing::Momentum momentum(Both& w) {
  dem::testing::Momentum p = dem::testing::momentum(w.spheres);
  for (Index t = 0; t < w.tetrahedra.tetrahedra.size(); ++t)
    for (const fdem3::NodeState& n : w.tetrahedra.tetrahedra.nodes.data()[t].at) {
      const Vec3 mv = w.tetrahedra.tetrahedra.mass.data()[t] * n.velocity;
      p.linear += mv;
      p.angular += cross(n.position, mv);
    }
  return p;
}

/// A block that stands still, its top at z = 0.
inline void held_block(Scene& scene, const Vec3& size, double edge) {
  scene.solids.material(30e9, 0.2, 2400.0);
  scene.solids.body("block", fdem3::testing::box({0.0, 0.0, -0.5 * size.z}, size, edge));
  const double far = fdem3::testing::far;
  scene.solids.support("all", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"});
}

}  // namespace breccia::coupled::testing
