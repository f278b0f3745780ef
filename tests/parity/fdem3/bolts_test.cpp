// Bolts between tetrahedra: they are pulled out as the equation of their bond says, resist joints
// that slide in any direction, pull with no sum and no moment, and are alike on threads, a device's
// schedule, ranks and resumed.

#include "fdem3/setup/bolts.hpp"

#include <array>
#include <set>

#include "fdem_shared/bolts/bolts.hpp"
#include "math/constants.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace bolts_in_space_test {

using namespace breccia::testing;
using fdem3::testing::far;
using fdem3::testing::Scene;

/// Opens the faces of a model on the plane z = 0.
void open_middle(fdem3::Model& model) {
  std::set<std::array<Index, 3>> faces;
  for (const auto& t : model.tetrahedron)
    for (int k = 0; k < 4; ++k) {
      std::array<Index, 3> face{};
      double away = 0.0;
      for (int c = 0; c < 3; ++c) {
        face[at(c)] = t[at(fdem3::corner_of_face(k, c))];
        away += std::abs(model.point[at(face[at(c)])].z);
      }
      std::sort(face.begin(), face.end());
      if (away < 1e-9) faces.insert(face);
    }
  for (const auto& face : faces) model.discontinuities.push_back({face, -1});
}

/// A block of 0.2 m with an open crack through its middle, and a bolt across it.
Scene bolted() {
  Scene s;
  s.material(30e9, 0.2, 2500.0);
  s.body("rock", prepare::kuhn_box({}, {0.2, 0.2, 0.2}, 0.1));
  open_middle(s.model);
  fdem3::BoltConfig bolt;
  bolt.name = "b";
  bolt.points = {{0.02, 0.01, 0.08}, {0.02, 0.01, -0.08}};
  bolt.segment = 0.02;
  bolt.diameter = 0.01;
  s.config.bolts = {bolt};
  s.config.time.end = 1.0;
  return s;
}

double fact_of(Method& method, const std::string& path) {
  for (const Fact& fact : method.facts())
    if (fact.path == path) return fact.value;
  return -1.0;
}
void run(Method& method, double time) {
  while (method.time() < time) method.advance({time, 1'000'000});
}

constexpr double depth = 0.15;  ///< of a bar in rock  [m]

/// A bar of 4 mm in stiff rock, pulled out of it by a head that moves away.
Scene pulled(double way) {
  Scene s;
  s.material(600e9, 0.2, 2500.0).damping = 0.5;
  s.body("rock", prepare::kuhn_box({0.0, 0.0, -0.1}, {0.1, 0.1, 0.2}, 0.05));
  s.body("head", prepare::kuhn_box({0.0, 0.0, 0.0205}, {0.031, 0.031, 0.031}, 0.031));
  s.support("floor", {-far, -far, -far}, {far, far, -0.1999}, {"x", "y", "z"});
  fdem3::SupportConfig& head =
      s.support("head", {-far, -far, 1e-3}, {far, far, far}, {"x", "y", "z"});
  head.velocity = Vec3{0.0, 0.0, way / 1e-3};
  head.history.times = {0.0, 0.5e-3, 1.5e-3, 2e-3};
  head.history.factors = {0.0, 1.0, 0.0, 0.0};
  fdem3::BoltConfig bolt;
  bolt.name = "b";
  bolt.points = {{0.003, 0.002, 0.01}, {0.003, 0.002, -depth}};
  bolt.segment = 0.005;
  bolt.diameter = 0.004;
  bolt.anchored = "start";
  s.config.bolts = {bolt};
  s.config.local_damping = 0.5;
  return s;
}

/// E A u'' = k u along a bar that ends free in rock: with the slip s at its mouth
/// N = sqrt(E A k) s sinh((l - x)/r)/cosh(l/r), r = sqrt(E A/k).
TEST(BoltsInSpace, are_pulled_out_as_their_bond_says) {
  const Scene s = pulled(1e-4);
  fdem3::World w = s.world();
  while (w.time < 2e-3) fdem3::step(w);
  const double stiffness = 200e9 * 0.25 * pi * 0.004 * 0.004, bond = 1e9;
  const double reach = std::sqrt(stiffness / bond), all = std::sqrt(stiffness * bond);
  const auto rows = fdem_shared::bolt_rows(w);
  ASSERT_EQ(rows.size(), 33U);
  const double slip = std::abs(rows[2].slip);  // where the rock begins
  EXPECT_GT(slip, 3e-5);
  for (std::size_t i = 2; i + 1 < rows.size(); ++i) {
    const double x = 0.005 * (static_cast<double>(i - 2) + 0.5);
    const double exact = all * slip * std::sinh((depth - x) / reach) / std::cosh(depth / reach);
    EXPECT_NEAR(rows[i].force, exact, 0.01 * all * slip) << i;
  }
}

