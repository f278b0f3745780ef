// Tiles by bisection of space, each with about as many links.

#include "dem/tiles/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dem/world.hpp"

namespace breccia::dem {
namespace {

/// Divides elements among tiles by planes across the longest side of what is left.
class Bisection {
 public:
  Bisection(const std::vector<Vec3>& position, const std::vector<double>& weight,
            std::vector<Index>& tile_of)
      : position_(position), weight_(weight), tile_of_(tile_of), order_(position.size()) {
    for (std::size_t e = 0; e < order_.size(); ++e) order_[e] = {0.0, static_cast<Index>(e)};
  }
  void divide(Index tiles) { divide(0, order_.size(), 0, tiles); }

 private:
  struct Placed {
    double along;  ///< the axis  [m]
    Index element;
  };
  static double part(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
  int longest_side(std::size_t begin, std::size_t end) const {
    double length[3];
    for (int axis = 0; axis < 3; ++axis) {
      double low = 1e300, high = -1e300;
      for (std::size_t k = begin; k < end; ++k) {
        const double x = part(position_[at(order_[k].element)], axis);
        low = std::min(low, x);
        high = std::max(high, x);
      }
      length[axis] = high - low;
    }
    return static_cast<int>(std::max_element(length, length + 3) - length);
  }
  void divide(std::size_t begin, std::size_t end, Index first, Index tiles) {
    if (tiles == 1) {
      for (std::size_t k = begin; k < end; ++k) tile_of_[at(order_[k].element)] = first;
      return;
    }
    const int axis = longest_side(begin, end);
    double whole = 0.0, before = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
      order_[k].along = part(position_[at(order_[k].element)], axis);
      whole += weight_[at(order_[k].element)];
    }
    std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin),
              order_.begin() + static_cast<std::ptrdiff_t>(end),
              [](const Placed& p, const Placed& q) {
                return p.along != q.along ? p.along < q.along : p.element < q.element;
              });
    const Index left = tiles / 2;
    const double wanted = whole * left / tiles;
    std::size_t middle = begin;
    while (middle < end && before + 0.5 * weight_[at(order_[middle].element)] < wanted)
      before += weight_[at(order_[middle++].element)];
    divide(begin, middle, first, left);
    divide(middle, end, first + left, tiles - left);
  }

  const std::vector<Vec3>& position_;
  const std::vector<double>& weight_;
  std::vector<Index>& tile_of_;
  std::vector<Placed> order_;
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

class Sharing {
 public:
  Sharing(const World& w, Index count)
      : w_(w),
        plan_(std::make_unique<TilePlan>(w.exec.space)),
        count_(count),
        kinds_{links_here(w.concrete), links_here(w.steel), links_here(w.interface)} {
    copy_to(state_, w.elements.state);
    place_.resize(state_.size());
    copy_to(bar_starts_, w.bar_incidence.starts);
    copy_to(bar_entries_, w.bar_incidence.entries);
    plan_->groups = {static_cast<Index>(w.concrete.groups.size()),
                     static_cast<Index>(w.steel.groups.size()),
                     static_cast<Index>(w.interface.groups.size())};
  }

  std::unique_ptr<TilePlan> plan() {
    divide();
    for (Index t = 0; t < count_; ++t)
      if (!fill(t)) return nullptr;
    TilePlan& p = *plan_;
    copy_to(p.own_there, p.own);
    copy_to(p.linked_there, p.linked);
    copy_to(p.links, links_);
    copy_to(p.axes, axes_);
    copy_to(p.rows, rows_);
    p.forces.resize(2 * 6 * static_cast<Index>(state_.size()));
    p.least.resize(2 * count_ * count_);
    return std::move(plan_);
  }

