#pragma once
// A bolt: a bar of segments whose nodes a bond ties to the rock. It knows no elements.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "fdem_shared/bolts/dowel.hpp"

namespace breccia::fdem_shared {

/// Constants of a bolt and its bond; in the plane per unit thickness.
struct BoltLaw {
  double stiffness = 0.0;       ///< E A  [N; in 2D N/m]
  double yield = 0.0;           ///< f_y A  [N; in 2D N/m]
  double bond_stiffness = 0.0;  ///< of a length of it  [N/m2; in 2D N/m3]
  double bond_strength = 0.0;   ///< of a length of it  [N/m; in 2D N/m2]
  Dowel dowel{};                ///< what it bears across
};

/// A node of a bolt, and the segment from it to the next node of the same bolt.
/// @tparam Vector  of the plane or of space
template <class Vector>
struct BoltNodeOf {
  using Across = AcrossOf<Vector>;
  double slip = 0.0;     ///< s: of the bar against the rock, along the bar  [m]
  double slid = 0.0;     ///< r: the part of it that stays  [m]
  double strain = 0.0;   ///< p: the part of the segment's strain that stays  [-]
  double rest = 0.0;     ///< L0: length of the segment without force; 0: it is not there yet  [m]
  double yielded = 0.0;  ///< work that the segment's yielding took  [J; in 2D J/m]
  double rubbed = 0.0;   ///< work that the bond's slip took  [J; in 2D J/m]
  double force = 0.0;    ///< N of the segment, pulled above 0  [N; in 2D N/m]
  Across across{};       ///< Q of the segment  [N; in 2D N/m]
  Across sheared{};      ///< the part of its offset that stays  [m]
  double crushed = 0.0;  ///< work that that took  [J; in 2D J/m]
  /// The directions carried of the segment as it came, by parts along the edges from corner 0 of
  /// the element where it begins, and of the one where it ends.  [-]
  CarriedOf<Vector> begin{}, end{};
};

/// The nodes of one bolt. With the distances L_j of the rock's points
///
///   N_j = E A ((L_j + s_j+1 - s_j)/L0_j - 1 - p_j)    |N_j| <= f_y A         segment j
///   q_i = k l_i (s_i - r_i)                           |q_i| <= t l_i         bond at node i
///   N_i - N_i-1 = q_i                                 balance of the bar; s_i = 0 where it is
///   anchored
///
/// with half of both segments as l_i. The bar has no mass of its own: it is in balance at any time.
/// Strain beyond the yield goes into p, slip beyond the bond into r. Rock feels N_i t_i - N_i-1
/// t_i-1 at node i, with the directions t of the segments: what the bar does to it has neither a
/// sum nor a moment. What it bears across: dowel.hpp.
/// @tparam Node  as BoltNodeOf
template <class Node>
class BoltChain {
 public:
  /// @param length  L_j of each segment, one less than the nodes
  BoltChain(const BoltLaw& law, bool starts_anchored, bool ends_anchored, Node* nodes,
            const std::vector<double>& length)
      : law_(law), anchored_{starts_anchored, ends_anchored}, nodes_(nodes), length_(length) {}

  /// Finds the slips of balance, and keeps what yields and slips.
  void settle();
  /// N of a segment, pulled above 0.  [N; in 2D N/m]
  double force(std::size_t segment) const;
  /// Elastic energy of bar and bond.  [J; in 2D J/m]
  double elastic() const;

 private:
  std::size_t nodes() const { return length_.size() + 1; }
  bool is_anchored(std::size_t i) const {
    return (i == 0 && anchored_[0]) || (i + 1 == nodes() && anchored_[1]);
  }
  double share(std::size_t i) const;
  double elastic_force(std::size_t segment) const;
  double elastic_bond(std::size_t i) const;
  double bond(std::size_t i) const;
  double missing_at(std::size_t i) const;
  double most_missing() const;
  void step_all();
  void step_one(std::size_t i);
  void step_down();
  void keep();

