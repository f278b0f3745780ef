// Servos: they reach and hold their force, what gives way is what closed answers say, and threads,
// a device's schedule, ranks and a resumed run move them alike.

#include "dem/servos.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "dem/setup/stages.hpp"
#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"
#include "physics/dem/specimen.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/stage_control.hpp"

namespace breccia {
namespace servos_test {

/// @param mass  of its plate; no limit: none, corrections alone  [kg]
ServoConfig pushing(const OverTime<double>& force, double speed, double mass = no_limit) {
  ServoConfig servo;
  servo.force = force;
  servo.speed = speed;
  servo.mass = mass;
  return servo;
}
/// Servos of a case that says nothing of a mass, and servos that correct every ten steps.
const double masses[] = {ServoConfig{}.mass, no_limit};

constexpr int spheres = 6;
constexpr double push = 2e3;  ///<  [N]

/// A column of grains on a floor, under a wall that a servo moves.
dem::testing::Scene column() {
  dem::testing::Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.local_damping = 0.4;
  for (int i = 0; i < spheres; ++i) s.sphere({0.0, 0.0, 0.01 + 0.02 * i}, 0.01);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.wall({0.0, 0.0, 0.02 * spheres + 1e-5}, {0.0, 0.0, -1.0});
  s.config.walls.back().name = "top";
  s.config.walls.back().servo = pushing(push, 0.5);
  s.config.probes = {{"force", "top", "force_z", "mean"}, {"place", "top", "position_z", "mean"}};
  return s;
}

/// A plate that a support presses along x with a table of pressures.
fdem::testing::Scene plate() {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).damping = 0.5;
  s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.04}}, 0.01));
  s.support("left", {-far, -far}, {-0.0499, far}, {"x"});
  fdem::SupportConfig& right = s.support("right", {0.0499, -far}, {far, far}, {"x"});
  right.servo.pressure = -5e6;
  right.servo.area = 0.04;
  right.servo.speed = 0.5;
  s.config.time.end = 1.0;
  s.config.probes = {{"force", "right", "force_x", "sum"},
                     {"place", "right", "position_x", "mean"}};
  return s;
}

void run_to(Method& method, double end) {
  while (method.time() < end) method.advance({end, 1'000'000'000});
}

TEST(Servo, wall_presses_a_column_as_far_as_its_springs_say) {
  for (const double mass : masses) {
    dem::testing::Scene s = column();
    s.config.walls.back().servo = pushing(push, 0.5, mass);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, 0.02);
    const std::vector<double> probes = method->probes();
    EXPECT_NEAR(probes[0], push, 1e-3 * push) << mass;
    // Two contacts with walls and five between spheres, of whose stiffness World knows the
    // constants.
    const dem::World w = s.world();
    const double between = w.given->contact_pairs.data()[0].normal * 0.01 / 2.0;
    const double at_wall = w.given->wall_pairs.data()[0].normal * 0.01 / 2.0;
    const double shorter = push * (2.0 / at_wall + (spheres - 1) / between);
    EXPECT_NEAR(0.02 * spheres - probes[1], shorter, 2e-3 * shorter) << mass;
    EXPECT_LT(method->energy().error_relative, 1e-2) << mass;
  }
}

TEST(Servo, wall_follows_a_table_of_its_force) {
  dem::testing::Scene s = column();
  OverTime<double> up;
  up.times = {0.0, 5e-3, 45e-3};
  up.values = {0.5 * push, 0.5 * push, 1.5 * push};
  for (const double mass : masses) {
    s.config.walls.back().servo = pushing(up, 0.5, mass);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    for (double t = 20e-3; t < 45e-3; t += 5e-3) {
      run_to(*method, t);
      const double asked = push * (0.5 + (method->time() - 5e-3) / 40e-3);
      EXPECT_NEAR(method->probes()[0], asked, 0.01 * asked) << t << ", " << mass;
    }
  }
}

TEST(Servo, support_presses_a_plate_as_far_as_hooke_says) {
  for (const double mass : masses) {
    fdem::testing::Scene s = plate();
    s.config.supports.back().servo.mass = mass;
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, 3e-3);
    const std::vector<double> probes = method->probes();
    EXPECT_NEAR(probes[0], 2e5, 1e-3 * 2e5) << mass;  // what the plate does to it
    const double shorter = 5e6 * 0.1 / 30e9;
    EXPECT_NEAR(0.05 - probes[1], shorter, 0.01 * shorter) << mass;
    EXPECT_LT(method->energy().error_relative, 1e-2) << mass;
  }
}

