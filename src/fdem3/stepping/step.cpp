#include "fdem3/stepping/step.hpp"

#include <algorithm>

#include "core/stepping.hpp"
#include "exec/for_each.hpp"
#include "fdem3/joints/joint_kernels.hpp"
#include "fdem3/ranks.hpp"

namespace breccia::fdem3 {
namespace {

struct OwnedStableStep {
  StableStep stable;
  OwnedView owned;
  BR_HD double operator()(Index t) const { return owned(t) ? stable(t) : largest_least; }
};

/// The stable step of those that can touch: where a joint may just have broken.
struct StableStepOf {
  OwnedStableStep stable;
  View<const Index> tetrahedron;
  BR_HD double operator()(Index i) const { return stable(tetrahedron[i]); }
};

/// Runs a kernel for the tetrahedra of this rank: ghosts follow their owners.
template <class Kernel>
struct ForOwned {
  static constexpr const char* name = Kernel::name;
  Kernel kernel;
  OwnedView owned;
  BR_HD void operator()(Index t) const {
    if (owned(t)) kernel(t);
  }
};
template <class Kernel>
void for_each_owned(World& w, const Kernel& kernel) {
  for_each(w.exec, w.tetrahedra.size(), ForOwned<Kernel>{kernel, w.domain.owned_view()});
}

MoveTetrahedra move_kernel(World& w) {
  Tetrahedra& t = w.tetrahedra;
  UsedMargin used{std::as_const(w.reach_place).view(), std::as_const(w.reach.reference).view(),
                  std::as_const(w.reach.margin).view(), w.reach.drift, Vec3{}};
  used.set_time(w.time + w.next_dt);
  return {kick(w),
          std::as_const(t.external).view(),
          t.nodes.view(),
          t.damping_work.view(),
          t.load_work.view(),
          used,
          w.beyond.view()};
}

AllowedStep allowed_step(const World& w) {
  return {w.given->time.safety, w.given->time.max_step};
}

}  // namespace

Kick kick(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  return {w.last_dt,
          w.next_dt,
          w.given->gravity,
          w.given->local_damping,
          w.given->holds.view(),
          w.motions.view(),
          t.mass.view(),
          t.nodes.view(),
          t.force.view(),
          t.hold.view()};
}

StableStep stable_step(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  const Joints& j = w.joints;
  return {t.nodes.view(),
          t.material.view(),
          w.given->laws.view(),
          t.shape.view(),
          t.viscosity.view(),
          t.mass.view(),
          w.given->contact_pairs.view(),
          w.given->materials,
          w.faces.view(),
          t.exposed.view(),
          w.given->bonds.view(),
          j.law.view(),
          j.shape.view(),
          j.length.view(),
          j.stage.view(),
          t.hold.view(),
          w.given->holds.view(),
          w.dashpots.view(),
          w.couple_incidence.view(),
          w.couples.pairs.a.view(),
          w.couples.pairs.b.view(),
          j.face_a.view(),
          j.face_b.view(),
          w.given->time.evaluate_every};
}

void list_motions(World& w) {
  if (w.prescribed.empty()) return;
  std::vector<Motion> now;
  const double middle = w.time + 0.5 * w.next_dt;
  for (const PrescribedMotion& p : w.prescribed) now.push_back({p.at(middle)});
  copy_to(w.motions, now);
}

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  const OwnedStableStep stable{stable_step(w), w.domain.owned_view()};
  const double least =
      w.domain.least(fold(w.exec, w.tetrahedra.size(), largest_least, stable, Least{}));
  return allowed_step(w)(least, w.last_dt);
}

double shortened_time_step(const World& w, const Buffer<Index>& tetrahedra) {
  const StageTime timed(w.exec, "time_step");
  const double stable = w.domain.least(
      fold(w.exec, tetrahedra.size(), largest_least,
           StableStepOf{{stable_step(w), w.domain.owned_view()}, tetrahedra.view()}, Least{}));
  return std::min(w.next_dt, allowed_step(w)(stable, w.last_dt));
}

void move_elements(World& w) {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  copy_to(w.beyond, std::vector<std::uint8_t>{0});
  for_each_owned(w, move_kernel(w));
}

