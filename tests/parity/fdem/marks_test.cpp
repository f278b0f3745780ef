// Couples that are listed ahead of the marks that let them touch: fewer searches, the same bits.

#include <gtest/gtest.h>

#include "fdem_shared/couple_phase.hpp"
#include "fdem_shared/exposed.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace marks_test {

fdem::World disc(int threads, Space space = Space::host) {
  const fdem::testing::Scene scene = fdem::testing::brittle_disc(20.0);
  Exec exec;
  exec.threads = threads;
  exec.space = space;
  return fdem::make_world(scene.config, scene.model, exec);
}

struct Ended {
  std::uint64_t hash;
  std::size_t cracks;
  double contact, friction, elastic;
  std::int64_t searches;
};
/// @param searches_each_time  expects no marks, so that each of them calls for a search
template <class World>
Ended ended(World w, int steps, bool searches_each_time) {
  for (int i = 0; i < steps; ++i) {
    if (searches_each_time)
      for (Index v = 0; v < w.exposed.vertex.size(); ++v)
        w.exposed.vertex.data()[v] &= fdem_shared::vertex_damaged;
    step(w);
  }
  const EnergyBalance b = energies(w).balance;
  return {state_hash(w), cracks(w).size(), b.contact, b.friction, b.elastic, w.searches};
}
void expect_same(const Ended& ahead, const Ended& each_time) {
  EXPECT_EQ(ahead.hash, each_time.hash);
  EXPECT_EQ(ahead.contact, each_time.contact);
  EXPECT_EQ(ahead.friction, each_time.friction);
  EXPECT_EQ(ahead.elastic, each_time.elastic);
  EXPECT_GT(each_time.cracks, 20U);
  EXPECT_GT(each_time.friction, 0.0);
}

TEST(ExpectedMarks, spare_searches_of_triangles) {
  const Ended ahead = ended(disc(1), 800, false), each_time = ended(disc(1), 800, true);
  expect_same(ahead, each_time);
  EXPECT_LT(ahead.searches, each_time.searches);
}
TEST(ExpectedMarks, spare_searches_of_triangles_where_arrays_lie_in_another_space) {
  expect_same(ended(disc(1, Space::shadow), 800, false), ended(disc(1), 800, true));
}
/// Most of these searches are of joints that break.
TEST(ExpectedMarks, change_nothing_of_tetrahedra) {
  const auto cubes = [] { return fdem3::testing::meeting_cubes().world(); };
  expect_same(ended(cubes(), 420, false), ended(cubes(), 420, true));
}

/// Those that wait have no part in the step, nor in what is told of contacts.
TEST(ExpectedMarks, are_of_couples_that_wait) {
  fdem::World w = disc(1);
  Index most = 0;
  for (int i = 0; i < 800; ++i) {
    fdem::step(w);
    Index waiting = 0;
    for (Index c = 0; c < w.couples.size(); ++c) {
      if (w.couple_phase.data()[c] != fdem_shared::CouplePhase::waits) continue;
      ++waiting;
      ASSERT_EQ(w.couples.history.state.data()[c].scale, 0.0);
      for (const Vec2& f : w.couples.history.force.as<double>().data()[c].on_a.at)
        ASSERT_EQ(dot(f, f), 0.0);
    }
    most = std::max(most, waiting);
  }
  EXPECT_GT(most, 20);
}

}  // namespace marks_test
}  // namespace breccia
