// Servos without inertia keep their force through waves and failure, instruments lag as they must,
// and servos of cases of both methods do what they do alone.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "domain/simulated_ranks.hpp"
#include "physics/coupled/scene.hpp"
#include "physics/dem/specimen.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/coupled_method.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace plates_test {

constexpr double push = 2e3;  ///<  [N]

ServoConfig pushing(double force, double speed, double mass = no_limit) {
  ServoConfig servo;
  servo.force = force;
  servo.speed = speed;
  servo.mass = mass;
  return servo;
}
void run_to(Method& method, double end) {
  while (method.time() < end) method.advance({end, 1'000'000'000});
}
/// Largest deviation of the size of the first probes from a force until that time, in any step.
double largest_deviation(Method& method, double end, std::size_t probes, double force) {
  double largest = 0.0;
  while (method.time() < end) {
    method.advance({end, method.steps() + 1});
    const std::vector<double> read = method.probes();
    for (std::size_t k = 0; k < probes; ++k)
      largest = std::max(largest, std::abs(std::abs(read[k]) / force - 1.0));
  }
  return largest;
}

/// A column of grains between a floor that strikes it at that time and a top that pushes.
dem::testing::Scene struck_column(double mass, double strikes) {
  dem::testing::Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.local_damping = 0.4;
  for (int i = 0; i < 6; ++i) s.sphere({0.0, 0.0, 0.01 + 0.02 * i}, 0.01);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.config.walls.back().velocity.times = {strikes, strikes + 1e-9};
  s.config.walls.back().velocity.values = {{}, {0.0, 0.0, 0.5}};
  s.wall({0.0, 0.0, 0.12}, {0.0, 0.0, -1.0});
  s.config.walls.back().name = "top";
  s.config.walls.back().servo = pushing(0.0, 5.0, mass);
  s.config.walls.back().servo.force.times = {0.0, 5e-3};
  s.config.walls.back().servo.force.values = {0.0, push};
  s.config.probes = {{"force", "top", "force_z", "mean"}};
  return s;
}

/// A plate without inertia gives way at once; a body that stands still feels 2 f of a wave.
TEST(Plate, without_inertia_keeps_its_force_in_every_step) {
  constexpr double strikes = 12e-3;  //  [s]
  const auto deviation = [&](double mass) {
    const dem::testing::Scene s = struck_column(mass, strikes);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, strikes);
    EXPECT_NEAR(method->probes()[0], push, 0.02 * push);
    const double largest = largest_deviation(*method, strikes + 1e-3, 1, push);
    EXPECT_LT(method->energy().error_relative, 1e-2);
    return largest;
  };
  EXPECT_LT(deviation(0.0), 1e-9);
  EXPECT_GT(deviation(0.05), 0.05);
}

/// Concrete of large elements is crushed while its sides are pressed: a link that lets go carries
/// more than a hundredth of their force.
TEST(Plate, holds_its_force_within_a_hundredth_through_failure) {
  constexpr double pressure = 10e6, area = 0.05 * 0.1, confined = 5e-3;
  dem::testing::Specimen s(350, {0.05, 0.05, 0.1});
  s.config.local_damping = 0.5;
  s.config.time.end = 1.0;
  s.config.contact.friction = 0.0;
  const auto wall = [&](const char* name, const Vec3& normal, double away, bool side) {
    dem::WallConfig w;
    w.name = name;
    w.normal = normal;
    w.point = -away * normal;
    if (side) {
      w.servo = pushing(0.0, 1.0, 0.0);
      w.servo.area = area;
      w.servo.pressure.times = {0.0, 1.5e-3, 2e-3};
      w.servo.pressure.values = {0.0, 0.9 * pressure, pressure};
    }
    s.config.walls.push_back(w);
  };
  wall("west", {1.0, 0.0, 0.0}, 0.0253, true);
  wall("east", {-1.0, 0.0, 0.0}, 0.0253, true);
  wall("south", {0.0, 1.0, 0.0}, 0.0253, true);
  wall("north", {0.0, -1.0, 0.0}, 0.0253, true);
  wall("foot", {0.0, 0.0, 1.0}, 0.0503, false);
  wall("head", {0.0, 0.0, -1.0}, 0.0503, false);
  s.config.walls.back().velocity.times = {confined, confined + 1e-4};
  s.config.walls.back().velocity.values = {{}, {0.0, 0.0, -0.1}};
  s.config.probes = {{"west", "west", "force_x", "mean"},
                     {"east", "east", "force_x", "mean"},
                     {"south", "south", "force_y", "mean"},
                     {"north", "north", "force_y", "mean"},
                     {"broken", "specimen", "broken", "sum"}};
  const auto method = make_method(s.config, s.model(), {}, nullptr);
  run_to(*method, confined);
  EXPECT_LT(largest_deviation(*method, 17e-3, 4, pressure * area), 0.01);
  EXPECT_GT(method->probes()[4], 50.0);
  EXPECT_LT(method->energy().error_relative, 5e-3);
}

/// A block of triangles whose far end strikes while a servo presses on the near one: a platen that
/// a support holds as a whole, or the block's own face.
/// @returns the largest deviation of the servo's force after the blow  [-]
double deviation_in_a_blow(bool platen, double mass) {
  using fdem::testing::far;
  constexpr double force = 2e5, strikes = 1e-3, strike = 0.05;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).damping = 0.1;
  s.config.local_damping = 0.5;
  s.body("block", prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.04}}, 0.01));
  if (platen) s.body("platen", prepare::crossed_rectangle({{0.060001, 0.0}, {0.02, 0.04}}, 0.01));
  fdem::SupportConfig& left = s.support("left", {-far, -far}, {-0.0499, far}, {"x"});
  left.velocity.times = {strikes, strikes + 1e-9};
  left.velocity.values = {{}, {strike, 0.0}};
  fdem::SupportConfig& right = platen
                                   ? s.support("right", {0.0500005, -far}, {far, far}, {"x", "y"})
                                   : s.support("right", {0.0499, -far}, {far, far}, {"x"});
  static_cast<ServoConfig&>(right.servo) = pushing(0.0, 2.0, mass);
  right.servo.force.times = {0.0, 8e-4, 9e-4};
  right.servo.force.values = {0.0, -0.9 * force, -force};
  s.config.time.end = 1.0;
  s.config.probes = {{"force", "right", "force_x", "sum"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, strikes);
  EXPECT_NEAR(method->probes()[0], force, 0.04 * force);
  const double largest = largest_deviation(*method, strikes + 6e-5, 1, force);
  EXPECT_LT(method->energy().error_relative, 1e-2);
  return largest;
}

