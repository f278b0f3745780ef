#include "dem/stepping/kernel_lanes.hpp"

#include "core/add_energies.hpp"
#include "exec/whole_packs.hpp"

namespace breccia::dem {
template <class Kernel>
void run_packs([[maybe_unused]] Lanes lanes, const Kernel& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  if constexpr (requires { Kernel::swept; })  // to where packs lie in whole cache lines
    for (const Index width = pack_width<Kernel>(lanes); begin < end && begin % width != 0; ++begin)
      kernel(begin);
#endif
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
#define BR_INSTANTIATE(Kernel) template void run_packs(Lanes, const Kernel&, Index, Index);
BR_EACH_LINK_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

void run_packs([[maybe_unused]] Lanes lanes, const GatherForces& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) begin = PacksAvx512::run(kernel, begin, end);
  if (lanes == Lanes::four) begin = PacksAvx2::run(kernel, begin, end);
#endif
  for (Index e = begin; e < end; ++e) kernel(e);
}

double least([[maybe_unused]] Lanes lanes, const View<const double>& numbers, Index begin,
             Index end) {
  LeastOf least{begin, largest_least};
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) least = PacksAvx512::run(numbers, begin, end);
  if (lanes == Lanes::four) least = PacksAvx2::run(numbers, begin, end);
#endif
  for (Index i = least.end; i < end; ++i) least.number = min(numbers[i], least.number);
  return least.number;
}

bool run_packs([[maybe_unused]] Lanes lanes, const MoveElements& kernel, Index begin, Index end) {
  MovedTo moved{begin, false};
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) moved = PacksAvx512::run(kernel, begin, end);
  if (lanes == Lanes::four) moved = PacksAvx2::run(kernel, begin, end);
#endif
  for (Index e = moved.end; e < end; ++e) moved.beyond = kernel(e) || moved.beyond;
  return moved.beyond;
}

template <class Links, class Number>
void run_adding([[maybe_unused]] Lanes lanes, const AddLinks& add, const Links& links, Index from,
                Index to, const PairForceOf<Number>* actions) {
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) return PacksAvx512::run(add, links, from, to, actions);
  if (lanes == Lanes::four) return PacksAvx2::run(add, links, from, to, actions);
#endif
  add(links, from, to, actions);
}
#define BR_INSTANTIATE(Links, Number)                                          \
  template void run_adding(Lanes, const AddLinks&, const Links&, Index, Index, \
                           const PairForceOf<Number>*);
BR_EACH_ADDED_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

template <class Kernel>
void add_energies(Lanes lanes, const Kernel& kernel, Index begin, Index end, Energies& sum) {
  add_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end, sum);
}
#define BR_INSTANTIATE(Kernel) \
  template void add_energies(Lanes, const Kernel&, Index, Index, Energies&);
BR_EACH_ENERGY_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

}  // namespace breccia::dem
