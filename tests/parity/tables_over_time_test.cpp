// Tables over time drive supports, walls and loads: closed answers, and the same bits by loops, by
// a device's schedule and on ranks.

#include <gtest/gtest.h>

#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "fdem/ranks.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace tables_over_time_test {

/// Up and down again: 0 at 0, 1 at a, 0 at 3 a.
template <class Value>
OverTime<Value> hat(double a, const Value& top) {
  OverTime<Value> table;
  table.times = {0.0, a, 3.0 * a};
  table.values = {Value{}, top, Value{}};
  return table;
}

constexpr double peak = 2e-5;  ///< when tables are at their top  [s]

/// A held sphere that follows a table, joined to a free one that a moving wall meets.
dem::testing::Scene pushed_pair() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  s.sphere({0.0, 0.0, 0.0}, 0.01);
  s.sphere({0.0201, 0.0, 0.0}, 0.01);
  s.link(0, 1);
  dem::SupportConfig grip;
  grip.name = "grip";
  grip.max.x = 0.01;
  grip.velocity = hat<Vec3>(peak, {0.3, -0.2, 0.1});
  s.config.supports = {grip};
  s.wall({0.0303, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  s.config.walls[0].velocity = hat<Vec3>(peak, {-8.0, 0.5, 0.0});
  s.config.time.max_step = 2e-7;
  s.config.time.end = 1.0;
  return s;
}

template <class World>
void run_on(World& w, double end) {
  while (w.time < end) advance(w, {end, 1'000'000});
}

TEST(TablesOverTime, move_a_support_and_a_wall_by_their_integral) {
  dem::World w = pushed_pair().world();
  run_on(w, 5.0 * peak);
  const double area = 1.5 * peak;  // of the hat; steps are short beside it
  const Vec3 x = dem::testing::state(w, 0).position;
  EXPECT_NEAR(x.x, 0.3 * area, 1e-3 * 0.3 * area);
  EXPECT_NEAR(x.y, -0.2 * area, 1e-3 * 0.2 * area);
  EXPECT_NEAR(x.z, 0.1 * area, 1e-3 * 0.1 * area);
  EXPECT_EQ(norm(dem::testing::state(w, 0).velocity), 0.0);
  EXPECT_NEAR(w.walls[0].point.x, 0.0303 - 8.0 * area, 1e-3 * 8.0 * area);
  EXPECT_EQ(norm(w.walls[0].velocity), 0.0);
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.work, 0.0);
  EXPECT_LT(e.error_relative, 2e-2);
}

TEST(TablesOverTime, drive_elements_by_a_devices_schedule_and_on_ranks_alike) {
  const dem::testing::Scene s = pushed_pair();
  dem::World host = s.world();
  run_on(host, 5.0 * peak);
  Exec exec;
  exec.space = Space::shadow;
  dem::World shadow = make_world(s.config, s.model, exec);
  run_on(shadow, 5.0 * peak);
  EXPECT_EQ(state_hash(shadow), state_hash(host));
  EXPECT_EQ(norm(shadow.walls[0].point - host.walls[0].point), 0.0);
  simulate_ranks(2, 5, [&](Communicator& ranks) {
    dem::World whole = make_world(s.config, s.model, {});
    dem::World part = share_out(whole, ranks, {}, Space::shadow);
    run_on(part, 5.0 * peak);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), state_hash(host));
  });
}

/// A block that is pushed by a table of a load, or by the table of factors that says the same.
fdem::testing::Scene pushed_block(const char* kind, bool by_factors) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(1e8);
  s.body("block", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.1}}, 0.05));
  fdem::LoadConfig& l = s.load("load", kind, {-far, -far}, {-0.0999, far});
  const Vec2 top{100.0, -40.0};
  if (by_factors) {
    l.history.times = {0.0, 1e-3, 3e-3};
    l.history.factors = {0.0, 1.0, 0.0};
    l.force = top;
    l.traction = 10.0 * top;
    l.pressure = 1000.0;
  } else {
    l.force = hat<Vec2>(1e-3, top);
    l.traction = hat<Vec2>(1e-3, 10.0 * top);
    l.pressure = hat<double>(1e-3, 1000.0);
  }
  return s;
}

TEST(TablesOverTime, load_a_block_as_factors_do_and_give_it_their_impulse) {
  for (const char* kind : {"force", "traction", "pressure"}) {
    fdem::World w = pushed_block(kind, false).world(), same = pushed_block(kind, true).world();
    run_on(w, 5e-3);
    run_on(same, 5e-3);
    const auto push = [](const fdem::World& of) { return fdem::testing::momentum(of).linear; };
    EXPECT_LT(norm(push(w) - push(same)), 1e-9 * norm(push(same))) << kind;
    if (kind[0] != 'f') continue;
    EXPECT_NEAR(push(w).x, 100.0 * 1.5e-3, 1e-3 * 0.15);
    EXPECT_NEAR(push(w).y, -40.0 * 1.5e-3, 1e-3 * 0.06);
  }
}

TEST(TablesOverTime, drive_triangles_by_a_devices_schedule_and_on_ranks_alike) {
  fdem::testing::Scene s = pushed_block("traction", false);
  fdem::SupportConfig& grip = s.support("grip", {0.0999, -1.0}, {1.0, 1.0}, {"x", "y"});
  grip.velocity = hat<Vec2>(1.3e-3, {0.02, 0.05});
  fdem::World host = s.world();
  run_on(host, 4e-3);
  Exec exec;
  exec.space = Space::shadow;
  fdem::World shadow = make_world(s.config, s.model, exec);
  run_on(shadow, 4e-3);
  EXPECT_EQ(state_hash(shadow), state_hash(host));
  EXPECT_NEAR(fdem::testing::value(host, "grip", "position_y"), 0.05 * 1.5 * 1.3e-3, 1e-6);
  simulate_ranks(2, 5, [&](Communicator& ranks) {
    fdem::World whole = make_world(s.config, s.model, {});
    fdem::World part = share_out(whole, ranks, {}, Space::host);
    run_on(part, 4e-3);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), state_hash(host));
  });
}

}  // namespace tables_over_time_test
}  // namespace breccia
