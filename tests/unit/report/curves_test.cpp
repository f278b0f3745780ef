// Probes of a run as curves.

#include "report/curves.hpp"

#include <gtest/gtest.h>

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

TEST(Curves, a_run_without_probes_has_none) {
  Record record;
  record.history.columns = {{"time", "s", {0.0}}, {"kinetic", "J", {0.0}}};
  EXPECT_EQ(curves_of(record), "");
}

}  // namespace curves_test
}  // namespace breccia::report
