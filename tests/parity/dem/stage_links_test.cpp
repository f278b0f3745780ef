// Links that a stage weakens, and faces that absorb: what follows, a ledger that books it, and the
// same bits on threads, a device's schedule, ranks and resumed.

#include <cmath>
#include <utility>

#include "dem/setup/moduli.hpp"
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

/// Two elements, joined by a link or pressed together, or one on a wall, that supports hold apart
/// from where they began, along and across; a second stage changes their modulus.
dem::testing::Scene held_pair(const char* law, double along, double young, bool on_wall = false) {
  dem::testing::Scene s;
  dem::MaterialConfig& m = s.material("m", law, 30e9, 0.2, 2400.0);
  m.tensile_strength = 400e6;
  m.cohesion = 1200e6;
  if (on_wall) {
    s.wall({0.0, 0.0, 0.01}, {0.0, 0.0, 1.0});
    s.config.walls.back().friction = 0.9;
  } else {
    s.sphere({0.0, 0.0, 0.0}, 0.01);
  }
  s.sphere({0.0, 0.0, 0.02}, 0.01);
  if (along > 0.0)
    s.link(0, 1,
           std::string(law) == "parallel" ? dem::LinkKind::parallel : dem::LinkKind::concrete);
  s.config.contact.restitution = 1.0;
  s.config.contact.friction = 0.9;
  dem::SupportConfig foot, head;
  foot.name = "foot";
  foot.max.z = 0.01;
  head.name = "head";
  head.min.z = 0.01;
  head.velocity.times = {0.0, 2e-5, 2.0001e-5};
  head.velocity.values = {{0.1 * along, 0.0, along}, {0.1 * along, 0.0, along}, {}};
  foot.fix = head.fix = {"all"};
  s.config.supports = {head};
  if (!on_wall) s.config.supports.push_back(foot);
  s.config.probes = {{"along", "head", "force_z", "sum"},
                     {"across", "head", "force_x", "sum"},
                     {"way", "head", "displacement_z", "mean"},
                     {"aside", "head", "displacement_x", "mean"}};
  s.config.time.end = 1.0;
  s.config.energy.stop = 0.0;
  dem::StageConfig hold, other;
  hold.name = "hold";
  hold.until = 4e-5;
  other.name = "other";
  other.until = 2e-5;
  other.materials.resize(1);
  other.materials[0].name = "m";
  other.materials[0].young = young;
  s.config.stages = {hold, other};
  return s;
}

/// F = K d, so with another K the force and what is stored, F d/2, change by the same share.
TEST(StageModuli,
     change_what_is_stored_and_the_work_by_half_of_the_stiffness_times_the_way_squared) {
  struct Held {
    const char* law;
    double along;
    bool on_wall = false;
  };
  for (const double by : {2.0, 0.25})
    for (const auto& [law, along, on_wall] :
         {Held{"concrete", 0.05}, Held{"parallel", 0.05}, Held{"concrete", -0.05},
          Held{"grain", -0.05}, Held{"grain", -0.05, true}})
      for (const char* contact : {"linear", "hertz"}) {
        SCOPED_TRACE(::testing::Message()
                     << law << " " << along << " " << contact << " " << by << " " << on_wall);
        dem::testing::Scene s = held_pair(law, along, by * 30e9, on_wall);
        s.config.contact.law = contact;
        const auto method = make_method(s.config, s.model, {}, nullptr);
        StageControl stages(*method, s.config.probes, "", nullptr);
        while (method->time() < 4e-5) method->advance(stages.limited({1.0, method->steps() + 37}));
        const EnergyBalance before = method->energy();
        const std::vector<double> was = method->probes();
        stages.look();
        ASSERT_EQ(method->stage().index, 1);
        const EnergyBalance after = method->energy();
        const double stored = -0.5 * (was[0] * was[2] + was[1] * was[3]);  // K d^2/2
        if (along > 0.0 || std::string(contact) == "linear") {
          EXPECT_NEAR(before.elastic, stored, 1e-6 * stored);
        }
        EXPECT_NEAR(after.elastic, by * before.elastic, 1e-9 * before.elastic);
        EXPECT_NEAR(after.work - before.work, (by - 1.0) * before.elastic, 1e-9 * before.elastic);
        EXPECT_NEAR(after.missing(), before.missing(), 1e-9 * before.elastic);
        while (!stages.finished()) {
          method->advance(stages.limited({1.0, method->steps() + 37}));
          stages.look();
        }
        const std::vector<double> is = method->probes();
        EXPECT_NEAR(is[0], by * was[0], 1e-9 * std::abs(was[0]));
        EXPECT_NEAR(is[1], by * was[1], 1e-9 * std::abs(was[0]));
        EXPECT_GT(std::abs(is[1]), 0.01 * std::abs(is[0]));
        EXPECT_NEAR(method->energy().missing(), before.missing(), 1e-9 * before.elastic);
      }
}

