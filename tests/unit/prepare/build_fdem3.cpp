// Models of tetrahedra: volumes, counts, order in memory, refused bodies.

#include "prepare/build_fdem3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "fdem3/setup/regions.hpp"
#include "prepare/tetrahedra/tet_order.hpp"
#include "unit/prepare/fdem3_scenes.hpp"

namespace breccia::fdem3 {
namespace build_fdem3_test {

/// A body's share of its mineral.
double share_of(const Model& m, int material) {
  double sum = 0.0, total = 0.0;
  for (std::size_t t = 0; t < m.tetrahedron.size(); ++t) {
    const double volume = prepare::signed_volume(m.point, m.tetrahedron[t]);
    total += volume;
    if (m.material[t] == material) sum += volume;
  }
  return sum / total;
}

TEST(BuildFdem3, RegularBoxesHaveSixTetrahedraToACube) {
  BodyConfig box = regular_box({0.3, 0.2, 0.1}, 0.0999);
  box.center = {1.0, -2.0, 5.0};
  box.velocity = {3.0, 4.0, 5.0};
  const Model m = built({box});
  EXPECT_TRUE(is_sound(m));
  ASSERT_EQ(m.size(), 6 * 3 * 2 * 1);
  EXPECT_EQ(m.point.size(), 4U * 3U * 2U);
  EXPECT_NEAR(volume_of(m), 0.006, 1e-16);
  for (const auto& t : m.tetrahedron)
    EXPECT_NEAR(prepare::signed_volume(m.point, t), 1e-3 / 6.0, 1e-17);
  for (const Vec3& p : m.point) {
    EXPECT_LE(std::abs(p.x - 1.0), 0.15 + 1e-12);
    EXPECT_LE(std::abs(p.y + 2.0), 0.10 + 1e-12);
    EXPECT_LE(std::abs(p.z - 5.0), 0.05 + 1e-12);
  }
  EXPECT_EQ(m.velocity.back().z, 5.0);
  EXPECT_EQ(m.strength.back(), 1.0F);
  EXPECT_EQ(m.groups, std::vector<std::string>{"block"});
}

TEST(BuildFdem3, EmptyRegionsNameTheCornerNearestToThem) {
  const Model m = built({regular_box({0.3, 0.2, 0.1}, 0.0999)});
  RegionConfig region;
  region.min = {-1.0, -1.0, 0.051};
  region.max = {1.0, 1.0, 0.06};
  const auto refused = [&] { return refusal_of([&] { corners_in(m, region, "support.top"); }); };
  EXPECT_TRUE(mentions(refused(), "support.top: its region holds no corner of any tetrahedron"));
  EXPECT_TRUE(mentions(refused(), ", 0.05) m, is 0.001 m away")) << refused();
  region.around = "z";
  region.radius = 1.0;
  EXPECT_FALSE(mentions(refused(), "nearest")) << "a cylinder is not measured";
}

TEST(BuildFdem3, NeighboursOfRegularBoxesShareFaces) {
  const Model m = built({regular_box({0.4, 0.3, 0.2}, 0.1)});
  int inner = 0, rim = 0;
  for (const prepare::MeshFace& face : prepare::faces_of(m.tetrahedron))
    ++(face.tetrahedra[1] >= 0 ? inner : rim);
  EXPECT_EQ(rim, 2 * 2 * (4 * 3 + 3 * 2 + 4 * 2)) << "two triangles to a square of the surface";
  EXPECT_EQ(inner, (4 * m.size() - rim) / 2);
}

TEST(BuildFdem3, JitterKeepsTheVolumeAndTheSurface) {
  BodyConfig box = regular_box({0.1, 0.1, 0.1}, 0.02);
  const Model regular = built({box});
  box.jitter = 0.3;
  const Model moved = built({box}), again = built({box}), other = built({box}, 2);
  EXPECT_TRUE(is_sound(moved));
  EXPECT_NEAR(volume_of(moved), 1e-3, 1e-15);
  EXPECT_LT(least_volume(moved), 0.7 * least_volume(regular));
  const auto moved_from_lattice = [](const Vec3& p) {
    const auto off = [](double x) { return std::abs(x / 0.02 - 0.5 - std::round(x / 0.02 - 0.5)); };
    return std::max({off(p.x), off(p.y), off(p.z)}) > 1e-9;
  };
  int count = 0;
  for (std::size_t i = 0; i < moved.point.size(); ++i) {
    const Vec3& p = moved.point[i];
    const bool inner = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.05 - 1e-9;
    EXPECT_EQ(moved_from_lattice(p), inner);
    count += inner;
  }
  EXPECT_EQ(count, 4 * 4 * 4);
  ASSERT_EQ(moved.point.size(), again.point.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < moved.point.size(); ++i) {
    EXPECT_EQ(norm(moved.point[i] - again.point[i]), 0.0);
    apart = std::max(apart, norm(moved.point[i] - other.point[i]));
  }
  EXPECT_GT(apart, 1e-3);
}

TEST(BuildFdem3, HilbertsCurveGoesFromCellToCell) {
  constexpr std::uint32_t n = 16;
  std::vector<std::array<int, 3>> cell(n * n * n, {-1, -1, -1});
  for (std::uint32_t x = 0; x < n; ++x)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t z = 0; z < n; ++z) {
        const std::uint64_t at = prepare::hilbert_index(x, y, z);
        ASSERT_LT(at, cell.size()) << "the curve fills a cube before it leaves it";
        ASSERT_EQ(cell[at][0], -1);
        cell[at] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
      }
  for (std::size_t k = 1; k < cell.size(); ++k) {
    int steps = 0;
    for (std::size_t a = 0; a < 3; ++a) steps += std::abs(cell[k][a] - cell[k - 1][a]);
    ASSERT_EQ(steps, 1);
  }
  std::set<std::uint64_t> far;
  constexpr std::uint32_t last = (1U << 21) - 1;
  for (const std::uint32_t x : {0U, last})
    for (const std::uint32_t y : {0U, last})
      for (const std::uint32_t z : {0U, last}) far.insert(prepare::hilbert_index(x, y, z));
  EXPECT_EQ(far.size(), 8U);
  EXPECT_LT(*far.rbegin(), std::uint64_t{1} << 63);
}

TEST(BuildFdem3, TetrahedraFollowTheCurveAndVerticesThem) {
  const Model m = built({regular_box({0.16, 0.16, 0.16}, 0.01)});
  double jump = 0.0;
  for (std::size_t t = 1; t < m.tetrahedron.size(); ++t)
    jump += norm(prepare::centroid(m.point, m.tetrahedron[t]) -
                 prepare::centroid(m.point, m.tetrahedron[t - 1]));
  EXPECT_LT(jump / static_cast<double>(m.size()), 0.01) << "less than an edge from one to the next";
  Index next = 0;
  for (const auto& t : m.tetrahedron)
    for (const Index v : t) {
      ASSERT_LE(v, next);
      if (v == next) ++next;
    }
  EXPECT_EQ(static_cast<std::size_t>(next), m.point.size());
}

TEST(BuildFdem3, BodiesAreGroupsWithMaterialsByName) {
  BodyConfig lower = regular_box({0.1, 0.1, 0.1}, 0.05), upper = lower;
  upper.name = "plate";
  upper.material = "steel";
  upper.center = {0.0, 0.0, 0.1};
  const Model m = built({lower, upper});
  EXPECT_EQ(m.groups, (std::vector<std::string>{"block", "plate"}));
  EXPECT_EQ(m.point.size(), 2U * 27U) << "bodies do not share vertices";
  for (std::size_t t = 0; t < m.tetrahedron.size(); ++t) {
    const bool above = prepare::centroid(m.point, m.tetrahedron[t]).z > 0.05;
    EXPECT_EQ(m.group[t], above ? 1 : 0);
    EXPECT_EQ(m.material[t], above ? 1 : 0);
  }
}

TEST(BuildFdem3, MineralsHaveTheirSharesOfTheVolume) {
  for (const char* kind : {"voronoi", "random"}) {
    BodyConfig body = regular_box({0.04, 0.04, 0.04}, 0.002);
    body.grains.kind = kind;
    body.grains.size = 0.004;
    body.grains.minerals = {{.material = "quartz", .fraction = 0.24, .color = ""},
                            {.material = "feldspar", .fraction = 0.68, .color = ""},
                            {.material = "biotite", .fraction = 0.08, .color = ""}};
    const Model m = built({body});
    // To within a grain of 10^3.
    EXPECT_NEAR(share_of(m, 2), 0.24, 0.002) << kind;
    EXPECT_NEAR(share_of(m, 3), 0.68, 0.002) << kind;
    EXPECT_NEAR(share_of(m, 4), 0.08, 0.002) << kind;
    int like = 0, all = 0;
    for (const prepare::MeshFace& face : prepare::faces_of(m.tetrahedron))
      if (face.tetrahedra[1] >= 0) {
        like += m.material[static_cast<std::size_t>(face.tetrahedra[0])] ==
                m.material[static_cast<std::size_t>(face.tetrahedra[1])];
        ++all;
      }
    // By chance: 0.24^2 + 0.68^2 + 0.08^2 = 0.53.
    const double share = static_cast<double>(like) / all;
    if (std::string(kind) == "random")
      EXPECT_NEAR(share, 0.53, 0.03);
    else
      EXPECT_GT(share, 0.75);
  }
}

TEST(BuildFdem3, BodiesAreTurnedAboutTheirCentre) {
  BodyConfig box = regular_box({0.4, 0.2, 0.1}, 0.05);
  box.center = {1.0, 2.0, 3.0};
  const Model upright = built({box});
  box.direction = {1.0, 1.0, 0.0};
  box.across = {0.0, 0.0, -2.0};
  const Model turned = built({box});
  ASSERT_EQ(turned.size(), upright.size());
  EXPECT_TRUE(is_sound(turned));
  EXPECT_NEAR(volume_of(turned), volume_of(upright), 1e-15);
  const double root = std::sqrt(0.5);
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Vec3& p : turned.point) {
    const Vec3 from = p - box.center;
    // Its own x points down, its z to (1, 1, 0), its y to (1, -1, 0) or against that.
    const Vec3 own{-from.z, root * (from.x - from.y), root * (from.x + from.y)};
    low = {std::min(low.x, own.x), std::min(low.y, own.y), std::min(low.z, own.z)};
    high = {std::max(high.x, own.x), std::max(high.y, own.y), std::max(high.z, own.z)};
  }
  EXPECT_LT(norm(high - Vec3{0.2, 0.1, 0.05}), 1e-12);
  EXPECT_LT(norm(low + Vec3{0.2, 0.1, 0.05}), 1e-12);
  box.structured = false;
  box.shape = "sphere";
  box.size = {};
  box.radius = 0.1;
  EXPECT_TRUE(mentions(refusal(case_of({box})),
                       "direction and across turn boxes, cylinders and STL surfaces"));
}

