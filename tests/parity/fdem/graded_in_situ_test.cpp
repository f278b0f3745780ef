// Stress in situ with a slope, and contacts that lose energy, have the same bits on threads, a
// device's schedule, ranks and resumed.

#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace in_situ_parity_test {

using namespace breccia::testing;
using fdem::testing::far;

/// Jointed ground, whose lower half bears less from a stage on, and a block that falls on it.
fdem::testing::Scene loaded(const char* joints) {
  fdem::testing::Scene s;
  for (int k = 0; k < 2; ++k) {
    fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
    m.joints = joints;
    m.joint.tension = 0.1e6;
    m.joint.cohesion = 0.4e6;
    m.joint.energy_open = m.joint.energy_slide = 1.0;
    m.friction = 0.4;
  }
  s.body("ground", prepare::crossed_rectangle({{0.0, -5.0}, {20.0, 10.0}}, 2.0));
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t)
    if (s.model.point[static_cast<std::size_t>(s.model.triangle[t][0])].y < -5.5)
      s.model.material[t] = 1;
  s.body("block", prepare::crossed_rectangle({{0.3, 0.501}, {1.0, 1.0}}, 1.0), 0, {1.0, -8.0});
  s.config.gravity = {0.0, -9.81};
  s.config.in_situ.yy_slope = {0.0, 2500.0 * 9.81};
  s.config.in_situ.xx_slope = {0.0, 0.6 * 2500.0 * 9.81};
  s.config.contact.restitution = 0.4;
  s.config.time.end = 1.0;
  s.support("foot", {-far, -far}, {far, -9.99}, {"x", "y"});
  fdem::StageConfig fall, soften;
  fall.name = "fall";
  fall.until = 1e-3;
  soften.name = "soften";
  soften.materials = {{"m1", 20e9, 0.25, -1.0, {}}};
  soften.until = 1e-3;
  s.config.stages = {fall, soften};
  return s;
}

TEST(GradedInSitu, is_alike_on_threads_schedule_and_ranks_and_resumed) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const fdem::testing::Scene s = loaded(joints);
    expect_alike(s);
    expect_resumed(s);
  }
}

}  // namespace in_situ_parity_test
}  // namespace breccia
