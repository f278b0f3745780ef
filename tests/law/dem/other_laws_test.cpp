// Steel links, steel-concrete bonds, contacts: against closed answers.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dem/laws/contact.hpp"
#include "dem/laws/interface_link.hpp"
#include "dem/laws/steel_link.hpp"
#include "dem/setup/materials.hpp"
#include "dem/setup/restitution.hpp"
#include "math/constants.hpp"
#include "pair_driver.hpp"
#include "run/case_keys.hpp"

namespace breccia::dem {
namespace other_laws_test {

using testing::Pair;

constexpr double length = 0.02, radius = 0.004;
const SteelLink steel{200e9, 200e9 / 2.6, 500e6, 2e9, 0.08};
const double area = pi * radius * radius;

/// Pulls to a stretch at the given rate of strain and back n times; returns the work done on the
/// link.
double pull(SteelState& state, Pair& pair, double stretch, int steps, double* spent = nullptr) {
  const double from = norm(pair.b.position - pair.a.position) - length;
  SteelState probe = state;
  double before = steel.response(length, radius, pair.move_b({}), probe).normal, work = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double each = (stretch - from) / steps;
    const SteelResponse r =
        steel.response(length, radius, pair.move_b({each / pair.dt, 0.0, 0.0}), state);
    work += 0.5 * (before + r.normal) * each;
    before = r.normal;
    if (spent != nullptr) *spent += r.yielded + r.broke;
  }
  return work;
}

TEST(SteelLink, its_stiffnesses_are_those_of_a_beam) {
  const SteelLink::Stiffness k = steel.stiffness(length, radius);
  const double second = pi * std::pow(radius, 4) / 4.0;
  EXPECT_NEAR(k.axial, 200e9 * area / length, 1e-9 * k.axial);
  EXPECT_NEAR(k.bending, 200e9 * second / length, 1e-9 * k.bending);
  EXPECT_NEAR(k.twist, steel.shear_modulus * 2.0 * second / length, 1e-9 * k.twist);
  const double phi = 12.0 * 200e9 * second / (0.9 * steel.shear_modulus * area * length * length);
  EXPECT_NEAR(k.shear, 12.0 * 200e9 * second / std::pow(length, 3) / (1.0 + phi), 1e-9 * k.shear);
}

TEST(SteelLink, it_yields_hardens_and_unloads_elastically) {
  SteelState state{};
  Pair pair;
  pull(state, pair, 0.02 * length, 2'000);
  const double tangent = 200e9 * 2e9 / 202e9;
  const double peak = 500e6 + tangent * (0.02 - 0.0025);
  SteelState probe = state;
  EXPECT_NEAR(steel.response(length, radius, pair.move_b({}), probe).normal, area * peak,
              1e-6 * area * peak);
  EXPECT_NEAR(state.hardening, (peak - 500e6) / 2e9, 1e-9);
  pull(state, pair, (0.02 - peak / 200e9) * length, 500);
  EXPECT_NEAR(steel.response(length, radius, pair.move_b({}), state).normal, 0.0,
              1e-6 * area * peak);
}

TEST(SteelLink, a_perfectly_plastic_cycle_costs_two_yield_forces_times_the_plastic_path) {
  const SteelLink perfect{200e9, 77e9, 500e6, 0.0, 10.0};
  SteelState state{};
  Pair pair;
  double spent = 0.0;
  const auto go = [&](double stretch) {
    const double from = norm(pair.b.position - pair.a.position) - length;
    for (int i = 0; i < 4'000; ++i)
      spent += perfect
                   .response(length, radius,
                             pair.move_b({(stretch - from) / 4'000 / pair.dt, 0.0, 0.0}), state)
                   .yielded;
  };
  go(0.01 * length);
  spent = 0.0;
  go(-0.01 * length);
  // half a cycle: path 0.02 L less twice the elastic part
  EXPECT_NEAR(spent, 500e6 * area * (0.02 - 2.0 * 0.0025) * length, 1e-3 * spent);
}

TEST(SteelLink, it_ruptures_at_its_failure_strain_and_then_only_bears_compression) {
  SteelState state{};
  Pair pair;
  double spent = 0.0;
  const double work = pull(state, pair, 0.1 * length, 20'000, &spent);
  EXPECT_EQ(state.hardening, steel_ruptured);
  EXPECT_NEAR(work, spent, 1e-3 * work);
  EXPECT_EQ(steel.response(length, radius, pair.move_b({}), state).normal, 0.0);
  pair.b.position.x = 0.99 * length;
  EXPECT_LT(steel.response(length, radius, pair.move_b({}), state).normal, 0.0);
}

/// EN 1992-1-1, annex C: B500B bears 1.08 times its yield stress at 5 %; EN 10025-2: S355 470 MPa
/// at 22 %.
TEST(SteelLink, of_the_library_yields_hardens_and_ruptures_as_its_source_says) {
  struct Source {
    const char* name;
    double young, yield, strength, strain;
  };
  for (const Source& source : {Source{"B500B", 200e9, 500e6, 1.08 * 500e6, 0.05},
                               Source{"S355", 210e9, 355e6, 470e6, 0.22}}) {
    const CaseText text{std::string("breccia = 1\nmethod = \"dem3d\"\n[time]\nend = 1.0\n"
                                    "[material.m]\nuse = \"") +
                            source.name + "\"\n",
                        "case.toml"};
    const SteelLink link = steel_law(read_case<Config>(text, {}).materials[0]);
    SteelState state{};
    Pair pair;
    double before = 0.0, largest = 0.0, at = 0.0, kink = 0.0;
    constexpr double each = 1e-5;  // of strain
    for (int i = 1; state.hardening != steel_ruptured && i < 40'000; ++i) {
      const double stress =
          link.response(length, radius, pair.move_b({each * length / pair.dt, 0.0, 0.0}), state)
              .normal /
          area;
      if (i == 50) {
        EXPECT_NEAR(stress, source.young * 50 * each, 1e-6 * stress) << source.name;
      }
      if (kink == 0.0 && stress - before < 0.5 * source.young * each) kink = before;
      if (stress > largest) {
        largest = stress;
        at = i * each;
      }
      before = stress;
    }
    EXPECT_EQ(state.hardening, steel_ruptured) << source.name;
    EXPECT_NEAR(kink, source.yield, source.young * each) << source.name;
    EXPECT_NEAR(largest, source.strength, 0.005 * source.strength) << source.name;
    EXPECT_NEAR(at, source.strain, 0.06 * source.strain) << source.name;
  }
}

TEST(SteelLink, a_plastic_hinge_limits_the_bending_moment) {
  SteelState state{};
  Pair pair;
  SteelResponse r{};
  for (int i = 0; i < 1'000; ++i)
    r = steel.response(length, radius, pair.move_b({}, {0.0, 0.0, 1e-3 / pair.dt}), state);
  EXPECT_NEAR(norm(r.moment), 500e6 * std::pow(2.0 * radius, 3) / 6.0, 1e-3 * norm(r.moment));
}

MaterialConfig bond_material(const char* kind) {
  MaterialConfig m;
  m.law = "interface";
  m.bond = kind;
  return m;
}

TEST(BondSlip, it_follows_the_curve_of_the_model_code) {
  const BondSlip bond = interface_law(bond_material("mc90"), {}).bond;
  for (const double mm : {0.05, 0.1, 0.2, 0.5, 0.9, 1.0, 2.0, 3.0, 4.0, 6.0, 7.9, 8.0, 10.0}) {
    const double s = mm * 1e-3;
    const double expected = s <= 1e-3   ? 13.7e6 * std::pow(s / 1e-3, 0.4)
                            : s <= 3e-3 ? 13.7e6
                            : s < 8e-3  ? 13.7e6 - (13.7e6 - 5.5e6) * (s - 3e-3) / 5e-3
                                        : 5.5e6;
    EXPECT_NEAR(bond.stress(s), expected, 3e-3 * expected) << mm << " mm";
  }
  const BondSlip plain = interface_law(bond_material("plastic"), {}).bond;
  EXPECT_EQ(plain.stress(0.0), 13.7e6);
  EXPECT_EQ(plain.stress(1.0), 13.7e6);
}

TEST(InterfaceLink, pulling_the_bar_out_meets_the_bond_stress_on_its_surface) {
  const InterfaceLink law = interface_law(bond_material("mc90"), {});
  const double share = pi * 2.0 * radius * 0.0357 / 5.0;  // S of one of five links
  InterfaceState state{};
  Pair pair;
  pair.a.position = {0.0, 0.0, 0.0};
  pair.b.position = {0.0, 0.014, 0.0};
  pair.excess = -0.006;
  double slip = 0.0, spent = 0.0, work = 0.0, before = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    // the bar's element moves along its axis x; b is kept beside it
    const PairMotion<double> m = pair.step({-0.2, 0.0, 0.0}, {}, {}, {});
    pair.a.position.x = 0.0;  // the chord's turn is not what is looked at
    const InterfaceResponse r =
        law.response(30e9 * share / 0.014, share, 0.014, {1.0, 0.0, 0.0}, m, 0.0, state);
    slip += 0.2 * pair.dt;
    spent += r.slid;
    work -= 0.5 * (before + r.force.x) * 0.2 * pair.dt;
    before = r.force.x;
    if (slip > 2e-5) {
      ASSERT_NEAR(-r.force.x, share * law.bond.stress(slip), 1e-2 * share * 13.7e6);
    }
  }
  const double stored = law.stored(30e9 * share / 0.014, share, state);
  EXPECT_NEAR(work, spent + stored, 1e-3 * work);
}

/// A bond whose bar is first drawn away from the concrete to a gap, then along its axis.
struct Parted {
  double broke = 0.0, along = 0.0, work = 0.0, spent = 0.0, stored = 0.0, slip = 0.0;
  Parted(const InterfaceLink& law, double share, double gap) {
    const double stiffness = 30e9 * share / 0.014;
    const Vec3 axis{1.0, 0.0, 0.0};
    InterfaceState state{};
    Vec3 before{};
    const auto move = [&](const Vec3& by) {  // of b against a; places stay, so that no axis turns
      PairMotion<double> m{};
      m.normal = {0.0, 1.0, 0.0};
      m.distance = 0.014;
      m.slip = {by.x, 0.0, by.z};
      const InterfaceResponse r = law.response(stiffness, share, 0.014, axis, m, by.y, state);
      broke += r.broke;
      spent += r.slid;
      work -= 0.5 * dot(before + r.force, by);
      before = r.force;
    };
    constexpr int steps = 40'000;
    for (int i = 0; i < steps; ++i) move({0.0, gap / steps, 0.0});
    for (int i = 0; i < steps; ++i) move({2e-3 / steps, 0.0, 0.0});
    along = -before.x;
    slip = 2e-3;
    stored = law.stored(stiffness, share, state);
  }
};

TEST(InterfaceLink, ribs_keep_the_share_of_the_bond_that_is_still_in_the_concrete) {
  MaterialConfig m = bond_material("mc90");
  m.tensile_strength = 2.2e6;
  m.fracture_energy = 100.0;
  const double share = pi * 2.0 * radius * 0.0357 / 5.0;
  const double last = 2.0 * 100.0 / 2.2e6;  // u_2 = 91 um
  EXPECT_NEAR(interface_law(m, {}).rupture_opening, last, 1e-12);
  for (const double height : {0.0, 1e-3}) {
    m.rib_height = height;
    const InterfaceLink law = interface_law(m, {});
    for (const double gap : {0.1e-3, 0.25e-3, 0.75e-3, 1.1e-3}) {
      const Parted bond(law, share, gap);
      const double kept = height > 0.0 ? std::max(0.0, 1.0 - gap / height) : 0.0;
      EXPECT_NEAR(bond.along, kept * share * 13.7e6, 1e-3 * share * 13.7e6) << height << " " << gap;
      EXPECT_NEAR(bond.broke, share * 100.0, 1e-9) << "energy of a crack along the bar";
      EXPECT_NEAR(bond.work, bond.spent + bond.stored + bond.broke, 1e-3 * bond.work);
    }
  }
}

TEST(Restitution, the_dashpots_that_cannot_pull_have_the_known_ratios) {
  const std::pair<double, double> known[] = {{0.2, 0.667474}, {0.4, 0.323607}, {0.5, 0.233028},
                                             {0.6, 0.165098}, {0.8, 0.067877}, {0.9, 0.031280},
                                             {0.98, 0.005895}};
  for (const auto& [e, ratio] : known)
    EXPECT_NEAR(damping_ratio_hertz(e), ratio, 2e-4 * (1.0 + ratio)) << e;
  EXPECT_EQ(damping_ratio_hertz(1.0), 0.0);
  // Linear, force-free end: e = exp(-xi (pi - atan2(2 xi w, 2 xi^2 - 1 ... )) / w) with w = sqrt(1
  // - xi^2)
  for (const double e : {0.3, 0.5, 0.7, 0.9}) {
    const double xi = damping_ratio_linear(e), w = std::sqrt(1.0 - xi * xi);
    const double end =
        std::atan2(2.0 * xi * w, 2.0 * xi * xi - 1.0);  // phase at which the push is over
    EXPECT_NEAR(std::exp(-xi / w * end), e, 1e-3) << e;
  }
}

const ContactPair glass{26.0e9, 9.0e9};
const ContactLaw::Pair spheres{0.005, 0.01, 0.02, 0.01, 0.01};

TEST(Contact, hertz_force_and_stiffnesses_are_those_of_the_book) {
  const ContactLaw law{true, 0.3, 0.0, 0.0, 0.0};
  ContactState state{};
  Pair pair;
  const double overlap = 1e-5;
  const ContactResponse r = law.response(glass, spheres, overlap, 0.0, pair.move_b({}), state);
  EXPECT_NEAR(r.pressure, 4.0 / 3.0 * 26e9 * std::sqrt(0.005) * std::pow(overlap, 1.5),
              1e-9 * r.pressure);
  EXPECT_NEAR(r.normal_stiffness, 2.0 * 26e9 * std::sqrt(0.005 * overlap),
              1e-9 * r.normal_stiffness);
  EXPECT_NEAR(r.shear_stiffness, 8.0 * 9e9 * std::sqrt(0.005 * overlap), 1e-9 * r.shear_stiffness);
  EXPECT_NEAR(law.stored_normal(glass, spheres, overlap), 0.4 * r.pressure * overlap,
              1e-9 * r.pressure * overlap);
}

TEST(Contact, friction_never_exceeds_coulomb_and_its_work_is_booked) {
  const ContactLaw law{false, 0.3, 0.0, 1.0, 0.1};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ContactState state{};
  Pair pair;
  double slid = 0.0;
  for (int i = 0; i < 5'000; ++i) {
    const PairMotion<double> m = pair.move_b({0.0, 0.1 * uniform(random), 0.1 * uniform(random)},
                                             {uniform(random), uniform(random), uniform(random)});
    const ContactResponse r = law.response({1e10, 0.2}, spheres, 1e-5, 0.0, m, state);
    ASSERT_LE(norm(r.shear), 0.3 * r.pressure * (1.0 + 1e-12));
    ASSERT_LE(norm(r.moment), 0.1 * 0.01 * r.pressure * (1.0 + 1e-12));
    slid += r.slid;
    ASSERT_GE(slid, -1e-12);
  }
  EXPECT_GT(slid, 0.0);
  const ContactResponse apart =
      law.response({1e10, 0.2}, spheres, -1e-6, 0.0, pair.move_b({}), state);
  EXPECT_EQ(apart.pressure, 0.0);
  EXPECT_EQ(norm(state.shear), 0.0);
}

TEST(Materials, the_macro_micro_relation_gives_the_known_ratio) {
  MaterialConfig m;
  const LocalElasticity local = local_elasticity(m);
  EXPECT_NEAR(local.ratio, 0.22 / 1.2, 1e-12);
  EXPECT_NEAR(local.modulus, 30e9 * 4.9 / (3.125 * 1.2 + 5.0 * 0.22), 1.0);
  m.poisson = 1.0 / 3.9;
  EXPECT_NEAR(local_elasticity(m).ratio, 0.0, 1e-12);
}

}  // namespace other_laws_test
}  // namespace breccia::dem
