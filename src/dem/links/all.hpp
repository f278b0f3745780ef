#pragma once
// Every kind of link of the DEM.

#include "dem/links/concrete.hpp"
#include "dem/links/interface.hpp"
#include "dem/links/ldpm.hpp"
#include "dem/links/parallel_bond.hpp"
#include "dem/links/steel.hpp"

namespace breccia::dem {

/// Calls X(Kernel) for the kernel of forces of each kind: their packs are built by this list.
#define BR_EACH_LINK_KERNEL(X)  \
  X(ConcreteLinkForces<double>) \
  X(ConcreteLinkForces<float>)  \
  X(ConcreteLinkForces<Single>) \
  X(SteelLinkForces)            \
  X(InterfaceLinkForces)        \
  X(ParallelBondForces)         \
  X(LdpmFacetForces)            \
  X(LdpmEdgeForces)

/// All links of a world. A new law is a member here, in the order of LinkKind.
struct LinkSets {
  LinkSet<ConcreteLink> concrete;
  LinkSet<SteelLink> steel;
  LinkSet<InterfaceLink> interface;
  LinkSet<ParallelBond> parallel;
  LinkSet<LdpmFacet> ldpm;

  /// Calls visit(set) for each kind.
  template <class Visit>
  void each_set(Visit&& visit) {
    visit(concrete), visit(steel), visit(interface), visit(parallel), visit(ldpm);
  }
  template <class Visit>
  void each_set(Visit&& visit) const {
    visit(concrete), visit(steel), visit(interface), visit(parallel), visit(ldpm);
  }

  /// Links of all kinds, broken ones included.
  Index links() const {
    Index count = 0;
    each_set([&](const auto& set) { count += set.size(); });
    return count;
  }
};

/// Calls visit(one's set, other's set) for each kind.
template <class One, class Other, class Visit>
void each_two_sets(One& one, Other& other, Visit&& visit) {
  one.each_set([&](auto& set) {
    other.each_set([&](auto& same) {
      if constexpr (std::remove_reference_t<decltype(set)>::kind ==
                    std::remove_reference_t<decltype(same)>::kind)
        visit(set, same);
    });
  });
}

}  // namespace breccia::dem
