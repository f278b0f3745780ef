// Faces that absorb waves: what comes back from a dashpot C at the end of a chain of impedance Z is
// (Z - C)/(Z + C) of the wave.

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace absorbing_test {

using testing::Scene;

constexpr int count = 240;

/// A chain along x whose middle begins to move; both of its ends have dashpots of `share` Z.
Scene chain(double share) {
  Scene s;
  MaterialConfig& m = s.material("m", "concrete", 30e9, 0.2, 2400.0);
  m.tensile_strength = m.cohesion = 1e12;
  for (int i = 0; i < count; ++i) {
    const double from = i - 0.5 * (count - 1);
    s.sphere({0.02 * i, 0.0, 0.0}, 0.01, {1e-3 * std::exp(-from * from / 100.0), 0.0, 0.0});
    if (i > 0) s.link(i - 1, i);
  }
  if (!(share > 0.0)) return s;
  const World w = s.world();
  const double z = std::sqrt(w.concrete.stiffness.data()[0] * s.model.mass[0]);
  for (const bool last : {false, true}) {
    SupportConfig end;
    end.name = last ? "last" : "first";
    (last ? end.min.x : end.max.x) = last ? 0.02 * (count - 1.5) : 0.01;
    end.fix = {"x"};
    end.absorb = "x";
    end.wave = "bar";
    end.area = share * z / std::sqrt(m.young * m.density);
    s.config.supports.push_back(end);
  }
  return s;
}

TEST(Absorbing, faces_reflect_by_the_ratio_of_impedances) {
  for (const double share : {0.0, 0.5, 1.0, 3.0}) {
    World w = chain(share).world();
    const double mass = w.elements.mass.data()[0], k = w.concrete.stiffness.data()[0];
    const double crossing = count * std::sqrt(mass / k);
    const EnergyBalance before = balance(w);
    const double start = before.kinetic + before.elastic;
    while (w.time < 0.85 * crossing) step(w);
    const EnergyBalance b = balance(w);
    const double back = (1.0 - share) / (1.0 + share);
    EXPECT_NEAR((b.kinetic + b.elastic) / start, back * back, 0.01) << share;
    EXPECT_NEAR(b.work / start, back * back - 1.0, 0.01) << share;
    EXPECT_LT(b.error_relative, 1e-6) << share;
  }
}

/// A dashpot far stiffer than the element's own step allows to integrate forwards holds it.
TEST(Absorbing, faces_of_any_impedance_are_stable) {
  World w = chain(1e4).world();
  while (w.time < 1e-3) step(w);
  EXPECT_LT(std::abs(testing::state(w, 0).velocity.x), 1e-6);
  EXPECT_LT(balance(w).error_relative, 1e-6);
}

TEST(Absorbing, faces_share_no_element_with_what_is_held) {
  Scene s = chain(1.0);
  SupportConfig hold;
  hold.name = "hold";
  hold.max.x = 0.01;
  hold.fix = {"y"};
  s.config.supports.push_back(hold);
  try {
    s.world();
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("an absorbing support shares element 0"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace absorbing_test
}  // namespace breccia::dem
