#pragma once
// A world as its tiles see it, and the words that they tell each other.

#include "core/timed.hpp"
#include "core/travel.hpp"
#include "dem/element_kernels.hpp"
#include "dem/links/all.hpp"
#include "dem/tiles/tile_plan.hpp"
#include "dem/world.hpp"

/// nvcc unrolls the loop that follows so many times: what it reads is on its way at one time.
#if defined(__CUDA_ARCH__)
#define BR_PRAGMA(text) _Pragma(#text)
#define BR_UNROLL_BY(times) BR_PRAGMA(unroll times)
#else
#define BR_UNROLL_BY(times)
#endif

namespace breccia::dem {

/// Waits for the threads of a tile.
BR_HD inline void meet_in_tile() {
#if defined(__CUDA_ARCH__)
  __syncthreads();
#endif
}

/// Writes a number for other tiles.
BR_HD inline void put(TileWord* to, std::uint64_t bits, std::uint32_t tag) {
  const auto low = static_cast<std::uint32_t>(bits), high = static_cast<std::uint32_t>(bits >> 32);
#if defined(__CUDA_ARCH__)
  asm volatile(
      "st.volatile.global.v4.u32 [%0], {%1, %2, %3, %4};" ::"l"(__cvta_generic_to_global(to)),
      "r"(low), "r"(tag), "r"(high), "r"(tag)
      : "memory");
#else
  *to = {low, tag, high, tag};
#endif
}
/// @returns whether the number with that tag is there
BR_HD inline bool get(const TileWord* from, std::uint64_t& bits, std::uint32_t tag) {
  TileWord word;
#if defined(__CUDA_ARCH__)
  asm volatile("ld.volatile.global.v4.u32 {%0, %1, %2, %3}, [%4];"
               : "=r"(word.low), "=r"(word.tag), "=r"(word.high), "=r"(word.same_tag)
               : "l"(__cvta_generic_to_global(from))
               : "memory");
#else
  word = *from;
#endif
  bits = std::uint64_t{word.high} << 32 | word.low;
  return word.tag == tag && word.same_tag == tag;
}

/// A world as searches by its tiles see it, and where they leave what they find.
struct TileSearchCase {
  MarginRule margins;  ///< horizon: in steps
  View<Vec3> reference;
  View<double> margin;
  View<const GlobalId> id;
  View<const Index> linked_starts, linked_partners, linked_links;
  LinkArrays<InterfaceLink>::Below interface_released;
  Index concrete, steel;  ///< links of these kinds
  // Contacts.
  Index room, contacts;  ///< that there may be; that there are at the start of the launch
  View<PairKey> key;
  View<Index> a, b;
  View<Index> incidence_starts;
  View<Entry> incidence;
  // Of TileSearches.
  View<double> spheres;  ///< five numbers of each element, one array each
  View<double> motion;
  View<ContactCounts> counts;
  View<Index> first_pair;
  View<PairKey> old_key;
  View<ContactState> old_state;
  View<DroppedContact> old_spent, dropped;
  View<Tile> tiles;
  View<Index> touched;
  View<TilePlace> starts;
  View<TileContact> found;
  std::size_t bytes;  ///< of a tile's memory
  Index most_acting;  ///< make_room()

  BR_HD NearSphere sphere(Index e) const {
    const Index n = spheres.size / 5;
    return {
        {spheres[e], spheres[n + e], spheres[2 * n + e]}, spheres[3 * n + e], spheres[4 * n + e]};
  }
  BR_HD void show(Index e, const NearSphere& sphere) const {
    const Index n = spheres.size / 5;
    spheres[e] = sphere.position.x;
    spheres[n + e] = sphere.position.y;
    spheres[2 * n + e] = sphere.position.z;
    spheres[3 * n + e] = sphere.radius;
    spheres[4 * n + e] = sphere.margin;
  }
};

/// A world as its tiles see it.
/// @tparam Number  as ConcreteLinkForces
template <class Number>
struct TileCase {
  using Law = typename TileMemory<Number>::Law;
  ConcreteLinkForces<Number> concrete;
  LinkArrays<ConcreteLink>::Below<StoredAs<Number>> concrete_released;
  ConcreteParts concrete_parts;  ///< that laws of any of these links have
  SteelLinkForces steel;
  InterfaceLinkForces interface;
  ContactForces contacts, twins;  ///< of elements that are a; as those that are b follow them
  MoveElements move;
  View<Vec3> force, torque;
  View<const Law> concrete_laws;
  View<const SteelLink> steel_laws;
  View<const InterfaceLink> interface_laws;
  EndOfStep<StepRule> end;
  TilesView tiles;
  TileConstants<typename TileMemory<Number>::Constant>* constants;  ///< of links outside tiles
  TileWord *forces, *least;
  std::uint32_t tag;  ///< before the first step
  StepClock start;
  TileSearchCase search;
  TileNews* news;  ///< where time is left

  /// The lists of tiles after some searches in this launch.
  BR_HD TileLists lists(Index searches) const {
    if (searches == 0) return tiles.lists;
    return {search.tiles, search.touched, search.starts, search.found};
  }
};

template <class Number>
TileCase<Number> case_of(World& w, TilePlan& plan, const StopAt& stop);
/// Takes over from the device after a launch: contacts that its searches have found, energies of
/// those that they have dropped. Time is left to the caller.
TileNews take_over(World& w, TilePlan& plan);

/// Numbers that a tile hears of all, and tells them.
struct TileReport {
  double slowest = 0.0;  ///< largest stiffness over inertia  [1/s2]
  bool near = false;     ///< some element may use its margin up in the move to come
};
BR_HD inline std::uint64_t packed(const TileReport& report) {
  return ordered_bits(report.slowest) | static_cast<std::uint64_t>(report.near ? 1 : 0) << 63;
}
BR_HD inline void hear(TileReport& report, std::uint64_t bits) {
  report.near = report.near || bits >> 63 != 0;
  report.slowest = max(report.slowest, number_of(bits & ~(std::uint64_t{1} << 63)));
}
/// The least of 1 / x is that of the largest x, rounding included.  [s2]
BR_HD inline double critical_of(double slowest) {
  return slowest > 0.0 ? 1.0 / slowest : largest_least;
}

}  // namespace breccia::dem
