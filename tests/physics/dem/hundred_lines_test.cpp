// The page for teaching, docs/dem_in_100_lines.cpp, is a program whose physics holds.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "paths.hpp"

namespace breccia {
namespace hundred_lines_test {

/// All that the program prints.
std::string printed() {
  std::FILE* const pipe = popen(hundred_lines, "r");
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
    text.append(part.data(), size);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return text;
}

TEST(DemInHundredLines, breaks_links_and_keeps_energy_and_momentum) {
  const std::string text = printed();
  int spheres = 0, broken = 0, links = 0;
  double energy = 1.0, momentum = 1.0;
  const std::size_t end = text.find("spheres");
  ASSERT_NE(end, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + end,
                        "spheres %d, broken links %d of %d largest error of energy %lf, change of "
                        "momentum %lf",
                        &spheres, &broken, &links, &energy, &momentum),
            5)
      << text;
  EXPECT_EQ(spheres, 17 * 17 * 3 + 147);  // the plate; lattice points within 3.25 of the centre
  EXPECT_GT(broken, links / 10);
  EXPECT_LT(energy, 1e-3);  // second order in the step: 2e-4 at a tenth of the stable one
  EXPECT_LT(momentum, 1e-13);
}

}  // namespace hundred_lines_test
}  // namespace breccia