/// At last all of its bond slips: t l, with half of the segment across the gap.
TEST(BoltsInSpace, leave_with_the_strength_of_their_bond) {
  Scene s = pulled(2e-3);
  s.config.bolts[0].bond_strength = 2e4;
  s.config.bolts[0].yield = 5e9;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run(*method, 1.6e-3);
  const double holds = 2e4 * (depth + 0.0025);
  EXPECT_NEAR(fact_of(*method, "bolt.b.force"), holds, 1e-5 * holds);
  EXPECT_GT(fact_of(*method, "bolt.b.rubbed"), 0.5 * holds * 1e-3);
  EXPECT_LT(method->energy().error_relative, 1e-2);
}

/// Struck and let go, with a dowel that yields in changing directions: the bolt gives momentum and
/// spin to one half and takes them from the other.
TEST(BoltsInSpace, pull_with_no_sum_and_no_moment) {
  Scene s = bolted();
  s.config.bolts[0].points = {{0.02, 0.01, 0.08}, {-0.03, 0.04, -0.08}};
  s.config.bolts[0].bedding = 5e9;
  s.config.bolts[0].grout = 1e5;
  fdem3::World w = s.world();
  for (Index t = 0; t < w.tetrahedra.size(); ++t)
    for (auto& n : w.tetrahedra.nodes.data()[t].at) {
      const Vec3 x = n.position;
      const bool high = fdem3::centroid(w.tetrahedra.nodes.data()[t]).z > 0.0;
      n.velocity = high ? Vec3{0.3 * x.z - 3.0 * x.y, 0.1 + 3.0 * x.x, 0.3 - 0.5 * x.x}
                        : Vec3{-0.2 + 2.0 * x.y, 0.2 * x.z - 2.0 * x.x, -0.3};
    }
  const fdem3::testing::Motions before = fdem3::testing::motions(w);
  while (w.time < 1e-3) fdem3::step(w);
  const fdem3::testing::Motions after = fdem3::testing::motions(w);
  EXPECT_GT(std::abs(fdem_shared::bolt_rows(w)[4].force), 1e3);
  EXPECT_GT(fdem_shared::bolt_energies(w)[0].crushed, 0.0);
  EXPECT_NEAR(norm(after.linear - before.linear), 0.0, 1e-10 * before.size);
  EXPECT_NEAR(norm(after.angular - before.angular), 0.0, 1e-10 * before.size);
}

/// One half slides past the other: E I beta^3 times the way in whatever direction, until the bar
/// yields in bending and the grout is crushed.
TEST(BoltsInSpace, resist_a_joint_that_slides_in_any_direction) {
  for (const Vec3& direction : {Vec3{1.0, 0.0, 0.0}, Vec3{0.6, -0.8, 0.0}}) {
    Scene s = bolted();
    s.config.local_damping = 0.8;
    s.config.materials[0].damping = 0.5;
    s.config.bolts[0].bedding = 5e9;
    s.support("roof", {-far, -far, 0.0999}, {far, far, far}, {"x", "y", "z"});
    fdem3::SupportConfig& block =
        s.support("block", {-far, -far, -far}, {far, far, -0.0999}, {"x", "y", "z"});
    block.velocity = 0.2 * direction;
    block.history.ramp = 5e-4;
    s.config.probes = {{"across", "b", "shear_force", "max"},
                       {"x", "block", "force_x", "sum"},
                       {"y", "block", "force_y", "sum"}};
    const auto method = make_method(s.config, s.model, {}, nullptr);
    const double bending = 200e9 * pi / 64.0 * 1e-8;
    const double stiffness = std::pow(bending, 0.25) * std::pow(0.25 * 5e9, 0.75);
    const double strength = 1.27 * 1e-4 * std::sqrt(30e6 * 500e6);
    run(*method, 2e-3);
    const double bears = stiffness * 0.2 * (method->time() - 2.5e-4);
    EXPECT_NEAR(method->probes()[0], bears, 0.02 * bears);
    EXPECT_NEAR(std::abs(method->probes()[1]), bears * std::abs(direction.x), 0.03 * bears);
    EXPECT_NEAR(std::abs(method->probes()[2]), bears * std::abs(direction.y), 0.03 * bears);
    run(*method, 6e-3);
    EXPECT_NEAR(method->probes()[0], strength, 1e-9 * strength);
    EXPECT_GT(fact_of(*method, "bolt.b.crushed"), 0.0);
    EXPECT_LT(method->energy().error_relative, 1e-2);
  }
}

