// Minerals and strengths inside a body: shares of the area, grain sizes, distributions.

#include "prepare/meshing/heterogeneity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "unit/prepare/fdem_scenes.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::fdem {
namespace heterogeneity_test {

double share_of(const Model& m, int material) {
  double sum = 0.0, total = 0.0;
  for (std::size_t t = 0; t < m.triangle.size(); ++t) {
    const double area = prepare::signed_area(m.point, m.triangle[t]);
    total += area;
    if (m.material[t] == material) sum += area;
  }
  return sum / total;
}

/// Granite as in Lukas et al. 2014: quartz 24 %, feldspar 68 %, biotite 8 %.
BodyConfig granite(const std::string& kind) {
  BodyConfig body = regular_plate({0.08, 0.08}, 0.001);
  body.grains.kind = kind;
  body.grains.size = 0.002;
  body.grains.minerals = {{.material = "quartz", .fraction = 0.24, .color = ""},
                          {.material = "feldspar", .fraction = 0.68, .color = ""},
                          {.material = "biotite", .fraction = 0.08, .color = ""}};
  return body;
}

TEST(Heterogeneity, MineralsHaveTheirShares) {
  for (const char* kind : {"voronoi", "random"})
    for (const std::int64_t seed : {1, 2, 3}) {
      const Model m = built({granite(kind)}, {}, seed);
      EXPECT_NEAR(share_of(m, 2), 0.24, 0.0024) << kind;
      EXPECT_NEAR(share_of(m, 3), 0.68, 0.0068) << kind;
      EXPECT_NEAR(share_of(m, 4), 0.08, 0.0008) << kind;
    }
}

TEST(Heterogeneity, GrainsKeepTrianglesTogether) {
  const auto like_neighbours = [](const Model& m) {
    int like = 0, all = 0;
    for (const auto& edge : prepare::edges_of(m.triangle))
      if (edge.triangles[1] >= 0) {
        like += m.material[static_cast<std::size_t>(edge.triangles[0])] ==
                m.material[static_cast<std::size_t>(edge.triangles[1])];
        ++all;
      }
    return static_cast<double>(like) / all;
  };
  // By chance: 0.24^2 + 0.68^2 + 0.08^2 = 0.53.
  EXPECT_NEAR(like_neighbours(built({granite("random")})), 0.53, 0.03);
  EXPECT_GT(like_neighbours(built({granite("voronoi")})), 0.80);
}

/// Rock of one mineral: what holds together without the boundaries are the grains.
TEST(Heterogeneity, BoundariesOfGrainsPartAllOfThem) {
  BodyConfig rock = granite("voronoi");
  rock.grains.minerals = {{.material = "quartz", .fraction = 1.0, .color = ""}};
  rock.mesh_size = 0.0005;
  EXPECT_TRUE(built({rock}).discontinuities.empty());
  rock.grains.boundary = "vein";
  const Model m = built({rock});
  std::map<prepare::Edge, std::int16_t> given;
  for (const auto& d : m.discontinuities) {
    EXPECT_EQ(d.material, 1);
    given[d.edge] = d.material;
  }
  std::vector<std::size_t> root(m.triangle.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  const auto edges = prepare::edges_of(m.triangle);
  const auto is_boundary = [&](const auto& edge) { return given.contains(edge.ends); };
  for (const auto& edge : edges)
    if (edge.triangles[1] >= 0 && !is_boundary(edge))
      root[find(static_cast<std::size_t>(edge.triangles[0]))] =
          find(static_cast<std::size_t>(edge.triangles[1]));
  std::map<std::size_t, double> area;
  for (std::size_t t = 0; t < m.triangle.size(); ++t)
    area[find(t)] += prepare::signed_area(m.point, m.triangle[t]);
  // 1,600 squares of edge `size` in the plate, and grains whose seeds lie beside it.
  EXPECT_GT(area.size(), 1600U);
  EXPECT_LT(area.size(), 1900U);
  double largest = 0.0;
  for (const auto& [grain, own] : area) largest = std::max(largest, own);
  EXPECT_LT(largest, 4.0 * 0.002 * 0.002);
  // No boundary lies within a grain.
  for (const auto& edge : edges)
    if (edge.triangles[1] >= 0 && is_boundary(edge)) {
      EXPECT_NE(find(static_cast<std::size_t>(edge.triangles[0])),
                find(static_cast<std::size_t>(edge.triangles[1])));
    }
}

TEST(Heterogeneity, BoundariesNeedGrainsAndAJointLaw) {
  BodyConfig rock = granite("random");
  rock.grains.boundary = "vein";
  EXPECT_NE(refusal({rock}).find("grains.boundary is between Voronoi grains; kind is random"),
            std::string::npos)
      << refusal({rock});
  rock = granite("voronoi");
  rock.grains.boundary = "seam";
  EXPECT_NE(refusal({rock}).find("grains.boundary = \"seam\" is not a joint law"),
            std::string::npos)
      << refusal({rock});
}

TEST(Heterogeneity, GrainsDependOnSeedAndPlaceOnly) {
  const std::vector<Vec2> places{{0.013, 0.02}, {-0.7, 0.3}, {0.0131, 0.0201}};
  const std::vector<Vec2> turned{places[2], places[0], places[1]};
  const auto a = prepare::voronoi_grains(places, 0.002, {7, 1}),
             b = prepare::voronoi_grains(turned, 0.002, {7, 1}),
             c = prepare::voronoi_grains(places, 0.002, {8, 1});
  EXPECT_EQ(a[0], b[1]);
  EXPECT_EQ(a[1], b[2]);
  EXPECT_EQ(a[2], b[0]);
  EXPECT_NE(a, c);
}

TEST(Heterogeneity, GrainsAreAsLargeAsAsked) {
  std::vector<Vec2> places;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) places.push_back({1e-4 * i, 1e-4 * j});
  std::map<std::uint64_t, int> count;
  for (const std::uint64_t grain : prepare::voronoi_grains(places, 0.002, {3, 0})) ++count[grain];
  // 20 x 20 squares, and those at the rim that are cut.
  EXPECT_NEAR(static_cast<double>(count.size()), 400.0, 60.0);
}

TEST(Heterogeneity, PictureGivesItsColoursToTheSamePlaces) {
  const ScratchFolder folder;
  const std::string file = "breccia_minerals.png";
  // Left half red; right half green above, blue below.
  Image image{20, 10, {}};
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) {
      const bool left = x < 10, above = y < 5;
      for (const int c : {left ? 250 : 3, !left && above ? 240 : 10, !left && !above ? 255 : 0})
        image.rgb.push_back(static_cast<std::uint8_t>(c));
    }
  write_png(folder / file, image);
  BodyConfig body = granite("picture");
  body.grains.file = file;
  body.grains.minerals[0].color = "ff0000";
  body.grains.minerals[1].color = "00ff00";
  body.grains.minerals[2].color = "0000FF";
  const Model m = built({body}, {}, 1, folder.path());
  EXPECT_NEAR(share_of(m, 2), 0.5, 0.01);
  EXPECT_NEAR(share_of(m, 3), 0.25, 0.01);
  for (std::size_t t = 0; t < m.triangle.size(); ++t) {
    const Vec2 p = prepare::centroid(m.point, m.triangle[t]);
    EXPECT_EQ(m.material[t], p.x < 0.0 ? 2 : p.y > 0.0 ? 3 : 4);
  }
  EXPECT_THROW(built({body}), IoError) << "the picture is gone";
  body.grains.minerals[0].color = "red";
  EXPECT_TRUE(mentions(refusal({body}), "color = \"red\" is no colour; needed is rrggbb"));
}

