// Bounds of a cohesive link under pressure: compaction, crushing after rupture, bounded moments,
// wear by slip and turn.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "dem/laws/concrete_link.hpp"
#include "dem/setup/materials.hpp"
#include "pair_driver.hpp"

namespace breccia::dem {
namespace confined_link_test {

using testing::Pair;

constexpr double first_length = 0.026, touching = 0.02, stiffness = 2e8, area = 3e-4;
constexpr double modulus = stiffness * first_length / area;  // K = K_n D_0 / S
constexpr double tension = 1.8e6, cohesion = 11e6, zeta = 10.0, eta = 2.0, cap = 2e6;
constexpr double onset = tension * area / stiffness, rupture = (1.0 + zeta) * onset;  // u_1, u_2
constexpr double compaction = 60e6, crushing = 10e6, slope = 0.4;                     // Y, H

ConcreteLink confined_law() {
  ConcreteLink law{};
  law.tensile_strength = tension;
  law.cohesion = cohesion;
  law.softening = zeta;
  law.friction = 0.176;
  law.broken_friction = 0.25;
  law.shear_ratio = 0.18;
  law.rolling_ratio = 1.0;
  law.rolling_limit = eta;
  law.broken_rolling_limit = 0.05;
  law.rolling_cap = cap;
  law.modulus = modulus;
  law.compaction_strength = compaction;
  law.compaction_slope = slope;
  law.crushing_strength = crushing;
  law.crushing_slope = slope;
  return law;
}

struct ConcretePart {
  ConcreteParts bit;
  void (*give)(ConcreteLink&);
};
std::vector<ConcretePart> concrete_part_list() {
  return {{concrete_compacts, [](ConcreteLink& l) { l.compaction_strength = 1.0; }},
          {concrete_compacts, [](ConcreteLink& l) { l.crushing_strength = 1.0; }},
          {concrete_wears, [](ConcreteLink& l) { l.slip_wear = 0.1; }},
          {concrete_wears, [](ConcreteLink& l) { l.turn_wear = 0.1; }},
          {concrete_caps_friction, [](ConcreteLink& l) { l.friction_cap = 1.0; }},
          {concrete_caps_rolling, [](ConcreteLink& l) { l.rolling_cap = 1.0; }},
          {concrete_is_hyperbolic, [](ConcreteLink& l) { l.hyperbolic = 1.0; }},
          {concrete_knee,
           [](ConcreteLink& l) {
             l.knee = {1.0, 1.0, 0.5};
           }},
          {concrete_rated, [](ConcreteLink& l) { l.rate.exponent = 0.02; }},
          {concrete_damps, [](ConcreteLink& l) { l.damping.share = 0.1; }}};
}

/// A link whose ends are moved, with the work done on it and the energy it has spent.
struct Rig {
  ConcreteLink law = confined_law();
  LinkConstants<double> link{first_length, stiffness, area, 0.5 * touching, touching};
  LinkState<double> state{};
  Pair pair;
  LinkResponse<double> last{};
  double work = 0.0, yielded = 0.0, spent = 0.0;

  Rig() { pair.b.position.x = first_length; }

