#include "laboratory/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "laboratory/rock_tests.hpp"

namespace breccia::laboratory {
namespace {

using Concrete = dem::MaterialConfig;
using Rock = fdem::MaterialConfig;

template <double Concrete::*value>
double get(const Concrete& m) {
  return m.*value;
}
template <double Concrete::*value>
void set(Concrete& m, double number) {
  m.*value = number;
}

constexpr double all = 1e300;

/// Twice the cohesion gives 1.5 times the compressive strength. Shares are about those that
/// calibrations of concretes end with: links of a packing show 1.3 to 1.7 T in tension where
/// softening gives their energy, and where G_F does 4 T, 2 T with the hyperbola, 1.5 T with a
/// knee; they show their G_F, and 1.4
/// times their nu, which grows with the 1.5th power of the key.
std::vector<Knob<Concrete>> knobs_of_links(const Concrete& m, bool by_energy) {
  const double ductile = m.criterion == "corner" ? 0.25 : 0.5;
  const double by_tension = !by_energy ? 0.7 : m.knee_strength > 0.0 ? 0.65 : ductile;
  return {
      {"young", "young", "compression_prism", "young", get<&Concrete::young>, set<&Concrete::young>,
       1.0, 0.03, 1.0, 0.0, all},
      {"poisson", "poisson", "compression_prism", "poisson", get<&Concrete::poisson>,
       set<&Concrete::poisson>, 1.5, 0.10, 0.72, 0.01, 1.0 / m.alpha},
      {"tensile_strength", "tension", "tension", "strength", get<&Concrete::tensile_strength>,
       set<&Concrete::tensile_strength>, 1.0, 0.05, by_tension, 0.0, all},
      {"cohesion", "compression", "compression_prism", "strength", get<&Concrete::cohesion>,
       set<&Concrete::cohesion>, 0.6, 0.05, 0.0, 0.0, all},
      {"fracture_energy", "fracture_energy", "tension_notched", "fracture_energy",
       get<&Concrete::fracture_energy>, set<&Concrete::fracture_energy>, 1.0, 0.10, 1.0, 0.0, all}};
}

/// G_t = s_t^2 l_t / (2 E_0) of a facet.
double facet_energy(const Concrete& m) {
  const double normal = m.young / (1.0 - 2.0 * m.poisson);
  return m.tensile_strength * m.tensile_strength * m.ldpm.tensile_length / (2.0 * normal);
}
/// By the length l_t, which stays longer than edges between grains.
void set_facet_energy(Concrete& m, double energy) {
  constexpr double longest_edges = 4.0;  // over the largest grain
  const double of_unit = facet_energy(m) / m.ldpm.tensile_length;
  m.ldpm.tensile_length = std::max(energy / of_unit, longest_edges * m.mix.largest);
}

/// Facets' numbers are near those of the concrete: shares are those that prisms with the parameters
/// of public benchmarks show, three times G_t among them, since grains crack around the crack, too.
/// The energy is set behind what it is made of.
std::vector<Knob<Concrete>> knobs_of_ldpm() {
  return {{"young", "young", "compression_prism", "young", get<&Concrete::young>,
           set<&Concrete::young>, 1.0, 0.03, 1.07, 0.0, all},
          {"poisson", "poisson", "compression_prism", "poisson", get<&Concrete::poisson>,
           set<&Concrete::poisson>, 1.0, 0.10, 0.85, 0.01, 0.249},
          {"tensile_strength", "tension", "tension", "strength", get<&Concrete::tensile_strength>,
           set<&Concrete::tensile_strength>, 1.0, 0.05, 1.0, 0.0, all},
          {"cohesion", "compression", "compression_prism", "strength", get<&Concrete::cohesion>,
           set<&Concrete::cohesion>, 0.8, 0.05, 0.2, 0.0, all},
          {"ldpm.tensile_length as tensile_strength^2 tensile_length (1 - 2 poisson) / (2 young)",
           "fracture_energy", "tension_notched", "fracture_energy", facet_energy, set_facet_energy,
           1.0, 0.10, 0.33, 0.0, all}};
}
std::vector<Knob<Concrete>> knobs_for(const Concrete& m, bool by_energy) {
  return m.law == "ldpm" ? knobs_of_ldpm() : knobs_of_links(m, by_energy);
}

/// Uniaxial strength of Mohr and Coulomb over the cohesion.
double strength_over_cohesion(const Rock& m) {
  const double phi = m.joint.friction_angle;
  return 2.0 * std::cos(phi) / (1.0 - std::sin(phi));
}

/// A friction angle is shown by the gain: near 60 degrees it grows by a tenth with each degree, so
/// that the angles themselves are no straight line.
double angle_of(double gain) {
  return std::asin((gain - 1.0) / (gain + 1.0));
}

/// Joints spend the energies that they are given (tests/law/fdem/joint_bond_test.cpp): those keys
/// are set. The cohesion is sought as the uniaxial strength that it gives, which the angle then
/// does not change; the angle is set before it.
std::vector<Knob<Rock>> knobs_for(const Rock&, bool) {
  constexpr double steepest = 1.3;    // rad
  constexpr double softened = 1.085;  // by joints of p_f = 20 E, E and nu alike (theory-fdem.md, 2)
  const auto f_t = [](const Rock& r) { return r.joint.tension; };
  const auto set_f_t = [](Rock& r, double x) { r.joint.tension = x; };
  const auto tension = [&](const char* target, const char* test, double share) {
    return Knob<Rock>{"joint.tension", target, test, "strength", f_t, set_f_t, 1.0, 0.05,
                      share,           0.0,    all};
  };
  return {
      {"young", "young", "plate", "young", [](const Rock& r) { return r.young; },
       [](Rock& r, double x) { r.young = x; }, 1.0, 0.03, softened, 0.0, all},
      {"poisson", "poisson", "plate", "poisson", [](const Rock& r) { return r.poisson; },
       [](Rock& r, double x) { r.poisson = x; }, 1.0, 0.10, softened, 0.01, 0.49},
      tension("brazilian", "disc", 0.9),
      tension("tension", "tension", 1.0),
      {"joint.friction_angle as (1 + sin(phi)) / (1 - sin(phi))", "friction_angle", "plate_pressed",
       "friction_angle", [](const Rock& r) { return gain_of(r.joint.friction_angle); },
       [](Rock& r, double x) { r.joint.friction_angle = angle_of(x); }, 1.0, 0.05, 1.0, 1.0,
       gain_of(steepest), "plate", gain_of},
      {"joint.cohesion times 2 cos(phi) / (1 - sin(phi))", "compression", "plate", "strength",
       [](const Rock& r) { return r.joint.cohesion * strength_over_cohesion(r); },
       [](Rock& r, double x) { r.joint.cohesion = x / strength_over_cohesion(r); }, 1.0, 0.05, 1.0,
       0.0, all},
      {"joint.energy_open", "fracture_energy", "", "",
       [](const Rock& r) { return r.joint.energy_open; },
       [](Rock& r, double x) { r.joint.energy_open = x; }, 1.0, 0.10, 1.0, 0.0, all},
      {"joint.energy_slide", "slide_energy", "", "",
       [](const Rock& r) { return r.joint.energy_slide; },
       [](Rock& r, double x) { r.joint.energy_slide = x; }, 1.0, 0.10, 1.0, 0.0, all}};
}

/// Whether numbers of a material stand in tables below it.
bool has_tables(const Concrete& m) {
  return m.law == "ldpm";
}
bool has_tables(const Rock&) {
  return true;
}

std::vector<SpecimenTest> tests_for(const Concrete& m, const std::vector<MaterialTarget>&) {
  return tests_of(m);
}
std::vector<SpecimenTest> tests_for(const Rock& m, const std::vector<MaterialTarget>& targets) {
  return rock_tests(side_pressure(targets, m.joint));
}

/// An angle may miss its target by 5 %, and by no more than changes the strength under pressure by
/// 5 %.
template <class Material>
double tolerance_of(const Knob<Material>& knob, double target,
                    const std::vector<SpecimenTest>& tests,
                    const std::vector<MaterialTarget>& targets) {
  double tolerance = knob.tolerance;
  if (std::string_view(knob.number) != "friction_angle") return tolerance;
  for (const SpecimenTest& test : tests)
    if (const auto strength = pressed_strength(targets, test.pressure);
        test.name == knob.test && strength)
      tolerance = std::min(tolerance, angle_for(target, 0.05 * *strength / test.pressure) / target);
  return tolerance;
}

/// A key changes by at most this factor from step to step.
constexpr double largest_change = 1.6;
/// A secant needs keys that differ by more than the scatter of packings can hide.
constexpr double least_difference = 0.02;

/// Solves a x = b by elimination with pivots; empty if a is singular.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    if (std::abs(a[pivot][k]) < 1e-9) return {};
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

}  // namespace

template <class Material>
Calibration<Material>::Calibration(Material start, std::vector<MaterialTarget> targets)
    : material_(std::move(start)) {
  const std::vector<SpecimenTest> possible = tests_for(material_, targets);
  const auto asked = [&](const char* name) {
    return std::find_if(targets.begin(), targets.end(),  // the first one counts
                        [&](const MaterialTarget& t) { return t.name == name; });
  };
  std::string names;
  for (const auto& knob : knobs_for(material_, asked("fracture_energy") != targets.end())) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", knob.target);
    const auto target = asked(knob.target);
    const bool taken = std::any_of(aims_.begin(), aims_.end(), [&](const Aim& a) {
      return std::string_view(a.knob.key) == knob.key;  // brazilian rules, not tension
    });
    if (target == targets.end() || taken) continue;
    if (!(target->value > 0.0))
      throw InputError(fmt::format("target {} must be above 0; nothing was run", target->name));
    aims_.push_back({knob, target->value});
    aims_.back().knob.tolerance = tolerance_of(knob, target->value, possible, targets);
  }
  if (std::none_of(aims_.begin(), aims_.end(), [](const Aim& a) { return a.knob.test[0] != '\0'; }))
    throw InputError("there is no target that a specimen shows: --target takes " + names +
                     "; nothing was run");
  for (const SpecimenTest& test : possible)
    if (std::any_of(aims_.begin(), aims_.end(), [&](const Aim& a) {
          return test.name == a.knob.test || test.name == a.knob.also;
        }))
      tests_.push_back(test);
  for (const Aim& aim : aims_)
    if (aim.knob.share > 0.0)
      aim.knob.set(material_, std::clamp(aim.knob.share * measured(aim, aim.target), aim.knob.low,
                                         aim.knob.high));
  slopes_.assign(aims_.size(), Row(aims_.size(), 0.0));
  for (std::size_t i = 0; i < aims_.size(); ++i) slopes_[i][i] = aims_[i].knob.sensitivity;
}

