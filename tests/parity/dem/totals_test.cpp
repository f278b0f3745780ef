// Packs of elements add up and divide as single elements do, whatever the sums and supports are.

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "dem/stepping/kernel_lanes.hpp"

namespace breccia::dem {
namespace totals_test {

/// Elements with random sums, some of them held, some with bars and contacts.
struct Scene {
  static constexpr Index count = 203;  // no whole number of packs
  Buffer<LinkSums> sums{Space::host, count};
  Incidence bars, contacts;
  Buffer<PairForce> bar_actions{Space::host, 3}, contact_actions{Space::host, 2};
  Buffer<double> mass{Space::host, count}, inertia{Space::host, count};
  Buffer<std::uint8_t> fixed{Space::host, count};
  Buffer<Vec3> force{Space::host, count}, torque{Space::host, count};
  Buffer<double> critical{Space::host, count};

  Scene() {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    std::uniform_real_distribution<float> stiffness(0.0F, 1.0F);
    const auto fill = [&](LinkSums& s) {
      double numbers[6];
      float stiffnesses[9];
      for (SixSums* six : {&s.as_a, &s.as_b}) {
        for (double& n : numbers) n = number(random);
        six->add(numbers);
      }
      for (StiffnessSums* sums_of_end : {&s.stiffness_a, &s.stiffness_b}) {
        for (float& k : stiffnesses) k = stiffness(random);
        sums_of_end->add(stiffnesses);
      }
    };
    for (Index e = 0; e < count; ++e) {
      mass.data()[e] = 1.5 + number(random);
      inertia.data()[e] = 1.5 + number(random);
      if (e % 50 < 3) fixed.data()[e] = static_cast<std::uint8_t>(random() % 64);
      if (e % 40 != 7) fill(sums.data()[e]);  // the others are free of forces
    }
    for (Buffer<PairForce>* actions : {&bar_actions, &contact_actions})
      for (PairForce& action : actions->host()) {
        for (double& n : action.numbers) n = number(random);
        for (float& k : action.stiffness) k = stiffness(random);
      }
    row(bars, {{10, 12}, {12, 100}, {199, 202}});
    row(contacts, {{8, 12}, {61, 62}});
  }
  void row(Incidence& incidence, const std::vector<std::pair<Index, Index>>& pairs) const {
    Buffer<Index> a, b;
    Buffer<GlobalId> ids(Space::host, count);
    for (Index e = 0; e < count; ++e) ids.data()[e] = e;
    std::vector<Index> from, to;
    for (const auto& [one, other] : pairs) {
      from.push_back(one);
      to.push_back(other);
    }
    copy_to(a, from);
    copy_to(b, to);
    build_incidence({}, a, b, ids, incidence);
  }
  void gather(Lanes lanes, bool evaluates = true) {
    run_packs(lanes,
              GatherForces{sums.view(), bars.view(), contacts.view(), bar_actions.view(),
                           contact_actions.view(), mass.view(), inertia.view(), fixed.view(),
                           force.view(), torque.view(), critical.view(), evaluates},
              0, count);
  }
};

template <class T>
bool same_bits(const Buffer<T>& one, const Buffer<T>& other) {
  return one.size() == other.size() &&
         std::memcmp(one.data(), other.data(), static_cast<std::size_t>(one.size()) * sizeof(T)) ==
             0;
}

/// In a step that does not evaluate the critical step, links bring no stiffness.
TEST(SameBits, of_forces_without_stiffness) {
  Scene with;
  with.gather(Lanes::one);
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;
    Scene without;
    for (LinkSums& sums : without.sums.host()) sums.clear_stiffness();
    const Buffer<double> before = without.critical;
    without.gather(lanes, false);
    EXPECT_TRUE(same_bits(without.force, with.force)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(without.torque, with.torque)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(without.critical, before)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(without.sums, with.sums)) << static_cast<int>(lanes);
  }
}

TEST(SameBits, of_totals_for_any_width_of_vector) {
  Scene one;
  one.gather(Lanes::one);
  EXPECT_EQ(one.critical.data()[47], 1e300);
  for (const Lanes lanes : {Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;
    Scene wide;
    wide.gather(lanes);
    EXPECT_TRUE(same_bits(wide.force, one.force)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(wide.torque, one.torque)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(wide.critical, one.critical)) << static_cast<int>(lanes);
    EXPECT_TRUE(same_bits(wide.sums, one.sums)) << static_cast<int>(lanes);
    EXPECT_EQ(least(lanes, std::as_const(one.critical).view(), 0, Scene::count),
              least(Lanes::one, std::as_const(one.critical).view(), 0, Scene::count));
  }
}

}  // namespace totals_test
}  // namespace breccia::dem
