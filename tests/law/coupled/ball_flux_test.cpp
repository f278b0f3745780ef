// The flux of a sphere's potential through triangles: reference values, closed formulas, balance,
// the slope of an energy, a mesh that is not felt.

#include "coupled/laws/ball_flux.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace breccia::coupled {
namespace ball_flux_test {

struct Force {
  Vec3 on_sphere{}, torque{}, corner[3] = {};
};
/// With a penalty of 1.
Force force_of(const Vec3& centre, double radius, const Vec3 (&x)[3]) {
  Force sum;
  BallFlux flux;
  if (!flux_of_face(centre, radius, x, flux)) return sum;
  sum.on_sphere = flux.push * flux.normal;
  sum.torque = cross(flux.lever, flux.normal);
  for (int k = 0; k < 3; ++k) sum.corner[k] = -flux.share[k] * flux.normal;
  return sum;
}
void expect_near(const Vec3& value, const Vec3& expected, double tolerance) {
  EXPECT_NEAR(value.x, expected.x, tolerance);
  EXPECT_NEAR(value.y, expected.y, tolerance);
  EXPECT_NEAR(value.z, expected.z, tolerance);
}
const Vec3 triangle[3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {.2, .9, .1}};

// Values of a prototype in another language.
TEST(BallFlux, gives_the_reference_forces_over_a_face) {
  const Force f = force_of({.4, .3, .45}, .5, triangle);
  expect_near(f.on_sphere, {0.0, -.00104911048644036, .00944199437796325}, 1e-16);
  expect_near(f.torque, {-2.84345308486e-5, 3.19888472047e-5, 3.55431635608e-6}, 1e-15);
  expect_near(f.corner[0], {0.0, .000313385144665, -.00282046630199}, 1e-14);
  expect_near(f.corner[1], {0.0, .000336181012331, -.00302562911098}, 1e-14);
  expect_near(f.corner[2], {0.0, .000399544329444, -.00359589896499}, 1e-14);
}
TEST(BallFlux, gives_the_reference_forces_beyond_an_edge_and_a_corner) {
  const Force edge = force_of({.5, -.2, .2}, .5, triangle);
  expect_near(edge.on_sphere, {0.0, -.00134131363894293, .0120718227504863}, 1e-16);
  expect_near(edge.torque, {.00317754006881, 0.0, 0.0}, 1e-14);
  const Force corner = force_of({-.15, -.2, .1}, .5, triangle);
  expect_near(corner.on_sphere, {0.0, -.000349649669879865, .00314684702891879}, 1e-16);
  // Along the triangle, so that y is 9 z.
  expect_near(corner.torque, {.000818646158298, -9.0 * 8.75980713584e-5, -8.75980713584e-5}, 2e-14);
}

// Closed integrals of the cap of a sphere.
TEST(BallFlux, of_a_plane_and_of_half_a_plane_are_the_closed_numbers) {
  const double radius = 0.5, overlap = 0.01, far = 40.0;
  const double square = 2.0 * radius * overlap - overlap * overlap;
  const double whole = pi * square * square / (4.0 * radius);
  const Vec3 centre{0.0, 0.0, radius - overlap};
  const Vec3 plane[3] = {{-far, -far, 0.0}, {far, -far, 0.0}, {0.0, far, 0.0}};
  const Force over_plane = force_of(centre, radius, plane);
  EXPECT_NEAR(over_plane.on_sphere.z, whole, 1e-14 * whole);
  EXPECT_EQ(norm(over_plane.torque), 0.0);
  // An edge below the centre takes half of it, and turns the sphere by 2 a^5/15 2/(2R).
  const Vec3 half[3] = {{-far, 0.0, 0.0}, {far, 0.0, 0.0}, {0.0, far, 0.0}};
  const Force over_edge = force_of(centre, radius, half);
  EXPECT_NEAR(over_edge.on_sphere.z, 0.5 * whole, 1e-14 * whole);
  const double turn = 2.0 / 15.0 * std::pow(square, 2.5) / radius;
  expect_near(over_edge.torque, {turn, 0.0, 0.0}, 1e-13 * turn);
  // A corner of 90 degrees takes a quarter.
  const Vec3 quarter[3] = {{0.0, 0.0, 0.0}, {far, 0.0, 0.0}, {0.0, far, 0.0}};
  EXPECT_NEAR(force_of(centre, radius, quarter).on_sphere.z, 0.25 * whole, 1e-14 * whole);
}

TEST(BallFlux, ends_where_the_triangle_does) {
  const Vec3 flat[3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  BallFlux flux;
  EXPECT_FALSE(flux_of_face({0.3, 0.3, 0.5}, 0.5, flat, flux));      // above
  EXPECT_FALSE(flux_of_face({0.3, -0.4, 0.3}, 0.5, flat, flux));     // beyond an edge
  EXPECT_FALSE(flux_of_face({-0.3, -0.3, 0.3}, 0.5, flat, flux));    // beyond a corner
  EXPECT_FALSE(flux_of_face({1.35, -0.13, 0.38}, 0.5, flat, flux));  // of less than 90 degrees
  EXPECT_TRUE(flux_of_face({-0.2, -0.2, 0.3}, 0.5, flat, flux));
}

struct Mesh {
  std::vector<Vec3> point;
  std::vector<int> corner;
};
/// A square of cells, whose inner vertices are moved by up to `jitter` of a cell.
template <class Height>
Mesh square_mesh(int cells, double side, double jitter, const Height& height) {
  const Random random{7, 1};
  Mesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const auto number = static_cast<std::uint64_t>(2 * (j * (cells + 1) + i));
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double h = side / cells, by = inner ? jitter * h : 0.0;
      const double x = i * h + by * (2.0 * random.uniform(number) - 1.0);
      const double y = j * h + by * (2.0 * random.uniform(number + 1) - 1.0);
      mesh.point.push_back({x, y, height(x, y)});
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int at = j * (cells + 1) + i, up = at + cells + 1;
      for (const int k : {at, at + 1, up, at + 1, up + 1, up}) mesh.corner.push_back(k);
    }
  return mesh;
}
Force force_of(const Vec3& centre, double radius, const Mesh& mesh) {
  Force sum;
  for (std::size_t k = 0; k < mesh.corner.size(); k += 3) {
    const auto at = [&](std::size_t c) {
      return mesh.point[static_cast<std::size_t>(mesh.corner[k + c])];
    };
    const Vec3 x[3] = {at(0), at(1), at(2)};
    const Force f = force_of(centre, radius, x);
    sum.on_sphere += f.on_sphere;
    sum.torque += f.torque;
  }
  return sum;
}

TEST(BallFlux, does_not_feel_how_a_plane_is_meshed) {
  const double radius = 0.5;
  const Mesh mesh = square_mesh(20, 8.0, 0.3, [](double, double) { return 0.0; });
  for (const double overlap : {0.001, 0.01, 0.1}) {
    const double square = 2.0 * radius * overlap - overlap * overlap;
    const double expected = pi * square * square / (4.0 * radius);
    for (int k = 0; k < 200; ++k) {
      const Vec3 centre{2.0 + 0.02 * k, 3.0 + 0.0113 * k, radius - overlap};
      const Force f = force_of(centre, radius, mesh);
      EXPECT_NEAR(f.on_sphere.z, expected, 2e-13 * expected);
      EXPECT_EQ(f.on_sphere.x, 0.0);
      EXPECT_LT(norm(f.torque), 1e-13 * expected * radius);
    }
  }
}

TEST(BallFlux, balances_forces_and_moments) {
  const Random random{3, 2};
  int touched = 0;
  for (std::uint64_t trial = 0; trial < 3000; ++trial) {
    std::uint64_t draw = 12 * trial;
    const auto next = [&] { return random.uniform(draw++); };
    const Vec3 x[3] = {
        {next(), next(), next()}, {next(), next(), next()}, {next(), next(), next()}};
    const Vec3 centre{next(), next(), next()};
    const Force f = force_of(centre, 0.4, x);
    const double size = norm(f.on_sphere);
    if (size == 0.0) continue;
    ++touched;
    const Vec3 sum = f.on_sphere + f.corner[0] + f.corner[1] + f.corner[2];
    Vec3 moment = f.torque;
    for (int k = 0; k < 3; ++k) moment += cross(x[k] - centre, f.corner[k]);
    // Corners bear more than the whole where the pressure is outside of the middle.
    const double scale = norm(f.corner[0]) + norm(f.corner[1]) + norm(f.corner[2]);
    EXPECT_LT(norm(sum), 1e-15 * scale);
    EXPECT_LT(norm(moment), 1e-12 * scale);
  }
  EXPECT_GT(touched, 300);
}

TEST(BallFlux, is_the_slope_of_an_energy) {
  const Mesh mesh = square_mesh(12, 3.0, 0.2, [](double x, double y) {
    return 0.05 * std::sin(5.0 * x) * std::cos(4.0 * y);
  });
  // Forces have an energy if their slopes are symmetric, and no work is done around a closed way.
  const Vec3 start{1.4, 1.5, 0.45};
  double work = 0.0, largest = 0.0;
  const int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    const auto at = [&](double s) {
      const double angle = 2.0 * pi * s;
      return start + Vec3{0.3 * std::sin(angle), 0.2 * std::sin(2.0 * angle),
                          0.08 * (std::cos(angle) - 1.0) + 0.02 * std::sin(3.0 * angle)};
    };
    const Vec3 from = at(static_cast<double>(k) / steps), to = at((k + 1.0) / steps);
    const Vec3 f = force_of(0.5 * (from + to), 0.5, mesh).on_sphere;
    work += dot(f, to - from);
    largest = std::max(largest, norm(f));
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(std::abs(work), 1e-8 * largest);
}

/// Two tetrahedra above each other's common face at x = 0, `apart` from each other there.
struct JointedPair {
  double radius = 0.5;
  bool joint_presses = true;

