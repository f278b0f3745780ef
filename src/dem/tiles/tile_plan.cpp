// Tiles by bisection of space, each with about as many links.

#include "dem/tiles/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dem/world.hpp"
#include "exec/tasks.hpp"

namespace breccia::dem {
namespace {

/// Divides elements among tiles by planes across the longest side of what is left. They are sorted
/// once along each axis; each part keeps its three orders.
class Bisection {
 public:
  Bisection(const std::vector<ElementState>& state, int threads) : threads_(threads) {
    left_.resize(state.size());
    right_.resize(state.size());
    for_each_task(threads_, 3, [&](int axis) { sort_along(at(axis), state); });
  }
  /// @param tile_of  of each element: gets its tile, so that all weigh about as much
  void divide(Index tiles, const std::vector<double>& weight, std::vector<Index>& tile_of) {
    for (std::size_t axis = 0; axis < 3; ++axis) order_[axis] = sorted_[axis];
    std::vector<Part> parts{{0, left_.size(), 0, tiles}}, halves;
    for (Index most = tiles; most > 1; most -= most / 2) {
      halves.resize(2 * parts.size());
      for_each_task(threads_, static_cast<int>(parts.size()), [&](int i) {
        halve(parts[at(i)], weight, halves[2 * at(i)], halves[2 * at(i) + 1]);
      });
      parts.swap(halves);
    }
    for (const Part& part : parts)
      for (std::size_t k = part.begin; k < part.end; ++k) tile_of[at(order_[0][k])] = part.first;
  }

 private:
  /// Elements [begin, end) of each order, for tiles [first, first + tiles).
  struct Part {
    std::size_t begin, end;
    Index first, tiles;
  };
  void sort_along(std::size_t axis, const std::vector<ElementState>& state) {
    std::vector<double>& along = along_[axis];
    along.reserve(state.size());
    for (const ElementState& s : state)
      along.push_back(axis == 0 ? s.position.x : axis == 1 ? s.position.y : s.position.z);
    std::vector<Index>& order = sorted_[axis];
    order.resize(state.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Index p, Index q) {
      return along[at(p)] != along[at(q)] ? along[at(p)] < along[at(q)] : p < q;
    });
  }
  std::size_t longest_side(const Part& part) const {
    double length[3] = {0.0, 0.0, 0.0};
    if (part.end > part.begin)
      for (std::size_t axis = 0; axis < 3; ++axis)
        length[axis] = along_[axis][at(order_[axis][part.end - 1])] -
                       along_[axis][at(order_[axis][part.begin])];
    return static_cast<std::size_t>(std::max_element(length, length + 3) - length);
  }
  /// @param low, high  get its halves; of a part of one tile `high` has none
  void halve(const Part& part, const std::vector<double>& weight, Part& low, Part& high) {
    low = part;
    high = {part.end, part.end, part.first, 0};
    if (part.tiles < 2) return;
    const std::size_t axis = longest_side(part);
    const std::vector<Index>& order = order_[axis];
    double whole = 0.0, before = 0.0;
    for (std::size_t k = part.begin; k < part.end; ++k) whole += weight[at(order[k])];
    const Index left = part.tiles / 2;
    const double wanted = whole * left / part.tiles;
    std::size_t middle = part.begin;
    while (middle < part.end && before + 0.5 * weight[at(order[middle])] < wanted)
      before += weight[at(order[middle++])];
    for (std::size_t k = part.begin; k < part.end; ++k) left_[at(order[k])] = k < middle ? 1 : 0;
    for (std::size_t other = 0; other < 3; ++other)
      if (other != axis) sort_sides(order_[other], part);
    low = {part.begin, middle, part.first, left};
    high = {middle, part.end, part.first + left, part.tiles - left};
  }
  /// Brings those on the left to the front, each side in its order.
  void sort_sides(std::vector<Index>& order, const Part& part) {
    std::size_t to = part.begin, rest = part.begin;
    for (std::size_t k = part.begin; k < part.end; ++k)
      (left_[at(order[k])] != 0 ? order[to++] : right_[rest++]) = order[k];
    std::copy(right_.begin() + static_cast<std::ptrdiff_t>(part.begin),
              right_.begin() + static_cast<std::ptrdiff_t>(rest),
              order.begin() + static_cast<std::ptrdiff_t>(to));
  }

