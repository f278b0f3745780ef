// breccia render DIR: a picture of a frame of a result folder, a sheet of several, or a film of
// all.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "app/camera_path.hpp"
#include "app/commands.hpp"
#include "app/film.hpp"
#include "app/film_recipe.hpp"
#include "app/run_notes.hpp"
#include "app/shots.hpp"
#include "exec/error.hpp"
#include "io/emphasis.hpp"
#include "io/harmless.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/picture.hpp"
#include "io/picture/sides.hpp"
#include "io/picture/vector_picture.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

bool is_drawing(const std::string& file) {
  return file.ends_with(".svg") || file.ends_with(".pdf");
}

/// The ends of "0:2.5e6" or "0..2.5e6". @throws InputError for another text
ValueRange range_of(const std::string& text) {
  const auto number = [](std::string_view part, double& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  ValueRange range{};
  for (const std::string_view between : {":", ".."})
    if (const std::size_t at = text.find(between); at != std::string::npos) {
      const std::string_view whole = text;
      if (number(whole.substr(0, at), range.low) &&
          number(whole.substr(at + between.size()), range.high) && range.low < range.high)
        return range;
    }
  throw InputError("--range " + text +
                   ": two numbers in SI units, the lower first, such as 0:2.5e6");
}

/// Columns and rows of "3x2".
struct Sheet {
  int columns = 0, rows = 0;
};
std::optional<Sheet> sheet_of(const std::string& text) {
  Sheet sheet;
  const char* const end = text.data() + text.size();
  const auto [x, first] = std::from_chars(text.data(), end, sheet.columns);
  if (first != std::errc{} || x == end || *x != 'x') return {};
  const auto [last, second] = std::from_chars(x + 1, end, sheet.rows);
  const bool good = second == std::errc{} && last == end && sheet.columns >= 1 && sheet.rows >= 1 &&
                    sheet.columns * sheet.rows <= 100 && sheet.columns <= 100;
  return good ? std::optional(sheet) : std::nullopt;
}

struct RenderCommand {
  std::string folder, file, sheet, range, size, camera, fit = "run";
  std::optional<std::string> title;
  std::vector<std::string> hidden;
  std::vector<std::string> beside;
  std::optional<std::string> color;
  std::optional<int> frame;
  int rate = 10, dpi = 0;
  RenderOptions options;
  std::optional<CameraPath> path_of_camera = {};

  void execute() {
    const bool film = is_film(file), drawing = is_drawing(file);
    if (!file.empty() && !film && !drawing && !file.ends_with(".png"))
      throw InputError(file +
                       ": pictures are .png, drawings of plane cases .svg or .pdf, films .mp4, "
                       ".webm or .gif; end the name with one of these");
    if (drawing && (!sheet.empty() || !beside.empty()))
      throw InputError("--sheet and --panels make PNG pictures, no " + file);
    if (drawing && !camera.empty())
      throw InputError("--camera is for pictures and films; a drawing is seen from above: " + file);
    options.hidden = {hidden.begin(), hidden.end()};
    if (!range.empty()) options.range = range_of(range);
    if (options.log && options.range && options.range->low < 0.0)
      throw InputError("--range " + range + ": --log needs values above 0, such as 1:1000");
    if (!size.empty()) set_size();
    if (!camera.empty()) path_of_camera.emplace(camera);
    const bool turns = film && path_of_camera && path_of_camera->pictures() > 0;
    if (int(film && !turns) + int(!sheet.empty()) + int(frame.has_value()) > 1)
      throw InputError(
          "a film, a --sheet and a --frame: choose one of them (a film of one frame needs a "
          "--camera with turntable.pictures)");
    std::vector<Shots> shots{{folder, titled(folder), color, fit}};
    for (const std::string& other : beside) shots.emplace_back(other, titled(other), color, fit);
    const std::vector<int> numbers = numbers_of(static_cast<int>(shots.front().times.size()), film);
    if (numbers.size() > 1 || shots.size() > 1) share_range(shots, numbers);
    if (options.height == 0) share_height(shots, numbers.back());
    const std::string path = file.empty() ? folder + "/render.png" : file;
    if (film)
      write_film(path, shots, numbers);
    else if (drawing)
      write_drawing(path, shots, numbers.front());
    else
      write_picture(path, shots, numbers);
  }

  /// Width and height of "1600x1200", or a width alone.
  void set_size() {
    const char* const end = size.data() + size.size();
    const auto [x, first] = std::from_chars(size.data(), end, options.width);
    bool good = first == std::errc{};
    options.height = 0;
    if (good && x != end) {
      const auto [last, second] = std::from_chars(x + 1, end, options.height);
      good = *x == 'x' && second == std::errc{} && last == end && is_side(options.height);
    }
    if (!good || !is_side(options.width))
      throw InputError(fmt::format("--size {}: {} to {} pixels each, such as 1600x1200 or 1600",
                                   size, least_side, largest_side));
  }

  /// With the title that is asked for or, without one, the case's; panels say of which folder.
  RenderOptions titled(const std::string& of) const {
    RenderOptions with = options;
    with.title = title ? *title : beside.empty() ? run_title(of) : of + ": " + run_title(of);
    return with;
  }

  /// Pictures side by side are of one size.
  static void share_height(std::vector<Shots>& shots, int number) {
    const double time = shots.front().times.at(static_cast<std::size_t>(number));
    int height = 0;
    for (const Shots& s : shots)
      height = std::max(height, picture_height(s.frame(s.at_time(time)), s.options));
    for (Shots& s : shots) s.options.height = height;
  }

  static void warn_if_blank(const Image& image, const Shots& shots, int number) {
    if (image.model_pixels > 0) return;
    warn(fmt::format(
        "nothing of the model is in the picture of frame {} of {}: --fit frame shows where it is; "
        "--clip and --hide take away",
        number, shots.folder));
  }

  /// The frames of the first folder that are shown.
  std::vector<int> numbers_of(int count, bool film) const {
    if (frame && (*frame < 0 || *frame >= count))
      throw InputError(fmt::format("frame {} does not exist: {} holds {} frames, counted from 0",
                                   *frame, folder, count));
    std::vector<int> numbers;
    if (film && frame) {
      numbers.assign(static_cast<std::size_t>(path_of_camera->pictures()), *frame);
    } else if (film) {
      const int pictures =
          path_of_camera && path_of_camera->pictures() > 0 ? path_of_camera->pictures() : count;
      for (int i = 0; i < pictures; ++i)
        numbers.push_back(pictures == 1 ? count - 1
                                        : static_cast<int>(std::lround(double(i) * (count - 1) /
                                                                       (pictures - 1))));
    } else if (!sheet.empty()) {
      const Sheet places = *sheet_of(sheet);
      const int shown = std::min(places.columns * places.rows, count);
      for (int i = 0; i < shown; ++i)
        numbers.push_back(shown == 1 ? count - 1 : i * (count - 1) / (shown - 1));
    } else {
      numbers.push_back(frame.value_or(count - 1));
    }
    return numbers;
  }

  /// One range of values for all: colours of one picture are those of the next.
  static void share_range(std::vector<Shots>& shots, const std::vector<int>& numbers) {
    if (shots.front().options.range || shots.front().options.field.empty()) return;
    std::optional<ValueRange> range;
    for (const int number : numbers)
      for (const Shots& s : shots)
        s.widen(range, s.at_time(shots.front().times.at(std::size_t(number))));
    for (Shots& s : shots) s.options.range = range;
  }

  /// A frame of the first folder, and those of the same time beside it.
  /// @param share  of the film that is over
  Image panels(const std::vector<Shots>& shots, int number, double share) const {
    std::vector<Image> images;
    const double time = shots.front().times.at(static_cast<std::size_t>(number));
    for (const Shots& s : shots) {
      const int there = &s == &shots.front() ? number : s.at_time(time);
      images.push_back(s.picture(there, camera_path(), share));
      warn_if_blank(images.back(), s, there);
    }
    if (images.size() == 1) return images.front();
    return grid(images, static_cast<int>(images.size()));
  }

  static double share_at(std::size_t picture, std::size_t count) {
    return count > 1 ? double(picture) / double(count - 1) : 0.0;
  }

  void write_picture(const std::string& path, const std::vector<Shots>& shots,
                     const std::vector<int>& numbers) const {
    const std::vector<double>& times = shots.front().times;
    std::vector<Image> images;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      images.push_back(panels(shots, numbers[i], share_at(i, numbers.size())));
    Image image = images.size() == 1 ? images.front() : grid(images, sheet_of(sheet)->columns);
    image.dpi = dpi;
    write_png(path, with_notes(png_content(image), notes_for(shots, numbers)));
    if (numbers.size() == 1)
      fmt::print("{}  frame {} of {}, {}\n", harmless(path), numbers.front(), times.size(),
                 time_text(times.at(static_cast<std::size_t>(numbers.front()))));
    else
      fmt::print("{}  {} of {} frames\n", harmless(path), numbers.size(), times.size());
  }

  /// Of the run, of the moment, and of how to draw it again.
  std::vector<PngNote> notes_for(const std::vector<Shots>& shots,
                                 const std::vector<int>& numbers) const {
    std::vector<PngNote> notes = run_notes(folder);
    if (notes.empty()) return notes;
    if (shots.size() > 1) {
      notes.push_back({"Runs", ""});
      for (const Shots& s : shots) notes.back().text += run_line(s.folder) + "\n";
    }
    std::vector<RecipePart> parts;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      for (RecipePart& part : parts_of(shots, numbers[i], share_at(i, numbers.size())))
        parts.push_back(std::move(part));
    if (parts.size() != numbers.size() * shots.size()) return notes;
    if (parts.size() == 1) {
      for (PngNote& one : parts.front().notes) notes.push_back(std::move(one));
      return notes;
    }
    notes.push_back({"State hash", note(parts.back().notes, "State hash")});
    FilmRecipe recipe = begun_recipe(shots);
    recipe.columns *= numbers.size() == 1 ? 1 : sheet_of(sheet)->columns;
    recipe.pictures.push_back(std::move(parts));
    notes.push_back({"Pictures", text_of(recipe)});
    return notes;
  }

  /// Texts of all runs; panels stand beside each other.
  static FilmRecipe begun_recipe(const std::vector<Shots>& shots) {
    FilmRecipe recipe;
    recipe.columns = static_cast<int>(shots.size());
    for (const Shots& s : shots) recipe.runs.push_back(run_notes(s.folder));
    return recipe;
  }

  /// How to draw a frame of the first folder again, and those beside it; none if a step is not
  /// known.
  std::vector<RecipePart> parts_of(const std::vector<Shots>& shots, int number,
                                   double share) const {
    std::vector<RecipePart> parts;
    const double time = shots.front().times.at(static_cast<std::size_t>(number));
    for (const Shots& s : shots) {
      const int there = &s == &shots.front() ? number : s.at_time(time);
      const auto moment =
          moment_of_frame(s.folder, there, s.times.at(static_cast<std::size_t>(there)));
      if (!moment || run_notes(s.folder).empty()) return {};
      parts.push_back({static_cast<int>(&s - shots.data()),
                       notes_of_picture(*moment, options_of_picture(s, there, share))});
    }
    return parts;
  }

  /// With the extent that the picture shows.
  RenderOptions options_of_picture(const Shots& shots, int number, double share) const {
    RenderOptions with = shots.seen(number, camera_path(), share);
    if (with.extent) return with;
    const Frame shown = shots.frame(number);
    with.extent = bulk_extent(with.scale == 1.0 ? shown : displaced(shown, with.scale));
    return with;
  }
  const CameraPath* camera_path() const { return path_of_camera ? &*path_of_camera : nullptr; }

  void write_drawing(const std::string& path, const std::vector<Shots>& all, int number) const {
    const Shots& shots = all.front();
    const Frame shown = shots.frame(number);
    FilmRecipe recipe = begun_recipe(all);
    recipe.pictures.push_back(parts_of(all, number, 0.0));
    std::string about = run_line(folder);
    RenderOptions looks = shots.options;
    if (!recipe.pictures.front().empty()) {
      about += "\n" + comment_of(recipe);
      looks = options_of_picture(shots, number, 0.0);
    }
    replace_file(path, path.ends_with(".svg") ? svg_content(shown, looks, about)
                                              : pdf_content(shown, looks, about));
    fmt::print("{}  frame {} of {}, {}\n", harmless(path), number, shots.times.size(),
               time_text(shots.times.at(static_cast<std::size_t>(number))));
  }

  void write_film(const std::string& path, const std::vector<Shots>& shots,
                  const std::vector<int>& numbers) const {
    std::string lines = run_line(folder);
    for (const std::string& other : beside) lines += "\n" + run_line(other);
    Film film(path, rate, lines);
    FilmRecipe recipe = begun_recipe(shots);
    bool known = true;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double share = double(i) / double(numbers.size());  // a turn's last is not its first
      const Image image = panels(shots, numbers[i], share);
      film.add(image);
      recipe.pictures.push_back(parts_of(shots, numbers[i], share));
      recipe.pixels.push_back(digest_of_pixels(image));
      known = known && !recipe.pictures.back().empty();
    }
    film.close(known ? comment_of(recipe) : "");
    fmt::print("{}  {} frames, {:.1f} s\n", harmless(path), numbers.size(),
               static_cast<double>(numbers.size()) / rate);
  }
};