  /// Power over speed of the ball that goes up, and of the gap that opens.
  struct Slopes {
    double up = 0.0, open = 0.0;
  };
  Slopes slopes(double height, double apart) const {
    Slopes sum;
    for (const double side : {1.0, -1.0}) {
      const double x = 0.5 * side * apart;
      const Vec3 left{x, -side, 0.0}, right{x, side, 0.0}, below{x, 0.0, -1.5},
          far{x + 1.5 * side, 0.0, 0.0};
      const Vec3 faces[4][3] = {{left, far, right},
                                {left, below, far},
                                {right, far, below},
                                {left, right, below}};  // the last one is the joint's
      for (int k = 0; k < (joint_presses ? 4 : 3); ++k) {
        const Force f = force_of({0.01, 0.02, height}, radius, faces[k]);
        sum.up += f.on_sphere.z;
        for (const Vec3& at : f.corner) sum.open += 0.5 * side * at.x;
      }
    }
    return sum;
  }
  /// Work around a closed way: the gap opens with the ball high, and closes with it low.
  double work(double high, double low, double open) const {
    constexpr int steps = 400;
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
      const double at = (k + 0.5) / steps, height = low + at * (high - low);
      sum += (slopes(high, at * open).open - slopes(low, at * open).open) * open / steps;
      sum += (slopes(height, 0.0).up - slopes(height, open).up) * (high - low) / steps;
    }
    return sum;
  }
};

