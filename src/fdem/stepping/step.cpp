#include "fdem/stepping/step.hpp"

#include "fdem/fluid/fluid.hpp"
#include "fdem/ranks.hpp"
#include "fdem/stepping/launches.hpp"
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
           pairs.b.view(), w.joints.edge_a.view(), w.joints.edge_b.view()},
          w.given->time.evaluate_every,
          w.given->rebound.stiffness()};
}

void list_motions(World& w) {
  fdem_shared::list_world_motions(w);
}
AllowedStep allowed_step(const World& w) {
  return fdem_shared::world_allowed_step(w);
}
double choose_time_step(const World& w) {
  return fdem_shared::world_time_step(w);
}
double shortened_time_step(const World& w, const Buffer<Index>& triangles) {
  return fdem_shared::world_shortened_step(w, triangles);
}

void StepwiseRun::send_ghosts(World& w) const {
  start_ghosts(w);
}

void StepwiseRun::ask_for_search(World& w) const {
  fdem::ask_for_search(w);
}

void StepwiseRun::receive_ghosts(World& w) const {
  finish_ghosts(w);
}

void StepwiseRun::search_if_due(World& w) const {
  if (!couples_are_due(w)) return;
  refresh_ghosts(w);
  find_couples(w);
}

void StepwiseRun::insert_joints(World& w) const {
  fdem::insert_joints(w);
}

void StepwiseRun::load_forces(World& w) const {
  if (w.given->flow.on) flow_on(w);
  if (w.load_starts.size() < 2) return;
  const StageTime timed(w.exec, "load_forces");
  fdem_shared::list_load_factors(w);
  for_each(w.exec, w.load_starts.size() - 1, load_kernel(w));
}

void StepwiseRun::bundle_forces(World& w) const {
  fdem_shared::share_forces_of_bundles(w, bundle_kernel(w));
}

void share_bundle_forces(World& w) {
  StepwiseRun{}.bundle_forces(w);
}

void StepwiseRun::choose_step(World& w) const {
  if (w.step % w.given->time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

void step(World& w) {
  step_by<HostRun>(w);
}
void evaluate_forces(World& w) {
  evaluate_forces_by<HostRun>(w);
}
Advanced advance(World& w, const StopAt& stop) {
  if (!w.given->flow.on) return advance_by_steps(w, stop);
  step(w);  // openings of cracks come to the host in every step, on a device, too
  return {1, w.last_dt, w.last_dt};
}

}  // namespace breccia::fdem
