// The virtual laboratory and calibration with the lattice discrete particle model.

#include "laboratory/ldpm_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exec/error.hpp"
#include "laboratory/calibration.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"

namespace breccia::laboratory {
namespace ldpm_tests_test {

dem::MaterialConfig concrete() {
  dem::MaterialConfig m;
  m.name = "grains";
  m.law = "ldpm";
  m.tensile_strength = 3.44e6;
  m.cohesion = 8.944e6;
  return m;
}

TEST(LdpmLaboratory, every_test_is_a_good_case_five_largest_grains_wide) {
  Sample sample;
  sample.material = concrete();
  sample.material.mix.largest = 10e-3;
  sample.material.ldpm.rate_factor = 0.05;
  ASSERT_EQ(tests_of(sample.material).size(), 16U);
  for (const SpecimenTest& test : tests_of(sample.material)) {
    EXPECT_EQ(test.size.x, 0.05) << test.name;
    const dem::Config c = case_of(test, sample, 2, "");
    EXPECT_NO_THROW(check_case(c)) << test.name;
    EXPECT_EQ(c.materials[0].ldpm.rate_factor, 0.0) << test.name;
    EXPECT_EQ(c.seed, 2) << test.name;
  }
  SpecimenTest bending = specimen_tests()[7];
  EXPECT_THROW(case_of(bending, sample, 1, ""), InputError);
}

/// Opposite faces hold particles each, and no particle lies beyond them.
TEST(LdpmLaboratory, faces_hold_the_particles_on_them) {
  Sample sample;
  sample.material = concrete();
  sample.material.mix.largest = 8e-3;
  for (const SpecimenTest& test : tests_of(sample.material)) {
    if (test.name != "triaxial_20") continue;
    const dem::Config c = case_of(test, sample, 1, "");
    const dem::Model model = build_model(c, "");
    ASSERT_EQ(c.supports.size(), 6U);
    for (const dem::SupportConfig& s : c.supports) {
      int held = 0;
      for (const Vec3& x : model.position)
        if (x.x >= s.min.x && x.y >= s.min.y && x.z >= s.min.z && x.x <= s.max.x &&
            x.y <= s.max.y && x.z <= s.max.z)
          ++held;
      EXPECT_GT(held, 20) << s.name;
      EXPECT_LT(held, static_cast<int>(model.size()) / 3) << s.name;
    }
    // the moving faces push inwards, with the pressure on their area
    EXPECT_EQ(c.supports[1].servo.pressure.values.back(), -20e6);
    EXPECT_EQ(c.supports[1].servo.area, test.size.y * test.size.z);
    EXPECT_EQ(c.supports[5].servo.area, test.size.x * test.size.y);
    EXPECT_LT(c.stages[1].supports[0].velocity.value.z, 0.0);
  }
}

/// Specimens whose numbers follow facets as those of a prism of 60 mm do, and each other's keys.
std::vector<TestResults> specimens_of(const dem::MaterialConfig& m,
                                      const std::vector<SpecimenTest>& tests) {
  const double young = m.young / (1.0 - 2.0 * m.poisson);
  const double energy =
      m.tensile_strength * m.tensile_strength * m.ldpm.tensile_length / (2.0 * young);
  const double f_t = 1.1 * std::pow(m.tensile_strength / 1e6, 0.9) * std::pow(energy, 0.05) * 1e6;
  std::vector<TestResults> results;
  for (const SpecimenTest& test : tests) {
    SpecimenResult s;
    s.numbers["young"] = 0.97 * m.young;
    s.numbers["poisson"] = 1.05 * m.poisson;
    s.numbers["strength"] =
        test.name == "tension" ? f_t
                               : 5.5e6 * std::pow(m.cohesion / 1e6, 0.7) * std::pow(f_t / 1e6, 0.4);
    s.numbers["fracture_energy"] = 1.6 * energy * std::pow(f_t / 3e6, 0.2);
    results.push_back({test, {s}, {}});
  }
  return results;
}

TEST(LdpmLaboratory, calibration_finds_the_facet_law_of_a_concrete) {
  Calibration calibration(concrete(), {{"young", 33.6e9, "Pa"},
                                       {"poisson", 0.2, "-"},
                                       {"compression", 38e6, "Pa"},
                                       {"tension", 2.9e6, "Pa"},
                                       {"fracture_energy", 90.0, "J/m2"}});
  ASSERT_EQ(calibration.tests().size(), 3U);
  while (calibration.steps().size() < 6 && !calibration.converged())
    calibration.take(specimens_of(calibration.material(), calibration.tests()));
  EXPECT_TRUE(calibration.converged()) << calibration.page("grains", "as a test");
  const dem::MaterialConfig& m = calibration.best().material;
  const auto shown = specimens_of(m, calibration.tests());
  for (const TestResults& result : shown) {
    const auto& numbers = result.specimens[0].numbers;
    if (result.test.name == "tension_notched") {
      EXPECT_NEAR(numbers.at("fracture_energy"), 90.0, 9.0);
    } else if (result.test.name == "tension") {
      EXPECT_NEAR(numbers.at("strength"), 2.9e6, 0.05 * 2.9e6);
    } else {
      EXPECT_NEAR(numbers.at("strength"), 38e6, 0.05 * 38e6);
      EXPECT_NEAR(numbers.at("young"), 33.6e9, 0.03 * 33.6e9);
    }
  }
  const std::string block = calibration.block("as a test");
  EXPECT_NE(block.find("[material.grains.ldpm]"), std::string::npos) << block;
  EXPECT_NE(block.find("tensile_length = "), std::string::npos) << block;
  EXPECT_NE(block.find("[material.grains.mix]"), std::string::npos) << block;
}

/// A brittle concrete of large grains: the law cannot soften along edges as long as l_t.
TEST(LdpmLaboratory, the_length_of_softening_stays_longer_than_edges) {
  dem::MaterialConfig coarse = concrete();
  coarse.mix.largest = 32e-3;
  const Calibration calibration(coarse, {{"fracture_energy", 1.0, "J/m2"}});
  EXPECT_EQ(calibration.material().ldpm.tensile_length, 4.0 * 32e-3);
}

}  // namespace ldpm_tests_test
}  // namespace breccia::laboratory
