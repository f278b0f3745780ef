#include "io/picture/line_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/picture/font.hpp"
#include "io/round_numbers.hpp"

namespace breccia {
namespace {

constexpr int panel_width = 480, panel_height = 340;  // pixels
constexpr int left_rim = 68, right_rim = 16, top_rim = 34,
              bottom_rim = 48;             // pixels around the axes
constexpr int line_height = 15;            // of a legend  [pixels]
constexpr double narrowest = 240.0;        // axes beside a legend  [pixels]
constexpr std::size_t most_points = 1500;  // of a curve that are drawn
constexpr std::array colors{"#1f5fa8", "#c8502b", "#2f8f4e", "#7d4aa0",  // legible on white
                            "#b58a00", "#00838f", "#8a4b2a", "#5a5a5a"};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

/// The values that an axis shows.
struct Span {
  double low = 1e300, high = -1e300;

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
  ValueRange widened() const {
    if (high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))
      return {low - 0.03 * (high - low), high + 0.05 * (high - low)};
    const double half = low == 0.0 ? 1.0 : 0.1 * std::abs(low);
    return {low - half, low + half};
  }
};

/// Of the letters of a browser, from above: those that pictures have are among the widest. [pixels]
double width_of(const std::string& text) {
  constexpr double pixels_per_unit = 1.25;  // 12 pixels are the height of a line
  return pixels_per_unit * text_width(text, 1);
}

struct PlotBox {
  double left, top, right, bottom;  ///<  [pixels]
};

/// A straight piece of what is drawn, or a point.
struct PlotPiece {
  double x1, y1, x2, y2;  ///<  [pixels]

  bool meets(const PlotBox& box) const {
    double from = 0.0, to = 1.0;  // of the piece: what lies in the box
    const auto cut = [&](double start, double way, double low, double high) {
      if (way == 0.0) return start >= low && start <= high;
      const double a = (low - start) / way, b = (high - start) / way;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
      return from <= to;
    };
    return cut(x1, x2 - x1, box.left, box.right) && cut(y1, y2 - y1, box.top, box.bottom);
  }
};

/// The first of the boxes that cover the fewest pieces, and how many those are.
struct FreeBox {
  std::size_t box = 0;
  std::ptrdiff_t covers = 0;
};
FreeBox freest_box(const std::vector<PlotBox>& boxes, const std::vector<PlotPiece>& pieces) {
  FreeBox best;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const std::ptrdiff_t covers =
        std::count_if(pieces.begin(), pieces.end(),
                      [&box = boxes[k]](const PlotPiece& piece) { return piece.meets(box); });
    if (k == 0 || covers < best.covers) best = {k, covers};
  }
  return best;
}

/// One plot within the sheet; (x, y) is its upper left corner.
class Panel {
 public:
  Panel(const LinePlot& plot, int x, int y) : plot_(plot), x_(x), y_(y) {}

  std::string text() {
    std::string svg = title();
    if (!take_spans()) return svg + label(middle(), y_ + panel_height / 2, "no numbers", "middle");
    make_room();
    svg += axes();
    for (const PlotLevel& level : plot_.levels) svg += drawn(level);
    for (std::size_t s = 0; s < plot_.series.size(); ++s)
      svg += drawn(plot_.series[s], color_of(s));
    return svg + legend();
  }

 private:
  /// In two lines, and small letters, where it is wider than the plot.
  std::string title() const {
    constexpr double room = (panel_width - 12) / 1.1;  // letters are bold
    std::vector<std::string> lines{plot_.title};
    if (width_of(plot_.title) > room) {
      const std::size_t half = plot_.title.size() / 2;
      const std::size_t before = plot_.title.rfind(' ', half), after = plot_.title.find(' ', half);
      const bool is_nearer = before != std::string::npos &&
                             (after == std::string::npos || half - before <= after - half);
      const std::size_t cut = is_nearer ? before : after;
      if (cut != std::string::npos)
        lines = {plot_.title.substr(0, cut), plot_.title.substr(cut + 1)};
    }
    double widest = room;
    for (const std::string& line : lines) widest = std::max(widest, width_of(line));
    std::string svg;
    double y = y_ + (lines.size() > 1 ? 13 : 20);
    for (const std::string& line : lines) {
      std::string text = label(x_ + panel_width / 2, y, line, "middle", "title");
      if (widest > room)
        text.replace(0, 5, fmt::format("<text style=\"font-size:{:.1f}px\"", 12.0 * room / widest));
      svg += text;
      y += 14;
    }
    return svg;
  }
  double middle() const { return 0.5 * (left() + right()); }
  double left() const { return x_ + left_; }
  double right() const { return x_ + panel_width - right_; }

