#include "core/travel.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "exec/error.hpp"
#include "unit/core/scenes.hpp"

namespace breccia {
namespace travel_test {

using scenes::buffer_of;
using scenes::RandomStream;

struct Spheres {
  std::vector<Vec3> centre, velocity;
  std::vector<double> radius;
  std::vector<GlobalId> ids;

  void add(const Vec3& at, const Vec3& speed, double size) {
    centre.push_back(at);
    velocity.push_back(speed);
    radius.push_back(size);
    ids.push_back(static_cast<GlobalId>(ids.size()));
  }
};

std::set<PairKey> touching(const Spheres& spheres) {
  std::set<PairKey> pairs;
  for (std::size_t i = 0; i < spheres.centre.size(); ++i)
    for (std::size_t j = i + 1; j < spheres.centre.size(); ++j)
      if (norm(spheres.centre[i] - spheres.centre[j]) <= spheres.radius[i] + spheres.radius[j])
        pairs.insert(pair_key(spheres.ids[i], spheres.ids[j]));
  return pairs;
}

/// A list of pairs and the travel since it was found.
struct Search {
  Travel travel;
  std::set<PairKey> keys;

  explicit Search(const Spheres& spheres, const MarginRule& rule) {
    Buffer<Box> boxes;
    Pairs pairs;
    BroadPhase broad_phase;
    const Buffer<Vec3> centre = buffer_of(spheres.centre);
    begin_travel({}, rule, centre, buffer_of(spheres.velocity), travel);
    sphere_boxes({}, centre, buffer_of(spheres.radius), travel.margin, boxes);
    broad_phase.search({}, boxes, buffer_of(spheres.ids), pairs);
    for (const PairKey key : pairs.key.host()) keys.insert(key);
  }
  bool valid(const Spheres& spheres) const {
    for (std::size_t i = 0; i < spheres.centre.size(); ++i)
      if (!(norm(spheres.centre[i] - travel.reference.host()[i]) <= travel.margin.host()[i]))
        return false;
    return true;
  }
};

TEST(Travel, NeverMissesATouchingPairWhileNoElementLeftItsMargin) {
  int searches = 0, steps = 0, touched = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed);
    const MarginRule rule{.base = random.uniform(0.0, 0.2), .horizon = 5.0, .largest = 0.6};
    Spheres spheres;
    for (int i = 0; i < 60; ++i) {
      const double speed = i % 10 == 0 ? 0.2 : 0.02;  // some fly fast
      spheres.add(random.inside(2.0), random.inside(speed), random.uniform(0.1, 0.3));
    }
    Search search(spheres, rule);
    for (int step = 0; step < 60; ++step) {
      for (std::size_t i = 0; i < spheres.centre.size(); ++i) {
        spheres.velocity[i] += random.inside(0.005);
        spheres.centre[i] += spheres.velocity[i];
      }
      ++steps;
      if (!search.valid(spheres)) {
        search = Search(spheres, rule);
        ++searches;
      }
      for (const PairKey key : touching(spheres)) {
        ++touched;
        ASSERT_TRUE(search.keys.count(key) == 1) << "seed " << seed << ", step " << step;
      }
    }
  }
  EXPECT_LT(searches, steps);
  EXPECT_GT(touched, 1000);
}

TEST(Travel, ListsTwoElementsThatMeetAfterOneMarginEach) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    RandomStream random(seed);
    const double margin = random.uniform(0.01, 1.0);
    const MarginRule rule{.base = 2.0 * margin, .horizon = 0.0, .largest = 10.0};
    Vec3 axis = random.inside(1.0);
    axis = (1.0 / norm(axis)) * axis;
    if (seed % 4 == 0) axis = {1.0, 0.0, 0.0};
    const double r = random.uniform(0.1, 1.0), s = random.uniform(0.1, 1.0);
    const Vec3 from = random.inside(seed % 3 == 0 ? 1e6 : 1.0);
    Spheres spheres;
    spheres.add(from, {}, r);
    spheres.add(from + (r + s + 2.0 * margin) * axis, {}, s);
    const Search search(spheres, rule);
    const double step = margin * (1.0 - 1e-9) - 1e-9;
    spheres.centre[0] += step * axis;
    spheres.centre[1] -= step * axis;
    ASSERT_TRUE(search.valid(spheres)) << "seed " << seed;
    ASSERT_EQ(search.keys.size(), 1u) << "seed " << seed;
  }
}

TEST(Travel, EndsWhenOneElementPassesItsOwnMarginOnly) {
  Spheres spheres;
  spheres.add({0.0, 0.0, 0.0}, {}, 0.1);
  spheres.add({5.0, 0.0, 0.0}, {0.0, 4.0, 3.0}, 0.1);
  spheres.add({9.0, 0.0, 0.0}, {0.0, 4.0e3, 0.0}, 0.1);
  const MarginRule rule{.base = 0.02, .horizon = 0.01, .largest = 0.5};
  const Search search(spheres, rule);
  EXPECT_DOUBLE_EQ(search.travel.margin.data()[0], 0.01);         // base / 2
  EXPECT_DOUBLE_EQ(search.travel.margin.data()[1], 0.01 + 0.05);  // + 5 m/s x 0.01 s
  EXPECT_DOUBLE_EQ(search.travel.margin.data()[2], 0.5);          // the largest allowed
  spheres.centre[1].z += 0.0599;
  spheres.centre[2].y += 0.499;
  EXPECT_TRUE(search.valid(spheres));
  spheres.centre[0].x += 0.0101;
  EXPECT_FALSE(search.valid(spheres));
}

}  // namespace travel_test
}  // namespace breccia
