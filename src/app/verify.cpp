// breccia verify PICTURE: runs again what a picture says it is of, draws it and compares.

#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "run/case.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/machine/signals.hpp"
#include "run/results/picture_notes.hpp"
#include "run/run.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

constexpr int exit_differs = 9;

/// A folder of its own that goes with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    if (::mkdtemp(path_.data()) == nullptr) throw IoError(path_ + ": cannot be made");
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_ = (fs::temp_directory_path() / "breccia-verify-XXXXXX").string();
};

/// Pixels that are not alike, of two images of one size.
std::int64_t unlike_pixels(const Image& a, const Image& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i + 2 < a.rgb.size(); i += 3)
    count += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2] ||
             (!a.alpha.empty() && a.alpha[i / 3] != b.alpha[i / 3]);
  return count;
}

struct VerifyCommand {
  std::string picture, folder, device = "cpu";
  int threads = 0;
  bool allow_scripts = false;

  int execute() const {
    const PictureRecipe recipe = recipe_of(notes_of(read_whole_file(picture), picture), picture);
    if (recipe.version != this_build().version)
      throw InputError(fmt::format(
          "{}: the picture is by breccia {}, this is {}; another version may give other bits",
          picture, recipe.version, this_build().version));
    const Image shown = read_png_with_alpha(picture);
    StopSignals signals;
    const ScratchFolder scratch;
    const Case read = case_of(recipe, scratch.file("input"));
    StageTimers timers;
    Exec exec = exec_on(device, threads, nullptr);
    exec.timers = &timers;
    const std::unique_ptr<Method> method = make_method(read, exec, nullptr);
    signals.answer_between_steps();
    fmt::print("{}\n", harmless(fmt::format("runs {} to step {} again, {}", recipe.case_name,
                                            count_text(double(recipe.moment.step)),
                                            time_text(recipe.moment.time))));
    std::fflush(stdout);
    if (const int stopped = run_to(recipe, read, exec, *method, scratch.file("out")); stopped != 0)
      return stopped;
    return compare(recipe, *method, shown, scratch.file("out"));
  }

  /// The case of the picture, without output but the frames that it may have been drawn from.
  Case case_of(const PictureRecipe& recipe, const std::string& nowhere) const {
    const bool stored = recipe.moment.frame.has_value();
    Case read = case_of_text(recipe.case_text, recipe.case_name, folder.empty() ? nowhere : folder,
                             {"output.pictures=false", "output.picture_steps=[]",
                              fmt::format("output.fields={}", stored), "output.report=false"});
    try {
      check_files(read);
    } catch (const Error& error) {
      throw InputError(
          fmt::format("{}\n  the case reads files that the picture does not hold; "
                      "--folder DIR says where they are",
                      error.what()));
    }
    if (!allow_scripts) refuse_scripts(read);
    return read;
  }

  int run_to(const PictureRecipe& recipe, const Case& read, const Exec& exec, Method& method,
             const std::string& out) const {
    RunPlan plan = breccia::plan_of(read);
    plan.limits.steps = recipe.moment.step;
    plan.machine = {processor_name(), device, exec.threads, 1};
    plan.timers = exec.timers;
    plan.speech = Speech::quiet;
    const ResultFolder result = ResultFolder::create(out, Existing::refuse);
    try {
      return Run(method, plan, &result).execute();
    } catch (const CheckFailed&) {
      return 0;  // the run itself ended well
    }
  }

  int compare(const PictureRecipe& recipe, Method& method, const Image& shown,
              const std::string& out) const {
    const PictureMoment& moment = recipe.moment;
    const std::uint64_t hash = method.state_hash();
    std::string differs;
    if (method.steps() != moment.step)
      differs = fmt::format("the run ended at step {}, the picture is of {}", method.steps(),
                            moment.step);
    else if (moment.hash && *moment.hash != hash)
      differs = fmt::format("the state at step {} has hash {:016x}, the picture names {:016x}",
                            moment.step, hash, *moment.hash);
    else
      differs = unlike(drawn_again(recipe, method, out), shown);
    if (!differs.empty()) {
      fmt::print("{}\n", harmless(fmt::format("another picture: {}", differs)));
      return exit_differs;
    }
    fmt::print("{}\n",
               harmless(fmt::format("the same picture: {}, step {}, hash {:016x}{}, all {} x {} "
                                    "pixels",
                                    recipe.case_name, moment.step, hash,
                                    moment.hash ? "" : " (the picture names none)", shown.width,
                                    shown.height)));
    return 0;
  }

  static Image drawn_again(const PictureRecipe& recipe, Method& method, const std::string& out) {
    if (recipe.moment.frame) {
      Frame frame = read_frame(out, *recipe.moment.frame);
      if (needs_displacement(recipe.options)) add_displacement(frame, read_frame(out, 0));
      return render(frame, recipe.options);
    }
    return render(method.frame(), recipe.options);
  }

  static std::string unlike(const Image& again, const Image& shown) {
    if (again.width != shown.width || again.height != shown.height)
      return fmt::format("it is drawn with {} x {} pixels, the picture has {} x {}", again.width,
                         again.height, shown.width, shown.height);
    if (again.alpha.empty() != shown.alpha.empty()) return "one of them is transparent";
    const std::int64_t count = unlike_pixels(again, shown);
    if (count == 0) return {};
    return fmt::format("{} of {} pixels differ", count, shown.rgb.size() / 3);
  }
};

}  // namespace

void add_verify(CLI::App& program, int& exit_code) {
  const auto verify = std::make_shared<VerifyCommand>();
  CLI::App* const command = program.add_subcommand(
      "verify", "run again what a picture says it is of, draw it and compare");
  command->add_option("PICTURE", verify->picture, "a PNG that `run` or `render` wrote")->required();
  command->add_option("--folder", verify->folder, "where the files are that the case reads")
      ->type_name("DIR");
  command->add_option("--device", verify->device, "where to compute: cpu, cuda or cuda:N")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--threads", verify->threads, "host threads; default: all there are")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--allow-scripts", verify->allow_scripts, allow_scripts_help);
  command->callback([verify, &exit_code] { exit_code = verify->execute(); });
}

}  // namespace breccia::app
