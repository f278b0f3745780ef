// Texts of line plots lie beside what is drawn.

#include "io/picture/line_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace breccia {
namespace line_plot_test {
namespace {

/// The number behind the last `before` in front of the first `text`.
double number_ahead(const std::string& svg, const std::string& text, const std::string& before) {
  const std::size_t at = svg.rfind(before, svg.find(text));
  EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_NE(at, std::string::npos) << text;
  return std::atof(svg.c_str() + at + before.size());
}
double left_of(const std::string& svg, const std::string& name) {
  return number_ahead(svg, ">" + name + "<", " x=\"");
}
double base_of(const std::string& svg, const std::string& name) {
  return number_ahead(svg, ">" + name + "<", " y=\"");
}
/// Where the upright axis is.
double axis(const std::string& svg) {
  const std::string style = "<line class=\"axis\" x1=\"";
  return std::atof(svg.c_str() + svg.find(style) + style.size());
}

PlotSeries curve(const std::string& name, double (*y)(double)) {
  PlotSeries series{name, {}, {}, {}};
  for (int k = 0; k <= 200; ++k) {
    series.x.push_back(0.005 * k);
    series.y.push_back(y(0.005 * k));
  }
  return series;
}

TEST(LinePlot, PutsItsLegendWhereNoCurveIs) {
  const auto peak = [](double x) { return x < 0.1 ? x : 0.01; };
  const std::string early = svg_of({{"", "x", "y", {curve("force", peak)}, {}, {}}});
  EXPECT_GT(left_of(early, "force"), 240.0);
  const auto ramp = [](double x) { return x; };
  const std::string rising = svg_of({{"", "x", "y", {curve("force", ramp)}, {}, {}}});
  EXPECT_LT(left_of(rising, "force"), 240.0);
  // Constant curves along both rims leave the middle of neither; the sheet's edges are no way out.
  const auto wave = [](double x) { return std::sin(400.0 * x); };
  const std::string full = svg_of({{"", "x", "y", {curve("force", wave)}, {}, {}}});
  EXPECT_GT(left_of(full, "force"), 400.0);
  EXPECT_LT(left_of(full, "force"), 460.0);
}

TEST(LinePlot, KeepsNumbersOfAnAxisOffItsLabel) {
  const auto narrow = [](double x) { return -392.4 + 0.26 * x; };
  const std::string svg = svg_of({{"", "x", "mean, deviation", {curve("", narrow)}, {}, {}}});
  // Seven letters of about 7 pixels beside a label that ends at 20.
  EXPECT_NE(svg.find(">-392.20<"), std::string::npos);
  EXPECT_GT(left_of(svg, "-392.20"), 20.0 + 42.0);
  EXPECT_LT(left_of(svg, "-392.20"), axis(svg));
  const auto usual = [](double x) { return x; };
  EXPECT_EQ(axis(svg_of({{"", "x", "y", {curve("", usual)}, {}, {}}})), 68.0);
}

TEST(LinePlot, NamesALevelWhereItCoversLeast) {
  const auto late = [](double x) { return x < 0.7 ? 0.0 : 1.05; };
  const std::string svg = svg_of({{"", "x", "y", {curve("", late)}, {{"mean", 1.0}}, {}}});
  EXPECT_GT(base_of(svg, "mean"), number_ahead(svg, ">mean<", "y2=\""));
}

TEST(LinePlot, BreaksATitleThatIsWiderThanThePlot) {
  const auto up = [](double x) { return x; };
  const auto titled = [&](const std::string& title) {
    return svg_of({{title, "x", "y", {curve("", up)}, {}, {}}});
  };
  EXPECT_NE(titled("A short title").find(">A short title<"), std::string::npos);
  const std::string svg =
      titled("Concrete ball on a reinforced concrete slab (Durand et al. 2012, section 5)");
  EXPECT_NE(svg.find(">Concrete ball on a reinforced concrete<"), std::string::npos) << svg;
  EXPECT_LT(base_of(svg, "slab (Durand et al. 2012, section 5)"), 34.0) << "above the plot";
  EXPECT_EQ(svg.find("font-size"), std::string::npos) << "letters as large as others";
  const std::string wide = titled(std::string(150, 'w'));
  EXPECT_LT(number_ahead(wide, ">www", "font-size:"), 6.0);
}

}  // namespace
}  // namespace line_plot_test
}  // namespace breccia