/// Options of what is drawn beside colours, and of the picture as a whole.
void add_looks(CLI::App& command, RenderCommand& render) {
  RenderOptions& options = render.options;
  options.height = 0;
  command
      .add_option("--fit", render.fit,
                  "the camera shows where bodies are at the start and as far as they go (run), in "
                  "each frame (frame), or at the start (first)")
      ->type_name("WHEN")
      ->check(CLI::IsMember({"run", "frame", "first"}))
      ->capture_default_str();
  command.add_flag("--links", options.show_links, "draw the links as well");
  command.add_flag("--xray", options.xray,
                   "fade what bars, cracks and broken links lie in, and draw these");
  command.add_flag("--forces", options.forces,
                   "forces of contacts without links as lines, as wide as they are large");
  command.add_option("--arrows", options.arrows, "vectors: velocity, displacement, force")
      ->type_name("FIELD");
  command.add_flag("--crosses", options.crosses,
                   "principal stresses in the plane of the picture: tension red, compression blue");
  command.add_option("--scale", options.scale, "draw displacements so many times")
      ->type_name("N")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  command.add_flag_callback(
      "--no-walls", [&options] { options.walls = false; },
      "leave out walls and marks on what is held");
  command.add_flag("--log", options.log, "colours by the logarithm of the field");
  command.add_flag("--edges", options.edges,
                   "draw the edges of triangles, or of faces of tetrahedra");
  command.add_flag("--no-legend", options.bare, "without title, legend, scale bar and axes");
  command.add_option("--dpi", render.dpi, "dots an inch, noted in the PNG for printers")
      ->type_name("N")
      ->check(CLI::Range(1, 10000));
  command.add_flag("--transparent", options.transparent, "no ground, for slides and posters");
  command.add_option("--title", render.title, "first line; default: that of the case")
      ->type_name("TEXT");
  command
      .add_option("--size", render.size,
                  "pixels, such as 1600x1200, or a width: then as high as the model needs; "
                  "default: 1280")
      ->type_name("WxH");
  command.add_option("--width", options.width, "of a picture, in pixels")->type_name("PIXELS");
  command.add_option("--height", options.height, "of a picture, in pixels; default: by the model")
      ->type_name("PIXELS");
}

}  // namespace

