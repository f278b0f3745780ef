// Spheres and tetrahedra in one run: the same bits on any number of threads and ranks, and by
// launches of a device.

#include <gtest/gtest.h>

#include "domain/simulated_ranks.hpp"
#include "io/case/case_file.hpp"
#include "physics/coupled/scene.hpp"
#include "run/case.hpp"
#include "run/method/coupled_method.hpp"

namespace breccia::coupled {
namespace threads_test {

using namespace testing;

/// A jointed cube that breaks on a layer of linked spheres, some of them tied to a second block.
Scene breaking_cube() {
  Scene s;
  fdem3::MaterialConfig& m = s.solids.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.joint.tension = 3e6;
  m.joint.cohesion = 9e6;
  m.joint.energy_open = 3.0;
  m.joint.energy_slide = 9.0;
  s.solids.body("cube", fdem3::testing::box({0.0, 0.0, 0.0202}, {0.02, 0.02, 0.02}, 0.01),
                {3.0, 0.0, -30.0});
  s.solids.body("base", fdem3::testing::box({0.0, 0.0, -0.0105}, {0.06, 0.06, 0.01}, 0.01));
  dem::MaterialConfig& c = s.balls.material("c", "concrete", 30e9, 0.2, 2400.0);
  c.tensile_strength = 2e6;
  c.cohesion = 6e6;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const Index e = s.balls.sphere({-0.02 + 0.01 * i, -0.02 + 0.01 * j, 0.0051}, 0.005);
      if (j > 0) s.balls.link(e - 1, e);
      if (i > 0) s.balls.link(e - 5, e);
    }
  std::sort(s.balls.model.links.begin(), s.balls.model.links.end(),
            [](const auto& a, const auto& b) { return a.a != b.a ? a.a < b.a : a.b < b.b; });
  BondConfig bond;
  bond.name = "layer";
  bond.spheres = "all";
  bond.tetrahedra = "base";
  bond.range = 2.2;
  bond.tensile_strength = 0.5e6;
  bond.cohesion = 1e6;
  bond.energy_open = 0.3;
  bond.energy_slide = 1.0;
  s.bonds.push_back(bond);
  return s;
}

std::uint64_t hash(const Both& w) {
  return dem::state_hash(w.spheres) * 31 + fdem3::state_hash(w.tetrahedra);
}

TEST(CoupledThreads, give_the_same_bits) {
  const Scene s = breaking_cube();
  const auto run = [&](int threads, Space space = Space::host) {
    auto w = s.world(threads, space);
    while (w->spheres.step < 450) step(w->between);
    return w;
  };
  const auto one = run(1);
  const EnergyBalance e = energies(*one);
  EXPECT_GT(e.fracture, 0.0);
  EXPECT_GT(e.friction, 0.0);
  EXPECT_GT(count(one->between).broken, 0.0);
  EXPECT_GT(one->between.searches, 3);
  for (const int threads : {2, 3, 7, 0}) {  // 0: a device
    SCOPED_TRACE(threads);
    const auto w = threads > 0 ? run(threads) : run(1, Space::shadow);
    EXPECT_EQ(hash(*w), hash(*one));
    EXPECT_EQ(w->spheres.time, one->spheres.time);
    EXPECT_EQ(energies(*w).friction, e.friction);
    EXPECT_EQ(energies(*w).fracture, e.fracture);
  }
}

/// Of a method at some step: what its files tell.
struct Seen {
  std::uint64_t hash = 0;
  std::vector<double> numbers;
  std::string points, presses;
  CheckpointWriter saved;
};
Seen seen(Method& method) {
  Seen now;
  now.hash = method.state_hash();
  now.numbers = method.probes();
  const EnergyBalance e = method.energy();
  now.numbers.insert(now.numbers.end(), {e.kinetic, e.elastic, e.fracture, e.friction, e.contact,
                                         e.work, e.start, method.time()});
  for (const Fact& fact : method.facts())
    if (fact.path.starts_with("coupling.")) now.numbers.push_back(fact.value);
  FrameOutput frame = method.frame_output({});
  now.points = std::move(frame.files.points);
  for (const FrameContact& press : method.frame().contacts)
    for (const double f : {press.force.x, press.force.y, press.force.z})
      now.presses += std::to_string(f) + " ";
  method.save(now.saved);
  return now;
}
void expect_equal(const Seen& a, const Seen& b) {
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_TRUE(a.points == b.points);
  EXPECT_TRUE(a.presses == b.presses);
}

/// The cube is shared out often: it flies over borders.
std::unique_ptr<Method> cube_on(Communicator* ranks, Space space = Space::host) {
  const Scene s = breaking_cube();
  Config config = s.config();
  config.domain.buffer = 0.0005;
  ProbeConfig push;
  push.name = "push";
  push.on = "tetrahedra";
  push.quantity = "momentum_z";
  push.reduce = "sum";
  config.probes.push_back(push);
  Exec exec;
  exec.space = space;
  return make_method(config, {s.balls.model, s.solids.model}, exec, ranks);
}
void advance_to(Method& method, std::int64_t step) {
  while (method.steps() < step) method.advance({1.0, std::min(step, method.steps() + 37)});
}

TEST(CoupledRanks, give_the_same_bits) {
  const auto alone = cube_on(nullptr);
  advance_to(*alone, 300);
  const Seen one = seen(*alone);
  EXPECT_GT(alone->energy().fracture, 0.0);
  for (const int count : {2, 3, 5}) {
    const Space space = count == 3 ? Space::shadow : Space::host;
    simulate_ranks(count, 5, [&](Communicator& ranks) {
      SCOPED_TRACE(std::to_string(count) + (space == Space::shadow ? " by launches" : ""));
      const auto method = cube_on(&ranks, space);
      advance_to(*method, 300);
      const Seen here = seen(*method);
      double shared = 0.0, evaluated = 0.0, bonds = 0.0;
      for (const Fact& fact : method->facts()) {
        if (fact.path.ends_with("domain.sharings")) shared += fact.value;
        if (fact.path == "domain.coupling_bonds_evaluated") evaluated = fact.value;
        if (fact.path == "coupling.bonds") bonds = fact.value;
      }
      double all = 0.0;
      Message message;
      put_array(message, std::vector<double>{evaluated});
      for (const Message& told : ranks.from_all(message))
        all += Unpacking(told).array<double>().at(0);
      EXPECT_GE(all, bonds);
      EXPECT_LT(all, (count == 2 ? 1.9 : count == 3 ? 2.5 : 3.0) * bonds);
      if (ranks.rank() != 0) return;
      expect_equal(here, one);
      EXPECT_GT(shared, 2.0);  // each method's first sharing, and more
    });
  }
}

TEST(CoupledRanks, go_on_from_each_others_states) {
  const auto alone = cube_on(nullptr);
  advance_to(*alone, 200);
  const Seen half = seen(*alone);
  advance_to(*alone, 400);
  const Seen end = seen(*alone);
  CheckpointWriter of_ranks;
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const auto method = cube_on(&ranks);
    const CheckpointReader reader(half.saved);
    method->load(ranks.rank() == 0 ? &reader : nullptr);
    const Seen again = seen(*method);
    advance_to(*method, 300);
    CheckpointWriter writer;
    method->save(writer);
    advance_to(*method, 400);
    const Seen here = seen(*method);
    if (ranks.rank() != 0) return;
    expect_equal(again, half);
    expect_equal(here, end);
    of_ranks = std::move(writer);
  });
  const auto after = cube_on(nullptr);
  const CheckpointReader reader(of_ranks);
  after->load(&reader);
  advance_to(*after, 400);
  expect_equal(seen(*after), end);
}

