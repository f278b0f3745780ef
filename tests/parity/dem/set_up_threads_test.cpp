// Models and worlds of spheres are made by threads: any number of them gives the same bytes.

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>

#include "bench/scenes.hpp"
#include "dem/observe.hpp"
#include "dem/setup/model_arrays.hpp"
#include "dem/world.hpp"
#include "prepare/build.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia {
namespace set_up_threads_test {

Exec on(int threads) {
  Exec exec;
  exec.threads = threads;
  return exec;
}

/// Two bodies of concrete in several classes of strength, bars across one, a file-free ball, held
/// and pushed edges; more elements and links than one thread takes at a time.
dem::Config scene() {
  dem::Config config = slab_scene(0.9);
  config.materials.push_back(config.materials[2]);
  config.materials.back().name = "weaker";
  config.materials.back().tensile_strength *= 0.5;
  config.materials[2].fabric = "faces";
  config.bodies[2].material = "weaker";
  config.supports[1].fix = {"x", "spin_y"};
  config.supports[2].fix = {"y"};
  config.supports[2].velocity = {0.0, 0.1, 0.0};
  return config;
}

const dem::Model& model_of(int threads) {
  static std::map<int, dem::Model> made;
  const auto [place, is_new] = made.try_emplace(threads);
  if (is_new) place->second = build_model(scene(), "", on(threads));
  return place->second;
}

TEST(SetUpThreads, BuildTheSameModel) {
  const dem::Model& one = model_of(1);
  std::vector<std::string> bytes;
  dem::each_element_array(one, [&](const char*, const auto& items) {
    bytes.emplace_back(reinterpret_cast<const char*>(items.data()),
                       items.size() * sizeof(items[0]));
  });
  for (const int threads : {3, 8}) {
    const dem::Model& several = model_of(threads);
    EXPECT_EQ(several.interaction_range, one.interaction_range);
    auto expected = bytes.begin();
    dem::each_element_array(several, [&](const char* name, const auto& items) {
      ASSERT_EQ(items.size() * sizeof(items[0]), expected->size()) << name;
      EXPECT_EQ(std::memcmp(items.data(), expected->data(), expected->size()), 0) << name;
      ++expected;
    });
    ASSERT_EQ(several.links.size(), one.links.size());
    for (std::size_t i = 0; i < one.links.size(); ++i) {
      const dem::Model::Link &p = one.links[i], &q = several.links[i];
      ASSERT_TRUE(p.a == q.a && p.b == q.b && p.kind == q.kind && p.material == q.material &&
                  p.share == q.share && p.strength == q.strength)
          << i;
    }
  }
}

/// The bytes of every array of a world on the host.
std::vector<std::string> bytes_of(dem::World& w) {
  std::vector<std::string> all;
  const auto add = [&all](const auto& array) {
    all.emplace_back(reinterpret_cast<const char*>(array.data()),
                     at(array.size()) * sizeof(*array.data()));
  };
  w.each_kept([&](auto& array) {
    if constexpr (requires { array.items(); })
      add(array.items());
    else
      add(array);
  });
  add(w.bar_incidence.starts);
  add(w.bar_incidence.entries);
  add(w.contact_incidence.starts);
  add(w.contact_incidence.entries);
  for (const auto& group : w.concrete.groups) add(group.starts);
  for (const auto& set : w.given->sets) add(set.members);
  return all;
}

TEST(SetUpThreads, MakeTheSameWorld) {
  dem::World one = dem::make_world(scene(), model_of(1), on(1));
  EXPECT_GT(one.concrete.groups.size(), 3U);
  EXPECT_GT(one.interface.size(), 1000);
  EXPECT_GT(one.contacts.size(), 50);
  const std::vector<std::string> expected = bytes_of(one);
  for (const int threads : {2, 3, 8}) {
    dem::World several = dem::make_world(scene(), model_of(1), on(threads));
    const std::vector<std::string> found = bytes_of(several);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_TRUE(found[k] == expected[k]) << "array " << k << ", " << threads << " threads";
    EXPECT_EQ(several.given->contact_step, one.given->contact_step);
    EXPECT_EQ(several.given->largest_margin, one.given->largest_margin);
    EXPECT_EQ(several.link_plan.tiles, one.link_plan.tiles);
    EXPECT_EQ(several.link_plan.reach, one.link_plan.reach);
    EXPECT_EQ(several.ledger.start, one.ledger.start);
    EXPECT_EQ(dem::state_hash(several), dem::state_hash(one)) << threads;
  }
}

TEST(SetUpThreads, CutTheSameBodyFromARepeatedCell) {
  dem::Config config = scene();
  config.bodies.resize(1);
  config.supports.clear();
  config.links = {};
  config.bodies[0].size = {1.6, 1.6, 0.1};
  config.bodies[0].pack.count = 24'000;
  config.bodies[0].pack.periodic = {"x", "y"};
  config.bodies[0].pack.cell = {0.4, 0.4, 0.0};
  const dem::Model one = build_model(config, "", on(1)), several = build_model(config, "", on(5));
  EXPECT_GT(one.size(), 20'000);
  ASSERT_EQ(one.size(), several.size());
  ASSERT_EQ(one.links.size(), several.links.size());
  EXPECT_EQ(
      std::memcmp(one.position.data(), several.position.data(), at(one.size()) * sizeof(Vec3)), 0);
  EXPECT_EQ(one.mass, several.mass);
  for (std::size_t i = 0; i < one.links.size(); ++i)
    ASSERT_TRUE(one.links[i].a == several.links[i].a && one.links[i].b == several.links[i].b) << i;
}

TEST(SetUpThreads, PackTheSameSpheres) {
  for (const bool periodic : {false, true}) {
    prepare::PackingTask task;
    task.container.size = {0.3, 0.2, 0.1};
    task.count = 3000;
    task.solid_volume = 0.6 * task.container.volume();
    task.random = {7, 0};
    task.periodic = {periodic, periodic, false};
    const prepare::Packing one = prepare::pack(task), several = prepare::pack(task, 4);
    EXPECT_EQ(one.iterations, several.iterations);
    EXPECT_EQ(one.overlap, several.overlap);
    EXPECT_EQ(one.radius, several.radius);
    ASSERT_EQ(one.position.size(), several.position.size());
    EXPECT_EQ(std::memcmp(one.position.data(), several.position.data(),
                          one.position.size() * sizeof(Vec3)),
              0)
        << periodic;
  }
}

}  // namespace set_up_threads_test
}  // namespace breccia
