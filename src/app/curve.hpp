#pragma once
// A small plot of a law: dots of Braille on a terminal, or SVG.

#include <string>
#include <utility>
#include <vector>

namespace breccia::app {

struct Curve {
  std::string title, x_label, y_label;              ///< labels with their units
  std::vector<std::pair<double, double>> points{};  ///< in those units
};

/// 12 lines of at most 80 columns. Each letter holds 2 x 4 dots (Unicode, Braille patterns).
std::string curve_for_terminal(const Curve& curve);
std::string curve_as_svg(const Curve& curve);

}  // namespace breccia::app
