// breccia render DIR: a picture of a frame of a result folder.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/picture/picture.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"

namespace breccia::app {
namespace {

struct RenderCommand {
  std::string folder, file;
  std::optional<std::string> color;
  std::optional<int> frame;
  RenderOptions options;

  void execute() {
    if (!file.empty() && !file.ends_with(".png"))
      throw InputError(file + ": pictures are PNG files; end the name with .png");
    const int count = static_cast<int>(frame_times(folder).size());
    if (count == 0) throw InputError(folder + ": this folder holds no frames");
    const int number = frame.value_or(count - 1);
    const Frame shown = read_frame(folder, number);
    // The camera of the run's own pictures.
    options.extent = bulk_extent(number == 0 ? shown : read_frame(folder, 0));
    options.field = color ? *color : has_field(shown, "damage") ? "damage" : "";
    if (options.field == "damage") options.range = ValueRange{0.0, 1.0};
    const std::string path = file.empty() ? folder + "/render.png" : file;
    write_png(path, render(shown, options));
    fmt::print("{}  frame {} of {}, {}\n", path, number, count, time_text(shown.time));
  }
};

}  // namespace

void add_render(CLI::App& program) {
  const auto render = std::make_shared<RenderCommand>();
  CLI::App* const command = program.add_subcommand("render", "draw a picture of a run");
  command->add_option("DIR", render->folder, "the result folder of the run")->required();
  command->add_option("-o,--out", render->file, "the picture; default: DIR/render.png")
      ->type_name("FILE.png");
  command->add_option("--color", render->color, "field that colours it; default: damage")
      ->type_name("FIELD");
  command->add_option("--view", render->options.view, "camera: iso, x, y or z")
      ->type_name("VIEW")
      ->capture_default_str();
  command->add_option("--clip", render->options.clip, "cut away one side of a plane such as x=0")
      ->type_name("PLANE");
  command->add_option("--frame", render->frame, "number of the frame; default: the last")
      ->type_name("N");
  command->add_option("--width", render->options.width, "in pixels")
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_option("--height", render->options.height, "in pixels")
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_flag("--links", render->options.show_links, "draw the links as well");
  command->callback([render] { render->execute(); });
}

}  // namespace breccia::app
