#pragma once
// Small worlds made in code.

#include <cmath>

#include "dem/observe.hpp"
#include "dem/world.hpp"
#include "math/constants.hpp"

namespace breccia::dem::testing {

/// A case and a model under construction.
struct Scene {
  Config config;
  Model model;

  Scene() { config.time.max_step = 1.0; }

  /// Adds a material and returns it for changes; elements name it by number.
  MaterialConfig& material(const char* name, const char* law, double young, double poisson,
                           double density) {
    MaterialConfig m;
    m.name = name;
    m.law = law;
    m.young = young;
    m.poisson = poisson;
    m.density = density;
    return config.materials.emplace_back(m);
  }
  /// Adds a sphere of the bulk density of its material.
  Index sphere(const Vec3& position, double radius, const Vec3& velocity = {},
               const Vec3& spin = {}, std::int16_t material = 0) {
    const double density = config.materials.at(static_cast<std::size_t>(material)).density;
    const double mass = 4.0 / 3.0 * pi * radius * radius * radius * density;
    return element(position, radius, mass, 0.4 * mass * radius * radius, velocity, spin, material);
  }
  Index element(const Vec3& position, double radius, double mass, double inertia,
                const Vec3& velocity = {}, const Vec3& spin = {}, std::int16_t material = 0) {
    if (model.groups.empty()) model.groups.push_back("all");
    model.group.push_back(0);
    model.material.push_back(material);
    model.radius.push_back(radius);
    model.mass.push_back(mass);
    model.inertia.push_back(inertia);
    model.position.push_back(position);
    model.velocity.push_back(velocity);
    model.spin.push_back(spin);
    model.bar_previous.push_back(-1);
    model.bar_next.push_back(-1);
    return model.size() - 1;
  }
  void link(Index a, Index b, LinkKind kind = LinkKind::concrete, std::int16_t material = 0) {
    model.links.push_back({a, b, kind, material});
  }
  void wall(const Vec3& point, const Vec3& normal, const Vec3& velocity = {}) {
    config.walls.push_back({"wall", point, normal, velocity, 1.0});
  }
  World world(int threads = 1, Precision precision = Precision::full) const {
    Exec exec;
    exec.threads = threads;
    exec.precision = precision;
    return make_world(config, model, exec);
  }
};

inline const ElementState& state(const World& w, Index e) {
  return w.elements.state.data()[e];
}

/// Velocity at the time of the positions: half a step on from where it is kept.
inline Vec3 velocity_now(const World& w, Index e) {
  return state(w, e).velocity +
         (0.5 * w.last_dt / w.elements.mass.data()[e]) * w.elements.force.data()[e];
}

/// Steps until pred(w) holds; false if it does not within `most` steps.
template <class Predicate>
bool run_until(World& w, long most, const Predicate& pred) {
  for (long i = 0; i < most; ++i) {
    step(w);
    if (pred(w)) return true;
  }
  return false;
}

struct Momentum {
  Vec3 linear{}, angular{};
};
inline Momentum momentum(const World& w) {
  Momentum p;
  for (Index e = 0; e < w.elements.size(); ++e) {
    const ElementState& s = state(w, e);
    const double m = w.elements.mass.data()[e];
    p.linear += m * s.velocity;
    p.angular += cross(s.position, m * s.velocity) + w.elements.inertia.data()[e] * s.spin;
  }
  return p;
}

}  // namespace breccia::dem::testing
