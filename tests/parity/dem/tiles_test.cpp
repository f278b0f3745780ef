// Steps by tiles, each in the memory of a multiprocessor, carried out by the processor: the bits of
// the host.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "dem/tiles/tile_plan.hpp"
#include "dem/tiles/tile_run.hpp"
#include "exec/error.hpp"
#include "paths.hpp"
#include "physics/dem/scene.hpp"
#include "prepare/build.hpp"
#include "run/case_keys.hpp"
#include "run/method/audited_method.hpp"
#include "run/method/dem_method.hpp"

namespace breccia::dem {
namespace tiles_test {

const std::string small_case = std::string(source_dir) + "/cases/rc_slab/small.toml";

/// Concrete, bars, bonds, and an impactor that comes to touch what it breaks.
World small_slab(Index tiles, int threads = 1, Precision precision = Precision::full,
                 bool of_library = false) {
  const auto read = [](const std::vector<std::string>& keys) {
    return read_case<Config>(small_case, keys);
  };
  const auto model_of = [](const Config& config) {
    return build_model(config, std::string(source_dir) + "/cases/rc_slab");
  };
  static const Config given = read({}), library = read({"material.c30.use=C30"});
  static const Model model_given = model_of(given), model_library = model_of(library);
  const Config& config = of_library ? library : given;
  const Model& model = of_library ? model_library : model_given;
  Exec exec;
  exec.threads = threads;
  exec.precision = precision;
  if (tiles != 0) exec.space = Space::shadow;
  exec.tiles = tiles;
  return make_world(config, model, exec);
}
/// As many steps as the impact needs to break links, some at a time.
void run(World& w, std::int64_t at_once, std::int64_t steps) {
  while (w.step < steps) advance(w, {1e300, std::min(steps, w.step + at_once)});
}

/// Lists that other runs of steps and output read.
void same_contacts(const World& w, const World& host) {
  const auto same = [](const auto& one, const auto& other, const char* what) {
    std::vector<std::decay_t<decltype(*one.data())>> a, b;
    copy_to(a, one);
    copy_to(b, other);
    ASSERT_EQ(a.size(), b.size()) << what;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0) << what;
  };
  same(w.contacts.pairs.key, host.contacts.pairs.key, "key");
  same(w.contacts.pairs.a, host.contacts.pairs.a, "a");
  same(w.contacts.pairs.b, host.contacts.pairs.b, "b");
  same(w.contacts.history.slid, host.contacts.history.slid, "slid");
  same(w.contacts.history.damped, host.contacts.history.damped, "damped");
  same(w.contact_incidence.starts, host.contact_incidence.starts, "first entries");
  same(w.contact_incidence.entries, host.contact_incidence.entries, "entries");
  same(w.travel.margin, host.travel.margin, "margins");
}

TEST(Tiles, are_shared_out_alike_by_any_number_of_threads) {
  constexpr Index count = 37;
  const World w = small_slab(count);
  const auto one = share_out_to_tiles(w, count);
  ASSERT_NE(one, nullptr);
  std::vector<Index> number(one->own);  // each element is some tile's own, once
  std::sort(number.begin(), number.end());
  for (Index e = 0; e < w.elements.size(); ++e) ASSERT_EQ(number[at(e)], e);
  const auto bytes = [](const auto& items) {
    std::vector<std::decay_t<decltype(*items.data())>> here;
    copy_to(here, items);
    return std::string(reinterpret_cast<const char*>(here.data()), here.size() * sizeof here[0]);
  };
  for (const int threads : {2, 7, 64}) {
    const auto several = share_out_to_tiles(small_slab(count, threads), count);
    ASSERT_NE(several, nullptr);
    EXPECT_EQ(several->tile_of, one->tile_of) << threads;
    EXPECT_EQ(several->linked, one->linked) << threads;
    EXPECT_EQ(bytes(several->links), bytes(one->links)) << threads;
    EXPECT_EQ(bytes(several->rows), bytes(one->rows)) << threads;
  }
}

void end_with_the_bits_of_the_host(Precision precision, bool of_library = false) {
  SCOPED_TRACE(word_of(precision));
  World host = small_slab(0, 1, precision, of_library);
  const std::int64_t steps = of_library ? 420 : 200;
  run(host, steps, steps);
  EXPECT_GT(count(host).broken_of(LinkKind::concrete), 100);
  EXPECT_GT(host.searches, 2);
  const EnergyBalance energy = balance(host);
  for (const Index tiles : {6, 40}) {
    World w = small_slab(tiles, 1, precision, of_library);
    ASSERT_TRUE(runs_by_tiles(w));
    EXPECT_EQ(static_cast<Index>(w.tiles.plan->tiles.size()), tiles);
    run(w, tiles == 6 ? 37 : steps, steps);  // leaving tiles and coming back changes nothing
    EXPECT_EQ(state_hash(w), state_hash(host)) << tiles;
    EXPECT_EQ(w.time, host.time);
    EXPECT_EQ(w.searches, host.searches);
    const EnergyBalance now = balance(w);
    EXPECT_EQ(now.elastic, energy.elastic) << tiles;
    EXPECT_EQ(now.fracture, energy.fracture) << tiles;
    EXPECT_EQ(now.plastic, energy.plastic) << tiles;
    EXPECT_EQ(now.friction, energy.friction) << tiles;
    EXPECT_EQ(now.work, energy.work) << tiles;
    EXPECT_TRUE(w.tiles.plan->found_there) << "tiles have searched themselves";
    same_contacts(w, host);
  }
}
TEST(Tiles, end_with_the_bits_of_the_host) {
  end_with_the_bits_of_the_host(Precision::full);
}
/// A hyperbola, a knee, bounds of friction, and a law for each class of links of its fabric.
TEST(Tiles, end_with_the_bits_of_the_host_for_concrete_of_the_library) {
  EXPECT_GT(small_slab(0, 1, Precision::full, true).concrete.groups.size(), 16U);
  end_with_the_bits_of_the_host(Precision::single, true);
}
TEST(Tiles, end_with_the_bits_of_the_host_in_mixed_precision) {
  end_with_the_bits_of_the_host(Precision::mixed);
}
TEST(Tiles, end_with_the_bits_of_the_host_in_single_precision) {
  end_with_the_bits_of_the_host(Precision::single);
}

/// Where their memory does not hold all, tiles keep constants of links outside, each for itself.
void keep_constants_outside(Precision precision) {
  SCOPED_TRACE(word_of(precision));
  constexpr Index tiles = 40;
  constexpr std::int64_t steps = 200;
  const auto some_are_outside = [](const std::vector<Tile>& all) {
    const auto outside = std::count_if(all.begin(), all.end(),
                                       [](const Tile& tile) { return tile.constants_outside; });
    return outside > 0 && outside < tiles;
  };
  World host = small_slab(0, 1, precision), w = small_slab(tiles, 1, precision);
  run(host, steps, steps);
  ASSERT_TRUE(runs_by_tiles(w));
  ASSERT_FALSE(some_are_outside(w.tiles.plan->tiles));
  const std::size_t room = w.tiles.plan->bytes / 34 * 33;
  w = small_slab(tiles, 1, precision);
  w.tiles.memory = room;
  ASSERT_TRUE(runs_by_tiles(w));
  EXPECT_TRUE(some_are_outside(w.tiles.plan->tiles));
  run(w, 37, steps);
  EXPECT_TRUE(runs_by_tiles(w));
  ASSERT_TRUE(w.tiles.plan->found_there);
  std::vector<Tile> found(tiles);
  copy_bytes(found.data(), Space::host, w.tiles.plan->searches.tiles.data(), Space::shadow,
             found.size() * sizeof(Tile));
  EXPECT_TRUE(some_are_outside(found));
  EXPECT_EQ(state_hash(w), state_hash(host));
  EXPECT_EQ(w.searches, host.searches);
  same_contacts(w, host);
}
TEST(Tiles, keep_constants_outside_where_their_memory_does_not_hold_them) {
  keep_constants_outside(Precision::full);
}
TEST(Tiles, keep_constants_outside_in_single_precision) {
  keep_constants_outside(Precision::single);
}

/// Once bodies at rest fall, the host must take their common motion off what they travel: tiles
/// leave in the middle of the step whose search finds that, and launches go on.
TEST(Tiles, leave_a_search_that_finds_a_drift_to_the_host) {
  testing::Scene scene;
  scene.config.gravity = {0.0, 0.0, -9.81};
  scene.material("m", "concrete", 30e9, 0.2, 2400.0);
  for (int k = 0; k < 8; ++k) {
    const Index a = scene.sphere({0.05 * k, 0.0, 0.0}, 0.01),
                b = scene.sphere({0.05 * k + 0.021, 0.0, 0.0}, 0.01);
    scene.link(a, b);
  }
  World host = make_world(scene.config, scene.model, Exec{});
  Exec exec;
  exec.space = Space::shadow;
  exec.tiles = tiles_in_any_case;
  World w = make_world(scene.config, scene.model, exec);
  ASSERT_TRUE(runs_by_tiles(w));
  const std::int64_t first = host.searches;
  while (host.searches < first + 2) step(host);
  while (w.step < host.step) advance(w, {1e300, host.step});
  EXPECT_GT(host.travel.drift.velocity.z, -1e3);
  EXPECT_NE(host.travel.drift.velocity.z, 0.0);
  EXPECT_FALSE(runs_by_tiles(w));
  EXPECT_EQ(state_hash(w), state_hash(host));
  EXPECT_EQ(w.searches, host.searches);
}

/// A step that is done twice begins from a state that was saved and loaded.
TEST(Tiles, an_audit_of_steps_on_a_device_finds_nothing_in_a_sound_run) {
  const auto config = read_case<Config>(small_case, {});
  static const Model model = build_model(config, std::string(source_dir) + "/cases/rc_slab");
  World host = small_slab(0);
  constexpr std::int64_t steps = 60;
  while (host.step < steps) advance(host, {1e300, steps});
  for (const Index tiles : {0, 6}) {
    Exec exec;
    exec.space = Space::shadow;
    exec.tiles = tiles;
    AuditConfig audit;
    audit.every = 4;
    const auto method = audited(make_method(config, model, exec), audit, 1, nullptr);
    while (method->steps() < steps) method->advance({1e300, steps});
    EXPECT_EQ(method->state_hash(), state_hash(host)) << tiles;
  }
}

TEST(Tiles, leave_walls_to_launches) {
  testing::Scene scene;
  scene.material("m", "concrete", 30e9, 0.2, 2400.0);
  const Index a = scene.sphere({0.0, 0.0, 0.02}, 0.01), b = scene.sphere({0.021, 0.0, 0.02}, 0.01);
  scene.link(a, b);
  Exec exec;
  exec.space = Space::shadow;
  exec.tiles = 2;
  World free = make_world(scene.config, scene.model, exec);
  EXPECT_TRUE(runs_by_tiles(free));
  scene.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  World walled = make_world(scene.config, scene.model, exec);
  EXPECT_FALSE(runs_by_tiles(walled));
  exec.tiles = tiles_in_any_case;
  World forced = make_world(scene.config, scene.model, exec);
  EXPECT_THROW(runs_by_tiles(forced), InputError);
}

TEST(Tiles, are_chosen_where_a_model_has_enough_links_for_them) {
  World small = small_slab(tiles_where_they_pay);
  EXPECT_FALSE(runs_by_tiles(small)) << small.links();
  World forced = small_slab(tiles_in_any_case);
  EXPECT_TRUE(runs_by_tiles(forced));
}

}  // namespace tiles_test
}  // namespace breccia::dem