/// Joints and small triangles make steps so short that a plate answers a servo by the waves that it
/// takes up.
TEST(Servo, follows_a_table_where_joints_rule_the_step) {
  using fdem::testing::far;
  for (const auto& [edge, mass] : {std::pair{0.01, masses[1]}, {0.005, masses[1]}, {0.01, 0.0}}) {
    fdem::testing::Scene s;
    fdem::MaterialConfig& rock = s.material(30e9, 0.2, 2600.0);
    rock.damping = 0.5;
    rock.joints = "intrinsic";
    s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.05, 0.05}}, edge));
    for (const double side : {-1.0, 1.0}) {
      const bool left = side < 0.0;
      fdem::SupportConfig& support =
          s.support(left ? "left" : "right", {left ? -far : 0.0249, -far},
                    {left ? -0.0249 : far, far}, {"x"});
      support.servo.pressure.times = {0.0, 2e-4, 3e-4};
      support.servo.pressure.values = {0.0, -4.5e6 * side, -5e6 * side};
      support.servo.area = 0.05;
      support.servo.speed = 1.0;
      support.servo.mass = mass;
    }
    s.config.time.end = 1.0;
    s.config.probes = {{"force", "right", "force_x", "sum"}};
    const auto method = make_method(s.config, s.model, {}, nullptr);
    for (double t = 1e-4; t < 6e-4; t += 0.5e-4) {
      run_to(*method, t);
      const double now = method->time();
      const double asked = now < 2e-4   ? 4.5e6 * now / 2e-4
                           : now < 3e-4 ? 4.5e6 + 0.5e6 * (now - 2e-4) / 1e-4
                                        : 5e6;
      EXPECT_NEAR(method->probes()[0], 0.05 * asked, 0.01 * 0.05 * 5e6)
          << edge << " m, " << t << ", " << mass;
    }
    EXPECT_LT(method->energy().error_relative, 1e-3);
  }
}

