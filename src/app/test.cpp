// breccia test CASE --material NAME: the virtual laboratory on one material.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "app/commands.hpp"
#include "app/damping_option.hpp"
#include "app/option_kinds.hpp"
#include "app/side_by_side_options.hpp"
#include "app/targets.hpp"
#include "exec/error.hpp"
#include "io/case/suggestion.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "laboratory/passport.hpp"
#include "laboratory/specimen_runs.hpp"
#include "run/case.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

namespace lab = laboratory;

std::string specimens_of(const lab::Sample& s) {
  if (s.material.law == "ldpm")
    return fmt::format(
        "Specimens of LDPM with the mix's grains of {:.3g} to {:.3g} mm; the prism is five of the "
        "largest wide and twice as high.",
        1e3 * s.material.mix.smallest, 1e3 * s.material.mix.largest);
  return fmt::format(
      "Specimens of spheres, {} in the prism of 0.1 x 0.1 x 0.2 m, {} in the disc, and as large "
      "ones as the prism's in the others; compactness {}, interaction range {}, local damping {}.",
      s.elements, std::max(s.elements, lab::fewest_in_disc), s.compactness, s.range, s.damping);
}
std::string specimens_of(const lab::RockSample& s) {
  return fmt::format(
      "Plane specimens (plane stress) of about {} triangles each: a plate of 50 x 100 mm, a disc "
      "of 50 mm.",
      s.elements);
}

struct TestCommand {
  std::string path, material, folder;
  std::vector<std::string> overrides, targets, only;
  int seeds = 3, elements = 1200;
  std::int64_t first_seed = 1;
  std::optional<double> damping;
  SideBySideOptions options;

  int execute() const {
    const Case read = load_case(path, overrides);
    tell_notes(read.notes);
    if (const auto* const concrete = std::get_if<dem::Config>(&read.config))
      return of_concrete(read, damped(lab::sample_of(*concrete, material), damping));
    refuse_damping(damping);
    const lab::RockSample rock = lab::rock_sample_of(rock_case(read), material);
    const auto wanted = all_targets(targets, rock.material.use);
    return make(read, rock, lab::rock_tests(lab::side_pressure(wanted, rock.material.joint)));
  }

  int of_concrete(const Case& read, const lab::Sample& sample) const {
    const std::vector<lab::SpecimenTest> tests = lab::tests_of(sample.material);
    if (sample.material.law != "ldpm" && elements < lab::fewest_between_walls)
      refuse_walls(chosen(tests));
    return make(read, sample, tests);
  }
  void refuse_walls(const std::vector<lab::SpecimenTest>& tests) const {
    std::string between, others;
    for (const lab::SpecimenTest& test : tests)
      (lab::has_walls(test) ? between : others) += " " + test.name;
    if (between.empty()) return;
    throw InputError(fmt::format(
        "--elements {}: so few spheres reach into the walls that press them before these move, and "
        "their strengths mean nothing; nothing was run\n  take {} or more for{}{}",
        elements, lab::fewest_between_walls, between,
        others.empty() ? "" : "\n  or name others by --only:" + others));
  }
  template <class Sample>
  int make(const Case& read, Sample sample, const std::vector<lab::SpecimenTest>& tests) const {
    sample.elements = elements;
    const std::vector<MaterialTarget> wanted = all_targets(targets, sample.material.use);
    const std::string out = folder.empty() ? "out/" + read.name + "_" + material + "_test" : folder;
    int exit_code = 0;
    const auto results = lab::run_specimens(chosen(tests), sample, bench(out), exit_code);
    for (const lab::TestResults& result : results)
      for (std::size_t k = 0; k < result.specimens.size(); ++k)
        write_curve(result.specimens[k].curve, out, fmt::format("{}-{}", result.test.name, k + 1));
    const auto lines = lab::passport_lines(results, wanted);
    replace_file(out + "/passport.md",
                 lab::passport_page(material, specimens_of(sample), results, lines));
    replace_file(out + "/specimens.csv", lab::specimens_table(results));
    replace_file(out + "/passport.svg", svg_of(lab::passport_plots(results), 2));
    return tell(lines, out, exit_code);
  }

  lab::Bench bench(const std::string& out) const {
    return {out, first_seed, seeds,
            [this](std::size_t runs, double bytes) { return options.workers(runs, bytes); },
            tell_of};
  }

