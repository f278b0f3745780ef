// Gas of an explosive in a cavity of tetrahedra: its pressure follows from how far it has grown.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/servo.hpp"
#include "exec/error.hpp"
#include "fdem3/fluid/fluid.hpp"
#include "fdem_shared/fluid/gas.hpp"
#include "math/constants.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia::fdem3 {
namespace explosive_test {

using testing::far;
using testing::Scene;

constexpr double inner = 0.02, outer = 0.06;
const fdem_shared::ExplosiveGas gas =
    fdem_shared::ExplosiveGas::of(49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9);

/// A surface, on which a wall of some layers stands.
struct Surface {
  std::vector<Vec3> point;  ///< of the wall's inner side  [m]
  std::vector<std::array<Index, 3>> triangle;
};
/// Prisms on its triangles, each cut into three tetrahedra by the order of its vertices.
/// @param place  place(point, ratio): where the point is in a layer that lies so much further out
template <class Place>
prepare::TetMesh walled(const Surface& surface, int layers, const Place& place) {
  prepare::TetMesh mesh;
  const auto count = static_cast<Index>(surface.point.size());
  for (int i = 0; i <= layers; ++i)
    for (const Vec3& x : surface.point)
      mesh.point.push_back(place(x, std::pow(outer / inner, static_cast<double>(i) / layers)));
  const auto add = [&](Index a, Index b, Index c, Index d) {
    const auto x = [&](Index v) { return mesh.point[at(v)]; };
    if (dot(x(b) - x(a), cross(x(c) - x(a), x(d) - x(a))) < 0.0) std::swap(c, d);
    mesh.tetrahedron.push_back({a, b, c, d});
  };
  for (int i = 0; i < layers; ++i)
    for (std::array<Index, 3> t : surface.triangle) {
      std::sort(t.begin(), t.end());
      const Index low = count * i, high = low + count;
      add(low + t[0], low + t[1], low + t[2], high + t[2]);
      add(low + t[0], low + t[1], high + t[1], high + t[2]);
      add(low + t[0], high + t[0], high + t[1], high + t[2]);
    }
  return mesh;
}
/// A ball with a ball in its middle: an octahedron's faces in n^2 triangles each.
prepare::TetMesh shell(int n, int layers = 4) {
  Surface ball;
  std::map<std::array<int, 3>, Index> number;
  const auto vertex = [&](std::array<int, 3> at_grid, const std::array<int, 3>& sign) {
    for (std::size_t k = 0; k < 3; ++k) at_grid[k] *= sign[k];
    const auto [found, is_new] = number.emplace(at_grid, static_cast<Index>(ball.point.size()));
    const Vec3 x{1.0 * at_grid[0], 1.0 * at_grid[1], 1.0 * at_grid[2]};
    if (is_new) ball.point.push_back((inner / norm(x)) * x);
    return found->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const std::array<int, 3> sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto corner = [&](int di, int dj) {
          return vertex({i + di, j + dj, n - i - j - di - dj}, sign);
        };
        ball.triangle.push_back({corner(0, 0), corner(1, 0), corner(0, 1)});
        if (i + j + 1 < n) ball.triangle.push_back({corner(1, 0), corner(1, 1), corner(0, 1)});
      }
  }
  return walled(ball, layers, [](const Vec3& x, double ratio) { return ratio * x; });
}
/// A slice of a tube.
prepare::TetMesh tube(int sectors) {
  Surface ring;
  constexpr int rows = 2;
  for (int row = 0; row <= rows; ++row)
    for (int k = 0; k < sectors; ++k) {
      const double angle = 2.0 * pi * k / sectors;
      ring.point.push_back(
          {inner * std::cos(angle), inner * std::sin(angle), 0.3 * inner * (row - 0.5 * rows)});
    }
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < sectors; ++k) {
      const Index p = row * sectors + k, q = row * sectors + (k + 1) % sectors;
      ring.triangle.push_back({p, q, q + sectors});
      ring.triangle.push_back({p, q + sectors, p + sectors});
    }
  return walled(ring, 4, [](const Vec3& x, double ratio) {
    return Vec3{ratio * x.x, ratio * x.y, x.z};
  });
}
Scene charged(const prepare::TetMesh& mesh, double charge, double young) {
  Scene s;
  s.material(young, 0.2, 2000.0).damping = 0.5;
  s.body("rock", mesh);
  LoadConfig& load = s.load("anfo", "fluid", {}, {});
  load.region.min = {-far, -far, -far};
  load.region.max = {far, far, far};
  load.region.radius = 1.05 * inner;
  load.explosive = {49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9, charge, false};
  return s;
}
void run_to(World& w, double time) {
  while (w.time < time) {
    step(w);
    if (w.step % servo_every == 0) spread_fluid(w);
  }
}

