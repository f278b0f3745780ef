#pragma once
// The search by the tiles themselves, in the middle of a step: each finds the contacts of its own
// elements among the spheres of all, and all of them number what they have found as a search on the
// host does (dem/search.cpp). Nothing goes to the host.
//
// Tiles meet between four phases: publish(), find(), number(), name(). Until find() has succeeded
// everywhere, contacts of the world stay as they were, so that the host can search in its place.

#include <cmath>

#include "core/cell_grid.hpp"
#include "core/grown_box.hpp"
#include "core/rows.hpp"
#include "dem/tiles/tile_step.hpp"

namespace breccia::dem {

/// A contact that a tile has found, as one of its own elements sees it.
struct FoundContact {
  Index partner;         ///< place in the world
  TilePlace own, place;  ///< of both in the tile
  TilePlace rank;        ///< among all of `own`
  TilePlace side;        ///< of `own`
  Index pair;
};
struct StagedSphere {
  NearSphere sphere;
  Index element;
};
/// An own element and another that it may touch, if no link holds them.
struct NearPair {
  Index partner;  ///< place in the world
  Index own;      ///< place in the tile
};

/// The memory of a tile during a search, where its steps keep everything else.
struct SearchMemory {
  Index* counters;   ///< found, touched, staged, all pairs, all entries, near
  Box *box, *boxes;  ///< of all own elements, of each
  double* motion;    ///< of all tiles, then their sums
  Index* place;      ///< own elements in the world
  NearSphere* own;
  Index *as_b, *all, *first_slot, *first_entry;  ///< contacts of own elements
  Index* first_pair;
  FoundContact* found;
  ContactCounts* segments;
  NearPair* near;
  StagedSphere* staged;
  Index near_room, staged_room;

  BR_HD SearchMemory(const Tile& tile, Index tiles, Index elements, std::size_t bytes,
                     std::byte* base) {
    constexpr Index near_each = 40;
    near_room = near_each * tile.own;
    constexpr std::size_t clocks = 1024;  // and what else comes first in TileMemory
    static_assert(clocks >= sizeof(TileMemory<double>) + 2 * sizeof(StepClock) + 64);
    detail::Pieces pieces{base, clocks};
    pieces.take(counters, 8);
    pieces.take(box, 1);
    pieces.take(boxes, tile.own);
    pieces.take(motion, 4 * tiles + 4);
    pieces.take(place, tile.own);
    pieces.take(own, tile.own);
    pieces.take(as_b, tile.own);
    pieces.take(all, tile.own);
    pieces.take(first_slot, tile.own + 1);
    pieces.take(first_entry, tile.own);
    pieces.take(first_pair, tile.own);
    pieces.take(found, most_contacts_of_tile);
    pieces.take(segments, segments_of(elements));
    pieces.take(near, near_room);
    pieces.take(staged, 0);
    constexpr Index most = 2048;
    const std::size_t room = bytes > pieces.used ? (bytes - pieces.used) / sizeof(StagedSphere) : 0;
    staged_room = room < static_cast<std::size_t>(most) ? static_cast<Index>(room) : most;
  }
  static constexpr Index segment = 64;  ///< elements
  BR_HD static Index segments_of(Index elements) { return (elements + segment - 1) / segment; }
};

/// A tile's part in a search. Functions of several threads take the thread's number among them;
/// those that return a truth return it to each thread for itself: the search has failed.
template <class Number>
struct TileSearch {
  static constexpr double gone = -1.0;  ///< radius of elements that have been taken out

  const TileCase<Number>& all;
  Index number;
  Tile tile;
  SearchMemory memory;

  BR_HD TileSearch(const TileCase<Number>& of, const TileLists& lists, Index tile_number,
                   std::byte* base)
      : all(of),
        number(tile_number),
        tile(lists.tiles.data[tile_number]),
        memory(tile, of.tiles.count, of.force.size, of.search.bytes, base) {}

