// Calibration finds the keys of a material that shows its targets.

#include "laboratory/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exec/error.hpp"

namespace breccia::laboratory {
namespace {

/// A concrete whose strengths depend on all keys, as those of packings do.
std::vector<TestResults> shown_by(const dem::MaterialConfig& m, const Calibration& calibration) {
  const double f_t =
      1.5e6 * std::pow(m.tensile_strength / 1e6, 0.9) * std::pow(m.fracture_energy / 100.0, 0.08);
  const double f_c = 9e6 * std::pow(m.cohesion / 1e6, 0.45) * std::pow(f_t / 1e6, 0.3);
  std::vector<TestResults> results;
  for (const SpecimenTest& test : calibration.tests()) {
    TestResults result{test, {}, {}};
    for (const double scatter : {0.99, 1.01}) {
      SpecimenResult s;
      s.numbers = {{"young", 0.93 * m.young * scatter}, {"poisson", 1.1 * m.poisson}};
      s.numbers["strength"] = scatter * (test.name == "tension" ? f_t : f_c);
      s.numbers["fracture_energy"] = 0.8 * m.fracture_energy * std::pow(f_t / 1e6, 0.1) * scatter;
      result.specimens.push_back(s);
    }
    results.push_back(result);
  }
  return results;
}

const std::vector<MaterialTarget> c30{{"young", 33.6e9, "Pa"},
                                      {"poisson", 0.2, "-"},
                                      {"compression", 38e6, "Pa"},
                                      {"tension", 2.9e6, "Pa"},
                                      {"fracture_energy", 140.5, "J/m2"}};

TEST(Calibration, FindsFiveKeysWithinSixSteps) {
  dem::MaterialConfig start;
  start.name = "c";
  Calibration calibration(start, c30);
  while (calibration.steps().size() < 6 && !calibration.converged())
    calibration.take(shown_by(calibration.material(), calibration));
  EXPECT_TRUE(calibration.converged()) << calibration.progress();
  const CalibrationStep& best = calibration.best();
  EXPECT_NEAR(best.shown.at("tension").mean, 2.9e6, 0.05 * 2.9e6);
  EXPECT_NEAR(best.shown.at("compression").mean, 38e6, 0.05 * 38e6);
  EXPECT_NEAR(best.material.young, 33.6e9 / 0.93, 0.03 * 36e9);
  EXPECT_NE(calibration.block("as a test").find("# tension: shown 2."), std::string::npos)
      << calibration.block("as a test");
  EXPECT_NE(calibration.page("c", "as a test").find(", best |"), std::string::npos);
  EXPECT_EQ(calibration.plot().series.size(), 5U);
}

TEST(Calibration, LeavesKeysWithoutATargetAloneAndMakesOnlyTheTestsItNeeds) {
  dem::MaterialConfig start;
  start.fracture_energy = 100.0;
  Calibration calibration(start, {{"tension", 2.9e6, "Pa"}, {"tension", 9e6, "Pa"}});
  ASSERT_EQ(calibration.tests().size(), 1U);
  EXPECT_EQ(calibration.tests()[0].name, "tension");
  while (calibration.steps().size() < 6 && !calibration.converged())
    calibration.take(shown_by(calibration.material(), calibration));
  EXPECT_EQ(calibration.material().cohesion, start.cohesion);
  EXPECT_EQ(calibration.material().young, start.young);
}

TEST(Calibration, RefusesToGoOnWithoutTargetsOrResults) {
  EXPECT_THROW(Calibration({}, {}), InputError);
  EXPECT_THROW(Calibration({}, {{"tension", -1.0, "Pa"}}), InputError);
  Calibration calibration({}, c30);
  EXPECT_THROW(calibration.take({}), InputError);
}

}  // namespace
}  // namespace breccia::laboratory
