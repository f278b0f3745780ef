// breccia explain KEY: what a key means, its formula, and the law that it shapes as a curve.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/coupled_keys.hpp"
#include "app/curve.hpp"
#include "dem/setup/config.hpp"
#include "dem/setup/materials.hpp"
#include "exec/error.hpp"
#include "fdem/laws/joint_bond.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/case/key_pages.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "run/case_keys.hpp"

namespace breccia::app {
namespace {

/// A law by its defaults: the keys that shape it, its formula, its curve.
struct Law {
  std::string method, table;
  std::vector<std::string> keys;
  std::string formula, source;
  Curve (*curve)();
};

constexpr double to_mpa = 1e-6, to_um = 1e6;

Curve concrete_tension() {
  const dem::MaterialConfig m;
  constexpr double length = 10e-3;  // of a link
  const double onset = m.tensile_strength * length / m.young;
  return {"concrete link of 10 mm in tension, by the defaults",
          "opening [um]",
          "normal stress [MPa]",
          {{0.0, 0.0},
           {to_um * onset, to_mpa * m.tensile_strength},
           {to_um * onset * (1.0 + m.softening), 0.0},
           {to_um * onset * (2.0 + m.softening), 0.0}}};
}

Curve concrete_shear() {
  const dem::MaterialConfig m;
  Curve curve{"shear strength of an intact link, by the defaults", "pressure [MPa]",
              "shear strength [MPa]"};
  for (const double pressure : {-m.tensile_strength, 0.0, 20e6})
    curve.points.emplace_back(to_mpa * pressure,
                              to_mpa * (m.cohesion + pressure * std::tan(m.friction_angle)));
  return curve;
}

Curve strain_rate() {
  dem::MaterialConfig m;
  m.rate = "malvar_ross";
  const dem::RateCurve rate = dem::rate_curve(m);
  Curve curve{"tensile strength over strain rate (malvar_ross, f_c = 30 MPa)",
              "log10 of the strain rate in 1/s", "dynamic over static strength [-]"};
  constexpr int parts = 60;
  for (int k = 0; k <= parts; ++k) {
    const double power = -6.0 + 8.5 * k / parts;
    curve.points.emplace_back(power, rate.factor<double>(std::pow(10.0, power)));
  }
  return curve;
}

Curve crushing() {
  constexpr double young = 30e9, onset = 60e6, slope = 0.4;  // by default there is none
  constexpr double closing = 0.02, yields = onset / young;
  constexpr double closed = onset + slope * young * closing / (1.0 - slope);
  constexpr double last = closed + 300e6;
  return {
      "link under pressure, E = 30 GPa, Y_c = 60 MPa, H_c = 0.4, p_c = 0.02, pressed and let go",
      "shortening over length [%]",
      "compressive stress [MPa]",
      {{0.0, 0.0},
       {100.0 * yields, to_mpa * onset},
       {100.0 * (closing + closed / young), to_mpa * closed},
       {100.0 * (closing + last / young), to_mpa * last},
       {100.0 * closing, 0.0}}};
}

Curve steel_tension() {
  const dem::MaterialConfig m;
  constexpr double percent = 100.0, young = 200e9;
  const double yields = m.yield / young, last = m.yield + m.hardening * m.failure_strain;
  const double end = m.failure_strain + last / young;
  return {"a bar in tension, by the defaults and E = 200 GPa",
          "strain [%]",
          "stress [MPa]",
          {{0.0, 0.0},
           {percent * yields, to_mpa * m.yield},
           {percent * end, to_mpa * last},
           {percent * end, 0.0}}};
}

Curve bond_slip() {
  const dem::MaterialConfig m;
  Curve curve{"bond of a bar (mc90), by the defaults", "slip [mm]", "bond stress [MPa]"};
  constexpr int parts = 40;
  for (int k = 0; k <= parts; ++k) {
    const double slip = m.slip1 * k / parts;
    curve.points.emplace_back(1e3 * slip, to_mpa * m.bond_strength * std::pow(slip / m.slip1, 0.4));
  }
  curve.points.emplace_back(1e3 * m.slip2, to_mpa * m.bond_strength);
  curve.points.emplace_back(1e3 * m.slip3, to_mpa * m.bond_residual);
  curve.points.emplace_back(1.25e3 * m.slip3, to_mpa * m.bond_residual);
  return curve;
}

Curve joint_opening() {
  const fdem::StrengthConfig s;
  const fdem::MaterialConfig m;
  constexpr double edge = 5e-3;
  const double elastic = 2.0 * edge * s.tension / (s.stiffness * m.young);
  const double soft = fdem::exact_softening_factor * s.energy_open / s.tension;
  Curve curve{"joint of 5 mm that opens, by the defaults", "opening [um]", "traction [MPa]"};
  constexpr int parts = 60;
  for (int k = 0; k <= parts / 3; ++k) {
    const double r = 3.0 * k / parts;
    curve.points.emplace_back(to_um * elastic * r, to_mpa * s.tension * (2.0 - r) * r);
  }
  for (int k = 1; k <= parts; ++k) {
    const double damage = static_cast<double>(k) / parts;
    curve.points.emplace_back(to_um * (elastic + soft * damage),
                              to_mpa * s.tension * fdem::softening(damage));
  }
  return curve;
}

const std::vector<Law>& laws() {
  static const std::vector<Law> all{
      {"dem3d",
       "[material.NAME]",
       {"tensile_strength", "softening", "fracture_energy", "knee_strength", "knee_opening"},
       "sigma = E u / L up to T, then falls with slope E / (zeta L): a link breaks at u = (1 + "
       "zeta) T L / E; fracture_energy sets zeta so that the area is G_F; knee_strength s above 0 "
       "bends the fall at s T and a part knee_opening of the way",
       "docs/theory.md, cohesive links",
       concrete_tension},
      {"dem3d",
       "[material.NAME]",
       {"cohesion", "friction_angle", "friction_cap", "friction_bound", "criterion"},
       "shear strength = C + min(f, s_F) of an intact link under pressure p, f = p tan phi_i; "
       "friction_bound = \"smooth\": C + f s_F / (f + s_F); criterion = \"hyperbola\": of "
       "this line L, sqrt(L^2 - (C - T tan phi_i)^2), so that nothing is left at a tension of T",
       "docs/theory.md, cohesive links",
       concrete_shear},
      {"dem3d",
       "[material.NAME]",
       {"rate", "rate_strength", "rate_crossings"},
       "T grows to T (e / 1e-6)^delta; malvar_ross: delta = 1 / (1 + 8 f_c / 10 MPa), a third from "
       "e = 1/s on; mc2010: 0.018, a third from 10/s on; constant from 160/s on",
       "Malvar and Ross 1998; fib Model Code 2010; docs/theory.md, strain rate",
       strain_rate},
      {"dem3d",
       "[material.NAME]",
       {"compaction_strength", "compaction_slope", "crushing_strength", "crushing_slope",
        "closing_strain"},
       "beyond Y the stress grows with H E; what is let go unloads with E. Y_c, H_c for whole "
       "links and broken ones that touch, Y_b, H_b for broken ones that do not. Shortened for good "
       "by closing_strain (2 % here) a link is elastic again",
       "docs/theory.md, concrete under pressure",
       crushing},
      {"dem3d",
       "[material.NAME]",
       {"yield", "hardening", "failure_strain"},
       "sigma = E eps up to f_y, then f_y + H eps_p; ruptures at eps_p = failure_strain",
       "docs/theory.md, steel links",
       steel_tension},
      {"dem3d",
       "[material.NAME]",
       {"bond", "bond_strength", "bond_residual", "slip1", "slip2", "slip3", "rib_height"},
       "tau = tau_max (s / s_1)^0.4 up to s_1, constant to s_2, falls to tau_f at s_3; times "
       "1 - gap / rib_height where concrete has parted from the bar",
       "CEB-FIP Model Code 1990; docs/theory.md, interface links",
       bond_slip},
      {"fdem2d",
       "[material.NAME.joint]",
       {"tension", "energy_open", "stiffness"},
       "sigma = f_t (2 r - r^2) with r = o / o_p up to o_p = 2 h f_t / p_f, then z(D) f_t with "
       "D = (o - o_p) / o_t and o_t = 2.5886 G_I / f_t; the area beyond o_p is G_I",
       "docs/theory-fdem.md, section 2",
       joint_opening}};
  return all;
}

const Law* law_of(const std::string& method, const KeyInfo& key) {
  const std::string name = key.path.substr(key.path.rfind('.') + 1);
  for (const Law& law : laws())
    if (law.method == method && law.table == table_heading(key) &&
        std::find(law.keys.begin(), law.keys.end(), name) != law.keys.end())
      return &law;
  return nullptr;
}

void print_wrapped(const std::string& text) {
  for (const std::string& line : wrapped(text, 76)) fmt::print("  {}\n", line);
}

/// Keys of exactly this name.
std::vector<KeyInfo> named(const std::vector<KeyInfo>& keys, const std::string& word) {
  std::vector<KeyInfo> found;
  for (const KeyInfo& key : keys)
    if (key.path == word || key.path.ends_with("." + word)) found.push_back(key);
  return found;
}

/// Keys of the table of this name, [word] or [[word]].
std::vector<KeyInfo> in_table(const std::vector<KeyInfo>& keys, const std::string& word) {
  std::vector<KeyInfo> found;
  for (const KeyInfo& key : keys) {
    const std::string heading = table_heading(key);
    if (heading == "[" + word + "]" || heading == "[[" + word + "]]") found.push_back(key);
  }
  return found;
}

struct ExplainCommand {
  std::string key, svg;

