// Elements change hands again and again: none is lost or doubled, and each keeps what it owns.

#include <gtest/gtest.h>

#include "core/state_hash.hpp"
#include "dem/ranks.hpp"
#include "fdem/ranks.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace migration_test {

using namespace mpi_testing;

/// In [-1, 1), by a thing and a round.
double drawn(std::int64_t thing, std::int64_t round, std::uint64_t k) {
  const auto mix =
      static_cast<std::uint64_t>(thing) * 1000003U + static_cast<std::uint64_t>(round) * 7919U + k;
  return static_cast<double>(mixed(mix * 0x9e3779b97f4a7c15ULL) >> 11) * 0x1p-52 - 1.0;
}

/// Throws the elements about in the space of the slab.
void scatter(dem::World& w, std::int64_t round) {
  for (Index e = 0; e < w.elements.size(); ++e) {
    const GlobalId id = w.elements.id.data()[e];
    w.elements.state.data()[e].position = {0.09 * drawn(id, round, 1), 0.09 * drawn(id, round, 2),
                                           0.05 * drawn(id, round, 3)};
  }
}
/// That scene with hexagons, in a space as large as their room.
void scatter(fdem::World& w, std::int64_t round) {
  for (Index t = 0; t < w.triangles.size(); ++t) {
    const GlobalId block = w.triangles.id.data()[t] / 6;
    const auto place = [&](std::int64_t when) {
      return Vec2{20.0 * drawn(block, when, 1), 20.0 * drawn(block, when, 2)};
    };
    const Vec2 shift = place(round) - place(round - 1);
    for (fdem::NodeState& node : w.triangles.nodes.data()[t].at) node.position += shift;
  }
}

const Buffer<GlobalId>& ids(const dem::World& w) {
  return w.elements.id;
}
const Buffer<GlobalId>& ids(const fdem::World& w) {
  return w.triangles.id;
}

/// All that elements own, and what ties them together, as bytes.
template <class State>
std::string bytes_of(State&& state) {
  std::string bytes;
  state.each_field([&](const char*, const char*, auto& array) {
    if constexpr (requires { array.items(); }) {
      const auto items = array.items().host();
      bytes.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
    } else {
      const auto items = array.host();
      bytes.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
    }
  });
  return bytes;
}
std::string all_bytes(dem::World& w) {
  return bytes_of(together(w.elements, w.concrete, w.steel, w.interface, w.contacts,
                           w.wall_contacts, w.travel));
}
std::string all_bytes(fdem::World& w) {
  return bytes_of(together(w.triangles, w.joints, w.couples, w.reach));
}

/// Some steps, then elements are thrown about until `moves` of them have changed hands.
template <class AScene>
void expect_all_kept(const AScene& scene, int steps, int count, std::int64_t moves) {
  auto lone = scene.world();
  for (int i = 0; i < steps; ++i) step(lone);
  const auto start = lone;
  const auto elements = static_cast<std::size_t>(ids(lone).size());
  std::int64_t rounds = 0, moved = 0;
  simulate_ranks(count, 4, [&](Communicator& ranks) {
    auto whole = start;
    auto part = share_out(whole, ranks, {});
    std::int64_t round = 0;
    std::vector<std::int64_t> seen(elements + 1, 0);
    while (seen[elements] < moves) {
      scatter(part, ++round);
      migrate(part);
      std::fill(seen.begin(), seen.end(), 0);
      for (Index e = 0; e < ids(part).size(); ++e)
        if (part.domain.owns(e)) ++seen[static_cast<std::size_t>(ids(part).data()[e])];
      seen[elements] = part.domain.counts.moved;
      ranks.add_up(seen);
      for (std::size_t id = 0; id < elements; ++id)
        ASSERT_EQ(seen[id], 1) << "element " << id << " in round " << round;
    }
    collect(part, whole);
    if (ranks.rank() != 0) return;
    rounds = round;
    moved = seen[elements];
    for (std::int64_t r = 1; r <= round; ++r) scatter(lone, r);
    EXPECT_TRUE(all_bytes(whole) == all_bytes(lone));  // no diff of bytes
    EXPECT_EQ(state_hash(whole), state_hash(lone));
  });
  EXPECT_GE(moved, moves);
  EXPECT_GT(rounds, 10);
}

TEST(Migration, a_hundred_thousand_moves_of_triangles_lose_and_double_none) {
  expect_all_kept(box(), 300, 7, 100000);
}
TEST(Migration, triangles_keep_cracked_joints_and_couples_wherever_they_go) {
  expect_all_kept(impact("intrinsic"), 200, 5, 10000);
}
TEST(Migration, twenty_thousand_moves_of_spheres_lose_and_double_none) {
  expect_all_kept(slab_piece(), 150, 5, 20000);
}

}  // namespace migration_test
}  // namespace breccia
