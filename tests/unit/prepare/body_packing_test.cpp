// Packings by sieve curve and porosity, and cut from periodic cells.

#include "prepare/packing/body_packing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "unit/prepare/models.hpp"

namespace breccia::prepare {
namespace body_packing_test {

using dem::BodyConfig;
using dem::Config;

double ball(double r) {
  return 4.0 / 3.0 * pi * r * r * r;
}
double solid(const BodyPacking& p) {
  double sum = 0.0;
  for (const double r : p.radius) sum += ball(r);
  return sum;
}

BodyConfig box(const Vec3& size, int count, double compactness = 0.58) {
  return dem::box_body("body", size, count, compactness);
}
BodyConfig graded(const Vec3& size) {
  BodyConfig body = box(size, 0);
  body.pack.sieves = {4e-3, 8e-3, 12e-3, 16e-3};
  body.pack.passing = {0.0, 0.3, 0.45, 1.0};
  return body;
}
BodyConfig periodic(BodyConfig body, std::vector<std::string> axes = {"x", "y", "z"}) {
  body.pack.periodic = std::move(axes);
  return body;
}
BodyPacking packed(const BodyConfig& body, std::uint64_t seed = 1) {
  return pack_body(body, {}, 0.0, {seed, 0});
}

/// Shares of the mass, or of the number, below a diameter; `spread` is the standard error of such a
/// share of independent draws.
struct Passed {
  double mass = 0.0, spread = 0.0;
};
Passed passed(const BodyPacking& p, double sieve) {
  double all = 0.0, squares = 0.0, below = 0.0;
  for (const double r : p.radius) {
    all += ball(r);
    squares += ball(r) * ball(r);
    if (2.0 * r < sieve) below += ball(r);
  }
  const double share = below / all;
  double variance = 0.0;
  for (const double r : p.radius) {
    const double off = (2.0 * r < sieve ? 1.0 : 0.0) - share;
    variance += ball(r) * ball(r) * off * off;
  }
  return {share, std::sqrt(variance) / all};
}

TEST(BodyPacking, FollowsItsSieveCurveOverSeeds) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const BodyPacking p = packed(graded({0.12, 0.12, 0.12}), seed);
    EXPECT_NEAR(solid(p), 0.58 * 0.12 * 0.12 * 0.12, 1e-12);
    // At the sieves, and between them, where the curve is linear in the size.
    for (const auto& [sieve, share] : {std::pair{6e-3, 0.15},
                                       {8e-3, 0.3},
                                       {10e-3, 0.375},
                                       {12e-3, 0.45},
                                       {13e-3, 0.5875},
                                       {15e-3, 0.8625}}) {
      const Passed found = passed(p, sieve);
      EXPECT_NEAR(found.mass, share, found.spread) << sieve << " seed " << seed;
      EXPECT_LT(found.spread, 0.05);
    }
    const auto [least, most] = std::minmax_element(p.radius.begin(), p.radius.end());
    EXPECT_GT(2.0 * *least, 4e-3 * 0.99);
    EXPECT_LT(2.0 * *most, 16e-3 * 1.01);
  }
}

/// The number of spheres of a mass in closed form.
TEST(BodyPacking, HasAsManyElementsAsItsSievesSay) {
  const double a = 4e-3, b = 8e-3;
  const Grading one{{a, b}, {0.0, 1.0}};
  // 1 / integral of 6 / (pi d^3) over [a, b], over b - a
  const double expected = pi * (b - a) / (3.0 * (1.0 / (a * a) - 1.0 / (b * b)));
  EXPECT_NEAR(one.mean_volume(), expected, 1e-12 * expected);
  EXPECT_NEAR(one.diameter_at(0.0), a, 1e-15);
  EXPECT_NEAR(one.diameter_at(1.0), b, 1e-15);
  const BodyConfig body = graded({0.1, 0.1, 0.1});
  const double count = elements_in(body.pack, 1e-3);
  EXPECT_EQ(packed(body).radius.size(), static_cast<std::size_t>(count));
  // Twice the sizes: an eighth of the elements.
  BodyConfig coarse = body;
  for (double& sieve : coarse.pack.sieves) sieve *= 2.0;
  EXPECT_NEAR(elements_in(coarse.pack, 8e-3), count, 1.0);
}