/// Without inertia both keep their force to what stiffens within a step.
TEST(Plate, of_triangles_keeps_its_force_through_a_blow) {
  EXPECT_GT(deviation_in_a_blow(true, 20.0), 0.05);
  EXPECT_LT(deviation_in_a_blow(true, 0.0), 1e-4);
}
TEST(Plate, of_a_face_keeps_its_force_through_a_blow) {
  EXPECT_GT(deviation_in_a_blow(false, 20.0), 0.05);
  EXPECT_LT(deviation_in_a_blow(false, 0.0), 1e-5);
}

/// A block of tetrahedra one side of which, at y = 0.02, is oblique: seen along z, x and y there go
/// together.
prepare::TetMesh oblique(double middle, double edge) {
  constexpr double width = 0.04, slope = 0.5;
  prepare::TetMesh mesh = fdem3::testing::box({0.0, middle, 0.0}, {width, width, width}, edge);
  for (Vec3& x : mesh.point) x.y += slope * x.x * (1.0 - std::abs(x.y - 0.5 * width) / width);
  return mesh;
}

/// Two blocks of tetrahedra side by side, of both of which a servo presses the same face, are
/// driven into each other: contacts of elements of the face act on it, obliquely.
TEST(Plate, of_a_face_knows_what_contacts_do_to_it) {
  using fdem3::testing::far;
  constexpr double force = 4e4, pressed = 1.5e-4;
  fdem3::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).damping = 0.5;
  s.config.local_damping = 0.7;
  s.body("left", oblique(0.0, 0.02));
  s.body("right", oblique(0.0400001, 0.013));
  s.support("foot", {-far, -far, -far}, {-0.0199, far, far}, {"x"});
  s.support("wall", {-0.0198, -far, -far}, {0.0198, -0.0199, far}, {"y"});
  fdem3::SupportConfig& drive =
      s.support("drive", {-0.0198, 0.0599, -far}, {0.0198, far, far}, {"y"});
  drive.velocity.times = {0.0, pressed, pressed + 1e-5};
  drive.velocity.values = {{}, {}, {0.0, -0.5, 0.0}};
  fdem3::SupportConfig& face = s.support("face", {0.0199, -far, -far}, {far, far, far}, {"x"});
  static_cast<ServoConfig&>(face.servo) = pushing(-force, 5.0, 0.0);
  face.servo.force.times = {0.0, 0.6 * pressed};
  face.servo.force.values = {0.0, -force};
  s.config.time.end = 1.0;
  s.config.probes = {{"force", "face", "force_x", "sum"}, {"drive", "drive", "force_y", "sum"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, pressed);
  EXPECT_LT(largest_deviation(*method, pressed + 1e-4, 1, force), 1e-5);
  EXPECT_GT(std::abs(method->probes()[1]), 0.5 * force);
}

