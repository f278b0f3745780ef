// Couples that no step looks at before the next search: they stay apart however their elements
// move within their margins.

#include "fdem_shared/separated.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/random.hpp"
#include "fdem3/contact/couples.hpp"
#include "fdem3/shape.hpp"

namespace breccia::fdem3 {
namespace separated_test {

using fdem_shared::are_separated;
using fdem_shared::MayBeNear;

bool meet(const Vec3 (&a)[4], const Vec3 (&b)[4]) {
  Target of_a = Target::of(a), of_b = Target::of(b);
  if (!(of_a.six_volumes > 0.0 && of_b.six_volumes > 0.0)) return false;  // as CoupleForces
  of_a.measure_heights();
  of_b.measure_heights();
  FaceOverlap o;
  for (int f = 0; f < 4; ++f) {
    Vec3 face_a[3], face_b[3];
    for (int k = 0; k < 3; ++k) {
      face_a[k] = a[corner_of_face(f, k)];
      face_b[k] = b[corner_of_face(f, k)];
    }
    if (overlap_of_face(face_a, of_b, o) || overlap_of_face(face_b, of_a, o)) return true;
  }
  return false;
}

TEST(Separated, distance_of_a_face_and_a_corner_counts) {
  const Vec3 low[4] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}};
  const Vec3 high[4] = {{0.2, 0.2, 0.1}, {0.9, 0.0, 0.8}, {0.0, 0.9, 0.8}, {0.0, 0.0, 0.9}};
  EXPECT_TRUE(are_separated(low, high, 0.0999));
  EXPECT_FALSE(are_separated(low, high, 0.1001));
  EXPECT_TRUE(are_separated(high, low, 0.0999));
  EXPECT_FALSE(are_separated(high, low, 0.1001));
}

/// No plane of a face keeps these apart.
TEST(Separated, distance_of_two_edges_that_cross_counts) {
  const Vec3 low[4] = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, -0.3, -1.0}, {0.0, 0.3, -1.0}};
  const Vec3 high[4] = {{0.0, -1.0, 0.1}, {0.0, 1.0, 0.1}, {-0.3, 0.0, 1.1}, {0.3, 0.0, 1.1}};
  EXPECT_TRUE(are_separated(low, high, 0.0999));
  EXPECT_FALSE(are_separated(low, high, 0.1001));
}

/// Two tetrahedra as a search sees them, and a couple of theirs from before.
struct Pair {
  Corners x[2];
  double margin[2];
  ShapeGradients shape[2];
  CoupleState last{};

  Pair(const Corners& first, const Corners& second, double margin_a, double margin_b)
      : x{first, second},
        margin{margin_a, margin_b},
        shape{shape_gradients(first.at), shape_gradients(second.at)} {}
  bool is_listed(PairKey last_key = 7) const {
    const Index a = 0, b = 1, place[2] = {0, 1};
    const PairKey key = 7;
    return MayBeNear<Shape, CoupleState>{{&a, 1},    {&b, 1},        {&key, 1},
                                         {place, 2}, {x, 2},         {margin, 2},
                                         {shape, 2}, {&last_key, 1}, {&last, 1}}(0);
  }
};

TEST(Separated, pairs_left_out_stay_apart_within_their_margins_wherever_these_lead) {
  const Random random{11, 3};
  int left_out = 0, far = 0, met = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    std::uint32_t draw = 0;
    const auto next = [&] { return random.uniform(i, draw++); };
    const auto point = [&] {
      const double x = next(), y = next(), z = next();
      return Vec3{x - 0.5, y - 0.5, z - 0.5};
    };
    Corners x[2];
    const Vec3 way = 1.6 * point();
    for (int k = 0; k < 4; ++k) {
      x[0].at[k] = point();
      x[1].at[k] = point() + way;
    }
    for (Corners& one : x)
      if (Target::of(one.at).six_volumes < 0.0) std::swap(one.at[0], one.at[1]);
    const Pair pair(x[0], x[1], 0.08 * next(), 0.04);
    const double(&margin)[2] = pair.margin;
    if (pair.is_listed()) {
      met += meet(x[0].at, x[1].at) ? 1 : 0;
      continue;
    }
    ++left_out;
    const double near = near_reach(pair.shape[0]) + near_reach(pair.shape[1]);
    far += are_separated(x[0].at, x[1].at, 2.0 * (margin[0] + margin[1])) ? 1 : 0;
    for (int trial = 0; trial < 8; ++trial) {  // towards each other, corner by corner
      Vec3 moved[2][4];
      for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 4; ++k) {
          const Vec3 turn = 0.5 * point(), go = (side == 0 ? 1.0 : -1.0) * way + turn;
          moved[side][k] = x[side].at[k] + (margin[side] / norm(go)) * go;
        }
      ASSERT_FALSE(meet(moved[0], moved[1])) << i;
      // Nor are they near: all of one moved further by that.
      for (Vec3& corner : moved[0]) corner += (near / norm(way)) * way;
      ASSERT_FALSE(meet(moved[0], moved[1])) << i;
    }
  }
  EXPECT_GT(left_out, 300);
  EXPECT_GT(left_out - far, 30);  // near their margins, too
  EXPECT_GT(met, 200);
}

