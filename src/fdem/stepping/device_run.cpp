// The step of fdem_shared/step.hpp by launches of a device: fdem_shared/device_run.hpp with the
// kernels of triangles.

#include "fdem_shared/device_run.hpp"

#include <algorithm>
#include <type_traits>

#include "exec/for_each.hpp"
#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/shape.hpp"
#include "fdem/stepping/busy_pairs.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem/stepping/step.hpp"
#include "fdem/stepping/wide_couples.hpp"
#include "fdem/stepping/wide_joints.hpp"
#include "fdem/stepping/wide_kernels.hpp"
#include "fdem_shared/kept_lists.hpp"

namespace breccia::fdem {
namespace {

using fdem_shared::Bounded;
using fdem_shared::BusyWide;
using fdem_shared::CountLists;
using fdem_shared::groups_for;
using fdem_shared::groups_of;
using fdem_shared::KeptList;
using fdem_shared::ListBusy;
using fdem_shared::NotListed;

/// From so many joints on they have a launch of their own: they take longer then than a launch
/// more, and can have the registers that suit them.
constexpr Index fewest_joints_apart = 250'000;

/// Books the slip of a whole joint in a function of its own, which reads it anew: numbers that are
/// kept for it would fill the registers of all others.
template <class Number>
BR_COLD void book_slip(const JointForces<Number>* joints, double span, Index i) {
  stay_in_place(joints);
  joints->template book_slips<double>(i, 1, span);
}
/// Joints in a launch of their own, in the fewest registers that they fit.
template <class Number>
struct JointsApart : JointForces<Number> {
  static constexpr int least_blocks = 8;
  using Loaded = typename JointForces<Number>::template Loaded<double>;
  BR_HD bool update_at(const StepTime& now, Index i, const Loaded& loaded) const {
    return this->update_by(i, loaded, [&, this] { book_slip<Number>(this, now.last_dt, i); });
  }
};

template <int blocks, class Kernel>
Bounded<Kernel, blocks> bounded(const Kernel& kernel) {
  return {kernel};
}

/// Groups of threads that share a list out: as many as run at a time, and more.
constexpr Index most_groups = 132 * 128;

/// In registers of which so many blocks fit a multiprocessor at once.
constexpr int blocks_of_pairs = 4;

/// Listed items by groups of threads.
template <class Wide>
BusyWide<Wide> listed(const Wide& wide, const KeptList& list, Index groups) {
  return {wide, list.item.view(), list.count.view(), groups};
}
/// Listed couples and damaged joints by several threads each, all others by one.
template <class Number, class By>
void launch_kept_pairs(World& w, const By& by) {
  using WideJoints = JointsWide<Number>;
  using WideCouples = CouplesWide<StoredAs<Number>, true>;
  const Index joints = w.joints.size(), couples = w.couples.size();
  const JointForces<Number> joint = joint_kernel<Number>(w);
  const CoupleForces<StoredAs<Number>> couple = couple_kernel<StoredAs<Number>>(w);
  const Index couple_groups = groups_for<WideCouples>(w.busy, couples, most_groups),
              joint_groups = groups_for<WideJoints>(w.busy_joints, joints, most_groups);
  const auto launch = [&](const auto& other_joints) {  // first what takes longest
    const auto wide_joints =
        bounded<blocks_of_pairs>(listed(WideJoints{joint}, w.busy_joints, joint_groups));
    for_each_part(
        w.exec,
        part(joint_groups * WideJoints::width, by(wide_joints),
             part(couple_groups * WideCouples::width,
                  by(listed(WideCouples{couple}, w.busy, couple_groups)),
                  part(couples, by(NotListed(couple, ActingCouple(w), w.busy)), other_joints))));
  };
  const auto others = [&](const auto& kernel) {
    return part(joints, by(NotListed(kernel, SoftenedJoint(w), w.busy_joints)), Parts<>{});
  };
  if (joints < fewest_joints_apart) return launch(others(bounded<blocks_of_pairs>(joint)));
  for_each_part(w.exec, others(JointsApart<Number>{joint}));
  launch(Parts<>{});
}

/// Damaged joints and busy couples.
template <class Number, bool any_couple, class By>
void launch_busy(World& w, const By& by) {
  using Joints = JointsWide<Number>;
  using Couples = CouplesWide<StoredAs<Number>, any_couple>;
  const Index joints = w.joints.size(), couples = w.couples.size();
  const Index groups = groups_of<Couples>(couples, most_groups),
              joint_groups = groups_of<Joints>(joints, most_groups);
  const auto wide_joints = bounded<blocks_of_pairs>(
      listed(Joints{joint_kernel<Number>(w)}, w.busy_joints, joint_groups));
  const auto wide_couples = listed(Couples{couple_kernel<StoredAs<Number>>(w)}, w.busy, groups);
  // Joints first: one takes longest. Both in registers of which four blocks fit.
  for_each_part(w.exec, part(joint_groups * Joints::width, by(wide_joints),
                             part(groups * Couples::width, by(wide_couples), Parts<>{})));
}

/// First what takes little, and lists of couples that may meet and of damaged joints; then these.
template <class Number, bool any_couple, class By>
void launch_busy_pairs(World& w, const By& by) {
  using Couple = BeginningCouples<StoredAs<Number>>;
  const Index joints = w.joints.size(), couples = w.couples.size();
  const Couple couple{couple_kernel<StoredAs<Number>>(w)};
  const JointForces<Number> joint = joint_kernel<Number>(w);
  const auto list_couples = by(ListBusy<Couple>{couple, w.busy.item.view(), w.busy.count.view()});
  const auto list_joints = [&](const auto& kernel) {
    return by(ListBusy<std::remove_cvref_t<decltype(kernel)>>{kernel, w.busy_joints.item.view(),
                                                              w.busy_joints.count.view()});
  };
  if (joints < fewest_joints_apart) {
    for_each_part(w.exec,
                  part(couples, list_couples,
                       part(joints, list_joints(bounded<blocks_of_pairs>(joint)), Parts<>{})));
  } else {
    for_each_part(w.exec, part(joints, list_joints(JointsApart<Number>{joint}), Parts<>{}));
    for_each_part(w.exec, part(couples, list_couples, Parts<>{}));
  }
  launch_busy<Number, any_couple>(w, by);
}

/// Joints and couples.
template <class Number, class By>
void launch_pairs(World& w, const By& by) {
  const Index joints = w.joints.size(), couples = w.couples.size();
  if (joints + couples == 0)  // triangles read corners ahead, which the move writes
    return for_each(w.exec, 1, by(Fence{}));
  if (keeps_lists(w)) return launch_kept_pairs<Number>(w, by);
  if (w.given->conservative || w.given->rebound.loses())
    launch_busy_pairs<Number, true>(w, by);
  else
    launch_busy_pairs<Number, false>(w, by);
}

struct Launches {
  static constexpr Index lanes = BundlesWide::width;
  static constexpr int blocks_of_sums = 0;

  template <class By>
  static void pairs(World& w, const By& by) {
    with_arithmetic(w.exec.precision, [&](auto number) { launch_pairs<decltype(number)>(w, by); });
  }
  template <class Visit>
  static void with_sums(World& w, const Visit& visit) {
    fdem::with_sums(w, [&](const auto& kernel) {
      using Sums = std::remove_cvref_t<decltype(kernel)>;
      visit(CountLists<Sums>{kernel, w.busy.count.data(), w.busy_joints.count.data()});
    });
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
