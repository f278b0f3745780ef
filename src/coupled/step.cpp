// One step of spheres and tetrahedra together: the steps of both methods (dem/stepping/step.hpp,
// fdem_shared/step.hpp), one within the other, and the forces between them.

#include "dem/stepping/step.hpp"

#include <algorithm>
#include <cmath>

#include "core/on_host.hpp"
#include "core/stepping.hpp"
#include "coupled/world.hpp"
#include "exec/fold_sum.hpp"
#include "exec/for_each.hpp"
#include "fdem3/stepping/step.hpp"

namespace breccia::coupled {

namespace {

/// Tetrahedra that spheres press on.
/// @tparam Run  carries their own step out
template <class Run>
struct TetrahedraRun : Run {
  World& both;
  explicit TetrahedraRun(World& w) : both(w) {}

  void search_if_due(fdem3::World& t) const {
    const std::int64_t before = t.searches;
    Run::search_if_due(t);
    if (t.searches != before && t.next_dt < t.last_dt)
      both.stable_step = std::min(both.stable_step, t.next_dt);
  }
  /// Joints that wake shorten the step.
  void insert_joints(fdem3::World& t) const {
    const double before = t.next_dt;
    Run::insert_joints(t);
    if (t.next_dt < before) both.stable_step = std::min(both.stable_step, t.next_dt);
  }
  /// Spheres have summed up their own by now.
  void coupling_forces(fdem3::World&) const { press(both); }
  void choose_step(fdem3::World&) const { note_stable_step(both); }
};

/// Spheres that press on tetrahedra.
template <class Run, class OfTetrahedra>
struct SpheresRun : Run {
  World& both;
  explicit SpheresRun(World& w) : both(w) {}

  void coupling_forces(dem::World&) const {
    fdem_shared::take_forces(TetrahedraRun<OfTetrahedra>(both), *both.tetrahedra);
  }
  void choose_step(dem::World& s) const {
    Run::choose_step(s);
    choose_common_step(both);
  }
};

template <class OfSpheres, class OfTetrahedra>
void take_step(World& w) {
  // 1., 2. Both move, by the same step, and search; then the faces near spheres are listed anew
  TetrahedraRun<OfTetrahedra> tetrahedra(w);
  SpheresRun<OfSpheres, OfTetrahedra> spheres(w);
  dem::take_motion(spheres, *w.spheres);
  fdem_shared::take_motion(tetrahedra, *w.tetrahedra);
  if (faces_are_due(w)) find_faces(w);

  // 3., 4. Within the forces of the spheres those of the tetrahedra; within these, between the sums
  //    of both and their loads and walls, those between them; the least step of all
  dem::take_forces(spheres, *w.spheres);
  spheres.count_step(*w.spheres);
  tetrahedra.count_step(*w.tetrahedra);
}

}  // namespace

void step(World& w) {
#if !defined(BR_NO_LAUNCHES)
  if (w.spheres->exec.space != Space::host) return take_step<dem::DeviceRun, fdem3::DeviceRun>(w);
#endif
  take_step<dem::HostRun, fdem3::HostRun>(w);
}

void press_spheres_again(World& w) {
  dem::Elements& e = w.spheres->elements;
  for_each(w.spheres->exec, w.rows.size(),
           AddToSpheres{w.rows.view(), std::as_const(w.bonds.state).view(),
                        std::as_const(w.touches.history.force).view(), std::as_const(e.mass).view(),
                        std::as_const(e.inertia).view(), e.force.view(), e.torque.view(),
                        w.spheres->critical.view()});
}

namespace {
/// A kernel for what this rank evaluates of a list; alone for all of it.
template <class Kernel>
void for_evaluated(const World& w, Index count, const Buffer<Index>& here, const Kernel& kernel) {
  if (w.spheres->domain.single_rank()) return for_each(w.spheres->exec, count, kernel);
  for_each(w.spheres->exec, here.size(), OfList<Kernel>{kernel, here.view()});
}
}  // namespace

void press(World& w) {
  const dem::World& s = *w.spheres;
  follow_owners(w);
  const StageTime timed(s.exec, "coupling");
  const Meeting m = meeting(w);
  for_evaluated(w, w.bonds.size(), w.border.bonds,
                BondForces{s.time, s.last_dt, m.spheres, m.orientation, m.nodes,
                           w.given->bonds.view(), m.tie, w.bonds.state.view()});
  for_evaluated(w, w.rows.size(), w.border.rows,
                MarkBonded{w.rows.view(), m.tie, w.bonds.state.view(), w.bonded.view()});
  for_evaluated(
      w, w.touches.size(), w.border.touches,
      PressFaces{s.last_dt, m.spheres, m.sphere_material, m.nodes, m.material, m.body, m.exposed,
                 w.given->laws.view(), w.given->materials, w.rows.view(), w.row_of_touch.view(),
                 w.bonded.view(), w.touches.pairs.b.view(), m.face, w.touches.history.state.view(),
                 w.touches.history.force.view(), w.faces.history.force.view(), w.pressed.view()});
  press_spheres_again(w);
  for_each(s.exec, w.around.tetrahedron.size(),
           AddToTetrahedra{m.solid_here, w.around.face_starts.view(), w.around.faces.view(),
                           w.around.bond_starts.view(), w.around.bonds.view(), m.face,
                           w.faces.history.force.view(), w.pressed.view(), m.tie,
                           w.bonds.state.view(), fdem3::stable_step(*w.tetrahedra),
                           w.tetrahedra->tetrahedra.force.view(), w.step.view()});
}

namespace {
struct StepOfRow {
  View<const double> step;
  BR_HD double operator()(Index i) const { return step[i]; }
};
/// Inertia over stiffness of a sphere with what tetrahedra add.
struct CriticalOfRow {
  View<const SphereRow> rows;
  View<const double> critical;
  BR_HD double operator()(Index i) const {
    return rows[i].here < 0 ? largest_least : critical[rows[i].here];
  }
};
}  // namespace

void note_stable_step(World& w) {
  fdem3::World& t = *w.tetrahedra;
  if (t.step % t.given->time.evaluate_every == 0) w.stable_step = fdem3::choose_time_step(t);
}

void choose_common_step(World& w) {
  dem::World& s = *w.spheres;
  fdem3::World& t = *w.tetrahedra;
  const double least = s.domain.least(
      fold(s.exec, w.step.size(), largest_least, StepOfRow{std::as_const(w.step).view()}, Least{}));
  const AllowedStep allowed{w.given->safety, t.given->time.max_step};
  double common = std::min({s.next_dt, w.stable_step, allowed(least, s.last_dt)});
  if (!s.domain.single_rank() && s.exec.space != Space::host) {
    // Launches of ranks note the least number of spheres before tetrahedra add to it.
    const CriticalOfRow critical{std::as_const(w.rows).view(), std::as_const(s.critical).view()};
    const double lower =
        s.domain.least(fold(s.exec, w.rows.size(), largest_least, critical, Least{}));
    common = std::min(common, dem::step_rule(s)(lower, s.last_dt));
  }
  s.next_dt = t.next_dt = common;
}

void shorten_common_step(World& w) {
  dem::World& s = *w.spheres;
  fdem3::World& t = *w.tetrahedra;
  w.stable_step = std::min(w.stable_step, fdem3::choose_time_step(t));
  s.next_dt = t.next_dt = std::min({s.next_dt, t.next_dt, w.stable_step});
}

namespace {

struct TouchShares {
  View<const TouchState> state;
  BR_HD void add_to(Energies& s, Index i) const {
    s.elastic.add(state[i].work - state[i].slid);
    s.friction.add(state[i].slid);
    s.friction.add(state[i].rubbed);
    s.contact.add(state[i].lost);
  }
};
struct BondShares {
  BondsView bonds;
  View<const BallBondState> state;
  BR_HD void add_to(Energies& s, Index i) const {
    s.fracture.add(state[i].work);
    if (state[i].stage == BondStage::parted) return;
    const double held = bonds.stored(i, state[i]);
    s.elastic.add(held);
    s.fracture.add(-held);
  }
};

}  // namespace

BondsView bonds_view(const World& w) {
  return {meeting(w), w.given->bonds.view()};
}

Energies held(const World& w) {
  FoldSum<Energies> all(w.spheres->exec);
  all.add(w.touches.size(), TouchShares{w.touches.history.state.view()});
  all.add(w.bonds.size(), BondShares{bonds_view(w), w.bonds.state.view()});
  return all.sum();
}

namespace {

/// A sphere that a servo leads, by the tetrahedra that it meets.
struct TouchedBy {
  std::int16_t motion;
  double velocity;  ///< of the servo: what it meets is taken to go with it  [m/s]
  View<const std::int16_t> led_by;
  View<const double> mass;
  View<const SphereRow> rows;
  View<const BallBondState> bonds;
  View<const SphereForce> touches;

