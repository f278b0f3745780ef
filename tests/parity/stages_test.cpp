// Stages of a case: what they change, when they end, what they book, and that threads, a device's
// schedule, ranks and a resumed run go through them alike.

#include "dem/setup/stages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>

#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/stage_control.hpp"

namespace breccia {
namespace stages_test {

/// A column of linked spheres between a wall below and a support above, beside a loose sphere that
/// rubs on the wall: it is held, then pulled, then falls onto the wall that rises.
dem::testing::Scene column() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.contact.friction = 0.6;
  for (int i = 0; i < 8; ++i) {
    s.sphere({0.0, 0.0, 0.0101 + 0.0201 * i}, 0.01);
    if (i > 0) s.link(i - 1, i);
  }
  s.sphere({0.05, 0.0, 0.00999}, 0.01, {3.0, 0.0, -0.1});
  s.config.gravity = {0.0, 0.0, -10.0};
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  dem::SupportConfig head;
  head.name = "head";
  head.min.z = 0.14;
  head.fix = {"all"};
  s.config.supports = {head};
  ProbeConfig top{"top", "head", "position_z", "mean"}, load{"load", "head", "force_z", "sum"};
  s.config.probes = {top, load};

  dem::StageConfig hold, pull, fall, end;
  hold.name = "hold";
  hold.until = 1e-4;
  pull.name = "pull";
  pull.local_damping = 0.2;
  pull.supports = {{"head", {"same"}, {0.0, 0.0, 0.05}, 5e-5, {}}};
  pull.when = "top > 0.150806";
  fall.name = "fall";
  fall.local_damping = 0.0;
  fall.friction = 0.1;
  fall.gravity = {1e3, 0.0, -2e4};
  fall.supports = {{"head", {}, {}, 0.0, {}}};
  OverTime<Vec3> rise;
  rise.times = {0.0, 1e-4, 2e-4};
  rise.values = {{}, {0.0, 0.0, 4.0}, {}};
  fall.walls = {{"wall", rise, {}}};
  fall.until = 3e-4;
  end.name = "end";
  end.gravity = {};
  end.until = 1e-4;
  s.config.stages = {hold, pull, fall, end};
  return s;
}

/// A strip of joined triangles that is pulled by a support, then let go under pressure and gravity.
fdem::testing::Scene strip() {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 0.01));
  s.support("left", {-far, -far}, {-0.0399, far}, {"x", "y"});
  s.support("right", {0.0399, -far}, {far, far}, {"x"});
  s.load("side", "pressure", {-far, 0.0099}, {far, far});
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 20;
  s.config.probes = {{"right", "right", "position_x", "mean"}};
  fdem::StageConfig pull, press, swing;
  pull.name = "pull";
  pull.supports = {{"right", {"same"}, {0.05, 0.0}, 2e-5, {}}};
  pull.when = "right > 0.040002";
  press.name = "press";
  press.local_damping = 0.1;
  press.supports = {{"right", {}, {}, 0.0, {}}};
  OverTime<double> pressure;
  pressure.times = {0.0, 3e-5};
  pressure.values = {0.0, 2e5};
  press.loads = {{"side", pressure, {}, {}, 0.0}};
  press.gravity = {1e4, -3e4};
  press.until = 6e-5;
  swing.name = "swing";
  swing.local_damping = 0.0;
  swing.loads = {{"side", {}, {}, {}, 0.0}};
  swing.supports = {{"right", {"y"}, {0.0, 0.2}, 1e-5, {}}, {"left", {}, {}, 0.0, {}}};
  swing.until = 5e-5;
  s.config.stages = {pull, press, swing};
  return s;
}

void run_to(Method& method, const CaseConfig& config, Communicator* ranks,
            std::int64_t steps = 1'000'000) {
  StageControl stages(method, config.probes, "", ranks);
  while (!stages.finished() && method.steps() < steps) {
    method.advance(stages.limited({1.0, std::min(steps, method.steps() + 37)}));
    stages.look();
  }
}

struct End {
  std::uint64_t hash = 0;
  std::vector<StageRecord> stages;
  std::int64_t steps = 0;
  double missing = 0.0;
};
template <class Scene>
End end_of(const Scene& s, Exec exec = {}, Communicator* ranks = nullptr) {
  const auto method = make_method(s.config, s.model, exec, ranks);
  run_to(*method, s.config, ranks);
  return {method->state_hash(), StageControl(*method, s.config.probes, "", ranks).records(),
          method->steps(), method->energy().error_relative};
}

