// Where a prism of the library's concrete that is pulled by its ends is damaged: beside the grips
// with links by the radii alone, as walls of the packing order elements there; with sections that
// make up for it as much elsewhere.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "run/case_keys.hpp"
#include "specimen.hpp"

namespace breccia::dem {
namespace grips_test {

MaterialConfig library_concrete() {
  return read_case<Config>(CaseText{"breccia = 1\nmethod = \"dem3d\"\n[time]\nend = 1.0\n"
                                    "[material.c]\nuse = \"C30\"\n",
                                    "case.toml"},
                           {})
      .materials[0];
}

/// Just beyond the peak, mean damage of elements between 1.5 mean radii, which the grips hold, and
/// 4 from an end, over that of those in the middle.  [-]
double damaged_at_ends(const std::string& fabric, int seed) {
  testing::Specimen specimen(800);
  specimen.config.seed = seed;
  specimen.config.local_damping = 0.0;  // its links damp
  specimen.material() = library_concrete();
  specimen.material().fabric = fabric;
  const Model model = specimen.model();
  testing::LoadTest test(specimen, model, 0.2);
  test.run(0.98);
  const World& w = test.world();
  double mean = 0.0;
  for (const double r : model.radius) mean += r / static_cast<double>(model.size());
  const double end = 0.5 * specimen.size.z;
  double all[2] = {}, soft[2] = {};  // in the middle, near an end
  const std::vector<double> damaged = damage(w);
  for (std::size_t e = 0; e < damaged.size(); ++e) {
    const double z = std::abs(model.position[e].z);
    if (z > end - 1.5 * mean) continue;
    const int at_end = z > end - 4.0 * mean ? 1 : 0;
    all[at_end] += 1.0;
    soft[at_end] += damaged[e];
  }
  return (soft[1] / all[1]) / (soft[0] / all[0]);
}

TEST(Grips, rule_pulled_prisms_where_links_go_by_the_radii_alone) {
  double ratio[3] = {};
  const char* const fabrics[] = {"packed", "even", "faces"};
  for (int k = 0; k < 3; ++k) {
    std::printf("%-6s", fabrics[k]);
    for (int seed = 1; seed <= 4; ++seed) {
      const double one = damaged_at_ends(fabrics[k], seed);
      std::printf("  %.2f", one);
      ratio[k] += one / 4.0;
    }
    std::printf("  mean %.2f\n", ratio[k]);
  }
  EXPECT_GT(ratio[0], 1.0);
  EXPECT_LT(ratio[1], 1.0);
  EXPECT_LT(ratio[2], 1.0);
}

}  // namespace grips_test
}  // namespace breccia::dem