template <class Material>
double Calibration<Material>::misfit(const CalibrationStep<Material>& step, const Aim& aim) const {
  return step.shown.at(aim.knob.target).mean / aim.target - 1.0;
}

template <class Material>
double Calibration<Material>::measured(const Aim& aim, double number) const {
  return aim.knob.measure == nullptr ? number : aim.knob.measure(number);
}

template <class Material>
double Calibration<Material>::worst(const CalibrationStep<Material>& step) const {
  double worst = 0.0;
  for (const Aim& aim : aims_)
    worst = std::max(worst, std::abs(misfit(step, aim)) / aim.knob.tolerance);
  return worst;
}

template <class Material>
bool Calibration<Material>::converged() const {
  return !steps_.empty() && worst(steps_.back()) <= 1.0;
}

template <class Material>
const CalibrationStep<Material>& Calibration<Material>::best() const {
  return *std::min_element(steps_.begin(), steps_.end(),
                           [&](const auto& a, const auto& b) { return worst(a) < worst(b); });
}

template <class Material>
void Calibration<Material>::take(const std::vector<TestResults>& results) {
  CalibrationStep<Material> step{material_, {}};
  for (const Aim& aim : aims_) {
    if (aim.knob.test[0] == '\0') {
      step.shown[aim.knob.target] = {aim.knob.get(material_), 0.0, 0};
      continue;
    }
    std::vector<double> values;
    if (std::string_view(aim.knob.number) == "friction_angle") {
      values = friction_angles(results);
    } else {
      for (const TestResults& result : results)
        if (result.test.name == aim.knob.test)
          for (const SpecimenResult& specimen : result.specimens)
            values.push_back(specimen.numbers.at(aim.knob.number));
    }
    const Spread spread = spread_of(values);
    if (spread.n == 0 || !(spread.mean > 0.0))
      throw InputError(fmt::format("no specimen of {} shows its {}: calibration cannot go on",
                                   aim.knob.test, aim.knob.target));
    step.shown[aim.knob.target] = spread;
  }
  steps_.push_back(step);
  learn();
  choose_next();
}