/// Balls that slide along a plate bring their springs of friction to tetrahedra of other ranks.
TEST(CoupledRanks, keep_the_springs_of_spheres_that_slide_on) {
  Scene s;
  fdem3::MaterialConfig& m = s.solids.material(1e9, 0.2, 2500.0);
  m.joints = "none";
  m.friction = 0.8;
  s.solids.body("plate", fdem3::testing::box({0.0, 0.0, -0.005}, {0.12, 0.01, 0.01}, 0.005));
  s.balls.material("c", "concrete", 1e9, 0.2, 2400.0);
  for (int i = 0; i < 36; ++i)
    s.balls.sphere({-0.055 + 0.003 * i, 0.0, 0.00141}, 0.0014, {15.0, 0.0, -8.0});
  const Config config = s.config();
  const auto run = [&](Communicator* ranks) {
    auto method = make_method(config, {s.balls.model, s.solids.model}, Exec{}, ranks);
    while (method->steps() < 400) method->advance({1.0, 400});
    return method;
  };
  const auto alone = run(nullptr);
  const Seen one = seen(*alone);
  EXPECT_GT(alone->energy().friction, 0.0);
  EXPECT_GT(alone->searches(), 5);
  for (const int count : {2, 4})
    simulate_ranks(count, 5, [&](Communicator& ranks) {
      const auto method = run(&ranks);
      const Seen here = seen(*method);
      if (ranks.rank() == 0) expect_equal(here, one);
    });
}

