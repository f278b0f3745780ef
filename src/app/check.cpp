// breccia check CASE...: says every problem of the cases without running them.

#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/option_kinds.hpp"
#include "exec/error.hpp"
#include "io/case/key_pages.hpp"
#include "io/case/material_library.hpp"
#include "io/case/problems.hpp"
#include "io/emphasis.hpp"
#include "io/fold.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"
#include "io/whole_file.hpp"
#include "prepare/build_coupled.hpp"
#include "prepare/checks/check_between.hpp"
#include "prepare/checks/check_in_situ.hpp"
#include "prepare/checks/check_regions.hpp"
#include "prepare/checks/check_tools.hpp"
#include "prepare/checks/check_values.hpp"
#include "run/case.hpp"
#include "run/case_keys.hpp"
#include "run/machine/fast_motion.hpp"
#include "run/machine/forecast.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/method/doubts.hpp"

namespace breccia::app {
namespace {

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// A count that is an estimate, to two digits and with a word for it.
std::string about(double count) {
  const double tens = std::pow(10.0, std::floor(std::log10(std::max(count, 1.0))) - 1.0);
  return "about " + count_text(count < 100.0 ? count : std::round(count / tens) * tens);
}

/// "about 1 element", "about 460 triangles"
std::string about_so_many(double count, std::string items) {
  if (count == 1.0 && items.ends_with('s')) items.pop_back();
  return about(count) + ' ' + items;
}

/// "1 element", "4,612 triangles"
std::string so_many_of(double count, std::string items) {
  if (count == 1.0 && items.ends_with('s')) items.pop_back();
  return count_text(count) + ' ' + items;
}

/// "18 ns", "1.1 us"
std::string short_time(double seconds) {
  const bool nanoseconds = seconds < 0.995e-6;
  if (seconds >= 1e-3) return time_text(seconds);
  const double number = seconds * (nanoseconds ? 1e9 : 1e6);
  const char* const unit = nanoseconds ? "ns" : "us";
  return number < 99.5 ? fmt::format("{:.2g} {}", number, unit)
                       : fmt::format("{:.0f} {}", number, unit);
}

/// beam.toml: beam.fixed.toml; a folder: its case.fixed.toml.
std::string fixed_path(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file = fs::is_directory(path) ? fs::path(path) / "case.toml" : fs::path(path);
  return (file.parent_path() / (file.stem().string() + ".fixed.toml")).string();
}

template <class Config>
std::size_t bodies_of(const Config& config) {
  return config.bodies.size();
}
std::size_t bodies_of(const coupled::Config& config) {
  return config.spheres.bodies.size() + config.tetrahedra.bodies.size();
}
template <class Config>
std::size_t materials_of(const Config& config) {
  return config.materials.size();
}
std::size_t materials_of(const coupled::Config& config) {
  return config.spheres.materials.size() + config.tetrahedra.materials.size();
}

struct CheckCommand {
  std::vector<std::string> paths, overrides;
  bool model = false, fix = false, allow_scripts = false;

  int execute() const {
    int exit_code = 0;
    for (const std::string& path : paths) {
      try {
        check(fix ? fixed(path) : path);
      } catch (const Error& error) {
        std::fflush(stdout);
        const std::string text = fmt::format(
            "{} {}\n", emphasized(Emphasis::error, "error:", stderr), harmless(error.what()));
        std::fputs(fitting(text, 4, stderr).c_str(), stderr);
        if (exit_code == 0) exit_code = error.exit_code();
      }
    }
    return exit_code;
  }

