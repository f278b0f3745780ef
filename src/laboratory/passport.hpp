#pragma once
// Passport of a material: its tests beside a laboratory's, as curves, numbers, one page.

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/case/material_library.hpp"
#include "io/picture/line_plot.hpp"
#include "laboratory/concrete_tests.hpp"
#include "laboratory/statistics.hpp"

namespace breccia::laboratory {

/// A loading curve: strain [-] and stress [Pa] in the sense of the loading; of the beam deflection
/// [m] and force [N].
struct LoadCurve {
  std::string x_name, y_name;  ///< with units
  std::vector<double> x, y;
};

/// Of one specimen: its curve, and numbers by name: strength, young, poisson, peak_strain,
/// fracture_energy; residual (stress at three times the strain of the peak, over it); of the
/// oedometer strain_100, strain_1000 (at stresses in MPa), tangent_300, tangent_800, side_ratio;
/// under hydrostatic pressure pressure_1, pressure_2 (at linear strains in per cent).
struct SpecimenResult {
  LoadCurve curve;
  std::map<std::string, double> numbers;  ///<  [SI]
};

/// Reads the history of a run of the test.
/// @throws IoError, InputError if it cannot be read or lacks the test's probes
SpecimenResult specimen_result(const SpecimenTest& test, const std::string& folder);

/// All specimens of a test.
struct TestResults {
  SpecimenTest test;
  std::vector<SpecimenResult> specimens;
  std::vector<std::string> failures;  ///< of runs without a result
};

/// Of plates without and with a pressure on their sides, mesh by mesh: sin phi = (N - 1) / (N + 1),
/// N the gain of strength over the pressure. Empty where either is missing.  [rad]
std::vector<double> friction_angles(const std::vector<TestResults>& results);

/// A line of the passport.
struct PassportLine {
  std::string test, quantity, unit;
  Spread spread;
  std::optional<double> target;
  double tolerance = 0.0;         ///< of the mean, over the target
  std::optional<double> up_to{};  ///< the target is all between it and this

  double misfit() const;  ///< of the mean, from the nearer end of the target  [-]
  bool pass() const { return !target || std::abs(misfit()) <= tolerance; }
  /// Mean and deviation, and the target, in the unit of the page.
  std::string shown_text() const;
  std::string target_text() const;
};

/// @param targets  macroscopic numbers of the material; none: the line has no verdict. Means may
///                 miss them by 3 % (E), 5 % (strengths), 10 % (nu, fracture energy). Unless it has
///                 a target of its own, the splitting strength of spheres lies between the tensile
///                 one (fib Model Code 2010, 5.1.5.1) and that over 0.9 (EN 1992-1-1, 3.1.2).
std::vector<PassportLine> passport_lines(const std::vector<TestResults>& results,
                                         const std::vector<MaterialTarget>& targets);

/// specimens.csv: each number of each specimen, a line each, in the units of the page.
std::string specimens_table(const std::vector<TestResults>& results);

/// passport.md.
/// @param specimens  a sentence about their size and elements
std::string passport_page(const std::string& material, const std::string& specimens,
                          const std::vector<TestResults>& results,
                          const std::vector<PassportLine>& lines);

/// One plot a test with the curves of all specimens.
std::vector<LinePlot> passport_plots(const std::vector<TestResults>& results);

}  // namespace breccia::laboratory
