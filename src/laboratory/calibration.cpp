#include "laboratory/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"

namespace breccia::laboratory {
namespace {

using Material = dem::MaterialConfig;

constexpr std::array knobs{
    Knob{"young", "young", "compression_prism", "young", &Material::young, 1.0, 0.03},
    Knob{"poisson", "poisson", "compression_prism", "poisson", &Material::poisson, 1.0, 0.10},
    Knob{"tensile_strength", "tension", "tension", "strength", &Material::tensile_strength, 1.0,
         0.05},
    Knob{"cohesion", "compression", "compression_prism", "strength", &Material::cohesion, 0.6,
         0.05},
    Knob{"fracture_energy", "fracture_energy", "bending", "fracture_energy",
         &Material::fracture_energy, 1.0, 0.10}};

/// A key changes by at most this factor from step to step.
constexpr double largest_change = 1.6;
/// A secant needs keys that differ by more than the scatter of packings can hide.
constexpr double least_difference = 0.02;

const SpecimenTest& test_named(const std::string& name) {
  const auto& tests = specimen_tests();
  return *std::find_if(tests.begin(), tests.end(), [&](const auto& t) { return t.name == name; });
}

}  // namespace

Calibration::Calibration(Material start, std::vector<MaterialTarget> targets)
    : material_(std::move(start)) {
  for (const Knob& knob : knobs)
    for (const MaterialTarget& target : targets)
      if (target.name == knob.target) {
        if (!(target.value > 0.0))
          throw InputError(fmt::format("target {} must be above 0; nothing was run", target.name));
        aims_.push_back({knob, target.value});
        break;  // the first one counts
      }
  if (aims_.empty())
    throw InputError(
        "there is no target to calibrate by: --target takes young, poisson, tension, compression "
        "and fracture_energy; nothing was run");
  // Start: E is what the material is asked for; cohesion begins at the material's own. The other
  // shares are about those that calibrations of concretes end with: links of a packing show 1.3 to
  // 1.7 T in tension where softening gives their energy, and 3.5 T where G_F does; they show 2.5
  // times their G_F, and 1.4 times their nu.
  const bool by_energy = std::any_of(aims_.begin(), aims_.end(), [](const Aim& a) {
    return a.knob.value == &Material::fracture_energy;
  });
  for (const Aim& aim : aims_) {
    const auto value = aim.knob.value;
    if (value == &Material::cohesion) continue;
    const double share = value == &Material::tensile_strength  ? by_energy ? 0.29 : 0.7
                         : value == &Material::fracture_energy ? 0.4
                         : value == &Material::poisson         ? 0.72
                                                               : 1.0;
    material_.*value = share * aim.target;
  }
}

std::vector<SpecimenTest> Calibration::tests() const {
  std::vector<SpecimenTest> tests;
  for (const SpecimenTest& test : specimen_tests())
    if (std::any_of(aims_.begin(), aims_.end(),
                    [&](const Aim& a) { return test.name == a.knob.test; }))
      tests.push_back(test);
  return tests;
}

double Calibration::misfit(const CalibrationStep& step, const Aim& aim) const {
  return step.shown.at(aim.knob.target).mean / aim.target - 1.0;
}

double Calibration::worst(const CalibrationStep& step) const {
  double worst = 0.0;
  for (const Aim& aim : aims_)
    worst = std::max(worst, std::abs(misfit(step, aim)) / aim.knob.tolerance);
  return worst;
}

bool Calibration::converged() const {
  return !steps_.empty() && worst(steps_.back()) <= 1.0;
}

const CalibrationStep& Calibration::best() const {
  return *std::min_element(steps_.begin(), steps_.end(),
                           [&](const auto& a, const auto& b) { return worst(a) < worst(b); });
}

void Calibration::take(const std::vector<TestResults>& results) {
  CalibrationStep step{material_, {}};
  for (const Aim& aim : aims_) {
    std::vector<double> values;
    for (const TestResults& result : results)
      if (result.test.name == aim.knob.test)
        for (const SpecimenResult& specimen : result.specimens)
          values.push_back(specimen.numbers.at(aim.knob.number));
    const Spread spread = spread_of(values);
    if (spread.n == 0 || !(spread.mean > 0.0))
      throw InputError(fmt::format("no specimen of {} shows its {}: calibration cannot go on",
                                   test_named(aim.knob.test).title, aim.knob.target));
    step.shown[aim.knob.target] = spread;
  }
  steps_.push_back(step);
  choose_next();
}

void Calibration::choose_next() {
  const CalibrationStep& last = steps_.back();
  for (const Aim& aim : aims_) {
    const double value = last.material.*aim.knob.value;
    double slope = aim.knob.sensitivity;
    if (steps_.size() > 1) {
      const CalibrationStep& former = steps_[steps_.size() - 2];
      const double apart = std::log(value / former.material.*aim.knob.value);
      const double change =
          std::log(last.shown.at(aim.knob.target).mean / former.shown.at(aim.knob.target).mean);
      if (std::abs(apart) > least_difference)
        slope = std::clamp(change / apart, 0.4 * slope, 2.5 * slope);
    }
    const double wanted = std::pow(1.0 + misfit(last, aim), -1.0 / slope);
    double& next = material_.*aim.knob.value;
    next = value * std::clamp(wanted, 1.0 / largest_change, largest_change);
    if (std::string_view(aim.knob.key) == "poisson") next = std::min(next, 1.0 / material_.alpha);
  }
}

std::string Calibration::progress() const {
  std::string text;
  for (const Aim& aim : aims_)
    text += fmt::format("{}{} {:+.1f} %", text.empty() ? "" : ", ", aim.knob.target,
                        100.0 * misfit(steps_.back(), aim));
  return text;
}

std::string Calibration::page(const std::string& material, const std::string& circumstances) const {
  std::string text =
      fmt::format("# Calibration of {}\n\n{}\n\n![misfits](calibration.svg)\n\n| step |", material,
                  circumstances);
  std::string rule = "|---|";
  for (const Aim& aim : aims_) {
    text += fmt::format(" {} | {}, misfit |", aim.knob.key, aim.knob.target);
    rule += "---|---|";
  }
  text += "\n" + rule + "\n";
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    text += fmt::format("| {}{} |", k + 1, &steps_[k] == &best() ? ", best" : "");
    for (const Aim& aim : aims_)
      text += fmt::format(" {} | {}, {:+.1f} % |", short_number(steps_[k].material.*aim.knob.value),
                          spread_text(steps_[k].shown.at(aim.knob.target)),
                          100.0 * misfit(steps_[k], aim));
    text += "\n";
  }
  return text + "\nThe material with the keys of the best step:\n\n```toml\n" +
         block(circumstances) + "```\n";
}

