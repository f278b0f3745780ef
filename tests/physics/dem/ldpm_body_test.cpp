// Bodies of LDPM: vibrations against beam theory, laws of motion, halves that meet again.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"

namespace breccia::dem {
namespace ldpm_body_test {

constexpr double young = 39e9, poisson = 0.17647, density = 2338.0;

Config prism(double width, double height) {
  Config config;
  MaterialConfig concrete;
  concrete.name = "concrete";
  concrete.law = "ldpm";
  concrete.density = density;
  concrete.young = young;
  concrete.poisson = poisson;
  concrete.tensile_strength = 3.44e6;
  concrete.cohesion = 8.944e6;
  config.materials = {concrete};
  BodyConfig body;
  body.name = "prism";
  body.material = "concrete";
  body.size = {width, width, height};
  config.bodies = {body};
  config.time.end = 1.0;
  return config;
}
SupportConfig end_face(const char* name, double low, double high) {
  SupportConfig s;
  s.name = name;
  s.min = {-1.0, -1.0, low};
  s.max = {1.0, 1.0, high};
  s.fix = {"all"};
  return s;
}

// --- Free vibrations of a cantilever ------------------------------------------------------------

struct Beam {
  double length, width, young;

  double area() const { return width * width; }
  double inertia() const { return width * width * width * width / 12.0; }
};
/// Determinant of moment and shear force at the free end of Timoshenko's cantilever that swings
/// with a circular frequency: zero for its own frequencies. Cowper's coefficient of shear.
double end_determinant(const Beam& beam, double omega) {
  using State = std::array<double, 4>;  // deflection, rotation, moment, shear force
  const double shear = beam.young / (2.0 * (1.0 + poisson)) * beam.area() * 10.0 * (1.0 + poisson) /
                       (12.0 + 11.0 * poisson);
  const double square = density * omega * omega;
  const auto slope = [&](const State& s) {
    return State{s[1] + s[3] / shear, s[2] / (beam.young * beam.inertia()),
                 -s[3] - square * beam.inertia() * s[1], -square * beam.area() * s[0]};
  };
  const auto plus = [](const State& s, double by, const State& d) {
    State sum = s;
    for (std::size_t k = 0; k < 4; ++k) sum[k] += by * d[k];
    return sum;
  };
  const auto at_end = [&](State s) {
    constexpr int steps = 200;
    const double h = beam.length / steps;
    for (int k = 0; k < steps; ++k) {  // Runge and Kutta
      const State a = slope(s), b = slope(plus(s, 0.5 * h, a)), c = slope(plus(s, 0.5 * h, b)),
                  d = slope(plus(s, h, c));
      s = plus(plus(plus(plus(s, h / 6.0, a), h / 3.0, b), h / 3.0, c), h / 6.0, d);
    }
    return s;
  };
  const State by_moment = at_end({0.0, 0.0, 1.0, 0.0}), by_force = at_end({0.0, 0.0, 0.0, 1.0});
  return by_moment[2] * by_force[3] - by_moment[3] * by_force[2];
}
double first_period(const Beam& beam) {
  const double slender = 3.516 / (beam.length * beam.length) *
                         std::sqrt(beam.young * beam.inertia() / (density * beam.area()));
  double low = 0.5 * slender, high = slender;
  const double sign = end_determinant(beam, low);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (sign * end_determinant(beam, middle) > 0.0 ? low : high) = middle;
  }
  return 2.0 * pi / low;
}

TEST(LdpmBody, timoshenkos_cantilever_is_eulers_where_it_is_slender) {
  const Beam beam{10.0, 0.05, young};
  const double slender = 3.51602 / (beam.length * beam.length) *
                         std::sqrt(young * beam.inertia() / (density * beam.area()));
  EXPECT_NEAR(first_period(beam) * slender / (2.0 * pi), 1.0, 3e-4);
}

constexpr double width = 0.04, height = 0.16;

/// A prism clamped at its foot that starts from rest in place with a speed along `direction`, by
/// the first mode. @returns time of one period, from zero to zero of the head's displacement
double swing(const Vec3& direction, double longest) {
  Config config = prism(width, height);
  MaterialConfig& m = config.materials[0];
  m.tensile_strength = m.cohesion = m.ldpm.collapse_strength = 1e12;
  m.ldpm.tensile_length = 100.0;
  config.supports = {end_face("foot", -1.0, -0.5 * height + 1e-6)};
  Model model = build_model(config, "");
  for (std::size_t e = 0; e < model.position.size(); ++e) {
    const double up = model.position[e].z / height + 0.5;
    // a quarter of a sine along the axis; (3 x^2 - x^3) / 2 is near the mode across it
    const double shape = direction.z != 0.0 ? std::sin(0.5 * pi * up) : 0.5 * up * up * (3.0 - up);
    model.velocity[e] = 1e-3 * shape * direction;
  }
  World w = make_world(config, model, {});
  const auto head = [&] {
    double sum = 0.0;
    int count = 0;
    for (std::size_t e = 0; e < model.position.size(); ++e) {
      if (model.position[e].z < 0.5 * height - 1e-6) continue;
      sum += dot(w.elements.state.data()[e].position - model.position[e], direction);
      ++count;
    }
    return sum / count;
  };
  double before = 0.0, at = 0.0;
  int crossings = 0;
  while (w.time < longest) {
    step(w);
    const double now = head();
    if (before * now < 0.0 && ++crossings == 2) {
      at = w.time - w.last_dt * now / (now - before);
      break;
    }
    before = now;
  }
  const EnergyBalance e = balance(w);
  EXPECT_LT(std::fabs(e.missing()), 1e-5 * e.start);
  EXPECT_EQ(crossings, 2);
  return at;
}

/// Along the axis a period is 4 l / sqrt(E / rho), which gives the modulus of this body; across it
/// Timoshenko's beam of that modulus. The clamped foot and the few grains across cost some per
/// cent.
TEST(LdpmBody, a_cantilever_swings_with_the_periods_of_beam_theory) {
  const double along = swing({0.0, 0.0, 1.0}, 1e-3);
  ASSERT_GT(along, 0.0);
  const double wave = 4.0 * height / along, modulus = density * wave * wave;
  EXPECT_NEAR(modulus / young, 1.0, 0.06);
  const double across = swing({1.0, 0.0, 0.0}, 4e-3);
  const double expected = first_period({height, width, modulus});
  RecordProperty("modulus_GPa", std::to_string(1e-9 * modulus));
  RecordProperty("period_over_beam", std::to_string(across / expected));
  EXPECT_NEAR(across / expected, 1.0, 0.04);
}

// --- Forces -------------------------------------------------------------------------------------

/// Whatever particles do, forces of facets neither push nor turn the whole.
TEST(LdpmBody, forces_and_torques_of_facets_have_no_sum) {
  const Config config = prism(0.04, 0.04);
  World w = make_world(config, build_model(config, ""), {});
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const double dt = 1e-9;
  for (int k = 0; k < 20; ++k) {
    for (ElementState& s : w.elements.state.host()) {
      const Vec3 way = 2e-6 * Vec3{normal(random), normal(random), normal(random)};
      s.position += way;
      s.velocity = (1.0 / dt) * way;
      s.spin = (2e-4 / dt) * Vec3{normal(random), normal(random), normal(random)};
    }
    w.last_dt = dt;
    evaluate_forces(w);
  }
  Vec3 force{}, torque{};
  double sizes = 0.0, turns = 0.0;
  for (Index e = 0; e < w.elements.size(); ++e) {
    const Vec3 f = w.elements.force.data()[e], t = w.elements.torque.data()[e];
    const Vec3 about = cross(w.elements.state.data()[e].position, f) + t;
    force += f, torque += about;
    sizes += norm(f), turns += norm(about);
  }
  EXPECT_GT(sizes, 1e3);
  EXPECT_LT(norm(force), 1e-12 * sizes);
  EXPECT_LT(norm(torque), 1e-12 * turns);
  double spent = 0.0;
  for (const double opened : w.ldpm.opened.host()) spent += opened;
  EXPECT_GT(spent, 0.0);  // facets have opened
}

// --- After an edge has parted --------------------------------------------------------------------

/// Pulled apart until all edges between have let go, and pushed together again. Contacts begin with
/// nothing, as links' do: no force comes or goes at once, and the ledger closes.
TEST(LdpmBody, halves_that_have_let_go_meet_again_and_no_energy_is_lost) {
  Config config = prism(0.03, 0.045);
  config.materials[0].ldpm.tensile_length = 0.1;
  config.supports = {end_face("foot", -1.0, -0.0224), end_face("head", 0.0224, 1.0)};
  constexpr double speed = 20.0, turn = 0.9e-3, touch = 1.9e-3;
  OverTime<Vec3>& path = config.supports[1].velocity;
  path.times = {0.0, 2e-5, turn - 2e-5, turn + 2e-5};
  path.values = {Vec3{}, Vec3{0.0, 0.0, speed}, Vec3{0.0, 0.0, speed}, Vec3{0.0, 0.0, -speed}};
  const Model model = build_model(config, "");
  World w = make_world(config, model, {});
  double between = 0.0, pressed = 0.0, worst = 0.0;
  Index released = 0;
  while (w.time < touch) {
    step(w);
    const double pull = probe(w, {"", "head", "force_z", "sum"});
    if (w.time > 0.8e-3 && w.time < turn) between = std::max(between, std::fabs(pull));
    if (w.time > turn) pressed = std::max(pressed, std::fabs(pull));
    if (w.step % 50 == 0) worst = std::max(worst, balance(w).error_relative);
  }
  for (const LdpmFrame& f : w.ldpm.frame.host())
    if (f.bond == ldpm_released) ++released;
  Index touching = 0;
  for (const ContactState& c : w.contacts.history.state.host())
    if (c.overlap > 0.0) ++touching;
  EXPECT_GT(released, 100);
  EXPECT_GT(touching, 0);
  EXPECT_GT(pressed, 100.0);
  EXPECT_LT(between, 0.2 * pressed);
  EXPECT_LT(worst, 2e-3);
}

}  // namespace ldpm_body_test
}  // namespace breccia::dem