TEST(ExplosiveInSpace, that_fills_its_hole_begins_with_the_pressure_of_the_volume_one) {
  const World w = charged(shell(1), 0.0, 50e9).world();
  const double octahedron = 4.0 / 3.0 * inner * inner * inner;
  EXPECT_NEAR(w.given->fluids[0].charge, octahedron, 1e-12 * octahedron);
  EXPECT_NEAR(w.fluid.gas.data()[0].pressure, gas.pressure(1.0), 1e-9 * gas.pressure(1.0));
}

/// Moves those elements of an octahedron's wall that `moves` names by a way along (1, 1, 1), each
/// part by the signs of where it is.
template <class Moves>
void part(World& w, double away, const Moves& moves) {
  for (Index t = 0; t < w.tetrahedra.size(); ++t) {
    const Vec3 middle = centroid(w.tetrahedra.nodes.data()[t]);
    const Vec3 outward{std::copysign(away, middle.x), std::copysign(away, middle.y),
                       std::copysign(away, middle.z)};
    if (!moves(middle)) continue;
    for (NodeState& n : w.tetrahedra.nodes.data()[t].at) n.position += outward;
  }
}

/// The eight sides of an octahedron move apart: the hole reaches to the middle of what was a
/// corner.
TEST(ExplosiveInSpace, fills_a_hole_whose_wall_has_parted) {
  World w = charged(shell(1), 0.0, 50e9).world();
  constexpr double away = 1e-3;
  part(w, away, [](const Vec3&) { return true; });
  const double half = inner + away, exact = 4.0 / 3.0 * half * half * half;
  EXPECT_NEAR(gas_volume(w, w.given->fluids[0]), exact, 1e-12 * exact);
}

/// One of them alone moves by d along each axis, and takes a quarter of the way of three corners:
/// 4/3 a^3 (1 + 3 d/(8 a)). By any one of the sides at a corner it would be another volume.
TEST(ExplosiveInSpace, fills_a_hole_by_the_mean_of_what_has_parted) {
  World w = charged(shell(1), 0.0, 50e9).world();
  constexpr double away = 1e-3;
  part(w, away, [](const Vec3& x) { return x.x > 0.0 && x.y > 0.0 && x.z > 0.0; });
  const double exact = 4.0 / 3.0 * inner * inner * inner * (1.0 + 3.0 * away / (8.0 * inner));
  EXPECT_NEAR(gas_volume(w, w.given->fluids[0]), exact, 1e-12 * exact);
}