  /// Leaves the tile as its steps have it, begins the travel of its elements, and shows them to
  /// all. Contacts are copied to where the old ones lie.
  /// @param contacts  before the search
  BR_HD static bool publish(const TileStep<Number>& step, double next_dt, Index contacts,
                            Index thread, Index threads) {
    const TileSearchCase& s = step.all.search;
    step.leave(thread, threads);
    MarginRule rule = s.margins;
    rule.horizon *= next_dt;
    bool lost = false;
    for (Index e = thread; e < step.tile.own; e += threads) {
      const Index g = step.memory.place[e];
      const ElementState state = step.memory.state[e];
      const double margin = rule.margin(state.velocity);
      s.reference[g] = state.position;
      s.margin[g] = margin;
      const bool is_out = is_gone(step.memory.fixed[e]);
      s.show(g, {state.position, is_out ? gone : state.radius, margin});
      constexpr double fast = 1e4;  // the sums of CommonMotion leave out what is faster still
      lost = lost || !is_finite(grown_box(state.position, state.radius, margin, 0.0)) ||
             !(dot(state.velocity, state.velocity) < fast * fast);
    }
    for (Index k = thread; k < 4; k += threads) {
      double sum = 0.0;
      for (Index e = 0; e < step.tile.own; ++e) {
        const Vec3& v = step.memory.state[e].velocity;
        sum += k == 0 ? v.x : k == 1 ? v.y : k == 2 ? v.z : dot(v, v);
      }
      s.motion[4 * step.number + k] = sum;
    }
    for (Index i = step.number * threads + thread; i < contacts;
         i += step.all.tiles.count * threads) {
      s.old_key[i] = s.key[i];
      s.old_state[i] = step.all.contacts.state[i];
      s.old_spent[i] = {step.all.contacts.slid[i], step.all.contacts.damped[i]};
    }
    return lost;
  }

  /// Finds the contacts of own elements, and says how many each has.
  BR_HD bool find(Index thread, Index threads) const {
    const TileSearchCase& s = all.search;
    for (Index e = thread; e < tile.own; e += threads) {
      const Index g = all.tiles.own[tile.first_own + e];
      memory.place[e] = g;
      const NearSphere own = s.sphere(g);
      memory.own[e] = own;
      memory.boxes[e] = grown_box(own.position, own.radius, own.margin, 0.0);
      memory.as_b[e] = memory.all[e] = 0;
    }
    for (Index k = thread; number == 0 && k < 4 * all.tiles.count; k += threads)
      memory.motion[k] = s.motion[k];
    if (thread == 0) memory.counters[0] = memory.counters[1] = memory.counters[5] = 0;
    meet_in_tile();
    bound(thread, threads);
    meet_in_tile();
    bool lost = number == 0 && thread == 0 && may_drift();
    if (memory.staged_room < 64) return true;
    for (Index first = 0; first < all.force.size; first += memory.staged_room) {
      if (thread == 0) memory.counters[2] = 0;
      meet_in_tile();
      stage(first, thread, threads);
      meet_in_tile();
      const Index lanes = threads < 32 ? threads : 32;  // that take one of the others
      for (Index k = thread / lanes; k < memory.counters[2]; k += threads / lanes)
        meet_own(memory.staged[k], thread % lanes, lanes);
      meet_in_tile();
    }
    if (memory.counters[5] > memory.near_room) return true;  // of all threads
    for (Index k = thread; k < memory.counters[5]; k += threads) find_contact(memory.near[k]);
    meet_in_tile();
    if (memory.counters[0] > most_contacts_of_tile) return true;  // of all threads
    order(thread, threads);
    meet_in_tile();
    if (thread == 0) {
      Tile next = tile;
      next.contacts = memory.counters[0];
      next.touched = memory.counters[1];
      next.first_contact = next.first_touched = number * most_contacts_of_tile;
      const std::size_t bytes = make_room<Number>(next, all.tiles.groups, s.bytes, s.most_acting);
      lost = lost || bytes > s.bytes;
      s.tiles[number] = next;
    }
    return lost;
  }