 private:
  /// Weights are corrected until tiles have about as many links, those across their borders
  /// included.
  void divide() {
    std::vector<Vec3> position;
    for (const ElementState& s : state_) position.push_back(s.position);
    std::vector<double> weight(state_.size(), 1.0);
    for (const LinksHere& links : kinds_)
      for (Index i = 0; i < links.size(); ++i) {
        weight[at(links.a[at(i)])] += 0.5;
        weight[at(links.b[at(i)])] += 0.5;
      }
    double best = 1e300;
    std::vector<Index> tile_of(state_.size());
    for (int turn = 0; turn < 6; ++turn) {
      Bisection(position, weight, tile_of).divide(count_);
      std::vector<double> links(static_cast<std::size_t>(count_), 1.0);
      for (const LinksHere& kind : kinds_)
        for (Index i = 0; i < kind.size(); ++i)
          each_tile_of(kind, i, tile_of, [&](Index t) { links[at(t)] += 1.0; });
      const double most = *std::max_element(links.begin(), links.end());
      if (most < best) {
        best = most;
        plan_->tile_of = tile_of;
      }
      const double mean = std::accumulate(links.begin(), links.end(), 0.0) / count_;
      if (most < 1.02 * mean) break;
      for (std::size_t e = 0; e < weight.size(); ++e)
        weight[e] *= std::sqrt(links[at(tile_of[e])] / mean);
    }
    own_.resize(static_cast<std::size_t>(count_));
    for (Index e = 0; e < static_cast<Index>(state_.size()); ++e)
      own_[at(plan_->tile_of[at(e)])].push_back(e);
    for (std::size_t k = 0; k < 3; ++k) {
      links_of_[k].resize(static_cast<std::size_t>(count_));
      for (Index i = 0; i < kinds_[k].size(); ++i)
        each_tile_of(kinds_[k], i, plan_->tile_of,
                     [&](Index t) { links_of_[k][at(t)].push_back(i); });
    }
  }

