#pragma once
// Small worlds of triangles made in code.

#include <cmath>
#include <map>
#include <string>

#include "core/precision.hpp"
#include "exec/error.hpp"
#include "fdem/observe.hpp"
#include "fdem/world.hpp"
#include "math/constants.hpp"
#include "prepare/meshing/structured.hpp"

namespace breccia::fdem::testing {

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
  void body(const char* name, const prepare::Mesh& mesh, std::int16_t material = 0,
            const Vec2& velocity = {}) {
    const auto first = static_cast<Index>(model.point.size());
    model.point.insert(model.point.end(), mesh.point.begin(), mesh.point.end());
    model.groups.push_back(name);
    for (const prepare::Triangle& t : mesh.triangle) {
      model.triangle.push_back({first + t[0], first + t[1], first + t[2]});
      model.group.push_back(static_cast<std::int16_t>(model.groups.size() - 1));
      model.material.push_back(material);
      model.velocity.push_back(velocity);
      model.strength.push_back(1.0F);
    }
  }
  /// Adds a body of one triangle.
  void triangle(const char* name, const Vec2& a, const Vec2& b, const Vec2& c,
                std::int16_t material = 0, const Vec2& velocity = {}) {
    prepare::Mesh mesh;
    mesh.point = {a, b, c};
    mesh.triangle = {{0, 1, 2}};
    body(name, mesh, material, velocity);
  }
  SupportConfig& support(const char* name, const Vec2& min, const Vec2& max,
                         const std::vector<std::string>& fix, const Vec2& velocity = {},
                         const char* on = "") {
    SupportConfig s;
    s.name = name;
    s.region.on = on;
    s.region.min = min;
    s.region.max = max;
    s.fix = fix;
    s.velocity = velocity;
    return config.supports.emplace_back(s);
  }
  LoadConfig& load(const char* name, const char* kind, const Vec2& min, const Vec2& max,
                   const char* on = "") {
    LoadConfig l;
    l.name = name;
    l.kind = kind;
    l.region.on = on;
    l.region.min = min;
    l.region.max = max;
    return config.loads.emplace_back(l);
  }
  World world(int threads = 1) const {
    Exec exec = in_precision({}, config.precision);
    exec.threads = threads;
    return make_world(config, model, exec);
  }
};

inline constexpr double far = 1e9;

/// A brittle disc, 40 mm across, that falls on a plate and breaks there; both have joints.
/// @param speed  of the disc  [m/s]
inline Scene brittle_disc(double speed) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.damping = 0.02;
  m.joint.tension = 2e6;
  m.joint.cohesion = 6e6;
  m.joint.energy_open = 2.0;
  m.joint.energy_slide = 6.0;
  scene.config.time.evaluate_every = 50;
  scene.body("disc", prepare::ringed_disc({0.0, 0.0202}, 0.02, 4e-3), 0, {2.0, -speed});
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.01}, {0.06, 0.02}}, 5e-3));
  scene.support("ground", {-1.0, -1.0}, {1.0, -0.0199}, {"y"});
  return scene;
}

inline TriangleNodes& nodes(World& w, Index t) {
  return w.triangles.nodes.data()[t];
}
inline const TriangleNodes& nodes(const World& w, Index t) {
  return w.triangles.nodes.data()[t];
}

/// Moves every corner by a function of where it is.
template <class Map>
void deform(World& w, const Map& map) {
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (NodeState& n : nodes(w, t).at) n.position = map(n.position);
}
/// Gives every corner the velocity that a function of its position says.
template <class Map>
void stir(World& w, const Map& map) {
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (NodeState& n : nodes(w, t).at) n.velocity = map(n.position);
}

/// Velocity at the time of the positions: half a step on from where it is kept.
inline Vec2 velocity_now(const World& w, Index t, int k) {
  const Vec2 force =
      w.triangles.force.data()[t].at[k] + w.triangles.mass.data()[t] * w.given->gravity;
  return nodes(w, t).at[k].velocity + (0.5 * w.last_dt / w.triangles.mass.data()[t]) * force;
}

struct Momentum {
  Vec2 linear{};
  double angular = 0.0, size = 0.0;  ///< size: sum of |m v|
};
inline Momentum momentum(const World& w) {
  Momentum p;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (const NodeState& n : nodes(w, t).at) {
      const Vec2 mv = w.triangles.mass.data()[t] * n.velocity;
      p.linear += mv;
      p.angular += cross(n.position, mv);
      p.size += norm(mv);
    }
  return p;
}

inline double value(const World& w, const char* on, const char* quantity,
                    const char* reduce = "mean") {
  return probe(w, ProbeConfig{"", on, quantity, reduce});
}

inline void run_to(World& w, double time) {
  while (w.time < time) step(w);
}

inline Vec2 rotated(const Vec2& x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x.x - s * x.y, s * x.x + c * x.y};
}

}  // namespace breccia::fdem::testing
