// Energies of triangles by packs add up to the bits of those one by one, however large they are.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "fdem/triangles/triangle_energies.hpp"

namespace breccia::fdem {
namespace energy_packs_test {

/// Triangles of three laws, hardly strained to far beyond, that move at speeds of many orders;
/// some are held, one has been taken out.
struct Scene {
  static constexpr Index count = 1003;  // no whole number of packs
  Buffer<TriangleNodes> nodes{Space::host, count};
  Buffer<Mat2> shape_inverse{Space::host, count};
  Buffer<Corners> force{Space::host, count}, external{Space::host, count};
  Buffer<double> mass{Space::host, count}, viscous_work{Space::host, count};
  Buffer<double> damping_work{Space::host, count}, load_work{Space::host, count};
  Buffer<Index> hold{Space::host, count}, law{Space::host, count};
  Buffer<Hold> holds{Space::host, 2};
  Buffer<ElasticTriangle> laws{Space::host, 3};
  bool driven;  ///< by loads, gravity and local damping

  explicit Scene(bool is_driven) : driven(is_driven) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0), order(-9.0, 6.0);
    const auto vector = [&](double size) {
      return Vec2{size * number(random), size * number(random)};
    };
    const auto of_any_size = [&] { return vector(std::pow(10.0, order(random))); };
    for (Index k = 0; k < 3; ++k) laws.data()[k] = {2e10, 3e10};
    laws.data()[1].preset = {-4e6, -7e6, 1e6};
    laws.data()[2] = {2e10, 3e10, {-4e6, -7e6, 1e6}, 4e9, 1e9, 0.3};
    for (Index k = 0; k < 2; ++k) holds.data()[k] = Hold{};
    holds.data()[0].fixed = 0b011001;
    holds.data()[1].gone = 1;
    for (Index t = 0; t < count; ++t) {
      const Vec2 first = Vec2{2e-3, 0.0} + vector(5e-4), second = Vec2{0.0, 2e-3} + vector(5e-4);
      shape_inverse.data()[t] = inverse(columns(first, second));
      constexpr double strains[] = {1e-9, 1e-4, 0.02, 0.15};
      const double size = strains[t < 600 ? t / 150 : t % 4];  // packs of one size, and of several
      const auto stretched = [&](const Vec2& edge) { return edge + vector(size * norm(edge)); };
      const Vec2 from = vector(1.0);
      nodes.data()[t] = {{{from, of_any_size()},
                          {from + stretched(first), of_any_size()},
                          {from + stretched(second), of_any_size()}}};
      for (int k = 0; k < 3; ++k) {
        force.data()[t].at[k] = of_any_size();
        external.data()[t].at[k] = of_any_size();
      }
      mass.data()[t] = 1.5 + number(random);
      law.data()[t] = t < 400 ? 0 : t % 3;
      hold.data()[t] = t % 97 == 5 || (t > 300 && t < 330) ? 0 : -1;
      if (t % 3 == 0) viscous_work.data()[t] = 1e4 * number(random);
      if (t % 5 == 0) damping_work.data()[t] = 1e4 * number(random);
      if (t % 100 == 0) load_work.data()[t] = 1e9 * number(random);
    }
    hold.data()[700] = 1;
  }
  Kick kick() const {
    Kick k{};
    k.last_dt = 1e-6;
    k.next_dt = 1.1e-6;
    if (driven) {
      k.damping = 0.2;
      k.gravity = {0.0, -9.81};
    }
    k.holds = holds.view();
    k.mass = mass.view();
    k.nodes = nodes.view();
    k.force = force.view();
    k.hold = hold.view();
    return k;
  }
  /// From triangle `first` on.
  Energies energies(Lanes lanes, Index first) const {
    const TriangleShares shares{{kick(), law.view(), laws.view(), shape_inverse.view(), lanes},
                                driven ? external.view() : View<const Corners>{},
                                viscous_work.view(),
                                damping_work.view(),
                                load_work.view()};
    Energies sum;
    shares.add_run(sum, first, count);
    return sum;
  }
  void expect_same_for_any_width() const {
    for (const Index first : {0, 3}) {
      const Energies one = energies(Lanes::one, first);
      for (const Lanes lanes : {Lanes::four, Lanes::eight}) {
        if (lanes > widest_lanes()) continue;
        const Energies packs = energies(lanes, first);
        EXPECT_EQ(std::memcmp(&packs, &one, sizeof one), 0)
            << first << ", " << static_cast<int>(lanes) << ": kinetic " << packs.kinetic.value()
            << ", " << one.kinetic.value() << ", elastic " << packs.elastic.value() << ", "
            << one.elastic.value() << ", damping " << packs.damping.value() << ", "
            << one.damping.value() << ", work " << packs.work.value() << ", " << one.work.value();
      }
    }
  }
};

TEST(SameBits, of_energies_of_triangles_for_any_width_of_vector) {
  for (const bool driven : {false, true})
    for (const double fastest : {1.0, 1e8, 1e12, HUGE_VAL, std::nan("")}) {
      SCOPED_TRACE(std::to_string(driven) + ", " + std::to_string(fastest));
      Scene scene(driven);
      scene.nodes.data()[500].at[1].velocity.x = fastest;
      const Energies one = scene.energies(Lanes::one, 0);
      EXPECT_EQ(std::isfinite(one.kinetic.value()), fastest < 1e9);  // an ExactSum ends at 2^63
      EXPECT_TRUE(std::isfinite(one.elastic.value()));
      EXPECT_GT(one.elastic.value(), 0.0);
      EXPECT_NE(one.damping.value(), 0.0);
      EXPECT_NE(one.work.value(), 0.0);
      scene.expect_same_for_any_width();
    }
}
/// Turned inside out, and so far away that its energy is beyond the parts of a PackSum.
TEST(SameBits, of_energies_of_triangles_that_are_torn_away) {
  for (const double way : {-1.0, 1e4, 1e9, HUGE_VAL, std::nan("")}) {
    SCOPED_TRACE(way);
    Scene scene(false);
    TriangleNodes& torn = scene.nodes.data()[450];
    torn.at[1].position = torn.at[0].position + Vec2{way, 0.0};
    const double elastic = scene.energies(Lanes::one, 0).elastic.value();
    EXPECT_EQ(std::isfinite(elastic), way == 1e4);
    if (way == 1e4) {
      EXPECT_GT(elastic, 2251799813685248.0);  // 2^51
    }
    scene.expect_same_for_any_width();
  }
}

}  // namespace energy_packs_test
}  // namespace breccia::fdem