  BR_HD ServoReading operator()(Index r) const {
    const SphereRow& row = rows[r];
    ServoReading met;
    if (row.here < 0 || led_by[row.here] != motion) return met;
    double stiffness = 0.0;
    for (Index b = row.bond; b < row.bond_end; ++b) stiffness += bonds[b].force.straight;
    for (Index t = row.touch; t < row.touch_end; ++t) stiffness += touches[t].straight;
    if (!(stiffness > 0.0)) return met;
    met.stiffness.add(stiffness);
    met.flow.add(stiffness * velocity);
    met.mass.add(mass[row.here]);
    return met;
  }
};

}  // namespace

std::vector<ServoReading> touched_by_servos(const World& w) {
  const dem::World& s = *w.spheres;
  std::vector<ServoReading> touched(s.servos.size());
  for (const ServoMotion& led : s.prescribed.servos) {
    if (led.axis < 0) continue;
    const TouchedBy by{led.motion,
                       s.servos[led.servo].velocity,
                       s.elements.motion.view(),
                       s.elements.mass.view(),
                       w.rows.view(),
                       w.bonds.state.view(),
                       w.touches.history.force.view()};
    touched[led.servo] =
        touched[led.servo] + fold(s.exec, w.rows.size(), ServoReading{}, by, Sum{});
  }
  return touched;
}

Counts count(const World& w) {
  const Space space = w.spheres->exec.space;
  const OnHost touches(w.touches.history.state, space);
  const OnHost bonds(w.bonds.state, space);
  Counts n;
  for (const TouchState& touch : touches->host()) n.touching += touch.touches != 0 ? 1.0 : 0.0;
  for (const BallBondState& bond : bonds->host()) {
    n.bonds += 1.0;
    if (bond.stage != BondStage::whole) n.broken += 1.0;
  }
  return n;
}

}  // namespace breccia::coupled