  void execute() const {
    const std::pair<const char*, std::vector<KeyInfo>> all[] = {
        {"dem3d", list_keys<dem::Config>("")},
        {"fdem2d", list_keys<fdem::Config>("")},
        {"fdem3d", list_keys<fdem3::Config>("")},
        {both_methods, keys_between()}};
    using OfMethod = std::pair<const char*, std::vector<KeyInfo>>;
    std::vector<OfMethod> methods, tables;
    const auto count = [](const std::vector<OfMethod>& of) {
      std::size_t sum = 0;
      for (const auto& [method, keys] : of) sum += keys.size();
      return sum;
    };
    for (const auto& [method, keys] : all) {
      methods.emplace_back(method, named(keys, key));
      tables.emplace_back(method, in_table(keys, key));
    }
    const bool is_table = count(tables) > 0;
    if (count(methods) == 0 && !is_table)  // a word of theirs
      for (std::size_t m = 0; m < methods.size(); ++m)
        methods[m].second = keys_about(all[m].second, key);
    constexpr std::size_t most = 8;
    const std::size_t total = count(methods);
    std::size_t largest = 0;
    for (const auto& [method, keys] : methods) largest = std::max(largest, keys.size());
    if (total == 0 && !is_table)
      throw InputError(key + " is not a key; breccia keys " + key + " searches for words");
    if (largest > most) {
      const auto longest = std::find_if(methods.begin(), methods.end(), [&](const OfMethod& of) {
        return of.second.size() == largest;
      });
      throw InputError(
          fmt::format("{0} may be {1} keys, {2} and {3} among them; breccia keys {0} "
                      "lists them, and explain takes one",
                      key, total, longest->second[0].path, longest->second[1].path));
    }
    for (const auto& [method, keys] : tables) tell_table(method, keys);
    const Law* drawn = nullptr;
    for (const auto& [method, keys] : methods)
      for (const KeyInfo& each : keys) {
        tell(method, each);
        const Law* const law = law_of(method, each);
        if (law == nullptr) continue;
        print_wrapped(law->formula + " (" + law->source + ")");
        if (law != drawn) fmt::print("\n{}", curve_for_terminal(law->curve()));
        if (drawn == nullptr && !svg.empty()) replace_file(svg, curve_as_svg(law->curve()));
        drawn = law;
      }
    if (drawn == nullptr && !svg.empty())
      throw InputError(key + " shapes no law: there is no curve for --svg");
    if (!svg.empty()) fmt::print("{}: written\n", harmless(svg));
  }

