// Links at the start: those and only those that the interaction range asks for.

#include "prepare/packing/linking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "prepare/build.hpp"
#include "unit/prepare/models.hpp"

namespace breccia::dem {
namespace linking_test {

using prepare::BodyLinks;
using Pairs = std::set<std::pair<Index, Index>>;

double ratio(const Model& m, Index a, Index b) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return norm(m.position[j] - m.position[i]) / (m.radius[i] + m.radius[j]);
}

Pairs pairs_of(const Model& m, LinkKind kind) {
  Pairs pairs;
  for (const Model::Link& link : m.links)
    if (link.kind == kind) pairs.insert({link.a, link.b});
  return pairs;
}

/// By the definition, all pairs one by one.
Pairs concrete_by_definition(const Model& m, int group, double range) {
  Pairs pairs;
  for (Index a = 0; a < m.size(); ++a)
    for (Index b = a + 1; b < m.size(); ++b)
      if (m.group[static_cast<std::size_t>(a)] == group &&
          m.group[static_cast<std::size_t>(b)] == group && ratio(m, a, b) <= range)
        pairs.insert({a, b});
  return pairs;
}

Pairs interface_by_definition(const Model& m, int steel, int host, double range) {
  Pairs pairs;
  for (Index s = 0; s < m.size(); ++s) {
    if (m.group[static_cast<std::size_t>(s)] != steel) continue;
    std::vector<std::pair<double, Index>> near;
    for (Index c = 0; c < m.size(); ++c)
      if (m.group[static_cast<std::size_t>(c)] == host) near.push_back({ratio(m, s, c), c});
    std::sort(near.begin(), near.end());
    for (std::size_t k = 0; k < near.size(); ++k)
      if (k < 4 || near[k].first <= range)
        pairs.insert({std::min(s, near[k].second), std::max(s, near[k].second)});
  }
  return pairs;
}

/// Elements at random, overlapping or not, with radii up to `widest` times the least.
Model random_model(int count, double widest, std::uint64_t seed) {
  Model m;
  m.groups = {"a", "b", "bars"};
  const Random random{seed, 0};
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    m.group.push_back(static_cast<std::int16_t>(3.0 * random.uniform(n, 0)));
    m.position.push_back({random.uniform(n, 1), random.uniform(n, 2), random.uniform(n, 3)});
    const double u = random.uniform(n, 4);
    m.radius.push_back(0.02 * (1.0 + (widest - 1.0) * u * u * u * u));
    m.bar_previous.push_back(-1);
    m.bar_next.push_back(-1);
  }
  return m;
}

TEST(Linking, EqualsTheDefinitionOnRandomModels) {
  const std::vector<BodyLinks> bodies{
      {.kind = BodyLinks::Kind::range, .material = 0},
      {.kind = BodyLinks::Kind::range, .material = 1},
      {.kind = BodyLinks::Kind::bars, .material = 2, .host = 0, .interface = 3}};
  for (const double widest : {1.0, 2.0, 50.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Model m = random_model(400, widest, seed);
      LinksConfig config;
      config.range = 1.0 + 0.2 * static_cast<double>(seed);
      link_elements(m, bodies, config);
      Pairs concrete = concrete_by_definition(m, 0, config.range);
      concrete.merge(concrete_by_definition(m, 1, config.range));
      EXPECT_EQ(pairs_of(m, LinkKind::concrete), concrete);
      EXPECT_EQ(pairs_of(m, LinkKind::interface), interface_by_definition(m, 2, 0, config.range));
      EXPECT_EQ(m.interaction_range, config.range);
      for (const Model::Link& link : m.links) {
        const int p = m.group[static_cast<std::size_t>(link.a)];
        const int q = m.group[static_cast<std::size_t>(link.b)];
        EXPECT_EQ(link.material, p != q ? 3 : p);
      }
    }
  }
}

TEST(Linking, ABarWithFewConcreteElementsIsLinkedToAllOfThem) {
  Model m = random_model(0, 1.0, 1);
  for (int i = 0; i < 4; ++i) {
    m.group.push_back(i == 0 ? 2 : 0);
    m.position.push_back({static_cast<double>(i), 0.0, 0.0});
    m.radius.push_back(0.01);
    m.bar_previous.push_back(-1);
    m.bar_next.push_back(-1);
  }
  const std::vector<BodyLinks> bodies{
      {.kind = BodyLinks::Kind::range}, {}, {.kind = BodyLinks::Kind::bars, .host = 0}};
  link_elements(m, bodies, {});
  EXPECT_EQ(pairs_of(m, LinkKind::interface), (Pairs{{0, 1}, {0, 2}, {0, 3}}));
}

