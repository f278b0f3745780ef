#pragma once
// Loops of a step of the FDEM on the host: over elements of this rank, shared by threads. Made for
// each method in its stepping/host_run.cpp.

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

/// Moves elements by the method's move_range(w, kernel, begin, end), which tells whether one of
/// them has used its margin up. @returns whether one has
template <class World>
bool move_here(World& w, const std::vector<ElementRun>& runs) {
  const auto kernel = world_move(w);
  std::atomic<bool> beyond = false;
  each_run(w, runs, [&](Index begin, Index end) {
    if (move_range(w, kernel, begin, end)) beyond.store(true, std::memory_order_relaxed);
  });
  return beyond;
}

template <class Base, class World>
void MovingRun<Base, World>::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  w.margin_used = move_here(w, w.domain.boundary_runs);
}

template <class Base, class World>
void MovingRun<Base, World>::move_interior(World& w) const {
  const StageTime timed(w.exec, "integration");
  if (!w.domain.single_rank() && move_here(w, w.domain.interior_runs)) w.margin_used = true;
  advance_time(w);
}

}  // namespace breccia::fdem_shared
