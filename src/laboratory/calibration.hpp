#pragma once
// From macroscopic numbers of a concrete or a rock to its local ones: each target is mostly the
// work of one key; what the keys do to the other targets is learnt from step to step.

#include <map>
#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "io/case/material_library.hpp"
#include "io/picture/line_plot.hpp"
#include "laboratory/passport.hpp"

namespace breccia::laboratory {

/// A key of the material and the target that it is found by.
template <class Material>
struct Knob {
  const char* key;     ///< as in [material.<name>]
  const char* target;  ///< as in MaterialTarget
  const char* test;    ///< the specimen test that shows it; empty: the key is the target
  const char* number;  ///< of its results
  double (*get)(const Material&);
  void (*set)(Material&, double);
  double sensitivity;     ///< d log(shown) / d log(key) at first  [-]
  double tolerance;       ///< of the mean, over the target
  double share;           ///< first value over the target; 0: the material's own
  double low, high;       ///< what the key may be
  const char* also = "";  ///< another test that the number needs
  /// Of shown numbers and the target, what the key works on; none: themselves.
  double (*measure)(double) = nullptr;
};

/// One set of keys, and what it has shown.
template <class Material>
struct CalibrationStep {
  Material material;
  std::map<std::string, Spread> shown;  ///< by target
};

/// Broyden's secants in the logarithms of keys and shown numbers: d log(shown_i) / d log(key_j)
/// begins with each target's own key and takes up what each step has shown, so that five numbers
/// need no trial of each key alone. A step starts from the best one so far.
/// @tparam Material  dem::MaterialConfig or fdem::MaterialConfig
template <class Material>
class Calibration {
 public:
  /// @throws InputError if no target is one that a key follows, or a target is not above 0
  Calibration(Material start, std::vector<MaterialTarget> targets);

  /// The tests that show the targets.
  const std::vector<SpecimenTest>& tests() const { return tests_; }
  /// The keys to try next: at first the closed-form start.
  const Material& material() const { return material_; }
  /// Takes what they have shown, and chooses the next ones. @throws InputError if a target was not
  /// shown, since no specimen has come to its end
  void take(const std::vector<TestResults>& results);

  /// For searches that choose the keys themselves: logarithms of the keys that specimens show, of
  /// material() as in logs_of_keys, and the misfits of the last step over their tolerances.
  std::vector<double> keys() const;
  void set_keys(const std::vector<double>& logs);
  std::vector<double> misfits() const;

  /// Whether all means of the last step are within the tolerances.
  bool converged() const;
  /// The step whose largest misfit over its tolerance is least.
  const CalibrationStep<Material>& best() const;
  const std::vector<CalibrationStep<Material>>& steps() const { return steps_; }

  /// One line about the last step: shown over target, in percent.
  std::string progress() const;
  /// Of the best step, what is beyond its tolerance, and what stands in the way; empty: nothing.
  std::string obstacles() const;
  /// calibration.md: every step.
  std::string page(const std::string& material, const std::string& circumstances) const;
  /// [material.<name>] with the best keys, and its record as comments.
  std::string block(const std::string& circumstances) const;
  /// Misfit of each target over the steps.
  LinePlot plot() const;

 private:
  struct Aim {
    Knob<Material> knob;
    double target;
  };
  using Row = std::vector<double>;
  double misfit(const CalibrationStep<Material>& step, const Aim& aim) const;
  double measured(const Aim& aim, double number) const;
  double worst(const CalibrationStep<Material>& step) const;
  Row logs_of_keys(const CalibrationStep<Material>& step) const;
  Row logs_of_shown(const CalibrationStep<Material>& step) const;  ///< over the targets
  void learn();
  void choose_next();

  Material material_;
  std::vector<Aim> aims_;
  std::vector<SpecimenTest> tests_;
  std::vector<Row> slopes_;  ///< [target][key]
  std::vector<CalibrationStep<Material>> steps_;
};

extern template class Calibration<dem::MaterialConfig>;
extern template class Calibration<fdem::MaterialConfig>;

}  // namespace breccia::laboratory