  bool take_spans() {
    Span x, y;
    for (const PlotSeries& series : plot_.series)
      for (std::size_t k = 0; k < series.x.size(); ++k) {
        if (!std::isfinite(series.x[k]) || !std::isfinite(series.y[k])) continue;
        const double error = error_at(series, k);
        x.add(series.x[k]);
        y.add(series.y[k] - error);
        y.add(series.y[k] + error);
      }
    if (x.empty()) return false;
    for (const PlotLevel& level : plot_.levels) y.add(level.y);
    if (y.low > 0.0 && y.low < 0.5 * y.high) y.low = 0.0;
    x_span_ = x.widened();
    y_span_ = y.widened();
    return true;
  }

  double place_x(double value) const {
    return left() + (right() - left()) * (value - x_span_.low) / (x_span_.high - x_span_.low);
  }
  double place_y(double value) const {
    const double height = panel_height - top_rim - bottom_rim;
    return y_ + top_rim + height * (y_span_.high - value) / (y_span_.high - y_span_.low);
  }

  /// Numbers lie between the axis and its label, the legend where no curve is: beside the axes if
  /// there is no such place within.
  void make_room() {
    constexpr double of_label = 22.0, gap = 6.0;  // pixels
    for (const Tick& tick : ticks_of(y_span_, std::pow(10.0, -power_of(y_span_))))
      left_ = std::max(left_, of_label + width_of(tick.text) + gap);
    double width = 0.0, height = 0.0;
    for (const PlotSeries& series : plot_.series) {
      if (series.name.empty()) continue;
      width = std::max(width, legend_text + width_of(series.name) + gap);
      height += line_height;
    }
    const double top = y_ + top_rim + 2.0, bottom = y_ + panel_height - bottom_rim - 2.0 - height;
    const double first = left() + 4.0, last = right() - width, centre = 0.5 * (first + last);
    std::vector<PlotBox> boxes;
    for (const auto& [x, y] : {std::pair(first, top),
                               {last, top},
                               {first, bottom},
                               {last, bottom},
                               {centre, top},
                               {centre, bottom}})
      boxes.push_back({x, y, x + width, y + height});
    const FreeBox best = freest_box(boxes, pieces());
    legend_ = boxes[best.box];
    if (best.covers == 0 || right() - width - left() < narrowest) return;
    right_ += width;
    legend_ = {right() + gap, top, right() + gap + width, top + height};
  }

  /// All that is drawn within the axes.
  std::vector<PlotPiece> pieces() const {
    std::vector<PlotPiece> all;
    for (const PlotLevel& level : plot_.levels)
      all.push_back({left(), place_y(level.y), right(), place_y(level.y)});
    for (const PlotSeries& series : plot_.series) {
      bool down = false;
      each_point(series, [&](std::size_t k, bool finite) {
        if (!finite) return void(down = false);
        const double x = place_x(series.x[k]), y = place_y(series.y[k]);
        PlotPiece piece{x, y, x, y};
        if (down && series.line) piece = {all.back().x2, all.back().y2, x, y};
        if (const double error = error_at(series, k); error > 0.0)
          all.push_back({x, place_y(series.y[k] - error), x, place_y(series.y[k] + error)});
        all.push_back(piece);
        down = true;
      });
    }
    return all;
  }

  static double error_at(const PlotSeries& series, std::size_t k) {
    return k < series.error.size() ? series.error[k] : 0.0;
  }
  /// Calls visit(number, whether it is finite) for the points that are drawn.
  template <class Visit>
  static void each_point(const PlotSeries& series, const Visit& visit) {
    const std::size_t count = std::min(series.x.size(), series.y.size());
    const std::size_t stride = series.marks ? 1 : count / most_points + 1;
    for (std::size_t k = 0; k < count; k += stride)
      visit(k, std::isfinite(series.x[k]) && std::isfinite(series.y[k]));
  }

  static std::string label(double x, double y, const std::string& text, const char* anchor,
                           const char* style = "text") {
    return fmt::format(
        "<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", style, x, y,
        anchor, escaped(text));
  }
  static std::string rule(double x1, double y1, double x2, double y2, const char* style) {
    return fmt::format(
        "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", style, x1,
        y1, x2, y2);
  }

  /// A label with the power of ten that its ticks leave out.
  static std::string with_power(const std::string& text, int power) {
    return power == 0 ? text : fmt::format("{}, times 1e{}", text, power);
  }
  static int power_of(const ValueRange& range) {
    const double largest = std::max(std::abs(range.low), std::abs(range.high));
    const int power = largest > 0.0 ? static_cast<int>(std::floor(std::log10(largest))) : 0;
    return power >= 4 || power < -2 ? 3 * static_cast<int>(std::floor(power / 3.0)) : 0;
  }

