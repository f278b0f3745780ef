#pragma once
// Line plots as SVG: curves and points of numbers, for pages and browsers.

#include <string>
#include <vector>

namespace breccia {

/// One curve, or one set of points.
struct PlotSeries {
  std::string name;           ///< in the legend; empty: none
  std::vector<double> x, y;   ///< of one length; what is not finite interrupts the curve
  std::vector<double> error;  ///< half the height of an error bar at each point; empty: none
  bool line = true, marks = false;
  int color = -1;  ///< number of a colour; below 0: the next one
};

/// A straight line over the whole plot, as of a target.
struct PlotLevel {
  std::string name;
  double y = 0.0;
};

struct LinePlot {
  std::string title, x_label, y_label;  ///< labels with their units, as "strain [-]"
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
  std::vector<std::string> x_words;  ///< instead of numbers below x = 0, 1, 2 ...
};

/// The plots side by side in rows of `columns`, as the text of an SVG file: the same text for the
/// same numbers on every machine. A plot without any finite number says so.
std::string svg_of(const std::vector<LinePlot>& plots, int columns = 1);

}  // namespace breccia
