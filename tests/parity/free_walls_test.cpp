// Walls with mass move alike on threads, by a device's schedule, on ranks and from a checkpoint.

#include <gtest/gtest.h>

#include <filesystem>

#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"
#include "run/method/dem_method.hpp"

namespace breccia {
namespace free_walls_test {

/// A missile with an ogive that falls into grains on a floor, under a lid that a force presses.
dem::testing::Scene struck(const char* law) {
  dem::testing::Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.contact.law = law;
  s.config.contact.friction = 0.4;
  s.config.contact.restitution = 0.5;
  s.config.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i < 64; ++i)
    s.sphere({0.0201 * (i % 4), 0.0202 * (i / 4 % 4), 0.01 + 0.0203 * (i / 16)},
             0.01 - 1e-5 * (i % 7));
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.wall({0.0, 0.0, 0.0816}, {0.0, 0.0, -1.0});
  dem::WallConfig& lid = s.config.walls.back();
  lid.name = "lid";
  lid.mass = 0.2;
  lid.free = {"x", "z"};
  lid.force = {1.0, 0.0, -30.0};
  s.wall({-0.013, 0.03, 0.035}, {1.0, 0.0, -0.1}, {});
  dem::WallConfig& missile = s.config.walls.back();
  missile.name = "missile";
  missile.shape = "cylinder";
  missile.radius = 0.008;
  missile.length = 0.03;
  missile.nose = "ogive";
  missile.nose_length = 0.012;
  missile.mass = 0.05;
  missile.free = {"x", "y", "z", "turn"};
  missile.spin = {0.0, 3.0, 200.0};
  missile.velocity = {20.0, 0.0, 0.0};
  for (const char* wall : {"lid", "missile"})
    for (const char* quantity : {"position_x", "position_z", "velocity_x", "force_x", "kinetic"})
      s.config.probes.push_back({std::string(wall) + quantity, wall, quantity, "mean"});
  for (const char* quantity : {"angular_momentum_x", "angular_momentum_y", "angular_momentum_z"})
    s.config.probes.push_back({std::string("missile") + quantity, "missile", quantity, "mean"});
  return s;
}

struct End {
  std::uint64_t hash;
  std::vector<double> probes;
  double kinetic, work;
  bool operator==(const End&) const = default;
};
End end_of(Method& method, double end) {
  while (method.time() < end) method.advance({end, 1'000'000'000});
  const std::uint64_t hash = method.state_hash();
  const std::vector<double> probes = method.probes();
  const EnergyBalance e = method.energy();
  return {hash, probes, e.kinetic, e.work};
}

TEST(FreeWalls, have_the_same_bits_everywhere) {
  for (const char* law : {"linear", "hertz"}) {
    const dem::testing::Scene s = struck(law);
    constexpr double end = 1.5e-3;
    const auto host = make_method(s.config, s.model, {}, nullptr);
    end_of(*host, 0.5 * end);
    const std::string path =
        std::filesystem::temp_directory_path() / ("free_" + std::to_string(::getpid()) + ".br");
    CheckpointWriter writer;
    host->save(writer);
    writer.write(path);
    const End expected = end_of(*host, end);
    EXPECT_LT(expected.probes[7], 19.9) << "the missile has hit grains";
    EXPECT_GT(std::abs(expected.probes[11]), 1e-6) << "and they turn it";
    EXPECT_LT(host->energy().error_relative, 1e-2);
    const CheckpointReader reader(path);
    const auto later = make_method(s.config, s.model, {}, nullptr);
    later->load(&reader);
    EXPECT_TRUE(end_of(*later, end) == expected) << "resumed";
    Exec exec;
    exec.threads = 3;
    const auto threads = make_method(s.config, s.model, exec, nullptr);
    EXPECT_TRUE(end_of(*threads, end) == expected) << "on threads";
    exec = {};
    exec.space = Space::shadow;
    const auto launched = make_method(s.config, s.model, exec, nullptr);
    EXPECT_TRUE(end_of(*launched, end) == expected) << "by launches";
    for (const Space space : {Space::host, Space::shadow})
      simulate_ranks(3, 5, [&](Communicator& ranks) {
        Exec own;
        own.space = space;
        const auto part = make_method(s.config, s.model, own, &ranks);
        end_of(*part, 0.2 * end);
        part->load(ranks.rank() == 0 ? &reader : nullptr);
        const End on_ranks = end_of(*part, end);
        if (ranks.rank() == 0) {
          EXPECT_TRUE(on_ranks == expected)
              << "resumed on ranks" << (space == Space::shadow ? " by launches" : "");
        }
      });
    std::filesystem::remove(path);
  }
}

}  // namespace free_walls_test
}  // namespace breccia
