// Lists that follow from elements and links: laws for devices, rows of links, shares of threads.

#include <algorithm>
#include <limits>
#include <utility>

#include "core/on_host.hpp"
#include "core/rows.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "exec/for_each.hpp"
#include "exec/sort_scan.hpp"

namespace breccia::dem {
namespace {

struct Ascending {
  BR_HD bool operator()(Index p, Index q) const { return p < q; }
};

/// First link of each element among a group's links, which are sorted by a.
template <class Law>
void find_starts(int threads, const Buffer<Index>& ends, Index elements, LinkGroup<Law>& group) {
  const Index* const a = ends.data();
  group.starts.resize_unfilled(elements + 1);
  Index* const starts = group.starts.data();
  each_portion(threads, group.end - group.begin, [&](Index begin, Index end) {
    for (Index i = group.begin + begin; i < group.begin + end; ++i)
      for (Index e = i == group.begin ? 0 : a[i - 1] + 1; e <= a[i]; ++e) starts[e] = i;
  });
  const Index beyond = group.end > group.begin ? a[group.end - 1] + 1 : 0;
  std::fill(starts + beyond, starts + elements + 1, group.end);
}

/// Links at one of their ends, by element, each row in the order of `order`.
LinkRows rows_of(const Exec& exec, const Buffer<Index>& end, Index elements,
                 const Buffer<Index>& order) {
  const Exec host{.threads = exec.threads};
  const Index count = order.size();
  const auto end_of = [&](Index k) { return end.data()[order.data()[k]]; };
  Buffer<Index> starts(Space::host, elements + 1), links = unfilled<Index>(Space::host, count);
  each_portion(host.threads, count, [&](Index from, Index to) {
    for (Index k = from; k < to; ++k) count_up(starts.data()[end_of(k)]);
  });
  exclusive_scan(host, starts);
  Buffer<Index> next(starts);
  each_portion(host.threads, count, [&](Index from, Index to) {
    for (Index k = from; k < to; ++k) links.data()[count_up(next.data()[end_of(k)])] = k;
  });
  each_portion(host.threads, elements, [&](Index from, Index to) {
    for (Index e = from; e < to; ++e) {
      Index* const row = links.data() + starts.data()[e];
      const Index length = starts.data()[e + 1] - starts.data()[e];
      sort_row(row, length, Ascending{});
      for (Index k = 0; k < length; ++k) row[k] = order.data()[row[k]];
    }
  });
  LinkRows rows(exec.space);
  copy_to(rows.starts, starts);
  copy_to(rows.links, links);
  return rows;
}

/// The order in which the host adds links up, as lists for a device: by tiles of link_plan, which
/// global ids bound, each group by group.
void list_rows(World& w, const Buffer<Index>& a, const Buffer<Index>& b) {
  const Index count = w.elements.size();
  const std::vector<Index>& tiles = w.link_plan.tiles;
  Buffer<Index> order = unfilled<Index>(Space::host, a.size());
  each_portion(w.exec.threads, static_cast<Index>(tiles.size()) - 1, [&](Index from, Index to) {
    for (Index t = from; t < to; ++t) {
      const Index begin = tiles[at(t)], end = tiles[at(t + 1)];
      Index place = 0;  // links of tiles before
      for (const auto& group : w.concrete.groups) place += group.starts.data()[begin] - group.begin;
      for (const auto& group : w.concrete.groups)
        for (Index i = group.starts.data()[begin]; i < group.starts.data()[end]; ++i)
          order.data()[place++] = i;
    }
  });
  w.rows_a = rows_of(w.exec, a, count, order);
  w.rows_b = rows_of(w.exec, b, count, order);
  with_number(w.exec.precision,
              [&](auto number) { w.link_actions.as<decltype(number)>().resize(a.size()); });
}

/// Whether the host sums facets as they come. Not beside bars: an element's facets and bonds are
/// added in the order of their partners, one among the other.
bool facets_are_swept(const World& w) {
  return w.exec.space == Space::host && w.ldpm.size() > 0 &&
         w.steel.size() + w.interface.size() + w.parallel.size() == 0;
}

/// Runs of elements with about as many links each.
void plan_sweep(World& w) {
  const OnHost<Buffer<Index>> a(w.concrete.a, w.exec.space), b(w.concrete.b, w.exec.space);
  const Index count = w.elements.size();
  for (auto& group : w.concrete.groups) find_starts(w.exec.threads, *a, count, group);
  const bool facets = facets_are_swept(w);
  if (facets)
    for (auto& group : w.ldpm.groups) find_starts(w.exec.threads, w.ldpm.a, count, group);
  const auto each_group = [&](const auto& visit) {
    for (const auto& group : w.concrete.groups) visit(group, *a, *b);
    if (facets)
      for (const auto& group : w.ldpm.groups) visit(group, w.ldpm.a, w.ldpm.b);
  };
  const int threads = count < smallest_shared_loop ? 1 : w.exec.threads;
  w.link_plan = {};
  w.link_plan.facets = facets;
  {
    const OnHost<Buffer<GlobalId>> id(w.elements.id, w.exec.space);
    const GlobalId* const ids = id->data();
    copy_to(w.link_plan.tiles, numbers_where(threads, count, [ids](Index e) {
              return e == 0 || ids[e] / sweep_tile != ids[e - 1] / sweep_tile;
            }));
  }
  std::vector<Index>& tiles = w.link_plan.tiles;
  tiles.push_back(count);

  const auto weight_before = [&](Index element) {
    Index weight = element;  // an element weighs about as much as a link
    each_group([&](const auto& group, const auto&, const auto&) {
      weight += group.starts.data()[element] - group.begin;
    });
    return weight;
  };
  const std::int64_t weight = weight_before(count);
  for (int t = 0; t <= threads; ++t) {
    const auto share = static_cast<Index>(weight * t / threads);
    Index begin = 0;  // the first element that has as much before it
    for (Index end = count; begin < end;) {
      const Index middle = begin + (end - begin) / 2;
      if (weight_before(middle) < share)
        begin = middle + 1;
      else
        end = middle;
    }
    w.link_plan.begin.push_back(*(std::upper_bound(tiles.begin(), tiles.end(), begin) - 1));
  }
  w.link_plan.begin.back() = count;

  struct Reach {
    Index end = 0, length = 0;  ///< beyond the higher ends of a run's links, and of the longest
  };
  std::vector<Reach> reach(at(threads));
  for_each_task(threads, threads, [&](int t) {
    Reach own;
    const Index from = w.link_plan.begin[at(t)], to = w.link_plan.begin[at(t + 1)];
    each_group([&](const auto& group, const Buffer<Index>& low, const Buffer<Index>& high) {
      for (Index i = group.starts.data()[from]; i < group.starts.data()[to]; ++i) {
        own.end = std::max(own.end, high.data()[i] + 1);
        own.length = std::max(own.length, high.data()[i] - low.data()[i]);
      }
    });
    reach[at(t)] = own;
  });
  Index reached = 0;  // by links of elements before
  for (int t = 0; t < threads; ++t) {
    w.link_plan.first_private.push_back(std::max(w.link_plan.begin[at(t)], reached));
    reached = std::max(reached, reach[at(t)].end);
    w.link_plan.reach = std::max(w.link_plan.reach, reach[at(t)].length);
  }
  w.link_plan.deferred.resize(at(threads));
  if (w.exec.space != Space::host) list_rows(w, *a, *b);
}

template <class Law>
void list_laws(LinkSet<Law>& set) {
  std::vector<Law> laws;
  std::vector<Index> ends;
  for (const LinkGroup<Law>& group : set.groups) {
    laws.push_back(group.law);
    ends.push_back(group.end);
  }
  copy_to(set.on_device.laws, laws);
  copy_to(set.on_device.ends, ends);
  if constexpr (LinkSet<Law>::kind == LinkKind::concrete) {
    std::vector<ConcreteLinkOf<float>> rounded;
    for (const Law& law : laws) rounded.push_back(law.template as<float>());
    copy_to(set.on_device.in_single, rounded);
  }
}

struct NameActions {
  static constexpr const char* name = "dem.name_actions";
  View<const Index> actions;
  View<Entry> entries;

