// breccia test CASE --material NAME: the virtual laboratory on one material.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "run/case.hpp"
#include "app/commands.hpp"
#include "app/side_by_side_options.hpp"
#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/case/material_library.hpp"
#include "io/case/units.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "laboratory/passport.hpp"
#include "laboratory/run_result.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

namespace lab = laboratory;

/// "tension=2.9 MPa".
MaterialTarget target_from(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  MaterialTarget target{text.substr(0, equals), 0.0, target_unit(text.substr(0, equals))};
  if (target.unit.empty() || equals == text.size())
    throw InputError(fmt::format(
        "--target {}: it is not NAME=VALUE with young, poisson, compression, tension, brazilian "
        "or fracture_energy; nothing was run",
        text));
  std::string problem;
  target.value = parse_quantity(text.substr(equals + 1), target.unit, problem);
  if (!problem.empty()) throw InputError("--target " + text + ": " + problem + "; nothing was run");
  return target;
}

struct TestCommand {
  std::string path, material, folder;
  std::vector<std::string> overrides, targets, only;
  int seeds = 3, elements = 1200;
  SideBySideOptions options;

  int execute() const {
    const Case read = load_case(path, overrides);
    const auto* const config = std::get_if<dem::Config>(&read.config);
    if (config == nullptr)
      throw InputError(path + ": only materials of method dem3d are tested; nothing was run");
    lab::Sample sample = lab::sample_of(*config, material);
    sample.elements = elements;
    const std::vector<MaterialTarget> wanted = all_targets(sample.material.use);
    const std::string out = folder.empty() ? "out/" + read.name + "_" + material + "_test" : folder;
    std::vector<lab::TestResults> results;
    std::vector<lab::PlannedRun> runs;
    double bytes = 0.0;
    make_folder(out + "/cases");
    for (const lab::SpecimenTest& test : chosen()) {
      results.push_back({test, {}, {}});
      for (int seed = 1; seed <= seeds; ++seed) {
        lab::PlannedRun run;
        run.name = fmt::format("{} {}", test.name, seed);
        run.case_path = fmt::format("{}/cases/{}-{}.toml", out, test.name, seed);
        replace_file(run.case_path,
                     completed_case(lab::case_of(test, sample, seed, out + "/cases")));
        const Case specimen = load_case(run.case_path, {});
        run.digest = specimen.digest;
        run.folder = fmt::format("{}/runs/{}-{}", out, test.name, seed);
        bytes = std::max(bytes, run_bytes(specimen));
        runs.push_back(run);
      }
    }
    const lab::Workers workers = options.workers(runs.size(), bytes);
    fmt::print("{}: {} specimens, {} at a time\n", harmless(material), runs.size(), workers.jobs);
    const auto ended = lab::run_side_by_side(runs, workers, tell_of(runs));
    int exit_code = 0;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      lab::TestResults& result = results[k / static_cast<std::size_t>(seeds)];
      if (ended[k].complete()) {
        result.specimens.push_back(lab::specimen_result(result.test, runs[k].folder));
        write_curve(result.specimens.back().curve, out, runs[k].name);
      } else {
        result.failures.push_back(ended[k].message);
        if (exit_code == 0) exit_code = std::abs(ended[k].exit_code);
      }
    }
    const auto lines = lab::passport_lines(results, wanted);
    replace_file(out + "/passport.md", lab::passport_page(material, sample, results, lines));
    replace_file(out + "/passport.svg", svg_of(lab::passport_plots(results), 2));
    return tell(lines, out, exit_code);
  }

  /// Those of the named material that it uses, and those of the command line in their place.
  std::vector<MaterialTarget> all_targets(const std::string& use) const {
    std::vector<MaterialTarget> all;
    for (const std::string& text : targets) all.push_back(target_from(text));
    if (const NamedMaterial* const named = use.empty() ? nullptr : named_material(use))
      all.insert(all.end(), named->targets.begin(), named->targets.end());
    return all;
  }

  std::vector<lab::SpecimenTest> chosen() const {
    std::vector<lab::SpecimenTest> tests;
    std::string names;
    for (const lab::SpecimenTest& test : lab::specimen_tests()) {
      names += " " + test.name;
      if (only.empty() || std::find(only.begin(), only.end(), test.name) != only.end())
        tests.push_back(test);
    }
    if (!only.empty() && tests.size() != only.size())
      throw InputError("--only: the tests are" + names + "; nothing was run");
    return tests;
  }

  static void write_curve(const lab::LoadCurve& curve, const std::string& out,
                          const std::string& name) {
    std::string text = curve.x_name + "," + curve.y_name + "\n", file = name;
    std::replace(file.begin(), file.end(), ' ', '-');
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      text += fmt::format("{},{}\n", curve.x[k], curve.y[k]);
    make_folder(out + "/curves");
    replace_file(out + "/curves/" + file + ".csv", text);
  }

  static int tell(const std::vector<lab::PassportLine>& lines, const std::string& out,
                  int exit_code) {
    constexpr int check_failed = 9;
    for (const lab::PassportLine& line : lines) {
      const std::string verdict =
          !line.target ? ""
                       : fmt::format("  target {}, {}", lab::short_number(*line.target),
                                     line.pass() ? "pass" : "fail");
      fmt::print("{:<38} {:<16} {}{}\n", line.test, line.quantity, lab::spread_text(line.spread),
                 verdict);
      if (exit_code == 0 && !line.pass()) exit_code = check_failed;
    }
    fmt::print("page {0}/passport.md  curves {0}/curves, {0}/passport.svg\n", harmless(out));
    return exit_code;
  }
};

}  // namespace

void add_test(CLI::App& program, int& exit_code) {
  const auto test = std::make_shared<TestCommand>();
  CLI::App* const command =
      program.add_subcommand("test", "the virtual laboratory on one material of a case");
  command->add_option("CASE", test->path, "a case of method dem3d")->required();
  command->add_option("--material", test->material, "a material of it, of law concrete or parallel")
      ->type_name("NAME")
      ->required();
  const auto each = [&](const char* name, std::vector<std::string>& values, const char* help,
                        const char* type) {
    command->add_option(name, values, help)
        ->type_name(type)
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
  };
  each("--target", test->targets, "a number it must show; may be repeated", "NAME=VALUE");
  each("--only", test->only, "this test; may be repeated", "TEST");
  command->add_option("--seeds", test->seeds, "packings of each specimen; default: 3")
      ->type_name("N")
      ->check([](const std::string& text) { return count_problem(text); });
  command->add_option("--elements", test->elements, "elements of the prism; default: 1200")
      ->type_name("N")
      ->check(CLI::Range(200, 1000000));
  each("--set", test->overrides, "override a key of the case", "KEY=VALUE");
  command->add_option("-o,--out", test->folder, "default: out/<case>_<material>_test")
      ->type_name("DIR");
  add_side_by_side_options(*command, test->options);
  command->footer(
      "Tests: compression_prism, compression_cube (smooth ends), platens_prism,\n"
      "platens_cube (rough platens), tension, brazilian, bending (a notched beam).\n"
      "\n"
      "Targets: young, poisson, compression, tension, brazilian, fracture_energy, as in\n"
      "--target 'tension=2.9 MPa'; a material with the key use has those of its name.\n"
      "The exit code is 9 if a mean misses its target.\n"
      "\n"
      "DIR/passport.md is the page, passport.svg has the curves of all specimens,\n"
      "curves/*.csv their points, cases/ and runs/ what was computed. Called again,\n"
      "the command keeps finished specimens.");
  command->callback([test, &exit_code] { exit_code = test->execute(); });
}

}  // namespace breccia::app