/// At rest the gas has the pressure of its volume, the rock that of Lame, and the ledger the energy
/// that the gas gave: charge (E(V_0) - E(V)).
/// @param end  by when it is at rest  [s]  @param over  volume over that at the start, to the
/// widening of the wall
template <class Widening>
void expect_at_rest(Scene s, double end, double widening_of_one, const Widening& over) {
  const double whole = s.world().given->fluids[0].charge, charge = 0.1 * whole;
  s.config.loads[0].explosive.charge = charge;
  World w = s.world();
  const double before = gas_volume(w, w.given->fluids[0]) / charge;
  EXPECT_NEAR(before, 10.0, 1e-9);
  run_to(w, end);
  const EnergyBalance sum = energies(w).balance;
  EXPECT_LT(sum.kinetic, 1e-4 * sum.elastic);
  const double volume = gas_volume(w, w.given->fluids[0]) / charge;
  const double pressure = w.fluid.gas.data()[0].pressure;
  EXPECT_NEAR(pressure, gas.pressure(volume), 1e-3 * pressure);
  EXPECT_LT(pressure, 0.98 * gas.pressure(before));
  const double widening = pressure * widening_of_one;
  EXPECT_NEAR(over(volume / before), widening, 0.08 * widening);
  const double given = charge * (gas.energy(before) - gas.energy(volume));
  EXPECT_NEAR(sum.work, given, 0.01 * given);
}
TEST(ExplosiveInSpace, pushes_a_closed_wall_by_the_volume_that_it_gains) {
  const Vec3 from[4] = {{0.0, 0.0, 0.0}, {1.0, 0.2, 0.1}, {0.3, 0.9, -0.1}, {0.2, 0.3, 1.1}};
  const Vec3 to[4] = {{-0.2, 0.1, 0.3}, {1.4, -0.3, 0.2}, {0.9, 1.8, -0.4}, {0.1, 0.5, 1.9}};
  const auto volume = [](const Vec3(&x)[4]) {
    return dot(x[3] - x[0], cross(x[1] - x[0], x[2] - x[0])) / 6.0;
  };
  const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  double swept = 0.0;
  for (const auto& f : face)
    swept +=
        fdem_shared::swept({from[f[0]], from[f[1]], from[f[2]]}, {to[f[0]], to[f[1]], to[f[2]]});
  EXPECT_NEAR(swept, volume(to) - volume(from), 1e-15);
}

constexpr double young = 2e9, nu = 0.2;

TEST(ExplosiveInSpace, comes_to_rest_in_a_ball) {
  const double ratio = outer * outer * outer / (inner * inner * inner);
  expect_at_rest(charged(shell(5, 6), 0.0, young), 6e-4,
                 (1.0 - 2.0 * nu + 0.5 * (1.0 + nu) * ratio) / (ratio - 1.0) / young,
                 [](double grown) { return std::cbrt(grown) - 1.0; });
}
/// Between two planes that do not move: stemming closes its ends.
TEST(ExplosiveInSpace, comes_to_rest_in_a_borehole) {
  Scene s = charged(tube(24), 0.0, young);
  s.config.loads[0].region.around = "z";
  s.config.loads[0].explosive.capped = true;
  s.support("planes", {-far, -far, -far}, {far, far, far}, {"z"});
  const double ratio = outer * outer / (inner * inner);
  expect_at_rest(s, 1.5e-3, (1.0 + nu) * (1.0 - 2.0 * nu + ratio) / (ratio - 1.0) / young,
                 [](double grown) { return std::sqrt(grown) - 1.0; });
}

std::string refused(const Scene& s) {
  try {
    s.world();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
TEST(ExplosiveInSpace, needs_the_whole_wall_of_a_hole) {
  Scene s = charged(shell(2), 0.0, 50e9);
  EXPECT_EQ(refused(s), "");
  s.config.loads[0].region.min = {0.0, -far, -far};
  EXPECT_NE(refused(s).find("takes a part of a border only"), std::string::npos) << refused(s);
  s.config.loads[0].explosive.capped = true;  // half of the ball, then
  EXPECT_EQ(refused(s), "");
  s = charged(shell(2), 0.0, 50e9);
  s.config.loads[0].region.radius = 2.0 * outer;
  EXPECT_NE(refused(s).find("outer border"), std::string::npos) << refused(s);
  s.config.loads[0].region.radius = 0.1 * inner;
  EXPECT_NE(refused(s).find("region"), std::string::npos) << refused(s);
  s = charged(tube(12), 0.0, 50e9);
  s.config.loads[0].region.around = "z";
  EXPECT_NE(refused(s).find("takes a part of a border only"), std::string::npos) << refused(s);
}

}  // namespace explosive_test
}  // namespace breccia::fdem3
