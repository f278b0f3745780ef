// Flow through triangles by the cubic law, and a front that spreads through them: levels,
// transients, radial flow, volume.

#include "fdem_shared/fluid/flow.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.hpp"
#include "fdem_shared/fluid/spreading.hpp"
#include "math/constants.hpp"

namespace breccia::fdem_shared {
namespace flow3_test {

constexpr double mu = 1e-3, bulk = 2.2e9;

struct Surface {
  std::vector<Vec2> point;
  std::vector<std::array<Index, 3>> triangle;

  template <class Take>
  std::vector<Port> ports(const Take& take) const {
    std::vector<Port> all;
    for (const auto& t : triangle)
      for (std::size_t k = 0; k < 3; ++k)
        if (take(point[at(t[k])]) && take(point[at(t[(k + 1) % 3])]))
          all.push_back(port_between(t[k], t[(k + 1) % 3]));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
  double edge(std::size_t t, std::size_t k) const {
    return norm(point[at(triangle[t][(k + 1) % 3])] - point[at(triangle[t][k])]);
  }
  std::vector<FaceCell> cells(double aperture, double filled) const {
    std::vector<FaceCell> all;
    for (std::size_t t = 0; t < triangle.size(); ++t) {
      FaceCell c;
      const Vec2& p = point[at(triangle[t][0])];
      c.area = 0.5 * std::abs(cross(point[at(triangle[t][1])] - p, point[at(triangle[t][2])] - p));
      for (std::size_t k = 0; k < 3; ++k) {
        c.port[k] = port_between(triangle[t][k], triangle[t][(k + 1) % 3]);
        c.edge[k] = edge(t, k);
      }
      c.aperture = aperture;
      c.bulk = bulk;
      c.fluid = filled * c.room();
      all.push_back(c);
    }
    return all;
  }
  Vec2 middle(std::size_t t) const {
    return (1.0 / 3.0) *
           (point[at(triangle[t][0])] + point[at(triangle[t][1])] + point[at(triangle[t][2])]);
  }
};

/// nx by ny squares of the side 1, each cut in two, whose corners inside are moved by up to
/// `share`.
Surface strip(int nx, int ny, double share) {
  Surface s;
  const Random random{7, 3};
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      Vec2 x{static_cast<double>(i), static_cast<double>(j)};
      const bool inside = i > 0 && i < nx && j > 0 && j < ny;
      const auto n = static_cast<std::uint64_t>(2 * s.point.size());
      if (inside)
        x += share * Vec2{2.0 * random.uniform(n) - 1.0, 2.0 * random.uniform(n + 1) - 1.0};
      s.point.push_back(x);
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index p = j * (nx + 1) + i, q = p + 1, r = p + nx + 1, o = r + 1;
      s.triangle.push_back({p, q, o});
      s.triangle.push_back({p, o, r});
    }
  return s;
}

/// A ring, by steps of the radius that grow with it.
Surface ring(double inner, double outer, int rings, int around) {
  Surface s;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < around; ++k) {
      const double r = inner * std::pow(outer / inner, static_cast<double>(i) / rings);
      const double turn = 2.0 * pi * (k + 0.5 * (i % 2)) / around;
      s.point.push_back({r * std::cos(turn), r * std::sin(turn)});
    }
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const Index p = i * around + k, q = i * around + (k + 1) % around, r = p + around,
                  o = q + around;
      if (i % 2 == 0) {
        s.triangle.push_back({p, r, q});
        s.triangle.push_back({q, r, o});
      } else {
        s.triangle.push_back({p, o, q});
        s.triangle.push_back({p, r, o});
      }
    }
  return s;
}

double held(const std::vector<FaceCell>& cells) {
  double sum = 0.0;
  for (const FaceCell& c : cells) sum += c.fluid;
  return sum;
}

/// Between two levels b a^3 dp/(12 mu L) passes, on triangles of any shape.
TEST(FaceFlow, passes_between_two_levels_as_the_cubic_law_says) {
  constexpr double a = 3e-5, dp = 2e5;
  for (const double share : {0.0, 0.1, 0.2}) {
    const Surface s = strip(24, 12, share);
    std::vector<FaceCell> cells = s.cells(a, 1.0);
    const FlowSource source{s.ports([](const Vec2& x) { return x.x < 1e-9; }), false, 3e5,
                            s.ports([](const Vec2& x) { return x.x > 24.0 - 1e-9; }), 1e5};
    const double before = held(cells);
    double came = 0.0;
    for (int step = 0; step < 4; ++step) {
      const Flowed first = flow(cells, source, mu, 100.0);
      came += first.injected - first.released;
    }
    EXPECT_NEAR(held(cells) - before, came, 1e-12 * before);
    const Flowed then = flow(cells, source, mu, 1.0);
    const double rate = 12.0 * a * a * a * dp / (12.0 * mu * 24.0);
    EXPECT_NEAR(then.injected, rate, 1e-6 * rate);
    EXPECT_NEAR(then.released, then.injected, 1e-6 * rate);
    double worst = 0.0;
    for (std::size_t t = 0; t < cells.size(); ++t)
      worst = std::max(worst, std::abs(cells[t].pressure() - 3e5 + dp * s.middle(t).x / 24.0) / dp);
    EXPECT_LT(worst, 1e-6);
  }
}

