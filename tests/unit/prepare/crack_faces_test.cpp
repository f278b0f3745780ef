// Faces of meshes along flat cracks.

#include "prepare/tetrahedra/crack_faces.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "math/constants.hpp"
#include "prepare/tetrahedra/least_cut.hpp"
#include "unit/prepare/fdem3_scenes.hpp"

namespace breccia::fdem3 {
namespace crack_faces_test {

DiscontinuityConfig plane_at(double height, double reach = 1.0) {
  DiscontinuityConfig d;
  d.name = "plane";
  d.points = {{-reach, -reach, height},
              {reach, -reach, height},
              {reach, reach, height},
              {-reach, reach, height}};
  return d;
}
DiscontinuityConfig disc_of(double radius, const Vec3& normal) {
  DiscontinuityConfig d;
  d.name = "disc";
  d.radius = radius;
  d.normal = normal;
  return d;
}
Model cracked(const BodyConfig& body, const DiscontinuityConfig& crack) {
  Config config = case_of({body});
  config.discontinuities = {crack};
  return build_model(config, ".");
}

double area_of(const Model& m) {
  double sum = 0.0;
  for (const Model::Discontinuity& d : m.discontinuities) {
    const Vec3 a = prepare::at(m.point, d.face[0]);
    sum +=
        0.5 * norm(cross(prepare::at(m.point, d.face[1]) - a, prepare::at(m.point, d.face[2]) - a));
  }
  return sum;
}

/// Volumes of what is connected over faces that are not cracked, the largest first.
std::vector<double> pieces_of(const Model& m) {
  std::set<prepare::Face> cracks;
  for (const Model::Discontinuity& d : m.discontinuities) cracks.insert(d.face);
  std::vector<std::size_t> root(m.tetrahedron.size());
  for (std::size_t t = 0; t < root.size(); ++t) root[t] = t;
  const auto find = [&](std::size_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  for (const prepare::MeshFace& face : prepare::faces_of(m.tetrahedron))
    if (face.tetrahedra[1] >= 0 && !cracks.contains(face.corners))
      root[find(static_cast<std::size_t>(face.tetrahedra[0]))] =
          find(static_cast<std::size_t>(face.tetrahedra[1]));
  std::map<std::size_t, double> volume;
  for (std::size_t t = 0; t < root.size(); ++t)
    volume[find(t)] += prepare::signed_volume(m.point, m.tetrahedron[t]);
  std::vector<double> pieces;
  for (const auto& [which, sum] : volume) pieces.push_back(sum);
  std::sort(pieces.rbegin(), pieces.rend());
  return pieces;
}

TEST(LeastCut, IsTheCheapestOfAll) {
  constexpr Index n = 7;
  for (std::uint64_t round = 0; round < 200; ++round) {
    const Random random{round, 1};
    std::array<std::array<std::int64_t, n + 2>, n + 2> cost{};
    prepare::LeastCut network(n);
    std::uint64_t draw = 0;
    for (Index a = 0; a < n; ++a) {
      const auto price = [&] {
        return random.uniform(draw++) < 0.5
                   ? std::int64_t{0}
                   : static_cast<std::int64_t>(9.0 * random.uniform(draw++));
      };
      network.tie_to_source(a, cost[n][static_cast<std::size_t>(a)] = price());
      network.tie_to_sink(a, cost[n + 1][static_cast<std::size_t>(a)] = price());
      for (Index b = 0; b < a; ++b)
        network.join(a, b,
                     cost[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = price());
    }
    const auto total = [&](unsigned above) {  // bits: with the source
      std::int64_t sum = 0;
      for (std::size_t a = 0; a < n; ++a) {
        const bool is_above = (above >> a & 1U) != 0;
        sum += cost[is_above ? n + 1 : n][a];
        for (std::size_t b = 0; b < a; ++b)
          if (is_above != ((above >> b & 1U) != 0)) sum += cost[a][b];
      }
      return sum;
    };
    std::int64_t least = total(0);
    unsigned common = (1U << n) - 1;
    for (unsigned above = 0; above < 1U << n; ++above) least = std::min(least, total(above));
    for (unsigned above = 0; above < 1U << n; ++above)
      if (total(above) == least) common &= above;
    unsigned found = 0;
    const std::vector<bool> with = network.with_source();
    for (std::size_t a = 0; a < n; ++a) found |= with[a] ? 1U << a : 0U;
    ASSERT_EQ(total(found), least) << round;
    ASSERT_EQ(found, common) << "what all cheapest cuts have in common is the smallest of them";
  }
}

TEST(CrackFaces, LatticePlanesArePartedExactly) {
  const Model m = cracked(regular_box({0.06, 0.05, 0.04}, 0.01), plane_at(0.01));
  ASSERT_EQ(m.discontinuities.size(), 2U * 6U * 5U);
  for (const Model::Discontinuity& d : m.discontinuities) {
    EXPECT_EQ(d.material, -1);
    for (const Index v : d.face) EXPECT_NEAR(prepare::at(m.point, v).z, 0.01, 1e-15);
  }
  const auto pieces = pieces_of(m);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(pieces[1], 0.06 * 0.05 * 0.01, 1e-15);
}

TEST(CrackFaces, OtherPlanesAreFollowedWithoutHoles) {
  BodyConfig box = regular_box({0.1, 0.1, 0.1}, 0.01);
  box.jitter = 0.2;
  for (const double height : {0.0, 0.013, 0.0149}) {
    const Model m = cracked(box, plane_at(height));
    const auto pieces = pieces_of(m);
    ASSERT_EQ(pieces.size(), 2U) << height;
    EXPECT_NEAR(pieces[1], 0.01 * (0.05 - height), 0.01 * 0.005) << "within half an edge";
    EXPECT_LT(area_of(m), 1.3 * 0.01) << height;
    for (const Model::Discontinuity& d : m.discontinuities)
      EXPECT_NEAR(prepare::centroid(m.point, d.face).z, height, 0.01);
  }
  BodyConfig free = box;
  free.structured = false;
  DiscontinuityConfig tilted = plane_at(0.0);
  tilted.points[0].z = tilted.points[1].z = -0.3;
  tilted.points[2].z = tilted.points[3].z = 0.3;
  tilted.embedded = false;
  const Model m = cracked(free, tilted);
  const auto pieces = pieces_of(m);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(pieces[1], 0.5e-3, 0.05e-3);
  EXPECT_LT(area_of(m), 1.5 * 0.01 * std::sqrt(1.09));
}

TEST(CrackFaces, ThinBodiesArePartedToo) {
  const Model m = cracked(regular_box({0.1, 0.1, 0.02}, 0.01), plane_at(0.001));
  EXPECT_EQ(m.discontinuities.size(), 200U);
}

TEST(CrackFaces, TwoTetrahedraArePartedAtTheirFace) {
  const std::vector<Vec3> point{
      {0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.002, 0.01}, {0.002, 0.002, -0.01}};
  const std::vector<prepare::Tetrahedron> two{{0, 1, 2, 3}, {0, 2, 1, 4}};
  const auto faces = prepare::faces_along(plane_at(0.0), point, two, prepare::faces_of(two),
                                          [](Index) { return false; });
  EXPECT_EQ(faces, (std::vector<prepare::Face>{{0, 1, 2}}));
}

TEST(CrackFaces, GmshFollowsDiscsAndPolygons) {
  BodyConfig box = regular_box({0.1, 0.1, 0.1}, 0.01);
  box.structured = false;
  const double r = 0.03;
  const Vec3 normal{0.3, -0.5, 1.0};
  const Model disc = cracked(box, disc_of(r, normal));
  for (const Model::Discontinuity& d : disc.discontinuities)
    for (const Index v : d.face) {
      EXPECT_NEAR(dot(prepare::at(disc.point, v), normal), 0.0, 1e-10);
      EXPECT_LE(norm(prepare::at(disc.point, v)), r + 1e-10);
    }
  // A polygon of at least 16 corners in the circle: 8 sin(2 pi / 16) / pi = 0.974.
  EXPECT_LT(area_of(disc), pi * r * r);
  EXPECT_GT(area_of(disc), 0.95 * pi * r * r);
  EXPECT_EQ(pieces_of(disc).size(), 1U);
  EXPECT_NEAR(volume_of(disc), 1e-3, 1e-12);

  const Model halves = cracked(box, plane_at(0.0123));
  EXPECT_NEAR(area_of(halves), 0.01, 1e-12);
  const auto pieces = pieces_of(halves);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(pieces[1], 0.01 * (0.05 - 0.0123), 1e-12);

  box.jitter = 0.2;
  EXPECT_NEAR(area_of(cracked(box, plane_at(0.0123))), 0.01, 1e-12) << "vertices on it stay";
}

TEST(CrackFaces, ADiscEndsWithinTheBody) {
  BodyConfig box = regular_box({0.1, 0.1, 0.1}, 0.005);
  box.jitter = 0.2;
  const Model m = cracked(box, disc_of(0.03, {0.0, 0.0, 2.0}));
  EXPECT_EQ(pieces_of(m).size(), 1U);
  EXPECT_NEAR(area_of(m), pi * 0.03 * 0.03, 0.25 * pi * 0.03 * 0.03);
  for (const Model::Discontinuity& d : m.discontinuities) {
    const Vec3 c = prepare::centroid(m.point, d.face);
    EXPECT_LT(std::sqrt(c.x * c.x + c.y * c.y), 0.03 + 0.005);
  }
}

TEST(CrackFaces, TheLastOfSeveralCounts) {
  Config config = case_of({regular_box({0.04, 0.04, 0.04}, 0.01)});
  config.discontinuities = {plane_at(0.0), plane_at(0.0, 0.01)};
  config.discontinuities[1].name = "inner";
  config.discontinuities[1].kind = "cohesive";
  config.discontinuities[1].material = "vein";
  const Model m = build_model(config, ".");
  int open = 0, vein = 0;
  for (const Model::Discontinuity& d : m.discontinuities) ++(d.material < 0 ? open : vein);
  EXPECT_EQ(vein, 2 * 2 * 2);
  EXPECT_EQ(open, 2 * (16 - 4));
  config.discontinuities = {plane_at(0.5)};
  EXPECT_TRUE(
      mentions(refusal(config), "discontinuity.plane: meets no face between two tetrahedra"));
}

}  // namespace crack_faces_test
}  // namespace breccia::fdem3