  void check(const std::string& path) const {
    const Case read = load_case(path, overrides);
    check_files(read);
    if (model && !allow_scripts) refuse_scripts(read);
    std::unique_ptr<Method> built;
    std::visit(
        [&](const auto& config) {
          const MemoryPlan plan = memory_plan(config, read.folder);
          refuse_without_memory(plan, plan.run_bytes, 1, path + ": the model");
          std::optional<Forecast> expected;  // may refuse the case
          if (!read.model) expected = forecast_of(config, read);
          // Built before it is called good: what run refuses of a mesh or packing is refused.
          if (model || (expected && is_soon_built(*expected) && scripts_of(read).empty()))
            built = method_to_look_at(read);
          if (expected && built != nullptr)
            expected = by_counts(
                *built, forecast_of(config, read, {built->time_step(), built->step_rule()}));
          fmt::print("{}: good: {}, {}, {}, ends at {}", harmless(path), config.method,
                     counted(bodies_of(config), "body", "bodies"),
                     counted(materials_of(config), "material", "materials"),
                     time_text(config.time.end));
          if (const auto files = scripts_of(read); !files.empty())
            fmt::print(", needs --allow-scripts for {}",
                       harmless(fmt::format("{}", fmt::join(files, ", "))));
          fmt::print("\n");
          for (const std::string& note : read.notes) tell_note(note);
          if constexpr (requires { prepare::doubtful_walls(config, read.folder); })
            for (const std::string& doubt : prepare::doubtful_walls(config, read.folder))
              tell_note(read.file.empty() ? doubt : with_lines(doubt, read.file));
          if constexpr (requires { config.links; }) {
            for (const auto& material : config.materials)
              if (!model && material.fracture_energy > 0.0)
                tell_note(
                    fmt::format("check --model tells whether elements of this size can show "
                                "the fracture_energy of {}",
                                material.name));
          }
          tell_of_wide_supports(config);
          tell_of_probes(config, read);
          if (!expected) return;
          tell_forecast(*expected);
          for (const std::string& sentence : too_fast(config, *expected))
            tell_warning(sentence, read);
        },
        read.config);
    if (model) tell_of_model(*built, read);
    if (built != nullptr) tell_warnings(*built, read);
  }

  /// Faults that specimens of its bodies show are told with file and lines.
  template <class Config>
  static Forecast forecast_of(const Config& config, const Case& read, const ModelStep& model = {}) {
    try {
      return forecast(config, read.folder, model);
    } catch (const InputError& error) {
      if (read.file.empty()) throw;
      throw InputError(with_lines(error.what(), read.file));
    }
  }

  /// The forecast with the counts of a model, which specimens foretold.
  static Forecast by_counts(Method& built, Forecast f) {
    double items = 0.0, bonds = 0.0;
    for (const Fact& fact : built.facts()) {
      if (fact.path == "model.elements" || fact.path == "model.triangles" ||
          fact.path == "model.tetrahedra")
        items += fact.value;
      if (fact.path == "model.links" || fact.path == "model.joints") bonds += fact.value;
    }
    if (!(items > 0.0 && f.items > 0.0)) return f;
    const double share = items / f.items;
    for (double* of : {&f.here_s, &f.gpu_s, &f.output_s, &f.memory, &f.disk}) *of *= share;
    f.items = items;
    f.bonds = bonds;
    f.counted = true;
    return f;
  }

  static bool is_soon_built(const Forecast& f) {
    constexpr double seconds = 0.3, items = 5000.0;
    return f.items > 0.0 && f.items < items && f.setup_s < seconds;
  }

