// Bolts between triangles: they hold a block by its weight, come with their stage, pull with no
// sum and no moment, and are alike on threads, a device's schedule, ranks and resumed.

#include "fdem/setup/bolts.hpp"

#include "fdem/setup/check_case.hpp"
#include "math/constants.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace bolts_test {

using namespace breccia::testing;
using fdem::testing::far;

/// A plate of 0.2 x 0.2 m with an open crack through its middle; its roof is held, a bolt crosses
/// the crack.
fdem::testing::Scene hanging() {
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0);
  s.body("rock", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.2}}, 0.05));
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Index from = s.model.triangle[t][at(k)], to = s.model.triangle[t][at((k + 1) % 3)];
      if (std::abs(s.model.point[at(from)].y) + std::abs(s.model.point[at(to)].y) < 1e-9)
        if (from < to) s.model.discontinuities.push_back({{from, to}, -1});
    }
  s.support("roof", {-far, 0.0999}, {far, far}, {"x", "y"});
  fdem::BoltConfig bolt;
  bolt.name = "b";
  bolt.points = {{0.01, 0.08}, {0.01, -0.08}};
  bolt.segment = 0.02;
  bolt.diameter = 0.01;
  s.config.bolts = {bolt};
  s.config.gravity = {0.0, -9.81};
  s.config.local_damping = 0.3;
  s.config.time.end = 1.0;
  return s;
}

double fact_of(Method& method, const std::string& path) {
  for (const Fact& fact : method.facts())
    if (fact.path == path) return fact.value;
  return -1.0;
}

TEST(Bolts, hold_the_weight_of_a_block) {
  fdem::testing::Scene s = hanging();
  s.config.local_damping = 0.8;
  s.config.bolts[0].points = {{0.0, 0.08}, {0.0, -0.08}};  // else it tilts, and pries
  const auto method = make_method(s.config, s.model, {}, nullptr);
  while (method->time() < 0.04) method->advance({0.04, 1'000'000});
  const double weight = 2500.0 * 9.81 * 0.2 * 0.1;
  EXPECT_NEAR(fact_of(*method, "bolt.b.force"), weight, 2e-3 * weight);
  EXPECT_LT(method->energy().error_relative, 1e-2);
}

/// Struck and let go: the bolt gives momentum and spin to one half and takes them from the other.
TEST(Bolts, pull_with_no_sum_and_no_moment) {
  fdem::testing::Scene s = hanging();
  s.config.supports.clear();
  s.config.gravity = {};
  s.config.local_damping = 0.0;
  s.config.bolts[0].bedding = 5e9;
  fdem::World w = s.world();
  EXPECT_GT(w.given->bolts[0].law.dowel.stiffness, 0.0);
  fdem::testing::stir(w, [](const Vec2& x) {
    return x.y > 0.0 ? Vec2{0.3 * x.y, 0.1 - 0.5 * x.x} : Vec2{-0.2, -0.1 + x.x};
  });
  const fdem::testing::Momentum before = fdem::testing::momentum(w);
  fdem::testing::run_to(w, 1e-3);
  const fdem::testing::Momentum after = fdem::testing::momentum(w);
  EXPECT_GT(std::abs(fdem_shared::bolt_rows(w)[4].force), 1e3);
  EXPECT_NEAR(norm(after.linear - before.linear), 0.0, 1e-10 * before.size);
  EXPECT_NEAR(after.angular, before.angular, 1e-8 * before.size);
}