  BR_HD void operator()(Index k) const {
    entries[k] = 2 * actions[pair_of(entries[k])] + side_of(entries[k]);
  }
};

/// Pairs of ends, and their actions.
struct BarEnds {
  Buffer<Index> a, b, actions;

  /// @param leads  first facet of each edge, which alone have actions; null: each link has one
  /// @param first  action of link 0
  void add(const Buffer<Index>& of_a, const Buffer<Index>& of_b, const Buffer<Index>* leads,
           Index first, int threads) {
    const Index before = a.size();
    const Index more = leads == nullptr ? of_a.size() : std::max(leads->size() - 1, 0);
    for (Buffer<Index>* array : {&a, &b, &actions}) array->resize_unfilled(before + more);
    each_portion(threads, more, [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) {
        const Index link = leads != nullptr ? leads->data()[k] : k;
        a.data()[before + k] = of_a.data()[link];
        b.data()[before + k] = of_b.data()[link];
        actions.data()[before + k] = first + link;
      }
    });
  }
};

/// The actions that elements add up from `bar_actions`: of each pair of ends, of facets the first
/// of each edge. Swept ones are not among them.
void list_bars(World& w) {
  BarEnds ends;
  Index first = 0;
  w.each_set([&](const auto& set) {
    using Set = std::remove_reference_t<decltype(set)>;
    if constexpr (!Set::swept) {
      const OnHost<Buffer<Index>> a(set.a, w.exec.space), b(set.b, w.exec.space);
      if constexpr (Set::kind == LinkKind::ldpm) {
        const OnHost<Buffer<Index>> leads(set.edges.leads, w.exec.space);
        if (!facets_are_swept(w)) ends.add(*a, *b, &*leads, first, w.exec.threads);
      } else {
        ends.add(*a, *b, nullptr, first, w.exec.threads);
      }
      first += set.size();
    }
  });
  Buffer<Index> all_a(w.exec.space), all_b(w.exec.space), named(w.exec.space);
  copy_to(all_a, ends.a);
  copy_to(all_b, ends.b);
  copy_to(named, ends.actions);
  build_incidence(w.exec, all_a, all_b, w.elements.id, w.bar_incidence);
  if (first > std::numeric_limits<Index>::max() / 2)
    throw DeviceError(
        "the model has more than the 1,073,741,823 facets and links of bars whose ends fit a "
        "32-bit index; use coarser grains");
  for_each(w.exec, w.bar_incidence.entries.size(),
           NameActions{std::as_const(named).view(), w.bar_incidence.entries.view()});
  w.bar_actions.resize(first);
}

}  // namespace

void list_laws(World& w) {
  w.each_set([](auto& set) { list_laws(set); });
}

void derive(World& w) {
  const FillingThreads filling(w.exec.threads);
  list_laws(w);
  find_edges(w.ldpm);
  if (w.exec.space != Space::host) w.ldpm.edges.shares.resize(w.ldpm.size());
  list_bars(w);
  if (w.exec.space == Space::host) w.link_sums.resize(w.elements.size());
  w.critical.resize(w.elements.size());
  plan_sweep(w);
  w.tiles.forget();
  derive_contacts(w);
  w.graph.clear();
}

}  // namespace breccia::dem
