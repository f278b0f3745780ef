// Specimens of the virtual laboratory, and what their curves are reduced to.

#include "laboratory/passport.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "laboratory/rock_tests.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "run/case_keys.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::laboratory {
namespace passport_test {

Sample concrete() {
  Sample sample;
  sample.material.name = "c";
  sample.elements = 300;
  return sample;
}
const SpecimenTest& test_named(const std::string& name) {
  for (const SpecimenTest& test : specimen_tests())
    if (test.name == name) return test;
  throw InputError(name);
}

TEST(Specimens, AreCasesWithoutAProblemAndReadBackAlike) {
  const ScratchFolder scratch;
  for (const SpecimenTest& test : specimen_tests()) {
    const dem::Config config = case_of(test, concrete(), 2, scratch.path());
    EXPECT_NO_THROW(dem::check_case(config)) << test.name;
    const std::string text = completed_case(config);
    EXPECT_EQ(completed_case(read_case<dem::Config>(CaseText{text, "case.toml"}, {})), text);
    EXPECT_EQ(config.seed, 2);
  }
  EXPECT_GT(read_whole_file(scratch / "beam-300-2.csv").size(), 10000U);
}

/// Servos move at 1 m/s at most: pressures beyond 200 MPa are given time to be reached.
TEST(Specimens, UnderMorePressureAreConfinedForLonger) {
  const auto confined = [](const char* name) {
    return case_of(test_named(name), concrete(), 1, ".").stages[0].until;
  };
  EXPECT_EQ(confined("triaxial_5"), 4e-3);
  EXPECT_EQ(confined("triaxial_200"), 4e-3);
  EXPECT_DOUBLE_EQ(confined("triaxial_650"), 13e-3);
  for (const SpecimenTest& test : specimen_tests())
    EXPECT_EQ(test.asked, test.pressure > 200e6) << test.name;
}

/// All elements of a support keep one height: a wide one clamps the end of the beam.
TEST(Specimens, BeamsLieOnLinesThatHoldAFewElements) {
  for (const int elements : {600, 2400}) {
    Sample sample = concrete();
    sample.elements = elements;
    const dem::Config config = case_of(test_named("bending_thirds"), sample, 1, ".");
    EXPECT_EQ(config.supports.size(), 4U);
    EXPECT_DOUBLE_EQ(config.supports[3].min.x - config.supports[2].min.x, 0.1) << "a third";
    const double radius = std::cbrt(0.75 * 0.002 * sample.compactness / (pi * elements));
    const dem::Model model = build_model(config, ".");
    for (const dem::SupportConfig& s : config.supports) {
      EXPECT_LE(s.max.x - s.min.x, 1.2 * radius) << s.name;
      int held = 0;
      for (const Vec3& x : model.position)
        held += x.x >= s.min.x && x.x <= s.max.x && x.z >= s.min.z && x.z <= s.max.z;
      EXPECT_GE(held, 1) << s.name << " of " << elements;
      EXPECT_LE(held, 9) << s.name << " of " << elements;
    }
  }
}

TEST(Specimens, HaveTheDampingThatIsAskedFor) {
  Sample sample = concrete();
  EXPECT_EQ(case_of(test_named("compression_prism"), sample, 1, ".").local_damping, 0.3);
  EXPECT_EQ(case_of(test_named("bending_plain"), sample, 1, ".").local_damping, 0.05);
  sample.damping = 0.02;
  EXPECT_EQ(case_of(test_named("compression_prism"), sample, 1, ".").local_damping, 0.02);
  EXPECT_EQ(case_of(test_named("bending_plain"), sample, 1, ".").local_damping, 0.02);
}

template <class Call>
std::string refusal_of(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Specimens, AreOfTheCasesMaterialPackingAndRange) {
  dem::Config c;
  c.materials.resize(1);
  c.materials[0].name = "c";
  c.materials[0].cohesion = 7e6;
  c.bodies.resize(1);
  c.bodies[0].material = "c";
  c.bodies[0].pack = {50, 1.5, 0.6};
  c.links.range = 1.3;
  const Sample sample = sample_of(c, "c");
  EXPECT_EQ(sample.material.cohesion, 7e6);
  EXPECT_EQ(sample.size_ratio, 1.5);
  EXPECT_EQ(sample.compactness, 0.6);
  EXPECT_EQ(sample.range, 1.3);
  EXPECT_EQ(sample.damping, 0.3);
  c.materials[0].link_damping = 0.3;
  EXPECT_EQ(sample_of(c, "c").damping, 0.0);
  EXPECT_THROW(sample_of(c, "d"), InputError);
  c.materials.resize(2);
  c.materials[1].name = "b500";
  c.materials[1].law = "steel";
  EXPECT_EQ(refusal_of([&] { sample_of(c, "nothere"); }),
            "the case has no material nothere; allowed are c; nothing was run");
  c.materials[0].law = "steel";
  EXPECT_THROW(sample_of(c, "c"), InputError);
}

/// A bar of E = 30 GPa and nu = 0.2 that breaks at 3 MPa and then carries a third, pulled at 1/s
/// with layers 0.18 m apart.
void write_history(const std::string& folder) {
  std::string text = "step,time,force_top,force_bottom,top,bottom,right,left\n-,s,N,N,m,m,m,m\n";
  for (int k = 0; k <= 200; ++k) {
    const double strain = 1e-6 * k, stress = k <= 100 ? 30e9 * strain : 1e6;
    text += fmt::format("{},{},{},{},{},{},{},{}\n", k, strain, 0.01 * stress, -0.01 * stress,
                        0.09 * (1.0 + strain), -0.09 * (1.0 + strain), 0.04 * (1.0 - 0.2 * strain),
                        -0.04 * (1.0 - 0.2 * strain));
  }
  replace_file(folder + "/history.csv", text);
}

TEST(SpecimenResult, OfABarIsItsModulusRatioAndStrength) {
  const ScratchFolder scratch;
  write_history(scratch.path());
  const SpecimenResult result = specimen_result(test_named("tension"), scratch.path());
  EXPECT_NEAR(result.numbers.at("strength"), 3e6, 1.0);
  EXPECT_NEAR(result.numbers.at("peak_strain"), 1e-4, 1e-10);
  EXPECT_NEAR(result.numbers.at("young"), 30e9, 1e3);
  EXPECT_NEAR(result.numbers.at("poisson"), 0.2, 1e-6);
}

/// 0.2 J of work, 0.05 J of it damped: what links took counts, and the peak of 1 kN.
TEST(SpecimenResult, OfABeamIsWhatItsLinksTookOverTheLigament) {
  const ScratchFolder scratch;
  std::string text = "time,force_top,top,fracture,friction,plastic\ns,N,m,J,J,J\n";
  for (int k = 0; k <= 40; ++k)
    text += fmt::format("{},{},{},{},{},{}\n", k, -1000.0 + 50.0 * std::abs(k - 20),
                        0.05 - 1e-5 * k, 0.08 * k / 40.0, 0.04 * k / 40.0, 0.03 * k / 40.0);
  replace_file(scratch / "history.csv", text);
  const SpecimenResult result = specimen_result(test_named("bending"), scratch.path());
  EXPECT_NEAR(result.numbers.at("fracture_energy"), 0.15 / (0.1 * 0.067), 1e-6);
  EXPECT_NEAR(result.numbers.at("strength"), 1.5 * 1000.0 * 0.3 / (0.1 * 0.067 * 0.067), 1e-3);
}

/// 1 J that links took over a ligament of 50 x 100 mm, and a peak of 15 kN.
TEST(SpecimenResult, OfANotchedPrismIsWhatItsLinksTookOverTheLigament) {
  const ScratchFolder scratch;
  std::string text =
      "time,force_top,force_bottom,top,bottom,fracture,friction,plastic\ns,N,N,m,m,J,J,J\n";
  for (int k = 0; k <= 40; ++k) {
    const double force = 15e3 - 750.0 * std::abs(k - 20);
    text += fmt::format("{},{},{},{},{},{},{},{}\n", k, force, -force, 0.075 + 1e-6 * k,
                        -0.075 - 1e-6 * k, 0.6 * k / 40.0, 0.3 * k / 40.0, 0.1 * k / 40.0);
  }
  replace_file(scratch / "history.csv", text);
  const SpecimenResult result = specimen_result(test_named("tension_notched"), scratch.path());
  EXPECT_NEAR(result.numbers.at("fracture_energy"), 200.0, 1e-6);
  EXPECT_NEAR(result.numbers.at("strength"), 3e6, 1e-3);
}

TEST(ConcreteTests, TheNotchesOfAPrismCutLinksAloneAndLeaveTheLigament) {
  const ScratchFolder scratch;
  Sample sample;
  sample.material.name = "concrete";
  sample.elements = 600;
  const dem::Config whole = [&] {
    dem::Config c = case_of(test_named("tension_notched"), sample, 1, scratch.path());
    c.bodies[0].cuts.clear();
    return c;
  }();
  const dem::Model m = build_model(
      case_of(test_named("tension_notched"), sample, 1, scratch.path()), scratch.path());
  EXPECT_EQ(m.size(), build_model(whole, scratch.path()).size());
  int across = 0;
  for (const dem::Model::Link& link : m.links) {
    const Vec3 a = m.position[static_cast<std::size_t>(link.a)];
    const Vec3 b = m.position[static_cast<std::size_t>(link.b)];
    if (a.z * b.z >= 0.0 || link.parted) continue;
    ++across;
    EXPECT_LT(std::abs(a.x + a.z / (a.z - b.z) * (b.x - a.x)), 0.025);
  }
  EXPECT_GT(across, 50);
}

TEST(SpecimenResult, NamesTheProbeThatIsMissing) {
  const ScratchFolder scratch;
  replace_file(scratch / "history.csv", "time\ns\n0\n1\n");
  EXPECT_THROW(specimen_result(test_named("tension"), scratch.path()), InputError);
}

TEST(SpecimenResult, OfAnOedometerIsItsStrainsAndTangents) {
  const ScratchFolder scratch;
  std::string text = "time,force_top,force_bottom,force_side,top,bottom\ns,N,N,N,m,m\n";
  for (int k = 0; k <= 200; ++k) {  // 20 GPa up to 0.2 GPa, 10 GPa beyond; sides bear 40 %
    const double strain = 5e-4 * k;
    const double stress = strain < 0.01 ? 20e9 * strain : 0.2e9 + 10e9 * (strain - 0.01);
    text += fmt::format("{},{},{},{},{},{}\n", k, 0.01 * stress, -0.01 * stress, 4e-3 * stress,
                        0.05 * (1.0 - strain), -0.05 * (1.0 - strain));
  }
  replace_file(scratch / "history.csv", text);
  const auto numbers = specimen_result(test_named("oedometer"), scratch.path()).numbers;
  EXPECT_NEAR(numbers.at("strain_100"), 0.005, 1e-9);
  EXPECT_NEAR(numbers.at("strain_1000"), 0.09, 1e-9);
  EXPECT_NEAR(numbers.at("tangent_300"), 10e9, 1e3);
  EXPECT_NEAR(numbers.at("tangent_800"), 10e9, 1e3);
  EXPECT_NEAR(numbers.at("side_ratio"), 0.4, 1e-9);
}

TEST(SpecimenResult, OfAPrismHoldsWhatIsLeftAfterThePeak) {
  const ScratchFolder scratch;
  std::string text = "time,force_top,force_bottom,top,bottom,right,left\ns,N,N,m,m,m,m\n";
  for (int k = 0; k <= 400; ++k) {
    const double strain = 1e-5 * k, stress = k <= 100 ? 30e9 * strain : 3e6;
    text += fmt::format("{},{},{},{},{},0.04,-0.04\n", k, 0.01 * stress, -0.01 * stress,
                        0.09 * (1.0 - strain), -0.09 * (1.0 - strain));
  }
  replace_file(scratch / "history.csv", text);
  const auto numbers = specimen_result(test_named("compression_prism"), scratch.path()).numbers;
  EXPECT_NEAR(numbers.at("residual"), 0.1, 1e-9);
}

/// A disc that still takes more load as its test ends has not shown its strength.
TEST(SpecimenResult, OfADiscHasNoStrengthWhereTheLoadStillGrows) {
  const ScratchFolder scratch;
  const auto strength = [&](int peak) {
    std::string text = "time,force_top,force_bottom,top,bottom\ns,N,N,m,m\n";
    for (int k = 0; k <= 400; ++k) {
      const double force = 1e3 * std::min(k, 2 * peak - k);
      text +=
          fmt::format("{},{},{},{},{}\n", k, force, -force, 0.025 - 1e-7 * k, -0.025 + 1e-7 * k);
    }
    replace_file(scratch / "history.csv", text);
    return specimen_result(rock_tests(10e6)[2], scratch.path()).numbers.at("strength");
  };
  EXPECT_NEAR(strength(300), 2.0 * 300e3 / (pi * 0.05), 1e-3);
  EXPECT_TRUE(std::isnan(strength(400)));
}

/// Under pressure the pieces of a rock wedge, and it bears more again: its strength is the first
/// peak that it falls from by a twentieth; without such a fall it has none where the test ends.
TEST(SpecimenResult, OfAPressedPlateIsItsFirstPeak) {
  const ScratchFolder scratch;
  const auto strength = [&](double fall) {
    std::string text = "time,force_top,force_bottom,top,bottom\ns,N,N,m,m\n";
    for (int k = 0; k <= 400; ++k) {
      const double force = 1e3 * (k <= 200 ? k : 200.0 * (1.0 - fall) + 0.5 * (k - 200));
      text += fmt::format("{},{},{},{},{}\n", k, -force, force, 0.05 - 1e-7 * k, -0.05 + 1e-7 * k);
    }
    replace_file(scratch / "history.csv", text);
    return specimen_result(rock_tests(10e6)[1], scratch.path()).numbers.at("strength");
  };
  EXPECT_NEAR(strength(0.06), 200e3 / 0.05, 1.0);
  EXPECT_TRUE(std::isnan(strength(0.04)));
}

/// N = 5: phi = asin(4/6).
TEST(FrictionAngle, IsThatOfPlatesFreeAndPressed) {
  const std::vector<SpecimenTest> tests = rock_tests(10e6);
  const auto plate = [](const SpecimenTest& test, double strength) {
    return TestResults{test, {{{}, {{"strength", strength}}}}, {}};
  };
  const auto angles = friction_angles({plate(tests[0], 60e6), plate(tests[1], 110e6)});
  ASSERT_EQ(angles.size(), 1U);
  EXPECT_NEAR(angles[0], std::asin(4.0 / 6.0), 1e-12);
  EXPECT_TRUE(friction_angles({plate(tests[0], 60e6)}).empty());
}

/// Half of the strength, but within the pressures that the angle was measured under.
TEST(FrictionAngle, IsToldUnderHalfTheStrengthOrWhatTheSourceHas) {
  fdem::StrengthConfig joint;
  joint.cohesion = 30e6;
  joint.friction_angle = std::asin(0.6);  // strength of 4 c
  EXPECT_NEAR(side_pressure({}, joint), 60e6, 1.0);
  EXPECT_EQ(side_pressure({{"compression", 80e6, "Pa"}}, joint), 40e6);
  EXPECT_EQ(side_pressure({{"compression", 80e6, "Pa"}, {"confinement", 9e6, "Pa"}}, joint), 9e6);
  EXPECT_EQ(rock_tests(40e6)[1].pressure, 40e6);
}

/// f_c = 80 MPa and N = 4 give 240 MPa under 40 MPa. 5 % of both strengths are 16 MPa, 0.4 of N,
/// 0.04 rad of the angle of 0.6435 rad: 6.2 %.
TEST(Passport, HoldsAPressedPlateAgainstTheAngleByItsStrength) {
  const std::vector<MaterialTarget> targets{{"compression", 80e6, "Pa"},
                                            {"friction_angle", std::asin(0.6), "rad"}};
  const std::vector<SpecimenTest> tests = rock_tests(40e6);
  const auto lines = [&](double free, double pressed) {
    return passport_lines({{tests[0], {{{}, {{"strength", free}}}}, {}},
                           {tests[1], {{{}, {{"strength", pressed}}}}, {}}},
                          targets);
  };
  const auto met = lines(80e6, 251e6), missed = lines(83.9e6, 227e6);
  ASSERT_EQ(met.size(), 3U);
  EXPECT_NEAR(*met[1].target, 240e6, 1.0);
  EXPECT_TRUE(met[1].pass() && met[2].pass());
  EXPECT_NEAR(met[2].tolerance, 0.04 / std::asin(0.6), 1e-4);
  EXPECT_TRUE(missed[0].pass());
  EXPECT_FALSE(missed[1].pass());
  EXPECT_FALSE(missed[2].pass());                                   // N = 3.58
  const std::string page = passport_page("m", "Plates.", {}, met);  // N = 4.275
  EXPECT_NE(page.find("| plates, free and pressed | friction angle | degrees | 38.38 (1) | 36.87 | "
                      "+4.1 % | pass |\n"),
            std::string::npos)
      << page;
}

TEST(RockSpecimens, AreCasesWithoutAProblem) {
  RockSample sample;
  sample.material.name = "granite";
  for (const SpecimenTest& test : rock_tests(40e6)) {
    const fdem::Config config = case_of(test, sample, 2, "");
    EXPECT_NO_THROW(fdem::check_case(config)) << test.name;
    EXPECT_EQ(config.loads.size(), test.pressure > 0.0 ? 2U : 0U);
    EXPECT_EQ(config.bodies[0].holes.size(), test.name == "disc" ? 2U : 0U);  // its flats
  }
  fdem::Config c;
  c.materials.resize(1);
  c.materials[0].name = "steel";
  c.materials[0].joints = "none";
  EXPECT_THROW(rock_sample_of(c, "steel"), InputError);
  EXPECT_EQ(refusal_of([&] { rock_sample_of(c, "rock"); }),
            "the case has no material rock; nothing was run");
}

TEST(Passport, HoldsMeansAgainstTargetsWithinTheirTolerances) {
  TestResults tension{test_named("tension"), {}, {}}, disc{test_named("brazilian"), {}, {}};
  for (const double strength : {2.9e6, 3.1e6}) {
    tension.specimens.push_back({{}, {{"strength", strength}}});
    disc.specimens.push_back({{}, {{"strength", 1.2 * strength}}});
  }
  const auto lines = passport_lines({tension, disc}, {{"tension", 3e6, "Pa"}});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[0].pass());
  EXPECT_FALSE(lines[1].pass());  // between f_t and f_t/0.9; 5 % beyond are allowed
  EXPECT_NEAR(lines[1].misfit(), 1.2 * 0.9 - 1.0, 1e-12);
  const std::string page = passport_page("c", "Spheres.", {tension, disc}, lines);
  EXPECT_NE(
      page.find("| direct tension, prism | strength | MPa | 3 +- 0.14 (2) | 3 | +0.0 % | pass |"),
      std::string::npos)
      << page;
  EXPECT_NE(page.find("| 3 to 3.333 | +8.0 % | **fail** |"), std::string::npos) << page;
  EXPECT_NE(page.find("| splitting over tension | 1.2 |"), std::string::npos) << page;
  EXPECT_EQ(specimens_table({tension, disc}),
            "test,specimen,quantity,unit,value\ntension,1,strength,MPa,2.9\n"
            "tension,2,strength,MPa,3.1\nbrazilian,1,strength,MPa,3.48\n"
            "brazilian,2,strength,MPa,3.72\n");
}

