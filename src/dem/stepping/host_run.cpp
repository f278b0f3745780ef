// A step by loops on the host: over packs of elements and links, shared by threads.

#include <algorithm>
#include <memory>

#include "dem/ranks.hpp"
#include "dem/stepping/launches.hpp"
#include "dem/stepping/step.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// Moves elements of this rank. @returns whether one of them has used its margin up
bool move_here(const World& w, const std::vector<ElementRun>& runs, const MoveElements& move) {
  constexpr Index grain = 512;
  const Index count = w.elements.size();
  std::vector<std::uint8_t> beyond(static_cast<std::size_t>((count + grain - 1) / grain), 0);
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    each_owned(w.domain, runs, begin, end, [&](Index from, Index to) {
      if (run_packs(w.lanes, move, from, to)) beyond[static_cast<std::size_t>(begin / grain)] = 1;
    });
  });
  return std::find(beyond.begin(), beyond.end(), 1) != beyond.end();
}

/// A kernel for all links of a group, on the host.
template <class Law, class Kernel>
void run_group(const World& w, const LinkGroup<Law>& group, const Kernel& kernel) {
  const Index count = group.end - group.begin;
  constexpr Index grain = 512;
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    run_packs(w.lanes, kernel, group.begin + begin, group.begin + end);
  });
}

/// Asks the memory for what the links [from, to) keep: too many arrays for the processor to
/// foresee.
template <class Number>
void fetch(const ConcreteLinkForces<Number>& links, Index from, Index to) {
  const auto &shear = links.shear.items, &moment = links.moment.items;
  const Index plane = links.shear.stride;
  for (Index i = from; i < to; i += 8) {
    __builtin_prefetch(links.length.data + i);
    __builtin_prefetch(links.stiffness.data + i);
    __builtin_prefetch(links.area.data + i);
    if (sizeof(Number) < sizeof(double) && i % 16 != 0) continue;  // of a cache line that is asked
    __builtin_prefetch(links.opening.data + i, 1);
    for (int c = 0; c < 3; ++c) {
      __builtin_prefetch(shear.data + c * plane + i, 1);
      __builtin_prefetch(moment.data + c * plane + i, 1);
    }
  }
}

/// Actions of links of a group that filled up the last pack of a tile; the next tile adds them.
template <class Number>
struct Ahead {
  static constexpr Index room = 15;  // of the widest pack, its first link apart
  Index begin = 0, end = 0;          ///< links
  PairForceOf<StoredAs<Number>> actions[room];
};

/// Forces of links [begin, end) and their sums, in portions whose actions stay in the nearest
/// cache. Links are computed by whole packs, up to `last`, so that groups may have few links in a
/// tile; they are added in the order of tiles.
template <class Number>
void add_links(Lanes lanes, ConcreteLinkForces<Number> links, Index begin, Index end, Index last,
               Ahead<Number>& ahead, const AddLinks& add) {
  constexpr Index portion = 64;
  const Index width = pack_width<ConcreteLinkForces<Number>>(lanes);
  alignas(64) PairForceOf<StoredAs<Number>> actions[portion + Ahead<Number>::room];
  links.actions.data = actions;
  links.actions.size = portion + Ahead<Number>::room;
  for (Index from = begin; from < end;) {
    const Index to = std::min(from / portion * portion + portion, end);  // whole packs, aligned
    const Index filled = std::min((to + width - 1) / width * width, last);
    links.first_action = -from;
    fetch(links, to, std::min(to + portion, end));
    Index next = from;  // the first that is not computed
    if (ahead.end > from) {
      next = ahead.end;
      std::copy(ahead.actions + (from - ahead.begin), ahead.actions + (ahead.end - ahead.begin),
                actions);
    }
    if (next < filled) run_packs(lanes, links, next, filled);
    run_adding(lanes, add, links, from, to, actions);
    ahead.begin = to;
    ahead.end = std::max(filled, next);
    std::copy(actions + (to - from), actions + (ahead.end - from), ahead.actions);
    from = to;
  }
}

/// Forces of the edges of facets [begin, end), in portions whose shares stay in a near cache.
/// @param then  called with the edges of each portion
template <class Then>
void facet_forces(Lanes lanes, LdpmFacetForces facets, LdpmEdgeForces edges, Index begin, Index end,
                  const Then& then) {
  constexpr Index portion = 2048;
  alignas(64) LdpmShare shares[portion];
  facets.shares.data = shares;
  facets.shares.size = portion;
  edges.shares = facets.shares;
  for (Index from = begin; from < end;) {
    const Index first = facets.edges[from];
    const Index last =
        end - from <= portion ? facets.edges[end - 1] + 1 : facets.edges[from + portion];
    const Index to = facets.leads[last];
    facets.first_share = edges.first_share = -from;
    run_packs(lanes, facets, from, to);
    run_packs(lanes, edges, first, last);
    then(first, last);
    from = to;
  }
}

