#include "app/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace breccia::app {
namespace {

struct Frame2 {
  double x_low, x_high, y_low, y_high;
};
Frame2 frame_of(const Curve& curve) {
  Frame2 f{0.0, 0.0, 0.0, 0.0};
  for (const auto& [x, y] : curve.points) {
    f.x_low = std::min(f.x_low, x);
    f.x_high = std::max(f.x_high, x);
    f.y_low = std::min(f.y_low, y);
    f.y_high = std::max(f.y_high, y);
  }
  if (f.x_high == f.x_low) f.x_high += 1.0;
  if (f.y_high == f.y_low) f.y_high += 1.0;
  return f;
}

std::string braille(unsigned dots) {
  const unsigned code = 0x2800U + dots;
  return {static_cast<char>(0xE0U | (code >> 12)), static_cast<char>(0x80U | ((code >> 6) & 0x3FU)),
          static_cast<char>(0x80U | (code & 0x3FU))};
}

}  // namespace

std::string curve_for_terminal(const Curve& curve) {
  constexpr int columns = 60, rows = 10, width = 2 * columns, height = 4 * rows;
  constexpr std::array<std::array<unsigned, 2>, 4> bit{{{1, 8}, {2, 16}, {4, 32}, {64, 128}}};
  std::vector<unsigned> cells(static_cast<std::size_t>(columns * rows), 0);
  const Frame2 f = frame_of(curve);
  const auto dot = [&](double x, double y) {
    const int i = static_cast<int>(std::lround((x - f.x_low) / (f.x_high - f.x_low) * (width - 1)));
    const int j =
        static_cast<int>(std::lround((f.y_high - y) / (f.y_high - f.y_low) * (height - 1)));
    cells[static_cast<std::size_t>(j / 4 * columns + i / 2)] |=
        bit[static_cast<std::size_t>(j % 4)][static_cast<std::size_t>(i % 2)];
  };
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    const auto [xa, ya] = curve.points[k - 1];
    const auto [xb, yb] = curve.points[k];
    constexpr int parts = 300;
    for (int p = 0; p <= parts; ++p) dot(xa + (xb - xa) * p / parts, ya + (yb - ya) * p / parts);
  }
  std::string text = fmt::format("  {}\n  {}\n", curve.title, curve.y_label);
  for (int row = 0; row < rows; ++row) {
    const std::string mark = row == 0          ? fmt::format("{:.3g}", f.y_high)
                             : row == rows - 1 ? fmt::format("{:.3g}", f.y_low)
                                               : "";
    text += fmt::format("  {:>8} |", mark);
    std::string line;
    for (int c = 0; c < columns; ++c)
      line += braille(cells[static_cast<std::size_t>(row * columns + c)]);
    text += line + "\n";
  }
  return text + fmt::format("           {:<8.3g}{:>52}\n", f.x_low,
                            fmt::format("{:.3g}  {}", f.x_high, curve.x_label));
}

std::string curve_as_svg(const Curve& curve) {
  constexpr double left = 60, top = 30, width = 400, height = 220;
  const Frame2 f = frame_of(curve);
  std::string path;
  for (const auto& [x, y] : curve.points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L",
                        left + (x - f.x_low) / (f.x_high - f.x_low) * width,
                        top + (f.y_high - y) / (f.y_high - f.y_low) * height);
  const auto words = [](double x, double y, const char* anchor, const std::string& text) {
    return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                       text);
  };
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 490 300\" "
             "font-family=\"sans-serif\" font-size=\"12\">\n"
             "<rect width=\"490\" height=\"300\" fill=\"white\"/>\n"
             "<path d=\"M{0} {1} V{2} H{3}\" fill=\"none\" stroke=\"#666\"/>\n"
             "<path d=\"{4}\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\"/>\n",
             left, top, top + height, left + width, path) +
         words(left, 18, "start", curve.title) +
         words(left - 6, top + 10, "end", fmt::format("{:.3g}", f.y_high)) +
         words(left - 6, top + height, "end", fmt::format("{:.3g}", f.y_low)) +
         words(left + 6, top + 10, "start", curve.y_label) +
         words(left, top + height + 16, "middle", fmt::format("{:.3g}", f.x_low)) +
         words(left + width, top + height + 16, "end", fmt::format("{:.3g}", f.x_high)) +
         words(left + width / 2, top + height + 34, "middle", curve.x_label) + "</svg>\n";
}

}  // namespace breccia::app
