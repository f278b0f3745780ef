#pragma once
// How a model is shared out to the multiprocessors of a device, each with the memory of its own:
// tiles of elements, what each has to know of its neighbours, and where everything lies in it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/precision.hpp"
#include "core/step_clock.hpp"
#include "dem/contacts.hpp"
#include "dem/laws/concrete_link.hpp"
#include "dem/laws/interface_link.hpp"
#include "dem/laws/steel_link.hpp"
#include "dem/near.hpp"

namespace breccia::dem {

struct World;

/// Elements and links of a tile by their places in it.
using TilePlace = std::uint16_t;

/// A link that a tile evaluates: one end at least is its own.
struct TileLink {
  TilePlace a, b;
  std::uint32_t number : 26;  ///< among the links of its kind
  std::uint32_t group : 6;
};
/// The neighbours of a bond's element along its bar.
struct TileAxis {
  TilePlace before, after;
};
/// A contact as one of its ends sees it, an element of the tile.
struct TileContact {
  Index pair;  ///< among all contacts
  TilePlace own, partner;
  Index side;  ///< of `own`: 0 for a, 1 for b
};

/// A tile: its own elements come first, then those that its links lead to, then further ones that
/// its contacts lead to. Counts, and where its part of each list of the plan begins.
struct Tile {
  Index own, linked, touched;  ///< elements  [-]
  Index concrete, steel, interface, contacts;
  Index acting;  ///< contacts that may have their actions in the tile's memory at one time
  Index row_entries;
  bool constants_outside;  ///< of concrete links: its memory does not hold them with all else
  Index first_own, first_linked, first_touched, first_link, first_axis, first_row, first_start,
      first_contact;

  BR_HD Index elements() const { return own + linked + touched; }
  BR_HD Index bars() const { return steel + interface; }
  BR_HD Index links() const { return concrete + bars(); }
  /// Where entries begin among the numbers of `rows`: at an even place.
  BR_HD Index first_entry() const { return (3 * own + 2) / 2 * 2; }
  BR_HD Index row_numbers() const { return first_entry() + row_entries; }
};

/// Concrete links of a tile are counted in runs, by how much a step asks of their law.
inline constexpr Index tile_stages = 4, tile_run_length = 32;
BR_HD constexpr Index tile_runs(Index links) {
  return (links + tile_run_length - 1) / tile_run_length;
}

/// Groups of links by kind: each has a law.
struct TileGroups {
  Index concrete, steel, interface;
  bool damped;  ///< whether concrete links have damping branches
};

/// Constants of a concrete link.
/// @tparam N  as ConcreteLinkOf
template <class N>
struct alignas(2 * sizeof(N)) TileConstants {
  N stiffness, area;
};

/// Torque on and force on an element.
struct ElementLoad {
  Vec3 force, torque;  ///<  [N], [N m]
};

/// An array in a tile's memory, told by how far it lies from this object, which lies there, too: an
/// address that each thread kept for itself would fill registers.
template <class T>
class Placed {
 public:
  BR_HD void place(std::byte* data) {
    away_ = static_cast<std::int32_t>(data - reinterpret_cast<std::byte*>(this));
  }
  BR_HD T* data() const {
#if defined(__CUDA_ARCH__)  // an address from which nvcc sees that it is of shared memory
    return reinterpret_cast<T*>(const_cast<std::byte*>(reinterpret_cast<const std::byte*>(this)) +
                                away_);
#else
    return reinterpret_cast<T*>(reinterpret_cast<std::intptr_t>(this) + away_);
#endif
  }
  BR_HD operator T*() const {
    return data();
  }

 private:
  std::int32_t away_;  ///<  [B]
};

/// Where everything lies in the memory of a tile; this comes first there.
/// @tparam Number  as ConcreteLinkForces
template <class Number>
struct TileMemory {
  using Stores = StoredAs<Number>;
  using Constant = ConstantOf<ComputedIn<Number>>;
  using Law = ConcreteLinkOf<Constant>;

  Tile tile;
  Placed<ElementState> state;  ///< of all elements
  Placed<double> mass, inertia;
  Placed<Index> place;  ///< in the arrays of the world
  Placed<std::int16_t> material, motion;
  Placed<std::uint8_t> fixed;
  Placed<ElementLoad> load;  ///< of its own elements
  Placed<Quaternion> orientation;
  Placed<Vec3> reference;
  Placed<double> margin, damping_work, load_work;
  Placed<float> over_mass;  ///<  [1/kg]
  Placed<float> room;       ///< square of the margin, less what rounding may take  [m2]

