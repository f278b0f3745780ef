// A cube between rough platens: the middle of its height is confined by friction, so that it bears
// more than a prism, but not much more.

#include <gtest/gtest.h>

#include <cstdio>

#include "confined_concrete.hpp"
#include "dem/observe.hpp"
#include "prepare/build.hpp"

namespace breccia::dem {
namespace confinement_test {

struct Pressed {
  double peak = 0.0;    ///< largest stress  [Pa]
  double strain = 0.0;  ///< there  [-]
  double last = 0.0;    ///< stress at the end  [Pa]
  double error = 0.0;   ///< of the ledger, relative  [-]
};

/// A packed block 0.1 m wide, pressed along z between rough walls at 2/s, from velocities of a
/// uniform strain.
class Press {
 public:
  Press(int count, double height, int seed, bool confined) : height_(height) {
    MaterialConfig m;
    m.name = "c";
    m.softening = 10.0;
    m.rolling_limit = 0.15;
    if (confined) breccia::testing::confine(m);
    config_.materials = {m};
    BodyConfig body;
    body.name = "block";
    body.material = "c";
    body.size = {width, width, height};
    body.pack = {.count = count, .size_ratio = 2.0, .compactness = 0.56};
    config_.bodies = {body};
    config_.links.range = 1.443;
    config_.local_damping = 0.3;
    config_.seed = seed;
    const Vec3 speed{0.0, 0.0, 0.5 * rate * height}, up{0.0, 0.0, 1.0};
    config_.walls = {{"bottom", -0.5 * height * up, up, speed, 1.0},
                     {"top", 0.5 * height * up, -1.0 * up, -1.0 * speed, 1.0}};
  }

  /// Stress over windows of strain, from the work of the walls.
  Pressed until(double strain) {
    Model model = build_model(config_, ".");
    for (std::size_t e = 0; e < model.position.size(); ++e)
      model.velocity[e].z = -rate * model.position[e].z;
    World w = make_world(config_, model, {});
    const double window = 1e-4;
    Pressed r;
    double work = 0.0, from = 0.0;
    while (from < strain) {
      while (rate * w.time < from + window) step(w);
      const EnergyBalance e = balance(w);
      const double now = rate * w.time;
      r.last = (e.work - work) / ((now - from) * height_ * width * width);
      if (r.last > r.peak) r.peak = r.last, r.strain = now;
      work = e.work, from = now;
      r.error = e.error_relative;
    }
    return r;
  }

 private:
  static constexpr double width = 0.1, rate = 2.0;
  double height_;
  Config config_;
};

/// Strengths of cubes of concrete C30 are 1.20 to 1.25 times those of cylinders 1 : 2 (EN 206). A
/// packing's strength varies by 5 % with its seed at 400 elements, the mean of three ratios by 4 %:
/// twice that is allowed.
TEST(Confinement, a_cube_between_rough_platens_has_a_peak_not_far_above_the_prisms) {
  double mean_ratio = 0.0;
  for (int seed = 1; seed <= 3; ++seed) {
    const Pressed cube = Press(400, 0.1, seed, true).until(6e-3);
    const Pressed prism = Press(800, 0.2, seed, true).until(6e-3);
    for (const Pressed& p : {cube, prism}) {
      EXPECT_LT(p.last, 0.5 * p.peak) << "no peak";
      EXPECT_LT(p.strain, 4e-3);
      EXPECT_LT(p.error, 1e-3);
    }
    const double ratio = cube.peak / prism.peak;
    std::printf("cube %.4g Pa at %.2g, prism %.4g Pa at %.2g, ratio %.3f\n", cube.peak, cube.strain,
                prism.peak, prism.strain, ratio);
    mean_ratio += ratio / 3.0;
  }
  EXPECT_GT(mean_ratio, 1.0);
  EXPECT_LT(mean_ratio, 1.25 * 1.08);
}

TEST(Confinement, a_cube_without_bounds_under_pressure_grows_stronger_for_ever) {
  const Pressed cube = Press(400, 0.1, 1, false).until(6e-3);
  EXPECT_EQ(cube.peak, cube.last);
  EXPECT_GT(cube.last, 2.0 * 37e6);  // twice what cubes of C30 bear
  EXPECT_LT(cube.error, 1e-3);
}

}  // namespace confinement_test
}  // namespace breccia::dem