/// 2 pi a^3 dp/(12 mu ln(R/r)).
TEST(FaceFlow, passes_from_a_hole_to_a_rim) {
  constexpr double a = 5e-5, dp = 1e5;
  double missed[2];
  for (int k = 0; k < 2; ++k) {
    const Surface s = ring(0.1, 3.0, 10 << k, 18 << k);
    std::vector<FaceCell> cells = s.cells(a, 1.0);
    const FlowSource source{s.ports([](const Vec2& x) { return norm(x) < 0.1 + 1e-9; }), false, dp,
                            s.ports([](const Vec2& x) { return norm(x) > 3.0 - 1e-9; }), 0.0};
    for (int step = 0; step < 4; ++step) flow(cells, source, mu, 100.0);
    const double rate = 2.0 * pi * a * a * a * dp / (12.0 * mu * std::log(30.0));
    missed[k] = flow(cells, source, mu, 1.0).injected / rate - 1.0;
    std::printf("%d rings: %+.3f %%\n", 10 << k, 100.0 * missed[k]);
  }
  EXPECT_LT(std::abs(missed[1]), 0.01);
  EXPECT_LT(std::abs(missed[1]), 0.5 * std::abs(missed[0]));
}

/// p/p_0 = erfc(x/(2 sqrt(D t))), D = K a^2/(12 mu).
TEST(FaceFlow, diffuses_along_a_slit) {
  constexpr double a = 5e-5, p0 = 1e6;
  const double diffusivity = bulk * a * a / (12.0 * mu), time = 60.0 / diffusivity;
  const Surface s = strip(100, 2, 0.0);
  std::vector<FaceCell> cells = s.cells(a, 1.0);
  const FlowSource source{s.ports([](const Vec2& x) { return x.x < 1e-9; }), false, p0};
  double came = 0.0;
  const double before = held(cells);
  for (int step = 0; step < 200; ++step) came += flow(cells, source, mu, time / 200.0).injected;
  EXPECT_NEAR(held(cells) - before, came, 1e-12 * before);
  for (std::size_t t = 0; t < cells.size(); ++t)
    EXPECT_NEAR(cells[t].pressure() / p0,
                std::erfc(s.middle(t).x / (2.0 * std::sqrt(diffusivity * time))), 0.005);
  EXPECT_NEAR(came, 2.0 * a * p0 / bulk * std::sqrt(4.0 * diffusivity * time / pi), 0.01 * came);
}

/// A rate Q from a point into a full slit without end (Theis 1935): p = 12 mu Q/(4 pi a^3)
/// E_1(r^2/(4 D t)). The largest misfit from 0.1 to 8 m, over the factor of E_1.
double misfit_of_theis(int rings, int around) {
  constexpr double a = 1e-4, rate = 1e-6;
  const double diffusivity = bulk * a * a / (12.0 * mu), time = 4.0 / diffusivity;
  const Surface s = ring(0.02, 30.0, rings, around);
  std::vector<FaceCell> cells = s.cells(a, 1.0);
  const FlowSource source{s.ports([](const Vec2& x) { return norm(x) < 0.02 + 1e-9; }), true, rate};
  double came = 0.0;
  const double before = held(cells);
  for (int step = 0; step < 400; ++step) came += flow(cells, source, mu, time / 400.0).injected;
  EXPECT_NEAR(came, rate * time, 1e-12 * came);
  EXPECT_NEAR(held(cells) - before, came, 1e-12 * before);
  const double scale = 12.0 * mu * rate / (4.0 * pi * a * a * a);
  double worst = 0.0;
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const double r = norm(s.middle(t));
    if (r < 0.1 || r > 8.0) continue;
    const double closed = -scale * std::expint(-r * r / (4.0 * diffusivity * time));
    worst = std::max(worst, std::abs(cells[t].pressure() - closed) / scale);
  }
  return worst;
}
TEST(FaceFlow, spreads_from_a_point_at_a_given_rate) {
  const double coarse = misfit_of_theis(24, 18), fine = misfit_of_theis(48, 36);
  std::printf("misfit of E_1: %.4f, %.4f\n", coarse, fine);
  EXPECT_LT(fine, 0.4 * coarse);
  EXPECT_LT(fine, 0.05);  // of 6.7 at 0.1 m
}

