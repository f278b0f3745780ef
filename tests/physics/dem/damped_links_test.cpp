// Chains of damped links: standing waves die as a spring beside a spring and a dashpot in line
// says.
#include <gtest/gtest.h>

#include <cmath>

#include "scene.hpp"

namespace breccia::dem {
namespace damped_links_test {

using testing::Scene;
using testing::state;

/// A free chain of touching spheres; its standing waves are u_j = cos(q (j + 1/2)), q = p pi / n.
struct Chain {
  static constexpr int size = 64;
  static constexpr double spacing = 0.02;
  Scene scene;

  explicit Chain(double damping, double time = 0.2) {
    MaterialConfig& m = scene.material("c", "concrete", 30e9, 0.2, 2400.0);
    m.tensile_strength = m.cohesion = 1e15;
    m.link_damping = damping;
    m.link_damping_time = time;
    scene.config.time.safety = 0.05;
    for (int j = 0; j < size; ++j) scene.sphere({j * spacing, 0.0, 0.0}, 0.5 * spacing);
    for (int j = 0; j + 1 < size; ++j) scene.link(j, j + 1);
  }
  void start(int mode, double velocity) {
    for (int j = 0; j < size; ++j)
      scene.model.velocity[static_cast<std::size_t>(j)].x =
          velocity * std::cos(mode * pi / size * (j + 0.5));
  }
  /// tau  [s]
  double relaxation() const {
    const MaterialConfig& m = scene.config.materials[0];
    return m.link_damping_time * spacing / std::sqrt(m.young / m.density);
  }
};

/// u'' = -w^2 (u + m e), e' = u' - e / tau: by Runge and Kutta's rule of the fourth order.
struct Mode {
  double omega, share, tau;
  double u = 0.0, v = 0.0, e = 0.0;

  void step(double dt) {
    const auto rate = [this](const Mode& s) {
      Mode r = s;
      r.u = s.v;
      r.v = -omega * omega * (s.u + share * s.e);
      r.e = s.v - s.e / tau;
      return r;
    };
    const auto after = [this](const Mode& r, double by) {
      Mode s = *this;
      s.u += by * r.u;
      s.v += by * r.v;
      s.e += by * r.e;
      return s;
    };
    const Mode a = rate(*this), b = rate(after(a, 0.5 * dt)), c = rate(after(b, 0.5 * dt)),
               d = rate(after(c, dt));
    u += dt / 6.0 * (a.u + 2.0 * b.u + 2.0 * c.u + d.u);
    v += dt / 6.0 * (a.v + 2.0 * b.v + 2.0 * c.v + d.v);
    e += dt / 6.0 * (a.e + 2.0 * b.e + 2.0 * c.e + d.e);
  }
};

TEST(DampedChain, every_standing_wave_dies_as_its_equation_says_and_the_ledger_closes) {
  for (const int mode : {4, 16, 40}) {
    Chain chain(0.3);
    const double v = 1e-2;
    chain.start(mode, v);
    World w = chain.scene.world();
    const double k = w.concrete.stiffness.data()[0], m = chain.scene.model.mass[0];
    const double omega = 2.0 * std::sqrt(k / m) * std::sin(0.5 * mode * pi / Chain::size);
    Mode exact{omega, 0.3, chain.relaxation()};
    exact.v = v;
    const double whole = balance(w).kinetic;
    double largest = 0.0;
    while (omega * w.time < 6.0 * pi) {
      step(w);
      for (int part = 0; part < 4; ++part) exact.step(0.25 * w.last_dt);
      const double shape = std::cos(mode * pi / Chain::size * 0.5);
      // the leapfrog is late by (w dt)^2 / 24 of its phase
      ASSERT_NEAR(state(w, 0).position.x, shape * exact.u, 0.01 * v / omega)
          << "mode " << mode << ", t w " << omega * w.time;
      if (omega * w.time > 4.0 * pi) largest = std::max(largest, std::abs(exact.u));
    }
    EXPECT_LT(largest, 0.98 * v / omega);  // of an undamped one: v / w
    const EnergyBalance e = balance(w);
    EXPECT_GT(e.damping, 0.0);
    EXPECT_NEAR(e.kinetic + e.elastic + e.damping, whole, 1e-5 * whole);
  }
}

// Closed answer for waves that are long beside a link: the share of the energy that is left after a
// cycle is exp(-2 pi m w tau).
TEST(DampedChain, long_waves_lose_energy_by_the_square_of_their_frequency) {
  for (const int mode : {2, 4}) {
    Chain chain(0.3);
    chain.start(mode, 1e-2);
    World w = chain.scene.world();
    const double k = w.concrete.stiffness.data()[0], m = chain.scene.model.mass[0];
    const double omega = 2.0 * std::sqrt(k / m) * std::sin(0.5 * mode * pi / Chain::size);
    const double whole = balance(w).kinetic;
    while (omega * w.time < 8.0 * pi) step(w);
    const double loss = 8.0 * pi * 0.3 * omega * chain.relaxation();
    EXPECT_NEAR(balance(w).damping / whole, 1.0 - std::exp(-loss), 0.03 * loss) << mode;
  }
}

TEST(DampedChain, its_fastest_wave_is_stable_at_the_whole_critical_step) {
  for (const double time : {0.05, 0.2, 50.0}) {
    Chain chain(3.0, time);
    chain.scene.config.time.safety = 1.0;
    chain.start(Chain::size - 1, 1e-2);
    World w = chain.scene.world();
    const double whole = balance(w).kinetic;
    for (int n = 0; n < 3000; ++n) step(w);
    const EnergyBalance e = balance(w);
    EXPECT_LT(e.kinetic + e.elastic, 1.001 * whole) << time;
  }
}

TEST(DampedChain, that_turns_as_one_keeps_its_energy_and_its_angular_momentum) {
  Chain chain(0.3);
  const double spin = 50.0, middle = 0.5 * (Chain::size - 1) * Chain::spacing;
  for (int j = 0; j < Chain::size; ++j) {
    chain.scene.model.velocity[static_cast<std::size_t>(j)].y =
        spin * (j * Chain::spacing - middle);
    chain.scene.model.spin[static_cast<std::size_t>(j)].z = spin;
  }
  World w = chain.scene.world();
  const double momentum = testing::momentum(w).angular.z;
  const double whole = balance(w).kinetic;
  while (spin * w.time < 0.2 * pi) step(w);
  const EnergyBalance e = balance(w);
  EXPECT_NEAR(testing::momentum(w).angular.z, momentum, 1e-9 * momentum);
  // it is stretched by its spin at once, which rings, and the ringing alone dies
  EXPECT_LT(e.damping, 2.0 * e.elastic);
  EXPECT_LT(e.damping, 1e-3 * whole);
}

}  // namespace damped_links_test
}  // namespace breccia::dem