  /// Probes that read nothing, and means of forces, which are rarely meant.
  template <class Config>
  static void tell_of_probes(const Config& config, const Case& read) {
    const auto tell = [&](const std::string& doubt) {
      tell_note(read.file.empty() ? doubt : with_lines(doubt, read.file));
    };
    const auto is_wall = [&](const std::string& name) {
      const auto among = [&](const auto& walls) {
        for (const auto& wall : walls)
          if (wall.name == name) return true;
        return false;
      };
      if constexpr (requires { config.spheres; })
        return among(config.spheres.walls);
      else if constexpr (requires { config.walls; })
        return among(config.walls);
      else
        return false;
    };
    for (const ProbeConfig& p : config.probes)
      if (p.reduce == "mean" &&
          (p.quantity.starts_with("force_") || p.quantity.starts_with("torque_")) && !is_wall(p.on))
        tell(
            fmt::format("probe.{}.reduce: the mean over what it reads; the whole {} is reduce = "
                        "\"sum\"",
                        p.name, p.quantity.substr(0, p.quantity.find('_'))));
    if constexpr (!requires { config.spheres; })
      for (const std::string& doubt : prepare::doubtful_probes(config, read.folder)) tell(doubt);
    if constexpr (requires { prepare::doubtful_loads(config, read.folder); })
      for (const std::string& doubt : prepare::doubtful_loads(config, read.folder)) tell(doubt);
    if constexpr (requires { prepare::doubtful_in_situ(config, read.folder); })
      for (const std::string& doubt : prepare::doubtful_in_situ(config, read.folder)) tell(doubt);
    if constexpr (requires { prepare::doubtful_bodies(config, read.folder); })
      for (const std::string& doubt : prepare::doubtful_bodies(config, read.folder)) tell(doubt);
    if constexpr (requires { prepare::doubtful_tools(config, read.folder); })
      for (const std::string& doubt : prepare::doubtful_tools(config, read.folder)) tell(doubt);
    for (const std::string& doubt : prepare::doubtful_values(config, read.folder)) tell(doubt);
    if constexpr (requires { prepare::merged_lines(config, read.folder); })
      for (const std::string& note : prepare::merged_lines(config, read.folder)) tell(note);
  }

  template <class Config>
  static void tell_of_wide_supports(const Config& config) {
    if constexpr (requires { config.spheres; }) {
      tell_of_wide_supports(config.spheres);
      tell_of_wide_supports(config.tetrahedra);
    } else if (config.bodies.size() > 1) {
      for (const auto& support : config.supports)
        if (takes_all(support))
          tell_note(
              fmt::format("support {} names no body (key on) and has no bounds: it "
                          "takes all {} bodies",
                          support.name, config.bodies.size()));
    }
  }
  template <class Support>
  static bool takes_all(const Support& support) {
    const auto same = [](const auto& a, const auto& b) {
      if constexpr (requires { a.z; })
        if (a.z != b.z) return false;
      return a.x == b.x && a.y == b.y;
    };
    const auto of_region = [&](const auto& r) {
      const std::remove_cvref_t<decltype(r)> anywhere{};
      return r.on.empty() && same(r.min, anywhere.min) && same(r.max, anywhere.max) &&
             r.radius == 0.0;
    };
    if constexpr (requires { support.region; })
      return of_region(support.region);
    else
      return of_region(support);
  }

  static void tell_note(const std::string& text) {
    const char* head = "note";
    for (const std::string& line : wrapped(harmless(text), 70)) {
      fmt::print("  {:<7} {}\n", head, line);
      head = "";
    }
  }

  static std::string about_duration(double seconds) {
    return (seconds < 1.0 ? "" : "about ") + rough_duration(seconds);
  }

  /// A bound of its steps by what it does not know.
  static const char* bound_of(const Forecast& f) {
    return f.cut_by_lines && !f.may_end_early ? "at least " : "";
  }
  static void tell_steps(const Forecast& f) {
    fmt::print("  step    {}{}, ruled by\n          {}\n",
               f.of_model       ? ""
               : f.cut_by_lines ? "at most about "
                                : "about ",
               short_time(f.step), harmless(f.step_rule));
    if (f.cut_by_lines)
      fmt::print(
          "          often a fifth of it and less where lines cut small elements:\n"
          "          check --model tells\n");
    fmt::print("  steps   {}{}, {}\n", bound_of(f), about(f.steps),
               f.cut_by_lines ? "more by as much as its step is shorter"
               : f.may_end_early
                   ? "fewer if its stages end it early,\n          more as bodies meet "
                     "and break"
                   : "more as bodies meet and break");
  }

