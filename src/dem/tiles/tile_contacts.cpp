// Changes of tiles by a search: their contacts, and the elements that these lead to.

#include <algorithm>
#include <cstring>
#include <numeric>

#include "dem/tiles/tile_plan.hpp"
#include "dem/world.hpp"

namespace breccia::dem {
namespace {

/// Contacts as one of their ends sees them, an element of a tile: in the order of tiles, those of a
/// tile in the order of all.
class ContactsByTile {
 public:
  ContactsByTile(const World& w, const TilePlan& plan) : begin_(plan.tiles.size() + 1, 0) {
    copy_to(a_, w.contacts.pairs.a);
    copy_to(b_, w.contacts.pairs.b);
    const auto each = [&](const auto& visit) {
      for (Index p = 0; p < static_cast<Index>(a_.size()); ++p) {
        visit(plan.tile_of[at(a_[at(p)])], 2 * p);
        visit(plan.tile_of[at(b_[at(p)])], 2 * p + 1);
      }
    };
    each([&](Index t, Entry) { ++begin_[at(t) + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    entries_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    each([&](Index t, Entry entry) { entries_[next[at(t)]++] = entry; });
  }
  /// Appends the contacts of tile t by its own elements, where those of each begin, and the
  /// elements that no link has told it of.
  void list(Index t, TilePlan& plan, std::vector<TileContact>& contacts,
            std::vector<TilePlace>& starts, std::vector<Index>& touched) {
    const Tile& tile = plan.tiles[at(t)];
    if (begin_[at(t)] == begin_[at(t) + 1]) {
      starts.resize(starts.size() + at(tile.own) + 1, TilePlace{0});
      return;
    }
    for (Index k = 0; k < tile.linked; ++k)
      plan.places.note(plan.linked[at(tile.first_linked + k)], t, tile.own + k);
    const std::size_t first_touched = touched.size();
    next_.assign(at(tile.own) + 1, 0);
    found_.clear();
    for (std::size_t k = begin_[at(t)]; k < begin_[at(t) + 1]; ++k) {
      const Index p = pair_of(entries_[k]), side = side_of(entries_[k]);
      const Index own = side == 0 ? a_[at(p)] : b_[at(p)],
                  other = side == 0 ? b_[at(p)] : a_[at(p)];
      const TilePlace place = plan.places.own(own);
      found_.push_back({p, place, place_of(other, t, plan, touched, first_touched), side});
      ++next_[place + 1U];
    }
    std::partial_sum(next_.begin(), next_.end(), next_.begin());
    for (const std::size_t start : next_) starts.push_back(static_cast<TilePlace>(start));
    const std::size_t first = contacts.size();
    contacts.resize(first + found_.size());
    for (const TileContact& one : found_) contacts[first + next_[one.own]++] = one;
  }

 private:
  /// Of an element in tile t, which gets to know it.
  static TilePlace place_of(Index element, Index t, TilePlan& plan, std::vector<Index>& touched,
                            std::size_t first_touched) {
    TilePlaces& places = plan.places;
    if (plan.tile_of[at(element)] == t) return places.own(element);
    if (!places.is_noted(t, element)) {
      const Tile& tile = plan.tiles[at(t)];
      const auto more = static_cast<Index>(touched.size() - first_touched);
      places.note(element, t, tile.own + tile.linked + more);
      touched.push_back(element);
    }
    return places.noted(element);
  }

  std::vector<Index> a_, b_;
  std::vector<std::size_t> begin_;  ///< first entry of each tile, and the end
  std::vector<Entry> entries_;
  std::vector<std::size_t> next_;   ///< of each own element of a tile
  std::vector<TileContact> found_;  ///< by a tile, in the order of all
};

template <class T>
PieceOf<T> append(std::vector<std::byte>& all, const std::vector<T>& items) {
  constexpr std::size_t line = 16;
  const std::size_t begin = (all.size() + line - 1) / line * line, bytes = items.size() * sizeof(T);
  all.resize(begin + bytes);
  if (bytes > 0) std::memcpy(all.data() + begin, items.data(), bytes);
  return {begin, static_cast<Index>(items.size())};
}
template <class T>
View<const T> piece(const Buffer<std::byte>& all, const PieceOf<T>& of) {
  View<const T> view;
  view.data = reinterpret_cast<const T*>(all.data() + of.begin);
  view.size = of.count;
  view.space = all.space();
  return view;
}

}  // namespace

void TilePlaces::begin(const std::vector<Index>& tile_of, const std::vector<Tile>& tiles,
                       const std::vector<Index>& own) {
  noted_by_.assign(tile_of.size(), -1);
  if (!own_.empty()) return;
  own_.resize(tile_of.size());
  noted_.resize(tile_of.size());
  for (const Tile& tile : tiles)
    for (Index k = 0; k < tile.own; ++k)
      own_[at(own[at(tile.first_own + k)])] = static_cast<TilePlace>(k);
}

TileSearches::TileSearches(Space space)
    : spheres(space),
      motion(space),
      counts(space),
      first_pair(space),
      old_key(space),
      old_state(space),
      old_spent(space),
      dropped(space),
      tiles(space),
      touched(space),
      starts(space),
      contacts(space),
      news(space) {}

void TilePlan::tell(const std::vector<Index>& touched, const std::vector<TilePlace>& starts,
                    const std::vector<TileContact>& contacts) {
  std::vector<std::byte> all;
  tiles_told = append(all, tiles);
  touched_told = append(all, touched);
  starts_told = append(all, starts);
  contacts_told = append(all, contacts);
  told.reserve(static_cast<Index>(all.size() + all.size() / 2));
  copy_to(told, all);
}

TilesView TilePlan::view() const {
  TileLists lists{piece(told, tiles_told), piece(told, touched_told), piece(told, starts_told),
                  piece(told, contacts_told)};
  if (found_there) {
    lists.tiles.data = searches.tiles.data();
    lists.touched.data = searches.touched.data();
    lists.starts.data = searches.starts.data();
    lists.contacts.data = searches.contacts.data();
    lists.touched.size = lists.contacts.size =
        static_cast<Index>(tiles.size()) * most_contacts_of_tile;
  }
  return {static_cast<Index>(tiles.size()),
          groups,
          own_there.view(),
          linked_there.view(),
          links.view(),
          axes.view(),
          rows.view(),
          lists};
}

void tell_contacts(const World& w, TilePlan& plan, std::size_t most_bytes) {
  ContactsByTile by_tile(w, plan);
  plan.places.begin(plan.tile_of, plan.tiles, plan.own);
  std::vector<TilePlace> starts;
  std::vector<TileContact> contacts;
  std::vector<Index> all_touched;
  plan.bytes = 0;
  for (Index t = 0; t < static_cast<Index>(plan.tiles.size()); ++t) {
    Tile& tile = plan.tiles[at(t)];
    tile.first_contact = static_cast<Index>(contacts.size());
    tile.first_touched = static_cast<Index>(all_touched.size());
    by_tile.list(t, plan, contacts, starts, all_touched);
    tile.contacts = static_cast<Index>(contacts.size()) - tile.first_contact;
    tile.touched = static_cast<Index>(all_touched.size()) - tile.first_touched;
    const Index most = most_acting(w.exec.space);
    const std::size_t bytes = with_arithmetic(w.exec.precision, [&](auto number) {
      return make_room<decltype(number)>(tile, plan.groups, most_bytes, most);
    });
    plan.bytes = std::max(plan.bytes, bytes);
  }
  plan.tell(all_touched, starts, contacts);
  plan.found_there = false;
}

}  // namespace breccia::dem
