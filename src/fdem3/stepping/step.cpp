#include "fdem3/stepping/step.hpp"

#include "fdem3/joints/joint_kernels.hpp"
#include "fdem3/ranks.hpp"
#include "fdem_shared/stepping.hpp"

namespace breccia::fdem3 {
namespace {

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

}  // namespace

Kick kick(const World& w) {
  return fdem_shared::world_kick(w);
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
  fdem_shared::list_world_motions(w);
}
double choose_time_step(const World& w) {
  return fdem_shared::world_time_step(w);
}
double shortened_time_step(const World& w, const Buffer<Index>& tetrahedra) {
  return fdem_shared::world_shortened_step(w, tetrahedra);
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
  fdem_shared::list_load_factors(w);
  Tetrahedra& t = w.tetrahedra;
  for_each(w.exec, w.load_starts.size() - 1,
           LoadForces{std::as_const(w.load_starts).view(), std::as_const(w.loaded_faces).view(),
                      std::as_const(w.load_laws).view(), std::as_const(t.nodes).view(),
                      t.external.view(), t.force.view()});
}

void bundle_forces(World& w) {
  const Bundles& all = w.bundles;
  fdem_shared::share_forces_of_bundles(
      w, BundleForces{all.starts.view(), all.nodes.view(), all.leader.view(),
                      std::as_const(w.tetrahedra.mass).view(), w.tetrahedra.force.view()});
}
void share_bundle_forces(World& w) {
  bundle_forces(w);
}

void Run::move_boundary(World& w) const {
  move_elements(w);
}
void Run::send_ghosts(World& w) const {
  start_ghosts(w);
}
void Run::move_interior(World& w) const {
  advance_time(w);
}
void Run::ask_for_search(World& w) const {
  fdem3::ask_for_search(w);
}
void Run::receive_ghosts(World& w) const {
  finish_ghosts(w);
}
void Run::search_if_due(World& w) const {
  if (!couples_are_due(w)) return;
  refresh_ghosts(w);
  find_couples(w);
}
void Run::pair_forces(World& w) const {
  joint_forces(w);
  couple_forces(w);
}
void Run::sum_forces(World& w) const {
  fdem3::sum_forces(w);
}
void Run::load_forces(World& w) const {
  fdem3::load_forces(w);
}
void Run::bundle_forces(World& w) const {
  fdem3::bundle_forces(w);
}
void Run::choose_step(World& w) const {
  if (w.step % w.given->time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

void step(World& w) {
  fdem_shared::take_step(Run{}, w);
}
void evaluate_forces(World& w) {
  fdem_shared::take_forces(Run{}, w);
}
Advanced advance(World& w, const StopAt&) {
  step(w);
  return {1, w.last_dt, w.last_dt};
}

}  // namespace breccia::fdem3
