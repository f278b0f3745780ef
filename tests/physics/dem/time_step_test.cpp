// The time step: the same in any axes, and never above what the assembly bears.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "scene.hpp"

namespace breccia::dem {
namespace time_step_test {

using testing::Scene;

/// A heap of spheres of unlike size, most neighbours linked, the others in contact.
Scene heap(double poisson, double rolling, double linked) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, poisson, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  m.rolling_limit = 1e9;
  m.rolling_stiffness = rolling;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 4; ++k) {
        const auto place = [&](int at) { return 0.02 * at + 0.006 * number(random); };
        const double x = place(i), y = place(j), z = place(k);
        s.sphere({x, y, z}, 0.007 + 0.007 * number(random));
      }
  for (Index a = 0; a < s.model.size(); ++a)
    for (Index b = a + 1; b < s.model.size(); ++b) {
      const auto p = static_cast<std::size_t>(a), q = static_cast<std::size_t>(b);
      const double touching = s.model.radius[p] + s.model.radius[q];
      const double distance = norm(s.model.position[q] - s.model.position[p]);
      if (distance < 1.3 * touching && number(random) < linked) s.link(a, b);
    }
  return s;
}

/// The least inertia over stiffness, from which the step follows.  [s2]
double least_critical(const World& w) {
  const auto all = w.critical.host();
  return *std::min_element(all.begin(), all.end());
}

TEST(TimeStep, does_not_depend_on_how_a_scene_is_turned) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> number;
  const Scene upright = heap(0.2, 1.0, 0.9);
  const World first = upright.world();
  const double expected = least_critical(first);
  int turned_steps = 0;
  for (int turn = 0; turn < 12; ++turn) {
    const double w = number(random), x = number(random), y = number(random), z = number(random);
    const double size = std::sqrt(w * w + x * x + y * y + z * z);
    const Vec3 axis = (1.0 / size) * Vec3{x, y, z};
    Scene s = upright;
    for (Vec3& p : s.model.position) {
      const Vec3 c = cross(axis, p);
      p += 2.0 * ((w / size) * c + cross(axis, c));
    }
    const World turned = s.world();
    EXPECT_NEAR(least_critical(turned) / expected, 1.0, 2e-6) << turn;
    if (turned.next_dt != first.next_dt) ++turned_steps;
  }
  EXPECT_LE(turned_steps, 2);  // it is rounded down to six bits
}

/// Forces of linear links on small motions u, theta of a world's elements.
struct Assembly {
  const World& w;
  double kt_share, rolling;

  using Motion = std::vector<Vec3>;  // u, then theta, of each element
  Motion force(const Motion& x) const {
    Motion f(x.size());
    const auto at = [](Index e) { return 2 * static_cast<std::size_t>(e); };
    for (Index i = 0; i < w.concrete.size(); ++i) {
      const Index a = w.concrete.a.data()[i], b = w.concrete.b.data()[i];
      const ElementState &sa = testing::state(w, a), &sb = testing::state(w, b);
      const Vec3 d = sb.position - sa.position;
      const double length = norm(d);
      const Vec3 n = (1.0 / length) * d;
      const double arm_a = 0.5 * (length + sa.radius - sb.radius), arm_b = length - arm_a;
      const double kn = w.concrete.stiffness.data()[i], kt = kt_share * kn;
      const double middle = 0.5 * (sa.radius + sb.radius);
      const Vec3 apart = x[at(b)] - x[at(a)];
      Vec3 slip = apart - cross(arm_a * x[at(a) + 1] + arm_b * x[at(b) + 1], n);
      slip -= dot(slip, n) * n;
      const Vec3 on_a = kn * dot(apart, n) * n + kt * slip;
      const Vec3 bent = (rolling * kt * middle * middle) * (x[at(b) + 1] - x[at(a) + 1]);
      f[at(a)] += on_a;
      f[at(b)] -= on_a;
      f[at(a) + 1] += arm_a * cross(n, on_a) + bent;
      f[at(b) + 1] += arm_b * cross(n, on_a) - bent;
    }
    return f;
  }
  /// The largest square of a circular frequency.  [1/s2]
  double largest_square() const {
    std::mt19937_64 random(1);
    std::normal_distribution<double> number;
    Motion x(2 * static_cast<std::size_t>(w.elements.size()));
    for (Vec3& v : x) v = {number(random), number(random), number(random)};
    double square = 0.0;
    for (int turn = 0; turn < 2000; ++turn) {
      const Motion f = force(x);
      double work = 0.0, size = 0.0, next = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double inertia =
            (i % 2 == 0 ? w.elements.mass : w.elements.inertia).data()[static_cast<Index>(i / 2)];
        work -= dot(x[i], f[i]);
        size += inertia * dot(x[i], x[i]);
        x[i] = (1.0 / inertia) * f[i];
        next += inertia * dot(x[i], x[i]);
      }
      square = work / size;
      for (Vec3& v : x) v = (1.0 / std::sqrt(next)) * v;
    }
    return square;
  }
};

TEST(TimeStep, of_a_heap_is_below_the_critical_one_of_its_largest_frequency) {
  for (const double poisson : {0.0, 0.1, 0.2})
    for (const double rolling : {0.0, 0.3, 1.0}) {
      const World w = heap(poisson, rolling, 1.0).world();
      const Assembly all{w, w.concrete.groups[0].law.shear_ratio, rolling};
      const double critical = 2.0 / std::sqrt(all.largest_square());
      const double bound = std::sqrt(2.0 * least_critical(w));
      EXPECT_LT(bound, critical) << poisson << ' ' << rolling;
      EXPECT_GT(bound, 0.6 * critical) << poisson << ' ' << rolling;
    }
}

TEST(TimeStep, of_a_pair_is_that_of_its_link_along_any_direction) {
  for (const Vec3& n : {Vec3{1.0, 0.0, 0.0}, Vec3{0.6, 0.0, 0.8}, Vec3{2.0 / 3, -1.0 / 3, 2.0 / 3}})
    for (const double poisson : {0.0, 0.2}) {
      Scene s;
      MaterialConfig& m = s.material("c", "concrete", 30e9, poisson, 2400.0);
      m.rolling_stiffness = 0.5;
      s.sphere({}, 0.01);
      s.sphere(0.025 * n, 0.013);
      s.link(0, 1);
      const World w = s.world();
      const double kn = w.concrete.stiffness.data()[0];
      const double kt = w.concrete.groups[0].law.shear_ratio * kn;
      const double arm = 0.5 * (0.025 + 0.01 - 0.013), kr = 0.5 * kt * 0.0115 * 0.0115;
      const double expected =
          std::min(s.model.mass[0] / kn, s.model.inertia[0] / (kt * arm * arm + kr));
      EXPECT_NEAR(w.critical.data()[0] / expected, 1.0, 0.2) << n.x << ' ' << poisson;
      EXPECT_LE(w.critical.data()[0], expected * (1.0 + 1e-6)) << n.x << ' ' << poisson;
    }
}

}  // namespace time_step_test
}  // namespace breccia::dem
