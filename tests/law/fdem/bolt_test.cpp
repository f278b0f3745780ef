// A bolt by itself: what it pulls with while a crack across it opens, beside closed answers.

#include <gtest/gtest.h>

#include <cmath>

#include "fdem/bolts/chain.hpp"

namespace breccia::fdem {
namespace bolt_test {

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
    BoltChain chain(law, start, end, nodes.data(), length);
    chain.settle();
    return chain.force(pieces);
  }
  double elastic() { return BoltChain(law, start, end, nodes.data(), length).elastic(); }
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

}  // namespace bolt_test
}  // namespace breccia::fdem
