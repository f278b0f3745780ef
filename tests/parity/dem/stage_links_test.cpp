// Links that a stage weakens, and faces that absorb: what follows, a ledger that books it, and the
// same bits on threads, a device's schedule, ranks and resumed.

#include "dem/setup/stages.hpp"
#include "parity/staged_runs.hpp"
#include "physics/dem/scene.hpp"

namespace breccia {
namespace stage_links_test {

using namespace breccia::testing;

/// A block of linked spheres, pulled apart slowly or struck; from a stage on its links bear a
/// quarter.
dem::testing::Scene weakened(const char* law) {
  dem::testing::Scene s;
  dem::MaterialConfig& m = s.material("m", law, 30e9, 0.2, 2400.0);
  m.tensile_strength = 4e6;
  m.cohesion = 12e6;
  const int n = 5, high = 12;
  for (int k = 0; k < high; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        s.sphere({0.02 * i, 0.02 * j, 0.02 * k}, 0.01 - 1e-5 * ((i + 2 * j + 3 * k) % 5));
  const auto at = [&](int i, int j, int k) { return (k * n + j) * n + i; };
  for (int k = 0; k < high; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto kind =
            std::string(law) == "parallel" ? dem::LinkKind::parallel : dem::LinkKind::concrete;
        if (i + 1 < n) s.link(at(i, j, k), at(i + 1, j, k), kind);
        if (j + 1 < n) s.link(at(i, j, k), at(i, j + 1, k), kind);
        if (k + 1 < high) s.link(at(i, j, k), at(i, j, k + 1), kind);
      }
  s.config.time.end = 1.0;
  s.config.local_damping = 0.2;
  s.config.time.safety = 0.2;  // the ledger of links that soften misses less the shorter steps are
  dem::SupportConfig foot, head, side;
  foot.name = "foot";
  foot.max.z = 0.01;
  head.name = "head";
  head.min.z = 0.02 * (high - 1.5);
  head.fix = {"z"};
  head.velocity = Vec3{0.0, 0.0, 0.02};
  side.name = "side";
  side.max.x = 0.01;
  side.min.z = 0.03;
  side.max.z = 0.19;
  side.absorb = "x";
  side.area = 0.01;
  s.config.supports = {foot, head, side};
  s.config.probes = {{"broken", "", "broken", "sum"}, {"pull", "head", "force_z", "sum"}};
  dem::StageConfig load, weak, loose;
  load.name = "load";
  load.until = 4e-4;
  weak.name = "weak";
  weak.until = 4e-4;
  weak.materials = {{"m", 1e6, 3e6, 0.3}};
  loose.name = "loose";
  loose.until = 2e-4;
  loose.supports = {{"side", {}, {}, 0.0, {}}};
  s.config.stages = {load, weak, loose};
  return s;
}

TEST(StageLinks, break_at_the_strength_of_their_stage) {
  for (const char* law : {"concrete", "parallel"}) {
    dem::testing::Scene s = weakened(law);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, s.config, nullptr);
    EXPECT_GT(method->probes()[0], 0.0) << law;
    EXPECT_LT(method->energy().error_relative, 1e-3) << law;
    for (dem::StageConfig& stage : s.config.stages) stage.materials.clear();
    const auto strong = make_method(s.config, s.model, {}, nullptr);
    run_to(*strong, s.config, nullptr);
    EXPECT_EQ(strong->probes()[0], 0.0) << law;
  }
}

TEST(StageLinks, are_alike_on_threads_schedule_and_ranks_and_resumed) {
  for (const char* law : {"concrete", "parallel"}) {
    const dem::testing::Scene s = weakened(law);
    expect_alike(s);
    expect_resumed(s);
  }
}

TEST(StageLinks, of_no_such_material_or_law_are_a_problem) {
  dem::testing::Scene s = weakened("concrete");
  s.config.stages[1].materials[0].name = "k";
  ASSERT_EQ(dem::stage_problems(s.config).size(), 1U);
  EXPECT_NE(dem::stage_problems(s.config)[0].find("stage.weak.material.name = \"k\""),
            std::string::npos);
  s.config.stages[1].materials[0].name = "m";
  s.config.materials[0].law = "grain";
  ASSERT_EQ(dem::stage_problems(s.config).size(), 1U);
  EXPECT_NE(dem::stage_problems(s.config)[0].find("stage.weak.material.m: its law is grain"),
            std::string::npos);
  s.config.materials[0].law = "concrete";
  s.config.supports[2].velocity = Vec3{1.0, 0.0, 0.0};
  EXPECT_NE(dem::stage_problems(s.config)[0].find("support.side.absorb: dashpots move nothing"),
            std::string::npos);
}

}  // namespace stage_links_test
}  // namespace breccia