TEST(BodyPacking, HasTheMassOfItsBulk) {
  Config config = dem::case_with_materials();
  for (BodyConfig body : {graded({0.1, 0.1, 0.1}), periodic(graded({0.1, 0.1, 0.1})),
                          periodic(box({0.1, 0.05, 0.1}, 500))}) {
    body.name = "one";
    config.bodies = {body};
    const dem::Model m = build_model(config, ".");
    const double mass = std::accumulate(m.mass.begin(), m.mass.end(), 0.0);
    const double volume = body.size.x * body.size.y * body.size.z;
    EXPECT_NEAR(mass, 2400.0 * volume, 1e-9 * mass);
  }
  BodyConfig round = periodic(box({}, 2000));
  round.shape = "cylinder";
  round.radius = 0.05, round.length = 0.1;
  config.bodies = {round};
  const dem::Model m = build_model(config, ".");
  const double mass = std::accumulate(m.mass.begin(), m.mass.end(), 0.0);
  EXPECT_NEAR(mass, 2400.0 * pi * 0.0025 * 0.1, 1e-9 * mass);
  EXPECT_NEAR(m.size(), 2000, 3.0 * std::sqrt(2000.0));
}

TEST(BodyPacking, ReachesAPorosityOrSaysThatItDoesNot) {
  BodyConfig body = box({0.1, 0.1, 0.1}, 800);
  body.pack.porosity = 0.42;
  const BodyPacking p = packed(body);
  EXPECT_NEAR(1.0 - solid(p) / 1e-3, 0.42, 1e-9);
  double worst = 0.0;
  for (std::size_t i = 0; i < p.radius.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double overlap = p.radius[i] + p.radius[j] - norm(p.position[i] - p.position[j]);
      worst = std::max(worst, overlap / std::min(p.radius[i], p.radius[j]));
    }
  EXPECT_LE(worst, overlap_tolerance);
  body.pack.porosity = 0.3;  // denser than any disordered packing of these spheres
  try {
    packed(body);
    FAIL() << "was packed";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("body.body.pack.porosity = 0.3 is not reached"),
              std::string::npos)
        << e.what();
  }
}

/// Neighbours within 1.4 (R_i + R_j), images of a periodic cell counted.
std::vector<int> neighbours(const BodyPacking& p, const Vec3& cell) {
  std::vector<int> found(p.radius.size());
  const auto near = [](double d, double edge) {
    return edge > 0.0 ? d - edge * std::round(d / edge) : d;
  };
  for (std::size_t i = 0; i < p.radius.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 d = p.position[i] - p.position[j];
      const Vec3 apart{near(d.x, cell.x), near(d.y, cell.y), near(d.z, cell.z)};
      if (norm(apart) > 1.4 * (p.radius[i] + p.radius[j])) continue;
      ++found[i], ++found[j];
    }
  return found;
}

struct Mean {
  double value = 0.0, error = 0.0;
};
Mean mean_of(const std::vector<double>& values) {
  Mean m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) m.value += v / n;
  for (const double v : values) m.error += (v - m.value) * (v - m.value);
  m.error = std::sqrt(m.error / (n * (n - 1.0)));
  return m;
}

