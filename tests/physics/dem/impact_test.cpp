// The impact on the reinforced slab, small: momentum that the rock loses is the impulse it gets,
// and that of the slab and its supports.

#include <gtest/gtest.h>

#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace impact_test {

const std::string folder = std::string(source_dir) + "/cases/rc_slab";

/// Sum of a quantity over a body, a support, or everything, as a probe of a case reads it.
double sum(const World& w, const char* on, const char* quantity) {
  return probe(w, {"", on, quantity, "sum"});
}

/// Impulses along z: over a step the mean of the forces at its ends.
struct Impulses {
  double rock = 0.0, slab = 0.0, steel = 0.0, supports = 0.0;
};

TEST(Impact, the_rock_s_loss_of_momentum_is_the_impulse_on_slab_bars_and_supports) {
  const auto config = read_case<Config>(folder + "/small.toml", {"time.end=1"});
  World w = make_world(config, build_model(config, folder), {});
  const double before = sum(w, "impactor", "momentum_z");
  const double slab_before = sum(w, "slab", "momentum_z"),
               steel_before = sum(w, "steel", "momentum_z");
  ASSERT_NEAR(before, -30.0 * 2400.0 * 4.0 / 3.0 * pi * std::pow(0.057, 3), 1e-9);

  Impulses given;
  double unbalanced = 0.0, largest = 0.0;
  while (w.time < 1e-3) {
    for (const bool at_end : {false, true}) {
      if (at_end) step(w);
      const double half = 0.5 * (at_end ? w.last_dt : w.next_dt);
      const double rock = sum(w, "impactor", "force_z");
      given.rock += half * rock;
      given.slab += half * sum(w, "slab", "force_z");
      given.steel += half * sum(w, "steel", "force_z");
      for (const char* support : {"west", "east", "south", "north"})
        given.supports += half * sum(w, support, "force_z");
      unbalanced = std::max(unbalanced, std::fabs(sum(w, "", "force_z")));
      largest = std::max(largest, std::fabs(rock));
    }
  }
  const double lost = before - sum(w, "impactor", "momentum_z");
  EXPECT_LT(lost, 0.3 * before) << "the rock has hardly been slowed";
  EXPECT_GT(count(w).broken_of(LinkKind::concrete), 100);
  const double tolerance = 1e-10 * std::fabs(before);
  EXPECT_NEAR(lost, -given.rock, tolerance);
  EXPECT_NEAR(given.rock, -(given.slab + given.steel), tolerance);
  // Elements of supports do not move: the rest of the impulse is momentum of slab and bars.
  const double gained =
      sum(w, "slab", "momentum_z") - slab_before + sum(w, "steel", "momentum_z") - steel_before;
  EXPECT_NEAR(gained, given.slab + given.steel - given.supports, tolerance);
  EXPECT_NEAR(lost, gained + given.supports, tolerance);
  EXPECT_GT(std::fabs(given.supports), 1e-3 * std::fabs(before)) << "no support felt the impact";
  // Forces between elements cancel at every step.
  EXPECT_LT(unbalanced, 1e-11 * largest);
}

}  // namespace impact_test
}  // namespace breccia::dem