  int threads_;
  std::vector<double> along_[3];
  std::vector<Index> sorted_[3], order_[3];
  std::vector<std::uint8_t> left_;  ///< of each element
  std::vector<Index> right_;        ///< each part has its own range
};

/// The links of a kind on the host, with the group of each.
struct LinksHere {
  std::vector<Index> a, b, before, after;
  std::vector<Index> group;
  Index size() const { return static_cast<Index>(a.size()); }
};
template <class Law>
LinksHere links_here(const LinkSet<Law>& set) {
  LinksHere here;
  copy_to(here.a, set.a);
  copy_to(here.b, set.b);
  if constexpr (std::is_same_v<Law, InterfaceLink>) {
    copy_to(here.before, set.before);
    copy_to(here.after, set.after);
  }
  here.group.assign(here.a.size(), 0);
  for (std::size_t g = 0; g < set.groups.size(); ++g)
    for (Index i = set.groups[g].begin; i < set.groups[g].end; ++i)
      here.group[at(i)] = static_cast<Index>(g);
  return here;
}

/// Calls visit(tile) for each tile that evaluates link i.
template <class Visit>
void each_tile_of(const LinksHere& links, Index i, const std::vector<Index>& tile_of,
                  const Visit& visit) {
  const Index of_a = tile_of[at(links.a[at(i)])], of_b = tile_of[at(links.b[at(i)])];
  visit(of_a);
  if (of_b != of_a) visit(of_b);
}

/// The lists of a world that its tiles take parts of, on the host.
struct Sources {
  LinksHere kinds[3];  ///< concrete, steel, interface
  std::vector<Index> bar_starts;
  std::vector<Entry> bar_entries;
  std::vector<Index> tile_of;                     ///< of each element
  std::vector<std::vector<Index>> own, links[3];  ///< of each tile, ascending
};

/// A tile and its part of the lists of all, the places of the tile in them left out.
struct FilledTile {
  Tile tile{};
  std::vector<Index> linked;
  std::vector<TileLink> links;
  std::vector<TileAxis> axes;
  std::vector<TilePlace> rows;
};

/// Fills one tile after the other.
class Filler {
 public:
  explicit Filler(const Sources& from) : from_(from) {
    place_.resize(from.tile_of.size());
    noted_by_.assign(from.tile_of.size(), -1);
  }

  /// @returns whether tiles can number what this one has
  bool fill(Index t, FilledTile& filled) {
    constexpr std::size_t most = std::numeric_limits<TilePlace>::max() / 2;
    const std::vector<Index>& own = from_.own[at(t)];
    if (own.empty()) return false;
    std::vector<Index>& linked = filled.linked;
    list_linked(t, linked);
    if (own.size() + linked.size() >= most) return false;
    std::size_t places = 0;
    for (const Index e : own) place_[at(e)] = static_cast<TilePlace>(places++);
    for (const Index e : linked) place_[at(e)] = static_cast<TilePlace>(places++);
    const auto place = [&](Index e) { return place_[at(e)]; };

    Tile& tile = filled.tile;
    tile.own = static_cast<Index>(own.size());
    tile.linked = static_cast<Index>(linked.size());
    const std::vector<Index> order[3] = {in_order_of_sums(from_.links[0][at(t)]),
                                         from_.links[1][at(t)], from_.links[2][at(t)]};
    tile.concrete = static_cast<Index>(order[0].size());
    tile.steel = static_cast<Index>(order[1].size());
    tile.interface = static_cast<Index>(order[2].size());
    if (at(tile.links()) >= most) return false;  // two entries of rows each
    filled.links.reserve(at(tile.links()));
    for (std::size_t k = 0; k < 3; ++k) {
      const LinksHere& all = from_.kinds[k];
      for (const Index i : order[k])
        filled.links.push_back({place(all.a[at(i)]), place(all.b[at(i)]),
                                static_cast<std::uint32_t>(i) & 0x3ffffffU,
                                static_cast<std::uint32_t>(all.group[at(i)]) & 0x3fU});
    }
    const LinksHere& bonds = from_.kinds[2];
    for (const Index i : order[2])
      filled.axes.push_back({place(bonds.before[at(i)]), place(bonds.after[at(i)])});
    list_rows(own, order, filled);
    return at(tile.row_entries) < 2 * most;
  }

 private:
  /// Elements of other tiles that the links of tile t lead to.
  void list_linked(Index t, std::vector<Index>& linked) {
    const auto note = [&](Index e) {
      if (from_.tile_of[at(e)] == t || noted_by_[at(e)] == t) return;
      noted_by_[at(e)] = t;
      linked.push_back(e);
    };
    for (std::size_t k = 0; k < 3; ++k)
      for (const Index i : from_.links[k][at(t)]) {
        const LinksHere& all = from_.kinds[k];
        note(all.a[at(i)]);
        note(all.b[at(i)]);
        if (k == 2) {
          note(all.before[at(i)]);
          note(all.after[at(i)]);
        }
      }
    std::sort(linked.begin(), linked.end());
  }