  Placed<TileLink> concrete, steel, interface;
  Placed<double> length;               ///< of concrete links, and what follows
  TileConstants<Constant>* constants;  ///< here, or outside in the order of the tile's links
  Placed<Stores> opening, shear, moment;
  Placed<float> branch_normal, branch_shear;  ///< empty without damping branches
  Placed<double> bar_length;
  Placed<SteelState> bar_state;
  Placed<TileAxis> axis;
  Placed<double> bond_stiffness, bond_area;
  Placed<InterfaceState> bond_state;

  Placed<PairForceOf<Stores>> actions;  ///< of concrete links, behind those of bars
  Placed<ElementLoad> received;  ///< of others' elements; in the memory of `actions`, when these
                                 ///< are summed
  Placed<TilePlace> order;  ///< where concrete links of the tile's list lie in it, while they are
                            ///< brought; behind `received`, as the next two
  Placed<std::uint8_t> stage;
  Placed<Index> stages;
  Placed<PairForce> bar_actions;  ///< of steel links, then bonds, then zeros
  Placed<TilePlace> rows;  ///< own elements by the length of their rows; first action of each as a,
                           ///< as b, and the end; then actions from `bar_actions` on, as many as a
                           ///< as as b, filled up by zeros to an even number
  Placed<TilePlace> starts;  ///< first contact of each own element, and the end
  Placed<TileContact> contacts;
  Placed<std::uint8_t>
      touching;            ///< whether a contact's ends have touched when they were last looked at
  Placed<TilePlace> acts;  ///< number from 1 of a contact's action in this step, the first ones in
                           ///< `contact_actions`; 0: none
  Placed<PairForce> contact_actions;
  Placed<Index> counters;  ///< next portion of links, next action of a contact

  Placed<Law> concrete_laws;
  Placed<SteelLink> steel_laws;
  Placed<InterfaceLink> interface_laws;
  Placed<StepClock> clocks;  ///< two, in turns

  /// `constants` that lie outside are placed by the caller.
  /// @returns the bytes that it takes, from this object on
  BR_HD std::size_t lay_out(const Tile& of, const TileGroups& groups);
};

namespace detail {

/// Takes pieces of memory one after the other.
struct Pieces {
  std::byte* base;
  std::size_t used = 0;

  template <class T>
  BR_HD void take(Placed<T>& piece, Index count) {
    piece.place(next<T>(count));
  }
  template <class T>
  BR_HD void take(T*& piece, Index count) {
    piece = reinterpret_cast<T*>(next<T>(count));
  }

