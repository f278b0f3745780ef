#pragma once
// From macroscopic numbers of a concrete to its local ones: each target is mostly the work of one
// key, so each key follows its own target by secants, all at once.

#include <map>
#include <string>
#include <vector>

#include "io/case/material_library.hpp"
#include "io/picture/line_plot.hpp"
#include "laboratory/passport.hpp"

namespace breccia::laboratory {

/// A key of the material and the target that it is found by.
struct Knob {
  const char* key;     ///< as in [material.<name>]
  const char* target;  ///< as in MaterialTarget
  const char* test;    ///< the specimen test that shows it
  const char* number;  ///< of its results
  double dem::MaterialConfig::*value;
  /// d log(shown) / d log(key) before two steps are known. Twice the cohesion gives 1.5 times the
  /// compressive strength.
  double sensitivity;
  double tolerance;  ///< of the mean, over the target
};

/// One set of keys, and what it has shown.
struct CalibrationStep {
  dem::MaterialConfig material;
  std::map<std::string, Spread> shown;  ///< by target
};

class Calibration {
 public:
  /// @throws InputError if no target is one that a key follows, or a target is not above 0
  Calibration(dem::MaterialConfig start, std::vector<MaterialTarget> targets);

  /// The tests that show the targets.
  std::vector<SpecimenTest> tests() const;
  /// The keys to try next: at first the closed-form start.
  const dem::MaterialConfig& material() const { return material_; }
  /// Takes what they have shown, and chooses the next ones. @throws InputError if a target was not
  /// shown, since no specimen has come to its end
  void take(const std::vector<TestResults>& results);

  /// Whether all means of the last step are within the tolerances.
  bool converged() const;
  /// The step whose largest misfit over its tolerance is least.
  const CalibrationStep& best() const;
  const std::vector<CalibrationStep>& steps() const { return steps_; }

  /// One line about the last step: shown over target, in percent.
  std::string progress() const;
  /// calibration.md: every step.
  std::string page(const std::string& material, const std::string& circumstances) const;
  /// [material.<name>] with the best keys, and its record as comments.
  std::string block(const std::string& circumstances) const;
  /// Misfit of each target over the steps.
  LinePlot plot() const;

 private:
  struct Aim {
    Knob knob;
    double target;
  };
  double misfit(const CalibrationStep& step, const Aim& aim) const;
  double worst(const CalibrationStep& step) const;
  void choose_next();

  dem::MaterialConfig material_;
  std::vector<Aim> aims_;
  std::vector<CalibrationStep> steps_;
};

}  // namespace breccia::laboratory