template <class Material>
typename Calibration<Material>::Row Calibration<Material>::logs_of_keys(
    const CalibrationStep<Material>& step) const {
  Row row;
  for (const Aim& aim : aims_) row.push_back(std::log(aim.knob.get(step.material)));
  return row;
}

template <class Material>
typename Calibration<Material>::Row Calibration<Material>::logs_of_shown(
    const CalibrationStep<Material>& step) const {
  Row row;
  for (const Aim& aim : aims_)
    row.push_back(
        std::log(measured(aim, step.shown.at(aim.knob.target).mean) / measured(aim, aim.target)));
  return row;
}

template <class Material>
std::vector<double> Calibration<Material>::keys() const {
  std::vector<double> logs;
  for (const Aim& aim : aims_)
    if (aim.knob.test[0] != '\0') logs.push_back(std::log(aim.knob.get(material_)));
  return logs;
}

template <class Material>
void Calibration<Material>::set_keys(const std::vector<double>& logs) {
  std::size_t next = 0;
  for (const Aim& aim : aims_)
    if (aim.knob.test[0] != '\0')
      aim.knob.set(material_, std::clamp(std::exp(logs.at(next++)), aim.knob.low, aim.knob.high));
}

template <class Material>
std::vector<double> Calibration<Material>::misfits() const {
  std::vector<double> all;
  for (const Aim& aim : aims_)
    if (aim.knob.test[0] != '\0') all.push_back(misfit(steps_.back(), aim) / aim.knob.tolerance);
  return all;
}

