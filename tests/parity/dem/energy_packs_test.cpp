// Energies of packs add up to the bits of energies one by one, however large they are.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "dem/stepping/kernel_lanes.hpp"

namespace breccia::dem {
namespace energy_packs_test {

/// Elements that move at speeds of many orders, one of them at `fastest`.
struct Scene {
  static constexpr Index count = 1003;  // no whole number of packs
  Buffer<ElementState> state{Space::host, count};
  Buffer<double> mass{Space::host, count}, inertia{Space::host, count};
  Buffer<double> damping_work{Space::host, count}, load_work{Space::host, count};
  Buffer<Vec3> force{Space::host, count}, torque{Space::host, count};
  Buffer<std::uint8_t> fixed{Space::host, count};
  Buffer<std::int16_t> motion{Space::host, count};

  explicit Scene(double fastest) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0), order(-9.0, 6.0);
    const auto vector = [&] {
      const double size = std::pow(10.0, order(random));
      return Vec3{size * number(random), size * number(random), size * number(random)};
    };
    for (Index e = 0; e < count; ++e) {
      state.data()[e] = {vector(), vector(), vector(), 0.01};
      force.data()[e] = vector();
      torque.data()[e] = vector();
      mass.data()[e] = 1.5 + number(random);
      inertia.data()[e] = 1.5 + number(random);
      motion.data()[e] = -1;
      if (e % 3 == 0) damping_work.data()[e] = 1e4 * number(random);
      if (e % 100 == 0) load_work.data()[e] = 1e9 * number(random);
    }
    state.data()[500].velocity.x = fastest;
  }
  Kick kick() const {
    Kick k{};
    k.last_dt = 1e-6;
    k.next_dt = 1.1e-6;
    k.damping = 0.2;
    k.mass = mass.view();
    k.inertia = inertia.view();
    k.state = state.view();
    k.force = force.view();
    k.torque = torque.view();
    k.fixed = fixed.view();
    k.motion = motion.view();
    return k;
  }
  /// From element `first` on.
  Energies energies(Lanes lanes, Index first) const {
    Energies sum;
    add_energies(lanes, KineticEnergy{kick()}, first, count, sum);
    add_energies(lanes, ElementShares{kick(), damping_work.view(), load_work.view()}, first, count,
                 sum);
    return sum;
  }
};

bool same_bits(const Energies& one, const Energies& other) {
  return std::memcmp(&one, &other, sizeof one) == 0;
}

TEST(SameBits, of_energies_for_any_width_of_vector) {
  for (const double fastest : {1.0, 1e8, 1e12, HUGE_VAL, std::nan("")}) {
    const Scene scene(fastest);
    for (const Index first : {0, 3}) {
      const Energies one = scene.energies(Lanes::one, first);
      EXPECT_EQ(std::isfinite(one.kinetic.value()), fastest < 1e9);  // an ExactSum ends at 2^63
      EXPECT_NE(one.damping.value(), 0.0);
      EXPECT_NE(one.work.value(), 0.0);
      for (const Lanes lanes : {Lanes::four, Lanes::eight})
        if (lanes <= widest_lanes()) {
          EXPECT_TRUE(same_bits(scene.energies(lanes, first), one))
              << fastest << ", " << static_cast<int>(lanes);
        }
    }
  }
}

}  // namespace energy_packs_test
}  // namespace breccia::dem
