#include "fdem/bolts/chain.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::fdem {

/// Length of the bar that the bond of a node stands for.
double BoltChain::share(std::size_t i) const {
  return 0.5 * ((i > 0 ? nodes_[i - 1].rest : 0.0) + (i + 1 < nodes() ? nodes_[i].rest : 0.0));
}
double BoltChain::elastic_force(std::size_t segment) const {
  const BoltNode &a = nodes_[segment], &b = nodes_[segment + 1];
  return law_.stiffness * ((length_[segment] - a.rest + b.slip - a.slip) / a.rest - a.strain);
}
double BoltChain::force(std::size_t segment) const {
  return std::clamp(elastic_force(segment), -law_.yield, law_.yield);
}
double BoltChain::elastic_bond(std::size_t i) const {
  return law_.bond_stiffness * share(i) * (nodes_[i].slip - nodes_[i].slid);
}
double BoltChain::bond(std::size_t i) const {
  const double most = law_.bond_strength * share(i);
  return std::clamp(elastic_bond(i), -most, most);
}

/// The force that is left over in the balance of a node.  [N/m]
double BoltChain::missing_at(std::size_t i) const {
  if (is_anchored(i)) return 0.0;
  return (i + 1 < nodes() ? force(i) : 0.0) - (i > 0 ? force(i - 1) : 0.0) - bond(i);
}
double BoltChain::most_missing() const {
  double most = 0.0;
  for (std::size_t i = 0; i < nodes(); ++i) most = std::max(most, std::abs(missing_at(i)));
  return most;
}

/// Newton's step: the balance of all nodes at once, by elimination from one end to the other. What
/// yields or slips keeps a small part of its stiffness, so that there is always an answer.
void BoltChain::step_all() {
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
void BoltChain::step_one(std::size_t i) {
  if (is_anchored(i)) return;
  const double before = i > 0 ? law_.stiffness / nodes_[i - 1].rest : 0.0;
  const double after = i + 1 < nodes() ? law_.stiffness / nodes_[i].rest : 0.0;
  nodes_[i].slip += missing_at(i) / (before + after + law_.bond_stiffness * share(i));
}

void BoltChain::settle() {
  constexpr int most_steps = 50;
  const double enough = 1e-10 * law_.yield;
  double missing = most_missing();
  for (int k = 0; k < most_steps && missing > enough; ++k) {
    const std::vector<BoltNode> before(nodes_, nodes_ + nodes());
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
  keep();
}

void BoltChain::keep() {
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

double BoltChain::elastic() const {
  double sum = 0.0;
  for (std::size_t j = 0; j + 1 < nodes(); ++j)
    sum += 0.5 * force(j) * force(j) * nodes_[j].rest / law_.stiffness;
  for (std::size_t i = 0; i < nodes(); ++i)
    sum += 0.5 * bond(i) * bond(i) / (law_.bond_stiffness * share(i));
  return sum;
}

}  // namespace breccia::fdem
