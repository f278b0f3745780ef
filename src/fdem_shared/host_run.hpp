#pragma once
// Loops of a step of the FDEM on the host: over elements of this rank, shared by threads. Made for
// each method in its stepping/host_run.cpp.

#include <algorithm>
#include <atomic>

#include "exec/for_each.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/stepping.hpp"
#include "fdem_shared/stepwise_run.hpp"

namespace breccia::fdem_shared {

/// Calls visit(begin, end) for runs of elements, in parts that the threads share: all of them if
/// there are no ranks.
template <class World, class Visit>
void each_run(const World& w, const std::vector<ElementRun>& runs, const Visit& visit) {
  constexpr Index grain = 512;
  for_each_run(w.exec, ShapeOf<World>::elements(w).size(), grain, [&](Index begin, Index end) {
    if (w.domain.single_rank()) return visit(begin, end);
    Domain::each_run_of(runs, begin, end, visit);
  });
}

/// Calls visit(begin, end, apart) for stretches of elements that are told apart or not.
template <class World, class Visit>
void each_stretch(const World& w, Index begin, Index end, const Visit& visit) {
  const View<const std::uint8_t> marked = w.summed_apart.marked.view();
  const auto is_apart = [&](Index t) { return marked[t / apart_group] != 0; };
  while (begin < end) {
    const bool apart = is_apart(begin);
    Index to = begin;
    do to = (to / apart_group + 1) * apart_group;
    while (to < end && is_apart(to) == apart);
    to = std::min(to, end);
    visit(begin, to, apart);
    begin = to;
  }
}

/// Moves elements by the method's move_range(w, kernel, begin, end), which tells whether one of
/// them has used its margin up. @returns whether one has
/// @param sums_due  whether the forces of those that are not summed apart are summed up, too
template <class World>
bool move_here(World& w, const std::vector<ElementRun>& runs, bool sums_due) {
  std::atomic<bool> beyond = false;
  const auto move_by = [&](const auto& kernel, Index begin, Index end) {
    if (move_range(w, kernel, begin, end)) beyond.store(true, std::memory_order_relaxed);
  };
  const auto alone = world_move(w);
  if constexpr (moves_at_once<World>)
    if (sums_due) {
      with_sums(w, [&](const auto& sums) {
        const auto both = sum_and_move(w, sums);
        each_run(w, runs, [&](Index begin, Index end) {
          each_stretch(w, begin, end, [&](Index from, Index to, bool apart) {
            if (apart)
              move_by(alone, from, to);
            else
              move_by(both, from, to);
          });
        });
      });
      return beyond;
    }
  each_run(w, runs, [&](Index begin, Index end) { move_by(alone, begin, end); });
  return beyond;
}

template <class Base, class World>
void MovingRun<Base, World>::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  w.margin_used = move_here(w, w.domain.boundary_runs, sums_due);
}

template <class Base, class World>
void MovingRun<Base, World>::move_interior(World& w) {
  const StageTime timed(w.exec, "integration");
  if (!w.domain.single_rank() && move_here(w, w.domain.interior_runs, sums_due))
    w.margin_used = true;
  sums_due = false;
  advance_time(w);
}

/// Sums of all elements; where another step follows, of those that are summed apart.
template <class Base, class World>
void MovingRun<Base, World>::sum_up(World& w) {
  if constexpr (moves_at_once<World>) sums_due = goes_on(w) && moves_most_at_once(w);
  with_sums(w, [&](const auto& sums) {
    each_run(w, w.domain.runs, [&](Index begin, Index end) {
      if constexpr (moves_at_once<World>)
        if (sums_due)
          return each_stretch(w, begin, end, [&](Index from, Index to, bool apart) {
            if (apart) run_packs(w.lanes, sums, from, to);
          });
      run_packs(w.lanes, sums, begin, end);
    });
  });
}

}  // namespace breccia::fdem_shared