template <class Scene>
void expect_alike(const Scene& s) {
  const End host = end_of(s);
  ASSERT_EQ(host.stages.size(), s.config.stages.size());
  EXPECT_LT(host.missing, 5e-3);
  Exec threads, shadow;
  threads.threads = 3;
  shadow.space = Space::shadow;
  for (const Exec& exec : {threads, shadow}) {
    const End other = end_of(s, exec);
    EXPECT_EQ(other.hash, host.hash);
    EXPECT_EQ(other.steps, host.steps);
  }
  for (const int count : {2, 3})
    simulate_ranks(count, 5, [&](Communicator& ranks) {
      const End other = end_of(s, {}, &ranks);
      if (ranks.rank() != 0) return;
      EXPECT_EQ(other.hash, host.hash) << count << " ranks";
      EXPECT_EQ(other.steps, host.steps);
      for (std::size_t k = 0; k < host.stages.size(); ++k) {
        EXPECT_EQ(other.stages[k].begin, host.stages[k].begin);
        EXPECT_EQ(other.stages[k].ended_by, host.stages[k].ended_by);
      }
    });
}

TEST(Stages, of_spheres_are_gone_through_alike_by_threads_schedule_and_ranks) {
  expect_alike(column());
}
TEST(Stages, of_triangles_are_gone_through_alike_by_threads_schedule_and_ranks) {
  expect_alike(strip());
}

/// Saved in each stage, and continued on other ranks.
template <class Scene>
void expect_resumed(const Scene& s) {
  const End whole = end_of(s);
  const std::string path =
      std::filesystem::temp_directory_path() / ("stages_" + std::to_string(::getpid()) + ".br");
  for (const StageRecord& stage : whole.stages) {
    const auto before = make_method(s.config, s.model, {}, nullptr);
    StageControl stages(*before, s.config.probes, "", nullptr);
    const double middle = 0.6 * stage.begin + 0.4 * stage.end;
    while (before->time() < middle) {
      before->advance(stages.limited({middle, 1'000'000}));
      stages.look();
    }
    CheckpointWriter writer;
    before->save(writer);
    writer.write(path);
    const auto after = make_method(s.config, s.model, {}, nullptr);
    const CheckpointReader reader(path);
    after->load(&reader);
    run_to(*after, s.config, nullptr);
    EXPECT_EQ(after->state_hash(), whole.hash) << stage.name;
    EXPECT_EQ(after->steps(), whole.steps) << stage.name;
    simulate_ranks(2, 5, [&](Communicator& ranks) {
      const auto on_ranks = make_method(s.config, s.model, {}, &ranks);
      on_ranks->load(ranks.rank() == 0 ? &reader : nullptr);
      run_to(*on_ranks, s.config, &ranks);
      const std::uint64_t hash = on_ranks->state_hash();
      if (ranks.rank() != 0) return;
      EXPECT_EQ(hash, whole.hash) << stage.name << " on two ranks";
    });
  }
  std::filesystem::remove(path);
}

TEST(Stages, of_spheres_go_on_from_a_checkpoint_in_any_of_them) {
  expect_resumed(column());
}
TEST(Stages, of_triangles_go_on_from_a_checkpoint_in_any_of_them) {
  expect_resumed(strip());
}

/// The ledger misses as a stage begins what it missed before, to rounding.
template <class Scene>
void expect_booked(const Scene& s) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  int changes = 0;
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, 1'000'000}));
    const EnergyBalance before = method->energy();
    const std::int32_t index = method->stage().index;
    stages.look();
    if (method->stage().index == index) continue;
    ++changes;
    const EnergyBalance after = method->energy();
    EXPECT_NEAR(after.missing(), before.missing(), 1e-12 * after.total()) << index;
  }
  EXPECT_EQ(changes, static_cast<int>(s.config.stages.size()) - 1);
}

TEST(Stages, of_spheres_move_no_energy_that_is_not_booked) {
  expect_booked(column());
}
TEST(Stages, of_triangles_move_no_energy_that_is_not_booked) {
  expect_booked(strip());
}

TEST(Stages, change_what_they_say_when_they_say) {
  const dem::testing::Scene s = column();
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  run_to(*method, s.config, nullptr);
  const std::vector<StageRecord> r = stages.records();
  ASSERT_EQ(r.size(), 4U);
  EXPECT_EQ(r[0].ended_by, "time");
  EXPECT_NEAR(r[0].end, 1e-4, 1e-6);
  EXPECT_EQ(r[1].ended_by, "probe");
  // 6 um at 0.05 m/s after half a ramp of 50 us, found at the next look
  EXPECT_GT(r[1].end - r[1].begin, 6e-6 / 0.05 + 2.5e-5 - 1e-6);
  EXPECT_LT(r[1].end - r[1].begin, 6e-6 / 0.05 + 2.5e-5 + 1e-4);
  EXPECT_NEAR(r[3].end - r[2].end, 1e-4, 1e-6);
}