  /// Numbers the contacts of own elements as the lower ones among those of all, and gives them
  /// their history.
  /// @param contacts  before the search
  BR_HD bool number_all(Index contacts, Index dropped, Index thread, Index threads) const {
    const TileSearchCase& s = all.search;
    const Index elements = all.force.size, segments = SearchMemory::segments_of(elements);
    for (Index k = thread; k < segments; k += threads) {
      const Index begin = k * SearchMemory::segment;
      memory.segments[k] = counted(begin, begin + SearchMemory::segment);
    }
    meet_in_tile();
    for (Index e = thread; e <= tile.own; e += threads) {
      const Index g = e < tile.own ? memory.place[e] : elements;
      const Index segment = g / SearchMemory::segment;
      ContactCounts before = counted(segment * SearchMemory::segment, g);
      for (Index k = 0; k < segment; ++k) {
        before.as_a += memory.segments[k].as_a;
        before.all += memory.segments[k].all;
      }
      if (e == tile.own) {
        memory.counters[3] = before.as_a;
        memory.counters[4] = before.all;
      } else {
        memory.first_pair[e] = before.as_a;
        memory.first_entry[e] = before.all;
      }
    }
    meet_in_tile();
    if (memory.counters[3] > s.room || dropped + contacts > s.dropped.size) return true;
    for (Index e = thread; e < tile.own; e += threads) {
      s.first_pair[memory.place[e]] = memory.first_pair[e];
      s.incidence_starts[memory.place[e]] = memory.first_entry[e];
    }
    if (number == 0 && thread == 0) s.incidence_starts[elements] = memory.counters[4];
    for (Index k = thread; k < memory.counters[0]; k += threads) {
      FoundContact& one = memory.found[k];
      if (one.side != 0) continue;
      const Index a = memory.place[one.own], b = one.partner;
      one.pair = memory.first_pair[one.own] + one.rank - memory.as_b[one.own];
      const PairKey key = pair_key(s.id[a], s.id[b]);
      s.key[one.pair] = key;
      s.a[one.pair] = a;
      s.b[one.pair] = b;
      const Index old = lower_bound(s.old_key.data, 0, contacts, key);
      const bool known = old < contacts && s.old_key[old] == key;
      all.contacts.state[one.pair] = known ? s.old_state[old] : ContactState{};
      all.contacts.slid[one.pair] = known ? s.old_spent[old].slid : 0.0;
      all.contacts.damped[one.pair] = known ? s.old_spent[old].damped : 0.0;
    }
    return false;
  }

  /// Gives numbers to the contacts of own elements as the higher ones, and lists all; notes what
  /// contacts have spent that are no longer there.
  BR_HD void name(Index contacts, Index thread, Index threads) const {
    const TileSearchCase& s = all.search;
    for (Index k = thread; k < memory.counters[0]; k += threads) {
      const FoundContact& one = memory.found[k];
      Index pair = one.pair;
      if (one.side != 0) {
        pair = s.first_pair[one.partner];
        const Index b = memory.place[one.own], end = pair + s.counts[one.partner].as_a;
        while (pair + 1 < end && s.b[pair] != b) ++pair;
      }
      s.found[number * most_contacts_of_tile + memory.first_slot[one.own] + one.rank] = {
          pair, one.own, one.place, static_cast<Index>(one.side)};
      s.incidence[memory.first_entry[one.own] + one.rank] = 2 * pair + one.side;
    }
    const Index now = memory.counters[3];
    for (Index i = number * threads + thread; i < contacts; i += all.tiles.count * threads) {
      const DroppedContact spent = s.old_spent[i];
      if (spent.slid == 0.0 && spent.damped == 0.0) continue;
      const Index at = lower_bound(s.key.data, 0, now, s.old_key[i]);
      if (at < now && s.key[at] == s.old_key[i]) continue;
      s.dropped[count_up(all.news->dropped)] = spent;
    }
    if (number == 0 && thread == 0) all.news->contacts = now;
  }

