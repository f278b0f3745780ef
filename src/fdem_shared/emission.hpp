#pragma once
// Acoustic emission of joints that broke, of triangles and tetrahedra.

#include <algorithm>
#include <vector>

#include "core/emission.hpp"
#include "core/emission_config.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// The moment of a joint that opened by o along n and slid by s along e, over its area A: the
/// stress that the jump would give the rock, times A (Aki and Richards 2002, 3.2),
///
///   M = A (lambda o 1 + 2 mu o n n + mu s (n e + e n)).  [N m]
template <class Law>
Sym3 moment_of(const Law& law, const Vec3& n, const Vec3& e, double area, double opening,
               double slip) {
  const double all = area * law.lambda * opening, open = 2.0 * area * law.shear * opening,
               slid = area * law.shear * slip;
  return {all + open * n.x * n.x + 2.0 * slid * n.x * e.x,
          all + open * n.y * n.y + 2.0 * slid * n.y * e.y,
          all + open * n.z * n.z + 2.0 * slid * n.z * e.z,
          open * n.y * n.z + slid * (n.y * e.z + n.z * e.y),
          open * n.x * n.z + slid * (n.x * e.z + n.z * e.x),
          open * n.x * n.y + slid * (n.x * e.y + n.y * e.x)};
}

/// The rock at a joint, between both of its sides.
template <class Law>
Law mean_of_sides(Law a, const Law& b) {
  a.lambda = 0.5 * (a.lambda + b.lambda);
  a.shear = 0.5 * (a.shear + b.shear);
  return a;
}

/// Energy that a joint spent on its fracture, without what contact of its sides began with.
template <class Joints>
double spent_by(const Joints& joints, Index i) {
  const auto &work = joints.work.data()[i], &before = inherited_work(joints, i);
  return work.open + work.slide - before.open - before.slide - friction_of_broken(joints, i);
}

/// Events by what the case says is near, or two mean edges and the time of the slowest wave.
template <class World>
std::vector<EmissionEvent> near_events(const World& w, const std::vector<Break>& breaks) {
  const EmissionConfig& asked = w.given->emission;
  const double distance = asked.distance > 0.0 ? asked.distance : 2.0 * w.given->mean_edge;
  double slowest = 1e300;
  for (const auto& rock : w.given->rocks) slowest = std::min(slowest, rock.slow);
  return events_of(breaks, distance, asked.window > 0.0 ? asked.window : distance / slowest);
}

}  // namespace breccia::fdem_shared