 private:
  template <class T>
  BR_HD std::byte* next(Index count) {
    constexpr std::size_t line = 16;
    const std::size_t begin = (used + line - 1) / line * line;
    used = begin + static_cast<std::size_t>(count) * sizeof(T);
    return base + begin;
  }
};

}  // namespace detail

template <class Number>
BR_HD std::size_t TileMemory<Number>::lay_out(const Tile& of, const TileGroups& groups) {
  tile = of;
  detail::Pieces pieces{reinterpret_cast<std::byte*>(this), sizeof(TileMemory)};
  const Index own = tile.own, all = tile.elements(), bars = tile.steel, bonds = tile.interface;
  pieces.take(clocks, 2);
  pieces.take(counters, 2);
  pieces.take(concrete_laws, groups.concrete);
  pieces.take(steel_laws, groups.steel);
  pieces.take(interface_laws, groups.interface);
  pieces.take(state, all);
  pieces.take(mass, all);
  pieces.take(inertia, all);
  pieces.take(place, all);
  pieces.take(material, all);
  pieces.take(motion, all);
  pieces.take(fixed, all);
  pieces.take(load, own);
  pieces.take(orientation, own);
  pieces.take(reference, own);
  pieces.take(margin, own);
  pieces.take(damping_work, own);
  pieces.take(load_work, own);
  pieces.take(over_mass, own);
  pieces.take(room, own);
  pieces.take(concrete, tile.concrete);
  pieces.take(length, tile.concrete);
  pieces.take(constants, tile.constants_outside ? 0 : tile.concrete);
  pieces.take(opening, tile.concrete);
  pieces.take(shear, 3 * tile.concrete);
  pieces.take(moment, 3 * tile.concrete);
  const Index damped = groups.damped ? tile.concrete : 0;
  pieces.take(branch_normal, damped);
  pieces.take(branch_shear, 3 * damped);
  pieces.take(steel, bars);
  pieces.take(bar_length, bars);
  pieces.take(bar_state, bars);
  pieces.take(interface, bonds);
  pieces.take(axis, bonds);
  pieces.take(bond_stiffness, bonds);
  pieces.take(bond_area, bonds);
  pieces.take(bond_state, bonds);
  pieces.take(rows, tile.row_numbers());
  pieces.take(starts, own + 1);
  pieces.take(contacts, tile.contacts);
  pieces.take(touching, tile.contacts);
  pieces.take(acts, tile.contacts);
  pieces.take(contact_actions, tile.acting);
  pieces.take(bar_actions, tile.bars() + 1);
  detail::Pieces also = pieces;
  also.take(received, all - own);
  also.take(order, tile.concrete);
  also.take(stage, tile.concrete);
  also.take(stages, tile_stages * tile_runs(tile.concrete));
  pieces.take(actions, tile.concrete);
  return pieces.used > also.used ? pieces.used : also.used;
}

/// The lists of tiles, which a search replaces.
struct TileLists {
  View<const Tile> tiles;
  View<const Index> touched;  ///< places of elements
  View<const TilePlace> starts;
  View<const TileContact> contacts;
};
/// Contents of tiles, for a launch.
struct TilesView {
  Index count;
  TileGroups groups;
  View<const Index> own, linked;  ///< places of elements
  View<const TileLink> links;
  View<const TileAxis> axes;
  View<const TilePlace> rows;
  TileLists lists;  ///< as the launch finds them
};

/// Finds room for what a search brings a tile: constants of links go outside if need be, and up to
/// `most` actions of contacts get places in its memory, as far as it goes.
/// @returns bytes that it needs
template <class Number>
BR_HD std::size_t make_room(Tile& tile, const TileGroups& groups, std::size_t most_bytes,
                            Index most) {
  const auto bytes = [&] {
    TileMemory<Number> memory;
    return memory.lay_out(tile, groups);
  };
  tile.acting = 0;
  tile.constants_outside = false;
  tile.constants_outside = bytes() > most_bytes;
  const std::size_t least = bytes();
  if (least >= most_bytes) return least;
  const std::size_t room = (most_bytes - least) / sizeof(PairForce);
  tile.acting = tile.contacts < most ? tile.contacts : most;
  if (room < static_cast<std::size_t>(tile.acting)) tile.acting = static_cast<Index>(room);
  return tile.acting > 0 ? bytes() : least;
}

/// A number that a tile tells another, with the step's number beside each half, so that it is
/// known to be whole and new without any order between writes.
struct alignas(16) TileWord {
  std::uint32_t low, tag, high, same_tag;
};

/// Where the tiles of a plan have elements: each its own ones, others as it notes them.
class TilePlaces {
 public:
  /// Nothing is noted by any tile.
  void begin(const std::vector<Index>& tile_of, const std::vector<Tile>& tiles,
             const std::vector<Index>& own);
  void note(Index element, Index tile, Index place) {
    const auto e = static_cast<std::size_t>(element);
    noted_by_[e] = tile;
    noted_[e] = static_cast<TilePlace>(place);
  }
  /// Of an element in its own tile.
  TilePlace own(Index element) const { return own_[static_cast<std::size_t>(element)]; }
  bool is_noted(Index tile, Index element) const {
    return noted_by_[static_cast<std::size_t>(element)] == tile;
  }
  TilePlace noted(Index element) const { return noted_[static_cast<std::size_t>(element)]; }

