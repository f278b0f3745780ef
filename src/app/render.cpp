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

#include "app/commands.hpp"
#include "app/film.hpp"
#include "app/run_notes.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/picture.hpp"
#include "io/picture/vector_picture.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

/// The frames of a run, and how pictures of them look: alike, so that they can be compared.
struct Shots {
  std::string folder;
  std::vector<double> times;  ///<  [s]
  RenderOptions options;

  Shots(std::string from, const RenderOptions& wanted, const std::optional<std::string>& color)
      : folder(std::move(from)), times(frame_times(folder)), options(wanted) {
    if (times.empty()) throw InputError(folder + ": this folder holds no frames");
    const Frame first = read_frame(folder, 0);
    options.extent = bulk_extent(first);  // the camera of the run's own pictures
    options.field = color ? *color : has_field(first, "damage") ? "damage" : "";
    if (options.field == "damage" && !options.range) options.range = ValueRange{0.0, 1.0};
  }
  Image picture(int number) const { return render(read_frame(folder, number), options); }
  /// The frame nearest to a time.
  int at_time(double time) const {
    const auto nearer = [time](double a, double b) {
      return std::abs(a - time) < std::abs(b - time);
    };
    return static_cast<int>(std::min_element(times.begin(), times.end(), nearer) - times.begin());
  }
  /// Widens a range to that of a frame's colours.
  void widen(std::optional<ValueRange>& range, int number) const {
    const auto bar = color_frame(read_frame(folder, number), options.field, {}).legend.bar;
    if (!bar) return;
    range = range ? ValueRange{std::min(range->low, bar->range.low),
                               std::max(range->high, bar->range.high)}
                  : bar->range;
  }
};

/// Images of one size in rows from the top; places that are left are white.
Image grid(const std::vector<Image>& images, int columns) {
  const auto count = static_cast<int>(images.size());
  const int rows = (count + columns - 1) / columns;
  const int width = images.front().width, height = images.front().height;
  Image whole{columns * width, rows * height, {}};
  const auto line = static_cast<std::ptrdiff_t>(3 * whole.width);
  whole.rgb.assign(static_cast<std::size_t>(line * whole.height), 255);
  for (int i = 0; i < count; ++i)
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* const from =
          &images[static_cast<std::size_t>(i)].rgb[static_cast<std::size_t>(3 * y * width)];
      std::copy_n(
          from, 3 * width,
          whole.rgb.begin() + line * ((i / columns) * height + y) + 3 * (i % columns) * width);
    }
  return whole;
}

bool is_drawing(const std::string& file) {
  return file.ends_with(".svg") || file.ends_with(".pdf");
}