 private:
  BR_HD static bool is_finite(const Box& box) {
    return std::isfinite(box.low.x) && std::isfinite(box.low.y) && std::isfinite(box.low.z) &&
           std::isfinite(box.high.x) && std::isfinite(box.high.y) && std::isfinite(box.high.z);
  }
  /// Whether all elements may share a motion that the host must take off (CommonMotion::drift(),
  /// with room for rounding).
  BR_HD bool may_drift() const {
    const double* const sums = memory.motion + 4 * all.tiles.count;
    const double share = 1.0 / static_cast<double>(all.force.size);
    const Vec3 mean = share * Vec3{sums[0], sums[1], sums[2]};
    return !(dot(mean, mean) < 0.7 * share * sums[3]);
  }
  /// The box of all own elements; in tile 0 also the sums of all motion.
  BR_HD void bound(Index thread, Index threads) const {
    constexpr Index sums = 32;  // by another warp
    for (Index k = thread; k < sums + 4; k += threads) {
      if (k >= sums && number == 0) {
        double sum = 0.0;
        for (Index t = 0; t < all.tiles.count; ++t) sum += memory.motion[4 * t + k - sums];
        memory.motion[4 * all.tiles.count + k - sums] = sum;
      }
      if (k >= 6) continue;
      double most = -1e300;
      for (Index e = 0; e < tile.own; ++e) {
        const double edge = reinterpret_cast<const double*>(memory.boxes + e)[k];
        most = memory.own[e].radius != gone ? max(most, k < 3 ? -edge : edge) : most;
      }
      reinterpret_cast<double*>(memory.box)[k] = k < 3 ? -most : most;
    }
  }
  /// Brings elements from `first` on whose boxes meet that of the tile.
  BR_HD void stage(Index first, Index thread, Index threads) const {
    const Index room = first + memory.staged_room;
    const Index end = room < all.force.size ? room : all.force.size;
    constexpr Index ahead = 4;  // are on their way at one time
    for (Index g = first + thread; g < end; g += ahead * threads) {
      NearSphere spheres[ahead];
      BR_UNROLL
      for (Index k = 0; k < ahead; ++k)
        spheres[k] = all.search.sphere(g + k * threads < end ? g + k * threads : g);
      BR_UNROLL
      for (Index k = 0; k < ahead; ++k) {
        const NearSphere& sphere = spheres[k];
        if (g + k * threads < end && sphere.radius != gone &&
            overlap(*memory.box, grown_box(sphere.position, sphere.radius, sphere.margin, 0.0)))
          memory.staged[count_up(memory.counters[2])] = {sphere, g + k * threads};
      }
    }
  }
  /// Finds the own elements that another may touch, if no link holds them.
  BR_HD void meet_own(const StagedSphere& other, Index lane, Index lanes) const {
    const NearSphere sphere = other.sphere;
    const Box box = grown_box(sphere.position, sphere.radius, sphere.margin, 0.0);
    for (Index e = lane; e < tile.own; e += lanes) {
      const Index g = memory.place[e];
      const NearSphere& own = memory.own[e];
      const bool near = g < other.element  // places and global ids ascend alike
                            ? may_touch(own, sphere, 0.0)
                            : may_touch(sphere, own, 0.0);
      if (!near || g == other.element || own.radius == gone || !overlap(memory.boxes[e], box))
        continue;
      const Index at = count_up(memory.counters[5]);
      if (at < memory.near_room) memory.near[at] = {other.element, e};
    }
  }
  /// Lists a pair that no link holds.
  BR_HD void find_contact(const NearPair& pair) const {
    const Index g = memory.place[pair.own];
    const bool is_a = g < pair.partner;
    if (is_a ? is_held(g, pair.partner) : is_held(pair.partner, g)) return;
    const Index at = count_up(memory.counters[0]);
    if (at >= most_contacts_of_tile) return;
    memory.found[at] = {pair.partner,
                        static_cast<TilePlace>(pair.own),
                        0,
                        0,
                        static_cast<TilePlace>(is_a ? 0 : 1),
                        0};
    count_up(memory.all[pair.own]);
    if (!is_a) count_up(memory.as_b[pair.own]);
  }
  /// Whether a link still holds two elements.
  BR_HD bool is_held(Index low, Index high) const {
    const TileSearchCase& s = all.search;
    const Index end = s.linked_starts[low + 1];
    constexpr Index ahead = 8;  // are on their way at one time
    for (Index first = s.linked_starts[low]; first < end; first += ahead) {
      bool here = false;
      BR_UNROLL
      for (Index k = 0; k < ahead; ++k)
        here = s.linked_partners[first + k < end ? first + k : first] == high || here;
      if (!here) continue;
      for (Index k = first; k < first + ahead && k < end; ++k) {
        if (s.linked_partners[k] != high) continue;
        const Index link = s.linked_links[k];
        if (link < s.concrete
                ? !all.concrete_released(link)
                : link < s.concrete + s.steel || !s.interface_released(link - s.concrete - s.steel))
          return true;
      }
    }
    return false;
  }

