#pragma once
// Joints as a device evaluates those with more to do than others: four threads take one. Forces
// are those of JointForces, to the bit.

#include "exec/early.hpp"
#include "exec/lockstep.hpp"
#include "fdem/joints/joint_kernels.hpp"

namespace breccia::fdem {

/// JointForces by four threads a joint, of which three take an integration point each: a joint that
/// is whole and slips under pressure, or has softened and goes on softening. Whatever comes once in
/// its life one thread does by itself.
template <class Number>
struct JointsWide {
  static constexpr const char* name = "fdem.joints";
  static constexpr Index width = 4;
  using Joint = JointForces<Number>;
  Joint all;

  BR_HD void set(const StepTime& now) { all.set(now); }
  BR_HD Index items() const { return all.stage.size; }

  struct Loaded {
    typename Joint::template Loaded<double> joint;
    BondState<double> point;  ///< the own one
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index j = joint_of(i);
    all.load_early(j, loaded.joint);
    loaded.point = read_record_now(all.points[j].point + point_of(i));
  }
  BR_HD void load_late(Index i, Loaded& loaded) const { all.load_late(joint_of(i), loaded.joint); }
  BR_HD void update(Index i, const Loaded& loaded) const {
    if (at(all.dt, i, loaded) == Left::to_one) all.slow(i / width);
  }
  BR_HD void update_at(const StepTime& now, Index i, const Loaded& loaded) const {
    if (at(now.last_dt, i, loaded) == Left::to_one) run_slow(&all, now, i / width);
  }

 private:
  enum class Left { nothing, to_one };  ///< of a thread's work: the joint, by itself

  /// Threads beyond the last joint look at it, too, and leave it alone.
  BR_HD Index joint_of(Index i) const {
    const Index last = items() - 1;
    return i / width < last ? i / width : last;
  }
  BR_HD static int point_of(Index i) {
    const auto lane = static_cast<int>(i % width);
    return lane < 3 ? lane : 2;  // two threads have the last one
  }
  /// Opening and slip of a point.
  BR_HD static Vec2 point(const JointOpening<double>& o, int q, const double (&offset)[2]) {
    const double open = q == 0 ? o.open[0] : q == 1 ? o.open[1] : o.open[2];
    const double slide = q == 0 ? o.slide[0] : q == 1 ? o.slide[1] : o.slide[2];
    return {open + offset[0], slide + offset[1]};
  }

  BR_HD Left at(double dt, Index i, const Loaded& loaded) const {
    const Index j = joint_of(i);
    const bool is_item = i / width < items(), leads = i % width == 0;
    const int q = point_of(i);
    const LaneGroup<width> group;
    const auto& joint = loaded.joint;
    const double h = joint.length, share = joint.strength;
    const JointOpening<double> o = Joint::opening(joint, 0.0);
    const auto elastic = all.elastic_law(j, joint);
    const JointBond bond = read_record(all.bonds, joint.law.at);
    const bool acts = is_item && o.size > 1e-12 * h;
    const bool whole = acts && joint.stage == JointStage::whole,
               softened = acts && joint.stage == JointStage::softened;

    const Vec2 now = point(o, q, elastic.offset);
    BondTraction<double> own{};
    BondState<double> state = loaded.point;
    bool leaves = false, slips = false;
    WholeOf<typename Joint::Computed> forces{};
    if constexpr (Joint::in_single) {  // of all points, by each thread
      if (whole) forces = all.whole_in_run(j, joint);
      leaves = forces.beyond;
      slips = forces.drags;
    } else if (whole) {
      own = elastic.at(now.x, now.y, leaves, slips);
    }
    if (softened) own = response(bond, share, h, now.x, now.y, state);
    BondTraction<double> t[3];
    for (int p = 0; p < 3; ++p) t[p] = {group.from(p, own.normal), group.from(p, own.shear)};
    const auto points = [&](bool flag) { return group.ballot(flag) & 7U; };
    const unsigned leaving = points(leaves), slipping = points(slips),
                   damaged = points(state.damage > 0.0), failed = points(state.damage >= 1.0),
                   failed_with_rock = points(failure_of(loaded.point) != Failure::none),
                   half_soft = points(softened && bond.by_rock() && is_half_soft(state));

    forces.beyond = leaving != 0;
    bool stays = false;
    if (whole) {
      if constexpr (!Joint::in_single) all.add_points(joint, elastic, o, t, forces);
      stays = !forces.beyond;
    }
    if (softened) {
      const bool by_rock = bond.by_rock() && (failed_with_rock & 2U) == 0 && half_soft == 0;
      stays = damaged != 0 && (failed & (failed - 1)) == 0 &&
              !(by_rock && all.rock_failure_at(j, bond, o, t) != Failure::none);
    }

    const bool books = whole && stays && slipping != 0,
               rubs = softened && stays && bond.residual > 0.0;
    double sum = 0.0;
    if (group.any_of_warp(books || rubs)) {
      const Vec2 last = point(Joint::opening(joint, dt), q, elastic.offset);
      double part = 0.0;
      if (books)
        part =
            weight_of(q) * spent_by_pressure<double>(elastic.slope, elastic.cohesion, bond.friction,
                                                     {last.x, now.x}, {last.y, now.y});
      if (rubs) part = Joint::rubbed_at(q, bond, share, h, last, now, loaded.point, state);
      for (int p = 0; p < 3; ++p) sum += group.from(p, part);
    }
    if (!stays) return is_item && leads ? Left::to_one : Left::nothing;
    if (softened && i % width < 3) all.points[j].point[q] = state;
    if (!leads) return Left::nothing;
    if (whole) {
      store_four<typename Joint::Stores>(all.force, j, forces.force);
      if (books) all.work[j].slide += h * sum;
      return Left::nothing;
    }
    using Stores = typename Joint::Stores;
    JointForceOf<Stores> force = converted<Stores>(force_of(t, o, h));
    const auto velocity = [&](int corner) {
      return Vec2{joint.corner[corner][2], joint.corner[corner][3]};
    };
    all.book_work(j, o, dt * (velocity(0) - velocity(2)), dt * (velocity(1) - velocity(3)),
                  converted<double>(as_in_memory(force)));
    if (rubs) all.rubbed[j] += h * sum;
    all.force[j] = force;
    return Left::nothing;
  }
};

}  // namespace breccia::fdem
