// Built once for each width of vector; BR_PACKS names the build (see CMakeLists.txt).
#if !defined(__OPTIMIZE__)
#error "needs -O1 or more: functions left as calls would be shared by builds of different widths"
#endif

#include "dem/stepping/kernel_lanes.hpp"

namespace breccia::dem {
namespace {

constexpr Index width = width_of<WidestPack>;

/// Packs that a kernel takes: of the numbers that it computes in.
template <class Kernel>
using PackOf = std::conditional_t<is_single<ItemOf<Kernel>>, SinglePack, WidestPack>;

/// Asks the memory for a pack of items of an array.
template <class T>
void fetch(const View<T>& array, Index first) {
  const auto* items = reinterpret_cast<const char*>(array.data + first);
  constexpr auto bytes = static_cast<Index>(width * sizeof(T));
  for (Index byte = 0; byte < bytes; byte += 64) __builtin_prefetch(items + byte);
}
/// Fetches all that a motion reads ahead: more arrays than the processor foresees.
void fetch(const MoveElements& kernel, Index first) {
  const Kick& kick = kernel.kick;
  fetch(kick.state, first);
  fetch(kernel.orientation, first);
  fetch(kick.force, first);
  fetch(kick.torque, first);
  fetch(kick.mass, first);
  fetch(kick.inertia, first);
  fetch(kernel.used.reference, first);
  fetch(kernel.used.margin, first);
}

}  // namespace

template <class Kernel>
BR_WHOLE Index BR_PACKS::run(const Kernel& kernel, Index begin, Index end) {
  if constexpr (requires { kernel.template sweep<WidestPack>(begin, end); })
    return kernel.template sweep<WidestPack>(begin, end);
  using Pack = PackOf<Kernel>;
  Index i = begin;
  for (; i + width_of<Pack> <= end; i += width_of<Pack>) {
    if constexpr (std::is_void_v<decltype(run_at<Pack>(kernel, i))>)
      run_at<Pack>(kernel, i);
    else if (!run_at<Pack>(kernel, i))
      break;
  }
  return i;
}
#define BR_INSTANTIATE(Kernel) template Index BR_PACKS::run(const Kernel&, Index, Index);
BR_EACH_LINK_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

BR_WHOLE Index BR_PACKS::run(const GatherForces& kernel, Index begin, Index end) {
  Index e = begin;
  for (; e + width <= end; e += width) kernel.at<WidestPack>(e);
  return e;
}

BR_WHOLE LeastOf BR_PACKS::run(const View<const double>& numbers, Index begin, Index end) {
  WidestPack least = constant<WidestPack>(largest_least);
  Index i = begin;
  for (; i + width <= end; i += width) least = min(load<WidestPack>(numbers, i), least);
  double number = largest_least;
  for (Index k = 0; k < width; ++k) number = min(least[k], number);
  return {i, number};
}

BR_WHOLE MovedTo BR_PACKS::run(const MoveElements& kernel, Index begin, Index end) {
  MovedTo moved{begin, false};
  for (; moved.end + width <= end; moved.end += width) {
    fetch(kernel, moved.end + 3 * width);
    if (run_at<WidestPack>(kernel, moved.end)) moved.beyond = true;
  }
  return moved;
}

template <class Links, class Number>
BR_WHOLE void BR_PACKS::run(const AddLinks& add, const Links& links, Index from, Index to,
                            const PairForceOf<Number>* actions) {
  add(links, from, to, actions);
}
#define BR_INSTANTIATE(Links, Number)                                      \
  template void BR_PACKS::run(const AddLinks&, const Links&, Index, Index, \
                              const PairForceOf<Number>*);
BR_EACH_ADDED_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

template <class Kernel>
BR_WHOLE Index BR_PACKS::add(const Kernel& kernel, Index begin, Index end, Energies& sum) {
  EnergiesOf<WidestPack> packs;
  Index i = begin;
  for (; i + width <= end; i += width)
    if (!kernel.template add_pack<WidestPack>(packs, i)) break;
  add_packs<WidestPack>(sum, packs);
  return i;
}
#define BR_INSTANTIATE(Kernel) template Index BR_PACKS::add(const Kernel&, Index, Index, Energies&);
BR_EACH_ENERGY_KERNEL(BR_INSTANTIATE)
#undef BR_INSTANTIATE

}  // namespace breccia::dem