void add_render(CLI::App& program) {
  const auto render = std::make_shared<RenderCommand>();
  CLI::App* const command =
      program.add_subcommand("render", "draw a picture, a sheet of pictures or a film of a run");
  command->add_option("DIR", render->folder, "the result folder of the run");
  command
      ->add_option(
          "-o,--out", render->file,
          "a picture .png, a drawing of a plane case .svg or .pdf, or a film .mp4, .webm or .gif; "
          "default: DIR/render.png")
      ->type_name("FILE");
  command
      ->add_option("--color", render->color, "field that colours it; default: damage, or velocity")
      ->type_name("FIELD");
  command->add_option("--view", render->options.view, "camera: iso, x, y or z")
      ->type_name("VIEW")
      ->capture_default_str();
  command
      ->add_option("--camera", render->camera,
                   "a camera file: keys in time, a turntable (docs/pictures.md)")
      ->type_name("FILE.toml");
  command->add_option("--clip", render->options.clip, "cut away one side of a plane such as x=0")
      ->type_name("PLANE");
  command->add_option("--range", render->range, "values at the ends of the colours, in SI units")
      ->type_name("LOW:HIGH");
  command
      ->add_option("--map", render->options.map,
                   "colours: viridis, magma, diverging, damage, ground, gray")
      ->type_name("NAME");
  command->add_option("--hide", render->hidden, "bodies that are not drawn")->type_name("NAME ...");
  command->add_option("--frame", render->frame, "number of the frame; default: the last")
      ->type_name("N");
  command->add_option("--sheet", render->sheet, "pictures from start to end in columns x rows")
      ->type_name("CxR")
      ->check([](const std::string& text) {
        return sheet_of(text) ? "" : text + " is no sheet such as 3x2 (at most 100 pictures)";
      });
  command->add_option("--panels", render->beside, "other runs beside it, at the same times")
      ->type_name("DIR");
  command->add_option("--fps", render->rate, "pictures a second of a film")
      ->type_name("N")
      ->check(CLI::Range(1, 120))
      ->capture_default_str();
  add_looks(*command, *render);
  command->callback([render] {
    if (render->folder.empty()) {
      if (render->beside.empty()) throw CLI::RequiredError("DIR");
      render->folder = render->beside.front();
      render->beside.erase(render->beside.begin());
    }
    render->execute();
  });
}

}  // namespace breccia::app
