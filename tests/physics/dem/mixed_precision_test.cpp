// Losses of links that keep and do things in single precision. One rounding is a relative error
// of at most 2^-24 = 6e-8 to the nearest, 2^-23 by chance; n roundings of a history by chance are a
// walk of sqrt(n) such steps.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace dem_mixed_precision_test {

using testing::Momentum;
using testing::momentum;
using testing::Scene;
using testing::state;

constexpr double nearest = 0x1p-24, by_chance = 0x1p-23;
constexpr double some = 16 * nearest;  ///< a few operations, one after the other

/// Two spheres in touch, linked, each with all it does prescribed.
Scene held_pair(const Vec3& velocity) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0).softening = 5.0;
  s.sphere({0.0, 0.0, 0.0}, 0.01);
  s.sphere({0.02, 0.0, 0.0}, 0.01);
  s.link(0, 1);
  s.config.supports = {{"a", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0},
                       {"b", "", {0.019, -1.0, -1.0}, {0.021, 1.0, 1.0}, {"all"}, velocity, 0.0}};
  return s;
}

// To the nearest the link would not feel it at all: half its last bit is thirty times this step.
TEST(MixedPrecision, feels_a_load_that_grows_by_a_billionth_of_the_strength_a_step) {
  constexpr int steps = 400'000;
  constexpr double share = 1e-9;
  const World still = held_pair({}).world();
  const ConcreteLink& law = still.concrete.groups[0].law;
  const double kt = law.shear_ratio * still.concrete.stiffness.data()[0];
  const double strength = law.cohesion * pi * 1e-4, at_first = 0.6 * strength;
  const Vec3 velocity{0.0, share * strength / kt / still.next_dt, 0.0};
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    World w = held_pair(velocity).world(1, precision);
    const auto shear = [&] {
      return with_number(precision, [&](auto number) {
        return w.concrete.kept.as<decltype(number)>().shear.view()[0];
      });
    };
    with_number(precision, [&](auto number) {
      w.concrete.kept.as<decltype(number)>().shear.view().store(0, {0.0, -at_first, 0.0});
    });
    const double before = -shear().y;
    for (int i = 0; i < steps; ++i) step(w);
    ASSERT_EQ(w.last_dt, still.next_dt);
    // The last bit between 1/2 and 1 times a power of two is 2^-24 of it; up once in bit / step.
    const double bit = std::exp2(std::ceil(std::log2(before)) - 24.0), grown = share * strength;
    const double walk = std::sqrt(steps * grown * bit);
    const double error = precision == Precision::full ? steps * 0x1p-53 * strength : 5.0 * walk;
    EXPECT_LT(error, 0.1 * steps * grown);
    EXPECT_NEAR(-shear().y - before, steps * grown, error);
  }
}

// So does the opening of a link that is worn: to the nearest it would never break.
TEST(MixedPrecision, feels_wear_of_a_billionth_of_the_rupture_a_step) {
  constexpr int steps = 400'000;
  constexpr double share = 1e-9, wear = 0.5;
  const auto pair = [](const Vec3& velocity) {
    Scene s = held_pair(velocity);
    MaterialConfig& m = s.config.materials[0];
    m.cohesion = m.friction_angle = 0.0;  // all slip is plastic
    m.slip_wear = wear;
    return s;
  };
  const World still = pair({}).world();
  const double kn = still.concrete.stiffness.data()[0];
  const double rupture = still.concrete.groups[0].law.tensile_strength * pi * 1e-4 / kn * 6.0;
  const double at_first = 0.6 * rupture, grown = share * rupture;
  const Vec3 velocity{0.0, grown / wear / still.next_dt, 0.0};
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    World w = pair(velocity).world(1, precision);
    with_number(precision, [&](auto number) {
      using Number = decltype(number);
      w.concrete.kept.as<Number>().opening.data()[0] = static_cast<Number>(at_first);
    });
    const double before = link_opening(w.concrete, 0);
    for (int i = 0; i < steps; ++i) step(w);
    ASSERT_EQ(w.last_dt, still.next_dt);
    const double bit = std::exp2(std::ceil(std::log2(before)) - 24.0);
    const double walk = std::sqrt(steps * grown * bit);
    // the first step slips only with the mean of the speeds before and after it
    const double error =
        precision == Precision::full ? grown + steps * 0x1p-53 * rupture : 5.0 * walk;
    EXPECT_LT(error, 0.1 * steps * grown);
    EXPECT_NEAR(link_opening(w.concrete, 0) - before, steps * grown, error);
  }
}