/// At a wall the first layer has no centres within R and half of the neighbours.
TEST(BodyPacking, OfAPeriodicCellIsAtItsBorderAsItIsWithin) {
  const double edge = 0.1;
  int outer = 0, all = 0;
  std::vector<double> at_border, within, crossing_border, crossing_middle;
  double depth = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const BodyPacking p = packed(periodic(box({edge, edge, edge}, 1500)), seed);
    EXPECT_EQ(p.radius.size(), 1500U);
    double mean = 0.0;
    for (const double r : p.radius) mean += r / 1500.0;
    depth = mean;
    const std::vector<int> links = neighbours(p, {edge, edge, edge});
    for (std::size_t i = 0; i < p.radius.size(); ++i) {
      const Vec3 x = p.position[i];
      EXPECT_TRUE(std::fabs(x.x) <= 0.5 * edge && std::fabs(x.y) <= 0.5 * edge &&
                  std::fabs(x.z) <= 0.5 * edge);
      const double from_face = 0.5 * edge - std::fabs(x.x);
      ++all;
      if (from_face < mean) ++outer, at_border.push_back(links[i]);
      if (from_face > 4.0 * mean) within.push_back(links[i]);
    }
    // Pairs that cross the border, and those that cross the middle plane.
    int border = 0, middle = 0;
    for (std::size_t i = 0; i < p.radius.size(); ++i)
      for (std::size_t j = 0; j < p.radius.size(); ++j) {
        const Vec3 d = p.position[j] - p.position[i];
        const auto near = [&](double v) { return v - edge * std::round(v / edge); };
        const Vec3 apart{near(d.x), near(d.y), near(d.z)};
        if (i == j || norm(apart) > 1.4 * (p.radius[i] + p.radius[j])) continue;
        const double end = p.position[i].x + apart.x;
        border += end > 0.5 * edge ? 1 : 0;
        middle += p.position[i].x < 0.0 && end > 0.0 && std::fabs(p.position[i].x) < 0.3 * edge;
      }
    crossing_border.push_back(border);
    crossing_middle.push_back(middle);
  }
  const Mean border = mean_of(at_border), bulk = mean_of(within);
  std::printf(
      "neighbours %.2f +- %.2f at the border, %.2f +- %.2f within; pairs across %.0f, %.0f\n",
      border.value, border.error, bulk.value, bulk.error, mean_of(crossing_border).value,
      mean_of(crossing_middle).value);
  EXPECT_NEAR(border.value, bulk.value, 3.0 * std::hypot(border.error, bulk.error));
  const double share = 2.0 * depth / edge;
  EXPECT_NEAR(outer / static_cast<double>(all), share, 3.0 * std::sqrt(share / all));
  const double across = mean_of(crossing_middle).value;
  EXPECT_NEAR(mean_of(crossing_border).value, across, 3.0 * std::sqrt(2.0 * across / 3.0));
}

TEST(BodyPacking, OverlapsNothingAcrossItsBorder) {
  const double edge = 0.1;
  const BodyPacking p = packed(periodic(box({edge, edge, edge}, 600)));
  double worst = 0.0;
  for (std::size_t i = 0; i < p.radius.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 d = p.position[i] - p.position[j];
      const auto near = [&](double v) { return v - edge * std::round(v / edge); };
      const double overlap =
          p.radius[i] + p.radius[j] - norm(Vec3{near(d.x), near(d.y), near(d.z)});
      worst = std::max(worst, overlap / std::min(p.radius[i], p.radius[j]));
    }
  EXPECT_LE(worst, overlap_tolerance);
}

/// Walls along z only: nothing reaches beyond them, and elements do beyond the other faces.
TEST(BodyPacking, KeepsTheFacesThatAreNotPeriodic) {
  const BodyPacking p = packed(periodic(box({0.1, 0.1, 0.1}, 600), {"x", "y"}));
  double out_x = 0.0, out_z = 0.0;
  for (std::size_t i = 0; i < p.radius.size(); ++i) {
    out_x = std::max(out_x, std::fabs(p.position[i].x) + p.radius[i] - 0.05);
    out_z = std::max(out_z, std::fabs(p.position[i].z) + p.radius[i] - 0.05);
  }
  EXPECT_LE(out_z, 0.01 * p.radius[0]);
  EXPECT_GT(out_x, 0.5 * p.radius[0]);
}

