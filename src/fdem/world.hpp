#pragma once
// Everything an FDEM run consists of between two steps.

#include <functional>
#include <vector>

#include "core/broad_phase.hpp"
#include "core/drift.hpp"
#include "core/energy_split.hpp"
#include "core/read_only.hpp"
#include "core/stages.hpp"
#include "core/step_clock.hpp"
#include "core/stepping.hpp"
#include "core/travel.hpp"
#include "domain/domain.hpp"
#include "domain/set_here.hpp"
#include "exec/lanes.hpp"
#include "exec/step_graph.hpp"
#include "exec/timers.hpp"
#include "fdem/case.hpp"
#include "fdem/setup/model.hpp"
#include "fdem/triangles/loads.hpp"
#include "fdem_shared/busy_items.hpp"
#include "fdem_shared/couple_phase.hpp"
#include "fdem_shared/exposed.hpp"
#include "fdem_shared/held_couples.hpp"
#include "fdem_shared/rigid.hpp"
#include "fdem_shared/stable_parts.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem {

using fdem_shared::ExposedVertices;
using fdem_shared::WholeMesh;

/// Where fluid presses on cracks: the same on all ranks.
using FluidState = fdem_shared::FluidStateOf<LoadedEdge, CrackSide>;

using RigidBody = fdem_shared::RigidBodyOf<Vec2>;
using RigidState = fdem_shared::RigidStateOf<Vec2>;
using BoltNode = fdem_shared::BoltNodeOf<Vec2>;
using BoltState = fdem_shared::BoltStateOf<Vec2, LoadedEdge>;

/// Joints side by side, and whether they can do without ghosts of other ranks' triangles.
inline constexpr Index joint_pack = 8;
enum class JointPack : std::uint8_t {
  outer,  ///< some of them act on a copy
  inner,  ///< all of them between two own triangles
  done    ///< and evaluated in this step: they are whole and stay so
};

/// Each line tells meaning and unit, then (length; who writes it). Lengths: triangles, joints, ...
/// of this rank, ghosts included; no length: one number. Writers, in the order of a run:
///
///   set-up   make_world()
///   stage    configure(), where a stage of the case begins and after loading a checkpoint
///   servo    correct_servos(), every servo_every steps
///   move, search, insertion, pairs, sums, loads, bundles, dt
///            within a step, by fdem_shared/step.hpp: moving triangles; find_couples(); joints
///            that wake; forces of joints and couples; forces of triangles; forces on edges;
///            corners that move as one; the next step
///   ranks    when triangles change ranks or the world changes its space
///   derive   derive(), after loading and ranks; advance: advance(), on a device
///
/// An array that ranks write moves with its triangle, joint or couple.
struct World {
  explicit World(const Exec& how);

  Exec exec;             ///< (ranks: its space)
  Lanes lanes;           ///< (set-up)
  ReadOnly<Case> given;  ///< constants: fdem/case.hpp (set-up, stage)

  // Prescribed motions: constant but for those that servos lead.
  std::vector<PrescribedMotion> prescribed;  ///< (motions; set-up, stage, servo)
  std::vector<ServoMotion> servo_motions;    ///< which of them servos lead (set-up, stage)
  std::vector<RigidBody> rigid_bodies;       ///< that move by forces now (set-up, stage)

  /// Visits the arrays that kernels read: state, and what follows from the case.
  template <class Visit>
  void each_kept(Visit&& visit) {
    const auto state = [&](auto& s) {
      s.each_field([&](const char*, const char*, auto& array) { visit(array); });
    };
    state(triangles);
    state(joints);
    state(couples);
    state(reach);
    given.each_array(visit);
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(triangles.external, joints.force.in_double, joints.force.in_single, joints.preset,
         exposed.changed, exposed.vertex, load_starts, loaded_edges, dashpots, bundles.starts,
         bundles.nodes, bundles.leader, joint_ends, edges, motions, last_motions, load_laws, stress,
         overshoot, reached, domain.owned_there, domain.migration_reference);
  }
  /// Visits the arrays that derive() and a search fill.
  template <class Visit>
  void each_derived(Visit&& visit) {
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(couple_incidence, broad_phase, parent_joint, couple_phase, node_vertex, side_across,
         border_vertex, amplitudes, amplitude_times, amplitude_factors, prescribed_velocity,
         reach_place, clock, device_flags, held_couples.item, summed_apart.marked,
         summed_apart.group, busy.item, busy.listed, busy.count, busy_joints.item,
         busy_joints.listed, busy_joints.count, ringed, rows);
  }

