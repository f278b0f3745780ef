#pragma once
// The widest form of the kernels that this processor can run, found at run time; same bits in all.

#include "dem/element_kernels.hpp"
#include "dem/energy_kernels.hpp"
#include "dem/links/all.hpp"
#include "dem/stepping/add_links.hpp"
#include "exec/lanes.hpp"

namespace breccia::dem {

/// Links of a whole pack.
template <class Kernel>
Index pack_width(Lanes lanes) {
  return static_cast<Index>(lanes) * (is_single<ItemOf<Kernel>> && lanes != Lanes::one ? 2 : 1);
}
/// kernel for the links [begin, end) on the calling thread.
template <class Kernel>
void run_packs(Lanes lanes, const Kernel& kernel, Index begin, Index end);
/// Packs of elements.
void run_packs(Lanes lanes, const GatherForces& kernel, Index begin, Index end);
/// @returns the least of the numbers [begin, end), none of which is negative
double least(Lanes lanes, const View<const double>& numbers, Index begin, Index end);
/// Packs of elements that move. @returns whether one of them has used its margin up
bool run_packs(Lanes lanes, const MoveElements& kernel, Index begin, Index end);

/// add for the links [from, to).
template <class Links, class Number>
void run_adding(Lanes lanes, const AddLinks& add, const Links& links, Index from, Index to,
                const PairForceOf<Number>* actions);
/// Calls X(kernel of forces, what its actions are stored in) for the links that are summed so.
#define BR_EACH_ADDED_KERNEL(X)         \
  X(ConcreteLinkForces<double>, double) \
  X(ConcreteLinkForces<float>, float)   \
  X(ConcreteLinkForces<Single>, float)  \
  X(LdpmEdgeForces, double)

/// Adds the energies of the items [begin, end) to `sum`.
template <class Kernel>
void add_energies(Lanes lanes, const Kernel& kernel, Index begin, Index end, Energies& sum);
using ConcreteEnergies = GroupEnergies<ConcreteLink, ConcreteShares<double>>;
using ConcreteEnergiesInSingle = GroupEnergies<ConcreteLink, ConcreteShares<float>>;
/// Calls X(kernel) for those that know packs.
#define BR_EACH_ENERGY_KERNEL(X) \
  X(ConcreteEnergies)            \
  X(ConcreteEnergiesInSingle)    \
  X(KineticEnergy)               \
  X(ElementShares)

/// How far a kernel came, and whether an element on the way has used its margin up.
struct MovedTo {
  Index end;
  bool beyond;
};

/// How far a search for the least number came, and what it is.
struct LeastOf {
  Index end;
  double number;
};

/// Builds of lanes/kernel_lanes.cpp for one width each. They process whole packs only and return
/// the first item not processed: of the remainder, or of a pack that is left to be taken one by
/// one.
struct PacksAvx2 {
  template <class Kernel>
  static Index run(const Kernel& kernel, Index begin, Index end);
  static Index run(const GatherForces& kernel, Index begin, Index end);
  static LeastOf run(const View<const double>& numbers, Index begin, Index end);
  static MovedTo run(const MoveElements& kernel, Index begin, Index end);
  template <class Links, class Number>
  static void run(const AddLinks& add, const Links& links, Index from, Index to,
                  const PairForceOf<Number>* actions);
  template <class Kernel>
  static Index add(const Kernel& kernel, Index begin, Index end, Energies& sum);
};
struct PacksAvx512 {
  template <class Kernel>
  static Index run(const Kernel& kernel, Index begin, Index end);
  static Index run(const GatherForces& kernel, Index begin, Index end);
  static LeastOf run(const View<const double>& numbers, Index begin, Index end);
  static MovedTo run(const MoveElements& kernel, Index begin, Index end);
  template <class Links, class Number>
  static void run(const AddLinks& add, const Links& links, Index from, Index to,
                  const PairForceOf<Number>* actions);
  template <class Kernel>
  static Index add(const Kernel& kernel, Index begin, Index end, Energies& sum);
};

}  // namespace breccia::dem
