// A bar in a body of an STL surface: what both bear while the body is whole, and what the bar bears
// alone once it has torn.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "dem/observe.hpp"
#include "dem/world.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::dem {
namespace bar_in_surface_test {

/// A spindle of six sides along z: 2 `wide` across at its ends, `narrow` at its middle.  [m]
std::string spindle(double narrow, double wide, double height) {
  const auto ring = [&](int level, int k) {
    const double r = level == 1 ? narrow : wide, angle = pi / 3.0 * k;
    return Vec3{r * std::cos(angle), r * std::sin(angle), 0.5 * height * (level - 1)};
  };
  std::string text = "solid spindle\n";
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& v : {a, b, c})
      text += "vertex " + std::to_string(1000.0 * v.x) + " " + std::to_string(1000.0 * v.y) + " " +
              std::to_string(1000.0 * v.z) + "\n";
    text += "endloop\nendfacet\n";
  };
  for (int k = 0; k < 6; ++k) {
    for (int level = 0; level < 2; ++level) {
      add(ring(level, k), ring(level, k + 1), ring(level + 1, k + 1));
      add(ring(level, k), ring(level + 1, k + 1), ring(level + 1, k));
    }
    add({0.0, 0.0, -0.5 * height}, ring(0, k + 1), ring(0, k));
    add({0.0, 0.0, 0.5 * height}, ring(2, k), ring(2, k + 1));
  }
  return text + "endsolid spindle\n";
}

struct Pulled {
  double peak = 0.0, last = 0.0;  ///< force on the head  [N]
};

/// A spindle 0.12 m long, pulled apart by 0.3 mm, with a bar of 8 mm of soft steel along its axis
/// or without.
Pulled pull(bool reinforced) {
  const ScratchFolder folder;
  replace_file(folder / "spindle.stl", spindle(0.02, 0.028, 0.12));
  Config config = case_with_materials();
  config.materials[0].tensile_strength = 3e6;
  config.materials[1].yield = 100e6;  // at a strain of 0.05 %
  config.materials[1].hardening = 0.0;
  BodyConfig part = box_body("part", {}, 500, 0.56);
  part.shape = "stl";
  part.file = "spindle.stl";
  part.file_unit = 1e-3;
  BodyConfig bar = rebar_body("bar", "part", 0, 0);
  bar.rebar.diameter = 8e-3;
  bar.rebar.drawn.resize(1);
  bar.rebar.drawn[0].points = {{0.0, 0.0, -0.055}, {0.0, 0.0, 0.055}};
  config.bodies = {part};
  if (reinforced) config.bodies.push_back(bar);
  config.links.range = 1.443;
  config.local_damping = 0.3;
  config.supports = {
      {"foot", "", {-1.0, -1.0, -1.0}, {1.0, 1.0, -0.045}, {"all"}, {}, 0.0},
      {"head", "", {-1.0, -1.0, 0.045}, {1.0, 1.0, 1.0}, {"all"}, {0.0, 0.0, 0.1}, 5e-4}};
  World w = make_world(config, build_model(config, folder.path()), {});
  Pulled pulled;
  double mean = 0.0;
  int steps = 0;
  while (w.time < 3e-3) {
    step(w);
    double force = 0.0;
    for (Index e = 0; e < w.elements.size(); ++e)
      if (w.elements.state.data()[e].position.z > 0.045) force += w.elements.force.data()[e].z;
    pulled.peak = std::max(pulled.peak, -force);
    if (w.time > 2.5e-3) mean -= force, ++steps;
  }
  pulled.last = mean / steps;
  EXPECT_LT(balance(w).error_relative, 1e-3);
  return pulled;
}

TEST(BarInSurface, bears_its_yield_force_where_the_body_has_torn) {
  const Pulled bare = pull(false), reinforced = pull(true);
  const double steel = pi * 8e-3 * 8e-3 / 4.0 * 100e6;  // A_s f_y = 5.03 kN
  std::printf("bare: %.0f N, then %.0f; with a bar: %.0f N, then %.0f; A_s f_y %.0f N\n", bare.peak,
              bare.last, reinforced.peak, reinforced.last, steel);
  EXPECT_LT(bare.last, 0.02 * bare.peak);
  EXPECT_NEAR(reinforced.last, steel, 0.03 * steel);
  EXPECT_GT(reinforced.peak, bare.peak);
}

}  // namespace bar_in_surface_test
}  // namespace breccia::dem
