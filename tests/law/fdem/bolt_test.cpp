// A bolt by itself: what it pulls with while a crack across it opens, beside closed answers.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fdem_shared/bolts/chain.hpp"

namespace breccia::fdem_shared {
namespace bolt_test {

using BoltNode = BoltNodeOf<Vec2>;

constexpr double half = 0.5;              ///< length on each side of the crack  [m]
const BoltLaw steel{2e7, 5e4, 1e9, 5e5};  // per metre of thickness
const double reach = std::sqrt(steel.stiffness / steel.bond_stiffness);  ///< of its bond  [m]

/// A bolt across a crack that opens in rock that is rigid on both sides.
struct Crossed {
  std::size_t pieces;  ///< on each side; one more crosses the crack
  bool start, end;     ///< whether its ends are anchored
  BoltLaw law = steel;
  std::vector<BoltNode> nodes = std::vector<BoltNode>(2 * pieces + 2);
  std::vector<double> length =
      std::vector<double>(2 * pieces + 1, half / static_cast<double>(pieces));

  Crossed(std::size_t count, bool start_anchored = false, bool end_anchored = false)
      : pieces(count), start(start_anchored), end(end_anchored) {
    length[pieces] = 1e-3;
    for (std::size_t j = 0; j < length.size(); ++j) nodes[j].rest = length[j];
  }
  /// @returns the force where it crosses the crack
  double open_to(double opening) {
    length[pieces] = 1e-3 + opening;
    BoltChain<BoltNode> chain(law, start, end, nodes.data(), length);
    chain.settle();
    return chain.force(pieces);
  }
  double elastic() { return BoltChain<BoltNode>(law, start, end, nodes.data(), length).elastic(); }
  double taken() const {
    double sum = 0.0;
    for (const BoltNode& n : nodes) sum += n.yielded + n.rubbed;
    return sum;
  }
};

/// E A u'' = k u on both sides: N = sqrt(E A k) tanh(l/reach) times the slip at the crack, coth
/// where its far ends are anchored.
TEST(Bolt, pulls_with_what_the_equation_of_its_bond_says) {
  constexpr double opening = 1e-5;
  const double stiff = std::sqrt(steel.stiffness * steel.bond_stiffness);
  const double gap = 1e-3 / steel.stiffness;  // what crosses the crack stretches, too
  for (const bool anchored : {false, true}) {
    const double share = anchored ? 1.0 / std::tanh(half / reach) : std::tanh(half / reach);
    const double at_gap = 0.5e-3 * steel.bond_stiffness;  // half of what crosses it is bonded
    const double exact = opening / (2.0 / (stiff * share + at_gap) + gap);
    double last = 0.0;
    for (const std::size_t pieces : {5, 10, 20}) {
      Crossed bolt(pieces, anchored, anchored);
      const double error = std::abs(bolt.open_to(opening) / exact - 1.0);
      if (last > 0.0) {
        EXPECT_LT(error, 0.3 * last) << pieces;  // by the square of the segments
      }
      last = error;
    }
    EXPECT_LT(last, 5e-3);
  }
}

/// Its bar holds f_y A, then a short bond t l.
TEST(Bolt, yields_and_is_pulled_out) {
  Crossed strong(10);
  for (double w = 0.0; w < 4e-3; w += 1e-4) strong.open_to(w);
  EXPECT_NEAR(strong.open_to(4e-3), steel.yield, 1e-6 * steel.yield);
  Crossed weak(10);
  weak.law.bond_strength = 6e4;
  for (double w = 0.0; w < 4e-3; w += 1e-4) weak.open_to(w);
  // Half of the segment that crosses the crack is bonded, too.
  EXPECT_NEAR(weak.open_to(4e-3), 6e4 * (half + 0.5e-3), 1e-5 * steel.yield);
}

/// One step may open the crack far beyond what its bond holds: all of that slips, in balance.
TEST(Bolt, is_in_balance_after_a_long_step) {
  for (const double opening : {1.75e-3, 5e-3, 0.05, 1.0}) {
    Crossed weak(10);
    weak.law.bond_strength = 6e4;
    EXPECT_NEAR(weak.open_to(opening), 6e4 * (half + 0.5e-3), 1e-9 * steel.yield) << opening;
  }
}

/// Opened, closed and opened further: the work is what it holds and what yielding and slip took.
TEST(Bolt, gives_back_what_it_holds_and_no_more) {
  for (const double bond : {5e5, 6e4}) {
    Crossed bolt(10);
    bolt.law.bond_strength = bond;
    double work = 0.0, opening = 0.0, force = 0.0;
    for (const double to : {2e-3, 0.5e-3, 3e-3}) {
      constexpr int steps = 2000;
      const double step = (to - opening) / steps;
      for (int k = 0; k < steps; ++k) {
        opening += step;
        const double now = bolt.open_to(opening);
        work += 0.5 * (force + now) * step;
        force = now;
      }
    }
    EXPECT_GT(bolt.taken(), bolt.elastic());
    EXPECT_NEAR(bolt.elastic() + bolt.taken(), work, 1e-3 * work) << bond;
  }
}

/// Deflection of the end of a long beam in grout, pushed across there with 1 N/m, by finite
/// differences: bending and grout hold the least energy. Elimination of a band of five.
double pushed_end(double bending, double bedding, double length, std::size_t pieces) {
  const double h = length / static_cast<double>(pieces), bent = bending / (h * h * h);
  std::vector<std::array<double, 3>> band(pieces, {0.0, 0.0, 0.0});  // diagonal and two above
  for (std::size_t i = 0; i < pieces; ++i) band[i][0] = bedding * h * (i == 0 ? 0.5 : 1.0);
  for (std::size_t i = 1; i < pieces; ++i) {
    const double part[3] = {1.0, -2.0, 1.0};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b)
        if (i - 1 + b < pieces) band[i - 1 + a][b - a] += bent * part[a] * part[b];
  }
  // From the far end, which is held, to the one that is pushed: only there is a right-hand side.
  for (std::size_t i = pieces; i-- > 1;)
    for (std::size_t a = 1; a <= 2 && a <= i; ++a) {
      const double share = band[i - a][a] / band[i][0];
      band[i - a][0] -= share * band[i - a][a];
      if (a == 1 && i >= 2) band[i - 2][1] -= share * band[i - 2][2];
    }
  return 1.0 / band[0][0];
}

/// Both sides of a joint bend alike: half of the offset each.
TEST(Bolt, is_as_stiff_across_as_a_beam_in_grout) {
  constexpr double bending = 98.0, bedding = 5e9;
  const double beta = std::sqrt(std::sqrt(0.25 * bedding / bending));
  const double exact = bending * beta * beta * beta;
  EXPECT_NEAR(0.5 / pushed_end(bending, bedding, 8.0 / beta, 800), exact, 5e-3 * exact);
}

/// Rock that turns and strains evenly carries a bar along; rock that slips does not.
TEST(Bolt, lies_out_of_line_by_slip_alone) {
  const Vec2 way{0.3, 0.4};
  const auto mapped = [](const Vec2& v) { return Vec2{0.6 * v.x - 0.9 * v.y, 0.7 * v.x + v.y}; };
  EXPECT_NEAR(PlaneOffset::of(mapped(way), mapped(way), mapped(way)).way, 0.0, 1e-16);
  const Vec2 slip = 1e-3 * Vec2{-0.8, 0.6};
  EXPECT_NEAR(PlaneOffset::of(way + slip, way, way).way, 1e-3, 1e-15);
  // Its slope by the way between its ends, and by what carries its ends, is what its forces say.
  const Vec2 one{0.29, 0.42}, other{0.33, 0.37};
  const auto slope = [&](const auto& at) { return (at(1e-6) - at(-1e-6)) / 2e-6; };
  const PlaneOffset at = PlaneOffset::of(way, one, other);
  const Vec2 aside{0.2, 0.5};
  EXPECT_NEAR(slope([&](double e) { return PlaneOffset::of(way + e * aside, one, other).way; }),
              dot(at.across, aside), 1e-9);
  EXPECT_NEAR(slope([&](double e) { return PlaneOffset::of(way, one + e * aside, other).way; }),
              -at.lever * dot(at.across, aside), 1e-9);
}

}  // namespace bolt_test
}  // namespace breccia::fdem_shared
