// A rigid body of tetrahedra with mass among spheres: it shares momentum and spin with what it
// hits, goes through stages with the same bits on threads, by launches, on ranks and resumed, and
// is in frames.

#include <gtest/gtest.h>

#include "parity/staged_runs.hpp"
#include "physics/coupled/scene.hpp"
#include "run/method/coupled_method.hpp"

namespace breccia::coupled {
namespace rigid_bodies_test {

using namespace testing;
using breccia::testing::run_to;

/// A brick flies at two loose balls, beside its middle.
Scene brick_at_balls() {
  Scene s;
  fdem3::MaterialConfig& m = s.solids.material(30e9, 0.2, 2500.0);
  m.friction = 0.5;
  s.solids.body("brick", fdem3::testing::box({0.0, 0.0, 0.0302}, {0.04, 0.02, 0.02}, 0.01));
  const double far = fdem3::testing::far;
  fdem3::SupportConfig& tool = s.solids.support("tool", {-far, -far, -far}, {far, far, far},
                                                {"x", "y", "z"}, {1.0, 0.0, -10.0});
  tool.region.on = "brick";
  tool.free = {"x", "y", "z", "turn"};
  s.balls.material("g", "grain", 10e9, 0.2, 2600.0);
  s.balls.sphere({-0.013, 0.002, 0.01}, 0.01, {});
  s.balls.sphere({0.009, -0.003, 0.0099}, 0.01, {});
  return s;
}

TEST(CoupledRigidBodies, share_momentum_and_spin_with_spheres) {
  const Scene s = brick_at_balls();
  auto w = s.world();
  const dem::testing::Momentum before = momentum(*w);
  const double kinetic = energies(*w).kinetic;
  const double size = norm(before.linear);
  while (w->spheres.time < 3e-4) step(w->between);
  const dem::testing::Momentum after = momentum(*w);
  EXPECT_LT(norm(after.linear - before.linear), 1e-11 * size);
  EXPECT_LT(norm(after.angular - before.angular), 1e-5 * 0.02 * size);
  EXPECT_EQ(count(w->between).touching, 0.0);  // they have parted again
  const auto& state = w->tetrahedra.rigid[0];
  const double lost = state.mass * norm(state.velocity - Vec3{1.0, 0.0, -10.0});
  EXPECT_GT(lost, 0.05 * size);
  const Vec3 spin = state.turn.spin(state.angular);
  EXPECT_GT(norm(spin), 10.0);
  // It is a brick yet: all of its corners move by the velocity and spin of the body.
  const auto& tetrahedra = w->tetrahedra.tetrahedra;
  for (Index t = 0; t < tetrahedra.size(); ++t)
    for (const fdem3::NodeState& n : tetrahedra.nodes.data()[t].at)
      EXPECT_LT(norm(n.velocity - state.velocity - cross(spin, n.position - state.centre)), 1e-2);
  EXPECT_LT(std::abs(energies(*w).missing()), 2e-3 * kinetic);
}

/// A brick falls on linked balls, is driven by a force and a torque, then held.
Config driven(const Scene& s) {
  Config config = s.config();
  config.domain.buffer = 0.0005;
  config.stages.resize(3);
  const char* names[] = {"fly", "drive", "hold"};
  for (std::size_t k = 0; k < 3; ++k) {
    config.stages[k].name = names[k];
    config.stages[k].until = 4e-5;
  }
  auto& drive = config.stages[1].tetrahedra.supports.emplace_back();
  drive.name = "tool";
  drive.force = Vec3{0.0, 100.0, -2e3};
  drive.torque = Vec3{0.5, 0.2, 1.0};
  auto& hold = config.stages[2].tetrahedra.supports.emplace_back();
  hold.name = "tool";
  hold.free = {};
  config.probes.resize(2);
  for (auto& p : config.probes) {
    p.name = p.on = "tool";
    p.quantity = "momentum_z";
    p.reduce = "sum";
  }
  config.probes[1].name = "turn";
  config.probes[1].quantity = "angular_momentum_z";
  return config;
}
struct Pile {
  Config config;
  Model model;
};
Pile brick_on_pile() {
  Scene s = brick_at_balls();
  dem::MaterialConfig& c = s.balls.material("c", "concrete", 30e9, 0.2, 2400.0);
  c.tensile_strength = 1e6;
  c.cohesion = 3e6;
  for (int i = 0; i < 5; ++i) {
    const Index e = s.balls.sphere({-0.02 + 0.01 * i, 0.012, 0.0152}, 0.005);
    if (i > 0) s.balls.link(e - 1, e);
  }
  for (auto e = s.balls.model.material.end() - 5; e != s.balls.model.material.end(); ++e) *e = 1;
  return {driven(s), {s.balls.model, s.solids.model}};
}

struct End {
  std::uint64_t hash = 0;
  std::vector<double> numbers;
  std::string points;
};
End end_of(Method& method) {
  End end{method.state_hash(), method.probes(), ""};
  const EnergyBalance e = method.energy();
  end.numbers.insert(end.numbers.end(), {e.kinetic, e.friction, e.contact, e.work, method.time()});
  end.points = method.frame_output({}).files.points;
  return end;
}
void expect_equal(const End& a, const End& b) {
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_TRUE(a.points == b.points);
}

TEST(CoupledRigidBodies, are_alike_on_threads_launches_ranks_and_resumed) {
  const Pile r = brick_on_pile();
  const auto made = [&](Exec exec, Communicator* ranks) {
    return make_method(r.config, r.model, exec, ranks);
  };
  const auto alone = made({}, nullptr);
  run_to(*alone, r.config, nullptr);
  const End one = end_of(*alone);
  EXPECT_LT(alone->energy().error_relative, 1e-2);
  Exec threads, shadow;
  threads.threads = 3;
  shadow.space = Space::shadow;
  for (const Exec& exec : {threads, shadow}) {
    const auto method = made(exec, nullptr);
    run_to(*method, r.config, nullptr);
    expect_equal(end_of(*method), one);
  }
  for (const int count : {2, 3})
    simulate_ranks(count, 5, [&](Communicator& ranks) {
      const auto method = made({}, &ranks);
      run_to(*method, r.config, &ranks);
      const End here = end_of(*method);
      if (ranks.rank() == 0) expect_equal(here, one);
    });
  for (const double time : {2e-5, 6e-5, 1e-4}) {  // in each stage
    const auto before = made({}, nullptr);
    StageControl stages(*before, r.config.probes, "", nullptr);
    while (before->time() < time) {
      before->advance(stages.limited({time, 1'000'000}));
      stages.look();
    }
    CheckpointWriter writer;
    before->save(writer);
    const CheckpointReader reader(writer);
    const auto after = made({}, nullptr);
    after->load(&reader);
    run_to(*after, r.config, nullptr);
    expect_equal(end_of(*after), one);
    simulate_ranks(2, 5, [&](Communicator& ranks) {
      const auto on_ranks = made({}, &ranks);
      on_ranks->load(ranks.rank() == 0 ? &reader : nullptr);
      run_to(*on_ranks, r.config, &ranks);
      const End here = end_of(*on_ranks);
      if (ranks.rank() == 0) expect_equal(here, one);
    });
  }
}

/// The largest mark of a support on a corner.
float most_held(const Frame& frame) {
  for (const FrameField& field : frame.point_fields)
    if (field.name == "held") return *std::max_element(field.values.begin(), field.values.end());
  return -1.0F;
}

/// It is drawn where it has gone, and as held from the stage on that holds it.
TEST(CoupledRigidBodies, are_in_frames) {
  const Pile r = brick_on_pile();
  const auto method = make_method(r.config, r.model, {}, nullptr);
  const Frame start = method->frame();
  ASSERT_FALSE(start.tetrahedra.empty());
  EXPECT_EQ(most_held(start), 0.0F);
  run_to(*method, r.config, nullptr);
  const Frame end = method->frame();
  ASSERT_EQ(end.tetrahedra.size(), start.tetrahedra.size());
  EXPECT_EQ(most_held(end), 7.0F);
  double sum = 0.0;
  for (std::size_t k = 0; k < end.tetrahedra.size(); ++k)
    sum += end.position[static_cast<std::size_t>(end.tetrahedra[k])].z -
           start.position[static_cast<std::size_t>(start.tetrahedra[k])].z;
  EXPECT_LT(sum / static_cast<double>(end.tetrahedra.size()), -2e-4);
}

}  // namespace rigid_bodies_test
}  // namespace breccia::coupled