  /// The order in which concrete links are summed (list_rows in dem/search.cpp): tile by tile of
  /// the sweep, group by group.
  std::vector<Index> in_order_of_sums(std::vector<Index> links) const {
    const LinksHere& all = kinds_[0];
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

  bool fill(Index t) {
    constexpr std::size_t most = std::numeric_limits<TilePlace>::max() / 2;
    TilePlan& p = *plan_;
    Tile tile{};
    std::vector<Index> known = own_[at(t)];
    if (known.empty()) return false;
    std::vector<Index> linked;
    for (std::size_t k = 0; k < 3; ++k)
      for (const Index i : links_of_[k][at(t)]) {
        linked.push_back(kinds_[k].a[at(i)]);
        linked.push_back(kinds_[k].b[at(i)]);
        if (k == 2) {
          linked.push_back(kinds_[k].before[at(i)]);
          linked.push_back(kinds_[k].after[at(i)]);
        }
      }
    std::sort(linked.begin(), linked.end());
    linked.erase(std::unique(linked.begin(), linked.end()), linked.end());
    std::erase_if(linked, [&](Index e) { return p.tile_of[at(e)] == t; });
    known.insert(known.end(), linked.begin(), linked.end());
    if (known.size() >= most) return false;

    for (std::size_t k = 0; k < known.size(); ++k) place_[at(known[k])] = static_cast<TilePlace>(k);
    const auto place = [&](Index e) { return place_[at(e)]; };

    tile.own = static_cast<Index>(own_[at(t)].size());
    tile.linked = static_cast<Index>(linked.size());
    tile.first_own = static_cast<Index>(p.own.size());
    tile.first_linked = static_cast<Index>(p.linked.size());
    tile.first_link = static_cast<Index>(links_.size());
    tile.first_axis = static_cast<Index>(axes_.size());
    tile.first_row = static_cast<Index>(rows_.size());
    tile.first_start = tile.first_own + t;
    p.own.insert(p.own.end(), own_[at(t)].begin(), own_[at(t)].end());
    p.linked.insert(p.linked.end(), linked.begin(), linked.end());

    const std::vector<Index> order[3] = {in_order_of_sums(links_of_[0][at(t)]), links_of_[1][at(t)],
                                         links_of_[2][at(t)]};
    for (std::size_t k = 0; k < 3; ++k)
      for (const Index i : order[k])
        links_.push_back({place(kinds_[k].a[at(i)]), place(kinds_[k].b[at(i)]),
                          static_cast<std::uint32_t>(i) & 0xfffffffU,
                          static_cast<std::uint32_t>(kinds_[k].group[at(i)]) & 0xfU});
    for (const Index i : order[2])
      axes_.push_back({place(kinds_[2].before[at(i)]), place(kinds_[2].after[at(i)])});
    tile.concrete = static_cast<Index>(order[0].size());
    tile.steel = static_cast<Index>(order[1].size());
    tile.interface = static_cast<Index>(order[2].size());
    if (at(tile.links()) >= most) return false;  // two entries of rows each
    list_rows(tile, order);
    p.tiles.push_back(tile);
    return true;
  }

  /// Rows of the own elements of a tile: what each gets as a, and as b.
  void list_rows(Tile& tile, const std::vector<Index> (&order)[3]) {
    const Index own = tile.own, bars = tile.bars();
    const TileLink* links = links_.data() + tile.first_link;
    std::vector<std::vector<TilePlace>>& row = row_of_;
    row.resize(std::max(row.size(), 2 * at(own)));
    for (auto& one : row) one.clear();
    for (Index l = 0; l < tile.concrete; ++l) {
      const auto action = static_cast<TilePlace>(bars + l);
      if (links[l].a < own) row[2U * links[l].a].push_back(action);
      if (links[l].b < own) row[2U * links[l].b + 1].push_back(action);
    }
    // Bars by the lists of the world, whose pairs are all steel links, then all bonds.
    const Index steel = w_.steel.size();
    const auto place_of_bar = [&](Index pair) {
      const int kind = pair < steel ? 1 : 2;
      const std::vector<Index>& here = order[kind];
      const Index number = pair < steel ? pair : pair - steel;
      const auto found = std::lower_bound(here.begin(), here.end(), number) - here.begin();
      return static_cast<Index>(found) + (kind == 1 ? 0 : tile.steel);
    };
    for (Index e = 0; e < own; ++e) {
      const Index element = plan_->own[at(tile.first_own + e)];
      for (Index k = bar_starts_[at(element)]; k < bar_starts_[at(element) + 1]; ++k) {
        const Entry entry = bar_entries_[at(k)];
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
    rows_.insert(rows_.end(), by_length.begin(), by_length.end());
    for (Index k = 0; k < 2 * own; ++k) {
      rows_.push_back(static_cast<TilePlace>(entries.size()));
      entries.insert(entries.end(), row[at(k)].begin(), row[at(k)].end());
    }
    rows_.push_back(static_cast<TilePlace>(entries.size()));
    rows_.insert(rows_.end(), entries.begin(), entries.end());
    tile.row_entries = static_cast<Index>(entries.size());
  }

  const World& w_;
  std::unique_ptr<TilePlan> plan_;
  Index count_;
  LinksHere kinds_[3];
  std::vector<ElementState> state_;
  std::vector<std::vector<TilePlace>> row_of_;  ///< of the own elements of the tile that is filled
  std::vector<TilePlace> place_;                ///< of elements in the tile that is filled
  std::vector<Index> bar_starts_;
  std::vector<Entry> bar_entries_;
  std::vector<std::vector<Index>> own_, links_of_[3];
  std::vector<TileLink> links_;
  std::vector<TileAxis> axes_;
  std::vector<TilePlace> rows_;
};

}  // namespace

TilePlan::TilePlan(Space space)
    : tiles_there(space),
      own_there(space),
      linked_there(space),
      touched_there(space),
      links(space),
      axes(space),
      rows(space),
      starts(space),
      contacts(space),
      forces(space),
      least(space),
      twin_state(space),
      twin_slid(space),
      twin_damped(space),
      twin_actions(space) {}

TilesView TilePlan::view() const {
  return {tiles_there.view(),   groups,         own_there.view(), linked_there.view(),
          touched_there.view(), links.view(),   axes.view(),      rows.view(),
          starts.view(),        contacts.view()};
}

std::unique_ptr<TilePlan> share_out_to_tiles(const World& w, Index count) {
  constexpr std::size_t most_groups = 16;
  constexpr Index most_links = 1 << 28;
  if (w.concrete.groups.size() > most_groups || w.steel.groups.size() > most_groups ||
      w.interface.groups.size() > most_groups || w.links() >= most_links)
    return nullptr;
  return Sharing(w, count).plan();
}

void tell_contacts(const World& w, TilePlan& plan) {
  std::vector<Index> a, b;
  copy_to(a, w.contacts.pairs.a);
  copy_to(b, w.contacts.pairs.b);
  const auto tiles = static_cast<Index>(plan.tiles.size());
  std::vector<std::vector<std::pair<Index, TileContact>>> of_tile(plan.tiles.size());
  std::vector<std::vector<Index>> touched(plan.tiles.size());
  const auto place = [&](Index t, Index e) {
    const Tile& tile = plan.tiles[at(t)];
    const auto own = plan.own.begin() + tile.first_own,
               linked = plan.linked.begin() + tile.first_linked;
    const auto among_own = std::lower_bound(own, own + tile.own, e);
    if (among_own != own + tile.own && *among_own == e)
      return static_cast<TilePlace>(among_own - own);
    const auto among_linked = std::lower_bound(linked, linked + tile.linked, e);
    if (among_linked != linked + tile.linked && *among_linked == e)
      return static_cast<TilePlace>(tile.own + (among_linked - linked));
    std::vector<Index>& more = touched[at(t)];
    const auto again = std::find(more.begin(), more.end(), e) - more.begin();
    if (static_cast<std::size_t>(again) == more.size()) more.push_back(e);
    return static_cast<TilePlace>(tile.own + tile.linked + again);
  };
  for (Index p = 0; p < static_cast<Index>(a.size()); ++p)
    for (Index side = 0; side < 2; ++side) {
      const Index own = side == 0 ? a[at(p)] : b[at(p)], other = side == 0 ? b[at(p)] : a[at(p)];
      const Index t = plan.tile_of[at(own)];
      of_tile[at(t)].push_back({own, {p, place(t, own), place(t, other), side}});
    }
  // Contacts ascend by their ids, so that those of an element come in the order of their partners.
  std::vector<TileContact> contacts;
  std::vector<TilePlace> starts;
  std::vector<Index> all_touched;
  plan.bytes = 0;
  for (Index t = 0; t < tiles; ++t) {
    Tile& tile = plan.tiles[at(t)];
    auto& here = of_tile[at(t)];
    std::stable_sort(here.begin(), here.end(),
                     [](const auto& p, const auto& q) { return p.second.own < q.second.own; });
    tile.first_contact = static_cast<Index>(contacts.size());
    tile.contacts = static_cast<Index>(here.size());
    tile.first_touched = static_cast<Index>(all_touched.size());
    tile.touched = static_cast<Index>(touched[at(t)].size());
    std::size_t next = 0;
    for (Index e = 0; e <= tile.own; ++e) {
      while (next < here.size() && here[next].second.own < e) ++next;
      starts.push_back(static_cast<TilePlace>(next));
    }
    for (const auto& one : here) contacts.push_back(one.second);
    all_touched.insert(all_touched.end(), touched[at(t)].begin(), touched[at(t)].end());
    TileMemory memory;
    plan.bytes =
        std::max(plan.bytes, memory.lay_out(tile, plan.groups, reinterpret_cast<std::byte*>(64)));
  }
  copy_to(plan.tiles_there, plan.tiles);
  copy_to(plan.touched_there, all_touched);
  copy_to(plan.starts, starts);
  copy_to(plan.contacts, contacts);
  const Index count = w.contacts.size();
  if (count <= plan.twin_state.size()) return;
  const Index room = 2 * count;
  plan.twin_state.resize(room);
  plan.twin_slid.resize(room);
  plan.twin_damped.resize(room);
  plan.twin_actions.resize(room);
}

}  // namespace breccia::dem
