// Scenes that ranks build part by part: the same model, and the same bits, as one rank builds.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/tiles.hpp"
#include "dem/observe.hpp"
#include "domain/simulated_ranks.hpp"
#include "fdem/observe.hpp"

namespace breccia {
namespace benchmark_tiles_test {

/// The hash after some steps, of the parts of all ranks together.
template <class World>
std::uint64_t hash_after(World& w, int steps, Communicator* ranks) {
  for (int i = 0; i < steps; ++i) step(w);
  auto hash = static_cast<std::int64_t>(state_hash(w));
  if (ranks != nullptr) ranks->add_up({&hash, 1});
  return static_cast<std::uint64_t>(hash);
}

template <class Make>
std::uint64_t on_ranks(int count, int steps, const Make& make) {
  std::uint64_t hash = 0;
  simulate_ranks(count, 5, [&](Communicator& ranks) {
    auto w = make(&ranks);
    EXPECT_GT(w.domain.counts.ghosts, 0) << "borders lie between tiles";
    const std::uint64_t own = hash_after(w, steps, &ranks);
    if (ranks.rank() == 0) hash = own;
  });
  return hash;
}

TEST(TiledSlabs, move_alike_on_any_number_of_ranks) {
  dem::Config small = slab_scene(0.4);
  small.bodies[2].center.z = 0.163;  // the rock meets the slab within the steps
  const auto make = [&](Communicator* ranks) { return tiled_slabs(small, 3, ranks, Exec{}); };
  dem::World alone = make(nullptr);
  const std::uint64_t hash = hash_after(alone, 120, nullptr);
  EXPECT_GT(dem::count(alone).touching, 0);
  for (const int ranks : {2, 4}) EXPECT_EQ(on_ranks(ranks, 120, make), hash) << ranks;
}

constexpr PlateTiles four{2, 2, 400};

TEST(TiledPlate, moves_alike_on_any_number_of_ranks) {
  const auto make = [](Communicator* ranks) { return tiled_plate(four, ranks, Exec{}); };
  fdem::World alone = make(nullptr);
  const std::uint64_t hash = hash_after(alone, 400, nullptr);
  const auto opened = alone.exposed.vertex.host();  // marks of damage go to all ranks
  EXPECT_GT(std::count(opened.begin(), opened.end(), 1), 100);
  EXPECT_GT(alone.couples.size(), 100);
  for (const int ranks : {2, 3, 5}) EXPECT_EQ(on_ranks(ranks, 400, make), hash) << ranks;
}

TEST(TiledPlate, is_whole_across_the_sides_of_tiles) {
  const fdem::World w = tiled_plate(four, nullptr, Exec{});
  std::vector<std::uint8_t> rim(w.given->open_vertex.size(), 0);
  Index joined = 0;
  for (std::size_t edge = 0; edge < w.across.size(); ++edge) {
    const std::size_t next = edge / 3 * 3 + (edge + 1) % 3;
    if (w.across[edge] < 0)
      rim[static_cast<std::size_t>(w.vertex[edge])] =
          rim[static_cast<std::size_t>(w.vertex[next])] = 1;
    else
      ++joined;
  }
  EXPECT_EQ(rim, w.given->open_vertex);
  for (const Index t : w.reach.element.host()) {
    const std::size_t first = 3 * static_cast<std::size_t>(t);
    EXPECT_TRUE(std::any_of(w.vertex.begin() + first, w.vertex.begin() + first + 3,
                            [&](Index v) { return rim[static_cast<std::size_t>(v)] != 0; }))
        << "triangle " << t << " is taken to touch others";
  }
  EXPECT_EQ(w.joints.size(), joined / 2);

  // The rim is a rectangle's: no more of it than the sides are long.
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  double area = 0.0, outline = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t) {
    const auto& at = w.triangles.nodes.data()[t].at;
    area += 0.5 * cross(at[1].position - at[0].position, at[2].position - at[0].position);
    for (int k = 0; k < 3; ++k) {
      const Vec2 x = at[k].position;
      low = {std::min(low.x, x.x), std::min(low.y, x.y)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y)};
      if (w.across[static_cast<std::size_t>(3 * t + k)] < 0)
        outline += norm(at[(k + 1) % 3].position - x);
    }
  }
  EXPECT_NEAR(area, (high.x - low.x) * (high.y - low.y), 1e-12);
  EXPECT_NEAR(outline, 2.0 * (high.x - low.x + high.y - low.y), 1e-12);
}

TEST(PlateTiles, make_about_as_many_triangles_as_asked_for) {
  for (const std::int64_t triangles : {2'000, 50'000, 300'000})
    for (const int parts : {1, 2, 6}) {
      const PlateTiles tiles = plate_tiles(triangles, parts);
      const double all = static_cast<double>(tiles.triangles) * tiles.columns * tiles.rows;
      EXPECT_NEAR(all, static_cast<double>(triangles) * parts, 1e-3 * all);
    }
}

}  // namespace benchmark_tiles_test
}  // namespace breccia