/// A bar of twelve cells: each element has its likeness one cell further on.
TEST(BodyPacking, RepeatsACell) {
  BodyConfig body = periodic(box({0.24, 0.08, 0.12}, 2304));
  body.pack.cell = {0.08, 0.0, 0.06};
  const BodyPacking p = packed(body);
  EXPECT_EQ(p.radius.size(), 2304U);
  EXPECT_NEAR(p.compactness, 0.58, 1e-9);
  int alike = 0, asked = 0;
  for (std::size_t i = 0; i < p.radius.size(); ++i) {
    if (p.position[i].x > 0.03) continue;
    ++asked;
    for (std::size_t j = 0; j < p.radius.size(); ++j)
      if (p.radius[i] == p.radius[j] &&
          norm(p.position[j] - p.position[i] - Vec3{0.08, 0.0, 0.0}) < 1e-12)
        ++alike;
  }
  EXPECT_EQ(alike, asked);
  // A body smaller than its cell is cut from it.
  body.size = {0.05, 0.08, 0.06};
  body.pack.count = 240;
  const BodyPacking part = packed(body);
  EXPECT_NEAR(static_cast<double>(part.radius.size()), 240.0, 3.0 * std::sqrt(240.0));
}

TEST(BodyPacking, RefusesWhatCannotBePacked) {
  const auto expect = [](const char* text, const BodyConfig& body) {
    Config config = dem::case_with_materials();
    config.bodies = {body};
    try {
      dem::check_case(config);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << text << "\n" << e.what();
    }
  };
  BodyConfig body = graded({0.1, 0.1, 0.1});
  body.pack.passing.pop_back();
  expect("body.body.pack.sieves has 4 sizes and .passing 3 shares", body);
  body = graded({0.1, 0.1, 0.1});
  body.pack.sieves[2] = 8e-3;
  expect("body.body.pack.sieves: 0.008 m is not above 0.008 m", body);
  body = graded({0.1, 0.1, 0.1});
  body.pack.passing[2] = 0.2;
  expect("body.body.pack.passing: 0.2 is below 0.3", body);
  body = graded({0.1, 0.1, 0.1});
  body.pack.passing[3] = 0.9;
  expect("body.body.pack.passing goes from 0 to 0.9", body);
  body = graded({0.1, 0.1, 0.1});
  body.pack.count = 100;
  expect("body.body.pack.count and .sieves are both given", body);
  expect("body.body.pack.sieves: an element is larger than the body", graded({4e-3, 4e-3, 4e-3}));
  expect("body.body.pack.sieves: 330 elements are too few", graded({0.1, 0.1, 0.014}));
  body = box({0.1, 0.1, 0.1}, 500);
  body.pack.porosity = 0.1;
  expect("body.body.pack.porosity = 0.1 is below 0.15", body);
  body.pack.porosity = 0.42;
  body.pack.compactness = 0.56;
  expect("body.body.pack.porosity and .compactness are both given", body);
  expect("body.body.pack.periodic: \"up\" is none of x, y, z",
         periodic(box({0.1, 0.1, 0.1}, 500), {"up"}));
  expect("too few for a periodic cell", periodic(box({0.1, 0.1, 0.1}, 8)));
  body = box({0.1, 0.1, 0.1}, 500);
  body.pack.cell = {0.05, 0.0, 0.0};
  expect("body.body.pack.cell has a length along x, but .periodic does not name x", body);
  body = periodic(box({}, 500), {"x"});
  body.shape = "cylinder";
  body.radius = 0.05, body.length = 0.1;
  expect("the round face of a cylinder is cut along x and y together", body);
  body.shape = "sphere";
  expect("a body of shape sphere is cut from a cell that is periodic along x, y and z", body);
}

}  // namespace body_packing_test
}  // namespace breccia::prepare