/// Rock that is pulled evenly on all sides stretches a closed ring in it by its own strain, however
/// the ring lies.
TEST(BoltsInSpace, of_a_closed_ring_bear_its_strain) {
  Scene s = bolted();
  s.model.discontinuities.clear();
  s.config.materials[0].damping = 0.5;
  fdem3::LoadConfig& pull = s.load("pull", "pressure", {-far, -far, -far}, {far, far, far});
  pull.pressure = -40e6;
  pull.history.ramp = 5e-4;
  fdem3::BoltConfig& ring = s.config.bolts[0];
  ring.points.clear();
  ring.center = {0.01, 0.0, 0.01};
  ring.radius = 0.06;
  ring.axis = {1.0, 2.0, 0.5};
  ring.area = 2e-5;
  ring.segment = 0.03;
  s.config.probes = {{"least", "b", "axial_force", "min"},
                     {"most", "b", "axial_force", "max"},
                     {"strain", "rock", "strain_xx", "mean"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run(*method, 1.5e-3);
  const std::vector<double> read = method->probes();
  const double bears = 200e9 * 2e-5 * read[2];
  EXPECT_GT(bears, 2e3);
  EXPECT_NEAR(read[0], bears, 0.01 * bears);
  EXPECT_NEAR(read[1], bears, 0.01 * bears);
  EXPECT_LT(fact_of(*method, "bolt.b.slip"), 1e-6);
}

/// Two stages; the bolt comes with the second, and slips and is sheared.
Scene staged() {
  Scene s = bolted();
  s.support("roof", {-far, -far, 0.0999}, {far, far, far}, {"x", "y", "z"});
  s.config.gravity = Vec3{3000.0, 1000.0, -5000.0};
  s.config.bolts[0].stage = "bolted";
  s.config.bolts[0].diameter = 0.004;
  s.config.bolts[0].bond_strength = 1e5;
  s.config.bolts[0].bedding = 5e9;
  s.config.bolts[0].grout = 1e3;
  s.config.bolts[0].anchored = "end";
  fdem3::StageConfig bare, bolted;
  bare.name = "bare";
  bare.until = 5e-5;
  bolted.name = "bolted";
  bolted.until = 2e-4;
  s.config.stages = {bare, bolted};
  return s;
}
TEST(BoltsInSpace, are_alike_on_threads_schedule_and_ranks) {
  expect_alike(staged());
}
TEST(BoltsInSpace, are_resumed) {
  expect_resumed(staged());
}

std::string refused(const Scene& s) {
  std::string said;
  for (const std::string& problem : fdem3::bolt_problems(s.config)) said += problem + "\n";
  try {
    s.world();
  } catch (const InputError& error) {
    said += error.what();
  }
  return said;
}
TEST(BoltsInSpace, that_cannot_be_are_refused) {
  Scene s = bolted();
  s.config.bolts[0].points[1].z = -0.2;
  EXPECT_NE(refused(s).find("bolt.b.points: (0.02, 0.01, -0.12) m lies in no tetrahedron"),
            std::string::npos)
      << refused(s);
  s = bolted();
  s.config.bolts[0].segment = 1e-3;
  EXPECT_EQ(refused(s), "");  // the bond slips before the rock feels the bar
  s.config.bolts[0].anchored = "end";
  EXPECT_NE(refused(s).find("bolt.b.segment: 0.001 m are stiffer than the corners of tetrahedra"),
            std::string::npos)
      << refused(s);
  s = bolted();
  s.config.bolts[0].points.clear();
  s.config.bolts[0].radius = 0.05;
  EXPECT_NE(refused(s).find("bolt.b.axis: a ring needs the direction of its axis"),
            std::string::npos);
  s = bolted();
  s.config.bolts[0].axis = {0.0, 0.0, 1.0};
  EXPECT_NE(refused(s).find("bolt.b.axis: a ring has one"), std::string::npos);
  s = bolted();
  s.config.bolts[0].bedding = 1e12;
  EXPECT_NE(refused(s).find("bolt.b.bedding: segments of 0.02 m"), std::string::npos);
  s = staged();
  s.config.stages[1].remove = {"rock"};
  EXPECT_NE(refused(s).find("lies in body rock, which stage bolted takes out"), std::string::npos)
      << refused(s);
}

/// Each of many bolts beside each other is soft enough for the corners that it pulls at; together
/// they are not.
TEST(BoltsInSpace, in_one_element_pull_together) {
  Scene s = bolted();
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
TEST(BoltsInSpace, are_in_frames) {
  const Scene s = staged();
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

}  // namespace bolts_in_space_test
}  // namespace breccia