TEST(Heterogeneity, SharesMustAddUpToOne) {
  BodyConfig body = granite("random");
  body.grains.minerals[0].fraction = 0.5;
  EXPECT_TRUE(mentions(refusal({body}), "add up to 1.26; they must add up to 1"));
}

struct Moments {
  double mean, deviation;
};
Moments moments_of(const std::vector<float>& values) {
  double sum = 0.0, squares = 0.0;
  for (const float v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const float v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

TEST(Heterogeneity, WeibullFactorsHaveTheirMoments) {
  const double m = 4.0, g1 = std::tgamma(1.0 + 1.0 / m), g2 = std::tgamma(1.0 + 2.0 / m);
  const double deviation = std::sqrt(g2 / (g1 * g1) - 1.0);
  std::vector<Vec2> places;
  for (int i = 0; i < 250; ++i)
    for (int j = 0; j < 250; ++j) places.push_back({1e-3 * i, 1e-3 * j});
  const Moments alone = moments_of(prepare::weibull_factors(places, m, 0.0, {5, 0}));
  EXPECT_NEAR(alone.mean, 1.0, 0.005);
  EXPECT_NEAR(alone.deviation, deviation, 0.005);
  const Moments field = moments_of(prepare::weibull_factors(places, m, 0.003, {5, 0}));
  EXPECT_NEAR(field.mean, 1.0, 0.02);
  EXPECT_NEAR(field.deviation, deviation, 0.02);
}

TEST(Heterogeneity, CorrelationFallsTo1OverEAtItsLength) {
  const double length = 0.004;
  std::vector<Vec2> near, far, apart;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 120; ++j) {
      near.push_back({0.0031 * i, 0.0031 * j});
      far.push_back({0.0031 * i + length, 0.0031 * j});
      apart.push_back({0.0031 * i, 0.0031 * j + 3.0 * length});
    }
  // With modulus 3.6 the distribution is nearly normal, so that f follows the field.
  const auto field = [&](const std::vector<Vec2>& places) {
    return prepare::weibull_factors(places, 3.6, length, {9, 0});
  };
  const auto correlation = [](const std::vector<float>& a, const std::vector<float>& b) {
    const Moments ma = moments_of(a), mb = moments_of(b);
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - ma.mean) * (b[k] - mb.mean);
    return sum / (static_cast<double>(a.size()) * ma.deviation * mb.deviation);
  };
  EXPECT_NEAR(correlation(field(near), field(far)), std::exp(-1.0), 0.05);
  EXPECT_NEAR(correlation(field(near), field(apart)), 0.0, 0.05);
}

TEST(Heterogeneity, CorrelatedStrengthDoesNotDependOnTheMesh) {
  BodyConfig coarse = regular_plate({0.05, 0.05}, 0.0010), fine = coarse;
  fine.mesh_size = 0.0005;
  coarse.weibull = fine.weibull = {.modulus = 4.0, .length = 0.01};
  const Model a = built({coarse}), b = built({fine});
  double worst = 0.0;
  for (std::size_t t = 0; t < a.triangle.size(); t += 97) {
    const Vec2 p = prepare::centroid(a.point, a.triangle[t]);
    double least = 1e300;
    float there = 0.0F;
    for (std::size_t s = 0; s < b.triangle.size(); ++s) {
      const double away = norm(prepare::centroid(b.point, b.triangle[s]) - p);
      if (away < least) {
        least = away;
        there = b.strength[s];
      }
    }
    worst = std::max(worst, std::abs(static_cast<double>(a.strength[t] - there)));
  }
  EXPECT_LT(worst, 0.1);
}

}  // namespace heterogeneity_test
}  // namespace breccia::fdem
