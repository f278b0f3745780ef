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
#include "app/run_notes.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/picture/vector_picture.hpp"
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

/// A picture, sheet, drawing or film as its texts describe it.
struct Described {
  FilmRecipe recipe;
  std::vector<std::vector<PictureRecipe>> pictures;  ///< parts of each

  Described(FilmRecipe from, const std::string& path) : recipe(std::move(from)) {
    for (const std::vector<RecipePart>& parts : recipe.pictures) {
      std::vector<PictureRecipe>& picture = pictures.emplace_back();
      for (const RecipePart& part : parts) {
        std::vector<PngNote> notes = recipe.runs[static_cast<std::size_t>(part.run)];
        notes.insert(notes.end(), part.notes.begin(), part.notes.end());
        picture.push_back(recipe_of(notes, path));
        refuse_other_version(picture.back(), path);
      }
    }
  }
  /// The part of a run that shows its last step; none: nothing shows that run.
  const PictureRecipe* last_of(int run) const {
    const PictureRecipe* last = nullptr;
    for (std::size_t p = 0; p < pictures.size(); ++p)
      for (std::size_t k = 0; k < pictures[p].size(); ++k)
        if (recipe.pictures[p][k].run == run &&
            (last == nullptr || pictures[p][k].moment.step > last->moment.step))
          last = &pictures[p][k];
    return last;
  }
  static void refuse_other_version(const PictureRecipe& recipe, const std::string& path) {
    if (recipe.version == this_build().version) return;
    throw InputError(
        fmt::format("{}: the picture is by breccia {}, this is {}; another version may give other "
                    "bits",
                    path, recipe.version, this_build().version));
  }
};

/// A run made again, up to the last step that is shown of it.
struct Again {
  StageTimers timers;
  std::unique_ptr<Method> method;
  std::string out;

  Frame frame(const PictureRecipe& recipe) const {
    if (!recipe.moment.frame) return method->frame();
    Frame frame = read_frame(out, *recipe.moment.frame);
    if (needs_displacement(recipe.options)) add_displacement(frame, read_frame(out, 0));
    if (shows_contacts(frame, recipe.options)) add_contacts_of(out, *recipe.moment.frame, frame);
    return frame;
  }
  /// A sentence if its state at that moment is not what the picture names.
  std::string unlike(const PictureMoment& named) const {
    PictureMoment now{method->steps(), method->time(), {}};
    if (named.frame && named.step != method->steps()) {
      const auto moment = moment_of_frame(out, *named.frame, named.time);
      if (!moment) return fmt::format("the run has no frame {}", *named.frame);
      now = *moment;
    } else {
      now.hash = method->state_hash();
    }
    if (now.step != named.step)
      return fmt::format("the run came to step {}, the picture is of {}", now.step, named.step);
    if (named.hash && now.hash && *named.hash != *now.hash)
      return fmt::format("the state at step {} has hash {:016x}, the picture names {:016x}",
                         now.step, *now.hash, *named.hash);
    return {};
  }
};

struct VerifyCommand {
  std::string picture, folder, device = "cpu";
  int threads = 0;
  bool allow_scripts = false;

  int execute() const {
    const std::string content = read_whole_file(picture);
    const Described described(described_by(content), picture);
    StopSignals signals;
    const ScratchFolder scratch;
    std::vector<std::unique_ptr<Again>> runs;
    for (int run = 0; run < static_cast<int>(described.recipe.runs.size()); ++run) {
      const PictureRecipe* const last = described.last_of(run);
      if (last == nullptr) throw InputError(picture + ": the recipe in it is damaged");
      runs.push_back(std::make_unique<Again>());
      if (const int stopped = made_again(*last, scratch, run, signals, *runs.back()); stopped != 0)
        return stopped;
    }
    if (is_film(picture)) return compare_film(described, runs);
    return compare(described, runs, content);
  }

  FilmRecipe described_by(const std::string& content) const {
    if (is_film(picture) || is_drawing()) return recipe_in(content, picture);
    std::vector<PngNote> notes = notes_of(content, picture);
    if (const std::string several = note(notes, "Pictures"); !several.empty())
      return recipe_of_text(several, picture);
    return {{std::move(notes)}, 1, {{RecipePart{}}}, {}};
  }
  bool is_drawing() const { return picture.ends_with(".svg") || picture.ends_with(".pdf"); }