  const BoltLaw& law_;
  bool anchored_[2];
  Node* nodes_;
  const std::vector<double>& length_;
};

/// Length of the bar that the bond of a node stands for.
template <class Node>
double BoltChain<Node>::share(std::size_t i) const {
  return 0.5 * ((i > 0 ? nodes_[i - 1].rest : 0.0) + (i + 1 < nodes() ? nodes_[i].rest : 0.0));
}
template <class Node>
double BoltChain<Node>::elastic_force(std::size_t segment) const {
  const Node &a = nodes_[segment], &b = nodes_[segment + 1];
  return law_.stiffness * ((length_[segment] - a.rest + b.slip - a.slip) / a.rest - a.strain);
}
template <class Node>
double BoltChain<Node>::force(std::size_t segment) const {
  return std::clamp(elastic_force(segment), -law_.yield, law_.yield);
}
template <class Node>
double BoltChain<Node>::elastic_bond(std::size_t i) const {
  return law_.bond_stiffness * share(i) * (nodes_[i].slip - nodes_[i].slid);
}
template <class Node>
double BoltChain<Node>::bond(std::size_t i) const {
  const double most = law_.bond_strength * share(i);
  return std::clamp(elastic_bond(i), -most, most);
}

/// The force that is left over in the balance of a node.  [N; in 2D N/m]
template <class Node>
double BoltChain<Node>::missing_at(std::size_t i) const {
  if (is_anchored(i)) return 0.0;
  return (i + 1 < nodes() ? force(i) : 0.0) - (i > 0 ? force(i - 1) : 0.0) - bond(i);
}
template <class Node>
double BoltChain<Node>::most_missing() const {
  double most = 0.0;
  for (std::size_t i = 0; i < nodes(); ++i) most = std::max(most, std::abs(missing_at(i)));
  return most;
}

/// Newton's step: the balance of all nodes at once, by elimination from one end to the other. What
/// yields or slips keeps a small part of its stiffness, so that there is always an answer.
template <class Node>
void BoltChain<Node>::step_all() {
  constexpr double left = 1e-6;
  const auto segment = [&](std::size_t j) {
    const bool yields = std::abs(elastic_force(j)) > law_.yield;
    return (yields ? left : 1.0) * law_.stiffness / nodes_[j].rest;
  };
  std::vector<double> over(nodes()), right(nodes());
  for (std::size_t i = 0; i < nodes(); ++i) {
    const double before = i > 0 ? segment(i - 1) : 0.0;
    const double after = i + 1 < nodes() ? segment(i) : 0.0;
    const bool slips = std::abs(elastic_bond(i)) > law_.bond_strength * share(i);
    const double own = (slips ? left : 1.0) * law_.bond_stiffness * share(i);
    const double carried = i > 0 && !is_anchored(i) ? before : 0.0;
    const double diagonal =
        is_anchored(i) ? 1.0 : before + after + own - carried * (i > 0 ? over[i - 1] : 0.0);
    over[i] = is_anchored(i) ? 0.0 : after / diagonal;
    right[i] = (missing_at(i) + carried * (i > 0 ? right[i - 1] : 0.0)) / diagonal;
  }
  double next = 0.0;
  for (std::size_t i = nodes(); i-- > 0;) {
    next = right[i] + over[i] * next;
    nodes_[i].slip += next;
  }
}

/// Moves a node to where nothing is missing if nothing yields; else nearer to it: no force grows
/// faster with the slip than these stiffnesses.
template <class Node>
void BoltChain<Node>::step_one(std::size_t i) {
  if (is_anchored(i)) return;
  const double before = i > 0 ? law_.stiffness / nodes_[i - 1].rest : 0.0;
  const double after = i + 1 < nodes() ? law_.stiffness / nodes_[i].rest : 0.0;
  nodes_[i].slip += missing_at(i) / (before + after + law_.bond_stiffness * share(i));
}

/// Newton's step, as far along it as the energy falls. No force falls as bar or bond go farther, so
/// the energy is convex, and steps lead to its least.
template <class Node>
void BoltChain<Node>::step_down() {
  std::vector<double> from(nodes()), way(nodes());
  for (std::size_t i = 0; i < nodes(); ++i) from[i] = nodes_[i].slip;
  step_all();
  for (std::size_t i = 0; i < nodes(); ++i) way[i] = nodes_[i].slip - from[i];
  const auto falls_at = [&](double share) {
    double slope = 0.0;
    for (std::size_t i = 0; i < nodes(); ++i) nodes_[i].slip = from[i] + share * way[i];
    for (std::size_t i = 0; i < nodes(); ++i) slope += missing_at(i) * way[i];
    return slope > 0.0;
  };
  double down = 0.0, up = 1.0;
  if (falls_at(up)) return;
  for (double middle = 0.5; down < middle && middle < up; middle = 0.5 * (down + up))
    (falls_at(middle) ? down : up) = middle;
  falls_at(up);
}

template <class Node>
void BoltChain<Node>::settle() {
  constexpr int most_steps = 50, most_down = 1000;
  const double enough = 1e-10 * law_.yield;
  double missing = most_missing();
  for (int k = 0; k < most_steps && missing > enough; ++k) {
    const std::vector<Node> before(nodes_, nodes_ + nodes());
    step_all();
    double now = most_missing();
    if (now > 0.5 * missing) {  // what yields has changed: node by node instead
      std::copy(before.begin(), before.end(), nodes_);
      for (int sweep = 0; sweep < 4; ++sweep) {
        for (std::size_t i = 0; i < nodes(); ++i) step_one(i);
        for (std::size_t i = nodes(); i-- > 0;) step_one(i);
      }
      now = most_missing();
    }
    missing = now;
  }
  for (int k = 0; k < most_down && missing > enough; ++k) {  // a long way in one step
    step_down();
    missing = most_missing();
  }
  keep();
}

template <class Node>
void BoltChain<Node>::keep() {
  for (std::size_t j = 0; j + 1 < nodes(); ++j) {
    const double now = force(j), beyond = (elastic_force(j) - now) / law_.stiffness;
    nodes_[j].strain += beyond;
    nodes_[j].yielded += now * beyond * nodes_[j].rest;
  }
  for (std::size_t i = 0; i < nodes(); ++i) {
    const double now = bond(i), stiffness = law_.bond_stiffness * share(i);
    const double beyond = (elastic_bond(i) - now) / stiffness;
    nodes_[i].slid += beyond;
    nodes_[i].rubbed += now * beyond;
  }
}

template <class Node>
double BoltChain<Node>::elastic() const {
  double sum = 0.0;
  for (std::size_t j = 0; j + 1 < nodes(); ++j)
    sum += 0.5 * force(j) * force(j) * nodes_[j].rest / law_.stiffness;
  for (std::size_t i = 0; i < nodes(); ++i)
    sum += 0.5 * bond(i) * bond(i) / (law_.bond_stiffness * share(i));
  return sum;
}

}  // namespace breccia::fdem_shared