  std::vector<lab::SpecimenTest> chosen(const std::vector<lab::SpecimenTest>& all) const {
    std::vector<lab::SpecimenTest> tests;
    std::set<std::string> names;
    for (const lab::SpecimenTest& test : all) {
      names.insert(test.name);
      if (only.empty() ? !test.asked : std::find(only.begin(), only.end(), test.name) != only.end())
        tests.push_back(test);
    }
    for (const std::string& name : only)
      if (!names.contains(name)) {
        const std::string near = suggestion(name, names);
        throw InputError(fmt::format("--only {}: no such test{}; nothing was run\n  there are {}",
                                     name, near.starts_with("; did you") ? near : "",
                                     fmt::join(names, ", ")));
      }
    return tests;
  }

  static void write_curve(const lab::LoadCurve& curve, const std::string& out,
                          const std::string& name) {
    std::string text = curve.x_name + "," + curve.y_name + "\n";
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      text += fmt::format("{},{}\n", curve.x[k], curve.y[k]);
    make_folder(out + "/curves");
    replace_file(out + "/curves/" + name + ".csv", text);
  }

  static int tell(const std::vector<lab::PassportLine>& lines, const std::string& out,
                  int exit_code) {
    constexpr int check_failed = 9;
    for (const lab::PassportLine& line : lines) {
      const std::string verdict = !line.target ? ""
                                               : fmt::format("  target {}, {}", line.target_text(),
                                                             line.pass() ? "pass" : "fail");
      fmt::print("{:<38} {:<16} {}{}\n", line.test, line.quantity, line.shown_text(), verdict);
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
  command->add_option("CASE", test->path, "a case")->required();
  command->add_option("--material", test->material, "a material of it that breaks")
      ->type_name("NAME")
      ->required();
  add_repeated(command, "--target", test->targets, "a number it must show; may be repeated",
               "NAME=VALUE");
  add_repeated(command, "--only", test->only, "this test; may be repeated", "TEST");
  add_count(command, "--seeds", test->seeds, "packings of each specimen; default: 3");
  command->add_option("--first-seed", test->first_seed, "seed of the first one; default: 1")
      ->type_name("N")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? text + " is below 0" : std::string();
      });
  command
      ->add_option("--elements", test->elements,
                   "elements of the prism, triangles of the plate; default: 1200")
      ->type_name("N")
      ->check(CLI::Range(200, 1000000));
  add_damping(*command, test->damping);
  add_repeated(command, "--set", test->overrides, "override a key of the case", "KEY=VALUE");
  command->add_option("-o,--out", test->folder, "default: out/<case>_<material>_test")
      ->type_name("DIR");
  add_side_by_side_options(*command, test->options);
  command->footer(
      "Tests of concrete (DEM): compression_prism, compression_cube (smooth ends), platens_prism, "
      "platens_cube (rough platens), tension, tension_notched (a prism), brazilian, bending "
      "(a notched beam), bending_plain, bending_thirds (plain ones), triaxial_5, _20, _50, _100, "
      "_200 (pressure in MPa; _500 and _650 if --only names them), oedometer. Those with walls "
      "(platens, triaxial, oedometer) take 600 elements or more.\n"
      "\n"
      "Of law ldpm: compression_prism, compression_cube, platens_prism, platens_cube (rough ends), "
      "held_prism, held_cube (held ends), tension, tension_notched, triaxial_5 to _200, biaxial, "
      "oedometer, hydrostatic; grains are the mix's, the prism is five of the largest wide, "
      "--elements has no use.\n"
      "\n"
      "Tests of rock (FDEM): plate, plate_pressed (its sides by half the target compression, at "
      "most the target confinement), disc, tension (a plate).\n"
      "\n"
      "Targets: young, poisson, compression, tension, brazilian, fracture_energy, friction_angle "
      "(by the strength of plate_pressed), confinement, as in --target 'tension=2.9 MPa'; a "
      "material with the key use has those of its name. The exit code is 9 if a mean misses its "
      "target.\n"
      "\n"
      "DIR/passport.md is the page, passport.svg has the curves of all specimens, curves/*.csv "
      "their points, specimens.csv their numbers, cases/ and runs/ what was computed. Called "
      "again, the command keeps finished specimens.");
  command->callback([test, &exit_code] { exit_code = test->execute(); });
}

}  // namespace breccia::app