TEST(Passport, HoldsSplittingAgainstTheRangeOfBothCodes) {
  const auto line = [](double strength, std::vector<MaterialTarget> targets) {
    TestResults disc{test_named("brazilian"), {}, {}};
    disc.specimens.push_back({{}, {{"strength", strength}}});
    return passport_lines({disc}, targets).at(0);
  };
  const std::vector<MaterialTarget> tension{{"tension", 3e6, "Pa"}};
  EXPECT_EQ(line(3.1e6, tension).misfit(), 0.0);
  EXPECT_NEAR(line(2.7e6, tension).misfit(), -0.1, 1e-12);
  EXPECT_FALSE(line(2.7e6, tension).pass());
  const PassportLine own = line(3.1e6, {{"tension", 3e6, "Pa"}, {"brazilian", 2.5e6, "Pa"}});
  EXPECT_NEAR(own.misfit(), 0.24, 1e-12);  // a target of its own is a number
  EXPECT_EQ(own.target_text(), "2.5");
  EXPECT_EQ(own.shown_text(), "3.1 (1) MPa");
}

TEST(Specimens, OfADiscHaveElementsEnoughBelowTheirStrips) {
  for (const int elements : {300, 5000}) {
    Sample sample;
    sample.material.law = "concrete";
    sample.elements = elements;
    const dem::Config c = case_of(test_named("brazilian"), sample, 1, "");
    EXPECT_EQ(c.bodies[0].pack.count, std::max(elements, fewest_in_disc));
  }
}

