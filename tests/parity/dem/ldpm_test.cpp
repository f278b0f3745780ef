// Concrete of LDPM: same bits on threads, packs, a device's schedule and ranks.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "prepare/build.hpp"
#include "run/method/dem_method.hpp"

namespace breccia::dem {
namespace ldpm_test {

/// A small prism that a fast head tears off its foot, on which it slides.
Config torn_prism() {
  Config config;
  MaterialConfig concrete;
  concrete.name = "concrete";
  concrete.law = "ldpm";
  concrete.density = 2338.0;
  concrete.young = 39e9;
  concrete.poisson = 0.17647;
  concrete.tensile_strength = 3.44e6;
  concrete.cohesion = 8.944e6;
  concrete.ldpm.tensile_length = 0.1;
  concrete.ldpm.densification = 1.5;
  config.materials = {concrete};
  BodyConfig prism;
  prism.name = "prism";
  prism.shape = "box";
  prism.material = "concrete";
  prism.size = {0.03, 0.03, 0.045};
  config.bodies = {prism};
  SupportConfig foot, head;
  foot.name = "foot";
  foot.min = {-1.0, -1.0, -1.0};
  foot.max = {1.0, 1.0, -0.0224};
  foot.fix = {"z", "spin_x", "spin_y"};
  foot.friction = 0.3;
  head.min = foot.min;
  head.max = foot.max;
  head.fix = {"all"};
  head.name = "head";
  head.min.z = 0.0224;
  head.max.z = 1.0;
  head.velocity = {40.0, 0.0, 120.0};
  head.ramp = 2e-5;
  config.supports = {foot, head};
  config.time.end = 1.0;
  return config;
}

const Model& model() {
  static const Model made = build_model(torn_prism(), "");
  return made;
}
constexpr int steps = 200;
World torn(Space space, int threads, Lanes lanes = widest_lanes()) {
  Exec exec;
  exec.space = space;
  exec.threads = threads;
  World w = make_world(torn_prism(), model(), exec);
  w.lanes = lanes;
  while (w.step < steps) advance(w, {1e300, steps});
  return w;
}
const World& reference() {
  static const World w = torn(Space::host, 1);
  return w;
}

TEST(LdpmFacets, crack_and_let_go_of_their_ends) {
  const Counts n = count(reference());
  EXPECT_GT(n.broken_of(LinkKind::ldpm), 100);
  const auto frames = reference().ldpm.frame.host();
  EXPECT_TRUE(std::any_of(frames.begin(), frames.end(),
                          [](const LdpmFrame& f) { return f.bond == ldpm_released; }));
  World w = reference();
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.fracture, 0.0);
  EXPECT_LT(e.error_relative, 0.05);
}

TEST(LdpmFacets, end_alike_on_threads_packs_and_a_devices_schedule) {
  for (const int threads : {2, 3, 7})
    EXPECT_EQ(state_hash(torn(Space::host, threads)), state_hash(reference())) << threads;
  for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight})
    if (lanes <= widest_lanes()) {
      EXPECT_EQ(state_hash(torn(Space::host, 1, lanes)), state_hash(reference()));
    }
  EXPECT_EQ(state_hash(torn(Space::shadow, 1)), state_hash(reference()));
}

TEST(LdpmFacets, resume_to_the_same_bits_on_other_threads_and_on_ranks) {
  const auto whole = make_method(torn_prism(), model(), {}, nullptr);
  while (whole->steps() < steps / 2) whole->advance({1e300, steps / 2});
  const std::string path =
      std::filesystem::temp_directory_path() / ("ldpm_" + std::to_string(::getpid()) + ".br");
  CheckpointWriter writer;
  whole->save(writer);
  writer.write(path);
  while (whole->steps() < steps) whole->advance({1e300, steps});
  EXPECT_EQ(whole->state_hash(), state_hash(reference()));
  const CheckpointReader reader(path);
  Exec three;
  three.threads = 3;
  const auto later = make_method(torn_prism(), model(), three, nullptr);
  later->load(&reader);
  EXPECT_EQ(later->steps(), steps / 2);
  while (later->steps() < steps) later->advance({1e300, steps});
  EXPECT_EQ(later->state_hash(), state_hash(reference()));
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const auto part = make_method(torn_prism(), model(), {}, &ranks);
    part->load(ranks.rank() == 0 ? &reader : nullptr);
    while (part->steps() < steps) part->advance({1e300, steps});
    const std::uint64_t hash = part->state_hash();
    if (ranks.rank() != 0) return;
    EXPECT_EQ(hash, state_hash(reference()));
  });
  std::filesystem::remove(path);
}

/// The prism with a bar through it, which bears after the prism has been torn; strengths depend on
/// rate.
Config barred_prism() {
  Config config = torn_prism();
  config.bodies[0].size = {0.04, 0.04, 0.045};
  config.materials[0].ldpm.rate_factor = 0.05;
  MaterialConfig steel;
  steel.name = "b500";
  steel.law = "steel";
  steel.density = 7850.0;
  steel.young = 200e9;
  MaterialConfig bond;
  bond.name = "bond";
  bond.law = "interface";
  config.materials.push_back(steel);
  config.materials.push_back(bond);
  BodyConfig bar;
  bar.name = "bar";
  bar.shape = "rebar";
  bar.material = "b500";
  bar.rebar.in = "prism";
  bar.rebar.interface_law = "bond";
  bar.rebar.diameter = 4e-3;
  bar.rebar.drawn.emplace_back().points = {{0.0, 0.0, -0.02}, {0.0, 0.0, 0.02}};
  config.bodies.push_back(bar);
  return config;
}

TEST(LdpmFacets, with_a_bar_end_alike_on_threads_packs_a_devices_schedule_and_ranks) {
  const Config config = barred_prism();
  const Model barred = build_model(config, "");
  const auto ended = [&](Space space, int threads, Lanes lanes) {
    Exec exec;
    exec.space = space;
    exec.threads = threads;
    World w = make_world(config, barred, exec);
    w.lanes = lanes;
    while (w.step < steps) advance(w, {1e300, steps});
    return state_hash(w);
  };
  const std::uint64_t one = ended(Space::host, 1, Lanes::one);
  EXPECT_EQ(ended(Space::host, 3, widest_lanes()), one);
  EXPECT_EQ(ended(Space::shadow, 1, Lanes::one), one);
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    World whole = make_world(config, barred, {});
    World part = share_out(whole, ranks, {}, Space::host);
    for (int i = 0; i < steps; ++i) step(part);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), one);
    const Counts n = count(whole);
    EXPECT_GT(n.broken_of(LinkKind::ldpm), 100);
    EXPECT_GT(n.broken_of(LinkKind::interface), 0);
  });
}

TEST(LdpmFacets, end_alike_on_ranks) {
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    World whole = make_world(torn_prism(), model(), {});
    World part = share_out(whole, ranks, {}, Space::host);
    for (int i = 0; i < steps; ++i) step(part);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), state_hash(reference()));
    EXPECT_EQ(count(whole).broken, count(reference()).broken);
  });
}

}  // namespace ldpm_test
}  // namespace breccia::dem
