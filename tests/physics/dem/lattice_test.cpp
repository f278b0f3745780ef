// A triangular lattice in its plane, unit thickness: its moduli follow from K_n and K_t alone.

#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace lattice_test {

using testing::Scene;
using testing::state;

constexpr double radius = 0.01, spacing = 0.02;

/// A symmetric matrix in the plane.
struct Plane {
  double xx, yy, xy;
};

/// The lattice after one step of an affine motion.
struct Affine {
  World world;
  Plane strain;
  Index middle;  ///< an element with six neighbours around it, and they have six, too
  double kn, kt;
};

/// Moves a patch of the lattice, turned by `angle`, by the velocities L x and looks one step later.
/// Without forces at the start, the first step is affine to rounding. `turn` is the rate of a rigid
/// rotation on top.
Affine deformed(double poisson, const Plane& rate, double angle, double turn = 0.0) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, poisson, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  m.rolling_limit = 1e9;
  Index middle = -1;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      const double along = spacing * (i + 0.5 * j), across = spacing * 0.5 * std::sqrt(3.0) * j;
      const Vec3 x{std::cos(angle) * along - std::sin(angle) * across,
                   std::sin(angle) * along + std::cos(angle) * across, 0.0};
      const Vec3 v{rate.xx * x.x + (rate.xy - turn) * x.y, (rate.xy + turn) * x.x + rate.yy * x.y,
                   0.0};
      const Index e = s.sphere(x, radius, v, {0.0, 0.0, turn});
      if (i == 0 && j == 0) middle = e;
    }
  for (Index a = 0; a < s.model.size(); ++a)
    for (Index b = a + 1; b < s.model.size(); ++b)
      if (norm(s.model.position[static_cast<std::size_t>(b)] -
               s.model.position[static_cast<std::size_t>(a)]) < 1.1 * spacing)
        s.link(a, b);
  World w = s.world();
  const double kn = w.concrete.stiffness.data()[0];
  const double kt = w.concrete.groups[0].law.shear_ratio * kn;
  const double dt = w.next_dt;
  step(w);
  return {std::move(w), {rate.xx * dt, rate.yy * dt, rate.xy * dt}, middle, kn, kt};
}

/// sigma = 1/(2 A) sum over the links of one element of force times branch, A its hexagon; per unit
/// of thickness  [N/m]
Plane stress_at(const World& w, Index element) {
  const double area = 0.5 * std::sqrt(3.0) * spacing * spacing;
  Plane sum{0.0, 0.0, 0.0};
  for (Index i = 0; i < w.concrete.size(); ++i) {
    const Index a = w.concrete.a.data()[i], b = w.concrete.b.data()[i];
    if (a != element && b != element) continue;
    const Vec3 branch = state(w, b).position - state(w, a).position;
    const Vec3 pull = -1.0 * link_force(w.concrete.groups[0].law, w.concrete, w.elements, i);
    sum.xx += 0.5 / area * pull.x * branch.x;
    sum.yy += 0.5 / area * pull.y * branch.y;
    sum.xy += 0.25 / area * (pull.x * branch.y + pull.y * branch.x);
  }
  return sum;
}

/// E = 2 sqrt3 K_n (K_n + K_t)/(3 K_n + K_t), nu = (K_n - K_t)/(3 K_n + K_t), plane stress.
Plane expected_stress(double kn, double kt, const Plane& strain) {
  const double young = 2.0 * std::sqrt(3.0) * kn * (kn + kt) / (3.0 * kn + kt);
  const double nu = (kn - kt) / (3.0 * kn + kt);
  const double c = young / (1.0 - nu * nu);
  return {c * (strain.xx + nu * strain.yy), c * (strain.yy + nu * strain.xx),
          c * (1.0 - nu) * strain.xy};
}

/// A rate of which one step makes a strain near 1e-8, so that squares of it do not count.
constexpr double rate = 5e-3;

TEST(Lattice, has_the_modulus_and_poisson_ratio_of_its_springs_in_every_direction) {
  // K_t / K_n = (1 - 3.9 nu)/(1 + nu): 1, 1/2 and 0
  for (const double poisson : {0.0, 0.5 / 4.4, 1.0 / 3.9})
    for (const double angle : {0.0, 0.2, pi / 7.0})
      for (const Plane& way : {Plane{rate, 0.0, 0.0}, Plane{0.0, rate, 0.0}, Plane{0.0, 0.0, rate},
                               Plane{rate, -0.3 * rate, 0.7 * rate}}) {
        const Affine now = deformed(poisson, way, angle);
        const Plane stress = stress_at(now.world, now.middle);
        const Plane expected = expected_stress(now.kn, now.kt, now.strain);
        const double scale = 1e-6 * now.kn * rate * now.world.last_dt;
        EXPECT_NEAR(stress.xx, expected.xx, scale) << poisson << " " << angle;
        EXPECT_NEAR(stress.yy, expected.yy, scale) << poisson << " " << angle;
        EXPECT_NEAR(stress.xy, expected.xy, scale) << poisson << " " << angle;
        // So deformed the lattice is in equilibrium: nothing relaxes, the moduli are its own.
        const double force = 1e-6 * now.kn * rate * now.world.last_dt * spacing;
        EXPECT_LT(norm(now.world.elements.force.data()[now.middle]), force);
        EXPECT_LT(norm(now.world.elements.torque.data()[now.middle]), force * radius);
      }
}

TEST(Lattice, stores_half_of_stress_times_strain) {
  // Every element has three links of its own in the plane: energy of a link over the area of a
  // hexagon, summed over the three directions.
  Affine now = deformed(0.1, {rate, 0.4 * rate, -0.2 * rate}, 0.3);
  const Plane& e = now.strain;
  const Plane s = expected_stress(now.kn, now.kt, e);
  const double area = 0.5 * std::sqrt(3.0) * spacing * spacing;
  const double per_element = 0.5 * area * (s.xx * e.xx + s.yy * e.yy + 2.0 * s.xy * e.xy);
  double stored = 0.0;
  for (Index i = 0; i < now.world.concrete.size(); ++i) {
    const Index a = now.world.concrete.a.data()[i], b = now.world.concrete.b.data()[i];
    if (a != now.middle && b != now.middle) continue;
    const World& w = now.world;
    const Vec3 f = link_force(w.concrete.groups[0].law, w.concrete, w.elements, i);
    const Vec3 n = (1.0 / spacing) * (state(now.world, b).position - state(now.world, a).position);
    const double pull = dot(f, n), slide = dot(f, f) - pull * pull;
    // half a link belongs to this element
    stored += 0.25 * (pull * pull / now.kn + slide / now.kt);
  }
  EXPECT_NEAR(stored, per_element, 1e-6 * per_element);
}

TEST(Lattice, turned_as_a_rigid_body_bears_no_stress) {
  const double turn = 1.0;
  const Affine now = deformed(0.1, {0.0, 0.0, 0.0}, 0.3, turn);
  const Plane stress = stress_at(now.world, now.middle);
  // A velocity along the tangent stretches by half the square of the angle.
  const double angle = turn * now.world.last_dt;
  EXPECT_LT(std::fabs(stress.xx) + std::fabs(stress.yy) + std::fabs(stress.xy),
            2.0 * now.kn * angle * angle);
}

}  // namespace lattice_test
}  // namespace breccia::dem
