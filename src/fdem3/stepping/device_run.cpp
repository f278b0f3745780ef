// The step of fdem_shared/step.hpp by launches of a device: fdem_shared/device_run.hpp with the
// kernels of tetrahedra.

#include "fdem_shared/device_run.hpp"

#include <algorithm>
#include <utility>

#include "exec/for_each.hpp"
#include "fdem3/joints/insertion_kernels.hpp"
#include "fdem3/shape.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem3/stepping/step.hpp"
#include "fdem3/stepping/wide_kernels.hpp"

namespace breccia::fdem3 {
namespace {

using fdem_shared::Bounded;
using fdem_shared::BusyWhereDue;
using fdem_shared::emptying;
using fdem_shared::groups_of;
using fdem_shared::ListBusy;

/// Groups of threads that share the list of busy couples out: as many as run at a time, and more.
constexpr Index most_groups = 132 * 64;

}  // namespace

struct Launches {
  static constexpr Index lanes = 1;
  static constexpr int blocks_of_sums = 4;

  /// The host takes the rest of a step in which joints wait for room.
  static void go_on(World& w) { w.joints_wait = true; }

  template <Phase phase>
  static void joints(World& w, const ByClock<phase>& by) {
    JointForces kernel = joint_kernel(w);
    kernel.host_request = &by.clocks.now->host_request;
    launch(w, by(Bounded<JointForces, 4>{kernel}));
  }
  static void joints(World& w, const AtOnce& by) {
    RareArray<JointFailure>& records = w.joints.failure;
    bool waiting = std::exchange(w.joints_wait, false);
    if (!waiting) launch(w, by(Bounded<JointForces, 4>{joint_kernel(w)}));
    while (waiting || finds_short(w)) {
      records.make_room(spare_records(w.exec.space, records.size()));
      w.graph.clear();
      launch(w, by(WaitingJoints{joint_kernel(w)}));
      waiting = false;
    }
  }

  template <class By>
  static void pairs(World& w, const By& by) {
    if (w.joints.size() + w.couples.size() == 0)  // elements read corners ahead, which move
      return for_each(w.exec, 1, by(Fence{}));
    joints(w, by);
    const Index couples = w.couples.size();
    if (couples == 0) return;
    const CoupleForces all = couple_kernel(w);
    const View<Index> busy = w.busy.item.view(), count = w.busy.count.view();
    for_each_part(w.exec, part(couples, by(ListBusy<CoupleForces>{all, busy, count}), Parts<>{}));
    const Index groups = groups_of<CouplesWide>(couples, most_groups);
    for_each_part(w.exec,
                  part(groups * CouplesWide::width,
                       by(BusyWhereDue<CouplesWide>{{all}, busy, count, groups}), Parts<>{}));
  }
  template <class Visit>
  static void with_sums(World& w, const Visit& visit) {
    fdem3::with_sums(w, [&](const auto& kernel) { visit(emptying(w, kernel)); });
  }
  static BundleForces bundles(World& w) { return bundle_kernel(w); }

 private:
  template <class Kernel>
  static void launch(World& w, const Kernel& kernel) {
    for_each_part(w.exec, part(w.joints.size(), kernel, Parts<>{}));
  }
  /// Whether joints of the last launch wait for room.
  static bool finds_short(World& w) {
    if (w.joints.failure.room() >= w.joints.size()) return false;
    for_each(w.exec, 1, Fence{});  // the launch has done its work
    return w.joints.failure.is_short();
  }
};

void take_step_on_device(World& w) {
  take_step(DeviceRun{}, w);
}
void take_forces_on_device(World& w) {
  take_forces(DeviceRun{}, w);
}
Advanced advance_on_device(World& w, const StopAt& stop) {
  return fdem_shared::advance_mesh<Launches>(w, stop);
}

}  // namespace breccia::fdem3

template class breccia::fdem_shared::DeviceRunOf<
    breccia::fdem3::Launches, breccia::fdem3::StepwiseRun, breccia::fdem3::World>;