/// Forces of all edges of a group.
void run_edges(World& w, const LinkGroup<LdpmFacet>& group, const LdpmFacetForces& facets) {
  if (group.begin == group.end) return;
  constexpr Index grain = 256;
  const LdpmEdgeForces edges = edge_kernel(w);
  const Index first = facets.edges[group.begin];
  const Index count = facets.edges[group.end - 1] + 1 - first;
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    facet_forces(w.lanes, facets, edges, facets.leads[first + begin], facets.leads[first + end],
                 [](Index, Index) {});
  });
}

template <class Number>
void link_forces_and_sums(World& w) {
  std::vector<ConcreteLinkForces<Number>> kernels;
  for (const auto& group : w.concrete.groups)
    kernels.push_back(link_kernel<Number>(w, w.concrete, group.law, 0));
  std::vector<LdpmFacetForces> of_facets;
  if (w.link_plan.facets)
    for (const auto& group : w.ldpm.groups)
      of_facets.push_back(link_kernel<double>(w, w.ldpm, group.law, 0));
  const LdpmEdgeForces edges = edge_kernel(w);
  const GatherForces gather = gather_kernel(w);
  LinkPlan& link_plan = w.link_plan;
  const auto threads = static_cast<int>(link_plan.first_private.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    const KernelScope scope;
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      AddLinks add{
          gather.sums,      link_plan.first_private[run], link_plan.begin[run + 1], link_plan.reach,
          gather.evaluates, link_plan.deferred[run]};
      add.deferred.clear();
      const auto ahead = std::make_unique_for_overwrite<Ahead<Number>[]>(kernels.size());
      auto tile =
          std::lower_bound(link_plan.tiles.begin(), link_plan.tiles.end(), link_plan.begin[run]);
      for (; *tile < link_plan.begin[run + 1]; ++tile) {
        const Index from = *tile, to = *(tile + 1);
        for (std::size_t g = 0; g < kernels.size(); ++g) {
          const Index* const starts = w.concrete.groups[g].starts.data();
          add_links(w.lanes, kernels[g], starts[from], starts[to], starts[link_plan.begin[run + 1]],
                    ahead[g], add);
        }
        for (std::size_t g = 0; g < of_facets.size(); ++g) {
          const Index* const starts = w.ldpm.groups[g].starts.data();
          facet_forces(w.lanes, of_facets[g], edges, starts[from], starts[to],
                       [&](Index first, Index last) {
                         run_adding(w.lanes, add, edges, first, last,
                                    edges.actions.data + edges.first_action);
                       });
        }
        run_packs(w.lanes, gather, std::max(from, link_plan.first_private[run]), to);
      }
    }
    // The end of the loop above is a barrier: every link is done.
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      const Index begin = link_plan.begin[run];
      const Index end = std::min(link_plan.first_private[run], link_plan.begin[run + 1]);
      if (begin == end) continue;
      for (std::size_t before = 0; before <= run; ++before)
        for (const DeferredForce& p : link_plan.deferred[before])
          if (p.b >= begin && p.b < end) gather.add_as_b(p.b, p.action);
      run_packs(w.lanes, gather, begin, end);
    }
  }
}

}  // namespace

void defer(const AddLinks& add, const PairForce& action, Index b) {
  add.deferred.push_back({action, b});
}
void defer(const AddLinks& add, const PairForceOf<float>& action, Index b) {
  PairForce same{};
  std::copy_n(action.numbers, 9, same.numbers);
  std::copy_n(action.stiffness, 9, same.stiffness);
  defer(add, same, b);
}

void HostRun::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  w.margin_used = move_here(w, w.domain.boundary_runs, move_kernel(w));
}

void HostRun::move_interior(World& w) const {
  const StageTime timed(w.exec, "integration");
  if (!w.domain.single_rank())
    w.margin_used |= move_here(w, w.domain.interior_runs, move_kernel(w));
  move_walls(w);
}

void HostRun::pair_forces(World& w) const {
  {
    const StageTime timed(w.exec, "bar_forces");
    each_bar_set(w, [&](auto& set, Index first_action) {
      for (const auto& group : set.groups)
        if constexpr (std::remove_reference_t<decltype(set)>::kind != LinkKind::ldpm)
          run_group(w, group, link_kernel<double>(w, set, group.law, first_action));
        else if (!w.link_plan.facets)
          run_edges(w, group, link_kernel<double>(w, set, group.law, first_action));
    });
  }
  const StageTime timed(w.exec, "contact_forces");
  for_each(w.exec, w.contacts.size(), contact_kernel(w));
}

void HostRun::sum_forces(World& w) const {
  const StageTime timed(w.exec, "link_forces");
  with_arithmetic(w.exec.precision,
                  [&w](auto number) { link_forces_and_sums<decltype(number)>(w); });
}

}  // namespace breccia::dem
