#include "fdem3/stepping/step.hpp"

#include "fdem3/fluid/fluid.hpp"
#include "fdem3/ranks.hpp"
#include "fdem3/shape.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem_shared/advance.hpp"
#include "fdem_shared/stepping.hpp"

namespace breccia::fdem3 {

Kick kick(const World& w) {
  return fdem_shared::world_kick(w);
}

StableStep stable_step(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  const Joints& j = w.joints;
  return {t.nodes.view(),
          t.material.view(),
          laws_of(w),
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
          w.couple_phase.view(),
          j.face_a.view(),
          j.face_b.view(),
          w.given->time.evaluate_every};
}

void list_motions(World& w) {
  fdem_shared::list_world_motions(w);
}
void foresee_motions(World& w) {
  fdem_shared::foresee_world_motions(w);
}
void start_rigid_bodies(World& w, const Config& config) {
  fdem_shared::start_rigid_of_world(w, config);
}
void take_up_rigid_bodies(World& w) {
  fdem_shared::take_up_rigid_of_world(w);
}
AllowedStep allowed_step(const World& w) {
  return fdem_shared::world_allowed_step(w);
}
double free_time_step(World& w) {
  return fdem_shared::world_free_step(w);
}
double choose_time_step(World& w) {
  return fdem_shared::world_time_step(w);
}
double shortened_time_step(World& w, const Buffer<Index>& tetrahedra) {
  return fdem_shared::world_shortened_step(w, tetrahedra);
}
double step_shortened_by_marks(World& w) {
  return fdem_shared::world_step_by_marks(w);
}

void StepwiseRun::load_forces(World& w) const {
  if (w.given->flow.on) flow_on(w);
  if (!w.given->bolts.empty()) fdem_shared::pull_bolts(w);
  fdem_shared::StepwiseRun<World>::load_forces(w);
}

void share_bundle_forces(World& w) {
  StepwiseRun{}.bundle_forces(w);
}

void step(World& w) {
  step_by<HostRun>(w);
}
void evaluate_forces(World& w) {
  evaluate_forces_by<HostRun>(w);
}
Advanced advance(World& w, const StopAt& stop) {
  return fdem_shared::advance_world<HostRun>(w, stop);
}

}  // namespace breccia::fdem3

template struct breccia::fdem_shared::StepwiseRun<breccia::fdem3::World>;