  /// Runs a case to the moment of the recipe; 0, or the exit code of a signal.
  int made_again(const PictureRecipe& recipe, const ScratchFolder& scratch, int number,
                 StopSignals& signals, Again& again) const {
    const Case read = case_of(recipe, scratch.file("input"));
    Exec exec = exec_on(device, threads, nullptr);
    exec.timers = &again.timers;
    again.method = make_method(read, exec, nullptr);
    again.out = scratch.file(fmt::format("out{}", number));
    signals.answer_between_steps();
    fmt::print("{}\n", harmless(fmt::format("runs {} to step {} again, {}", recipe.case_name,
                                            count_text(double(recipe.moment.step)),
                                            time_text(recipe.moment.time))));
    std::fflush(stdout);
    return run_to(recipe, read, exec, again);
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

  int run_to(const PictureRecipe& recipe, const Case& read, const Exec& exec, Again& again) const {
    RunPlan plan = breccia::plan_of(read);
    plan.limits.steps = recipe.moment.step;
    plan.machine = {processor_name(), device, exec.threads, 1};
    plan.timers = exec.timers;
    plan.speech = Speech::quiet;
    const ResultFolder result = ResultFolder::create(again.out, Existing::refuse);
    try {
      return Run(*again.method, plan, &result).execute();
    } catch (const CheckFailed&) {
      return 0;  // the run itself ended well
    }
  }

  using Runs = std::vector<std::unique_ptr<Again>>;

  /// Draws one picture of all again; a sentence if a state is not what it names.
  static std::string drawn_again(const Described& all, std::size_t number, const Runs& runs,
                                 Image& image) {
    std::vector<Image> parts;
    for (std::size_t k = 0; k < all.pictures[number].size(); ++k) {
      const PictureRecipe& recipe = all.pictures[number][k];
      const int run = all.recipe.pictures[number][k].run;
      const Again& again = *runs[static_cast<std::size_t>(run)];
      if (const std::string differs = again.unlike(recipe.moment); !differs.empty()) return differs;
      parts.push_back(render(again.frame(recipe), recipe.options));
      if (parts.back().width != parts.front().width || parts.back().height != parts.front().height)
        return "its parts are not of one size";
    }
    image = parts.size() == 1 ? std::move(parts.front()) : grid(parts, all.recipe.columns);
    return {};
  }

  int compare_film(const Described& film, const Runs& runs) const {
    std::string differs;
    std::optional<FilmReader> shown;
    double worst = 0.0;
    std::size_t done = 0;
    for (; done < film.pictures.size(); ++done) {
      Image again;
      differs = drawn_again(film, done, runs, again);
      if (!differs.empty()) break;
      if (film.recipe.pixels.size() != film.pictures.size() ||
          digest_of_pixels(again) != film.recipe.pixels[done]) {
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
                                              film.pictures.size(), differs)));
      return exit_differs;
    }
    fmt::print("{}\n", harmless(fmt::format(
                           "the same film: {}, {} pictures to {}; their pixels are those "
                           "that it was made of, compression changed them by {:.1f} of "
                           "255 at most",
                           names_of(film), film.pictures.size(), ends_of(film, runs), worst)));
    return 0;
  }

  int compare(const Described& one, const Runs& runs, const std::string& content) const {
    std::string differs, size;
    if (is_drawing()) {
      const PictureRecipe& recipe = one.pictures.front().front();
      const std::string about = about_drawing(content);
      differs = runs.front()->unlike(recipe.moment);
      const Frame frame = runs.front()->frame(recipe);
      if (differs.empty() &&
          content != (picture.ends_with(".svg") ? svg_content(frame, recipe.options, about)
                                                : pdf_content(frame, recipe.options, about)))
        differs = "the drawing has other lines";
      size = fmt::format("all {} bytes", content.size());
    } else {
      const Image shown = read_png_with_alpha(picture);
      Image again;
      differs = unlike_size(one, shown);
      if (differs.empty()) differs = drawn_again(one, 0, runs, again);
      if (differs.empty()) differs = unlike(again, shown);
      size = fmt::format("all {} x {} pixels", shown.width, shown.height);
    }
    if (!differs.empty()) {
      fmt::print("{}\n", harmless(fmt::format("another picture: {}", differs)));
      return exit_differs;
    }
    fmt::print("{}\n", harmless(fmt::format("the same picture: {}, {}, {}", names_of(one),
                                            ends_of(one, runs), size)));
    return 0;
  }

  static std::string names_of(const Described& all) {
    std::string names;
    for (int run = 0; run < static_cast<int>(all.recipe.runs.size()); ++run)
      names += (run > 0 ? " beside " : "") + all.last_of(run)->case_name;
    return names;
  }
  /// "step 200, hash 0123456789abcdef" of each run.
  static std::string ends_of(const Described& all, const Runs& runs) {
    std::string ends;
    for (std::size_t run = 0; run < runs.size(); ++run) {
      const PictureMoment& moment = all.last_of(static_cast<int>(run))->moment;
      ends += fmt::format("{}step {}, hash {:016x}{}", run > 0 ? " and " : "", moment.step,
                          runs[run]->method->state_hash(),
                          moment.hash ? "" : " (the picture names none)");
    }
    return ends;
  }

  /// Asked before anything is drawn, which may be more than fits the memory.
  static std::string unlike_size(const Described& one, const Image& shown) {
    const std::vector<PictureRecipe>& parts = one.pictures.front();
    const auto count = static_cast<std::int64_t>(parts.size());
    const std::int64_t columns = count == 1 ? 1 : one.recipe.columns;
    const std::int64_t width = columns * parts.front().options.width;
    const std::int64_t height = (count + columns - 1) / columns * parts.front().options.height;
    if (width == shown.width && height == shown.height) return {};
    return fmt::format("it is drawn with {} x {} pixels, the picture has {} x {}", width, height,
                       shown.width, shown.height);
  }

  static std::string unlike(const Image& again, const Image& shown) {
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
                   "a PNG that `run` or `render` wrote, a drawing (.svg, .pdf) or film of `render`")
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
