// A step by loops on the host: over packs of tetrahedra and joints, shared by threads.

#include "fdem_shared/host_run.hpp"

#include "core/stepping.hpp"
#include "exec/for_each.hpp"
#include "fdem3/shape.hpp"
#include "fdem3/stepping/kernel_lanes.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem3/stepping/step.hpp"

template <>
inline constexpr bool breccia::on_host_alone<breccia::fdem3::CoupleForces> = true;

namespace breccia::fdem3 {

bool move_range(const World& w, const MoveTetrahedra& kernel, Index begin, Index end) {
  return run_packs(w.lanes, kernel, begin, end);
}

void HostRun::pair_forces(World& w) const {
  {
    const StageTime timed(w.exec, "joint_forces");
    const JointForces kernel = joint_kernel(w);
    constexpr Index grain = 512;
    for_each_run(w.exec, w.joints.size(), grain,
                 [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  }
  const StageTime timed(w.exec, "contact_forces");
  for_each(w.exec, w.couples.size(), couple_kernel(w));
}

void HostRun::sum_forces(World& w) {
  const StageTime timed(w.exec, "element_forces");
  sum_up(w);
}

}  // namespace breccia::fdem3

template struct breccia::fdem_shared::MovingRun<breccia::fdem3::StepwiseRun, breccia::fdem3::World>;