  // State: what a checkpoint holds.
  Triangles triangles;        ///< (triangles; see its lines)
  Joints joints;              ///< (joints; see its lines)
  Couples couples;            ///< (couples; search, pairs, ranks)
  TravelOfTriangles reach;    ///< since the last search (triangles that can touch; search, ranks)
  ExposedVertices exposed;    ///< (vertices of the whole mesh; pairs, search)
  Ledger ledger;              ///< (search, stage, probes)
  double time = 0.0;          ///< of positions and forces  [s]  (move)
  double last_dt = 0.0;       ///< the step that led here  [s]  (move)
  double next_dt = 0.0;       ///< the step to come  [s]  (dt, search, insertion)
  std::int64_t step = 0;      ///< steps taken  [-]  (end of a step)
  std::int64_t searches = 0;  ///< [-]  (search)
  std::vector<RigidState> rigid;   ///< of supports; empty: none is ever free (stage, motions)
  std::vector<ServoState> servos;  ///< of supports; empty: the case has none (servos; servo)
  StageProgress stage;             ///< where it is among the stages of its case (stage)
  FluidState fluid;                ///< (fluid: spread_fluid(), every servo_every steps)
  BoltState bolts;                 ///< (loads: pull_bolts(), in every step)

  // Which part of the whole it is, and how its triangles lie in the mesh: constant between two
  // migrations.
  Domain domain;     ///< (ranks; its ghosts that follow their owners: search)
  WholeMesh mesh;    ///< (ranks)
  Halo tied_forces;  ///< ghosts whose corners move as one with own ones (ranks)
  mutable std::vector<SetHere>
      sets_here;              ///< places of Case::sets on this rank (sets; probes, servo)
  std::vector<Index> across;  ///< edge of the neighbour, -1: none here  [-]  (3 triangles; ranks)
  std::vector<Index> vertex;  ///< vertex of the whole mesh at each node  [-]  (3 triangles; ranks)
  Buffer<EdgeJoints> edges;   ///< joints of each triangle by slot  [-]  (triangles; set-up, ranks)
  Buffer<JointEnds> joint_ends;     ///< nodes  [-]  (joints; set-up, ranks)
  Buffer<Index> load_starts;        ///< first loaded edge of each triangle, and the end  [-]
                                    ///< (loaded triangles + 1; set-up, ranks)
  Buffer<LoadedEdge> loaded_edges;  ///< (loaded edges; set-up, ranks)
  Buffer<EdgeDashpots> dashpots;    ///< [Pa s/m]  (triangles, none if no edge absorbs; ranks)
  Bundles bundles;  ///< corners that may move as one (set-up, ranks); leaders: (derive, insertion)
  Buffer<Index> node_vertex;           ///< `vertex`, for kernels (3 triangles; search)
  Buffer<Index> side_across;           ///< `across`, for kernels (3 triangles; search)
  Buffer<std::uint8_t> ringed;         ///< 1: of each corner in `bundles` (3 triangles, none if
                                       ///< there are no bundles; derive)
  Buffer<std::uint8_t> border_vertex;  ///< Case::open_vertex, for kernels (vertices; search)

  // Results of a search.
  Incidence couple_incidence;                     ///< (triangles; search, derive)
  BroadPhase broad_phase;                         ///< scratch of the search (search)
  Buffer<fdem_shared::CouplePhase> couple_phase;  ///< (couples; search, derive, pairs)
  Buffer<Index> parent_joint;             ///< see CoupleForces  [-]  (couples; search, derive)
  Buffer<Index> reach_place;              ///< in `reach`, -1: a ghost, or it cannot touch  [-]
                                          ///< (triangles; search, derive)
  fdem_shared::HeldCouples held_couples;  ///< (held couples; servo)
  fdem_shared::SummedApart summed_apart;  ///< (groups of triangles; sums)

  // Results of a step, overwritten by the next one.
  Buffer<Motion> motions;        ///< of supports, mid-step  [m/s]  (motions; move)
  Buffer<LoadLaw> load_laws;     ///< Case::loads with their factors now (loads; loads)
  Buffer<Sym2> stress;           ///< where joints are extrinsic  [Pa]  (triangles; insertion)
  Buffer<double> overshoot;      ///< of dormant joints: stress over strength  [-]
                                 ///< (joints; insertion)
  Buffer<std::uint8_t> reached;  ///< 1: a dormant joint's strength is reached  [-]  (1; insertion)
  Buffer<fdem_shared::RowsOfCorners<fdem_shared::RowSums, 3>> rows;  ///< where corners move as one
                                                                     ///< (triangles; dt)
  double least_step = 0.0;   ///< stable one of all, when last evaluated  [s]  (dt)
  bool margin_used = false;  ///< some own triangle has used its margin up (move)
  bool marks_due = false;    ///< on a device: vertices are to be marked (move)
  /// Of each joint_pack joints; empty: all of them wait for ghosts. On the host. (joints /
  /// joint_pack; ranks; `done` within a step: pairs)
  std::vector<JointPack> joint_packs;

