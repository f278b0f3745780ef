// breccia calibrate CASE --material NAME: local numbers of a material from macroscopic targets.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/damping_option.hpp"
#include "app/option_kinds.hpp"
#include "app/side_by_side_options.hpp"
#include "app/targets.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "laboratory/calibration.hpp"
#include "laboratory/optimiser.hpp"
#include "laboratory/specimen_runs.hpp"
#include "run/case.hpp"
#include "run/machine/machine.hpp"

namespace breccia::app {
namespace {

namespace lab = laboratory;

struct CalibrateCommand {
  std::string path, material, folder, method = "secant";
  std::vector<std::string> overrides, targets;
  int seeds = 2, elements = 1200, steps = 0;
  std::optional<double> damping;
  SideBySideOptions options;

  int execute() const {
    const Case read = load_case(path, overrides);
    tell_notes(read.notes);
    if (const auto* const concrete = std::get_if<dem::Config>(&read.config)) {
      const lab::Sample sample = damped(lab::sample_of(*concrete, material), damping);
      if (sample.material.law == "ldpm")
        return find(
            read, sample,
            fmt::format("specimens with grains of {:.3g} to {:.3g} mm, the prism five of "
                        "the largest wide",
                        1e3 * sample.material.mix.smallest, 1e3 * sample.material.mix.largest));
      return find(read, sample,
                  fmt::format("packings of {} elements in the prism, compactness {}, size ratio "
                              "{}, interaction range {}, local damping {}",
                              elements, sample.compactness, sample.size_ratio, sample.range,
                              sample.damping));
    }
    refuse_damping(damping);
    return find(read, lab::rock_sample_of(rock_case(read), material),
                fmt::format("meshes of {} triangles in the plate of 50 x 100 mm", elements));
  }

  template <class Sample>
  int find(const Case& read, Sample sample, const std::string& specimens) const {
    sample.elements = elements;
    lab::Calibration calibration(sample.material, all_targets(targets, sample.material.use));
    const std::string out =
        folder.empty() ? "out/" + read.name + "_" + material + "_calibration" : folder;
    const std::string circumstances =
        fmt::format("Calibrated by breccia {} on {} {}.", this_build().version, seeds, specimens);
    const lab::Bench bench{
        out, 1, seeds,
        [this](std::size_t runs, double bytes) { return options.workers(runs, bytes); }, tell_of};
    int exit_code = 0;
    const std::size_t most = static_cast<std::size_t>(steps > 0 ? steps : by_secants() ? 8 : 60);
    const auto goes_on = [&] {
      return exit_code == 0 && !calibration.converged() && calibration.steps().size() < most;
    };
    const auto step = [&] {
      sample.material = calibration.material();
      const auto results = lab::run_specimens(calibration.tests(), sample, bench, exit_code);
      if (exit_code > 128) return;  // ended by a signal: what was computed is kept
      calibration.take(results);
      fmt::print("step {}: {}\n", calibration.steps().size(), calibration.progress());
      std::fflush(stdout);
      replace_file(out + "/calibration.md", calibration.page(material, circumstances));
      replace_file(out + "/calibration.svg", svg_of({calibration.plot()}));
      replace_file(out + "/material.toml", calibration.block(circumstances));
    };
    if (by_secants())
      while (goes_on()) step();
    else
      lab::make_small(method, calibration.keys(), [&](const std::vector<double>& keys) {
        calibration.set_keys(keys);
        step();
        return goes_on() ? calibration.misfits() : std::vector<double>{};
      });
    if (exit_code > 128) return exit_code;
    const std::string missed = calibration.obstacles();
    fmt::print("{}  material {}/material.toml  steps {}/calibration.md\n",
               missed.empty() ? "every target is met" : "not every target is met, " + missed,
               harmless(out), harmless(out));
    constexpr int check_failed = 9;
    return exit_code != 0 ? exit_code : calibration.converged() ? 0 : check_failed;
  }

  bool by_secants() const { return method == "secant"; }
};

}  // namespace

void add_calibrate(CLI::App& program, int& exit_code) {
  const auto calibrate = std::make_shared<CalibrateCommand>();
  CLI::App* const command =
      program.add_subcommand("calibrate", "find local numbers of a material from macroscopic ones");
  command->add_option("CASE", calibrate->path, "a case")->required();
  command->add_option("--material", calibrate->material, "a material of it: where to begin")
      ->type_name("NAME")
      ->required();
  add_repeated(command, "--target", calibrate->targets, "a number it must show; may be repeated",
               "NAME=VALUE");
  add_count(command, "--seeds", calibrate->seeds, "packings of each specimen; default: 2");
  add_count(command, "--elements", calibrate->elements,
            "elements of the prism, triangles of the plate; default: 1200");
  add_count(command, "--steps", calibrate->steps, "steps at most; default: 8, by NLopt 60");
  command
      ->add_option("--method", calibrate->method,
                   "secant, or by NLopt cobyla (then sbplx), sbplx, bobyqa")
      ->type_name("NAME")
      ->check(CLI::IsMember({"secant", "cobyla", "sbplx", "bobyqa"}));
  add_damping(*command, calibrate->damping);
  add_repeated(command, "--set", calibrate->overrides, "override a key of the case", "KEY=VALUE");
  command->add_option("-o,--out", calibrate->folder, "default: out/<case>_<material>_calibration")
      ->type_name("DIR");
  add_side_by_side_options(*command, calibrate->options);
  command->footer(
      "Each target is mostly the work of one key. Concrete (DEM): young, poisson, tension by "
      "tensile_strength, compression by cohesion, fracture_energy; law ldpm likewise, the energy "
      "by ldpm.tensile_length. Rock (FDEM): young, poisson, brazilian or else tension by "
      "joint.tension, compression by joint.cohesion, friction_angle; fracture_energy and "
      "slide_energy are set as joint.energy_open and joint.energy_slide, and no specimen shows "
      "them. Other keys stay. A material with the key use has the targets of its name; --target "
      "takes their place.\n"
      "\n"
      "A step makes the specimens that show the targets ('breccia test'), then all keys move by "
      "secants. It ends when all means are within 3 % (E), 5 % (strengths, friction angle), 10 % "
      "(nu, fracture energy), else with exit code 9.\n"
      "\n"
      "DIR/material.toml is the material with its record, calibration.md and .svg the steps. "
      "Called again, the command takes what was computed from DIR/runs.");
  command->callback([calibrate, &exit_code] { exit_code = calibrate->execute(); });
}

}  // namespace breccia::app
