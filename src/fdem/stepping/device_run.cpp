// The step of fdem_shared/step.hpp by launches of a device: fdem_shared/device_run.hpp with the
// kernels of triangles.

#include "fdem_shared/device_run.hpp"

#include <algorithm>
#include <type_traits>

#include "exec/for_each.hpp"
#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/shape.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"
#include "fdem/stepping/wide_couples.hpp"
#include "fdem/stepping/wide_joints.hpp"
#include "fdem/stepping/wide_kernels.hpp"

namespace breccia::fdem {
namespace {

using fdem_shared::Bounded;
using fdem_shared::BusyWide;
using fdem_shared::emptying;
using fdem_shared::groups_of;
using fdem_shared::ListBusy;

/// From so many joints on they have a launch of their own: they take longer then than a launch
/// more, and can have the registers that suit them.
constexpr Index fewest_joints_apart = 250'000;

template <int blocks, class Kernel>
Bounded<Kernel, blocks> bounded(const Kernel& kernel) {
  return {kernel};
}

/// Whether couples with work to do are listed first, and damaged joints: a launch more. It pays
/// from so many couples on, or from fewer where joints may be damaged, which take long. Tests in
/// Space::shadow see both ways.
bool lists_busy(const World& w) {
  const Index couples = w.couples.size();
  return couples >= (w.joints.size() > 0 || w.exec.space == Space::shadow ? 500 : 8'000);
}
/// Groups of threads that share a list out: as many as run at a time, and more.
constexpr Index most_groups = 132 * 128;

/// Joints and couples by one thread or group of threads each.
template <class Number, class By>
void launch_all_pairs(World& w, const By& by) {
  const Index joints = w.joints.size(), couples = w.couples.size();
  const JointForces<Number> joint = joint_kernel<Number>(w);
  using Couples = CouplesWide<Number, true>;
  const Couples wide{couple_kernel<Number>(w)};
  const Index threads = couples * Couples::width;
  if (joints < fewest_joints_apart)
    return for_each_part(w.exec,
                         part(threads, by(wide), part(joints, by(bounded<4>(joint)), Parts<>{})));
  for_each_part(w.exec, part(joints, by(bounded<8>(joint)), Parts<>{}));
  for_each_part(w.exec, part(threads, by(wide), Parts<>{}));
}

/// Damaged joints and busy couples.
template <class Number, bool any_couple, class By>
void launch_busy(World& w, const By& by) {
  using Joints = JointsWide<Number>;
  using Couples = CouplesWide<Number, any_couple>;
  const Index joints = w.joints.size(), couples = w.couples.size();
  const Index groups = groups_of<Couples>(couples, most_groups),
              joint_groups = groups_of<Joints>(joints, most_groups);
  const auto wide_joints = by(BusyWide<Joints>{{joint_kernel<Number>(w)},
                                               w.busy_joints.item.view(),
                                               w.busy_joints.count.view(),
                                               joint_groups});
  const auto wide_couples = by(BusyWide<Couples>{
      {couple_kernel<Number>(w)}, w.busy.item.view(), w.busy.count.view(), groups});
  // Joints first: one takes longest. Both in registers of which four blocks fit.
  for_each_part(w.exec, part(joint_groups * Joints::width, bounded<4>(wide_joints),
                             part(groups * Couples::width, wide_couples, Parts<>{})));
}

/// First what takes little, and lists of couples that may meet and of damaged joints; then these.
template <class Number, class By>
void launch_busy_pairs(World& w, const By& by) {
  using Couple = BeginningCouples<Number>;
  const Index joints = w.joints.size(), couples = w.couples.size();
  const Couple couple{couple_kernel<Number>(w)};
  const JointForces<Number> joint = joint_kernel<Number>(w);
  const auto list_couples = by(ListBusy<Couple>{couple, w.busy.item.view(), w.busy.count.view()});
  const auto list_joints = [&](const auto& kernel) {
    return by(ListBusy<std::remove_cvref_t<decltype(kernel)>>{kernel, w.busy_joints.item.view(),
                                                              w.busy_joints.count.view()});
  };
  if (joints < fewest_joints_apart) {
    for_each_part(w.exec, part(couples, list_couples,
                               part(joints, list_joints(bounded<4>(joint)), Parts<>{})));
  } else {
    for_each_part(w.exec, part(joints, list_joints(bounded<8>(joint)), Parts<>{}));
    for_each_part(w.exec, part(couples, list_couples, Parts<>{}));
  }
  if (couple.conservative || couple.rebound.loses())
    launch_busy<Number, true>(w, by);
  else
    launch_busy<Number, false>(w, by);
}

/// Joints and couples.
template <class Number, class By>
void launch_pairs(World& w, const By& by) {
  const Index joints = w.joints.size(), couples = w.couples.size();
  if (joints + couples == 0)  // triangles read corners ahead, which the move writes
    return for_each(w.exec, 1, by(Fence{}));
  if (lists_busy(w))
    launch_busy_pairs<Number>(w, by);
  else
    launch_all_pairs<Number>(w, by);
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