/// A servo holds the foot of a block that a pile hits; a stage takes the pile, which is bonded to
/// it, out.
TEST(CoupledRanks, go_through_servos_and_stages) {
  const breccia::Case read = case_of_text(R"(breccia = 1
method = ["dem3d", "fdem3d"]
[time]
end = "0.1 ms"
max_step = "0.31 us"
[output]
pictures = false
[spheres.material.grain]
law = "grain"
young = "10 GPa"
[[spheres.body]]
name = "pile"
shape = "box"
material = "grain"
center = [-0.01, -0.01, 0.0205]
size = [0.04, 0.04, 0.04]
pack = { count = 30, compactness = 0.35 }
velocity = [5.0, 0.0, -20.0]
[[spheres.body]]
name = "heap"
shape = "box"
material = "grain"
center = [0.035, 0.035, 0.0205]
size = [0.03, 0.03, 0.04]
pack = { count = 12, compactness = 0.25 }
velocity = [0.0, 0.0, -20.0]
[[spheres.support]]
name = "lid"
on = "heap"
min = [-1.0, -1.0, "30 mm"]
fix = ["z"]
servo = { axis = "z", force = [[0, 0], ["1 ms", "-100 kN"]], speed = 100, mass = 2 }
[tetrahedra.material.rock]
young = "30 GPa"
joints = "none"
[[tetrahedra.body]]
name = "block"
shape = "box"
material = "rock"
center = [0.0, 0.0, -0.01]
size = [0.1, 0.1, 0.02]
structured = true
mesh_size = "20 mm"
[[tetrahedra.support]]
name = "foot"
max = [1.0, 1.0, "-19 mm"]
fix = ["z"]
[[bond]]
name = "b"
spheres = "pile"
tetrahedra = "block"
range = 2.0
[[probe]]
name = "lid"
on = "lid"
quantity = "velocity_z"
[[stage]]
name = "hold"
until = "30 us"
[[stage]]
name = "drop"
gravity = [0.0, 0.0, -9.81e3]
remove = ["pile"]
)",
                                          "both.toml", ".", {});
  const auto run = [&](Communicator* ranks) {
    const auto method = breccia::make_method(read, Exec{}, ranks, true);
    while (method->steps() < 300) {
      method->advance({1.0, method->steps() + 1});
      StageProgress now = method->stage();
      if (now.index > 0 || method->time() < method->stages()[0].until) continue;
      now.cause[0] = StageCause::time;
      now.index = 1;
      now.begin[1] = now.end[0] = method->time();
      method->set_stage(now);
    }
    return seen(*method);
  };
  const Seen one = run(nullptr);
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const Seen here = run(&ranks);
    if (ranks.rank() == 0) expect_equal(here, one);
  });
}

}  // namespace threads_test
}  // namespace breccia::coupled