/// A given rate into a dry slit: a circle of fluid with the area Q t/a.
TEST(FaceFlow, fills_a_dry_slit_with_a_front) {
  constexpr double a = 1e-4, rate = 1e-4;
  const Surface s = ring(0.05, 3.0, 30, 24);
  std::vector<FaceCell> cells = s.cells(a, 0.0);
  const FlowSource source{s.ports([](const Vec2& x) { return norm(x) < 0.05 + 1e-9; }), true, rate};
  double came = 0.0;
  for (int k = 0; k < 300; ++k) came += flow(cells, source, mu, 0.01).injected;
  EXPECT_NEAR(came, rate * 3.0, 1e-15);
  EXPECT_NEAR(held(cells), came, 1e-15);
  const double front = std::sqrt(rate * 3.0 / (a * pi) + 0.05 * 0.05);  // 0.98 m
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const double r = norm(s.middle(t));
    if (r < 0.85 * front) {
      EXPECT_GT(cells[t].pressure(), 0.0) << r;
    }
    if (r > 1.15 * front) {
      EXPECT_EQ(cells[t].pressure(), 0.0) << r;
    }
  }
}

/// Cracks of a surface, broken from the start.
std::vector<FaceCrack> cracks_of(const Surface& s) {
  std::vector<FaceCrack> all;
  for (std::size_t t = 0; t < s.triangle.size(); ++t) {
    FaceCrack c;
    c.a = static_cast<Index>(2 * t);
    c.b = c.a + 1;
    for (std::size_t k = 0; k < 3; ++k) {
      c.port[k] = port_between(s.triangle[t][k], s.triangle[t][(k + 1) % 3]);
      c.edge[k] = s.edge(t, k);
    }
    all.push_back(c);
  }
  return all;
}

/// The front runs at its speed along a strip, a little later where ways from middle to middle of
/// edges bend: by sqrt(2) at most, in right triangles.
TEST(FaceSpreading, runs_at_its_speed) {
  const Surface s = strip(20, 4, 0.0);
  const std::vector<FaceCrack> cracks = cracks_of(s);
  const std::vector<Port> source = s.ports([](const Vec2& x) { return x.x < 1e-9; });
  double area = 0.0, last = -1.0;
  for (const double time : {0.0, 2.0, 4.0, 6.0}) {
    area = 0.0;
    double far = 0.0;
    for (const auto& f : filled_cracks(cracks, source, 2.0, time)) {
      area += f.share * f.crack.area();
      far = std::max(far, s.middle(static_cast<std::size_t>(f.crack.a / 2)).x);
    }
    EXPECT_GT(area, last);
    EXPECT_LE(far, 2.0 * time + 1.0);
    EXPECT_LE(area, 4.0 * (2.0 * time + 1.0));
    EXPECT_GE(area, 4.0 * 2.0 * time / std::sqrt(2.0) - 4.0);
    last = area;
  }
}

/// Through edges alone: two triangles that share a corner are not connected.
TEST(FaceSpreading, goes_through_edges_and_waits_for_cracks_to_break) {
  FaceCrack first{0, 1, 0, {port_between(0, 1), port_between(1, 2), port_between(2, 0)}, {1, 1, 1}};
  FaceCrack second{
      2, 3, 0, {port_between(1, 2), port_between(2, 3), port_between(3, 1)}, {1, 1, 1}};
  FaceCrack corner{
      4, 5, 0, {port_between(0, 7), port_between(7, 8), port_between(8, 0)}, {1, 1, 1}};
  second.since = 3.0;
  const std::vector<FaceCrack> all{first, second, corner};
  const std::vector<Port> source{port_between(0, 1)};
  EXPECT_EQ(filled_cracks(all, source, 0.0, 2.0).size(), 1U);
  EXPECT_EQ(filled_cracks(all, source, 0.0, 3.0).size(), 2U);
  EXPECT_NEAR(first.depth(0), std::sqrt(0.75), 1e-12);
  EXPECT_EQ(first.way(0, 1), 0.5);
  const auto at = [&](double now) { return filled_cracks(all, source, 1.0, now); };
  EXPECT_EQ(at(0.0).size(), 0U);
  EXPECT_NEAR(at(0.3)[0].share, 0.3 / std::sqrt(0.75), 1e-12);
  EXPECT_EQ(at(3.0).size(), 1U);
  EXPECT_NEAR(at(3.3)[1].share, 0.3 / std::sqrt(0.75), 1e-12);
}

}  // namespace flow3_test
}  // namespace breccia::fdem_shared
