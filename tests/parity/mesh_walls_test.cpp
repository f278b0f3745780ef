// Walls of triangles act alike on threads, by a device's schedule, on ranks and from a checkpoint.

#include <gtest/gtest.h>

#include <filesystem>

#include "domain/simulated_ranks.hpp"
#include "physics/dem/meshes.hpp"
#include "physics/dem/scene.hpp"
#include "run/method/dem_method.hpp"

namespace breccia {
namespace mesh_walls_parity_test {

using dem::testing::box_mesh;
using dem::testing::Corners;
using dem::testing::quad;

/// Grains in a funnel that turns, whose outlet they are too large for; a paddle turns in them, and
/// a block with mass falls on them if it is `free`.
dem::testing::Scene stirred(const char* law, bool free) {
  dem::testing::Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.contact.law = law;
  s.config.contact.friction = 0.4;
  s.config.contact.restitution = 0.5;
  s.config.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i < 64; ++i)
    s.sphere({-0.03 + 0.0201 * (i % 4), -0.03 + 0.0202 * (i / 4 % 4), 0.03 + 0.0203 * (i / 16)},
             0.01 - 1e-5 * (i % 7), {0.0, 0.0, -1.0});
  const auto wall = [&](const char* name, const Vec3& point, const Vec3& normal) -> auto& {
    s.wall(point, normal);
    dem::WallConfig& w = s.config.walls.back();
    w.name = name;
    w.shape = "stl";
    w.file = "in_the_model.stl";
    return w;
  };
  Corners funnel;
  const Vec3 low[4] = {
      {-8e-3, -8e-3, 0.0}, {8e-3, -8e-3, 0.0}, {8e-3, 8e-3, 0.0}, {-8e-3, 8e-3, 0.0}};
  for (int k = 0; k < 4; ++k) {
    const Vec3 a = low[k], b = low[(k + 1) % 4];
    const Vec3 up_a{8.0 * a.x, 8.0 * a.y, 0.05}, up_b{8.0 * b.x, 8.0 * b.y, 0.05};
    for (const Vec3& c : quad(a, b, up_b, up_a)) funnel.push_back(c);
  }
  wall("funnel", {0.0, 0.0, -0.009}, {0.0, 0.0, 1.0}).spin = {0.0, 0.0, 20.0};
  s.model.wall_meshes.push_back(funnel);
  wall("paddle", {0.0, -0.053, 0.04}, {0.1, 0.0, 1.0}).spin = {0.0, 5.0, 40.0};
  s.model.wall_meshes.push_back(box_mesh({-0.04, -0.002, -0.01}, {0.04, 0.002, 0.01}, 3));
  if (free) {
    dem::WallConfig& block = wall("block", {0.005, 0.0, 0.105}, {0.0, 0.0, 1.0});
    block.mass = 0.1;
    block.free = {"x", "y", "z"};
    block.velocity = {0.0, 0.0, -4.0};
    s.model.wall_meshes.push_back(box_mesh({-0.02, -0.02, 0.0}, {0.02, 0.02, 0.03}, 2));
  }
  for (const dem::WallConfig& w : s.config.walls)
    for (const char* quantity : {"position_z", "force_x", "force_z", "torque_y"})
      s.config.probes.push_back({w.name + quantity, w.name, quantity, "mean"});
  return s;
}

struct End {
  std::uint64_t hash;
  std::vector<double> probes;
  double kinetic, work, friction;
  bool operator==(const End&) const = default;
};
End end_of(Method& method, double end) {
  while (method.time() < end) method.advance({end, 1'000'000'000});
  const std::uint64_t hash = method.state_hash();
  const std::vector<double> probes = method.probes();
  const EnergyBalance e = method.energy();
  return {hash, probes, e.kinetic, e.work, e.friction};
}

TEST(MeshWalls, have_the_same_bits_everywhere) {
  for (const bool free : {false, true}) {
    const dem::testing::Scene s = stirred(free ? "hertz" : "linear", free);
    constexpr double end = 6e-3;
    const auto host = make_method(s.config, s.model, {}, nullptr);
    end_of(*host, 0.5 * end);
    const std::string path =
        std::filesystem::temp_directory_path() / ("mesh_" + std::to_string(::getpid()) + ".br");
    CheckpointWriter writer;
    host->save(writer);
    writer.write(path);
    const End expected = end_of(*host, end);
    EXPECT_LT(expected.probes[2], -1.0) << "the funnel bears grains";
    EXPECT_GT(expected.work, 1e-3) << "the paddle moves grains";
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
    simulate_ranks(3, 5, [&](Communicator& ranks) {
      const auto part = make_method(s.config, s.model, {}, &ranks);
      end_of(*part, 0.2 * end);
      part->load(ranks.rank() == 0 ? &reader : nullptr);
      const End on_ranks = end_of(*part, end);
      if (ranks.rank() == 0) {
        EXPECT_TRUE(on_ranks == expected) << "resumed on ranks";
      }
    });
    std::filesystem::remove(path);
  }
}

}  // namespace mesh_walls_parity_test
}  // namespace breccia
