// The step of fdem_shared/step.hpp by launches of a device: fdem_shared/device_run.hpp with the
// kernels of triangles.

#include "fdem_shared/device_run.hpp"

#include <algorithm>

#include "exec/for_each.hpp"
#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/shape.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"
#include "fdem/stepping/wide_kernels.hpp"

namespace breccia::fdem {
namespace {

using fdem_shared::Bounded;
using fdem_shared::BusyWide;
using fdem_shared::emptying;
using fdem_shared::ListBusy;

/// From so many joints on they have a launch of their own: they take longer then than a launch
/// more, and can have the registers that suit them.
constexpr Index fewest_joints_apart = 250'000;

/// From so many couples on those with work to do are listed first: a launch more. Tests in
/// Space::shadow see both ways.
Index fewest_couples_listed(Space space) {
  return space == Space::shadow ? 500 : 8'000;
}
/// Groups of threads that share the list out: as many as run at a time, and more.
constexpr Index most_groups = 132 * 128;

/// Joints and couples.
template <class Number, class By>
void launch_pairs(World& w, const By& by) {
  const Index joints = w.joints.size(), couples = w.couples.size();
  const CoupleForces<Number> all = couple_kernel<Number>(w);
  const CouplesWide<Number> wide{all};
  if (joints + couples == 0)  // triangles read corners ahead, which the move writes
    return for_each(w.exec, 1, by(Fence{}));
  const auto with_joints = [&](Index count, const auto& kernel) {
    if (joints < fewest_joints_apart)
      return for_each_part(
          w.exec, part(count, kernel,
                       part(joints, by(Bounded<JointForces<Number>, 4>{joint_kernel<Number>(w)}),
                            Parts<>{})));
    for_each_part(w.exec, part(joints, by(Bounded<JointForces<Number>, 8>{joint_kernel<Number>(w)}),
                               Parts<>{}));
    for_each_part(w.exec, part(count, kernel, Parts<>{}));
  };
  if (couples < fewest_couples_listed(w.exec.space))
    return with_joints(couples * CouplesWide<Number>::width, by(wide));
  with_joints(couples,
              by(ListBusy<CoupleForces<Number>>{all, w.busy.couple.view(), w.busy.count.view()}));
  const Index groups = std::min(couples, most_groups);
  for_each_part(w.exec,
                part(groups * CouplesWide<Number>::width,
                     by(BusyWide<CouplesWide<Number>>{wide, std::as_const(w.busy.couple).view(),
                                                      std::as_const(w.busy.count).view(), groups}),
                     Parts<>{}));
}

struct Launches {
  static constexpr Index lanes = BundlesWide::width;
  static constexpr int blocks_of_sums = 0;

  template <class By>
  static void pairs(World& w, const By& by) {
    with_number(w.exec.precision, [&](auto number) { launch_pairs<decltype(number)>(w, by); });
  }
  template <class Visit>
  static void with_sums(World& w, const Visit& visit) {
    with_number(w.exec.precision,
                [&](auto number) { visit(emptying(w, triangle_kernel<decltype(number)>(w))); });
  }
  static BundlesWide bundles(World& w) { return {bundle_kernel(w)}; }
};
using DeviceRun = fdem_shared::DeviceRunOf<Launches, StepwiseRun, World>;

}  // namespace

void take_step_on_device(World& w) {
  take_step(DeviceRun{}, w);
}
void take_forces_on_device(World& w) {
  take_forces(DeviceRun{}, w);
}
Advanced advance_on_device(World& w, const StopAt& stop) {
  return fdem_shared::advance_mesh<Launches>(w, stop);
}

}  // namespace breccia::fdem