TEST(TestCommand, WritesThePassportOfAMaterial) {
  const ScratchFolder scratch;
  replace_file(scratch / "c.toml", R"(
breccia = 1
method = "dem3d"
[time]
end = 1.0
[material.c]
law = "concrete"
[[body]]
name = "b"
shape = "box"
material = "c"
size = [0.1, 0.1, 0.1]
pack = { count = 100, compactness = 0.56 }
)");
  const std::string arguments =
      "test '" + scratch / "c.toml' --material c --only tension --seeds 1 " +
      "--elements 200 --target tension=3e6 --target poisson=0.2 -o '" + scratch / "out'";
  const int exit_code = wait_for(start_program(arguments, scratch / "output.txt"));
  EXPECT_TRUE(exit_code == 0 || exit_code == 9) << read_whole_file(scratch / "output.txt");
  const std::string page = read_whole_file(scratch / "out/passport.md");
  EXPECT_NE(page.find("| direct tension, prism | strength | MPa | "), std::string::npos) << page;
  const std::string drag = "its links do not damp, so specimens have local damping of 0.3;";
  EXPECT_NE(page.find("local damping 0.3."), std::string::npos) << page;
  EXPECT_NE(read_whole_file(scratch / "output.txt").find(drag), std::string::npos);
  wait_for(start_program(arguments + " --set material.c.link_damping=0.3", scratch / "output.txt"));
  EXPECT_EQ(read_whole_file(scratch / "output.txt").find(drag), std::string::npos);
  EXPECT_NE(read_whole_file(scratch / "out/passport.md").find("local damping 0."),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/curves/tension-1.csv"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/passport.svg"));
  EXPECT_NE(read_whole_file(scratch / "out/specimens.csv").find("\ntension,1,strength,MPa,"),
            std::string::npos);
  const auto refused = [&](const std::string& more, const std::string& words) {
    EXPECT_EQ(wait_for(start_program(arguments + " " + more, scratch / "output.txt")), 2) << more;
    const std::string said = read_whole_file(scratch / "output.txt");
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  refused("--only dance", "--only dance: no such test; nothing was run\n  there are bending, ");
  refused("--only tensoin", "; did you mean tension?");
  refused("--only platens_cube",
          "take 600 or more for platens_cube\n  or name others by --only: tension");
  refused("--target compression=38", "38 Pa is outside of 1 kPa to 10 TPa; did you mean '38 MPa'?");
  refused("--target friction_angle=55",
          "55 rad is outside of 0 to 90 degrees; did you mean '55 deg'?");
  refused("--target 'poisson=20'", "20 is outside of 0 to 0.5");
  refused("--target tension=4e6", "tension is asked for twice");
  refused("--first-seed -3", "--first-seed");
  refused("--damping 1.5", "--damping");
  EXPECT_EQ(
      wait_for(start_program("test '" + scratch / "c.toml' --material d", scratch / "output.txt")),
      2);
  EXPECT_NE(read_whole_file(scratch / "output.txt").find("no material d; did you mean c?"),
            std::string::npos);
}

TEST(TestCommand, TellsWhatIsWrongWithASpecimen) {
  const ScratchFolder scratch;
  replace_file(scratch / "r.toml", R"(
breccia = 1
method = "fdem2d"
[time]
end = 1.0
[material.r]
use = "marble-cherokee"
[[body]]
name = "b"
shape = "plate"
material = "r"
size = [0.1, 0.1]
mesh_size = 0.05
)");
  const std::string arguments =
      "test '" + scratch / "r.toml' --material r --only disc --seeds 1 -o '" + scratch / "out'";
  const std::string no_gmsh = "PATH=/nowhere; export PATH;";
  EXPECT_EQ(wait_for(start_program(arguments, scratch / "output.txt", no_gmsh)), 2);
  const std::string said = read_whole_file(scratch / "output.txt");
  EXPECT_NE(said.find("needs the program gmsh"), std::string::npos) << said;
}

}  // namespace passport_test
}  // namespace breccia::laboratory