/// Rock of one mineral: what holds together without the boundaries are the grains.
TEST(BuildFdem3, BoundariesOfGrainsPartAllOfThem) {
  BodyConfig rock = regular_box({0.02, 0.02, 0.02}, 0.001);
  rock.grains.kind = "voronoi";
  rock.grains.size = 0.005;
  rock.grains.minerals = {{.material = "quartz", .fraction = 1.0, .color = ""}};
  EXPECT_TRUE(built({rock}).discontinuities.empty());
  rock.grains.boundary = "vein";
  const Model m = built({rock});
  std::set<std::array<Index, 3>> given;
  for (const auto& d : m.discontinuities) {
    EXPECT_EQ(d.material, 0);
    given.insert(d.face);
  }
  std::vector<std::size_t> root(m.tetrahedron.size());
  for (std::size_t t = 0; t < root.size(); ++t) root[t] = t;
  const auto find = [&](std::size_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  const auto faces = prepare::faces_of(m.tetrahedron);
  for (const prepare::MeshFace& face : faces)
    if (face.tetrahedra[1] >= 0 && !given.contains(face.corners))
      root[find(static_cast<std::size_t>(face.tetrahedra[0]))] =
          find(static_cast<std::size_t>(face.tetrahedra[1]));
  std::map<std::size_t, double> volume;
  for (std::size_t t = 0; t < m.tetrahedron.size(); ++t)
    volume[find(t)] += prepare::signed_volume(m.point, m.tetrahedron[t]);
  // 64 cubes of edge `size` in the box, and grains whose seeds lie in those around it.
  EXPECT_GT(volume.size(), 64U);
  EXPECT_LE(volume.size(), 216U);
  double largest = 0.0;
  for (const auto& [grain, own] : volume) largest = std::max(largest, own);
  EXPECT_LT(largest, 4.0 * 0.005 * 0.005 * 0.005);
  for (const prepare::MeshFace& face : faces)  // no boundary lies within a grain
    if (face.tetrahedra[1] >= 0 && given.contains(face.corners)) {
      EXPECT_NE(find(static_cast<std::size_t>(face.tetrahedra[0])),
                find(static_cast<std::size_t>(face.tetrahedra[1])));
    }
}

TEST(BuildFdem3, BoundariesOfGrainsNeedGrainsAndAJointLaw) {
  BodyConfig rock = regular_box({0.02, 0.02, 0.02}, 0.01);
  rock.grains.kind = "random";
  rock.grains.minerals = {{.material = "quartz", .fraction = 1.0, .color = ""}};
  rock.grains.boundary = "vein";
  EXPECT_TRUE(mentions(refusal(case_of({rock})),
                       "grains.boundary is between Voronoi grains; kind is random"));
  rock.grains.kind = "voronoi";
  rock.grains.size = 0.005;
  rock.grains.boundary = "seam";
  EXPECT_TRUE(mentions(refusal(case_of({rock})),
                       "grains.boundary = \"seam\" is not a joint law; there are: vein"));
}

TEST(BuildFdem3, CorrelatedStrengthIsAFunctionOfThePlace) {
  BodyConfig body = regular_box({0.05, 0.05, 0.05}, 0.005);
  body.weibull = {.modulus = 4.0, .length = 0.02};
  BodyConfig half = body;
  half.size.x = 0.025;
  half.center.x = 0.0125;
  const Model whole = built({body}), part = built({half});
  int found = 0;
  for (std::size_t s = 0; s < part.tetrahedron.size(); s += 37) {
    const Vec3 place = prepare::centroid(part.point, part.tetrahedron[s]);
    for (std::size_t t = 0; t < whole.tetrahedron.size(); ++t)
      if (norm(prepare::centroid(whole.point, whole.tetrahedron[t]) - place) < 1e-9) {
        EXPECT_NEAR(whole.strength[t], part.strength[s], 1e-5F);
        ++found;
      }
  }
  EXPECT_GT(found, 50);
}

TEST(BuildFdem3, WeibullFactorsHaveTheirMoments) {
  const double m = 4.0, g1 = std::tgamma(1.0 + 1.0 / m), g2 = std::tgamma(1.0 + 2.0 / m);
  BodyConfig body = regular_box({0.1, 0.1, 0.1}, 0.005);
  body.weibull = {.modulus = m, .length = 0.0};
  const Model model = built({body});
  double sum = 0.0, squares = 0.0;
  for (const float f : model.strength) {
    sum += f;
    squares += static_cast<double>(f) * f;
  }
  const double n = static_cast<double>(model.size()), mean = sum / n;
  EXPECT_NEAR(mean, 1.0, 0.005);  // 48,000 factors: 0.28 / sqrt(n) = 0.0013
  EXPECT_NEAR(squares / n - mean * mean, g2 / (g1 * g1) - 1.0, 0.003);
}

TEST(BuildFdem3, AllProblemsAreToldWithBodyAndKey) {
  BodyConfig nameless = regular_box({0.1, 0.0, 0.1}, 0.0);
  nameless.material = "stone";
  BodyConfig ball = regular_box({}, 0.01);
  ball.name = "ball";
  ball.shape = "sphere";
  ball.parts = {"a"};
  const std::string text = refusal(case_of({nameless, ball}));
  for (const char* part :
       {"body.block: material = \"stone\" is not a material; there are: rock, steel",
        "body.block: shape box needs size, three lengths above 0",
        "body.block: shape box needs mesh_size", "body.ball: shape sphere needs a radius above 0",
        "body.ball: structured = true is for boxes, not for sphere",
        "body.ball: parts are of a mesh file; shape is sphere"})
    EXPECT_TRUE(mentions(text, part)) << part << "\n" << text;
  EXPECT_TRUE(mentions(refusal(case_of({})), "at least one [[body]] is needed"));
  const BodyConfig one = regular_box({0.1, 0.1, 0.1}, 0.05);
  EXPECT_TRUE(mentions(refusal(case_of({one, one})), "another body has this name"));
  EXPECT_TRUE(mentions(refusal(case_of({regular_box({1.0, 1.0, 1.0}, 1e-4)})),
                       "more than 2e+08 tetrahedra"));
}

}  // namespace build_fdem3_test
}  // namespace breccia::fdem3
