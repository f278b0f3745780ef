#pragma once
// Parts of a step that both finite-discrete methods share: prescribed motions, loads over time,
// corners that move as one, the next step. Made for each method in its stepping/step.cpp.

#include <algorithm>

#include "core/step_clock.hpp"
#include "core/stepping.hpp"
#include "domain/owned.hpp"
#include "exec/timers.hpp"
#include "fdem_shared/bundle_steps.hpp"
#include "fdem_shared/open_vertices.hpp"
#include "fdem_shared/ranks.hpp"
#include "fdem_shared/rigid_bodies.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/stepwise_run.hpp"
#include "fdem_shared/sum_and_move.hpp"

namespace breccia::fdem_shared {

/// The stable step of those of a list: where a joint may just have broken.
template <class StableStep>
struct ListedStableStep {
  StableStep stable;
  View<const Index> listed;
  BR_HD double operator()(Index i) const { return stable(listed[i]); }
};

/// Of those of a list the stable step where they can touch; elsewhere any will do.
template <class Touches, class StableStep>
struct StableWhere {
  Touches touches;
  StableStep stable;
  View<const Index> listed;
  BR_HD double operator()(Index i) const {
    const Index t = listed[i];
    return touches(t) ? stable(t) : largest_least;
  }
};

/// The second law of motion with the arrays of a world.
template <class World>
auto world_kick(const World& w) {
  const auto& t = ShapeOf<World>::elements(w);
  return typename ShapeOf<World>::Kick{w.last_dt,
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

/// The move of all elements; it asks whether margins hold where they will be.
template <class World>
auto world_move(World& w) {
  using Move = typename ShapeOf<World>::Move;
  auto& e = ShapeOf<World>::elements(w);
  decltype(Move::used) used{std::as_const(w.reach_place).view(),
                            std::as_const(w.reach.reference).view(),
                            std::as_const(w.reach.margin).view(),
                            w.reach.drift,
                            {}};
  used.set_time(w.time + w.next_dt);
  return Move{kick(w),
              std::as_const(e.external).view(),
              e.nodes.view(),
              e.damping_work.view(),
              e.load_work.view(),
              used};
}

/// Kernels of sum_and_move.hpp over the arrays of a world whose SummedApart is known.
template <class World, class Sums>
SumApart<Sums> sum_apart(const World& w, const Sums& sums) {
  return {sums, w.summed_apart.group.view(), ShapeOf<World>::elements(w).size()};
}
template <class World, class Sums>
SumOthers<Sums> sum_others(const World& w, const Sums& sums) {
  return {sums, {w.summed_apart.marked.view()}};
}
template <class World, class Sums>
auto sum_and_move(World& w, const Sums& sums) {
  using Move = typename ShapeOf<World>::Move;
  return SumAndMove<Sums, Move>{sums, world_move(w), {std::as_const(w.summed_apart.marked).view()}};
}

/// Velocities of supports at the middle of the step to come, into World::motions.
/// @returns the states of rigid bodies after it
template <class World>
auto motions_to_come(World& w) {
  auto rigid = w.rigid;
  if (w.prescribed.empty()) return rigid;
  std::vector<typename ShapeOf<World>::Motion> now;
  for (const auto& p : w.prescribed) now.push_back(p.now(w.time, w.next_dt));
  for (const auto& body : w.rigid_bodies) {
    const auto step = rigid_step(w, body);
    now[at(body.motion)] = step.motion;
    rigid[body.support] = step.after;
  }
  copy_to(w.motions, now);
  return rigid;
}
template <class World>
void list_world_motions(World& w) {
  w.rigid = motions_to_come(w);
}
template <class World>
void foresee_world_motions(World& w) {
  if (!w.rigid_bodies.empty()) motions_to_come(w);
}

/// Whether a support turns what it holds, or lets it go where forces lead: the host tells in each
/// step where its axis is.
template <class World>
bool turns_anything(const World& w) {
  return !w.rigid_bodies.empty() || std::any_of(w.prescribed.begin(), w.prescribed.end(),
                                                [](const auto& p) { return p.turns(); });
}

template <class World>
AllowedStep world_allowed_step(const World& w) {
  return {w.given->time.safety, w.given->time.max_step};
}

/// Safe share of the stable step of all elements, rounded down to six bits.  [s]
template <class World>
double world_time_step(World& w) {
  const StageTime timed(w.exec, "time_step");
  const Index count = ShapeOf<World>::elements(w).size();
  w.least_step = bundles_bound(w)
                     ? least_step_of_corners(w, Pressed::soon)
                     : w.domain.least(fold_owned(w.exec, w.domain, count, largest_least,
                                                 stable_step(w), Least{}));
  return world_allowed_step(w)(w.least_step, w.last_dt);
}

/// The step to come, or less where these elements allow less: after their joints have changed. What
/// moves with them may have lost mass: where corners move as one, all are asked.
template <class World>
double world_shortened_step(World& w, const Buffer<Index>& listed) {
  if (bundles_bound(w)) return std::min(w.next_dt, world_time_step(w));
  const StageTime timed(w.exec, "time_step");
  using Stable = ListedStableStep<decltype(stable_step(w))>;
  const Stable stable{stable_step(w), listed.view()};
  const double least = w.domain.least(fold_owned(w.exec, w.domain, listed.size(), largest_least,
                                                 stable, Least{}, ListedElement<>{listed.view()}));
  return std::min(w.next_dt, world_allowed_step(w)(least, w.last_dt));
}

/// As that, by the elements in reach that can touch by the marks of now.
template <class World>
double world_step_by_marks(World& w) {
  if (bundles_bound(w)) return std::min(w.next_dt, world_time_step(w));
  const StageTime timed(w.exec, "time_step");
  const auto touchable = touchable_now(w);
  const View<const Index> listed = std::as_const(w.reach.element).view();
  using Stable = StableWhere<std::remove_const_t<decltype(touchable)>, decltype(stable_step(w))>;
  const double least = w.domain.least(fold_owned(w.exec, w.domain, listed.size, largest_least,
                                                 Stable{touchable, stable_step(w), listed}, Least{},
                                                 ListedElement<>{listed}));
  return std::min(w.next_dt, world_allowed_step(w)(least, w.last_dt));
}

/// The factors that loads have at the time of the positions.
template <class World>
void list_load_factors(World& w) {
  auto now = w.given->loads;
  for (std::size_t i = 0; i < now.size(); ++i)
    now[i].factor = w.given->load_amplitudes[i].at(w.time);
  copy_to(w.load_laws, now);
}

/// Corners that move as one share their force.
/// @param share  the kernel
template <class World, class Share>
void share_forces_of_bundles(World& w, const Share& share) {
  if (w.mesh.bundled && !w.domain.single_rank()) {  // also on ranks that have none
    const StageTime timed(w.exec, "halo");
    w.tied_forces.refresh(w.exec, *w.domain.ranks, ShapeOf<World>::elements(w).force);
  }
  if (w.bundles.starts.size() < 2) return;
  const StageTime timed(w.exec, "bundles");
  for_each(w.exec, w.bundles.starts.size() - 1, share);
}

template <class World>
void StepwiseRun<World>::send_ghosts(World& w) const {
  start_ghosts(w);
}
template <class World>
void StepwiseRun<World>::ask_for_search(World& w) const {
  ask_ranks_for_search(w);
}
template <class World>
void StepwiseRun<World>::receive_ghosts(World& w) const {
  finish_ghosts(w);
}
template <class World>
void StepwiseRun<World>::search_if_due(World& w) const {
  if (!couples_are_due(w) || follow_marks(w)) return;
  refresh_ghosts(w);
  find_couples(w);
}
template <class World>
void StepwiseRun<World>::insert_joints(World& w) const {
  wake_joints(w);
}
template <class World>
void StepwiseRun<World>::load_forces(World& w) const {
  if (w.load_starts.size() < 2) return;
  const StageTime timed(w.exec, "load_forces");
  list_load_factors(w);
  for_each(w.exec, w.load_starts.size() - 1, load_kernel(w));
}
template <class World>
void StepwiseRun<World>::bundle_forces(World& w) const {
  share_forces_of_bundles(w, bundle_kernel(w));
}
template <class World>
void StepwiseRun<World>::choose_step(World& w) const {
  if (w.step % w.given->time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

}  // namespace breccia::fdem_shared
