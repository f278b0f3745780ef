// Boxes of probes that are open on a side.

#include <gtest/gtest.h>

#include <limits>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "core/probe.hpp"

namespace breccia {
namespace probe_box_test {

ProbeConfig probe(const std::string& quantity, const std::vector<double>& min,
                  const std::vector<double>& max) {
  ProbeConfig p;
  p.name = "p";
  p.quantity = quantity;
  p.min = min;
  p.max = max;
  return p;
}

TEST(ProbeBox, with_one_corner_is_open_on_the_other_side) {
  EXPECT_TRUE(probe_problems(probe("velocity_z", {0, 0, 1}, {}), in_space).empty());
  EXPECT_TRUE(probe_problems(probe("strain_yy", {}, {1, 2}), in_plane).empty());
  const ReadBox above({0, 0, 1}, {}), below({}, {1, 2});
  EXPECT_TRUE(above.holds({5, 5, 1e6}));
  EXPECT_FALSE(above.holds({5, 5, 0.9}));
  EXPECT_TRUE(below.holds({-1e6, -1e6, 7}));
  EXPECT_FALSE(below.holds({0, 2.1, 0}));
}

TEST(ProbeBox, of_the_stress_of_spheres_has_a_volume) {
  EXPECT_FALSE(probe_problems(probe("stress_zz", {0, 0, 1}, {}), in_space).empty());
  EXPECT_TRUE(probe_problems(probe("stress_zz", {0, 0, 1}, {1, 1, 2}), in_space).empty());
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(probe_problems(probe("stress_zz", {0, 0, -inf}, {1, 1, 2}), in_space).empty());
  EXPECT_TRUE(probe_problems(probe("velocity_z", {-inf, 0, 1}, {1, inf, inf}), in_space).empty());
}

}  // namespace probe_box_test
}  // namespace breccia