  static void tell_forecast(const Forecast& f) {
    if (f.items == 0.0) {
      fmt::print("  size    known when bodies are meshed or filled: check --model\n");
      return;
    }
    const auto so_many = [&](double count, const char* name) {
      return f.counted ? so_many_of(count, name) : about_so_many(count, name);
    };
    fmt::print("  size    {}", so_many(f.items, f.item_name));
    if (f.bonds > 0.0) fmt::print(", {}", so_many(f.bonds, f.bond_name));
    fmt::print("\n");
    tell_steps(f);
    const double all = f.setup_s + f.here_s + f.output_s;
    const std::string here =  // "at least under 1 s" would bound nothing
        f.cut_by_lines && all < 1.0 ? fmt::format("about {:.1g} s", all) : about_duration(all);
    fmt::print("  time    {}{} here ({})", bound_of(f), here,
               counted(static_cast<std::size_t>(omp_get_num_procs()), "core", "cores"));
    if (f.setup_s >= 1.0) fmt::print(", {} of it set-up", rough_duration(f.setup_s));
    if (f.output_s >= 1.0) fmt::print(", {} of it output", rough_duration(f.output_s));
    if (f.gpu_s > 0.0)
      fmt::print("\n          steps alone: {} on one H200 GPU", about_duration(f.gpu_s));
    if (f.joined) fmt::print("\n          several times that where it is crushed");
    fmt::print("\n");
    fmt::print("  memory  about {}; disk about {}, most of it {}\n", memory_text(f.memory),
               memory_text(f.disk), f.longest_part);
  }

  /// Writes the case with what is surely a slip corrected. Returns the path to go on with.
  std::string fixed(const std::string& path) const {
    const std::string into = fixed_path(path);
    std::string from = path, text;
    std::vector<std::string> told;
    for (int round = 0; round < 50; ++round) {  // a corrected name shows the slips below it
      try {
        text.empty() ? read_keys(from) : read_keys(CaseText{text, into});
        break;
      } catch (const CaseError& error) {
        const std::string old =
            text.empty()
                ? read_whole_file(std::filesystem::is_directory(path) ? path + "/case.toml" : path)
                : text;
        for (const Problem& problem : error.problems)
          if (const auto& c = problem.correction)
            told.push_back(fmt::format("line {}: {} -> {}", c->line, c->old, c->now));
        const std::string better = corrected(old, error.problems);
        if (better == old) break;
        text = better;
      }
    }
    if (text.empty()) {
      fmt::print("{}: nothing that --fix knows how to correct\n", harmless(path));
      return path;
    }
    replace_file(into, text);
    fmt::print("{}: {} in {}\n", harmless(path), counted(told.size(), "correction", "corrections"),
               harmless(into));
    for (const std::string& line : told) fmt::print("  {}\n", harmless(line));
    return into;
  }

  template <class Source>
  void read_keys(const Source& source) const {
    const std::string method = case_method(source, overrides);
    if (asks_for_two_methods(source, overrides))
      read_case<coupled::Config>(source, overrides);
    else if (method == "fdem2d")
      read_case<fdem::Config>(source, overrides);
    else if (method == "fdem3d")
      read_case<fdem3::Config>(source, overrides);
    else
      read_case<dem::Config>(source, overrides);
  }

  static void tell_of_model(Method& method, const Case& read) {
    const std::string rule = method.step_rule();
    fmt::print("  step {:.3g} s{}\n", method.time_step(), rule.empty() ? "" : " ruled by " + rule);
    for (const Fact& fact : method.facts()) {
      if (fact.path.starts_with("model.added_mass."))
        fmt::print("  {} {:.4g}\n", fact.path.substr(6), fact.value);
      if (fact.path.starts_with("model.rock.")) tell_of_rock(fact, read);
    }
  }
  /// The modulus that the case gives a material of triangles or tetrahedra, 0: none  [Pa], and the
  /// material of the program that it uses.
  struct GivenMaterial {
    double young = 0.0;
    std::string use;
  };
  static GivenMaterial given_material(const Case& read, const std::string& material) {
    const auto among = [&](const auto& materials) {
      for (const auto& m : materials)
        if (m.name == material) return GivenMaterial{m.young, m.use};
      return GivenMaterial{};
    };
    return std::visit(
        [&](const auto& config) {
          if constexpr (requires { config.tetrahedra; })
            return among(config.tetrahedra.materials);
          else
            return among(config.materials);
        },
        read.config);
  }