/// A plate of mass M with a force on its back stands at the end of a bar of impedance Z = rho c h.
/// A wave that brings the force f comes to it: M dv/dt = 2 f - Z v, so what the bar pushes with is
/// off by 2 f exp(-t Z/M).
TEST(Servo, with_a_plate_is_off_by_the_plates_inertia_alone) {
  using fdem::testing::far;
  constexpr double edge = 0.005, length = 0.2, height = 0.01, young = 30e9, density = 2400.0;
  constexpr double brings = 0.1;  // speed of the wave's matter  [m/s]
  const double speed = std::sqrt(young / density), impedance = density * speed * height;
  const double comes = length / speed, lasts = 12.0 * edge / speed;
  fdem::testing::Scene s;
  s.material(young, 0.0, density).damping = 0.1;
  s.body("bar", prepare::crossed_rectangle({{0.0, 0.0}, {length, height}}, edge));
  s.support("left", {-far, -far}, {-0.5 * length + 1e-4, far}, {"x"}, {brings, 0.0});
  fdem::SupportConfig& right = s.support("right", {0.5 * length - 1e-4, -far}, {far, far}, {"x"});
  right.servo = {};
  right.servo.speed = 10.0;
  right.servo.mass = lasts * impedance;
  s.config.time.end = 1.0;
  s.config.probes = {{"force", "right", "force_x", "sum"},
                     {"speed", "right", "velocity_x", "mean"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  double given = 0.0, before = 0.0;
  for (const double t : {1.0, 2.0, 4.0}) {
    const double end = comes + t * lasts;
    while (method->time() < end) {
      method->advance({end, method->steps() + 1});
      const double now = method->probes()[0];
      given += 0.5 * (before + now) * method->time_step();
      before = now;
    }
    const double left = std::exp(-(method->time() - comes) / lasts);
    const std::vector<double> probes = method->probes();
    EXPECT_NEAR(probes[0], 2.0 * impedance * brings * left, 0.03 * 2.0 * impedance * brings) << t;
    EXPECT_NEAR(probes[1], 2.0 * brings * (1.0 - left), 0.03 * 2.0 * brings) << t;
    EXPECT_NEAR(right.servo.mass * probes[1], given, 0.04 * given) << t;
  }
  EXPECT_LT(method->energy().error_relative, 1e-3);
}

/// A face that touches nothing goes by the inertia of its plate, elements of a support with it.
TEST(Servo, with_a_plate_that_touches_nothing_falls_freely) {
  dem::testing::Scene s = column();
  s.config.walls.back().point.z += 0.1;
  s.config.walls.back().servo.speed = 20.0;
  s.config.walls.back().servo.mass = 0.4;
  const auto walls = make_method(s.config, s.model, {}, nullptr);
  run_to(*walls, 2e-3);
  const double t = walls->time(), way = 0.5 * push / 0.4 * t * t;
  const double start = s.config.walls.back().point.z;
  EXPECT_NEAR(start - walls->probes()[1], way, 0.02 * way);
  EXPECT_GT(way, 0.005);

  dem::testing::Scene head = column();
  head.config.walls.clear();
  dem::SupportConfig all;
  all.name = "all";
  all.fix = {"z"};
  static_cast<ServoConfig&>(all.servo) = pushing(push, 10.0);
  all.servo.axis = "z";
  all.servo.mass = 0.1;
  head.config.supports = {all};
  head.config.probes = {{"speed", "all", "velocity_z", "mean"}};
  const auto held = make_method(head.config, head.model, {}, nullptr);
  run_to(*held, 1e-4);
  EXPECT_NEAR(held->probes()[0], push / 0.1 * held->time(), 0.1 * push / 0.1 * 1e-4);
}

template <class Scene>
void expect_alike(const Scene& s, double end) {
  const auto host = make_method(s.config, s.model, {}, nullptr);
  run_to(*host, 0.5 * end);
  const std::string path =
      std::filesystem::temp_directory_path() / ("servo_" + std::to_string(::getpid()) + ".br");
  CheckpointWriter writer;
  host->save(writer);
  writer.write(path);
  run_to(*host, end);
  const std::uint64_t hash = host->state_hash();
  const CheckpointReader reader(path);
  const auto later = make_method(s.config, s.model, {}, nullptr);
  later->load(&reader);
  run_to(*later, end);
  EXPECT_EQ(later->state_hash(), hash) << "resumed";
  Exec shadow;
  shadow.space = Space::shadow;
  const auto launched = make_method(s.config, s.model, shadow, nullptr);
  run_to(*launched, end);
  EXPECT_EQ(launched->state_hash(), hash) << "by launches";
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const auto part = make_method(s.config, s.model, {}, &ranks);
    run_to(*part, 0.2 * end);
    part->load(ranks.rank() == 0 ? &reader : nullptr);
    run_to(*part, end);
    const std::uint64_t on_ranks = part->state_hash();
    if (ranks.rank() != 0) return;
    EXPECT_EQ(on_ranks, hash) << "resumed on ranks";
  });
  std::filesystem::remove(path);
}

TEST(Servo, of_walls_has_the_same_bits_everywhere) {
  dem::testing::Scene s = column();
  s.config.walls.back().servo.slow = 1e-3;
  expect_alike(s, 2e-3);
  s.config.walls.back().servo.mass = 0.0;
  expect_alike(s, 2e-3);
}
/// The column pressed by its highest spheres, held as a whole by a servo.
dem::testing::Scene column_under_head(int highest) {
  dem::testing::Scene s = column();
  s.config.walls.pop_back();
  dem::SupportConfig head;
  head.name = "head";
  head.min.z = 0.02 * (spheres - highest);
  head.fix = {"all"};
  static_cast<ServoConfig&>(head.servo) = pushing(-push, 0.5);
  head.servo.axis = "z";
  s.config.supports = {head};
  return s;
}
TEST(Servo, of_supports_of_spheres_has_the_same_bits_everywhere) {
  dem::testing::Scene s = column_under_head(1);
  s.config.probes.clear();
  expect_alike(s, 2e-3);
  s.config.supports.back().servo.mass = 0.05;
  expect_alike(s, 2e-3);
}
TEST(Servo, of_supports_of_triangles_has_the_same_bits_everywhere) {
  fdem::testing::Scene s = plate();
  expect_alike(s, 2e-5);
  s.config.supports.back().servo.mass = no_limit;
  expect_alike(s, 2e-5);
  s.config.supports.back().servo.mass = 2.0;
  expect_alike(s, 2e-5);
}