  std::string axes() const {
    const double x0 = left(), x1 = right();
    const double y0 = y_ + panel_height - bottom_rim, y1 = y_ + top_rim;
    std::string svg;
    const int power_y = power_of(y_span_), power_x = power_of(x_span_);
    for (const Tick& tick : ticks_of(y_span_, std::pow(10.0, -power_y))) {
      svg += rule(x0, place_y(tick.value), x1, place_y(tick.value), "grid");
      svg += label(x0 - 6, place_y(tick.value) + 4, tick.text, "end");
    }
    if (plot_.x_words.empty())
      for (const Tick& tick : ticks_of(x_span_, std::pow(10.0, -power_x))) {
        svg += rule(place_x(tick.value), y0, place_x(tick.value), y1, "grid");
        svg += label(place_x(tick.value), y0 + 16, tick.text, "middle");
      }
    for (std::size_t k = 0; k < plot_.x_words.size(); ++k)
      svg += label(place_x(static_cast<double>(k)), y0 + 16, plot_.x_words[k], "middle");
    svg += rule(x0, y0, x1, y0, "axis") + rule(x0, y0, x0, y1, "axis");
    const bool words = !plot_.x_words.empty();
    svg += label(middle(), y0 + 36, with_power(plot_.x_label, words ? 0 : power_x), "middle");
    svg += fmt::format(
        "<text class=\"text\" transform=\"translate({},{}) rotate(-90)\" "
        "text-anchor=\"middle\">{}</text>\n",
        x_ + 16, (y0 + y1) / 2.0, escaped(with_power(plot_.y_label, power_y)));
    return svg;
  }

  const char* color_of(std::size_t series) const {
    const int given = plot_.series[series].color;
    return colors[(given < 0 ? series : static_cast<std::size_t>(given)) % colors.size()];
  }

  /// The name of a level stands at an end of it, above or below, where it covers least.
  std::string drawn(const PlotLevel& level) const {
    const double y = place_y(level.y), width = width_of(level.name);
    std::vector<PlotBox> boxes;
    for (const double x : {right() - 2.0 - width, left() + 4.0})
      for (const double base : {y - 4.0, y + 13.0})
        boxes.push_back({x, base - 10.0, x + width, base + 3.0});
    const PlotBox& box = boxes[freest_box(boxes, pieces()).box];
    return rule(left(), y, right(), y, "level") +
           label(box.left, box.bottom - 3.0, level.name, "start");
  }

  std::string drawn(const PlotSeries& series, const char* color) const {
    std::string path, marks;
    bool down = false;
    each_point(series, [&](std::size_t k, bool finite) {
      if (!finite) return void(down = false);
      const double x = place_x(series.x[k]), y = place_y(series.y[k]);
      path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", x, y);
      down = true;
      if (series.marks)
        marks +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, color);
      if (const double error = error_at(series, k); error > 0.0)
        marks += fmt::format("<path class=\"curve\" stroke=\"{}\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n",
                             color, x, place_y(series.y[k] - error), place_y(series.y[k] + error));
    });
    if (!series.line) return marks;
    return fmt::format("<path class=\"curve\" stroke=\"{}\" d=\"{}\"/>\n", color, path) + marks;
  }

  std::string legend() const {
    std::string svg;
    double y = legend_.top + 12.0;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      if (plot_.series[s].name.empty()) continue;
      svg +=
          fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"3\" fill=\"{}\"/>\n",
                      legend_.left + 6.0, y - 5.0, color_of(s));
      svg += label(legend_.left + legend_text, y, plot_.series[s].name, "start");
      y += line_height;
    }
    if (svg.empty()) return svg;
    return fmt::format(
               "<rect class=\"veil\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
               "height=\"{:.1f}\"/>\n",
               legend_.left, legend_.top, legend_.right - legend_.left,
               legend_.bottom - legend_.top) +
           svg;
  }

  static constexpr double legend_text = 23.0;  // behind the mark of a curve  [pixels]
  const LinePlot& plot_;
  int x_, y_;
  double left_ = left_rim, right_ = right_rim;  // as wide as texts beside the axes ask for [pixels]
  PlotBox legend_{};
  ValueRange x_span_{0.0, 1.0}, y_span_{0.0, 1.0};
};

}  // namespace

std::string svg_of(const std::vector<LinePlot>& plots, int columns) {
  const int count = static_cast<int>(plots.size());
  const int across = std::clamp(columns, 1, std::max(count, 1));
  const int down = std::max((count + across - 1) / across, 1);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\">\n<style>text{{font:12px sans-serif;fill:#222}}.title{{font-weight:bold}}"
      ".grid{{stroke:#e4e4e4}}.axis{{stroke:#444}}.level{{stroke:#444;stroke-dasharray:6 4}}"
      ".curve{{fill:none;stroke-width:1.6}}.veil{{fill:white;fill-opacity:0.8}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      across * panel_width, down * panel_height);
  for (int k = 0; k < count; ++k)
    svg += Panel(plots[static_cast<std::size_t>(k)], k % across * panel_width,
                 k / across * panel_height)
               .text();
  return svg + "</svg>\n";
}

}  // namespace breccia
