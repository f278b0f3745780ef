// A step by loops on the host, shared by threads.

#include "fdem_shared/host_run.hpp"

#include "core/stepping.hpp"
#include "fdem3/shape.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem3/stepping/step.hpp"

namespace breccia::fdem3 {

bool move_range(const World&, const MoveTetrahedra& kernel, Index begin, Index end) {
  bool beyond = false;
  for (Index t = begin; t < end; ++t) beyond = kernel(t) || beyond;
  return beyond;
}

void HostRun::pair_forces(World& w) const {
  {
    const StageTime timed(w.exec, "joint_forces");
    for_each(w.exec, w.joints.size(), joint_kernel(w));
  }
  const StageTime timed(w.exec, "contact_forces");
  for_each(w.exec, w.couples.size(), couple_kernel(w));
}

void HostRun::sum_forces(World& w) const {
  const StageTime timed(w.exec, "element_forces");
  const ElementForces kernel = element_kernel(w);
  fdem_shared::each_run(w, w.domain.runs, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t) kernel(t);
  });
}

}  // namespace breccia::fdem3

template struct breccia::fdem_shared::MovingRun<breccia::fdem3::StepwiseRun, breccia::fdem3::World>;
