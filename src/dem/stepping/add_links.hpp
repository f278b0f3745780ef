#pragma once
// The sums of concrete links and of edges of facets on the host, as their forces come.

#include <algorithm>
#include <vector>

#include "dem/element_kernels.hpp"
#include "dem/links/all.hpp"

namespace breccia::dem {

/// The action of a link that a later run adds to element b.
struct DeferredForce {
  PairForce action;
  Index b;
};

struct AddLinks;
/// Stores an action for the run that owns element b.
void defer(const AddLinks& add, const PairForce& action, Index b);
void defer(const AddLinks& add, const PairForceOf<float>& action, Index b);

/// Sums the actions of links as they come. A force on an element outside this thread's private
/// range is stored in `deferred`; its owner thread adds it later, in the order of all links, so
/// that the sum does not depend on the number of threads.
struct AddLinks {
  View<LinkSums> sums;
  Index first_private, end;  ///< elements that get sums at once
  Index reach;               ///< no link leads further
  bool evaluates;            ///< as StepTime: otherwise stiffnesses are left out
  std::vector<DeferredForce>& deferred;

  /// Links [from, to); action 0 is of link `from`.
  template <class Number>
  void operator()(const ConcreteLinkForces<Number>& links, Index from, Index to,
                  const PairForceOf<StoredAs<Number>>* actions) const {
    evaluates ? add<true>(links, from, to, actions) : add<false>(links, from, to, actions);
  }
  /// Adds the forces of the edges of facets [from, to); action 0 is of facet 0.
  void operator()(const LdpmEdgeForces& edges, Index from, Index to,
                  const PairForce* actions) const {
    for (Index k = from; k < to;) {
      const Index a = edges.a[edges.leads[k]];
      SixSums as_a = sums[a].as_a;
      EightFloatSums stiffness_a = sums[a].stiffness_a.straight;  // ratios are zero
      for (; k < to && edges.a[edges.leads[k]] == a; ++k) {
        const PairForce& action = actions[edges.leads[k]];
        const Index b = edges.b[edges.leads[k]];
        as_a.add(action.numbers);
        if (evaluates) stiffness_a.add(action.stiffness);
        if (b >= first_private && b < end) {
          sums[b].as_b.add(action.numbers + 3);
          if (evaluates) sums[b].stiffness_b.straight.add(action.stiffness);
        } else {
          defer(*this, action, b);
        }
      }
      sums[a].as_a = as_a;
      sums[a].stiffness_a.straight = stiffness_a;
    }
  }
  /// Asks the memory for an element before the first link comes to it.
  void fetch(Index element, const View<const ElementState>& state) const {
    const auto* sum = reinterpret_cast<const char*>(sums.data + element);
    const auto* record = reinterpret_cast<const char*>(state.data + element);
    for (int line = 0; line < 4; ++line) __builtin_prefetch(sum + 64 * line, 1);
    for (int line = 0; line < 2; ++line) __builtin_prefetch(record + 64 * line);
  }

 private:
  template <bool with_stiffness, class Links, class Action>
  void add(const Links& links, Index from, Index to, const Action* actions) const {
    for (Index i = from; i < to;) {
      const Index a = links.a[i];
      SixSums as_a = sums[a].as_a;
      StiffnessSums stiffness_a = sums[a].stiffness_a;
      fetch(std::min(a + reach, sums.size - 1), links.elements.state);
      for (; i < to && links.a[i] == a; ++i) {
        const Action& action = actions[i - from];
        as_a.add(action.numbers);
        if (with_stiffness) stiffness_a.add(action.stiffness);
        const Index b = links.b[i], soon = links.b[std::min(i + 8, to - 1)];
        __builtin_prefetch(&sums[soon].as_b, 1);
        if (with_stiffness) __builtin_prefetch(&sums[soon].stiffness_b, 1);
        if (b < first_private || b >= end)
          defer(*this, action, b);
        else if (with_stiffness)
          sums[b].add_as_b(action.numbers, action.stiffness);
        else
          sums[b].as_b.add(action.numbers + 3);
      }
      sums[a].as_a = as_a;
      if (with_stiffness) sums[a].stiffness_a = stiffness_a;
    }
  }
};

}  // namespace breccia::dem