/// Brittle bonds of elements that supports hold let go, each of which bears some hundredths of a
/// side's force.
TEST(Plate, of_a_layer_keeps_its_force_while_its_bonds_break) {
  constexpr double force = 5e3, confined = 1e-3, edge = 0.018, end = 0.04;
  dem::testing::Specimen s(100, {0.05, 0.05, 0.1});
  s.material().law = "parallel";
  s.material().tensile_strength = 1e6;
  s.material().cohesion = 2e6;
  for (const double side : {-1.0, 1.0}) {
    dem::SupportConfig pressed, crushed;
    pressed.name = side < 0.0 ? "south" : "north";
    (side < 0.0 ? pressed.max.y : pressed.min.y) = side * edge;
    pressed.fix = {"y"};
    static_cast<ServoConfig&>(pressed.servo) = pushing(0.0, 5.0, 0.0);
    pressed.servo.axis = "y";
    pressed.servo.force.times = {0.0, 0.5 * confined};
    pressed.servo.force.values = {0.0, -side * force};
    crushed.name = side < 0.0 ? "foot" : "head";
    (side < 0.0 ? crushed.max.z : crushed.min.z) = side * end;
    crushed.fix = {"z"};
    crushed.velocity.times = {confined, confined + 1e-4};
    crushed.velocity.values = {{}, {0.0, 0.0, -0.2 * side}};
    s.config.supports.insert(s.config.supports.end(), {pressed, crushed});
  }
  s.config.time.end = 1.0;
  s.config.probes = {{"south", "south", "force_y", "sum"},
                     {"north", "north", "force_y", "sum"},
                     {"broken", "north", "broken", "sum"}};
  const auto method = make_method(s.config, s.model(), {}, nullptr);
  run_to(*method, confined);
  EXPECT_LT(largest_deviation(*method, 2e-3, 2, force), 0.01);
  EXPECT_GT(method->probes()[2], 5.0);
  EXPECT_LT(method->energy().error_relative, 5e-3);
}

/// A wall that goes at a constant speed presses grains by K v t: what is told lags by K v lag.
TEST(LaggingProbe, follows_a_ramp_by_its_lag_and_has_the_same_bits_everywhere) {
  constexpr double lag = 50e-6;
  dem::testing::Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time = {.end = 1.0, .max_step = 1e-6};
  for (int i = 0; i < 6; ++i) s.sphere({0.03 * i, 0.0, 0.01}, 0.01);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.wall({0.0, 0.0, 0.02}, {0.0, 0.0, -1.0}, {0.0, 0.0, -0.01});
  s.config.walls.back().name = "top";
  dem::SupportConfig held;
  held.name = "held";
  s.config.supports = {held};
  s.config.probes = {{"now", "top", "force_z", "mean"}, {"cell", "top", "force_z", "mean"}};
  s.config.probes[1].lag = lag;
  const double end = 1e-3;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, 0.4 * end);
  const std::string path =
      std::filesystem::temp_directory_path() / ("lag_" + std::to_string(::getpid()) + ".br");
  CheckpointWriter writer;
  method->save(writer);
  writer.write(path);
  run_to(*method, end);
  const std::vector<double> told = method->probes();
  const double slope = told[0] / method->time(), look = 10.0 * method->time_step();
  EXPECT_NEAR((told[0] - told[1]) / slope, lag, look);

  const CheckpointReader reader(path);
  const auto later = make_method(s.config, s.model, {}, nullptr);
  later->load(&reader);
  run_to(*later, end);
  EXPECT_EQ(later->probes()[1], told[1]) << "resumed";
  Exec shadow;
  shadow.space = Space::shadow;
  const auto launched = make_method(s.config, s.model, shadow, nullptr);
  run_to(*launched, end);
  EXPECT_EQ(launched->probes()[1], told[1]) << "by launches";
  simulate_ranks(2, 5, [&](Communicator& ranks) {
    const auto part = make_method(s.config, s.model, {}, &ranks);
    run_to(*part, end);
    const std::vector<double> read = part->probes();
    if (ranks.rank() == 0) {
      EXPECT_EQ(read[1], told[1]) << "on ranks";
    }
  });
  std::filesystem::remove(path);
}

