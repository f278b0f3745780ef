#include "io/picture/annotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/picture/font.hpp"

namespace breccia {
namespace {

constexpr Color ink{0.13F, 0.14F, 0.16F}, faint{0.42F, 0.43F, 0.46F};
constexpr int bar_width = 12;  ///< of a legend's bar  [dots]
constexpr int border = 12;     ///< around everything  [dots]

/// Text of this program, which is plain ASCII for terminals, with the sign of micro.
std::string typeset(std::string text) {
  for (const std::string_view before : {" ", "["})
    for (const std::string_view unit : {"us", "um", "uN", "uPa", "uJ", "uW", "uHz"}) {
      const std::string plain = std::string(before) + std::string(unit);
      for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at))
        text.replace(at + 1, 1, "\u00b5");
    }
  return text;
}

/// As much of a text as fits, with dots where it ends early.
std::string shortened(std::string text, int width, int scale) {
  if (text_width(text, scale) <= width) return text;
  const auto amid_letter = [](char byte) { return (byte & 0xC0) == 0x80; };  // of UTF-8
  while (!text.empty() && (text.back() == ' ' || text_width(text + "...", scale) > width)) {
    while (text.size() > 1 && amid_letter(text.back())) text.pop_back();
    text.pop_back();
  }
  return text.empty() ? text : text + "...";
}

/// Width of the legend with its margins; 0 if there is nothing to explain.  [pixels]
int legend_width(const Legend& legend, int scale) {
  int width = text_width(typeset(legend.title), scale);
  if (legend.bar) {
    for (const Tick& tick : legend.bar->ticks) {
      width = std::max(width, (bar_width + 5) * scale + text_width(tick.text, scale));
    }
    width = std::max(width, text_width(legend.bar->note, scale));
  }
  for (const Legend::Swatch& swatch : legend.swatches) {
    width = std::max(width, (bar_width + 5) * scale + text_width(swatch.name, scale));
  }
  for (const std::string& note : legend.notes)
    width = std::max(width, text_width(typeset(note), scale));
  return width == 0 ? 0 : width + 2 * border * scale;
}

constexpr int axes_room = 62;  ///< below the legend  [dots]
constexpr double least_bar = 0.2, usual_bar = 0.4, above_legend = 1.0 / 7.0;  ///< of the height

/// Height of the lines of a legend that has a bar, or none.  [pixels]
double lines_height(const Legend& legend, int scale) {
  const double lines = static_cast<double>(legend.swatches.size() + legend.notes.size()) +
                       (legend.title.empty() ? 0.0 : 1.0) + (legend.bar ? 1.5 : 0.0) +
                       (legend.bar && !legend.bar->note.empty() ? 1.0 : 0.0);
  return lines * (font_height + 4) * scale;
}

/// Shorter where lines and axes would not fit.
int bar_length(const Paper& paper, const Legend& legend, int scale) {
  const double height = paper.height;
  const double left =
      (1.0 - above_legend) * height - lines_height(legend, scale) - axes_room * scale;
  return static_cast<int>(std::clamp(left, least_bar * height, usual_bar * height));
}

/// Height of the legend without margins.  [pixels]
int legend_height(const Paper& paper, const Legend& legend, int scale) {
  const int line = (font_height + 4) * scale;
  int lines = static_cast<int>(legend.swatches.size() + legend.notes.size()) +
              (legend.title.empty() ? 0 : 1);
  if (!legend.bar) return lines * line;
  if (!legend.bar->note.empty()) ++lines;
  return (lines + 1) * line + 4 * scale + bar_length(paper, legend, scale);
}