  /// The order in which concrete links are summed (list_rows in dem/search.cpp): tile by tile of
  /// the sweep, group by group.
  std::vector<Index> in_order_of_sums(std::vector<Index> links) const {
    const LinksHere& all = from_.kinds[0];
    const auto before = [&](Index i, Index j) {
      const Index p = all.a[at(i)] / sweep_tile, q = all.a[at(j)] / sweep_tile;
      if (p != q) return p < q;
      if (all.group[at(i)] != all.group[at(j)]) return all.group[at(i)] < all.group[at(j)];
      return i < j;
    };
    if (!std::is_sorted(links.begin(), links.end(), before))
      std::sort(links.begin(), links.end(), before);
    return links;
  }

  /// Rows of the own elements of a tile: what each gets as a, and as b.
  void list_rows(const std::vector<Index>& elements, const std::vector<Index> (&order)[3],
                 FilledTile& filled) {
    Tile& tile = filled.tile;
    const Index own = tile.own, bars = tile.bars();
    const std::vector<TileLink>& links = filled.links;
    std::vector<std::vector<TilePlace>>& row = row_of_;
    row.resize(std::max(row.size(), 2 * at(own)));
    for (auto& one : row) one.clear();
    const auto zeros = static_cast<TilePlace>(bars);
    for (Index l = 0; l < tile.concrete; ++l) {
      const auto action = static_cast<TilePlace>(bars + 1 + l);
      const TileLink& link = links[at(l)];
      if (link.a < own) row[2U * link.a].push_back(action);
      if (link.b < own) row[2U * link.b + 1].push_back(action);
    }
    // Bars by the lists of the world, whose pairs are all steel links, then all bonds.
    const Index steel = from_.kinds[1].size();
    const auto place_of_bar = [&](Index pair) {
      const int kind = pair < steel ? 1 : 2;
      const std::vector<Index>& here = order[kind];
      const Index number = pair < steel ? pair : pair - steel;
      const auto found = std::lower_bound(here.begin(), here.end(), number) - here.begin();
      return static_cast<Index>(found) + (kind == 1 ? 0 : tile.steel);
    };
    for (Index e = 0; e < own; ++e) {
      const Index element = elements[at(e)];
      for (Index k = from_.bar_starts[at(element)]; k < from_.bar_starts[at(element) + 1]; ++k) {
        const Entry entry = from_.bar_entries[at(k)];
        row[at(2 * e + side_of(entry))].push_back(
            static_cast<TilePlace>(place_of_bar(pair_of(entry))));
      }
    }
    // Threads of a warp take rows of about the same length.
    std::vector<TilePlace> by_length(at(own)), entries;
    std::iota(by_length.begin(), by_length.end(), TilePlace{0});
    const auto length = [&](TilePlace e) {
      return std::max(row[2U * e].size(), row[2U * e + 1].size());
    };
    std::stable_sort(by_length.begin(), by_length.end(),
                     [&](TilePlace p, TilePlace q) { return length(p) > length(q); });
    std::vector<TilePlace>& rows = filled.rows;
    rows = by_length;
    for (Index k = 0; k < 2 * own; ++k) {
      rows.push_back(static_cast<TilePlace>(entries.size()));
      entries.insert(entries.end(), row[at(k)].begin(), row[at(k)].end());
      const std::size_t longest = length(static_cast<TilePlace>(k / 2));
      entries.resize(rows.back() + (longest + 1) / 2 * 2, zeros);
    }
    rows.push_back(static_cast<TilePlace>(entries.size()));
    rows.resize(at(tile.first_entry()));
    rows.insert(rows.end(), entries.begin(), entries.end());
    tile.row_entries = static_cast<Index>(entries.size());
  }

  const Sources& from_;
  std::vector<std::vector<TilePlace>> row_of_;  ///< of the own elements of the tile that is filled
  std::vector<TilePlace> place_;                ///< of elements in the tile that is filled
  std::vector<Index> noted_by_;                 ///< the last tile that knows each element by a link
};

class Sharing {
 public:
  Sharing(const World& w, Index count)
      : plan_(std::make_unique<TilePlan>(w.exec.space)), count_(count), threads_(w.exec.threads) {
    from_.kinds[0] = links_here(w.concrete);
    from_.kinds[1] = links_here(w.steel);
    from_.kinds[2] = links_here(w.interface);
    copy_to(state_, w.elements.state);
    copy_to(from_.bar_starts, w.bar_incidence.starts);
    copy_to(from_.bar_entries, w.bar_incidence.entries);
    plan_->groups = {static_cast<Index>(w.concrete.groups.size()),
                     static_cast<Index>(w.steel.groups.size()),
                     static_cast<Index>(w.interface.groups.size()), w.concrete.damped};
  }