  /// The modulus that specimens of a material of the program are to show; 0: none.  [Pa]
  static double target_young(const std::string& material) {
    const NamedMaterial* const named = named_material(material);
    if (named != nullptr)
      for (const MaterialTarget& target : named->targets)
        if (target.name == "young") return target.value;
    return 0.0;
  }

  /// By how much joints soften a specimen, and the `young` at which it has the modulus given, or
  /// that of the material which it uses: both grow alike, as the stiffness of joints is given over
  /// `young`.
  static std::string softened(double young, const GivenMaterial& given) {
    constexpr double near = 0.05;
    if (const double target = target_young(given.use); target > 0.0) {
      const double off = young / target - 1.0;
      const std::string meant = std::abs(off) < near
                                    ? std::string("nothing to do")
                                    : fmt::format("young = \"{:.4g} GPa\" gives that",
                                                  1e-9 * given.young * target / young);
      return fmt::format(", {:+.1f} % of {:.4g} GPa, which {} is to show: {}", 100.0 * off,
                         1e-9 * target, given.use, meant);
    }
    if (!(given.young > 0.0) || !(young < 0.9995 * given.young)) return "";
    return fmt::format(
        ", {:.1f} % softer than its young of {:.4g} GPa: a specimen shows that; young = \"{:.4g} "
        "GPa\" gives {:.4g} GPa",
        100.0 * (1.0 - young / given.young), 1e-9 * given.young,
        1e-9 * given.young * given.young / young, 1e-9 * given.young);
  }

  /// One number of a material as its joints soften it, model.rock.<material>.<word>.
  static void tell_of_rock(const Fact& fact, const Case& read) {
    const std::size_t cut = fact.path.rfind('.');
    const std::string whose = fact.path.substr(std::string("model.rock.").size(),
                                               cut - std::string("model.rock.").size()),
                      word = fact.path.substr(cut + 1);
    if (word == "young")
      fmt::print("{}", fitting(fmt::format("  {} with its joints: E {:.4g} GPa{}\n",
                                           harmless(whose), 1e-9 * fact.value,
                                           softened(fact.value, given_material(read, whose))),
                               4, stdout));
    else if (word == "poisson")
      fmt::print("  {} with its joints: nu {:.4g}\n", harmless(whose), fact.value);
    else if (word.ends_with("wave_speed"))
      fmt::print("  {} with its joints: {} waves at {:.5g} m/s\n", harmless(whose),
                 word == "wave_speed" ? "pressure" : "shear", fact.value);
    else
      fmt::print("  {} with its joints: {} {:.6g}\n", harmless(whose), word, fact.value);
  }
  static void tell_warnings(Method& method, const Case& read) {
    for (const std::string& warning : doubts_of(method, read.common().time.end))
      tell_warning(warning, read);
  }
  static void tell_warning(const std::string& warning, const Case& read) {
    std::fflush(stdout);
    const std::string text =
        fmt::format("{} {}\n", emphasized(Emphasis::warning, "warning:", stderr),
                    harmless(read.file.empty() ? warning : with_lines(warning, read.file)));
    std::fputs(fitting(text, 2, stderr).c_str(), stderr);
  }
};

}  // namespace

void add_check(CLI::App& program, int& exit_code) {
  const auto check = std::make_shared<CheckCommand>();
  CLI::App* const command =
      program.add_subcommand("check", "say every problem of cases without running them");
  command->add_option("CASE", check->paths, "case files, or folders that hold case.toml")
      ->required();
  add_repeated(command, "--set", check->overrides, "override a key of the cases", "KEY=VALUE");
  command->add_flag("--model", check->model,
                    "also build and set up the models, and say what is doubtful about them");
  command->add_flag(
      "--fix", check->fix,
      "write CASE.fixed.toml with misspelt keys, words and units corrected, and check "
      "that");
  command->add_flag("--allow-scripts", check->allow_scripts, allow_scripts_help);
  command->callback([check, &exit_code] { exit_code = check->execute(); });
}

}  // namespace breccia::app
