#pragma once
// Sums of energies by packs where items can be taken whole, all else one by one.

#include "core/energy.hpp"
#include "exec/whole_packs.hpp"

namespace breccia {

/// A kernel of energies, and the sum that it adds to.
template <class Kernel>
struct AddingTo {
  const Kernel& kernel;
  Energies& sum;
  void operator()(Index i) const { kernel.add_to(sum, i); }
};
template <class Packs>
struct AddingPacks {
  template <class Kernel>
  static Index run(const AddingTo<Kernel>& adding, Index begin, Index end) {
    return Packs::add(adding.kernel, begin, end, adding.sum);
  }
};

/// Adds the energies of items [begin, end) to `sum`.
/// @tparam Eight, Four  builds for AVX-512 and AVX2; their add() returns where it stops
template <class Eight, class Four, class Kernel>
void add_whole_packs(Lanes lanes, const Kernel& kernel, Index begin, Index end, Energies& sum) {
  run_whole_packs<AddingPacks<Eight>, AddingPacks<Four>>(lanes, AddingTo<Kernel>{kernel, sum},
                                                         begin, end);
}

}  // namespace breccia
