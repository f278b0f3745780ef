#include "laboratory/passport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "exec/error.hpp"
#include "laboratory/rock_tests.hpp"
#include "math/constants.hpp"
#include "report/table.hpp"

namespace breccia::laboratory {
namespace {

using Values = std::vector<double>;

/// Between which shares of the peak E and nu are read: EN 12390-13.
constexpr double elastic_from = 0.1, elastic_to = 1.0 / 3.0;

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

/// Energy that softening, sliding and turning of links took: work less what is stored, and less
/// local damping, which no specimen has.
double spent(const report::NumberTable& table, const std::string& folder) {
  double sum = 0.0;
  for (const char* name : {"fracture", "friction", "plastic"})
    sum += column(table, name, folder).back();
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

/// Stress at three times the strain of the peak, over the peak's; means over a tenth of that
/// strain.
double residual_of(const Values& strain, const Values& stress, std::size_t peak) {
  double sum = 0.0, n = 0.0;
  for (std::size_t k = peak; k < strain.size(); ++k)
    if (std::abs(strain[k] - 3.0 * strain[peak]) < 0.15 * strain[peak]) sum += stress[k], n += 1.0;
  return sum / (n * stress[peak]);
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
  if (test.loading == Loading::platens || test.loading == Loading::compression)
    result.numbers["residual"] = residual_of(strain, stress, peak);
  if (test.loading == Loading::platens || test.loading == Loading::triaxial ||
      test.loading == Loading::biaxial)
    return result;  // the give of walls is in the strain, or there are no gauges
  result.numbers["young"] = slope_between(strain, stress, stress, elastic_from, elastic_to);
  const Values right = column(table, "right", folder), left = column(table, "left", folder);
  const Values across = scaled(growth(right, left), -sense / (right[0] - left[0]));
  result.numbers["poisson"] = slope_between(strain, across, stress, elastic_from, elastic_to);
  return result;
}

/// y where x first reaches a value; not a number if it never does.
double first_at(const Values& x, const Values& y, double value) {
  for (std::size_t k = 1; k < x.size(); ++k)
    if (x[k] >= value) return y[k - 1] + (y[k] - y[k - 1]) * (value - x[k - 1]) / (x[k] - x[k - 1]);
  return std::nan("");
}

SpecimenResult of_oedometer(const SpecimenTest& test, const report::NumberTable& table,
                            const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const Values strain = scaled(growth(top, bottom), -1.0 / (top[0] - bottom[0]));
  const Values stress = scaled(load_of(table, folder), 1.0 / (test.size.x * test.size.y));
  const Values side = column(table, "force_side", folder);
  SpecimenResult result{{"strain [-]", "stress [Pa]", strain, stress}, {}};
  auto& n = result.numbers;
  n["strain_100"] = first_at(stress, strain, 100e6);
  n["strain_1000"] = first_at(stress, strain, 1e9);
  // over a fifth of the stress to both sides: platens meet one sphere after the other
  const auto tangent = [&](double at) {
    return 0.4 * at / (first_at(stress, strain, 1.2 * at) - first_at(stress, strain, 0.8 * at));
  };
  n["tangent_300"] = tangent(300e6);
  n["tangent_800"] = tangent(800e6);
  n["side_ratio"] = std::abs(first_at(stress, side, 1e9)) / (1e9 * test.size.y * test.size.z);
  return result;
}

/// All three edges shorten alike.
SpecimenResult of_pressure(const SpecimenTest& test, const report::NumberTable& table,
                           const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const Values strain = scaled(growth(top, bottom), -1.0 / (top[0] - bottom[0]));
  const Values stress = scaled(load_of(table, folder), 1.0 / (test.size.x * test.size.y));
  SpecimenResult result{{"strain [-]", "pressure [Pa]", strain, stress}, {}};
  result.numbers["pressure_1"] = first_at(strain, stress, 0.01);
  result.numbers["pressure_2"] = first_at(strain, stress, 0.02);
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

/// The peak; not a number where the load still grows as the test ends.
double peak_within(const Values& stress) {
  const std::size_t peak = peak_of(stress);
  return peak + 1 + stress.size() / 100 >= stress.size() ? std::nan("") : stress[peak];
}

/// Under pressure a broken rock may bear more and more again as its pieces wedge: the largest
/// stress before the first fall by a twentieth beyond half of the largest at all.
double first_peak_of(const Values& stress) {
  const double least = 0.5 * stress[peak_of(stress)];
  double most = least;
  for (std::size_t k = 0; k < stress.size(); ++k) {
    most = std::max(most, stress[k]);
    if (most > least && stress[k] < 0.95 * most) return most;
  }
  return peak_within(stress);
}

/// A plate in plane stress, of unit thickness.
SpecimenResult of_plate(const SpecimenTest& test, const report::NumberTable& table,
                        const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const double sense = test.loading == Loading::pulled_plate ? 1.0 : -1.0;
  const Values strain = scaled(growth(top, bottom), sense / (top[0] - bottom[0]));
  const Values stress = scaled(load_of(table, folder), 1.0 / test.size.x);
  const std::size_t peak = peak_of(stress);
  SpecimenResult result{{"strain [-]", "stress [Pa]", strain, stress}, {}};
  result.numbers["strength"] = test.pressure > 0.0 ? first_peak_of(stress) : stress[peak];
  result.numbers["peak_strain"] = strain[peak];
  if (test.pressure > 0.0) return result;  // the sides have been pressed meanwhile
  result.numbers["young"] = slope_between(strain, stress, stress, elastic_from, elastic_to);
  const Values right = column(table, "right", folder), left = column(table, "left", folder);
  const Values across = scaled(growth(right, left), -sense / test.size.x);
  result.numbers["poisson"] = slope_between(strain, across, stress, elastic_from, elastic_to);
  return result;
}

SpecimenResult of_plane_disc(const SpecimenTest& test, const report::NumberTable& table,
                             const std::string& folder) {
  const Values top = column(table, "top", folder), bottom = column(table, "bottom", folder);
  const Values closing = scaled(growth(top, bottom), -1.0 / test.size.x);
  const Values stress = scaled(load_of(table, folder), 2.0 / (pi * test.size.x));
  SpecimenResult result{{"closing over diameter [-]", "2 P / (pi d t) [Pa]", closing, stress}, {}};
  result.numbers["strength"] = peak_within(stress);
  return result;
}

SpecimenResult of_beam(const SpecimenTest& test, const report::NumberTable& table,
                       const std::string& folder) {
  const Values top = column(table, "top", folder);
  Values deflection(top.size()), force = column(table, "force_top", folder);
  for (std::size_t k = 0; k < top.size(); ++k) deflection[k] = top[0] - top[k];
  if (test.apart > 0.0) {
    const Values right = column(table, "force_top_right", folder);
    for (std::size_t k = 0; k < force.size(); ++k) force[k] += right[k];
  }
  const auto [low, high] = std::minmax_element(force.begin(), force.end());
  force = scaled(force, std::abs(*low) > std::abs(*high) ? -1.0 : 1.0);
  SpecimenResult result{{"deflection [m]", "force [N]", deflection, force}, {}};
  const double depth = test.size.z - test.notch;
  const double peak = force[peak_of(force)];
  if (test.notch > 0.0)  // a plain beam's holds work spread over its length
    result.numbers["fracture_energy"] = spent(table, folder) / (test.size.y * depth);
  // Of the section above the notch, by the theory of beams.
  result.numbers["strength"] =
      1.5 * peak * (beam_span - test.apart) / (test.size.y * depth * depth);
  return result;
}

SpecimenResult of_notched_prism(const SpecimenTest& test, const report::NumberTable& table,
                                const std::string& folder) {
  const double ligament = test.size.y * (test.size.x - 2.0 * test.notch);
  const Values opening = growth(column(table, "top", folder), column(table, "bottom", folder));
  const Values stress = scaled(load_of(table, folder), 1.0 / ligament);
  SpecimenResult result{{"elongation [m]", "stress of the ligament [Pa]", opening, stress}, {}};
  result.numbers["strength"] = stress[peak_of(stress)];
  result.numbers["fracture_energy"] = spent(table, folder) / ligament;
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
  if (test.name == "compression_prism" || test.name == "plate") {
    if (number == "strength") return "compression";
    if (number == "young" || number == "poisson") return number;
  }
  if (test.name == "tension" && number == "strength") return "tension";
  if (test.name == "disc" && number == "strength") return "brazilian";
  if (test.name == "brazilian" && number == "strength")
    return target_of(targets, "brazilian") ? "brazilian" : "tension";
  if (test.name == "tension_notched" && number == "fracture_energy") return number;
  return "";
}

double tolerance_of(const std::string& target) {
  if (target == "young") return 0.03;
  return target == "poisson" || target == "fracture_energy" ? 0.10 : 0.05;
}

/// The share of an angle that 5 % of both strengths, free and under pressure, leave open.
double angle_tolerance(const std::vector<TestResults>& results,
                       const std::vector<MaterialTarget>& targets) {
  double tolerance = 0.05;
  for (const TestResults& result : results)
    if (const double p = result.test.pressure; result.test.loading == Loading::plate && p > 0.0)
      if (const auto pressed = pressed_strength(targets, p)) {
        const double both = *pressed + *target_of(targets, "compression");
        const double angle = *target_of(targets, "friction_angle");
        tolerance = angle_for(angle, 0.05 * both / p) / angle;
      }
  return tolerance;
}

struct Shown {
  const char *name, *words, *unit;
  double factor;
};
constexpr std::array shown{
    Shown{"strength", "strength", "MPa", 1e-6},
    Shown{"peak_strain", "strain at the peak", "1e-3", 1e3},
    Shown{"young", "E", "GPa", 1e-9},
    Shown{"poisson", "nu", "-", 1.0},
    Shown{"residual", "stress at 3 times that strain, over the peak", "-", 1.0},
    Shown{"fracture_energy", "fracture energy", "J/m2", 1.0},
    Shown{"strain_100", "strain at 0.1 GPa", "%", 100.0},
    Shown{"strain_1000", "strain at 1 GPa", "%", 100.0},
    Shown{"tangent_300", "tangent at 0.3 GPa", "GPa", 1e-9},
    Shown{"tangent_800", "tangent at 0.8 GPa", "GPa", 1e-9},
    Shown{"side_ratio", "lateral over axial stress at 1 GPa", "-", 1.0},
    Shown{"pressure_1", "pressure at a linear strain of 1 %", "MPa", 1e-6},
    Shown{"pressure_2", "pressure at a linear strain of 2 %", "MPa", 1e-6},
    Shown{"friction_angle", "friction angle", "degrees", 180.0 / pi}};
const Shown& shown_of(const std::string& name) {
  const auto found =
      std::find_if(shown.begin(), shown.end(), [&](const Shown& s) { return name == s.name; });
  if (found == shown.end()) throw std::logic_error("no words for " + name);
  return *found;
}

}  // namespace

SpecimenResult specimen_result(const SpecimenTest& test, const std::string& folder) {
  const report::NumberTable table = report::read_table(folder + "/history.csv");
  switch (test.loading) {
    case Loading::brazilian:
      return of_disc(test, table, folder);
    case Loading::notched_tension:
      return of_notched_prism(test, table, folder);
    case Loading::bending:
      return of_beam(test, table, folder);
    case Loading::plate:
    case Loading::pulled_plate:
      return of_plate(test, table, folder);
    case Loading::plane_disc:
      return of_plane_disc(test, table, folder);
    case Loading::oedometer:
      return of_oedometer(test, table, folder);
    case Loading::hydrostatic:
      return of_pressure(test, table, folder);
    default:
      return of_prism(test, table, folder);
  }
}

std::vector<double> friction_angles(const std::vector<TestResults>& results) {
  const TestResults *free = nullptr, *pressed = nullptr;
  for (const TestResults& result : results) {
    if (result.test.loading != Loading::plate) continue;
    (result.test.pressure > 0.0 ? pressed : free) = &result;
  }
  Values angles;
  if (free == nullptr || pressed == nullptr || free->specimens.size() != pressed->specimens.size())
    return angles;
  for (std::size_t k = 0; k < free->specimens.size(); ++k) {
    const double more =
        pressed->specimens[k].numbers.at("strength") - free->specimens[k].numbers.at("strength");
    const double n = more / pressed->test.pressure;  // (1 + sin phi) / (1 - sin phi)
    angles.push_back(std::asin(std::clamp((n - 1.0) / (n + 1.0), 0.0, 1.0)));
  }
  return angles;
}

double PassportLine::misfit() const {
  const double nearest = up_to ? std::clamp(spread.mean, *target, *up_to) : *target;
  return (spread.mean - nearest) / std::abs(nearest);
}

std::string PassportLine::shown_text() const {
  const Shown& s = shown_of(quantity);
  return fmt::format("{} {}", spread_text(spread, s.factor), s.unit);
}

std::string PassportLine::target_text() const {
  const double factor = shown_of(quantity).factor;
  const std::string from = short_number(factor * *target);
  return up_to ? from + " to " + short_number(factor * *up_to) : from;
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
      const bool pressed =
          result.test.name == "plate_pressed" && std::string_view(number.name) == "strength";
      lines.push_back(
          {result.test.title, number.name, number.unit, spread_of(values),
           pressed ? pressed_strength(targets, result.test.pressure) : target_of(targets, target),
           tolerance_of(target)});
      if (result.test.name == "brazilian" && target == "tension" && lines.back().target)
        lines.back().up_to = *lines.back().target / 0.9;
    }
  if (const Values angles = friction_angles(results); !angles.empty())
    lines.push_back({"plates, free and pressed", "friction_angle", "rad", spread_of(angles),
                     target_of(targets, "friction_angle"), angle_tolerance(results, targets)});
  return lines;
}

std::string specimens_table(const std::vector<TestResults>& results) {
  std::string text = "test,specimen,quantity,unit,value\n";
  for (const TestResults& result : results)
    for (std::size_t k = 0; k < result.specimens.size(); ++k)
      for (const Shown& s : shown)
        if (const auto found = result.specimens[k].numbers.find(s.name);
            found != result.specimens[k].numbers.end())
          text +=
              fmt::format("{},{},{},{},{:.9g}\n", result.test.name, k + 1, s.name, s.unit,
                          std::isfinite(found->second) ? s.factor * found->second : std::nan(""));
  return text;
}

/// Ratios of the means of two tests; nothing without a pair of them.
std::string ratios_of(const std::vector<PassportLine>& lines) {
  const auto mean = [&](const std::string& title) {
    for (const PassportLine& line : lines)
      if (line.test == title && line.quantity == "strength") return line.spread.mean;
    return std::nan("");
  };
  std::string rows;
  const auto ratio = [&](const char* words, const std::string& a, const std::string& b) {
    const double value = mean(a) / mean(b);
    if (std::isfinite(value)) rows += fmt::format("| {} | {} |\n", words, short_number(value));
  };
  const std::string smooth = "compression, prism, smooth ends", tension = "direct tension, prism";
  ratio("compression over tension", smooth, tension);
  ratio("rough cube over rough prism (real concrete: 1.20 to 1.25)",
        "compression, cube, rough platens", "compression, prism, rough platens");
  ratio("rough prism over smooth prism", "compression, prism, rough platens", smooth);
  ratio("splitting over tension", "Brazilian, disc", tension);
  ratio("held prism over smooth prism", "compression, prism, held ends", smooth);
  ratio("held cube over held prism", "compression, cube, held ends",
        "compression, prism, held ends");
  return rows.empty() ? "" : "\n| ratio of means | shown |\n|---|---|\n" + rows;
}

std::string passport_page(const std::string& material, const std::string& specimens,
                          const std::vector<TestResults>& results,
                          const std::vector<PassportLine>& lines) {
  std::string text = fmt::format(
      "# Passport of {}\n\n{} Mean, +- the deviation of the sample, and number of packings or "
      "meshes.\n\n![curves](passport.svg)\n\n"
      "| test | quantity | unit | shown | target | misfit | verdict "
      "|\n|---|---|---|---|---|---|---|\n",
      material, specimens);
  for (const PassportLine& line : lines) {
    const Shown& s = shown_of(line.quantity);
    text += fmt::format("| {} | {} | {} | {} |", line.test, s.words, s.unit,
                        spread_text(line.spread, s.factor));
    if (line.target)
      text += fmt::format(" {} | {:+.1f} % | {} |\n", line.target_text(), 100.0 * line.misfit(),
                          line.pass() ? "pass" : "**fail**");
    else
      text += " - | - | - |\n";
  }
  text += ratios_of(lines);
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