TEST(Linking, BarsAreBondedToTheParticlesAroundThem) {
  Config config = small_slab();
  config.materials[0].law = "ldpm";
  config.bodies[0].pack.count = 0;
  const Model m = build_model(config, "");
  EXPECT_EQ(pairs_of(m, LinkKind::interface), interface_by_definition(m, 1, 0, 1.4));
  EXPECT_EQ(pairs_of(m, LinkKind::steel).size(), 8u * 7u);
  EXPECT_FALSE(m.facets.empty());
}

TEST(Linking, LinksAreUniqueOrderedAndBetweenTheRightElements) {
  Config config = small_slab();
  config.bodies.push_back(sphere_body("rock", {0.0, 0.0, 0.09}, 0.039, 60, 0.5));
  const Model m = build_model(config, ".");
  int of_kind[link_kinds] = {};
  for (std::size_t k = 0; k < m.links.size(); ++k) {
    const Model::Link& link = m.links[k];
    ASSERT_LT(link.a, link.b);
    ASSERT_GE(link.a, 0);
    ASSERT_LT(link.b, m.size());
    if (k > 0) {
      const Model::Link& before = m.links[k - 1];
      ASSERT_TRUE(before.a < link.a || (before.a == link.a && before.b < link.b));
    }
    const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
    const std::set<int> groups{m.group[a], m.group[b]};
    switch (link.kind) {
      case LinkKind::concrete:
        EXPECT_TRUE(groups == std::set<int>{0} || groups == std::set<int>{2});
        EXPECT_EQ(link.material, 0);
        break;
      case LinkKind::steel:
        EXPECT_EQ(groups, std::set<int>{1});
        EXPECT_TRUE(m.bar_next[a] == link.b || m.bar_next[b] == link.a);
        EXPECT_EQ(link.material, 1);
        break;
      case LinkKind::parallel:
      case LinkKind::ldpm:
        ADD_FAILURE() << "no body of the case has parallel bonds or facets";
        break;
      case LinkKind::interface:
        EXPECT_EQ(groups, (std::set<int>{0, 1}));
        EXPECT_EQ(link.material, 2);
        break;
    }
    ++of_kind[static_cast<int>(link.kind)];
  }
  EXPECT_EQ(of_kind[static_cast<int>(LinkKind::steel)], 8 * 7);  // 8 bars of 7 links
  EXPECT_GE(of_kind[static_cast<int>(LinkKind::interface)], 4 * 64);
}

TEST(Linking, ElementsOfAConcreteBodyThatOverlapAreLinked) {
  Config config = case_with_materials();
  config.bodies = {box_body("dense", {0.1, 0.1, 0.1}, 500, 0.64)};
  config.links.range = 1.0;
  const Model m = build_model(config, ".");
  const Pairs touching = concrete_by_definition(m, 0, 1.0);
  EXPECT_GT(touching.size(), 500U);
  EXPECT_EQ(pairs_of(m, LinkKind::concrete), touching);
}

TEST(Linking, TheRangeIsSolvedForTheNumberOfLinks) {
  Config config = small_slab();
  for (const int wanted : {3000, 5000, 9000, 30000}) {
    config.links.count = wanted;
    const Model m = build_model(config, ".");
    EXPECT_NEAR(static_cast<double>(m.links.size()), wanted, 1.0);
    EXPECT_GE(m.interaction_range, 1.0);
    // The range alone gives the same links again.
    Config again = config;
    again.links.count = 0;
    again.links.range = m.interaction_range;
    EXPECT_EQ(build_model(again, ".").links.size(), m.links.size());
  }
}

TEST(Linking, LinksPerElementAreTwiceTheLinksOverTheElements) {
  Config config = small_slab();
  config.links.per_element = 11.1;
  const Model m = build_model(config, ".");
  EXPECT_NEAR(2.0 * static_cast<double>(m.links.size()) / m.size(), 11.1, 0.01);
}

TEST(Linking, ANumberOfLinksThatNoRangeGivesIsRefused) {
  Config config = small_slab();
  config.links.count = 100;  // fewer than bars need
  EXPECT_THROW(build_model(config, "."), InputError);
  config.links.count = 900 * 899 / 2;
  EXPECT_THROW(build_model(config, "."), InputError);
}

}  // namespace linking_test
}  // namespace breccia::dem
