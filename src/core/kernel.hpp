#pragma once
// The protocol of kernels: each is written once, for the host, its packs and a device.
//
// A kernel is a struct of views with these members; R is double, or a pack of doubles on the host.
//
//   Loaded<R>              numbers of item i, or of i and its neighbours in a pack
//   load_early(i, loaded)  reads what the stage before does not write: on a device, while that runs
//   load_late(i, loaded)   reads the rest
//   update(i, loaded)      computes and stores; may return a number or a truth
//   slow(i)                optional: what few items need. update() then returns false, with nothing
//                          stored, where the item, or one of its pack, is left to slow(); it knows
//                          no time
//   Item                   optional: the type of one item's numbers, if it is not double
//   update_at(now, i, loaded)  optional: update() with the time of the step, on a device
//   set(now)               gives the kernel the time of a step
//
// A kernel whose items nothing reads ahead has operator()(i) alone, and may have set(now). One that
// gives several threads to an item has a plain Loaded, and `width`; whole warps call it.

#include <type_traits>
#include <utility>

#include "core/step_clock.hpp"

namespace breccia {

template <class Kernel>
concept LoadsPacks = requires {
  typename Kernel::template Loaded<double>;
};
template <class Kernel>
concept LoadsItems = requires {
  typename Kernel::Loaded;
};
template <class Kernel>
concept HasSlow = requires(const Kernel& kernel) {
  kernel.slow(Index{});
};

/// The type of one item's numbers in a kernel: its member Item, else double.
template <class Kernel>
struct ItemType {
  using type = double;
};
template <class Kernel>
requires requires {
  typename Kernel::Item;
}
struct ItemType<Kernel> {
  using type = typename Kernel::Item;
};
template <class Kernel>
using ItemOf = typename ItemType<Kernel>::type;

/// Numbers that a kernel loads of one item, as the member Loaded; none if it loads nothing ahead.
template <class Kernel>
struct LoadedBy {};
template <LoadsItems Kernel>
struct LoadedBy<Kernel> {
  using Loaded = typename Kernel::Loaded;
};
template <LoadsPacks Kernel>
struct LoadedBy<Kernel> {
  using Loaded = typename Kernel::template Loaded<ItemOf<Kernel>>;
};

/// Item i, or i and its neighbours in a pack, at one go. @returns what update() returns
template <class R, LoadsPacks Kernel>
BR_HD inline auto run_at(const Kernel& kernel, Index i) {
  typename Kernel::template Loaded<R> loaded;
  kernel.load_early(i, loaded);
  kernel.load_late(i, loaded);
  return kernel.update(i, loaded);
}

/// The work of a kernel for an item of which all has been loaded.
template <class Kernel, class... Read>
BR_HD inline auto finish_item(const Kernel& kernel, Index i, Read&... loaded) {
  if constexpr (sizeof...(Read) == 0)
    return kernel(i);
  else
    return kernel.update(i, loaded...);
}

/// Whether a kernel gives a number for each item, the least of which is noted.
template <class Kernel, class... Read>
inline constexpr bool gives_number =
    std::is_same_v<decltype(finish_item(std::declval<const Kernel&>(), Index{},
                                        std::declval<Read&>()...)),
                   double>;

#if defined(__CUDACC__)
#define BR_COLD __host__ __device__ __noinline__
#else
#define BR_COLD __attribute__((noinline))
#endif

/// Keeps what a pointer leads to where the launch has it: otherwise all of it is passed by value.
template <class T>
BR_HD inline void stay_in_place([[maybe_unused]] const T*& parameters) {
#if defined(__CUDA_ARCH__)
  asm volatile("" : "+l"(parameters));
#endif
}

/// slow(i) of a kernel as of `now`, in a function of its own: what few items need costs the others
/// no registers.
/// @param kernel  where the launch has its parameters
template <HasSlow Kernel>
BR_COLD void run_slow(const Kernel* kernel, StepTime now, Index i) {
  stay_in_place(kernel);
  Kernel timed = *kernel;
  timed.set(now);
  timed.slow(i);
}

}  // namespace breccia