  /// Orders what was found by own element and partner, gives partners a place in the tile, and
  /// writes what others want to know.
  BR_HD void order(Index thread, Index threads) const {
    const TileSearchCase& s = all.search;
    const Index count = memory.counters[0];
    for (Index e = thread; e <= tile.own; e += threads) {
      Index before = 0;
      for (Index k = 0; k < e; ++k) before += memory.all[k];
      memory.first_slot[e] = before;
      s.starts[tile.first_start + e] = static_cast<TilePlace>(before);
      if (e < tile.own) s.counts[memory.place[e]] = {memory.all[e] - memory.as_b[e], memory.all[e]};
    }
    // By own element, so that a rank asks for few comparisons.
    auto* const by_own = reinterpret_cast<Index*>(memory.near);  // it is not needed any more
    for (Index e = thread; e < tile.own; e += threads) memory.first_pair[e] = 0;
    meet_in_tile();
    for (Index k = thread; k < count; k += threads) {
      const Index own = memory.found[k].own;
      by_own[memory.first_slot[own] + count_up(memory.first_pair[own])] = k;
    }
    meet_in_tile();
    constexpr TilePlace unknown = 0xffff;
    for (Index k = thread; k < count; k += threads) {
      FoundContact& one = memory.found[k];
      Index rank = 0;
      for (Index j = memory.first_slot[one.own]; j < memory.first_slot[one.own + 1]; ++j)
        rank += memory.found[by_own[j]].partner < one.partner ? 1 : 0;
      one.rank = static_cast<TilePlace>(rank);
      one.place = unknown;
      Index at = lower_bound(memory.place, 0, tile.own, one.partner);
      if (at < tile.own && memory.place[at] == one.partner) one.place = static_cast<TilePlace>(at);
      const Index* const linked = all.tiles.linked.data + tile.first_linked;
      at = one.place == unknown ? lower_bound(linked, 0, tile.linked, one.partner) : tile.linked;
      if (at < tile.linked && linked[at] == one.partner)
        one.place = static_cast<TilePlace>(tile.own + at);
    }
    meet_in_tile();
    // Of several contacts with one element that no link has told the tile of, the first is noted.
    for (Index k = thread; k < count; k += threads) {
      FoundContact& one = memory.found[k];
      if (one.place != unknown) continue;
      Index first = 0;
      while (memory.found[first].partner != one.partner) ++first;
      one.pair = first;
      if (first != k) continue;
      const Index more = count_up(memory.counters[1]);
      one.place = static_cast<TilePlace>(tile.own + tile.linked + more);
      s.touched[number * most_contacts_of_tile + more] = one.partner;
    }
    meet_in_tile();
    for (Index k = thread; k < count; k += threads) {
      FoundContact& one = memory.found[k];
      if (one.place == unknown) one.place = memory.found[one.pair].place;
    }
  }
  BR_HD ContactCounts counted(Index begin, Index end) const {
    ContactCounts sum{0, 0};
    const Index last = end < all.force.size ? end : all.force.size;
    BR_UNROLL_BY(8)
    for (Index g = begin; g < last; ++g) {
      sum.as_a += all.search.counts[g].as_a;
      sum.all += all.search.counts[g].all;
    }
    return sum;
  }
};

}  // namespace breccia::dem
