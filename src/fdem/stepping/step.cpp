#include "fdem/stepping/step.hpp"

#include "fdem/fluid/fluid.hpp"
#include "fdem/ranks.hpp"
#include "fdem/shape.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem_shared/advance.hpp"
#include "fdem_shared/mark_apart.hpp"
#include "fdem_shared/stepping.hpp"

namespace breccia::fdem {

Kick kick(const World& w) {
  return fdem_shared::world_kick(w);
}

StableStep stable_step(const World& w) {
  const Triangles& t = w.triangles;
  const Pairs& pairs = w.couples.pairs;
  return {t.nodes.view(),
          t.material.view(),
          laws_of(w),
          w.given->laws.view(),
          t.viscosity.view(),
          t.mass.view(),
          w.given->contact_pairs.view(),
          w.given->materials,
          w.edges.view(),
          w.given->bonds.view(),
          w.joints.law.view(),
          w.joints.stage.view(),
          t.hold.view(),
          w.given->holds.view(),
          w.dashpots.view(),
          {t.nodes.view(), t.shape_inverse.view(), w.couple_incidence.view(), pairs.a.view(),
           pairs.b.view(), w.couple_phase.view(), w.joints.edge_a.view(), w.joints.edge_b.view()},
          w.given->time.evaluate_every,
          w.given->rebound.stiffness()};
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
double shortened_time_step(World& w, const Buffer<Index>& triangles) {
  return fdem_shared::world_shortened_step(w, triangles);
}
double step_shortened_by_marks(World& w) {
  return fdem_shared::world_step_by_marks(w);
}

void StepwiseRun::load_forces(World& w) const {
  if (w.given->flow.on) flow_on(w);
  if (!w.given->bolts.empty()) fdem_shared::pull_bolts(w);
  fdem_shared::StepwiseRun<World>::load_forces(w);
}

bool moves_most_at_once(World& w) {
  return fdem_shared::world_moves_most_at_once(w);
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

}  // namespace breccia::fdem

template struct breccia::fdem_shared::StepwiseRun<breccia::fdem::World>;