  double distance() const { return norm(pair.b.position - pair.a.position); }
  void take(const PairMotion<double>& m) {
    const LinkResponse<double> r = law.response(link, m, state);
    link.length -= r.shortened;
    work += 0.5 * (last.normal + r.normal) * m.extension - 0.5 * dot(last.shear + r.shear, m.slip) -
            0.5 * dot(last.moment + r.moment, m.turn);
    yielded += r.yielded;
    spent += r.slid + r.yielded + r.broke;
    last = r;
  }
  void move(double to, int steps) {
    const double each = (to - distance()) / steps / pair.dt;
    for (int i = 0; i < steps; ++i) take(pair.move_b({each, 0.0, 0.0}));
  }
  /// One step of slip at the contact point, the centres at rest: spins about z, equal on both ends.
  void slide(double slip) {
    const double spin = -slip / pair.dt / distance();
    take(pair.step({}, {0.0, 0.0, spin}, {}, {0.0, 0.0, spin}));
  }
  void turn(double angle) { take(pair.move_b({}, {angle / pair.dt, 0.0, 0.0})); }
  bool intact() const { return state.opening >= 0.0; }
  /// Stored and spent, as the ledger adds up.
  double held() const {
    const double fracture = intact() ? law.tension(link).spent(state.opening) : 0.0;
    return law.stored(link, distance() - link.length, state) + spent + fracture;
  }
};

TEST(ConfinedLink, yields_under_pressure_along_a_line_and_keeps_its_shortening) {
  const double at_yield = compaction * area / stiffness, beyond = 2.0 * at_yield;
  const double limit = area * compaction + slope * stiffness * beyond;
  const double area_under =
      (1.0 - slope) * (area * compaction * beyond + 0.5 * slope * stiffness * beyond * beyond);
  for (const int steps : {300, 3'000}) {
    Rig rig;
    rig.move(first_length - 0.5 * at_yield, steps);
    EXPECT_EQ(rig.link.length, first_length);
    rig.move(first_length - at_yield - beyond, steps);
    EXPECT_NEAR(rig.last.normal, -limit, 1e-9 * limit);
    EXPECT_NEAR(first_length - rig.link.length, (1.0 - slope) * beyond, 1e-9 * beyond);
    EXPECT_NEAR(rig.yielded, area_under, 2.0 * area_under / steps);
    EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
    // Unloading and reloading are elastic, and yielding goes on where it was left.
    const double shortened = rig.link.length, spent = rig.yielded;
    rig.move(shortened, steps);
    EXPECT_NEAR(rig.last.normal, 0.0, 1e-9 * limit);
    rig.move(first_length - at_yield - beyond, steps);
    EXPECT_NEAR(rig.last.normal, -limit, 1e-9 * limit);
    EXPECT_NEAR(rig.link.length, shortened, 1e-12 * first_length);
    EXPECT_NEAR(rig.yielded, spent, 1e-9 * spent);
    rig.move(rig.distance() - 1e-6, steps);
    EXPECT_NEAR(rig.last.normal, -limit - slope * stiffness * 1e-6, 1e-9 * limit);
    EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
  }
}

TEST(ConfinedLink, is_elastic_again_once_its_pores_are_closed) {
  const double closing = 0.01, shortest = (1.0 - closing) * first_length;
  const double closed =
      area * compaction + slope / (1.0 - slope) * stiffness * closing * first_length;
  for (const int steps : {300, 3'000}) {
    Rig rig;
    rig.law.closing_strain = closing;
    rig.move(shortest - closed / stiffness, steps);
    EXPECT_NEAR(rig.last.normal, -closed, 1e-9 * closed);
    EXPECT_NEAR(rig.link.length, shortest, 1e-12 * first_length);
    const double spent = rig.yielded;
    rig.move(shortest - 2.0 * closed / stiffness, steps);
    EXPECT_NEAR(rig.last.normal, -2.0 * closed, 1e-9 * closed);
    EXPECT_NEAR(rig.link.length, shortest, 1e-12 * first_length);
    EXPECT_NEAR(rig.yielded, spent, 1e-9 * spent);
    EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
    rig.move(shortest, steps);
    EXPECT_NEAR(rig.last.normal, 0.0, 1e-9 * closed);
    EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
  }
}

TEST(ConfinedLink, pressed_across_its_closing_in_one_step_loses_no_energy) {
  Rig rig;
  rig.law.closing_strain = 0.002;
  const double to = first_length - 3.0 * compaction * area / stiffness - 0.01 * first_length;
  rig.move(to, 7);
  EXPECT_NEAR(rig.link.length, 0.998 * first_length, 1e-12 * first_length);
  EXPECT_NEAR(rig.last.normal, stiffness * (to - rig.link.length), 1e-9 * stiffness * first_length);
  EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
}

TEST(ConfinedLink, friction_bears_no_more_than_its_bound) {
  const double bound = 3e6;
  for (const double pressure : {10e6, 40e6})
    for (const auto& [brittle, fades] :
         {std::pair{false, 0.0}, {true, 0.0}, {false, 1.0}, {true, 1.0}}) {
      Rig rig;
      rig.law.friction_cap = bound;
      rig.law.friction_fades = fades;
      rig.law.brittle_shear = brittle ? 1.0 : 0.0;
      rig.law.crushing_strength = 0.0;
      rig.move(first_length - pressure * area / stiffness, 100);
      const double slip = (cohesion + 0.25 * pressure) * area / (0.18 * stiffness);
      for (int i = 0; i < 2000; ++i) rig.slide(slip / 1000);
      EXPECT_EQ(rig.intact(), !brittle);
      const auto friction = [&](double f) {
        return fades > 0.0 ? f * bound / (f + bound) : std::min(f, bound);
      };
      const double whole = cohesion + friction(0.176 * pressure), left = friction(0.25 * pressure);
      EXPECT_NEAR(norm(rig.last.shear), (brittle ? left : whole) * area, 1e-6 * whole * area);
      EXPECT_NEAR(rig.held(), rig.work, 1e-9 * rig.work);
    }
}

TEST(ConfinedLink, broken_under_pressure_falls_to_the_crushed_strength_and_pays_for_it) {
  for (const int steps : {500, 5'000}) {
    Rig rig;
    rig.law.brittle_shear = 1.0;
    const double pressed = 40e6 * area, peak = cohesion * area + 0.176 * pressed;
    rig.move(first_length - pressed / stiffness, steps);
    EXPECT_NEAR(rig.last.normal, -pressed, 1e-9 * pressed);
    const double slip = peak / (0.18 * stiffness);
    for (int i = 0; rig.intact() && i < 2 * steps; ++i) rig.slide(slip / steps);
    ASSERT_FALSE(rig.intact());
    EXPECT_NEAR(rig.last.normal, -pressed, 1e-9 * pressed);
    EXPECT_EQ(rig.yielded, 0.0);

    rig.slide(0.0);
    const double crushed = crushing * area + slope * (pressed - crushing * area);
    EXPECT_NEAR(rig.last.normal, -crushed, 1e-9 * pressed);
    EXPECT_NEAR(rig.yielded, 0.5 * (pressed * pressed - crushed * crushed) / stiffness,
                1e-9 * rig.work);
    EXPECT_NEAR(rig.held(), rig.work, 1e-3 * rig.work);
    rig.slide(0.0);
    EXPECT_NEAR(rig.last.normal, -crushed, 1e-9 * pressed) << "it has yielded once";

    // Pressed on, it shortens until its ends touch; then it is as strong as an intact one.
    const double before = rig.last.normal;
    rig.move(rig.distance() - 1e-4, steps);
    EXPECT_NEAR(rig.last.normal, before - slope * stiffness * 1e-4, 1e-9 * pressed);
    while (rig.link.length > touching) rig.move(rig.distance() - 1e-4, steps / 100);
    EXPECT_NEAR(rig.link.length, touching, 1e-4);
    const double touches = rig.last.normal;
    rig.move(rig.distance() - 1e-6, 1);
    EXPECT_NEAR(rig.last.normal, touches - stiffness * 1e-6, 1e-9 * pressed);
    EXPECT_NEAR(rig.held(), rig.work, 1e-3 * rig.work);
  }
}

TEST(ConfinedLink, without_a_strength_of_its_kind_it_never_yields) {
  Rig whole;
  whole.law.compaction_strength = 0.0;
  whole.move(first_length - 1e-3, 100);
  EXPECT_NEAR(whole.last.normal, -stiffness * 1e-3, 1e-9 * stiffness * 1e-3);
  Rig broken;
  broken.law.crushing_strength = 0.0;
  broken.state.opening = link_broken;
  broken.move(first_length - 1e-3, 100);
  EXPECT_NEAR(broken.last.normal, -stiffness * 1e-3, 1e-9 * stiffness * 1e-3);
}

/// So stiff in shear that the elastic slip, which is set free as cohesion falls, does not run ahead
/// of the slip that is asked for.
Rig worn_by_slip() {
  Rig rig;
  rig.law.shear_ratio = 10.0;
  rig.law.slip_wear = 0.3;
  return rig;
}

TEST(ConfinedLink, is_worn_to_rupture_by_plastic_slip) {
  for (const double stretch : {-1e-5, 0.5 * onset}) {
    for (const int steps : {1'000, 10'000}) {
      Rig rig = worn_by_slip();
      rig.move(first_length + stretch, steps);
      const double each = rupture / 0.3 / steps, kt = 10.0 * stiffness;
      const double pressure = stretch < 0.0 ? -stiffness * stretch : 0.0;
      double slip = 0.0;
      while (rig.intact() && slip < 10.0 * rupture / 0.3) {
        rig.slide(each);
        slip += each;
        ASSERT_NEAR(rig.held(), rig.work, 2.0 * cohesion * area * each) << slip;
      }
      // Plastic slip is what was asked for, less the elastic slip that friction holds at the end.
      const double from = std::max(0.0, stretch);  // the opening before wear
      EXPECT_NEAR(slip, (rupture - from) / 0.3 + 0.176 * pressure / kt, 3.0 * each) << stretch;
      for (int i = 0; i < 100; ++i) rig.slide(each);
      EXPECT_NEAR(norm(rig.last.shear), 0.25 * pressure, 1e-6 * cohesion * area) << stretch;
    }
  }
}

TEST(ConfinedLink, is_worn_to_rupture_by_plastic_turn) {
  Rig rig;
  rig.law.turn_wear = 0.1;
  const double radius = 0.5 * touching, each = 2.0 * rupture / 0.1 / radius / 10'000;
  double angle = 0.0, most = 0.0;
  while (rig.intact() && angle < 100.0 * rupture / radius) {
    rig.turn(each);
    angle += each;
    most = std::max(most, rig.work);
    ASSERT_NEAR(rig.held(), rig.work, 5e-4 * most + 1e-12);
  }
  EXPECT_NEAR(angle, rupture / 0.1 / radius, 3.0 * each);  // an unloaded link: nothing is left
  rig.turn(each);
  EXPECT_EQ(norm(rig.last.moment), 0.0);
}

TEST(ConfinedLink, that_is_brittle_wears_without_making_energy) {
  Rig rig = worn_by_slip();
  rig.law.softening = 0.0;
  rig.move(first_length - 1e-5, 10);
  for (int i = 0; i < 5'000; ++i) {
    rig.slide(5e-3 * onset);
    ASSERT_NEAR(rig.held(), rig.work, 5e-3 * rig.work) << i;
  }
  EXPECT_FALSE(rig.intact());
}

TEST(ConfinedLink, bears_no_more_moment_than_its_cap_allows) {
  const double radius = 0.5 * touching;
  Rig rig;
  const auto limit = [&] {
    for (int i = 0; i < 100; ++i) rig.turn(1e-3);
    return norm(rig.last.moment);
  };
  const double unloaded = eta * radius * tension * area;
  EXPECT_NEAR(limit(), unloaded, 1e-9 * unloaded);  // T is below the cap
  const double capped = eta * radius * cap * area;
  for (const double stress : {5e6, 50e6}) {
    rig.move(first_length - stress * area / stiffness, 10);
    EXPECT_NEAR(limit(), capped, 1e-9 * capped) << stress;
  }
  rig.state.opening = link_broken;
  rig.law.crushing_strength = 0.0;
  EXPECT_NEAR(limit(), 0.05 * radius * cap * area, 1e-9 * capped);
  rig.move(first_length - 1e6 * area / stiffness, 10);
  EXPECT_NEAR(limit(), 0.05 * radius * 1e6 * area, 1e-9 * capped);
}

TEST(ConfinedLink, a_random_path_puts_in_what_is_stored_or_spent) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Rig rig;
    rig.law.slip_wear = 0.3;
    rig.law.turn_wear = 0.1;
    rig.law.compaction_strength = 2e6;
    rig.law.crushing_strength = 1e6;
    if (seed > 1) rig.law.knee = {0.8 / 0.1, 0.2 / 0.9, 0.2 + 0.1};  // softening along two lines
    double most = 0.0;
    Vec3 velocity{}, spin{};
    for (int i = 0; i < 60'000; ++i) {
      if (i % 300 == 0) {
        velocity = 0.01 * Vec3{normal(random), normal(random), normal(random)} +
                   0.3 / (first_length * 60.0) *
                       (Vec3{0.9998 * first_length, 0.0, 0.0} - rig.pair.b.position);
        spin = {normal(random), normal(random), normal(random)};
      }
      rig.take(rig.pair.move_b(velocity, spin));
      most = std::max(most, rig.held());
      ASSERT_NEAR(rig.work, rig.held(), 0.01 * most + 1e-9) << "seed " << seed << ", step " << i;
    }
    EXPECT_GT(rig.spent, 0.0);
    EXPECT_LT(rig.link.length, first_length);
    EXPECT_FALSE(rig.intact());
  }
}

TEST(ConfinedLink, of_a_kernel_for_its_parts_alone_has_the_bits_of_the_whole_law) {
  ConcreteLink law = confined_law();
  law.slip_wear = 0.3;
  law.turn_wear = 0.1;
  ASSERT_EQ(law.parts(), concrete_bounded);
  ConcreteLink plain = law;
  plain.compaction_strength = plain.crushing_strength = plain.rolling_cap = 0.0;
  plain.slip_wear = plain.turn_wear = 0.0;
  ASSERT_EQ(plain.parts(), ConcreteParts{0});
  for (const ConcretePart& part : concrete_part_list()) {
    ConcreteLink one = plain;
    part.give(one);
    EXPECT_EQ(one.parts(), part.bit);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int broken = 0, worn = 0;
  for (int link = 0; link < 200; ++link) {
    Rig whole, lean;
    whole.law = lean.law = law;
    LinkConstants<double> lean_link = lean.link;
    LinkState<double> lean_state{};
    for (int step = 0; step < 60; ++step) {
      const PairMotion<double> motion =
          whole.pair.move_b({20.0 * any(random), 5.0 * any(random), 5.0 * any(random)},
                            {500.0 * any(random), 500.0 * any(random), 500.0 * any(random)});
      const double length = whole.link.length;
      whole.take(motion);
      const LinkResponse<double> r = law.response<concrete_bounded>(lean_link, motion, lean_state);
      lean_link.length -= r.shortened;
      ASSERT_EQ(r.normal, whole.last.normal);
      ASSERT_EQ(r.shear.y, whole.last.shear.y);
      ASSERT_EQ(r.moment.x, whole.last.moment.x);
      ASSERT_EQ(r.broke, whole.last.broke);
      ASSERT_EQ(r.yielded, whole.last.yielded);
      ASSERT_EQ(lean_state.opening, whole.state.opening);
      worn += whole.link.length < length ? 1 : 0;
    }
    broken += whole.state.opening < 0.0 ? 1 : 0;
  }
  EXPECT_GT(broken, 20);
  EXPECT_GT(worn, 20);
}

TEST(ConfinedLink, of_a_material_without_these_keys_has_none_of_these_bounds) {
  MaterialConfig m;
  m.rolling_limit = 0.13;
  ContactConfig contact;
  contact.friction = 0.37;
  ConcreteLink law = concrete_law(m, contact);
  EXPECT_EQ(law.broken_friction, 0.37);
  EXPECT_EQ(law.broken_rolling_limit, 0.13);
  EXPECT_EQ(law.rolling_cap, 0.0);
  EXPECT_EQ(law.friction_cap, 0.0);
  EXPECT_EQ(law.compaction_strength, 0.0);
  EXPECT_EQ(law.crushing_strength, 0.0);
  EXPECT_EQ(law.closing_strain, 0.0);
  EXPECT_FALSE(law.wears());
  m.broken_friction = 0.0;
  m.broken_rolling_limit = 0.0;
  law = concrete_law(m, contact);
  EXPECT_EQ(law.broken_friction, 0.0);
  EXPECT_EQ(law.broken_rolling_limit, 0.0);
}

}  // namespace confined_link_test
}  // namespace breccia::dem
