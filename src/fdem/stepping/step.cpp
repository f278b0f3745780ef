#include "fdem/stepping/step.hpp"

#include <algorithm>

#include "core/stepping.hpp"
#include "exec/for_each.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/ranks.hpp"
#include "fdem/stepping/launches.hpp"

namespace breccia::fdem {
namespace {

struct OwnedStableStep {
  StableStep stable;
  OwnedView owned;
  BR_HD double operator()(Index t) const { return owned(t) ? stable(t) : largest_least; }
};

/// The stable step of the triangles that can touch: those where a joint may just have broken.
struct StableStepOf {
  OwnedStableStep stable;
  View<const Index> triangle;
  BR_HD double operator()(Index i) const { return stable(triangle[i]); }
};

}  // namespace

Kick kick(const World& w) {
  const Triangles& t = w.triangles;
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
  if (w.prescribed.empty()) return;
  std::vector<Motion> now;
  const double middle = w.time + 0.5 * w.next_dt;
  for (const PrescribedMotion& p : w.prescribed) now.push_back({p.at(middle)});
  copy_to(w.motions, now);
}

AllowedStep allowed_step(const World& w) {
  return {w.given->time.safety, w.given->time.max_step};
}

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  const OwnedStableStep stable{stable_step(w), w.domain.owned_view()};
  const double least =
      w.domain.least(fold(w.exec, w.triangles.size(), largest_least, stable, Least{}));
  return allowed_step(w)(least, w.last_dt);
}

double shortened_time_step(const World& w, const Buffer<Index>& triangles) {
  const StageTime timed(w.exec, "time_step");
  const double stable = w.domain.least(
      fold(w.exec, triangles.size(), largest_least,
           StableStepOf{{stable_step(w), w.domain.owned_view()}, triangles.view()}, Least{}));
  return std::min(w.next_dt, allowed_step(w)(stable, w.last_dt));
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
  if (w.load_starts.size() > 1) {
    const StageTime timed(w.exec, "load_forces");
    std::vector<LoadLaw> now = w.given->loads;
    for (std::size_t i = 0; i < now.size(); ++i)
      now[i].factor = w.given->load_amplitudes[i].at(w.time);
    copy_to(w.load_laws, now);
    for_each(w.exec, w.load_starts.size() - 1, load_kernel(w));
  }
}

void StepwiseRun::bundle_forces(World& w) const {
  if (w.mesh.bundled && !w.domain.single_rank()) {  // also on ranks that have none
    const StageTime timed(w.exec, "halo");
    w.tied_forces.refresh(w.exec, *w.domain.ranks, w.triangles.force);
  }
  if (w.bundles.starts.size() < 2) return;
  const StageTime timed(w.exec, "bundles");
  for_each(w.exec, w.bundles.starts.size() - 1, bundle_kernel(w));
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
