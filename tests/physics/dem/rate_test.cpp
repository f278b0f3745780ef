// Strength in direct tension over the rate of strain, with and without a rate of the links' own.
#include <gtest/gtest.h>

#include <cstdio>

#include "specimen.hpp"

namespace breccia::dem {
namespace rate_test {

using testing::pulled;
using testing::Specimen;

constexpr double zeta = 10.0;

Specimen concrete(const char* rate) {
  Specimen s(600);
  s.config.local_damping = 0.0;
  MaterialConfig& m = s.material();
  m.tensile_strength = 2.2e6;
  m.cohesion = 5.5e6;
  m.softening = zeta;
  m.rolling_limit = 0.15;
  m.rate = rate;
  return s;
}

/// Strength of a specimen over zeta, by the reference values for T = 4 MPa (specimen_test.cpp),
/// joined by straight lines.  [MPa]
double reference(double softening) {
  if (softening < 5.0) return 3.98 + (5.5 - 3.98) * (softening - 1.0) / 4.0;
  return 5.5 + (6.30 - 5.5) * (softening - 5.0) / 5.0;
}

// A link that is f times as strong and opens as far has zeta' = (1 + zeta) / f - 1: links share a
// load less well, so that the specimen gains less than its links.
double gained(double f) {
  return f * reference((1.0 + zeta) / f - 1.0) / reference(zeta);
}

TEST(StrainRate, raises_the_strength_in_tension_by_the_curve_of_the_links_as_they_share_it) {
  const double scatter = 0.05;  // of the strengths of 600 elements, and of a quotient of two
  const Specimen slow = concrete("none");
  const Model model = slow.model();
  const double still = pulled(slow, model, 0.05, 0.3).strength;
  const double inertia = pulled(slow, model, 1.0, 0.3).strength / still;
  const double whole = pulled(concrete("malvar_ross"), model, 1.0, 0.3).strength / still;
  const double code = pulled(concrete("mc2010"), model, 1.0, 0.3).strength / still;
  std::printf("at 1/s over %.3g MPa: inertia %.3f, Malvar and Ross %.3f, MC2010 %.3f\n",
              still * 1e-6, inertia, whole, code);
  EXPECT_NEAR(inertia, 1.0, 0.07);                               // without a rate of the links
  EXPECT_NEAR(whole, gained(1.738) * inertia, scatter * whole);  // 1e6^(1/25)
  EXPECT_NEAR(code, gained(1.282) * inertia, scatter * code);    // 1e6^0.018
}

}  // namespace rate_test
}  // namespace breccia::dem
