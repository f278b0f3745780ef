#include "laboratory/passport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "report/table.hpp"

namespace breccia::laboratory {
namespace {

using Values = std::vector<double>;

Values column(const report::NumberTable& table, const char* name, const std::string& folder) {
  const report::Column* const found = table.column(name);
  if (found == nullptr || found->values.empty())
    throw InputError(fmt::format("{}/history.csv has no values of {}", folder, name));
  return found->values;
}

/// How far the distance of two probes has grown.
Values growth(const Values& a, const Values& b) {
  Values result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result[k] = (a[k] - b[k]) - (a[0] - b[0]);
  return result;
}

Values scaled(Values values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::size_t peak_of(const Values& y) {
  return static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin());
}

/// Slope of y over x between two shares of the peak of `load`, before it; not a number without
/// three such points.
double slope_between(const Values& x, const Values& y, const Values& load, double low,
                     double high) {
  const std::size_t peak = peak_of(load);
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k <= peak; ++k) {
    if (load[k] > high * load[peak]) break;
    if (load[k] < low * load[peak]) continue;
    n += 1.0, sx += x[k], sy += y[k], sxx += x[k] * x[k], sxy += x[k] * y[k];
  }
  return n < 3.0 ? std::nan("") : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double work(const LoadCurve& curve) {
  double sum = 0.0;
  for (std::size_t k = 1; k < curve.x.size(); ++k)
    sum += 0.5 * (curve.y[k] + curve.y[k - 1]) * (curve.x[k] - curve.x[k - 1]);
  return sum;
}

/// Half the difference of the forces at both ends, positive in the sense of the loading.
Values load_of(const report::NumberTable& table, const std::string& folder) {
  const Values top = column(table, "force_top", folder);
  const Values bottom = column(table, "force_bottom", folder);
  Values force(top.size());
  for (std::size_t k = 0; k < top.size(); ++k) force[k] = 0.5 * (top[k] - bottom[k]);
  const auto [low, high] = std::minmax_element(force.begin(), force.end());
  return scaled(force, std::abs(*low) > std::abs(*high) ? -1.0 : 1.0);
}

SpecimenResult of_prism(const SpecimenTest& test, const report::NumberTable& table,
                        const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const double sense = test.loading == Loading::tension ? 1.0 : -1.0;
  const Values strain = scaled(growth(top, bottom), sense / (top[0] - bottom[0]));
  const Values stress = scaled(load_of(table, folder), 1.0 / (test.size.x * test.size.y));
  const std::size_t peak = peak_of(stress);
  SpecimenResult result{{"strain [-]", "stress [Pa]", strain, stress}, {}};
  result.numbers["strength"] = stress[peak];
  result.numbers["peak_strain"] = strain[peak];
  if (test.loading == Loading::platens || test.loading == Loading::triaxial)
    return result;  // the give of walls is in the strain
  result.numbers["young"] = slope_between(strain, stress, stress, 0.1, 0.4);
  const Values right = column(table, "right", folder), left = column(table, "left", folder);
  const Values across = scaled(growth(right, left), -sense / (right[0] - left[0]));
  result.numbers["poisson"] = slope_between(strain, across, stress, 0.1, 0.4);
  return result;
}

SpecimenResult of_disc(const SpecimenTest& test, const report::NumberTable& table,
                       const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const Values strain = scaled(growth(top, bottom), -1.0 / test.size.x);
  // sigma = 2 P / (pi d t)
  const Values stress = scaled(load_of(table, folder), 2.0 / (pi * test.size.x * test.size.z));
  SpecimenResult result{{"closing over diameter [-]", "2 P / (pi d t) [Pa]", strain, stress}, {}};
  result.numbers["strength"] = stress[peak_of(stress)];
  return result;
}

SpecimenResult of_beam(const SpecimenTest& test, const report::NumberTable& table,
                       const std::string& folder) {
  const Values top = column(table, "top", folder);
  Values deflection(top.size()), force = column(table, "force_top", folder);
  for (std::size_t k = 0; k < top.size(); ++k) deflection[k] = top[0] - top[k];
  const auto [low, high] = std::minmax_element(force.begin(), force.end());
  force = scaled(force, std::abs(*low) > std::abs(*high) ? -1.0 : 1.0);
  SpecimenResult result{{"deflection [m]", "force [N]", deflection, force}, {}};
  const double ligament = test.size.y * (test.size.z - beam_notch);
  const double peak = force[peak_of(force)];
  result.numbers["fracture_energy"] = work(result.curve) / ligament;
  // Of the section above the notch, by the theory of beams.
  const double depth = test.size.z - beam_notch;
  result.numbers["strength"] = 1.5 * peak * beam_span / (test.size.y * depth * depth);
  return result;
}

std::optional<double> target_of(const std::vector<MaterialTarget>& targets,
                                const std::string& name) {
  for (const MaterialTarget& target : targets)
    if (target.name == name) return target.value;
  return std::nullopt;
}

/// Which target a number of a test is held against.
std::string target_name(const SpecimenTest& test, const std::string& number,
                        const std::vector<MaterialTarget>& targets) {
  if (test.name == "compression_prism") {
    if (number == "strength") return "compression";
    if (number == "young" || number == "poisson") return number;
  }
  if (test.name == "tension" && number == "strength") return "tension";
  if (test.name == "brazilian" && number == "strength")
    return target_of(targets, "brazilian") ? "brazilian" : "tension";
  if (test.name == "bending" && number == "fracture_energy") return number;
  return "";
}

double tolerance_of(const std::string& target) {
  if (target == "young") return 0.03;
  return target == "poisson" || target == "fracture_energy" ? 0.10 : 0.05;
}

struct Shown {
  const char *name, *words, *unit;
  double factor;
};
constexpr std::array shown{Shown{"strength", "strength", "MPa", 1e-6},
                           Shown{"peak_strain", "strain at the peak", "1e-3", 1e3},
                           Shown{"young", "E", "GPa", 1e-9}, Shown{"poisson", "nu", "-", 1.0},
                           Shown{"fracture_energy", "fracture energy", "J/m2", 1.0}};
const Shown& shown_of(const std::string& name) {
  return *std::find_if(shown.begin(), shown.end(), [&](const Shown& s) { return name == s.name; });
}

}  // namespace

SpecimenResult specimen_result(const SpecimenTest& test, const std::string& folder) {
  const report::NumberTable table = report::read_table(folder + "/history.csv");
  switch (test.loading) {
    case Loading::brazilian:
      return of_disc(test, table, folder);
    case Loading::bending:
      return of_beam(test, table, folder);
    default:
      return of_prism(test, table, folder);
  }
}

bool PassportLine::pass() const {
  return !target || std::abs(spread.mean - *target) <= tolerance * std::abs(*target);
}

std::vector<PassportLine> passport_lines(const std::vector<TestResults>& results,
                                         const std::vector<MaterialTarget>& targets) {
  std::vector<PassportLine> lines;
  for (const TestResults& result : results)
    for (const Shown& number : shown) {
      Values values;
      for (const SpecimenResult& specimen : result.specimens)
        if (const auto found = specimen.numbers.find(number.name); found != specimen.numbers.end())
          values.push_back(found->second);
      if (values.empty()) continue;
      const std::string target = target_name(result.test, number.name, targets);
      lines.push_back({result.test.title, number.name, number.unit, spread_of(values),
                       target_of(targets, target), tolerance_of(target)});
    }
  return lines;
}

std::string passport_page(const std::string& material, const Sample& sample,
                          const std::vector<TestResults>& results,
                          const std::vector<PassportLine>& lines) {
  std::string text = fmt::format(
      "# Passport of {}\n\nSpecimens of spheres, {} in the prism of 0.1 x 0.1 x 0.2 m and in the "
      "disc, "
      "and as large ones as the prism's in the others; compactness {}, interaction range {}. Mean, "
      "+- the deviation of the "
      "sample, and number of packings.\n\n![curves](passport.svg)\n\n"
      "| test | quantity | unit | shown | target | misfit | verdict "
      "|\n|---|---|---|---|---|---|---|\n",
      material, sample.elements, sample.compactness, sample.range);
  for (const PassportLine& line : lines) {
    const Shown& s = shown_of(line.quantity);
    text += fmt::format("| {} | {} | {} | {} |", line.test, s.words, s.unit,
                        spread_text(line.spread, s.factor));
    if (line.target)
      text += fmt::format(" {} | {:+.1f} % | {} |\n", short_number(s.factor * *line.target),
                          100.0 * (line.spread.mean / *line.target - 1.0),
                          line.pass() ? "pass" : "**fail**");
    else
      text += " - | - | - |\n";
  }
  const auto mean = [&](const std::string& title) {
    for (const PassportLine& line : lines)
      if (line.test == title && line.quantity == "strength") return line.spread.mean;
    return std::nan("");
  };
  const auto ratio = [&](const char* words, std::size_t a, std::size_t b) {
    const double value = mean(specimen_tests()[a].title) / mean(specimen_tests()[b].title);
    if (std::isfinite(value)) text += fmt::format("| {} | {} |\n", words, short_number(value));
  };
  text += "\n| ratio of means | shown |\n|---|---|\n";
  ratio("compression over tension", 0, 4);
  ratio("rough cube over rough prism (real concrete: 1.20 to 1.25)", 3, 2);
  ratio("rough prism over smooth prism", 2, 0);
  ratio("splitting over tension", 5, 4);
  std::string failures;
  for (const TestResults& result : results)
    for (const std::string& failure : result.failures)
      failures += fmt::format("- {}: {}\n", result.test.title, failure);
  if (!failures.empty()) text += "\n## Specimens without a result\n\n" + failures;
  return text;
}

std::vector<LinePlot> passport_plots(const std::vector<TestResults>& results) {
  std::vector<LinePlot> plots;
  for (const TestResults& result : results) {
    if (result.specimens.empty()) continue;
    LinePlot plot{result.test.title,
                  result.specimens[0].curve.x_name,
                  result.specimens[0].curve.y_name,
                  {},
                  {},
                  {}};
    for (const SpecimenResult& specimen : result.specimens)
      plot.series.push_back({"", specimen.curve.x, specimen.curve.y, {}, true, false});
    plots.push_back(plot);
  }
  return plots;
}

}  // namespace breccia::laboratory