/// Gravity that sways by a table, and a floor that a table turns.
TEST(Tables, of_gravity_and_spin_have_the_same_bits_everywhere) {
  dem::testing::Scene grains = column();
  grains.config.walls.pop_back();
  grains.config.probes.clear();
  grains.config.gravity.times = {0.0, 1e-3};
  grains.config.gravity.values = {{}, {3.0, 0.0, -9.81}};
  grains.config.walls.back().spin.times = {0.0, 2e-3};
  grains.config.walls.back().spin.values = {{}, {0.0, 0.0, 500.0}};
  expect_alike(grains, 2e-3);
  fdem::testing::Scene flat = plate();
  flat.config.supports.pop_back();
  flat.config.probes.clear();
  flat.config.gravity.times = {0.0, 1e-5};
  flat.config.gravity.values = {{}, {1e4, 0.0}};
  expect_alike(flat, 2e-5);
}

/// Platens without inertia know what comes by their contacts, whose other sides another rank may
/// have.
TEST(Servo, of_platens_without_inertia_has_the_same_bits_everywhere) {
  dem::testing::Scene grains = column_under_head(2);
  grains.config.probes.clear();
  grains.config.supports.back().servo.mass = 0.0;
  expect_alike(grains, 1e-3);

  const auto press = [](auto& platen) {
    static_cast<ServoConfig&>(platen.servo) = pushing(-2e5, 2.0);
    platen.servo.mass = 0.0;
  };
  fdem::testing::Scene flat;
  flat.material(30e9, 0.2, 2500.0);
  flat.body("block", prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.04}}, 0.02));
  flat.body("platen", prepare::crossed_rectangle({{0.060001, 0.0}, {0.02, 0.08}}, 0.02));
  const double far = fdem::testing::far;
  flat.support("left", {-far, -far}, {-0.0499, far}, {"x"});
  press(flat.support("right", {0.0500005, -far}, {far, far}, {"x", "y"}));
  flat.config.time.end = 1.0;
  expect_alike(flat, 2e-5);

  fdem3::testing::Scene solid;
  solid.material(30e9, 0.2, 2500.0);
  solid.body("block", fdem3::testing::box({0.0, 0.0, 0.0}, {0.04, 0.02, 0.02}, 0.02));
  solid.body("platen", fdem3::testing::box({0.030001, 0.0, 0.0}, {0.02, 0.04, 0.04}, 0.02));
  solid.support("left", {-far, -far, -far}, {-0.0199, far, far}, {"x"});
  press(solid.support("right", {0.0200005, -far, -far}, {far, far, far}, {"x", "y", "z"}));
  solid.config.time.end = 1.0;
  expect_alike(solid, 2e-5);
  press(solid.support("face", {-far, -far, 0.0099}, {0.0199, far, far}, {"z"}));
  solid.config.supports.back().servo.axis = "z";
  expect_alike(solid, 2e-5);
}

/// Layers of concrete, whose links another rank may have the other ends of, while some of them
/// break.
TEST(Servo, of_layers_without_inertia_has_the_same_bits_everywhere) {
  for (const char* law : {"concrete", "parallel"}) {
    dem::testing::Specimen s(60, {0.05, 0.05, 0.1});
    s.material().law = law;
    s.material().tensile_strength = 0.5e6;
    s.material().cohesion = 1e6;
    dem::SupportConfig foot, head;
    foot.name = "foot";
    foot.max.z = -0.03;
    foot.fix = {"z"};
    head.name = "head";
    head.min.z = 0.03;
    head.fix = {"z"};
    static_cast<ServoConfig&>(head.servo) = pushing(-15e3, 5.0, 0.0);
    head.servo.axis = "z";
    s.config.supports = {foot, head};
    s.config.time.end = 1.0;
    struct {
      dem::Config config;
      dem::Model model;
    } const layers{s.config, s.model()};
    SCOPED_TRACE(law);
    expect_alike(layers, 1e-4);
  }
}