void joint_forces(World& w) {
  const StageTime timed(w.exec, "joint_forces");
  Joints& j = w.joints;
  for_each(w.exec, j.size(),
           JointForces{w.time,
                       w.last_dt,
                       std::as_const(w.tetrahedra.nodes).view(),
                       w.given->bonds.view(),
                       std::as_const(j.face_a).view(),
                       std::as_const(j.face_b).view(),
                       std::as_const(j.turn).view(),
                       std::as_const(j.law).view(),
                       std::as_const(j.shape).view(),
                       std::as_const(j.length).view(),
                       std::as_const(j.strength).view(),
                       std::as_const(j.preset).view(),
                       w.given->in_situ,
                       j.stage.view(),
                       j.points.view(),
                       j.force.view(),
                       j.work.view(),
                       j.broke_at.view(),
                       j.pressing.view(),
                       j.shear_at_break.view(),
                       w.exposed.changed.view()});
}

void couple_forces(World& w) {
  const StageTime timed(w.exec, "contact_forces");
  Couples& c = w.couples;
  Joints& j = w.joints;
  for_each(w.exec, c.size(),
           CoupleForces{w.last_dt,
                        std::as_const(w.tetrahedra.nodes).view(),
                        std::as_const(w.tetrahedra.material).view(),
                        w.given->contact_pairs.view(),
                        w.given->materials,
                        std::as_const(w.tetrahedra.exposed).view(),
                        std::as_const(c.pairs.a).view(),
                        std::as_const(c.pairs.b).view(),
                        std::as_const(w.parent_joint).view(),
                        {std::as_const(j.pressing).view(), std::as_const(j.shear_at_break).view(),
                         j.inherited_work.view()},
                        c.history.state.view(),
                        c.history.force.view()});
}

void sum_forces(World& w) {
  const StageTime timed(w.exec, "element_forces");
  Tetrahedra& t = w.tetrahedra;
  for_each_owned(
      w, ElementForces{w.last_dt, std::as_const(t.nodes).view(), std::as_const(t.material).view(),
                       w.given->laws.view(), std::as_const(t.shape).view(),
                       std::as_const(t.viscosity).view(), std::as_const(w.faces).view(),
                       std::as_const(w.joints.turn).view(), std::as_const(w.joints.force).view(),
                       w.couple_incidence.view(), std::as_const(w.couples.history.force).view(),
                       t.force.view(), t.viscous_work.view()});
}

void load_forces(World& w) {
  if (w.load_starts.size() < 2) return;
  const StageTime timed(w.exec, "load_forces");
  std::vector<LoadLaw> now = w.given->loads;
  for (std::size_t i = 0; i < now.size(); ++i)
    now[i].factor = w.given->load_amplitudes[i].at(w.time);
  copy_to(w.load_laws, now);
  Tetrahedra& t = w.tetrahedra;
  for_each(w.exec, w.load_starts.size() - 1,
           LoadForces{std::as_const(w.load_starts).view(), std::as_const(w.loaded_faces).view(),
                      std::as_const(w.load_laws).view(), std::as_const(t.nodes).view(),
                      t.external.view(), t.force.view()});
}

void bundle_forces(World& w) {
  if (w.mesh.bundled && !w.domain.single_rank()) {  // also on ranks that have none
    const StageTime timed(w.exec, "halo");
    w.tied_forces.refresh(w.exec, *w.domain.ranks, w.tetrahedra.force);
  }
  if (w.bundles.starts.size() < 2) return;
  const StageTime timed(w.exec, "bundles");
  for_each(
      w.exec, w.bundles.starts.size() - 1,
      BundleForces{std::as_const(w.bundles.starts).view(), std::as_const(w.bundles.nodes).view(),
                   std::as_const(w.bundles.leader).view(), std::as_const(w.tetrahedra.mass).view(),
                   w.tetrahedra.force.view()});
}
void share_bundle_forces(World& w) {
  bundle_forces(w);
}

void take_forces(World& w) {
  // 3. Joints crack, couples push and rub, tetrahedra deform; one sum per corner, no atomics
  joint_forces(w);
  couple_forces(w);
  sum_forces(w);
  load_forces(w);
  bundle_forces(w);

  // 4. The next step: Gershgorin's bound
  if (w.step % w.given->time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

void take_step(World& w) {
  // 1. Newton's second law: velocities and positions of all corners
  move_elements(w);
  start_ghosts(w);
  ask_for_search(w);  // all ranks vote
  finish_ghosts(w);
  advance_time(w);

  // 2. Contact detection, when travel has used the margin up or a joint has opened
  if (couples_are_due(w)) {
    refresh_ghosts(w);
    find_couples(w);
  }

  take_forces(w);
  w.step += 1;
}

void step(World& w) {
  take_step(w);
}
void evaluate_forces(World& w) {
  take_forces(w);
}
Advanced advance(World& w, const StopAt&) {
  take_step(w);
  return {1, w.last_dt, w.last_dt};
}

}  // namespace breccia::fdem3