 private:
  std::vector<TilePlace> own_;    ///< of each element
  std::vector<Index> noted_by_;   ///< the last tile that has noted each element
  std::vector<TilePlace> noted_;  ///< its place there
};

/// An array among others in one piece of memory.
template <class T>
struct PieceOf {
  std::size_t begin = 0;  ///<  [B]
  Index count = 0;
};

/// Actions of contacts that lie in a tile's memory, at most.
inline Index most_acting(Space space) {
  return space == Space::shadow ? 1 : 32;  // 1: tests see what does not fit
}
/// Contacts that a search by tiles may find for one of them.
inline constexpr Index most_contacts_of_tile = 2048;

/// Contacts of an element in a list that is sorted by the lower of two elements.
struct ContactCounts {
  Index as_a, all;
};
/// Energy that a contact has spent which leaves the list.
struct DroppedContact {
  double slid, damped;  ///<  [J]
};
/// How a launch of tiles leaves a world.
struct TileNews {
  StepClock clock;
  std::uint32_t tag;         ///< of the last words that were exchanged
  Index searches, contacts;  ///< contacts: after the last search
  Index dropped;             ///< contacts that searches have dropped and that have spent energy
};

/// Searches by the tiles themselves: what they find, and what they tell each other meanwhile.
struct TileSearches {
  Buffer<double> spheres;        ///< of each element five numbers
  Buffer<double> motion;         ///< of each tile: sums of velocities and of their squares
  Buffer<ContactCounts> counts;  ///< of each element
  Buffer<Index> first_pair;      ///< of each element as the lower one
  Buffer<PairKey> old_key;       ///< contacts before the search
  Buffer<ContactState> old_state;
  Buffer<DroppedContact> old_spent, dropped;
  Buffer<Tile> tiles;
  Buffer<Index> touched;
  Buffer<TilePlace> starts;
  Buffer<TileContact> contacts;
  Buffer<TileNews> news;

  explicit TileSearches(Space space);
};

/// A model's tiles. Elements and links are shared out once, contacts after each search.
struct TilePlan {
  std::vector<Tile> tiles;
  TileGroups groups{};
  std::size_t bytes = 0;           ///< that the largest tile needs
  std::vector<Index> tile_of;      ///< of each element
  std::vector<Index> own, linked;  ///< elements, ascending in each tile
  TilePlaces places;               ///< for telling contacts

  // In the space of the world.
  Buffer<Index> own_there, linked_there;
  Buffer<TileLink> links;
  Buffer<TileAxis> axes;
  Buffer<TilePlace> rows;
  Buffer<std::byte> told;  ///< what a search changes, in one piece, so that one copy brings it
  PieceOf<Tile> tiles_told;
  PieceOf<Index> touched_told;
  PieceOf<TilePlace> starts_told;
  PieceOf<TileContact> contacts_told;
  Buffer<double> constants;  ///< of concrete links outside the memory of tiles: room for two each
  Buffer<TileWord> forces;   ///< of each element, six words, for even and odd steps
  Buffer<TileWord> least;    ///< from each tile to each, likewise
  // Contacts whose b is in another tile than a are followed by both; that of b keeps its own state.
  Buffer<ContactState> twin_state;
  Buffer<double> twin_slid, twin_damped;
  Buffer<PairForce> twin_actions;
  std::uint32_t tag = 0;  ///< of the last words that were exchanged
  TileSearches searches;
  bool found_there = false;  ///< tiles have found their contacts themselves

  explicit TilePlan(Space space);
  /// Brings these and `tiles` to the space of the world.
  void tell(const std::vector<Index>& touched, const std::vector<TilePlace>& starts,
            const std::vector<TileContact>& contacts);
  TilesView view() const;
};

/// Shares a world out to at most `count` tiles. @returns null if links cannot be told by tiles
std::unique_ptr<TilePlan> share_out_to_tiles(const World& w, Index count);
/// Gives tiles their contacts, after a search.
/// @param memory  of a tile at most  [B]
void tell_contacts(const World& w, TilePlan& plan, std::size_t memory);

/// The tiles of a world, once they were asked for. A copy of a world has none.
class Tiles {
 public:
  Tiles() = default;
  Tiles(const Tiles&) {}
  Tiles(Tiles&&) noexcept = default;
  Tiles& operator=(const Tiles&) {
    forget();
    return *this;
  }
  Tiles& operator=(Tiles&&) noexcept = default;
  ~Tiles() = default;

  /// After elements or links have changed places.
  void forget() {
    plan.reset();
    known = false;
  }
  std::unique_ptr<TilePlan> plan;
  bool known = false;           ///< whether `plan` tells how it stands; null: no tiles
  bool contacts_known = false;  ///< whether it has heard of the last search
  std::size_t memory = std::size_t{1} << 30;  ///< of each at most, where a processor takes them [B]
};

}  // namespace breccia::dem