std::string Calibration::block(const std::string& circumstances) const {
  const CalibrationStep& step = best();
  std::string text = "# " + circumstances + "\n";
  for (const Aim& aim : aims_)
    text += fmt::format("# {}: shown {}, target {}, {:+.1f} %\n", aim.knob.target,
                        spread_text(step.shown.at(aim.knob.target)), short_number(aim.target),
                        100.0 * misfit(step, aim));
  WriteKeys keys;
  Material material = step.material;
  for (const Aim& aim : aims_)  // four digits are more than packings leave
    material.*aim.knob.value = std::stod(fmt::format("{:.4g}", material.*aim.knob.value));
  material.each_key(keys);
  return text + "[material." + key_text(material.name) + "]\n" + keys.own;
}

LinePlot Calibration::plot() const {
  LinePlot plot{
      "Misfit of each target", "step", "shown over target, less 1 [%]", {}, {{"", 0.0}}, {}};
  for (const Aim& aim : aims_) {
    PlotSeries line{aim.knob.target, {}, {}, {}, true, true};
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Spread& spread = steps_[k].shown.at(aim.knob.target);
      line.x.push_back(static_cast<double>(k + 1));
      line.y.push_back(100.0 * misfit(steps_[k], aim));
      line.error.push_back(100.0 * spread.deviation / aim.target);
    }
    plot.series.push_back(line);
  }
  return plot;
}

}  // namespace breccia::laboratory
