// Energies that cracks have spent, by mode: a stage that changes the strength of joints leaves them
// as they were, on ranks, in snapshots and from a checkpoint, too.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "domain/simulated_ranks.hpp"
#include "physics/fdem/scene.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace stage_cracks_test {

struct Modes {
  double open = 0.0, slide = 0.0, sum = 0.0;

  explicit Modes(Method& method) : sum(method.energy().fracture) {
    for (const Fact& fact : method.facts()) {
      if (fact.path == "fracture.energy_by_mode.opening") open = fact.value;
      if (fact.path == "fracture.energy_by_mode.sliding") slide = fact.value;
    }
  }
};
void expect_sum(const Modes& modes, const char* when) {
  EXPECT_NEAR(modes.open + modes.slide, modes.sum, 1e-12 * modes.sum) << when;
}
void expect_same(const Modes& one, const Modes& other, const char* where) {
  EXPECT_EQ(one.open, other.open) << where;
  EXPECT_EQ(one.slide, other.slide) << where;
  EXPECT_EQ(one.sum, other.sum) << where;
}
void go_on(Method& method, int steps) {
  while (method.steps() < steps) method.advance({1.0, steps});
}
void begin_second_stage(Method& method) {
  StageProgress now = method.stage();
  now.index = 1;
  method.set_stage(now);
}

/// A block that is pressed until its joints open and slide.
fdem::testing::Scene block() {
  using fdem::testing::far;
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.damping = 0.5;
  m.friction = 0.5;
  m.joint.tension = 5e6;
  m.joint.cohesion = 15e6;
  m.joint.energy_open = 5.0;
  m.joint.energy_slide = 50.0;
  m.joint.friction_angle = 0.5;
  s.body("block", prepare::equilateral_rectangle({{0.0, 0.0}, {8e-3, 8e-3}}, 1e-3));
  s.support("top", {-far, 4e-3 - 1e-9}, {far, far}, {"y"}, {0.0, -4.0});
  s.support("bottom", {-far, -far}, {far, -4e-3 + 1e-9}, {"y"}, {0.0, 4.0});
  return s;
}
/// A second stage doubles the strengths of a scene whose joints soften.
fdem::testing::Scene staged(fdem::testing::Scene s) {
  s.config.time.end = 1.0;
  s.config.stages.resize(2);
  s.config.stages[0].name = "break";
  s.config.stages[0].until = 0.5;
  s.config.stages[1].name = "tougher";
  s.config.stages[1].until = 1.0;
  auto& change = s.config.stages[1].materials.emplace_back();
  change.name = s.config.materials[0].name;
  change.joint.tension = 2.0 * s.config.materials[0].joint.tension;
  change.joint.cohesion = 2.0 * s.config.materials[0].joint.cohesion;
  return s;
}

TEST(StageCracks, of_triangles_keep_the_modes_that_they_have_spent) {
  const fdem::testing::Scene s = staged(block());
  constexpr int steps = 700, end = 750;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  go_on(*method, steps);
  const Modes before(*method);
  EXPECT_NE(before.open, 0.0);
  EXPECT_GT(before.slide, 0.0);
  expect_sum(before, "before");
  begin_second_stage(*method);
  const Modes after(*method);
  expect_sum(after, "after");
  EXPECT_NEAR(after.open, before.open, 1e-9 * before.sum);
  EXPECT_NEAR(after.slide, before.slide, 1e-9 * before.sum);
  CheckpointWriter writer;
  method->save(writer);
  go_on(*method, end);
  const Modes last(*method);
  expect_sum(last, "at the end");

  const std::string path =
      std::filesystem::temp_directory_path() / ("modes_" + std::to_string(::getpid()) + ".br");
  writer.write(path);
  const CheckpointReader reader(path);
  const auto resumed = make_method(s.config, s.model, {}, nullptr);
  resumed->load(&reader);
  std::filesystem::remove(path);
  go_on(*resumed, end);
  expect_same(Modes(*resumed), last, "a checkpoint");

  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const auto part = make_method(s.config, s.model, {}, &ranks);
    go_on(*part, steps);
    begin_second_stage(*part);
    go_on(*part, end);
    const Modes of_all(*part);
    if (ranks.rank() == 0) expect_same(of_all, last, "3 ranks");
  });

  Exec shadow;
  shadow.space = Space::shadow;
  const auto device = make_method(s.config, s.model, shadow, nullptr);
  go_on(*device, steps);
  begin_second_stage(*device);
  const auto snapshot = device->snapshot();
  ASSERT_NE(snapshot, nullptr);
  expect_same(Modes(*snapshot), after, "a snapshot");
}

}  // namespace stage_cracks_test
}  // namespace breccia