/// Three grains on a block of tetrahedra; the highest are led by a servo, or a wall is.
struct OnBlock {
  coupled::Config config;
  coupled::Model model;

  OnBlock(bool wall, int led, double mass) {
    constexpr double radius = 0.01;
    fdem3::testing::Scene block;
    block.material(30e9, 0.2, 2400.0).damping = 0.5;
    block.body("block", fdem3::testing::box({0.0, 0.0, -0.01}, {0.06, 0.06, 0.02}, 0.02));
    const double far = fdem3::testing::far;
    block.support("foot", {-far, -far, -far}, {far, far, -0.0199}, {"x", "y", "z"});
    dem::testing::Scene balls;
    balls.material("g", "grain", 10e9, 0.2, 2500.0);
    balls.config.local_damping = 0.4;
    for (int k = 0; k < 3; ++k)
      balls.sphere({0.003, 0.002, radius * (1.0 + 2.0 * k) + 1e-6}, radius);
    const double top = 6.0 * radius + 2e-6;
    if (wall) {
      balls.wall({0.0, 0.0, top}, {0.0, 0.0, -1.0});
      balls.config.walls.back().name = "top";
      balls.config.walls.back().servo = pushing(push, 0.2, mass);
    } else {
      dem::SupportConfig head;
      head.name = "top";
      head.min.z = top - 2.0 * radius * led;
      head.fix = {"all"};
      static_cast<ServoConfig&>(head.servo) = pushing(-push, 0.2, mass);
      head.servo.axis = "z";
      balls.config.supports = {head};
    }
    static_cast<dem::Config&>(config.spheres) = balls.config;
    static_cast<fdem3::Config&>(config.tetrahedra) = block.config;
    config.time.end = 1.0;
    config.time.max_step = 1.0;
    config.probes = {{"top", "top", "force_z", "sum"}, {"foot", "foot", "force_z", "sum"}};
    model = {balls.model, block.model};
  }
  std::unique_ptr<Method> run(double end, Exec exec = {}) const {
    auto method = make_method(config, model, exec);
    run_to(*method, end);
    return method;
  }
};

/// Walls, grains that others lie under, grains that lie on tetrahedra alone; with a plate and
/// without.
TEST(Servo, of_both_methods_presses_through_spheres_on_tetrahedra) {
  for (const double mass : {no_limit, 0.0})
    for (const int led : {0, 1, 3}) {
      SCOPED_TRACE(::testing::Message() << led << " grains led, mass " << mass);
      const OnBlock s(led == 0, led, mass);
      const auto method = s.run(3e-3);
      const std::vector<double> read = method->probes();
      EXPECT_NEAR(std::abs(read[0]), push, 0.01 * push);
      EXPECT_NEAR(std::abs(read[1]), push, 0.01 * push);
      EXPECT_LT(method->energy().error_relative, 5e-3);
    }
}

TEST(Servo, of_both_methods_has_the_same_bits_everywhere) {
  constexpr double end = 2e-4;
  for (const int led : {0, 1, 3}) {
    SCOPED_TRACE(::testing::Message() << led << " grains led");
    const OnBlock s(led == 0, led, led == 1 ? 0.0 : no_limit);
    const std::uint64_t host = s.run(end)->state_hash();
    Exec threads, shadow;
    threads.threads = 3;
    shadow.space = Space::shadow;
    EXPECT_EQ(s.run(end, threads)->state_hash(), host);
    EXPECT_EQ(s.run(end, shadow)->state_hash(), host);
    const auto first = s.run(0.5 * end);
    const std::string path =
        std::filesystem::temp_directory_path() / ("plates_" + std::to_string(::getpid()) + ".br");
    CheckpointWriter writer;
    first->save(writer);
    writer.write(path);
    const CheckpointReader reader(path);
    const auto later = make_method(s.config, s.model, {});
    later->load(&reader);
    run_to(*later, end);
    EXPECT_EQ(later->state_hash(), host) << "resumed";
    std::filesystem::remove(path);
  }
}

}  // namespace plates_test
}  // namespace breccia
