// The same bits for any number of ranks: triangles that break, fly, push and move as one.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "domain/simulated_ranks.hpp"
#include "fdem/ranks.hpp"
#include "io/case_file.hpp"
#include "physics/fdem/scene.hpp"
#include "prepare/build_fdem.hpp"
#include "run/fdem_method.hpp"

namespace breccia {
namespace {

using fdem::testing::Scene;

/// A brittle disc that breaks on a plate. Extrinsic: its triangles move as one until joints wake.
Scene impact(const char* joints) {
  Scene scene;
  fdem::MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = joints;
  m.friction = 0.5;
  m.damping = 0.02;
  m.joint.tension = 2e6;
  m.joint.cohesion = 6e6;
  m.joint.energy_open = 2.0;
  m.joint.energy_slide = 6.0;
  scene.config.time.evaluate_every = 50;
  scene.config.gravity = {0.0, -9.81};
  scene.body("disc", prepare::ringed_disc({0.0, 0.0202}, 0.02, 4e-3), 0, {2.0, -60.0});
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.01}, {0.06, 0.02}}, 5e-3));
  scene.support("ground", {-1.0, -1.0}, {1.0, -0.0199}, {"y"});
  scene.load("push", "pressure", {-1.0, -1.0}, {-0.0299, 1.0}, "plate").pressure = 1e5;
  scene.load("quiet", "absorbing", {0.0299, -1.0}, {1.0, 1.0}, "plate");
  return scene;
}

/// Hexagons of six triangles that move as one, flying into the corner of a room.
Scene box() {
  Scene scene;
  scene.config = read_case<fdem::Config>(BR_SOURCE_DIR "/cases/moving_box/small.toml", {});
  fdem::BodyConfig& blocks = scene.config.bodies[0];
  blocks.hexagons.count = 100;
  blocks.size = {19.0, 19.0};
  blocks.center = {39.0, 38.0};
  FdemNames names;
  for (const fdem::MaterialConfig& m : scene.config.materials) names.materials.push_back(m.name);
  scene.model = build_fdem_model(scene.config.bodies, {}, names, 1, "");
  return scene;
}

struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t searches = 0;
  double energies[5] = {};
  std::size_t cracks = 0;
  Index candidates = 0;
  double dt = 0.0;
  bool operator==(const Outcome&) const = default;
};
Outcome outcome_of(fdem::World& w) {
  const EnergyBalance e = fdem::energies(w).balance;
  return {fdem::state_hash(w),
          w.searches,
          {e.kinetic, e.elastic, e.friction, e.fracture, e.work},
          fdem::cracks(w).size(),
          w.couples.size(),
          w.next_dt};
}

Outcome alone(const Scene& scene, int steps) {
  fdem::World w = scene.world();
  for (int i = 0; i < steps; ++i) fdem::step(w);
  return outcome_of(w);
}

struct Shared {
  Outcome outcome;
  DomainCounts counts;
};
Shared on_ranks(int count, const Scene& scene, int steps, const DomainConfig& config = {},
                int threads = 1) {
  Shared shared;
  simulate_ranks(count, static_cast<std::uint64_t>(count), [&](Communicator& ranks) {
    fdem::World whole = scene.world(threads);
    fdem::World part = fdem::share_out(whole, ranks, config);
    for (int i = 0; i < steps; ++i) fdem::step(part);
    fdem::collect(part, whole);
    if (ranks.rank() == 0) shared = {outcome_of(whole), part.domain.counts};
  });
  return shared;
}

