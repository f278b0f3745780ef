// Probes of a run as curves.

#include "report/curves.hpp"

#include <gtest/gtest.h>

#include "core/probe_curve.hpp"

namespace breccia::report {
namespace curves_test {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Curves, stress_stands_over_strain_and_probes_of_a_unit_share_a_plot) {
  Record record;
  record.scene.title = "A prism";
  record.history.columns = {{"time", "s", {0.0, 1e-3, 2e-3}},
                            {"kinetic", "J", {0.0, 1.0, 2.0}},
                            {"axial_stress", "Pa", {0.0, -1e6, -5e5}},
                            {"axial_strain", "-", {0.0, -1e-4, -2e-4}},
                            {"top", "N", {0.0, 7.0, 9.0}},
                            {"side", "N", {0.0, 3.0, 4.0}}};
  for (const char* probe : {"axial_stress", "axial_strain", "top", "side"})
    record.numbers[std::string("probe.") + probe + ".last"] = 0.0;
  const std::string svg = curves_of(record);
  EXPECT_EQ(svg.find("<svg"), 0U) << svg.substr(0, 60);
  EXPECT_EQ(count_of(svg, "A prism"), 1U);
  EXPECT_EQ(count_of(svg, "axial_strain"), 2U) << svg;  // along the stress, and over time
  EXPECT_EQ(count_of(svg, "time [ms]"), 3U);
  EXPECT_EQ(count_of(svg, ">top<") + count_of(svg, ">side<"), 2U);
  EXPECT_EQ(svg.find("kinetic"), std::string::npos);
}

TEST(Curves, that_a_case_names_come_first) {
  Record record;
  record.history.columns = {{"time", "s", {0.0, 1e-3, 2e-3}},
                            {"way", "m", {0.0, -1e-4, -2e-4}},
                            {"press", "N", {0.0, -7e3, -9e3}}};
  for (const char* probe : {"way", "press"})
    record.numbers[std::string("probe.") + probe + ".last"] = 0.0;
  record.scene = scene_of("[output]\ncurves = [\"-press over -way\", \"press over other\"]\n");
  ASSERT_EQ(record.scene.curves.size(), 2U);
  const std::string svg = curves_of(record);
  const std::size_t x = svg.find("-way ["), y = svg.find("-press [N]");
  ASSERT_NE(x, std::string::npos) << svg;
  ASSERT_NE(y, std::string::npos) << svg;
  EXPECT_LT(x, svg.find("time [ms]"));
  EXPECT_EQ(count_of(svg, "time [ms]"), 2U);
}

TEST(Curves, are_named_by_two_probes) {
  const auto curve = ProbeCurve::parsed("-load cell over  mid way ");
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->y.probe, "load cell");
  EXPECT_EQ(curve->y.sign, -1.0);
  EXPECT_EQ(curve->x.probe, "mid way");
  EXPECT_EQ(curve->x.sign, 1.0);
  for (const char* text : {"load", "load over", " over way", "a over b over c"})
    EXPECT_FALSE(ProbeCurve::parsed(text)) << text;
}

TEST(Curves, a_run_without_probes_has_none) {
  Record record;
  record.history.columns = {{"time", "s", {0.0}}, {"kinetic", "J", {0.0}}};
  EXPECT_EQ(curves_of(record), "");
}

}  // namespace curves_test
}  // namespace breccia::report