  static void tell_table(const std::string& method, const std::vector<KeyInfo>& keys) {
    if (keys.empty()) return;
    fmt::print("\n{}  (method {})\n", table_heading(keys.front()), method);
    print_wrapped(keys.front().table_meaning);
    for (const KeyInfo& key : keys) {
      fmt::print("  {}\n", example_line(key));
      for (const std::string& line : wrapped(key.meaning, 72)) fmt::print("      {}\n", line);
    }
  }
  static void tell(const std::string& method, const KeyInfo& key) {
    fmt::print("\n{} {}  (method {})\n", table_heading(key), example_line(key), method);
    print_wrapped(key.meaning);
    if (!key.range.empty() && key.range != "any")
      print_wrapped("allowed: " + key.range +
                    (key.unit.empty() || key.unit == "-" ? "" : " " + key.unit));
  }
};

}  // namespace

void add_explain(CLI::App& program) {
  const auto explain = std::make_shared<ExplainCommand>();
  CLI::App* const command =
      program.add_subcommand("explain", "what a key means, with formula and curve of its law");
  command->add_option("KEY", explain->key, "its name, or its path as in material.joint.tension")
      ->required();
  command->add_option("--svg", explain->svg, "also write the curve to this file")
      ->type_name("FILE.svg");
  command->footer("Example: breccia explain tensile_strength");
  command->callback([explain] { explain->execute(); });
}

}  // namespace breccia::app
