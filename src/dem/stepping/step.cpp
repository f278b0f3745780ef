#include "dem/stepping/step.hpp"

#include <algorithm>
#include <utility>

#include "core/stepping.hpp"
#include "dem/free_walls.hpp"
#include "dem/ranks.hpp"
#include "dem/stepping/launches.hpp"
#include "domain/owned.hpp"

namespace breccia::dem {
namespace {

struct LeastCritical {
  View<const double> critical;
  BR_HD double operator()(Index e) const { return critical[e]; }
};
/// Of the elements of this rank, on a device.
double least_there(const World& w) {
  if (sums_note_least(w)) {
    std::uint64_t bits = 0;
    peek_marked_bytes(&bits, &w.clock.data()->least, w.exec.space, sizeof bits);
    return number_of(bits);
  }
  return fold_owned(w.exec, w.domain, w.elements.size(), largest_least,
                    LeastCritical{w.critical.view()}, Least{});
}
/// The least critical number of this rank's elements, on the host.
double least_here(const World& w) {
  constexpr Index grain = 4096;
  const Index count = w.elements.size();
  std::vector<double> least_of(static_cast<std::size_t>((count + grain - 1) / grain + 1),
                               largest_least);
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    double& own = least_of[static_cast<std::size_t>(begin / grain)];
    each_owned(w.domain, w.domain.runs, begin, end, [&](Index from, Index to) {
      own = std::min(own, least(w.lanes, w.critical.view(), from, to));
    });
  });
  return *std::min_element(least_of.begin(), least_of.end());
}

}  // namespace

ElementsView elements_view(const World& w) {
  return {w.elements.state.view(), w.elements.mass.view(), w.elements.inertia.view()};
}

Kick kick(const World& w) {
  return {w.time,
          w.last_dt,
          w.next_dt,
          w.given->gravity,
          w.given->local_damping,
          w.motions.view(),
          w.motion_times.view(),
          w.motion_factors.view(),
          w.elements.mass.view(),
          w.elements.inertia.view(),
          w.elements.state.view(),
          w.elements.force.view(),
          w.elements.torque.view(),
          w.elements.fixed.view(),
          w.elements.motion.view()};
}

StepRule step_rule(const World& w) {
  return {w.given->time.safety, w.given->time.max_step, w.given->contact_step};
}

View<const Wall> walls_view(const World& w) {
  if (w.exec.space != Space::host) return w.device_walls.view();
  View<const Wall> view;
  view.data = w.walls.data();
  view.size = static_cast<Index>(w.walls.size());
  return view;
}

WallMesh mesh_of(const World& w, Index wall) {
  const WallMeshes& all = w.given->meshes;
  if (all.parts.empty()) return {};
  const WallMeshes::Part& part = all.parts[static_cast<std::size_t>(wall)];
  return {all.nodes.view(), all.triangles.view(), all.starts.view(), all.ends.view(),
          all.out.view(),   part.first,           part.last,         part.closed};
}

void move_walls(World& w) {
  const std::size_t first = w.prescribed.motions.size() - w.walls.size();
  for (std::size_t k = 0; k < w.walls.size(); ++k) {
    if (is_free(w, k)) {
      move_free_wall(w, k);
      continue;
    }
    w.walls[k].velocity = w.prescribed.velocity(first + k, w.time + 0.5 * w.next_dt);
    if (!w.given->wall_spins.empty())
      w.walls[k].spin = w.given->wall_spins[k].at(w.time + 0.5 * w.next_dt);
    w.walls[k].move(w.next_dt, w.travel.drift.velocity);
  }
  advance_time(w);
}

void StepwiseRun::send_ghosts(World& w) const {
  start_ghosts(w);
}

void StepwiseRun::receive_ghosts(World& w) const {
  ask_for_search(w);  // all ranks vote, while ghosts travel
  finish_ghosts(w);
}

void StepwiseRun::search_if_due(World& w) const {
  if (!contacts_are_due(w)) return;
  refresh_ghosts(w);
  find_contacts(w);
}

void StepwiseRun::wall_forces(World& w) const {
  if (w.wall_contacts.size() == 0 && w.free_walls.empty()) return;
  const StageTime timed(w.exec, "wall_forces");
  if (w.exec.space != Space::host) copy_to(w.device_walls, w.walls);
  each_wall_kernel(w, [&w](Index count, const auto& kernel) { for_each(w.exec, count, kernel); });
  sum_on_free_walls(w);
}

void StepwiseRun::choose_step(World& w) const {
  if (w.step % w.given->time.evaluate_every != 0) return;
  const StageTime timed(w.exec, "time_step");
  const double least = w.exec.space != Space::host ? least_there(w) : least_here(w);
  w.next_dt = step_rule(w)(std::min(w.domain.least(least), least_of_free_walls(w)), w.last_dt);
}

void step(World& w) {
  step_by<HostRun>(w);
}
void evaluate_forces(World& w) {
  evaluate_forces_by<HostRun>(w);
}

namespace {
/// A copy with the forces of the state as it is: a force law may note what it sees.
World evaluated(const World& w) {
  World trial = w;
  trial.graph.clear();
  trial.last_dt = 0.0;  // nothing has moved since
  trial.step = 0;       // a step that evaluates
  evaluate_forces(trial);
  return trial;
}
}  // namespace

double step_allowed_now(const World& w) {
  return evaluated(w).next_dt;
}

void find_critical(World& w) {
  w.critical = evaluated(w).critical;
}

void evaluate_anew(World& w) {
  w.contact_actions.clear();
  w.contact_actions.resize(w.contacts.size());        // those that touch write theirs
  const double last = std::exchange(w.last_dt, 0.0);  // nothing has moved since
  const double next = w.next_dt;
  evaluate_forces(w);
  w.last_dt = last;
  w.next_dt = std::min(next, w.next_dt);
}

Advanced advance(World& w, const StopAt& stop) {
  if (w.free_walls.empty() && w.given->wall_spins.empty()) return advance_by_steps(w, stop);
  step(w);  // what acts on a wall with mass, and how one turns, is of the host in every step
  return {1, w.last_dt, w.last_dt};
}

}  // namespace breccia::dem
