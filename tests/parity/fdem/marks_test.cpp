// Couples that are listed ahead of the marks that let them touch: fewer searches, the same bits.

#include <gtest/gtest.h>

#include "fdem_shared/couple_phase.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace marks_test {

/// A brittle disc that breaks on a plate.
fdem::World disc(int threads, Space space = Space::host) {
  fdem::testing::Scene scene;
  fdem::MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.damping = 0.02;
  m.joint.tension = 2e6;
  m.joint.cohesion = 6e6;
  m.joint.energy_open = 2.0;
  m.joint.energy_slide = 6.0;
  scene.config.time.evaluate_every = 50;
  scene.body("disc", prepare::ringed_disc({0.0, 0.0202}, 0.02, 4e-3), 0, {2.0, -20.0});
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.01}, {0.06, 0.02}}, 5e-3));
  scene.support("ground", {-1.0, -1.0}, {1.0, -0.0199}, {"y"});
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
    if (searches_each_time) w.expected_vertex.clear();
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
