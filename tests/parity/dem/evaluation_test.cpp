// Steps between two evaluations of the critical step leave stiffnesses out: in every way in which a
// run is carried out, forces stay what they are, and steps change at evaluations alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "dem/tiles/tile_run.hpp"
#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace evaluation_test {

constexpr int every = 7, steps = 420;

/// Spheres of unlike size that fly apart until most links have broken, so that the critical step
/// grows, and falls where others meet.
const testing::Scene& burst() {
  static const testing::Scene scene = [] {
    testing::Scene s;
    MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2400.0);
    m.tensile_strength = 3e6;
    m.cohesion = 6e6;
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) {
          const auto place = [&](int at) { return 0.02 * at + 0.004 * number(random); };
          const double x = place(i), y = place(j), z = place(k);
          s.sphere({x, y, z}, 0.006 + 0.006 * number(random), 60.0 * Vec3{x, y, z});
        }
    for (Index a = 0; a < s.model.size(); ++a)
      for (Index b = a + 1; b < s.model.size(); ++b) {
        const auto p = static_cast<std::size_t>(a), q = static_cast<std::size_t>(b);
        const double distance = norm(s.model.position[q] - s.model.position[p]);
        if (distance < 1.4 * (s.model.radius[p] + s.model.radius[q])) s.link(a, b);
      }
    return s;
  }();
  return scene;
}
World world(const Exec& exec = {}, int evaluate_every = every, double max_step = 1.0) {
  Config config = burst().config;
  config.time.evaluate_every = evaluate_every;
  config.time.max_step = max_step;
  return make_world(config, burst().model, exec);
}
World to_end(World w) {
  while (w.step < steps) advance(w, {1e300, steps});
  return w;
}

TEST(Evaluation, changes_the_step_at_its_own_moments_alone) {
  World w = world();
  std::set<double> seen;
  bool fell = false;
  for (int i = 0; i < steps; ++i) {
    const double before = w.next_dt;
    step(w);
    if (w.next_dt == before) continue;
    EXPECT_EQ(i % every, 0) << i;
    fell = fell || w.next_dt < before;
    seen.insert(w.next_dt);
  }
  EXPECT_GT(seen.size(), 10U);
  EXPECT_TRUE(fell);
  EXPECT_GT(count(w).broken_of(LinkKind::concrete), w.concrete.size() / 2);
}

TEST(Evaluation, does_not_change_forces) {
  const double short_step = 0.2 * world().next_dt;
  const World one = to_end(world({}, 1, short_step));
  EXPECT_EQ(one.next_dt, short_step);
  EXPECT_EQ(state_hash(to_end(world({}, every, short_step))), state_hash(one));
}

TEST(Evaluation, gives_the_same_bits_however_steps_are_carried_out) {
  for (const Precision precision : {Precision::full, Precision::mixed, Precision::single}) {
    Exec exec;
    exec.precision = precision;
    const World host = to_end(world(exec));
    const auto expect_same = [&](const World& w, const char* what) {
      EXPECT_EQ(w.step, steps);
      EXPECT_EQ(w.time, host.time) << what << ' ' << word_of(precision);
      EXPECT_EQ(w.next_dt, host.next_dt) << what;
      EXPECT_EQ(state_hash(w), state_hash(host)) << what << ' ' << word_of(precision);
    };
    for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight}) {
      World w = world(exec);
      w.lanes = std::min(lanes, widest_lanes());
      expect_same(to_end(std::move(w)), "packs");
    }
    Exec three = exec, launches = exec;
    three.threads = 3;
    expect_same(to_end(world(three)), "threads");
    launches.space = Space::shadow;
    expect_same(to_end(world(launches)), "launches");
    Exec tiles = launches;
    tiles.tiles = 5;
    World w = world(tiles);
    ASSERT_TRUE(runs_by_tiles(w));
    while (w.step < steps) advance(w, {1e300, std::min<std::int64_t>(steps, w.step + 33)});
    expect_same(w, "tiles");
  }
}

TEST(Evaluation, gives_the_same_bits_on_ranks) {
  const World alone = to_end(world());
  for (const Space space : {Space::host, Space::shadow})
    simulate_ranks(3, 60, [&](Communicator& ranks) {
      World whole = world();
      World part = share_out(whole, ranks, {}, space);
      for (int i = 0; i < steps; ++i) advance(part, {1e300, i + 1});
      collect(part, whole);
      if (ranks.rank() != 0) return;
      EXPECT_EQ(state_hash(whole), state_hash(alone)) << static_cast<int>(space);
      EXPECT_EQ(whole.time, alone.time);
    });
}

}  // namespace evaluation_test
}  // namespace breccia::dem