  // On a device.
  Buffer<Motion>
      last_motions;  ///< while `motions` are those of the step to come (motions; bundles)
  Buffer<AmplitudeTable> amplitudes;  ///< two of each motion, then of each load (advance)
  Buffer<double> amplitude_times, amplitude_factors;  ///< their entries  [s], [-]  (advance)
  Buffer<Vec2> prescribed_velocity;                   ///< [m/s]  (motions; advance, servo)
  Buffer<StepClock> clock;                            ///< time there (2; move)
  /// Of a move launched at once: 1 if margin_used, in one process if a search is due; on ranks bit
  /// k if flag k of ExposedVertices::changed is set. (2; move)
  Buffer<std::int32_t> device_flags;
  fdem_shared::KeptList busy,
      busy_joints;  ///< couples, joints (search, derive; pairs, sums)
  StepGraph graph;  ///< of a few steps (advance)
};

/// Moves a world's arrays to another space; derive() must follow.
void move_to(World& w, Space space);

/// A world at rest in its first state, forces evaluated. @throws InputError naming what does not
/// fit
World make_world(const Config& config, const Model& model, const Exec& exec);

/// The place of each triangle's law in Case::laws.
inline View<const Index> laws_of(const World& w) {
  return w.given->in_situ.graded() ? w.triangles.id.view() : w.triangles.material.view();
}

/// Lets the world go on by another stage of its case: gravity, damping, friction, supports, loads.
/// The state stays as it is. @throws InputError if supports contradict each other
void configure(World& w, const Config& config);
/// Gravity alone: the ledger asks what a change of it is worth.
void set_gravity(World& w, const Vec2& gravity);

/// Fills what follows from the state, after loading.
void derive(World& w);
void derive_couples(World& w);
/// The vertex of each node where kernels can read it; it changes only where triangles move between
/// ranks.
/// Who moves with whom, from the stages of the joints.
void derive_bundles(World& w);

/// One step: the points of Lukas 2014, section 2.
void step(World& w);
/// One step on the host; on a device as many as a few hundredths of a second hold, ending at
/// `stop`.
Advanced advance(World& w, const StopAt& stop);
/// Velocities of supports at the middle of the step to come, into World::motions.
void list_motions(World& w);
/// As list_motions(), between two steps, for those who look at velocities there: rigid bodies then
/// have those of the step to come. All ranks call it.
void foresee_motions(World& w);
/// Rigid bodies of a new world, and those that a stage sets free. All ranks call it.
void start_rigid_bodies(World& w, const Config& config);
void take_up_rigid_bodies(World& w);

/// The parts of a step that all runs share (fdem/stepping/step.hpp).
/// Asks all ranks whether couples must be searched for, and hears what they say.
void ask_ranks_for_search(World& w);
bool couples_are_due(World& w);
MarginRule margin_rule(const World& w);
/// Takes marks over without a search, if it can; expects those to come.
bool follow_marks(World& w);
void expect_marks(World& w);
void find_couples(World& w);
void wake_joints(World& w);
/// Whether other elements than those that are summed apart are worth a sum and a move at one go.
bool moves_most_at_once(World& w);
/// Case::free_step of a whole model.  [s]
double free_time_step(World& w);
/// Safe share of the stable step of all triangles, rounded down to six bits.  [s]
double choose_time_step(World& w);
/// The step to come, or less where these triangles allow less: after their joints have changed.
double shortened_time_step(World& w, const Buffer<Index>& triangles);
/// Shortened by the elements in reach that can touch by the marks of now.
double step_shortened_by_marks(World& w);
void evaluate_forces(World& w);

Kick kick(const World& w);
StableStep stable_step(const World& w);

AllowedStep allowed_step(const World& w);

/// Starts the ledger at the present state.
void begin_ledger(World& w);

/// Energies that a part holds and has spent, of what it owns, as they are now, when they are asked
/// for: until then the host can go on.
std::function<Energies()> held_later(const World& w);
inline Energies held(const World& w) {
  return held_later(w)();
}
/// Where every joule is, per unit thickness.
EnergySplit energy_split(const World& w);
/// The balance of all energies; keeps the largest energy seen, for the relative error.
EnergySplit energies(World& w);

}  // namespace breccia::fdem
