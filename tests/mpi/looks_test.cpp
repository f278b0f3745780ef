// Ranks see of a run, by their parts, the bits that one process sees of the whole.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/probe.hpp"
#include "dem/ranks.hpp"
#include "exec/error.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace looks_test {

using namespace mpi_testing;

/// The bits of all that is seen on the way, the sign of a zero included.
using Seen = std::vector<std::uint64_t>;

/// A look every so many steps, a step at a time in between.
template <class AScene>
Seen seen(int count, const AScene& scene, int steps, int every, Space space = Space::host) {
  return on_all_ranks(
      count, 1, scene,
      [&](Method& method, bool) {
        Seen all;
        const auto note = [&all](double number) {
          all.push_back(std::bit_cast<std::uint64_t>(number));
        };
        while (true) {
          const EnergyBalance e = method.energy();
          for (const double part : {e.kinetic, e.elastic, e.fracture, e.plastic, e.friction,
                                    e.damping, e.contact, e.work, e.start, e.error_relative})
            note(part);
          for (const double value : method.probes()) note(value);
          if (method.steps() >= steps) return all;
          const std::int64_t next = method.steps() + every;
          while (method.steps() < next) method.advance({1e300, next});
        }
      },
      space);
}

/// Each quantity in each way of all items and of a body.
std::vector<ProbeConfig> probes(const std::string& body, const std::string& last_axis) {
  std::vector<ProbeConfig> all;
  for (const std::string& on : {std::string(), body})
    for (std::string quantity : {"position_", "velocity_", "force_", "momentum_", "displacement_",
                                 "speed", "damage", "kinetic", "broken"}) {
      if (quantity.ends_with("_")) quantity += last_axis;
      for (const char* reduce : {"min", "max", "sum", "mean"})
        all.push_back({quantity + reduce, on, quantity, reduce});
    }
  return all;
}
Scene probed(Scene scene, const std::string& body) {
  scene.config.probes = probes(body, "y");
  for (const std::string quantity :
       {"stress_xy", "strain_yy", "torque_z", "angular_momentum_z", "opening", "slip"})
    scene.config.probes.push_back({quantity, body, quantity, "mean"});
  return scene;
}

/// Where every column of the ledger has something in it.
Slab damped_piece() {
  Slab piece = slab_piece();
  piece.config.gravity = {0.0, 0.0, -9.81};
  piece.config.local_damping = 0.1;
  piece.config.probes = probes(piece.config.bodies[0].name, "z");
  piece.config.probes.push_back(
      {"box", "", "stress_zz", "mean", {-0.05, -0.04, -0.03}, {0.05, 0.06, 0.05}});
  for (const std::string quantity : {"strain_xz", "torque_y", "angular_momentum_x"})
    piece.config.probes.push_back({quantity, piece.config.bodies[0].name, quantity, "mean"});
  return piece;
}

TEST(Looks, at_a_slab_that_breaks_find_the_same) {
  const Slab piece = damped_piece();
  const Seen expected = seen(1, piece, 200, 20);
  for (const int count : {2, 3, 5, 8, 32})
    EXPECT_EQ(seen(count, piece, 200, 20), expected) << count << " ranks";
}

TEST(Looks, at_triangles_that_break_find_the_same) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = probed(impact(joints), "plate");
    const Seen expected = seen(1, scene, 200, 20);
    for (const int count : {2, 3, 5, 8, 32})
      EXPECT_EQ(seen(count, scene, 200, 20), expected) << joints << ", " << count << " ranks";
  }
}

TEST(Looks, at_bodies_that_fly_find_the_same) {
  const Scene scene = probed(box(), "blocks");
  const Seen expected = seen(1, scene, 700, 70);
  for (const int count : {2, 5, 12})
    EXPECT_EQ(seen(count, scene, 700, 70), expected) << count << " ranks";
}

TEST(Looks, find_the_same_where_most_ranks_own_nothing) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0).friction = 0.5;
  scene.config.gravity = {0.0, -9.81};
  scene.body("disc", prepare::ringed_disc({0.0, 0.0}, 4e-3, 4e-3), 0, {2.0, -60.0});
  scene = probed(scene, "disc");
  const Seen expected = seen(1, scene, 40, 10);
  EXPECT_EQ(seen(20, scene, 40, 10), expected);
}

