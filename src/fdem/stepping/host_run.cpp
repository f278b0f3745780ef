// A step by loops on the host: over packs of triangles and joints, shared by threads.

#include <algorithm>
#include <atomic>

#include "core/stepping.hpp"
#include "exec/for_each.hpp"
#include "fdem/stepping/kernel_lanes.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"

namespace breccia::fdem {
namespace {

/// Calls visit(begin, end) for runs of triangles, in parts that the threads share: all of them if
/// there are no ranks.
template <class Visit>
void each_run(const World& w, const std::vector<ElementRun>& runs, const Visit& visit) {
  constexpr Index grain = 512;
  for_each_run(w.exec, w.triangles.size(), grain, [&](Index begin, Index end) {
    if (w.domain.single_rank()) return visit(begin, end);
    Domain::each_run_of(runs, begin, end, visit);
  });
}

/// Moves triangles. @returns whether an own one has used its margin up
bool move_here(World& w, const std::vector<ElementRun>& runs) {
  const MoveTriangles move = move_kernel(w);
  std::atomic<bool> beyond = false;
  each_run(w, runs, [&](Index begin, Index end) {
    if (run_packs(w.lanes, move, begin, end)) beyond.store(true, std::memory_order_relaxed);
  });
  return beyond;
}

/// Calls visit(begin, end) for runs of joints whose packs take(pack) chooses.
template <class Take, class Visit>
void each_run_of_packs(const World& w, const Take& take, const Visit& visit) {
  constexpr Index grain = 64 * joint_pack;
  for_each_run(w.exec, w.joints.size(), grain, [&](Index begin, Index end) {
    const auto taken = [&](Index i) {
      return take(w.joint_packs[static_cast<std::size_t>(i / joint_pack)]);
    };
    for (Index from = begin; from < end; from += joint_pack) {
      if (!taken(from)) continue;
      Index to = from;
      while (to < end && taken(to)) to += joint_pack;
      visit(from, std::min(to, end));
      from = to;
    }
  });
}

}  // namespace

void HostRun::move_boundary(World& w) const {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  w.margin_used = move_here(w, w.domain.boundary_runs);
}

void HostRun::move_interior(World& w) const {
  const StageTime timed(w.exec, "integration");
  if (!w.domain.single_rank() && move_here(w, w.domain.interior_runs)) w.margin_used = true;
  advance_time(w);
}

void HostRun::inner_joint_forces(World& w) const {
  if (w.joint_packs.empty()) return;
  const StageTime timed(w.exec, "joint_forces");
  with_number(w.exec.precision, [&w](auto number) {
    const auto kernel = joint_kernel<decltype(number)>(w);
    each_run_of_packs(
        w, [](JointPack pack) { return pack == JointPack::inner; },
        [&](Index begin, Index end) {
          while (begin < end) {
            const Index stop = run_whole(w.lanes, kernel, begin, end);
            for (; begin < stop && (begin + joint_pack <= stop || stop == end); begin += joint_pack)
              w.joint_packs[static_cast<std::size_t>(begin / joint_pack)] = JointPack::done;
            if (stop < end) begin += joint_pack;  // the pack where it stopped: in its turn
          }
        });
  });
}

void HostRun::joint_forces(World& w) const {
  const StageTime timed(w.exec, "joint_forces");
  with_number(w.exec.precision, [&w](auto number) {
    const auto kernel = joint_kernel<decltype(number)>(w);
    if (w.joint_packs.empty())
      return for_each_run(w.exec, w.joints.size(), 64 * joint_pack,
                          [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
    each_run_of_packs(
        w, [](JointPack pack) { return pack != JointPack::done; },
        [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  });
  std::replace(w.joint_packs.begin(), w.joint_packs.end(), JointPack::done, JointPack::inner);
}

void HostRun::couple_forces(World& w) const {
  const StageTime timed(w.exec, "contact_forces");
  with_number(w.exec.precision, [&](auto number) {
    const auto kernel = couple_kernel<decltype(number)>(w);
    for_each_run(w.exec, w.couples.size(), 64,
                 [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  });
}

void HostRun::pair_forces(World& w) const {
  joint_forces(w);
  couple_forces(w);
}

void HostRun::sum_forces(World& w) const {
  const StageTime timed(w.exec, "triangle_forces");
  with_number(w.exec.precision, [&](auto number) {
    const auto kernel = triangle_kernel<decltype(number)>(w);
    each_run(w, w.domain.runs,
             [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  });
}

}  // namespace breccia::fdem