// The outer faces of a body with an open joint are not a closed surface: their push has no energy.
// With those of the joint it has one, whatever the joint does.
TEST(BallFlux, has_an_energy_over_open_joints_if_their_faces_press) {
  JointedPair pair;
  const double outer_faces = (pair.joint_presses = false, pair.work(0.45, 0.35, 0.02));
  const double all_faces = (pair.joint_presses = true, pair.work(0.45, 0.35, 0.02));
  // The integral of phi over the part of the gap that the ball enters on its way down, times its
  // width: (R^2 - x^2 - y^2 - z^2)/(2 R) over the caps of depth 0.05 and 0.15, at x near 0.
  const auto cap = [&](double height) {
    double sum = 0.0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double z = height + (k + 0.5) / steps * (pair.radius - height);
      const double square = pair.radius * pair.radius - z * z;
      sum += 2.0 / 3.0 * square * std::sqrt(square) / pair.radius * (pair.radius - height) / steps;
    }
    return sum;
  };
  const double expected = 0.02 * (cap(0.35) - cap(0.45));
  EXPECT_NEAR(std::abs(outer_faces), expected, 0.01 * expected);
  EXPECT_LT(std::abs(all_faces), 1e-4 * expected);
}

// On a surface that is not flat the torque of all faces vanishes where the ball is closed off.
TEST(BallFlux, does_not_turn_a_sphere_on_a_rough_surface) {
  const Mesh mesh = square_mesh(16, 4.0, 0.3, [](double x, double y) {
    return 0.04 * std::sin(7.0 * x) * std::cos(6.0 * y);
  });
  const Force f = force_of({2.03, 1.97, 0.4}, 0.5, mesh);
  EXPECT_GT(f.on_sphere.z, 1e-3);
  EXPECT_LT(norm(f.torque), 1e-14 * norm(f.on_sphere));
}

}  // namespace ball_flux_test
}  // namespace breccia::coupled