/// Half of a step's kick comes before the stage and half after it, each with its own forces.
TEST(StageModuli, change_the_energy_of_what_moves_and_it_is_all_booked) {
  for (const char* law : {"parallel", "concrete"})
    for (const double by : {2.0, 0.4}) {
      dem::testing::Scene s = weakened(law);
      s.config.local_damping = 0.0;
      s.config.materials[0].tensile_strength = 40e6;
      s.config.materials[0].cohesion = 120e6;
      s.config.stages[1].materials = {{"m"}};
      s.config.stages[1].materials[0].young = by * 30e9;
      const auto method = make_method(s.config, s.model, {}, nullptr);
      run_to(*method, s.config, nullptr);
      EXPECT_EQ(method->probes()[0], 0.0);
      EXPECT_LT(method->energy().error_relative, 1e-5) << law << " " << by;
    }
}

/// A link that has softened tells what that spent by its law: by another one it would be less.
TEST(StageLinks, of_another_strength_keep_what_cracks_have_spent) {
  dem::testing::Scene s = held_pair("concrete", 0.4, -1.0);
  s.config.materials[0].tensile_strength = 4e6;
  s.config.stages[1].materials[0].tensile_strength = 1e6;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  while (method->time() < 3e-5) method->advance({3e-5, method->steps() + 1});
  const EnergyBalance before = method->energy();
  ASSERT_GT(before.fracture, 0.01 * before.work);
  StageProgress next = method->stage();
  next.index = 1;
  next.begin[1] = method->time();
  method->set_stage(next);
  const EnergyBalance after = method->energy();
  EXPECT_EQ(after.fracture, before.fracture);
  EXPECT_LT(after.elastic, before.elastic);
  EXPECT_NEAR(after.work - before.work, after.elastic - before.elastic, 1e-12 * before.work);
  EXPECT_NEAR(after.error_relative, before.error_relative, 1e-12);
  // A run that goes on from a checkpoint has it, too.
  CheckpointWriter writer;
  method->save(writer);
  const auto again = make_method(s.config, s.model, {}, nullptr);
  const CheckpointReader reader(writer);
  again->load(&reader);
  EXPECT_EQ(again->energy().fracture, before.fracture);
}

/// Links that soften keep their damage; some break later.
TEST(StageModuli, are_alike_on_threads_schedule_and_ranks_and_resumed) {
  dem::testing::Scene s = weakened("concrete");
  s.config.materials[0].softening = 1.5;
  s.config.materials[0].tensile_strength = 1e6;
  s.config.stages[1].materials = {{"m"}};
  s.config.stages[1].materials[0].young = 60e9;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_GT(method->probes()[0], 0.0);
  expect_alike(s);
  expect_resumed(s);
}