/// A link pulled until it breaks.
struct Pulled {
  double peak = 0.0;      ///< largest force on its end  [N]
  double fracture = 0.0;  ///< energy spent  [J]
  double work = 0.0;      ///< put in by the ends  [J]
  double strength = 0.0, toughness = 0.0;
};
Pulled pulled_apart(Precision precision) {
  World w = held_pair({0.02, 0.0, 0.0}).world(1, precision);
  Pulled r;
  const ConcreteLink& law = w.concrete.groups[0].law;
  r.strength = law.tensile_strength * pi * 1e-4;
  r.toughness = 0.5 * r.strength * r.strength / w.concrete.stiffness.data()[0] * 6.0;
  while (link_opening(w.concrete, 0) >= 0.0) {
    step(w);
    r.peak = std::max(r.peak, -w.elements.force.data()[1].x);
  }
  const EnergyBalance e = balance(w);
  r.fracture = e.fracture;
  r.work = e.work;
  return r;
}
TEST(MixedPrecision, breaks_a_link_at_its_strength_and_energy) {
  const Pulled full = pulled_apart(Precision::full), mixed = pulled_apart(Precision::mixed);
  const Pulled single = pulled_apart(Precision::single);
  EXPECT_NEAR(full.peak, full.strength, 1e-2 * full.strength);  // by the length of a step
  EXPECT_NEAR(single.peak, full.peak, some * full.peak);
  EXPECT_NEAR(single.fracture, full.fracture, some * full.fracture);
  EXPECT_NEAR(single.work, full.work, some * full.work);
  EXPECT_NEAR(mixed.peak, full.peak, nearest * full.peak);
  EXPECT_EQ(mixed.fracture, full.fracture);
  EXPECT_NEAR(mixed.fracture, mixed.toughness, 1e-9 * mixed.toughness);
  EXPECT_NEAR(mixed.work, full.work, nearest * full.work);
}

TEST(MixedPrecision, bends_a_cantilever_as_double_does) {
  constexpr int links = 10, steps = 20'000;
  double stiffness[3];
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    Scene s;
    MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2500.0);
    m.tensile_strength = m.cohesion = 1e15;
    m.rolling_limit = 1e9;
    s.config.local_damping = 0.6;
    for (int i = 0; i <= links; ++i) {
      s.sphere({0.02 * i, 0.0, 0.0}, 0.01);
      if (i > 0) s.link(i - 1, i);
    }
    const double x = 0.02 * links;
    s.config.supports = {
        {"clamp", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0},
        {"tip", "", {x - 1e-3, -1.0, -1.0}, {x + 1e-3, 1.0, 1.0}, {"z"}, {0.0, 0.0, 0.01}, 0.0}};
    World w = s.world(1, precision);
    while (state(w, links).position.z < 1e-5 * x) step(w);
    w.motions.data()[0].velocity = {};
    for (int i = 0; i < steps; ++i) step(w);
    stiffness[static_cast<int>(precision)] =
        -w.elements.force.data()[links].z / state(w, links).position.z;
  }
  EXPECT_NEAR(stiffness[1] / stiffness[0], 1.0, std::sqrt(steps) * by_chance);
  EXPECT_NEAR(stiffness[2] / stiffness[0], 1.0, std::sqrt(steps) * by_chance);
}

/// A block of linked spheres that flies, turns and rings.
Scene block(int side, double speed) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0).softening = 5.0;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&](double scale) {
    return Vec3{scale * uniform(random), scale * uniform(random), scale * uniform(random)};
  };
  for (int i = 0; i < side * side * side; ++i)
    s.sphere(
        Vec3{0.02 * (i % side), 0.02 * (i / side % side), 0.02 * (i / side / side)} + draw(1e-3),
        0.009, draw(speed), draw(100.0 * speed));
  for (Index a = 0; a < s.model.size(); ++a)
    for (Index b = a + 1; b < s.model.size(); ++b)
      if (norm(s.model.position[static_cast<std::size_t>(b)] -
               s.model.position[static_cast<std::size_t>(a)]) < 0.0245)
        s.link(a, b);
  return s;
}

