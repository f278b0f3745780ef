// breccia verify PICTURE: runs again what a picture says it is of, draws it and compares.

#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/film.hpp"
#include "app/film_recipe.hpp"
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
constexpr double most_rms = 12.0;  // that compression changes pixels by, of 255

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

/// Root of the mean square, over all bytes of two pictures of one size.
double rms_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = double(a[i]) - double(b[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct VerifyCommand {
  std::string picture, folder, device = "cpu";
  int threads = 0;
  bool allow_scripts = false;

  int execute() const {
    if (is_film(picture)) return verify_film();
    const PictureRecipe recipe = recipe_of(notes_of(read_whole_file(picture), picture), picture);
    refuse_other_version(recipe);
    const Image shown = read_png_with_alpha(picture);
    return made_again(recipe, [&](Method& method, const std::string& out) {
      return compare(recipe, method, shown, out);
    });
  }

  void refuse_other_version(const PictureRecipe& recipe) const {
    if (recipe.version == this_build().version) return;
    throw InputError(fmt::format(
        "{}: the picture is by breccia {}, this is {}; another version may give other bits",
        picture, recipe.version, this_build().version));
  }

  /// Runs the case to the moment of the recipe, then `judge(method, folder of results)`.
  template <class Judge>
  int made_again(const PictureRecipe& recipe, const Judge& judge) const {
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
    return judge(*method, scratch.file("out"));
  }

  /// Every picture of a film drawn again, against its digest and against what the film shows.
  int verify_film() const {
    const FilmRecipe film = film_recipe_in(read_whole_file(picture), picture);
    std::vector<PictureRecipe> recipes;
    for (const std::vector<PngNote>& notes : film.pictures) {
      std::vector<PngNote> all = film.run;
      all.insert(all.end(), notes.begin(), notes.end());
      recipes.push_back(recipe_of(all, picture));
    }
    const PictureRecipe& last = *std::max_element(
        recipes.begin(), recipes.end(), [](const PictureRecipe& a, const PictureRecipe& b) {
          return a.moment.step < b.moment.step;
        });
    refuse_other_version(last);
    return made_again(last, [&](Method& method, const std::string& out) {
      return compare_film(film, recipes, last, method, out);
    });
  }

  int compare_film(const FilmRecipe& film, const std::vector<PictureRecipe>& recipes,
                   const PictureRecipe& last, Method& method, const std::string& out) const {
    std::string differs = unlike_state(last.moment, method);
    std::optional<FilmReader> shown;
    double worst = 0.0;
    std::size_t done = 0;
    for (; differs.empty() && done < recipes.size(); ++done) {
      const Image again = drawn_again(recipes[done], method, out);
      if (digest_of_pixels(again) != film.pixels[done]) {
        differs = "its pixels are not those that the film was made of";
        break;
      }
      if (!shown) shown.emplace(picture, again.width, again.height);
      const std::vector<std::uint8_t> seen = shown->next();
      if (seen.empty()) {
        differs = "the film ends before it";
        break;
      }
      const double rms = rms_difference(again.rgb, seen);
      worst = std::max(worst, rms);
      if (rms > most_rms) {
        differs = fmt::format("the film shows another one (by {:.1f} of 255)", rms);
        break;
      }
    }
    if (differs.empty() && shown && !shown->next().empty())
      differs = "the film has more pictures than that";
    if (!differs.empty()) {
      fmt::print("{}\n", harmless(fmt::format("another film: picture {} of {}: {}", done + 1,
                                              recipes.size(), differs)));
      return exit_differs;
    }
    fmt::print("{}\n", harmless(fmt::format(
                           "the same film: {}, {} pictures to step {}, hash {:016x}{}; their "
                           "pixels are those that it was made of, compression changed them by "
                           "{:.1f} of 255 at most",
                           last.case_name, recipes.size(), last.moment.step, method.state_hash(),
                           last.moment.hash ? "" : " (the film names none)", worst)));
    return 0;
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

  static std::string unlike_state(const PictureMoment& moment, Method& method) {
    if (method.steps() != moment.step)
      return fmt::format("the run ended at step {}, the picture is of {}", method.steps(),
                         moment.step);
    if (const std::uint64_t hash = method.state_hash(); moment.hash && *moment.hash != hash)
      return fmt::format("the state at step {} has hash {:016x}, the picture names {:016x}",
                         moment.step, hash, *moment.hash);
    return {};
  }

  int compare(const PictureRecipe& recipe, Method& method, const Image& shown,
              const std::string& out) const {
    const PictureMoment& moment = recipe.moment;
    const std::uint64_t hash = method.state_hash();
    std::string differs = unlike_state(moment, method);
    if (differs.empty()) differs = unlike(drawn_again(recipe, method, out), shown);
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
      "verify", "run again what a picture or film says it is of, draw it and compare");
  command
      ->add_option("PICTURE", verify->picture,
                   "a PNG that `run` or `render` wrote, or a film of `render`")
      ->required();
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