TEST(Stages, end_at_rest_and_when_a_load_has_fallen) {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0).softening = 0.0;
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.local_damping = 0.7;
  for (int i = 0; i < 3; ++i) s.sphere({0.02 * i, 0.0, 0.0}, 0.01);
  s.link(0, 1);
  s.link(1, 2);
  dem::SupportConfig foot, head;
  foot.name = "foot";
  foot.max.x = 0.01;
  head.name = "head";
  head.min.x = 0.03;
  s.config.supports = {foot, head};
  s.config.probes = {{"load", "head", "force_x", "sum"}};
  dem::StageConfig stretch, pull;
  stretch.name = "stretch";
  stretch.gravity = {0.0, 0.0, -9.81};
  stretch.rest = 1e-6;
  pull.name = "pull";
  pull.supports = {{"head", {"same"}, {0.01, 0.0, 0.0}, 0.0, {}}};
  pull.drop = 0.5;
  pull.drop_of = "load";
  s.config.stages = {stretch, pull};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  while (!stages.finished() && method->time() < 0.1) {
    method->advance(stages.limited({1.0, 1'000'000}));
    stages.look();
  }
  const std::vector<StageRecord> r = stages.records();
  ASSERT_EQ(r.size(), 2U);
  EXPECT_EQ(r[0].ended_by, "rest");
  EXPECT_EQ(r[1].ended_by, "drop");
  EXPECT_LT(method->time(), 0.1);
}

/// An element that many links hold, itself held at first: those around it alone allow longer steps,
/// and the step is looked at rarely.
dem::testing::Scene hub() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0).tensile_strength = 1e9;
  s.config.materials[0].cohesion = 1e9;
  s.config.time = {.end = 1.0, .safety = 0.2};
  s.config.time.max_step = 1.0;
  s.config.time.evaluate_every = 1000;
  s.sphere({0.0, 0.0, 0.0}, 0.01);
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0}) {
        if (x == 0.0 && y == 0.0 && z == 0.0) continue;
        s.sphere({0.04 * x, 0.04 * y, 0.04 * z}, 0.01, {0.0, 0.01 * x, 0.02 * z + 0.01});
        s.link(0, s.model.size() - 1);
      }
  dem::SupportConfig hand;
  hand.name = "hand";
  hand.min = {-0.01, -0.01, -0.01};
  hand.max = {0.01, 0.01, 0.01};
  hand.fix = {"all"};
  s.config.supports = {hand};
  dem::StageConfig hold, go;
  hold.name = "hold";
  hold.until = 2e-5;
  go.name = "go";
  go.supports = {{"hand", {}, {}, 0.0, {}}};
  go.until = 1e-4;
  s.config.stages = {hold, go};
  return s;
}

TEST(Stages, elements_that_are_set_free_shorten_the_step_at_once) {
  const auto longest_steps = [](const dem::testing::Scene& s) {
    const auto method = make_method(s.config, s.model, {}, nullptr);
    StageControl stages(*method, s.config.probes, "", nullptr);
    std::array<double, 2> longest{};
    while (!stages.finished()) {
      const auto stage = static_cast<std::size_t>(method->stage().index);
      const Advanced taken = method->advance(stages.limited({1.0, 1'000'000}));
      longest[stage] = std::max(longest[stage], taken.dt_max);
      stages.look();
    }
    EXPECT_LT(method->energy().error_relative, 5e-3);
    return longest;
  };
  dem::testing::Scene s = hub();
  const std::array<double, 2> rarely = longest_steps(s);
  EXPECT_LT(rarely[1], 0.7 * rarely[0]);
  expect_alike(s);
  s.config.time.evaluate_every = 1;
  const std::array<double, 2> always = longest_steps(s);
  EXPECT_EQ(always[0], rarely[0]);
  EXPECT_NEAR(always[1], rarely[1], 0.05 * rarely[1]);
}

TEST(Stages, that_cannot_end_or_name_what_is_not_there_are_problems) {
  dem::Config config;
  config.probes = {{"load", "", "force_x", "sum"}};
  dem::StageConfig first, second, third;
  first.name = "a";
  second.name = "b";
  second.when = "lod > 3";
  second.supports = {{"grip", {"same"}, {}, 0.0, {}}};
  third.name = "b";
  third.drop = 0.5;
  config.stages = {first, second, third};
  const std::vector<std::string> said = dem::stage_problems(config);
  const auto tells = [&](const std::string& text) {
    return std::any_of(said.begin(), said.end(),
                       [&](const std::string& s) { return s.find(text) != std::string::npos; });
  };
  EXPECT_TRUE(tells("stage.a never ends"));
  EXPECT_TRUE(tells("stage.b.when: \"lod\" is not a probe; there are: load"));
  EXPECT_TRUE(tells("stage.b: there are two stages of this name"));
  EXPECT_TRUE(tells("stage.b.support.name = \"grip\" is no support; there are: none"));
  EXPECT_TRUE(tells("stage.b.drop_of = \"\" is not a probe, which drop needs"));
  EXPECT_EQ(said.size(), 5U);
}

}  // namespace stages_test
}  // namespace breccia