/// All axes one after the other, each with its own differences.
bool separated_by_any_axis(const Vec3 (&a)[4], const Vec3 (&b)[4], double distance) {
  const auto along = [&](const Vec3& axis) {
    const double size = norm(axis);
    if (!(size > 0.0)) return false;
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    for (int k = 0; k < 4; ++k)
      for (int side = 0; side < 2; ++side) {
        const double at = dot(axis, (side == 0 ? a : b)[k] - a[0]);
        low[side] = std::min(low[side], at);
        high[side] = std::max(high[side], at);
      }
    return std::max(low[1] - high[0], low[0] - high[1]) / size > distance;
  };
  for (int f = 0; f < 4; ++f)
    for (const auto& x : {&a, &b}) {
      const auto corner = [&](int k) { return (*x)[corner_of_face(f, k)]; };
      if (along(cross(corner(1) - corner(0), corner(2) - corner(0)))) return true;
    }
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      for (int k = 0; k < 4; ++k)
        for (int m = k + 1; m < 4; ++m)
          if (along(cross(a[j] - a[i], b[m] - b[k]))) return true;
  return false;
}

/// From tetrahedra that share corners to such as are far apart.
TEST(Separated, the_list_is_that_of_all_axes) {
  const Random random{12, 4};
  int listed = 0, shared = 0, beside = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    std::uint32_t draw = 0;
    const auto next = [&] { return random.uniform(i, draw++); };
    const auto point = [&] {
      const double x = next(), y = next(), z = next();
      return Vec3{x - 0.5, y - 0.5, z - 0.5};
    };
    Corners x[2];
    const Vec3 way = 2.0 * point();
    for (int k = 0; k < 4; ++k) {
      x[0].at[k] = point();
      x[1].at[k] = point() + way;
    }
    const int common = static_cast<int>(i % 4);  // a little apart, as the corners of a crack
    for (int k = 0; k < common; ++k) x[1].at[k] = x[0].at[k] + 0.2 * next() * point();
    for (Corners& one : x)
      if (Target::of(one.at).six_volumes < 0.0) std::swap(one.at[0], one.at[1]);
    const Pair pair(x[0], x[1], 0.08 * next(), 0.04);
    const double margins = pair.margin[0] + pair.margin[1];
    const double way_of_both = margins + near_reach(pair.shape[0]) + near_reach(pair.shape[1]);
    double size = 0.0;
    for (const Corners& one : x) {
      double longest = 0.0;
      for (int k = 1; k < 4; ++k) longest = std::max(longest, norm(one.at[k] - one.at[0]));
      size += longest;
    }
    const bool apart =
        separated_by_any_axis(x[0].at, x[1].at, way_of_both + 1e-6 * (size + way_of_both));
    ASSERT_EQ(pair.is_listed(), !apart) << i;
    const bool by_corners = fdem_shared::corners_within(x[0].at, x[1].at, margins);
    listed += apart ? 0 : 1;
    shared += by_corners ? 1 : 0;
    beside += !by_corners && fdem_shared::corners_within(x[0].at, x[1].at, 2.0 * margins) && apart;
  }
  EXPECT_GT(listed, 1000);
  EXPECT_LT(listed, 3500);
  EXPECT_GT(shared, 300);
  EXPECT_GT(beside, 10);  // a little too far
}

TEST(Separated, couples_that_hold_something_stay_listed) {
  Corners x[2] = {{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}, {}};
  for (int k = 0; k < 4; ++k) x[1].at[k] = x[0].at[k] + Vec3{5.0, 0.0, 0.0};
  Pair pair(x[0], x[1], 0.1, 0.1);
  EXPECT_FALSE(pair.is_listed());
  pair.last.work = 1e-300;
  EXPECT_TRUE(pair.is_listed());
  for (const PairKey other : {6, 8}) EXPECT_FALSE(pair.is_listed(other));  // not theirs
  pair.last.work = 0.0;
  pair.last.slid = 1e-9;
  EXPECT_TRUE(pair.is_listed());
}

}  // namespace separated_test
}  // namespace breccia::fdem3