/// One half slides past the other: E I beta^3 times the way, until the bar yields in bending and
/// the grout is crushed.
TEST(Bolts, resist_a_joint_that_slides) {
  fdem::testing::Scene s = hanging();
  s.config.gravity = {};
  s.config.local_damping = 0.8;
  s.config.materials[0].friction = 0.0;
  fdem::BoltConfig& bolt = s.config.bolts[0];
  bolt.points = {{0.0, 0.08}, {0.0, -0.08}};
  bolt.bedding = 5e9;
  s.config.materials[0].damping = 0.5;
  fdem::SupportConfig& block = s.support("block", {-far, -far}, {far, -0.0499}, {"x", "y"});
  block.velocity = Vec2{0.2, 0.0};
  block.history.ramp = 5e-4;
  s.config.probes = {{"across", "b", "shear_force", "max"}, {"block", "block", "force_x", "sum"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  const double bending = 200e9 * pi / 64.0 * 1e-8;
  const double stiffness = std::pow(bending, 0.25) * std::pow(0.25 * 5e9, 0.75);
  const double strength = 1.27 * 1e-4 * std::sqrt(30e6 * 500e6);
  while (method->time() < 2e-3) method->advance({2e-3, 1'000'000});
  const double bears = stiffness * 0.2 * (method->time() - 2.5e-4);
  EXPECT_NEAR(std::abs(method->probes()[0]), bears, 0.01 * bears);
  EXPECT_NEAR(std::abs(method->probes()[1]), bears, 0.02 * bears);
  while (method->time() < 5e-3) method->advance({5e-3, 1'000'000});
  EXPECT_NEAR(std::abs(method->probes()[0]), strength, 1e-9 * strength);
  EXPECT_GT(fact_of(*method, "bolt.b.crushed"), 0.0);
  EXPECT_LT(method->energy().error_relative, 1e-2);
}

/// Rock that is pulled evenly on all sides stretches a closed ring in it by its own strain, and
/// nowhere does the ring slip.
TEST(Bolts, of_a_closed_ring_bear_its_strain) {
  fdem::testing::Scene s = hanging();
  s.model.discontinuities.clear();
  s.config.gravity = {};
  s.config.supports.clear();
  s.config.materials[0].damping = 0.5;
  fdem::LoadConfig pull;
  pull.name = "pull";
  pull.pressure = -40e6;
  pull.history.ramp = 5e-4;
  s.config.loads = {pull};
  fdem::BoltConfig& ring = s.config.bolts[0];
  ring.points.clear();
  ring.center = {0.01, 0.0};
  ring.radius = 0.06;
  ring.area = 2e-5;
  s.config.probes = {{"least", "b", "axial_force", "min"},
                     {"most", "b", "axial_force", "max"},
                     {"strain", "rock", "strain_xx", "mean"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  while (method->time() < 1.5e-3) method->advance({1.5e-3, 1'000'000});
  const std::vector<double> read = method->probes();
  const double bears = 200e9 * 2e-5 * read[2];
  EXPECT_GT(bears, 2e3);
  EXPECT_NEAR(read[0], bears, 0.01 * bears);
  EXPECT_NEAR(read[1], bears, 0.01 * bears);
  EXPECT_LT(fact_of(*method, "bolt.b.slip"), 1e-6);
}

/// Two stages; the bolt comes with the second.
fdem::testing::Scene staged() {
  fdem::testing::Scene s = hanging();
  s.config.gravity = {0.0, -5000.0};
  s.config.bolts[0].stage = "bolted";
  s.config.bolts[0].bond_strength = 1e5;
  s.config.bolts[0].bedding = 5e9;
  fdem::StageConfig bare, bolted;
  bare.name = "bare";
  bare.until = 5e-5;
  bolted.name = "bolted";
  bolted.until = 2e-4;
  s.config.stages = {bare, bolted};
  return s;
}
TEST(Bolts, are_alike_on_threads_schedule_and_ranks) {
  expect_alike(staged());
}
TEST(Bolts, are_resumed) {
  expect_resumed(staged());
}

std::string refused(const fdem::testing::Scene& s) {
  std::string said;
  for (const std::string& problem : fdem::bolt_problems(s.config)) said += problem + "\n";
  try {
    s.world();
  } catch (const InputError& error) {
    said += error.what();
  }
  return said;
}
TEST(Bolts, that_cannot_be_are_refused) {
  fdem::testing::Scene s = hanging();
  s.config.bolts[0].points[1].y = -0.2;
  EXPECT_NE(refused(s).find("bolt.b.points: (0.01, -0.12) m lies in no triangle"),
            std::string::npos)
      << refused(s);
  s = hanging();
  s.config.bolts[0].segment = 1e-4;
  s.config.bolts[0].anchored = "end";  // elsewhere the bond slips with the rock
  EXPECT_NE(refused(s).find("bolt.b.segment: 0.0001 m are stiffer"), std::string::npos);
  s = hanging();
  s.config.bolts[0].radius = 0.05;
  EXPECT_NE(refused(s).find("bolt.b.points: at least two, or the radius of a ring and none"),
            std::string::npos);
  s = hanging();
  s.config.bolts[0].stage = "later";
  EXPECT_NE(refused(s).find("bolt.b.stage"), std::string::npos);
  s = staged();
  s.config.stages[1].remove = {"rock"};
  EXPECT_NE(refused(s).find("lies in body rock, which stage bolted takes out"), std::string::npos)
      << refused(s);
}

/// Each of many bolts beside each other is soft enough for the corners that it pulls at; together
/// they are not.
TEST(Bolts, in_one_element_pull_together) {
  fdem::testing::Scene s = hanging();
  s.config.bolts[0].anchored = "both";
  s.config.bolts[0].name = "b0";
  std::string said;
  for (int k = 1; k < 400 && said.empty(); ++k) {
    EXPECT_EQ(refused(s), "") << k;
    s.config.bolts.push_back(s.config.bolts[0]);
    s.config.bolts.back().name = "b" + std::to_string(k);
    try {
      s.world();
    } catch (const InputError& error) {
      said = error.what();
    }
  }
  EXPECT_NE(said.find("bolts pull at"), std::string::npos) << said;
  EXPECT_NE(said.find("together with"), std::string::npos) << said;
}

/// Frames have them from their stage on, with ends and forces as bolts.csv tells, on ranks, too.
TEST(Bolts, are_in_frames) {
  const fdem::testing::Scene s = staged();
  const auto at_end = [&](Communicator* ranks, const auto& look) {
    const auto method = make_method(s.config, s.model, {}, ranks);
    const Frame before = method->frame();
    if (ranks == nullptr || ranks->rank() == 0) {
      EXPECT_TRUE(before.bolted);
      EXPECT_TRUE(before.bars.empty());
    }
    run_to(*method, s.config, ranks);
    const Frame after = method->frame();
    const std::vector<Table> tables = method->tables();
    if (ranks != nullptr && ranks->rank() != 0) return;
    look(after, tables);
  };
  std::vector<FrameBar> alone;
  at_end(nullptr, [&](const Frame& frame, const std::vector<Table>& tables) {
    alone = frame.bars;
    const auto bolts = std::find_if(tables.begin(), tables.end(),
                                    [](const Table& table) { return table.name == "bolts"; });
    ASSERT_NE(bolts, tables.end());
    ASSERT_EQ(alone.size() + 1, bolts->rows.size());
    const std::size_t axes = bolts->columns.size() - 4;
    for (std::size_t k = 0; k < alone.size(); ++k) {
      const std::vector<double>& row = bolts->rows[k];
      EXPECT_EQ(alone[k].begin.x, row[1]);
      EXPECT_EQ(alone[k].end.y, bolts->rows[k + 1][2]);
      EXPECT_NEAR(alone[k].force, row[axes + 1], 1e-6 * std::abs(row[axes + 1]) + 1e-9);
      EXPECT_NEAR(alone[k].slip, row[axes + 3], 1e-6 * std::abs(row[axes + 3]) + 1e-15);
    }
    EXPECT_GT(std::abs(alone[alone.size() / 2].force), 0.0F);
  });
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    at_end(&ranks, [&](const Frame& frame, const std::vector<Table>&) {
      ASSERT_EQ(frame.bars.size(), alone.size());
      for (std::size_t k = 0; k < alone.size(); ++k) {
        EXPECT_EQ(frame.bars[k].force, alone[k].force);
        EXPECT_EQ(frame.bars[k].end.y, alone[k].end.y);
      }
    });
  });
}

}  // namespace bolts_test
}  // namespace breccia
