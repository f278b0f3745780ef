// A step by loops on the host: over packs of triangles and joints, shared by threads.

#include "fdem_shared/host_run.hpp"

#include <algorithm>

#include "core/stepping.hpp"
#include "exec/for_each.hpp"
#include "fdem/shape.hpp"
#include "fdem/stepping/kernel_lanes.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"

namespace breccia::fdem {
namespace {

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

template <class Kernel>
bool move_range(const World& w, const Kernel& kernel, Index begin, Index end) {
  return run_packs(w.lanes, kernel, begin, end);
}

void HostRun::inner_joint_forces(World& w) const {
  if (w.joint_packs.empty()) return;
  const StageTime timed(w.exec, "joint_forces");
  with_arithmetic(w.exec.precision, [&w](auto number) {
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
  with_arithmetic(w.exec.precision, [&w](auto number) {
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
    for_each_run(w.exec, w.couples.size(), 512,
                 [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  });
}

void HostRun::pair_forces(World& w) const {
  joint_forces(w);
  couple_forces(w);
}

void HostRun::sum_forces(World& w) {
  const StageTime timed(w.exec, "triangle_forces");
  sum_up(w);
}

}  // namespace breccia::fdem

template struct breccia::fdem_shared::MovingRun<breccia::fdem::StepwiseRun, breccia::fdem::World>;
