// Fluid that follows cracks: threads, a device's schedule, ranks and resumed runs agree, and the
// ledger books its work.

#include <algorithm>
#include <map>

#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace fluid_test {

using namespace breccia::testing;

/// A block with an open crack of 40 mm in its middle, from one end of which fluid comes.
fdem::testing::Scene flooded(const char* joints, double speed) {
  fdem::testing::Scene s;
  fdem::MaterialConfig& rock = s.material(30e9, 0.2, 2500.0);
  rock.joints = joints;
  rock.joint.tension = 4e6;
  rock.joint.cohesion = 20e6;
  rock.joint.energy_open = 20.0;
  rock.friction = 0.5;
  s.body("rock", prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.06}}, 0.01));
  std::vector<std::pair<double, Index>> line;
  for (std::size_t i = 0; i < s.model.point.size(); ++i) {
    const Vec2& x = s.model.point[i];
    if (std::abs(x.y) < 1e-9 && std::abs(x.x) < 0.0201)
      if (std::abs(std::remainder(x.x, 0.01)) < 1e-9) line.emplace_back(x.x, static_cast<Index>(i));
  }
  std::sort(line.begin(), line.end());
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    s.model.discontinuities.push_back({{line[i].second, line[i + 1].second}, -1});
  fdem::LoadConfig& water = s.load("water", "fluid", {-0.021, -0.001}, {-0.019, 0.001});
  water.pressure.times = {0.0, 1e-5, 1e-4};
  water.pressure.values = {0.0, 40e6, 10e6};
  water.speed = speed;
  s.config.time.end = 1.0;
  s.config.time.max_step = 5e-8;
  fdem::StageConfig fill, more;
  fill.name = "fill";
  fill.until = 2e-5;
  more.name = "more";
  more.until = 1e-5;
  more.loads = {{"water", 20e6, {}, {}, 0.0}};
  s.config.stages = {fill, more};
  return s;
}

TEST(Fluid, in_cracks_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(flooded("intrinsic", 800.0));
  expect_alike(flooded("extrinsic", 0.0));
}
TEST(Fluid, in_cracks_is_resumed) {
  expect_resumed(flooded("intrinsic", 800.0));
}
/// A block with a square hole in its middle, which an explosive breaks.
fdem::testing::Scene blasted() {
  fdem::testing::Scene s;
  fdem::MaterialConfig& rock = s.material(30e9, 0.2, 2500.0);
  rock.joints = "intrinsic";
  rock.joint.tension = 4e6;
  rock.joint.cohesion = 20e6;
  rock.joint.energy_open = 20.0;
  rock.friction = 0.5;
  const prepare::Mesh whole = prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.06}}, 0.01);
  prepare::Mesh pierced;
  std::map<Index, Index> number;
  for (const prepare::Triangle& t : whole.triangle) {
    const Vec2 middle = prepare::centroid(whole.point, t);
    if (std::abs(middle.x) < 0.01 && std::abs(middle.y) < 0.01) continue;
    prepare::Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = number.emplace(t[k], static_cast<Index>(pierced.point.size()));
      if (is_new) pierced.point.push_back(prepare::at(whole.point, t[k]));
      corners[k] = found->second;
    }
    pierced.triangle.push_back(corners);
  }
  s.body("rock", pierced);
  fdem::LoadConfig& anfo = s.load("anfo", "fluid", {-0.011, -0.011}, {0.011, 0.011});
  anfo.explosive = {49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9, 8e-6};
  s.config.time.end = 1.0;
  s.config.time.max_step = 5e-8;
  fdem::StageConfig first, second;
  first.name = "first";
  first.until = 2e-5;
  second.name = "second";
  second.until = 1e-5;
  s.config.stages = {first, second};
  return s;
}
TEST(Fluid, of_an_explosive_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(blasted());
}
TEST(Fluid, of_an_explosive_is_resumed) {
  expect_resumed(blasted());
}

/// The water flows: into the crack at a given pressure, then at a given rate.
fdem::testing::Scene flowing(const char* joints) {
  fdem::testing::Scene s = flooded(joints, 0.0);
  fdem::LoadConfig& water = s.config.loads.back();
  water.viscosity = 1e-3;
  water.filled = true;
  s.config.stages[1].loads[0].pressure = 0.0;
  s.config.stages[1].loads[0].rate = 0.5;
  return s;
}
TEST(Fluid, that_flows_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(flowing("intrinsic"));
  expect_alike(flowing("extrinsic"));
}
TEST(Fluid, that_flows_is_resumed) {
  expect_resumed(flowing("intrinsic"));
}
/// Fluid that came in is in the cracks, besides what they held at the start: 4 closed edges of 1
/// cm.
TEST(Fluid, that_flows_is_neither_lost_nor_made) {
  const fdem::testing::Scene s = flowing("intrinsic");
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  double injected = 0.0, volume = 0.0, length = 0.0;
  for (const Fact& fact : method->facts()) {
    if (fact.path == "fluid.water.injected") injected = fact.value;
    if (fact.path == "fluid.water.volume") volume = fact.value;
    if (fact.path == "fluid.water.length") length = fact.value;
  }
  EXPECT_GT(injected, 1e-6);
  EXPECT_GT(length, 0.015);
  EXPECT_NEAR(volume - injected, 4.0 * 0.01 * 1e-5, 1e-12 * volume + 1e-15);
  EXPECT_LT(method->energy().error_relative, 2e-3);
}
TEST(Fluid, that_runs_faster_fills_more) {
  double last = 0.0;
  for (const double speed : {100.0, 800.0, 0.0}) {
    const fdem::testing::Scene s = flooded("intrinsic", speed);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, s.config, nullptr);
    double length = 0.0;
    for (const Fact& fact : method->facts())
      if (fact.path == "fluid.water.length") length = fact.value;
    EXPECT_GT(length, 1.2 * last) << speed;
    last = length;
    EXPECT_LT(method->energy().error_relative, 2e-3) << speed;
    EXPECT_GT(method->energy().work, 0.0);
  }
  EXPECT_GT(last, 0.06);  // it has left the crack of 40 mm
}

}  // namespace fluid_test
}  // namespace breccia