/// The bar with frame, ticks and numbers; (left, top) is its upper corner.
void draw_bar(Paper& paper, const Legend::Bar& bar, int left, int top, int length, int scale) {
  const int right = left + bar_width * scale;
  paper.fill(left - 1, top - 1, right + 1, top + length + 1, faint);
  for (int y = 0; y < length; ++y) {
    const float share = 1.0F - (static_cast<float>(y) + 0.5F) / static_cast<float>(length);
    paper.fill(left, top + y, right, top + y + 1, map_color(bar.map, share));
  }
  const double width = bar.range.high - bar.range.low;
  // In a short bar every second number, or fewer, so that they do not touch.
  const std::size_t count = bar.ticks.size();
  const double apart = count > 1 ? (bar.ticks[1].value - bar.ticks[0].value) / width * length : 1e9;
  std::size_t every = 1;
  while (every < count && static_cast<double>(every) * apart < font_height * scale) ++every;
  for (std::size_t k = 0; k < count; k += every) {
    const Tick& tick = bar.ticks[k];
    const double share = width > 0.0 ? (tick.value - bar.range.low) / width : 0.0;
    const int y = top + static_cast<int>((1.0 - share) * (length - 1) + 0.5);
    paper.fill(right + 1, y - scale / 2, right + 3 * scale, y - scale / 2 + scale, ink);
    paper.write(right + 5 * scale, y - 7 * scale / 2, tick.text, scale, ink);
  }
}

}  // namespace

int text_scale(const RenderOptions& options) {
  const int fitting = std::min(options.height / 170, options.width / 520);
  constexpr std::array scales{12, 6, 4, 3, 2, 1};
  for (const int scale : scales) {
    if (scale <= fitting) return scale;
  }
  return 1;
}

int fitted_height(const RenderOptions& options, const Legend& legend, double aspect) {
  constexpr double lowest = 0.28, highest = 0.75;  // of the width
  RenderOptions tall = options;
  tall.height = static_cast<int>(highest * options.width);
  const int scale = text_scale(tall);
  const Window window = scene_window(tall, legend);
  const double beside = tall.height - (window.bottom - window.top);
  const double wanted = beside + aspect * (window.right - window.left);
  const double of_legend = (lines_height(legend, scale) + axes_room * scale) /
                           (1.0 - above_legend - (legend.bar ? least_bar : 0.0));
  if (options.bare) return std::max(16, static_cast<int>(std::min<double>(wanted, tall.height)));
  const double height = std::max({wanted, of_legend, lowest * options.width});
  return std::max(16, static_cast<int>(std::min<double>(height, tall.height)));
}

Window scene_window(const RenderOptions& options, const Legend& legend) {
  const int scale = text_scale(options);
  const double edge = border * scale;
  if (options.bare)
    return {0.25 * edge, 0.25 * edge, options.width - 0.25 * edge, options.height - 0.25 * edge};
  const double right = options.width - legend_width(legend, scale);
  const double bottom = options.height - edge - 2.0 * font_height * scale;
  const Window window{edge, edge + 2.0 * font_height * scale,
                      right < options.width ? right : options.width - edge, bottom};
  const bool too_small = window.right - window.left < 0.25 * options.width ||
                         window.bottom - window.top < 0.25 * options.height;
  if (too_small) return {0.0, 0.0, 1.0 * options.width, 1.0 * options.height};
  return window;
}

void draw_title(Paper& paper, const std::string& title, const Frame& frame, int scale) {
  const int left = border * scale, top = border * scale, gap = 12 * scale,
            right = paper.width - left;
  const std::string time = typeset("t = " + time_text(frame.time)),
                    step = fmt::format("step {}", frame.step);
  const int of_time = text_width(time, scale);
  const std::string shown = shortened(title, right - of_time - gap - left, scale);
  const int time_at = shown.empty() ? left : left + text_width(shown, scale) + gap;
  const int step_at = time_at + of_time + gap;
  const int end = step_at + text_width(step, scale);
  paper.veil(left, top, end <= right ? end : step_at - gap, top + font_height * scale, scale);
  paper.write(left, top, shown, scale, ink);
  paper.write(time_at, top, time, scale, ink);
  if (end <= right) paper.write(step_at, top, step, scale, faint);
}