TEST(FdemRanks, leave_the_same_state_ledger_and_couples_amid_fracture) {
  const Scene scene = impact("intrinsic");
  const Outcome expected = alone(scene, 300);
  EXPECT_GT(expected.cracks, 20U);
  for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16})
    EXPECT_EQ(on_ranks(count, scene, 300).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_where_joints_wake_at_their_strength) {
  const Scene scene = impact("extrinsic");
  const Outcome expected = alone(scene, 300);
  EXPECT_GT(expected.cracks, 10U);
  for (const int count : {1, 2, 3, 5, 8, 16})
    EXPECT_EQ(on_ranks(count, scene, 300).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_where_all_flies_through_the_borders) {
  const Scene scene = box();
  const Outcome expected = alone(scene, 700);
  EXPECT_GT(expected.energies[1], 0.0);  // blocks press on walls
  for (const int count : {2, 3, 5, 7, 12}) {
    const Shared shared = on_ranks(count, scene, 700);
    EXPECT_EQ(shared.outcome, expected) << count << " ranks";
    EXPECT_GT(shared.counts.migrations, 8);
  }
}

TEST(FdemRanks, leave_the_same_state_however_borders_and_copies_are_kept) {
  const Scene scene = impact("intrinsic");
  const Outcome expected = alone(scene, 300);
  DomainConfig config;
  config.balance = false;
  EXPECT_EQ(on_ranks(4, scene, 300, config).outcome, expected);
  config = {};
  config.imbalance = 0.0;
  config.refinement = 10;
  config.buffer = 0.02;
  const Shared eager = on_ranks(5, scene, 300, config);
  EXPECT_EQ(eager.outcome, expected);
  EXPECT_GT(eager.counts.cuts, 5);
  config.refinement = 2;
  config.buffer = 2.0;
  EXPECT_EQ(on_ranks(3, scene, 300, config).outcome, expected);
  EXPECT_EQ(on_ranks(3, scene, 300, {}, 2).outcome, expected);
}

TEST(FdemRanks, leave_the_same_state_for_any_margin_of_search) {
  Scene scene = impact("intrinsic");
  const std::uint64_t expected = alone(scene, 300).hash;
  for (const double margin : {0.02, 0.8}) {
    scene.config.search.margin = margin;
    EXPECT_EQ(on_ranks(4, scene, 300).outcome.hash, expected) << margin;
  }
}

struct Journal {
  std::string checkpoint, frame;
  std::uint64_t hash = 0;
  double friction = 0.0, error = 0.0;
  bool operator==(const Journal&) const = default;
};
Journal journal(int count, const Scene& scene, const std::string& folder, const std::string& from) {
  Journal j;
  simulate_ranks(count, 78, [&](Communicator& ranks) {
    const auto method =
        make_fdem_method(scene.config, scene.model, Exec{}, count > 1 ? &ranks : nullptr);
    if (ranks.rank() != 0) {
      EXPECT_EQ(method->follow(), 4);
      return;
    }
    if (!from.empty()) method->load(CheckpointReader(from));
    while (method->steps() < 170) {
      method->advance({1e300, method->steps() + 1});
      if (method->steps() % 7 == 0) method->energy();  // looking changes nothing
    }
    CheckpointWriter writer;
    method->save(writer);
    writer.write(folder + "/state.br");
    std::ifstream file(folder + "/state.br", std::ios::binary);
    j.checkpoint.assign(std::istreambuf_iterator<char>(file), {});
    while (method->steps() < 300) method->advance({1e300, 300});
    j.hash = method->state_hash();
    j.friction = method->energy().friction;
    j.error = method->energy().error_relative;
    for (const FrameField& field : method->frame().line_fields)
      j.frame.append(reinterpret_cast<const char*>(field.values.data()),
                     field.values.size() * sizeof(float));
    method->dismiss(4);
  });
  return j;
}

TEST(FdemRanks, write_the_same_bytes_and_go_on_from_those_of_any_other_number_of_ranks) {
  const std::string folder = std::filesystem::temp_directory_path() / "breccia_fdem_ranks";
  std::filesystem::create_directories(folder);
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    const Journal expected = journal(1, scene, folder, "");
    EXPECT_EQ(journal(3, scene, folder, ""), expected);
    EXPECT_EQ(journal(5, scene, folder, folder + "/state.br"), expected);
    EXPECT_EQ(journal(2, scene, folder, folder + "/state.br"), expected);
    EXPECT_EQ(journal(1, scene, folder, folder + "/state.br"), expected);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace breccia