  std::unique_ptr<TilePlan> plan() {
    divide();
    list_by_tiles();
    std::vector<FilledTile> filled(at(count_));
    std::vector<std::uint8_t> fits(at(count_), 0);
    const int fillers = std::min(threads_, static_cast<int>(count_));
    for_each_task(threads_, fillers, [&](int number) {
      Filler filler(from_);
      for (Index t = number; t < count_; t += fillers) fits[at(t)] = filler.fill(t, filled[at(t)]);
    });
    if (std::find(fits.begin(), fits.end(), 0) != fits.end()) return nullptr;
    join(filled);
    plan_->tile_of = std::move(from_.tile_of);
    plan_->constants.resize(2 * plan_->links.size());
    plan_->forces.resize(2 * 6 * static_cast<Index>(state_.size()));
    plan_->least.resize(2 * count_ * count_);
    return std::move(plan_);
  }

 private:
  /// Weights are corrected until tiles have about as many links, those across their borders
  /// included.
  void divide() {
    Bisection bisection(state_, threads_);
    std::vector<double> weight(state_.size(), 1.0);
    for (const LinksHere& links : from_.kinds)
      for (Index i = 0; i < links.size(); ++i) {
        weight[at(links.a[at(i)])] += 0.5;
        weight[at(links.b[at(i)])] += 0.5;
      }
    double best = 1e300;
    std::vector<Index> tile_of(state_.size());
    for (int turn = 0; turn < 6; ++turn) {
      bisection.divide(count_, weight, tile_of);
      std::vector<double> links(static_cast<std::size_t>(count_), 1.0);
      for (const LinksHere& kind : from_.kinds)
        for (Index i = 0; i < kind.size(); ++i)
          each_tile_of(kind, i, tile_of, [&](Index t) { links[at(t)] += 1.0; });
      const double most = *std::max_element(links.begin(), links.end());
      if (most < best) {
        best = most;
        from_.tile_of = tile_of;
      }
      const double mean = std::accumulate(links.begin(), links.end(), 0.0) / count_;
      if (most < 1.02 * mean) break;
      for (double& excess : links) excess = std::pow(excess / mean, 0.85);
      for (std::size_t e = 0; e < weight.size(); ++e) weight[e] *= links[at(tile_of[e])];
    }
  }

  void list_by_tiles() {
    from_.own.resize(at(count_));
    for (Index e = 0; e < static_cast<Index>(state_.size()); ++e)
      from_.own[at(from_.tile_of[at(e)])].push_back(e);
    for_each_task(threads_, 3, [this](int k) {
      const LinksHere& kind = from_.kinds[k];
      from_.links[k].resize(at(count_));
      for (Index i = 0; i < kind.size(); ++i)
        each_tile_of(kind, i, from_.tile_of, [&](Index t) { from_.links[k][at(t)].push_back(i); });
    });
  }

  /// The lists of all tiles, one tile after the other.
  void join(std::vector<FilledTile>& filled) {
    TilePlan& p = *plan_;
    std::vector<TileLink> links;
    std::vector<TileAxis> axes;
    std::vector<TilePlace> rows;
    const auto append = [](auto& all, const auto& more) {
      const auto first = static_cast<Index>(all.size());
      all.insert(all.end(), more.begin(), more.end());
      return first;
    };
    for (Index t = 0; t < count_; ++t) {
      const FilledTile& one = filled[at(t)];
      Tile tile = one.tile;
      tile.first_own = append(p.own, from_.own[at(t)]);
      tile.first_linked = append(p.linked, one.linked);
      tile.first_link = append(links, one.links);
      tile.first_axis = append(axes, one.axes);
      tile.first_row = append(rows, one.rows);
      tile.first_start = tile.first_own + t;
      p.tiles.push_back(tile);
    }
    copy_to(p.own_there, p.own);
    copy_to(p.linked_there, p.linked);
    copy_to(p.links, links);
    copy_to(p.axes, axes);
    copy_to(p.rows, rows);
  }

  Sources from_;
  std::unique_ptr<TilePlan> plan_;
  Index count_;
  int threads_;
  std::vector<ElementState> state_;
};

}  // namespace

TilePlan::TilePlan(Space space)
    : own_there(space),
      linked_there(space),
      links(space),
      axes(space),
      rows(space),
      told(space),
      constants(space),
      forces(space),
      least(space),
      twin_state(space),
      twin_slid(space),
      twin_damped(space),
      twin_actions(space),
      searches(space) {}

std::unique_ptr<TilePlan> share_out_to_tiles(const World& w, Index count) {
  constexpr std::size_t most_groups = 64;
  constexpr Index most_links = 1 << 26;
  if (w.concrete.groups.size() > most_groups || w.steel.groups.size() > most_groups ||
      w.interface.groups.size() > most_groups || w.links() >= most_links)
    return nullptr;
  return Sharing(w, count).plan();
}

}  // namespace breccia::dem