/// Links of other strengths than the material's (fabric "faces") keep their shares, and those of
/// a material that the stage does not name stay as they are.
TEST(StageLinks, are_as_if_built_with_the_materials_of_the_stage) {
  dem::testing::Scene s = weakened("concrete");
  s.config.materials.push_back(s.config.materials[0]);
  s.config.materials[0].fabric = s.config.materials[1].fabric = "faces";
  s.config.materials[1].name = "other";
  for (std::size_t k = 0; k < s.model.links.size(); ++k) {
    s.model.links[k].strength = 0.25 * (1.0 + static_cast<double>(k % 5));
    s.model.links[k].material = static_cast<std::int16_t>(k % 2);
  }
  s.config.stages[1].materials = {{"m", 1e6, 3e6, 0.3}};
  for (const double young : {15e9, 120e9}) {
    s.config.stages[1].materials[0].young = young;
    ASSERT_TRUE(dem::stage_problems(s.config).empty());
    StageProgress second;
    second.index = 1;
    const dem::Config then = dem::config_at(s.config, second);
    dem::World w = dem::make_world(s.config, s.model, {});
    dem::change_moduli(w, s.config, then);
    dem::configure(w, then);
    const dem::World built = dem::make_world(then, s.model, {});
    ASSERT_EQ(w.concrete.groups.size(), 10U);
    std::vector<dem::ConcreteLink> on_device;
    copy_to(on_device, w.concrete.on_device.laws);
    ASSERT_EQ(on_device.size(), 10U);
    for (std::size_t g = 0; g < w.concrete.groups.size(); ++g) {
      const dem::ConcreteLink& should = built.concrete.groups[g].law;
      for (const dem::ConcreteLink& is : {w.concrete.groups[g].law, on_device[g]}) {
        EXPECT_DOUBLE_EQ(is.tensile_strength, should.tensile_strength) << g;
        EXPECT_DOUBLE_EQ(is.cohesion, should.cohesion) << g;
        EXPECT_DOUBLE_EQ(is.broken_friction, should.broken_friction) << g;
        EXPECT_DOUBLE_EQ(is.modulus, should.modulus) << g;
      }
    }
    for (Index i = 0; i < w.concrete.size(); ++i)
      EXPECT_DOUBLE_EQ(w.concrete.stiffness.data()[i], built.concrete.stiffness.data()[i]) << i;
    // the elements' own material became stiffer, or both stay resolved as they were
    EXPECT_DOUBLE_EQ(w.given->contact_step,
                     young > 30e9 ? built.given->contact_step : w.given->first_contact_step);
  }
}

/// A contact that closes in a stage with 100 times the modulus takes a tenth of the time: resolved
/// by as many steps it gives back all of its energy.
TEST(StageModuli, shorten_the_step_that_resolves_contacts) {
  dem::testing::Scene s;
  s.material("m", "grain", 1e8, 0.2, 2400.0);
  s.config.contact.restitution = 1.0;
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.sphere({0.0, 0.0, 0.011}, 0.01, {0.0, 0.0, -1.0});
  s.config.time.end = 1.0;
  s.config.probes = {{"speed", "", "velocity_z", "mean"}};
  s.config.stages.resize(2);
  s.config.stages[0].name = "soft";
  s.config.stages[0].until = 4e-4;
  s.config.stages[1].name = "stiff";
  s.config.stages[1].until = 3e-3;
  s.config.stages[1].materials.resize(1);
  s.config.stages[1].materials[0].name = "m";
  s.config.stages[1].materials[0].young = 1e10;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_NEAR(method->probes()[0], 1.0, 1e-2);
}

/// Links with a fracture energy part at an opening of their own, which softer ones would reach
/// before their strength.
TEST(StageModuli, with_which_links_would_part_below_their_strength_are_refused) {
  dem::testing::Scene s = weakened("concrete");
  s.model.bulk.resize(1);
  s.model.bulk[0].rupture_opening = 5e-5;
  s.config.stages[1].materials = {{"m"}};
  for (const double young : {20e9, 1e9}) {
    s.config.stages[1].materials[0].young = young;
    std::string told;
    try {
      make_method(s.config, s.model, {}, nullptr);
    } catch (const InputError& error) {
      told = error.what();
    }
    if (young > 10e9)
      EXPECT_EQ(told, "");
    else
      EXPECT_NE(told.find("stage.material.m.young = 1e+09 Pa: a link would reach its strength "
                          "beyond the opening"),
                std::string::npos)
          << told;
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
