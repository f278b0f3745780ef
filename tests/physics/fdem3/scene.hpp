#pragma once
// Small worlds of tetrahedra made in code.

#include <string>

#include "fdem3/observe.hpp"
#include "fdem3/world.hpp"
#include "prepare/tetrahedra/kuhn_box.hpp"

namespace breccia::fdem3::testing {

/// A case and a model under construction.
struct Scene {
  Config config;
  Model model;

  Scene() { config.time.max_step = 1.0; }

  /// Adds a material without joints or friction and returns it for changes.
  MaterialConfig& material(double young = 60e9, double poisson = 0.25, double density = 2650.0) {
    MaterialConfig m;
    m.name = "m" + std::to_string(config.materials.size());
    m.young = young;
    m.poisson = poisson;
    m.density = density;
    m.joints = "none";
    m.friction = 0.0;
    return config.materials.emplace_back(m);
  }
  /// Adds a body with vertices of its own.
  template <class Place>
  void body(const char* name, const prepare::TetMesh& mesh, const Vec3& velocity,
            const Place& place) {
    const auto first = static_cast<Index>(model.point.size());
    for (const Vec3& x : mesh.point) model.point.push_back(place(x));
    model.groups.push_back(name);
    for (const prepare::Tetrahedron& t : mesh.tetrahedron) {
      model.tetrahedron.push_back({first + t[0], first + t[1], first + t[2], first + t[3]});
      model.group.push_back(static_cast<std::int16_t>(model.groups.size() - 1));
      model.material.push_back(0);
      model.velocity.push_back(velocity);
      model.strength.push_back(1.0F);
    }
  }
  void body(const char* name, const prepare::TetMesh& mesh, const Vec3& velocity = {}) {
    body(name, mesh, velocity, [](const Vec3& x) { return x; });
  }
  SupportConfig& support(const char* name, const Vec3& min, const Vec3& max,
                         const std::vector<std::string>& fix, const Vec3& velocity = {}) {
    SupportConfig s;
    s.name = name;
    s.region.min = min;
    s.region.max = max;
    s.fix = fix;
    s.velocity = velocity;
    return config.supports.emplace_back(s);
  }
  LoadConfig& load(const char* name, const char* kind, const Vec3& min, const Vec3& max) {
    LoadConfig l;
    l.name = name;
    l.kind = kind;
    l.region.min = min;
    l.region.max = max;
    return config.loads.emplace_back(l);
  }
  World world(int threads = 1, Space space = Space::host) const {
    Exec exec;
    exec.threads = threads;
    exec.space = space;
    return make_world(config, model, exec);
  }
};

inline constexpr double far = 1e9;

/// A jittered box.
inline prepare::TetMesh box(const Vec3& center, const Vec3& size, double edge, double share = 0.1) {
  prepare::TetMesh mesh = prepare::kuhn_box(center, size, edge);
  prepare::jitter(mesh, share, Random{11, 5}, {});
  return mesh;
}

/// Sums over corners, at the time of the positions.
struct Motions {
  Vec3 linear{}, angular{};
  double size = 0.0;  ///< sum of |m v|
};
inline Motions motions(World& w) {
  Motions p;
  const std::vector<Corners> now = velocities_now(w);
  for (Index t = 0; t < w.tetrahedra.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      const Vec3 mv = w.tetrahedra.mass.data()[t] * now[static_cast<std::size_t>(t)].at[k];
      p.linear += mv;
      p.angular += cross(w.tetrahedra.nodes.data()[t].at[k].position, mv);
      p.size += norm(mv);
    }
  return p;
}

/// Two cubes with joints that meet and break: all kernels have work.
inline Scene meeting_cubes(const char* criterion = "rock") {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.damping = 0.02;
  m.joint.tension = 3e6;
  m.joint.cohesion = 9e6;
  m.joint.energy_open = 3.0;
  m.joint.energy_slide = 9.0;
  scene.config.joints.criterion = criterion;
  scene.body("low", box({0.0, 0.0, -0.0101}, {0.02, 0.02, 0.02}, 0.01), {});
  scene.body("high", box({0.003, 0.002, 0.0101}, {0.02, 0.02, 0.02}, 0.01), {3.0, 0.0, -30.0});
  return scene;
}

}  // namespace breccia::fdem3::testing
