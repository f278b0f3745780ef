// What ranks see of a run by their parts has the bits of what one process sees of the whole.

#include <gtest/gtest.h>

#include <bit>

#include "mpi/on_ranks.hpp"

namespace breccia {
namespace {

using namespace mpi_testing;

/// The bits of all that is seen on the way, the sign of a zero included.
using Seen = std::vector<std::uint64_t>;

/// A look every so many steps, a step at a time in between.
template <class AScene>
Seen seen(int count, const AScene& scene, int steps, int every, Space space = Space::host) {
  Seen all;
  const auto note = [&all](double number) { all.push_back(std::bit_cast<std::uint64_t>(number)); };
  led_on_ranks(
      count, 1, scene,
      [&](Method& method) {
        while (true) {
          const EnergyBalance e = method.energy();
          for (const double part : {e.kinetic, e.elastic, e.fracture, e.plastic, e.friction,
                                    e.damping, e.contact, e.work, e.start, e.error_relative})
            note(part);
          if (method.steps() >= steps) return;
          const std::int64_t next = method.steps() + every;
          while (method.steps() < next) method.advance({1e300, next});
        }
      },
      space);
  return all;
}

/// Where every column of the ledger has something in it.
Slab damped_piece() {
  Slab piece = slab_piece();
  piece.config.gravity = {0.0, 0.0, -9.81};
  piece.config.local_damping = 0.1;
  return piece;
}

TEST(Looks, at_a_slab_that_breaks_find_the_same_energies) {
  const Slab piece = damped_piece();
  const Seen expected = seen(1, piece, 300, 30);
  for (const int count : {2, 3, 5, 8, 32})
    EXPECT_EQ(seen(count, piece, 300, 30), expected) << count << " ranks";
}

TEST(Looks, at_triangles_that_break_find_the_same_energies) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    const Seen expected = seen(1, scene, 300, 30);
    for (const int count : {2, 3, 5, 8, 32})
      EXPECT_EQ(seen(count, scene, 300, 30), expected) << joints << ", " << count << " ranks";
  }
}

TEST(Looks, at_bodies_that_fly_find_the_same_energies) {
  const Seen expected = seen(1, box(), 700, 70);
  for (const int count : {2, 5, 12})
    EXPECT_EQ(seen(count, box(), 700, 70), expected) << count << " ranks";
}

TEST(Looks, find_the_same_where_most_ranks_own_nothing) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0).friction = 0.5;
  scene.config.gravity = {0.0, -9.81};
  scene.body("disc", prepare::ringed_disc({0.0, 0.0}, 4e-3, 4e-3), 0, {2.0, -60.0});
  const Seen expected = seen(1, scene, 40, 10);
  EXPECT_EQ(seen(20, scene, 40, 10), expected);
}

// Stands for ranks that compute on GPUs: their arrays are out of the host's reach.
TEST(Looks, find_the_same_where_arrays_lie_in_another_space) {
  EXPECT_EQ(seen(3, damped_piece(), 300, 30, Space::shadow), seen(1, damped_piece(), 300, 30));
  for (const char* joints : {"intrinsic", "extrinsic"})
    EXPECT_EQ(seen(3, impact(joints), 300, 30, Space::shadow), seen(1, impact(joints), 300, 30))
        << joints;
}

}  // namespace
}  // namespace breccia