void draw_legend(Paper& paper, const Legend& legend, int scale) {
  const int left = paper.width - legend_width(legend, scale) + border * scale;
  const int line = (font_height + 4) * scale;
  int y = static_cast<int>(above_legend * paper.height);
  const int height = legend_height(paper, legend, scale);
  if (height > 0) paper.veil(left, y, paper.width - border * scale, y + height, scale);
  if (!legend.title.empty()) {
    paper.write(left, y, typeset(legend.title), scale, ink);
    y += line;
  }
  if (legend.bar) {
    if (!legend.bar->note.empty()) {
      paper.write(left, y, legend.bar->note, scale, faint);
      y += line;
    }
    y += 4 * scale;
    const int length = bar_length(paper, legend, scale);
    draw_bar(paper, *legend.bar, left, y, length, scale);
    y += length + line;
  }
  for (const Legend::Swatch& swatch : legend.swatches) {
    const int size = 8 * scale;
    paper.fill(left - 1, y - 1, left + bar_width * scale + 1, y + size + 1, faint);
    paper.fill(left, y, left + bar_width * scale, y + size, swatch.color);
    paper.write(left + (bar_width + 5) * scale, y + scale / 2, swatch.name, scale, ink);
    y += line;
  }
  for (const std::string& note : legend.notes) {
    paper.write(left, y, typeset(note), scale, faint);
    y += line;
  }
}

void draw_scale_bar(Paper& paper, double resolution, int scale) {
  const double length = round_step_below(0.22 * paper.width / resolution);
  const int left = border * scale, bottom = paper.height - border * scale;
  const int right = left + static_cast<int>(length * resolution + 0.5);
  // No higher than the number: marks on the lower border of bodies end just above it.
  paper.veil(left, bottom - (font_height + 1) * scale, right, bottom, scale);
  paper.fill(left, bottom - scale, right, bottom, ink);
  paper.fill(left, bottom - 4 * scale, left + scale, bottom, ink);
  paper.fill(right - scale, bottom - 4 * scale, right, bottom, ink);
  const std::string text = typeset(length_text(length));
  paper.write((left + right - text_width(text, scale)) / 2, bottom - (font_height + 5) * scale,
              text, scale, ink);
}

void draw_axes(Paper& paper, const Axes& axes, int scale) {
  struct Arrow {
    const char* name;
    Color color;
    Vec3 direction;
  };
  std::array arrows{Arrow{"x", {0.78F, 0.20F, 0.18F}, {1, 0, 0}},
                    Arrow{"y", {0.20F, 0.55F, 0.24F}, {0, 1, 0}},
                    Arrow{"z", {0.17F, 0.35F, 0.75F}, {0, 0, 1}}};
  std::stable_sort(arrows.begin(), arrows.end(), [&axes](const Arrow& a, const Arrow& b) {
    return dot(a.direction, axes.toward) < dot(b.direction, axes.toward);
  });
  const double length = 22.0 * scale;
  const double u = paper.width - border * scale - 1.6 * length;
  const double v = paper.height - border * scale - 0.9 * length;
  const auto each_arrow = [&](const auto& draw) {
    for (const Arrow& arrow : arrows) {
      const double du = length * dot(arrow.direction, axes.right);
      const double dv = -length * dot(arrow.direction, axes.up);
      if (du * du + dv * dv < 4.0 * scale * scale) continue;  // it points at the viewer
      const double far = 1.0 + 6.0 * scale / std::sqrt(du * du + dv * dv);
      draw(arrow, du, dv, far);
    }
  };
  each_arrow([&](const Arrow&, double du, double dv, double far) {  // light ground
    paper.stroke(u, v, u + far * du, v + far * dv, 11.0 * scale, {1.0F, 1.0F, 1.0F});
  });
  each_arrow([&](const Arrow& arrow, double du, double dv, double far) {
    paper.stroke(u, v, u + du, v + dv, 1.5 * scale, arrow.color);
    paper.write(static_cast<int>(u + far * du - 2.5 * scale),
                static_cast<int>(v + far * dv - 4.5 * scale), arrow.name, scale, arrow.color);
  });
}

}  // namespace breccia