TEST(MixedPrecision, keeps_momentum_as_double_does_and_turns_by_roundings_only) {
  constexpr int steps = 4000;
  for (const Precision precision : {Precision::mixed, Precision::single}) {
    Scene s = block(6, 10.0);
    s.config.time.safety = 0.3;
    World w = s.world(1, precision);
    double scale = 0.0;
    for (Index e = 0; e < w.elements.size(); ++e)
      scale += w.elements.mass.data()[e] * norm(state(w, e).velocity);
    step(w);
    const Momentum start = momentum(w);
    double torques = 0.0;  // what all links together round, in a step, at most
    for (int i = 0; i < steps; ++i) {
      step(w);
      double sum = 0.0;
      for (const Vec3& f : w.elements.force.host()) sum += 0.02 * norm(f);
      torques = std::max(torques, w.last_dt * sum);
    }
    const Momentum end = momentum(w);
    EXPECT_GT(count(w).broken_of(LinkKind::concrete), 100);
    EXPECT_LT(norm(end.linear - start.linear), 1e-11 * scale);  // both ends get the same number
    EXPECT_LT(norm(end.angular - start.angular), steps * nearest * torques);
    EXPECT_GT(norm(end.angular - start.angular), 0.0);
  }
}

TEST(MixedPrecision, keeps_the_energy_of_an_elastic_block) {
  constexpr int steps = 20'000;
  double drift[3] = {};
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    Scene s = block(5, 0.01);
    s.config.time.safety = 0.1;
    s.config.materials[0].rolling_limit = 1e9;
    World w = s.world(1, precision);
    const double start = balance(w).start;
    for (int i = 0; i < steps; ++i) step(w);
    drift[static_cast<int>(precision)] = std::fabs(balance(w).missing()) / start;
  }
  EXPECT_LT(drift[0], 1e-5);
  EXPECT_LT(drift[1], drift[0] + std::sqrt(steps) * by_chance);
  EXPECT_LT(drift[2], drift[0] + std::sqrt(steps) * by_chance);
  RecordProperty("mixed", fmt::format("{:.3g}", drift[1]));
  RecordProperty("single", fmt::format("{:.3g}", drift[2]));
}

TEST(MixedPrecision, forces_of_a_breaking_slab_differ_by_less_than_3e_6_after_a_step) {
  const Config config =
      read_case<Config>(std::string(source_dir) + "/cases/rc_slab/small.toml", {});
  World full = make_world(config, build_model(config, ""), {});
  for (int i = 0; i < 600; ++i) step(full);
  ASSERT_GT(count(full).broken_of(LinkKind::concrete), 1000);
  for (const Precision precision : {Precision::mixed, Precision::single}) {
    World mixed = full;
    mixed.exec.precision = mixed.concrete.precision = precision;
    const LinkHistory<double>& kept = full.concrete.kept.in_double;
    LinkHistory<float>& rounded = mixed.concrete.kept.in_single;
    mixed.concrete.kept.in_double = LinkHistory<double>();
    rounded.opening.resize(kept.opening.size());
    rounded.shear.resize(kept.opening.size());
    rounded.moment.resize(kept.opening.size());
    for (Index i = 0; i < kept.opening.size(); ++i) {
      rounded.opening.data()[i] = static_cast<float>(kept.opening.data()[i]);
      rounded.shear.view().store(i, kept.shear.view()[i]);
      rounded.moment.view().store(i, kept.moment.view()[i]);
    }
    World after = full;
    step(after);
    step(mixed);
    std::vector<double> errors;
    for (Index e = 0; e < after.elements.size(); ++e) {
      const Vec3 f = after.elements.force.data()[e];
      if (norm(f) > 0.0) errors.push_back(norm(mixed.elements.force.data()[e] - f) / norm(f));
    }
    std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                     errors.end());
    const double median = errors[errors.size() / 2];
    EXPECT_LT(median, 3e-6);
    EXPECT_GT(median, 1e-9);
    RecordProperty(word_of(precision), fmt::format("{:.3g}", median));
  }
}

}  // namespace dem_mixed_precision_test
}  // namespace breccia::dem