/// The ends of "0:2.5e6". @throws InputError for another text
ValueRange range_of(const std::string& text) {
  ValueRange range{};
  const char* const end = text.data() + text.size();
  const auto [colon, first] = std::from_chars(text.data(), end, range.low);
  if (first == std::errc{} && colon != end && *colon == ':') {
    const auto [last, second] = std::from_chars(colon + 1, end, range.high);
    if (second == std::errc{} && last == end && range.low < range.high) return range;
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
  std::string folder, file, sheet, range;
  std::vector<std::string> hidden;
  std::vector<std::string> beside;
  std::optional<std::string> color;
  std::optional<int> frame;
  int rate = 10;
  RenderOptions options;

  void execute() {
    const bool film = is_film(file), drawing = is_drawing(file);
    if (!file.empty() && !film && !drawing && !file.ends_with(".png"))
      throw InputError(file +
                       ": pictures are .png, drawings of plane cases .svg or .pdf, films .mp4, "
                       ".webm or .gif; end the name with one of these");
    if (drawing && (!sheet.empty() || !beside.empty()))
      throw InputError("--sheet and --panels make PNG pictures, no " + file);
    options.hidden = {hidden.begin(), hidden.end()};
    if (!range.empty()) options.range = range_of(range);
    if (int(film) + int(!sheet.empty()) + int(frame.has_value()) > 1)
      throw InputError("a film, a --sheet and a --frame: choose one of them");
    std::vector<Shots> shots{{folder, options, color}};
    for (const std::string& other : beside) shots.emplace_back(other, options, color);
    const std::vector<int> numbers = numbers_of(static_cast<int>(shots.front().times.size()), film);
    if (numbers.size() > 1 || shots.size() > 1) share_range(shots, numbers);
    const std::string path = file.empty() ? folder + "/render.png" : file;
    if (film)
      write_film(path, shots, numbers);
    else if (drawing)
      write_drawing(path, shots.front(), numbers.front());
    else
      write_picture(path, shots, numbers);
  }

  /// The frames of the first folder that are shown.
  std::vector<int> numbers_of(int count, bool film) const {
    if (frame && (*frame < 0 || *frame >= count))
      throw InputError(fmt::format("frame {} does not exist: {} holds {} frames, counted from 0",
                                   *frame, folder, count));
    std::vector<int> numbers;
    if (film) {
      for (int i = 0; i < count; ++i) numbers.push_back(i);
    } else if (!sheet.empty()) {
      const Sheet size = *sheet_of(sheet);
      const int shown = std::min(size.columns * size.rows, count);
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
  static Image panels(const std::vector<Shots>& shots, int number) {
    if (shots.size() == 1) return shots.front().picture(number);
    std::vector<Image> images;
    const double time = shots.front().times.at(static_cast<std::size_t>(number));
    for (const Shots& s : shots) images.push_back(s.picture(s.at_time(time)));
    return grid(images, static_cast<int>(images.size()));
  }

  void write_picture(const std::string& path, const std::vector<Shots>& shots,
                     const std::vector<int>& numbers) const {
    const std::vector<double>& times = shots.front().times;
    std::vector<Image> images;
    for (const int number : numbers) images.push_back(panels(shots, number));
    const Image image =
        images.size() == 1 ? images.front() : grid(images, sheet_of(sheet)->columns);
    write_png(path, with_notes(png_content(image), notes_for(shots, numbers)));
    if (numbers.size() == 1)
      fmt::print("{}  frame {} of {}, {}\n", harmless(path), numbers.front(), times.size(),
                 time_text(times.at(static_cast<std::size_t>(numbers.front()))));
    else
      fmt::print("{}  {} of {} frames\n", harmless(path), numbers.size(), times.size());
  }

  /// Of the run and, for one frame of one run, of how to draw it again.
  std::vector<PngNote> notes_for(const std::vector<Shots>& shots,
                                 const std::vector<int>& numbers) const {
    std::vector<PngNote> notes = run_notes(folder);
    if (notes.empty() || shots.size() > 1 || numbers.size() > 1 || !sheet.empty()) return notes;
    const int number = numbers.front();
    const double time = shots.front().times.at(static_cast<std::size_t>(number));
    if (const auto moment = moment_of_frame(folder, number, time))
      for (PngNote& one : notes_of_picture(*moment, shots.front().options))
        notes.push_back(std::move(one));
    return notes;
  }

  static void write_drawing(const std::string& path, const Shots& shots, int number) {
    const Frame shown = read_frame(shots.folder, number);
    replace_file(path, path.ends_with(".svg") ? svg_content(shown, shots.options)
                                              : pdf_content(shown, shots.options));
    fmt::print("{}  frame {} of {}, {}\n", harmless(path), number, shots.times.size(),
               time_text(shots.times.at(static_cast<std::size_t>(number))));
  }

  void write_film(const std::string& path, const std::vector<Shots>& shots,
                  const std::vector<int>& numbers) const {
    Film film(path, rate, run_line(folder));
    for (const int number : numbers) film.add(panels(shots, number));
    film.close();
    fmt::print("{}  {} frames, {:.1f} s\n", harmless(path), numbers.size(),
               static_cast<double>(numbers.size()) / rate);
  }
};

}  // namespace

void add_render(CLI::App& program) {
  const auto render = std::make_shared<RenderCommand>();
  CLI::App* const command =
      program.add_subcommand("render", "draw a picture, a sheet of pictures or a film of a run");
  command->add_option("DIR", render->folder, "the result folder of the run")->required();
  command
      ->add_option(
          "-o,--out", render->file,
          "a picture .png, a drawing of a plane case .svg or .pdf, or a film\n.mp4, .webm or .gif; "
          "default: DIR/render.png")
      ->type_name("FILE");
  command->add_option("--color", render->color, "field that colours it; default: damage")
      ->type_name("FIELD");
  command->add_option("--view", render->options.view, "camera: iso, x, y or z")
      ->type_name("VIEW")
      ->capture_default_str();
  command->add_option("--clip", render->options.clip, "cut away one side of a plane such as x=0")
      ->type_name("PLANE");
  command->add_option("--range", render->range, "values at the ends of the colours, in SI units")
      ->type_name("LOW:HIGH");
  command->add_option("--map", render->options.map, "colours: viridis, diverging, damage, ground")
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
  command->add_option("--width", render->options.width, "of a picture, in pixels")
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_option("--height", render->options.height, "of a picture, in pixels")
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_flag("--links", render->options.show_links, "draw the links as well");
  command->callback([render] { render->execute(); });
}

}  // namespace breccia::app
