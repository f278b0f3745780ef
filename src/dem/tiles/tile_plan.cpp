// Tiles by bisection of space, each with about as many links.

#include "dem/tiles/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dem/world.hpp"

namespace breccia::dem {
namespace {

/// Divides elements among tiles by planes across the longest side of what is left. They are sorted
/// once along each axis; each part keeps its three orders.
class Bisection {
 public:
  explicit Bisection(const std::vector<ElementState>& state) {
    left_.resize(state.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
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
  }
  /// @param tile_of  of each element: gets its tile, so that all weigh about as much
  void divide(Index tiles, const std::vector<double>& weight, std::vector<Index>& tile_of) {
    for (std::size_t axis = 0; axis < 3; ++axis) order_[axis] = sorted_[axis];
    divide({0, left_.size()}, 0, tiles, weight, tile_of);
  }

 private:
  struct Run {
    std::size_t begin, end;
  };
  std::size_t longest_side(const Run& run) const {
    double length[3] = {0.0, 0.0, 0.0};
    if (run.end > run.begin)
      for (std::size_t axis = 0; axis < 3; ++axis)
        length[axis] =
            along_[axis][at(order_[axis][run.end - 1])] - along_[axis][at(order_[axis][run.begin])];
    return static_cast<std::size_t>(std::max_element(length, length + 3) - length);
  }
  void divide(const Run& run, Index first, Index tiles, const std::vector<double>& weight,
              std::vector<Index>& tile_of) {
    const std::size_t axis = longest_side(run);
    const std::vector<Index>& order = order_[axis];
    if (tiles == 1) {
      for (std::size_t k = run.begin; k < run.end; ++k) tile_of[at(order[k])] = first;
      return;
    }
    double whole = 0.0, before = 0.0;
    for (std::size_t k = run.begin; k < run.end; ++k) whole += weight[at(order[k])];
    const Index left = tiles / 2;
    const double wanted = whole * left / tiles;
    std::size_t middle = run.begin;
    while (middle < run.end && before + 0.5 * weight[at(order[middle])] < wanted)
      before += weight[at(order[middle++])];
    for (std::size_t k = run.begin; k < run.end; ++k) left_[at(order[k])] = k < middle ? 1 : 0;
    for (std::size_t other = 0; other < 3; ++other)
      if (other != axis) part(order_[other], run);
    divide({run.begin, middle}, first, left, weight, tile_of);
    divide({middle, run.end}, first + left, tiles - left, weight, tile_of);
  }
  /// Brings those on the left to the front, each side in its order.
  void part(std::vector<Index>& order, const Run& run) {
    right_.clear();
    std::size_t to = run.begin;
    for (std::size_t k = run.begin; k < run.end; ++k)
      if (left_[at(order[k])] != 0)
        order[to++] = order[k];
      else
        right_.push_back(order[k]);
    std::copy(right_.begin(), right_.end(), order.begin() + static_cast<std::ptrdiff_t>(to));
  }

  std::vector<double> along_[3];
  std::vector<Index> sorted_[3], order_[3], right_;
  std::vector<std::uint8_t> left_;  ///< of each element
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
    noted_by_.assign(state_.size(), -1);
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
    Bisection bisection(state_);
    std::vector<double> weight(state_.size(), 1.0);
    for (const LinksHere& links : kinds_)
      for (Index i = 0; i < links.size(); ++i) {
        weight[at(links.a[at(i)])] += 0.5;
        weight[at(links.b[at(i)])] += 0.5;
      }
    double best = 1e300;
    std::vector<Index> tile_of(state_.size());
    for (int turn = 0; turn < 6; ++turn) {
      bisection.divide(count_, weight, tile_of);
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
      for (double& excess : links) excess = std::pow(excess / mean, 0.85);
      for (std::size_t e = 0; e < weight.size(); ++e) weight[e] *= links[at(tile_of[e])];
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
    const auto note = [&](Index e) {
      if (p.tile_of[at(e)] == t || noted_by_[at(e)] == t) return;
      noted_by_[at(e)] = t;
      linked.push_back(e);
    };
    for (std::size_t k = 0; k < 3; ++k)
      for (const Index i : links_of_[k][at(t)]) {
        note(kinds_[k].a[at(i)]);
        note(kinds_[k].b[at(i)]);
        if (k == 2) {
          note(kinds_[k].before[at(i)]);
          note(kinds_[k].after[at(i)]);
        }
      }
    std::sort(linked.begin(), linked.end());
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
  std::vector<Index> noted_by_;                 ///< the last tile that knows each element by a link
  std::vector<Index> bar_starts_;
  std::vector<Entry> bar_entries_;
  std::vector<std::vector<Index>> own_, links_of_[3];
  std::vector<TileLink> links_;
  std::vector<TileAxis> axes_;
  std::vector<TilePlace> rows_;
};

}  // namespace

TilePlan::TilePlan(Space space)
    : own_there(space),
      linked_there(space),
      links(space),
      axes(space),
      rows(space),
      told(space),
      forces(space),
      least(space),
      twin_state(space),
      twin_slid(space),
      twin_damped(space),
      twin_actions(space),
      searches(space) {}

std::unique_ptr<TilePlan> share_out_to_tiles(const World& w, Index count) {
  constexpr std::size_t most_groups = 16;
  constexpr Index most_links = 1 << 28;
  if (w.concrete.groups.size() > most_groups || w.steel.groups.size() > most_groups ||
      w.interface.groups.size() > most_groups || w.links() >= most_links)
    return nullptr;
  return Sharing(w, count).plan();
}

}  // namespace breccia::dem
