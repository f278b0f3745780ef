// Calibration finds the keys of a material that shows its targets.

#include "laboratory/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exec/error.hpp"
#include "laboratory/optimiser.hpp"
#include "laboratory/rock_tests.hpp"

namespace breccia::laboratory {
namespace calibration_test {

/// A concrete whose strengths depend on all keys, as those of packings do.
std::vector<TestResults> shown_by(const dem::MaterialConfig& m,
                                  const Calibration<dem::MaterialConfig>& calibration) {
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
  const CalibrationStep<dem::MaterialConfig>& best = calibration.best();
  EXPECT_NEAR(best.shown.at("tension").mean, 2.9e6, 0.05 * 2.9e6);
  EXPECT_NEAR(best.shown.at("compression").mean, 38e6, 0.05 * 38e6);
  EXPECT_NEAR(best.material.young, 33.6e9 / 0.93, 0.03 * 36e9);
  EXPECT_EQ(calibration.obstacles(), "");
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

/// A concrete whose keys work on each other's targets: more cohesion raises the ratio and the
/// tensile strength, and more of the key poisson lowers the compressive strength.
TEST(Calibration, LearnsWhatKeysDoToOtherTargets) {
  dem::MaterialConfig start;
  Calibration calibration(start, c30);
  while (calibration.steps().size() < 8 && !calibration.converged()) {
    const dem::MaterialConfig& m = calibration.material();
    const double f_c = 20e6 * std::pow(m.cohesion / 1e6, 0.5) * std::pow(m.poisson / 0.1, -0.5);
    const double nu = 1.2 * m.poisson * std::pow(m.cohesion / 10e6, 0.5);
    const double f_t = 2e6 * std::pow(m.tensile_strength / 1e6, 0.7) *
                       std::pow(m.fracture_energy / 50.0, 0.2) * std::pow(m.cohesion / 10e6, 0.2);
    const double g_f = 2.0 * m.fracture_energy * std::pow(m.tensile_strength / 1e6, 0.3);
    std::vector<TestResults> results;
    for (const SpecimenTest& test : calibration.tests()) {
      SpecimenResult s;
      s.numbers = {{"young", m.young}, {"poisson", nu}, {"fracture_energy", g_f}};
      s.numbers["strength"] = test.name == "tension" ? f_t : f_c;
      results.push_back({test, {s}, {}});
    }
    calibration.take(results);
  }
  EXPECT_TRUE(calibration.converged()) << calibration.page("c", "as a test");
}

/// Plates by Mohr and Coulomb, a little stronger than their joints; a disc a tenth too strong.
TEST(Calibration, FindsTheKeysOfARock) {
  fdem::MaterialConfig start;
  start.name = "granite";
  Calibration calibration(start, {{"young", 69e9, "Pa"},
                                  {"compression", 200e6, "Pa"},
                                  {"brazilian", 9.3e6, "Pa"},
                                  {"tension", 99e6, "Pa"},
                                  {"friction_angle", 1.03, "rad"},
                                  {"slide_energy", 120.0, "J/m2"}});
  ASSERT_EQ(calibration.tests().size(), 3U);
  while (calibration.steps().size() < 5 && !calibration.converged()) {
    const fdem::MaterialConfig& m = calibration.material();
    const double sine = std::sin(0.97 * m.joint.friction_angle);
    std::vector<TestResults> results;
    for (const SpecimenTest& test : calibration.tests()) {
      SpecimenResult s;
      const double f_c = 2.15 * m.joint.cohesion * std::cos(m.joint.friction_angle) / (1.0 - sine);
      s.numbers = {{"young", 0.92 * m.young}};
      s.numbers["strength"] = test.name == "disc"
                                  ? 1.1 * m.joint.tension
                                  : f_c + test.pressure * (1.0 + sine) / (1.0 - sine);
      results.push_back({test, {s, s}, {}});
    }
    calibration.take(results);
  }
  EXPECT_TRUE(calibration.converged()) << calibration.page("granite", "as a test");
  EXPECT_NEAR(calibration.best().material.joint.tension, 9.3e6 / 1.1, 0.05 * 9.3e6);
  EXPECT_EQ(calibration.best().shown.count("tension"), 0U);  // the disc's target rules
  EXPECT_NEAR(calibration.best().material.joint.energy_slide, 120.0, 1e-9);  // set
  EXPECT_EQ(calibration.best().material.joint.energy_open, start.joint.energy_open);
  EXPECT_NE(calibration.block("as a test").find("[material.granite]"), std::string::npos);
  EXPECT_NE(calibration.block("as a test").find("[material.granite.joint]\ntension = "),
            std::string::npos)
      << calibration.block("as a test");
}

/// 59 degrees under a twentieth of the strength: 4.5 % more of the angle are 8 % more strength
/// under pressure, which is not met; 3 % are 5 %.
TEST(Calibration, HoldsAnAngleAlsoAgainstTheStrengthUnderPressure) {
  const double angle = 1.03;
  const auto met = [&](double shown) {
    Calibration calibration(fdem::MaterialConfig{}, {{"compression", 200e6, "Pa"},
                                                     {"friction_angle", angle, "rad"},
                                                     {"confinement", 10e6, "Pa"}});
    std::vector<TestResults> results;
    for (const SpecimenTest& test : calibration.tests()) {
      SpecimenResult s;
      s.numbers["strength"] = 200e6 + test.pressure * gain_of(shown * angle);
      results.push_back({test, {s}, {}});
    }
    EXPECT_EQ(results.back().test.pressure, 10e6);
    calibration.take(results);
    return calibration.converged();
  };
  EXPECT_TRUE(met(1.03));
  EXPECT_FALSE(met(1.045));
}

/// Without a splitting strength the direct one is shown by a plate that is pulled, not by a disc.
TEST(Calibration, FindsTheDirectStrengthOfARockByAPlate) {
  Calibration calibration(fdem::MaterialConfig{}, {{"tension", 2.9e6, "Pa"}});
  ASSERT_EQ(calibration.tests().size(), 1U);
  EXPECT_EQ(calibration.tests()[0].loading, Loading::pulled_plate);
  EXPECT_DOUBLE_EQ(calibration.material().joint.tension, 2.9e6);
}

/// A disc that bears less the steeper its joints rub: both targets cannot be met. The tool says
/// which step is nearest, what it misses, and what either target costs the other.
TEST(Calibration, SaysWhatStandsInTheWayOfTargetsThatExcludeEachOther) {
  fdem::MaterialConfig start;
  Calibration calibration(start, {{"brazilian", 9.3e6, "Pa"}, {"friction_angle", 1.03, "rad"}});
  EXPECT_EQ(calibration.steps().size(), 0U);
  while (calibration.steps().size() < 6 && !calibration.converged()) {
    const double phi = calibration.material().joint.friction_angle;
    const double gain = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
    std::vector<TestResults> results;
    for (const SpecimenTest& test : calibration.tests()) {
      SpecimenResult s;
      s.numbers["strength"] = test.name == "disc"
                                  ? std::min(calibration.material().joint.tension, 60e6 / gain)
                                  : 200e6 + 0.7 * gain * test.pressure;
      results.push_back({test, {s}, {}});
    }
    calibration.take(results);
  }
  EXPECT_FALSE(calibration.converged());
  const std::string said = calibration.obstacles();
  EXPECT_EQ(said.find("nearest is step "), 0U) << said;
  EXPECT_NE(said.find("brazilian -"), std::string::npos) << said;
  EXPECT_NE(said.find("was met best in step "), std::string::npos) << said;
}

/// By NLopt, too, in more evaluations; what a search may not do is told.
TEST(Calibration, FindsFiveKeysByNLopt) {
  if (!has_nlopt()) GTEST_SKIP() << "built without NLopt";
  const auto evaluations = [](const char* method) {
    Calibration calibration(dem::MaterialConfig{}, c30);
    make_small(method, calibration.keys(), [&](const std::vector<double>& keys) {
      calibration.set_keys(keys);
      calibration.take(shown_by(calibration.material(), calibration));
      const bool ends = calibration.converged() || calibration.steps().size() == 200;
      return ends ? std::vector<double>{} : calibration.misfits();
    });
    EXPECT_TRUE(calibration.converged()) << method << " " << calibration.progress();
    return calibration.steps().size();
  };
  EXPECT_LE(evaluations("cobyla"), 40U);
  evaluations("sbplx");
  EXPECT_THROW(make_small("newton", {0.0}, nullptr), InputError);
  EXPECT_THROW(make_small("cobyla", {0.0},
                          [](const std::vector<double>&) -> std::vector<double> {
                            throw InputError("no specimen");
                          }),
               InputError);
}

TEST(Calibration, RefusesToGoOnWithoutTargetsOrResults) {
  EXPECT_THROW(Calibration(dem::MaterialConfig{}, {}), InputError);
  EXPECT_THROW(Calibration(dem::MaterialConfig{}, {{"tension", -1.0, "Pa"}}), InputError);
  EXPECT_THROW(Calibration(fdem::MaterialConfig{}, {{"slide_energy", 9.0, "J/m2"}}), InputError);
  Calibration calibration(dem::MaterialConfig{}, c30);
  EXPECT_THROW(calibration.take({}), InputError);
}

}  // namespace calibration_test
}  // namespace breccia::laboratory