/// J += (dy - J dx) dx^T / (dx . dx); a target keeps to its own key, within bounds.
template <class Material>
void Calibration<Material>::learn() {
  if (steps_.size() < 2) return;
  const Row x = logs_of_keys(steps_.back()), y = logs_of_shown(steps_.back());
  const Row x0 = logs_of_keys(steps_[steps_.size() - 2]);
  const Row y0 = logs_of_shown(steps_[steps_.size() - 2]);
  double squared = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) squared += (x[j] - x0[j]) * (x[j] - x0[j]);
  if (squared < least_difference * least_difference) return;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double missed = y[i] - y0[i];
    for (std::size_t j = 0; j < x.size(); ++j) missed -= slopes_[i][j] * (x[j] - x0[j]);
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double slope = slopes_[i][j] + missed * (x[j] - x0[j]) / squared;
      const double own = aims_[i].knob.sensitivity;
      slopes_[i][j] =
          i == j ? std::clamp(slope, 0.4 * own, 2.5 * own) : std::clamp(slope, -1.5, 1.5);
    }
  }
}

template <class Material>
void Calibration<Material>::choose_next() {
  const CalibrationStep<Material>& from = best();
  const Row y = logs_of_shown(from), x = logs_of_keys(from);
  Row change = solved(slopes_, y);
  if (change.empty())
    for (std::size_t i = 0; i < y.size(); ++i) change.push_back(y[i] / aims_[i].knob.sensitivity);
  material_ = from.material;
  for (std::size_t i = 0; i < aims_.size(); ++i) {
    const double most = std::log(largest_change);
    const double next = std::exp(x[i] - std::clamp(change[i], -most, most));
    aims_[i].knob.set(material_, std::clamp(next, aims_[i].knob.low, aims_[i].knob.high));
  }
}