/// The column under a dead load on its highest grain.
dem::testing::Scene loaded_column() {
  dem::testing::Scene s = column();
  s.config.walls.pop_back();
  dem::SupportConfig head;
  head.name = "head";
  head.min.z = 0.02 * (spheres - 1);
  head.fix = {};
  head.force = Vec3{0.0, 0.0, -push};
  s.config.supports = {head};
  s.config.probes = {{"force", "floor", "force_z", "mean"},
                     {"speed", "head", "velocity_z", "mean"}};
  return s;
}
TEST(DeadLoad, comes_to_the_floor_and_is_booked) {
  dem::testing::Scene s = loaded_column();
  s.config.supports[0].ramp = 5e-3;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, 0.02);
  EXPECT_NEAR(std::abs(method->probes()[0]), push, 1e-4 * push);
  EXPECT_LT(method->energy().error_relative, 1e-4);
  s.config.walls.clear();  // nothing holds: F t/m
  s.config.local_damping = 0.0;
  s.config.probes.erase(s.config.probes.begin());
  s.config.supports[0].min = {};
  s.config.supports[0].ramp = 0.0;
  const auto free = make_method(s.config, s.model, {}, nullptr);
  run_to(*free, 1e-3);
  double mass = 0.0;
  for (const double one : s.model.mass) mass += one;
  EXPECT_NEAR(free->probes()[0], -push / mass * free->time(), 1e-9 * push / mass);
  // Of a force that is there at once the ledger misses m (a dt/2)^2/2, 1/(2 n)^2 of all after n
  // steps.
  EXPECT_LT(free->energy().error_relative, 1e-4);
}
TEST(DeadLoad, has_the_same_bits_everywhere) {
  dem::testing::Scene s = loaded_column();
  s.config.supports[0].force.times = {0.0, 1e-3};
  s.config.supports[0].force.values = {{}, {100.0, 0.0, -push}};
  s.config.probes.clear();
  expect_alike(s, 2e-3);
}
TEST(DeadLoad, on_what_is_held_is_a_problem) {
  dem::testing::Scene s = loaded_column();
  s.config.supports[0].fix = {"z"};
  std::string said;
  for (const std::string& problem : dem::stage_problems(s.config)) said += problem + "\n";
  EXPECT_NE(said.find("support.head.force acts on elements that are free: fix must be []"),
            std::string::npos)
      << said;
}

/// A plate of grains that a servo moves as a whole pushes as one layer of it does: what it touches
/// counts, not what it is made of.
TEST(Servo, of_a_platen_counts_what_it_touches) {
  dem::testing::Scene s = column_under_head(3);
  s.config.probes = {{"force", "head", "force_z", "sum"}};
  dem::World w = s.world();
  w.servos.resize(s.config.walls.size() + 1);
  while (w.step < 400) {
    dem::step(w);
    if (w.step % servo_every == 0) correct_servos(w, s.config, read_servos(w, s.config));
  }
  const ServoReading read = read_servos(w, s.config).back();
  const double between = w.given->contact_pairs.data()[0].normal * 0.01 / 2.0;
  EXPECT_NEAR(read.stiffness.value(), between, 1e-9 * between);
  EXPECT_NEAR(read.mass.value(), s.model.mass[0], 1e-12);
}

TEST(Servo, that_cannot_act_is_a_problem) {
  dem::testing::Scene s = column();
  s.config.walls.back().velocity = {0.0, 0.0, -1.0};
  s.config.walls.back().servo.pressure = 1e6;
  dem::SupportConfig head;
  head.name = "head";
  head.fix = {"x"};
  static_cast<ServoConfig&>(head.servo) = pushing(1.0, 1.0);
  head.servo.axis = "z";
  head.servo.mass = 1.0;
  head.servo.gain = 0.5;
  s.config.supports = {head};
  std::string said;
  for (const std::string& problem : dem::stage_problems(s.config)) said += problem + "\n";
  EXPECT_NE(said.find("support.head.servo.gain: a plate has none"), std::string::npos) << said;
  EXPECT_NE(said.find("wall.top: it has a velocity and a servo"), std::string::npos) << said;
  EXPECT_NE(said.find("wall.top.servo.area: the pressure needs an area"), std::string::npos);
  EXPECT_NE(said.find("support.head.servo.axis = \"z\": it does not fix that direction"),
            std::string::npos);
}

}  // namespace servos_test
}  // namespace breccia