// Stands for ranks that compute on GPUs: their arrays are out of the host's reach.
TEST(Looks, find_the_same_where_arrays_lie_in_another_space) {
  EXPECT_EQ(seen(3, damped_piece(), 200, 20, Space::shadow), seen(1, damped_piece(), 200, 20));
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = probed(impact(joints), "plate");
    EXPECT_EQ(seen(3, scene, 200, 20, Space::shadow), seen(1, scene, 200, 20)) << joints;
  }
}

// Walls press from the start, so the first look, before any step, finds contacts with them.
TEST(Looks, at_spheres_between_walls_find_the_same) {
  const Slab array = spheres_between_walls();
  const Seen expected = seen(1, array, 200, 20);
  EXPECT_EQ(seen(1, array, 200, 20, Space::shadow), expected);
  for (const int count : {2, 3, 8}) {
    EXPECT_EQ(seen(count, array, 200, 20), expected) << count << " ranks";
    EXPECT_EQ(seen(count, array, 200, 20, Space::shadow), expected) << count << " devices";
  }
}

/// Words of verify() after each of some steps.
template <class AScene>
std::vector<std::string> told(int count, const AScene& scene, int steps) {
  return on_all_ranks(count, 1, scene, [&](Method& method, bool) {
    std::vector<std::string> all;
    while (method.steps() < steps) {
      const std::int64_t next = method.steps() + 1;
      while (method.steps() < next) method.advance({1e300, next});
      try {
        method.verify();
        all.push_back("sound");
      } catch (const NumericsError& error) {
        all.push_back(error.what());
      }
    }
    return all;
  });
}

TEST(Looks, at_numbers_that_go_wrong_name_the_same_triangle) {
  Scene scene = box();
  scene.config.gravity = {1e9, 0.0};
  scene.config.time.safety = 1.0;
  scene.config.time.max_step = 0.02;
  scene.config.time.evaluate_every = 1000;
  const std::vector<std::string> expected = told(1, scene, 3);
  EXPECT_NE(expected.back().find("triangle"), std::string::npos) << expected.back();
  for (const int count : {2, 3, 5, 12}) EXPECT_EQ(told(count, scene, 3), expected) << count;
}

TEST(Looks, at_numbers_that_go_wrong_name_the_same_element) {
  Slab piece = slab_piece();
  piece.config.time.safety = 1.0;
  piece.config.gravity = {0.0, 0.0, -1e13};
  const std::vector<std::string> expected = told(1, piece, 3);
  EXPECT_NE(expected.back().find("element"), std::string::npos) << expected.back();
  for (const int count : {2, 3, 5, 12}) EXPECT_EQ(told(count, piece, 3), expected) << count;
}

/// Copies may lag behind their owners, who look at them.
template <class AScene, class Spoil>
void expect_copies_are_left_to_their_owners(const AScene& scene, const Spoil& spoil) {
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    auto whole = scene.world();
    auto part = share_out(whole, ranks, {});
    const Domain& domain = part.domain;
    EXPECT_FALSE(domain.ghosts.empty());
    for (const Ghost& ghost : domain.ghosts) spoil(part, ghost.element);
    EXPECT_EQ(find_unsound(part).id, Unsound::none);
    for (Index e = 0; e < domain.owned.size(); ++e) spoil(part, e);
    EXPECT_NE(find_unsound(part).id, Unsound::none);
  });
}
TEST(Looks, at_numbers_that_go_wrong_leave_copies_to_their_owners) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  expect_copies_are_left_to_their_owners(slab_piece(), [](dem::World& part, Index e) {
    part.elements.state.data()[e].velocity.x = nan;
  });
  expect_copies_are_left_to_their_owners(impact("intrinsic"), [](fdem::World& part, Index t) {
    part.triangles.nodes.data()[t].at[1].position.x = nan;
  });
}

TEST(Readings, take_the_last_of_equal_numbers_in_whatever_order_they_come) {
  const Readings first(0.0, 3), last(-0.0, 7);
  for (const Readings& both : {first + last, last + first, Readings() + last + first}) {
    EXPECT_TRUE(std::signbit(both.low));
    EXPECT_TRUE(std::signbit(both.high));
    EXPECT_EQ(both.count, 2);
  }
}

}  // namespace looks_test
}  // namespace breccia