template <class Material>
std::string Calibration<Material>::progress() const {
  std::string text;
  for (const Aim& aim : aims_)
    text += fmt::format("{}{} {:+.1f} %", text.empty() ? "" : ", ", aim.knob.target,
                        100.0 * misfit(steps_.back(), aim));
  return text;
}

template <class Material>
std::string Calibration<Material>::obstacles() const {
  const CalibrationStep<Material>& nearest = best();
  const auto number = [&](const CalibrationStep<Material>& step) {
    return static_cast<std::size_t>(&step - steps_.data()) + 1;
  };
  std::string missed, instead;
  for (const Aim& aim : aims_) {
    if (std::abs(misfit(nearest, aim)) <= aim.knob.tolerance) continue;
    missed +=
        fmt::format("{}{} {:+.1f} % (allowed: {:.0f})", missed.empty() ? "" : ", ", aim.knob.target,
                    100.0 * misfit(nearest, aim), 100.0 * aim.knob.tolerance);
    const double key = aim.knob.get(nearest.material);
    if (key <= aim.knob.low * (1.0 + 1e-9) || key >= aim.knob.high * (1.0 - 1e-9))
      missed += fmt::format(", with {} at its limit", aim.knob.key);
    // Where this target was met best, and what that cost.
    const auto& met = *std::min_element(steps_.begin(), steps_.end(), [&](auto& a, auto& b) {
      return std::abs(misfit(a, aim)) < std::abs(misfit(b, aim));
    });
    const Aim& other = *std::max_element(aims_.begin(), aims_.end(), [&](auto& a, auto& b) {
      return std::abs(misfit(met, a)) / a.knob.tolerance <
             std::abs(misfit(met, b)) / b.knob.tolerance;
    });
    if (&met != &nearest)
      instead += fmt::format(
          "; {} was met best in step {} ({:+.1f} %), where {} missed by {:+.1f} %", aim.knob.target,
          number(met), 100.0 * misfit(met, aim), other.knob.target, 100.0 * misfit(met, other));
  }
  return missed.empty() ? missed
                        : fmt::format("nearest is step {}: {}{}", number(nearest), missed, instead);
}

template <class Material>
std::string Calibration<Material>::page(const std::string& material,
                                        const std::string& circumstances) const {
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
      text += fmt::format(" {} | {}, {:+.1f} % |", short_number(aim.knob.get(steps_[k].material)),
                          spread_text(steps_[k].shown.at(aim.knob.target)),
                          100.0 * misfit(steps_[k], aim));
    text += "\n";
  }
  return text + "\nThe material with the keys of the best step:\n\n```toml\n" +
         block(circumstances) + "```\n";
}

template <class Material>
std::string Calibration<Material>::block(const std::string& circumstances) const {
  const CalibrationStep<Material>& step = best();
  std::string text = "# " + circumstances + "\n";
  for (const Aim& aim : aims_)
    text += aim.knob.test[0] == '\0'
                ? fmt::format("# {}: {}, set; no specimen shows it\n", aim.knob.target,
                              short_number(aim.target))
                : fmt::format("# {}: shown {}, target {}, {:+.1f} %\n", aim.knob.target,
                              spread_text(step.shown.at(aim.knob.target)), short_number(aim.target),
                              100.0 * misfit(step, aim));
  WriteKeys keys("material." + key_text(step.material.name) + ".");
  Material material = step.material;
  for (const Aim& aim : aims_)  // four digits are more than packings leave
    aim.knob.set(material, std::stod(fmt::format("{:.4g}", aim.knob.get(material))));
  material.each_key(keys);
  return text + "[material." + key_text(material.name) + "]\n" + keys.own +
         (has_tables(material) ? keys.below : "");
}

template <class Material>
LinePlot Calibration<Material>::plot() const {
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

template class Calibration<dem::MaterialConfig>;
template class Calibration<fdem::MaterialConfig>;

}  // namespace breccia::laboratory
