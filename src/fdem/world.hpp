#pragma once
// Everything an FDEM run consists of between two steps.

#include <string>
#include <vector>

#include "core/broad_phase.hpp"
#include "core/drift.hpp"
#include "core/energy.hpp"
#include "core/stages.hpp"
#include "core/step_clock.hpp"
#include "core/travel.hpp"
#include "domain/domain.hpp"
#include "domain/set_here.hpp"
#include "exec/lanes.hpp"
#include "exec/step_graph.hpp"
#include "exec/timers.hpp"
#include "fdem/setup/config.hpp"
#include "fdem/setup/effective.hpp"
#include "fdem/setup/model.hpp"
#include "fdem/triangles/loads.hpp"

namespace breccia::fdem {

/// A named set of corners that probes read: a body, a support or a line of the mesh.
struct NodeSet {
  std::string name;
  std::vector<Index> nodes;  ///< 3 triangle + corner, ascending, in the whole mesh
  SetHere here{};            ///< in a rank's part, for its probes
};

/// Where the triangles that can touch stood at the last search, and how far each may go from there,
/// the drift taken off.
struct TravelOfTriangles {
  Buffer<Index> triangle;     ///< those that can touch, ascending by global id
  Buffer<Corners> reference;  ///< their corners at the search  [m]
  Buffer<double> margin;      ///<  [m]
  PlaneDrift drift;

  template <class Visit>
  void each_field(Visit&& field) {
    field("triangle", "-", triangle);
    field("reference", "m", reference);
    field("margin", "m", margin);
  }
};

/// Where joints have opened. A vertex becomes contact-active at a step fixed by the physics, not at
/// the next search, so results do not depend on when searches happen.
struct ExposedVertices {
  Buffer<std::uint8_t> changed;  ///< flags of Change since the vertices were marked last
  Buffer<std::uint8_t> vertex;   ///< 1: a joint at this vertex of the mesh is damaged
};

/// What a rank knows of the whole mesh besides its part of it.
struct WholeMesh {
  Buffer<Index> joint_number;      ///< of the local joints in the whole mesh, ascending
  std::vector<std::uint8_t> tied;  ///< 1: some corners at this vertex move as one, or did
  std::vector<LoadedEdge> loaded;  ///< by global id
  bool bundled = false;            ///< there are such vertices
  bool absorbs = false;            ///< some edges take waves up
  bool preset = false;             ///< joints keep an opening at which they were joined
};

/// Joints side by side, and whether they can do without ghosts of other ranks' triangles.
inline constexpr Index joint_pack = 8;
enum class JointPack : std::uint8_t {
  outer,  ///< some of them act on a copy
  inner,  ///< all of them between two own triangles
  done    ///< and evaluated in this step: they are whole and stay so
};

/// Numbers that stay as the case gave them.
struct Parameters {
  TimeConfig time;
  Vec2 gravity{};
  Sym2 in_situ{};  ///< stress at the start  [Pa]
  double local_damping = 0.0;
  double mean_edge = 0.0;  ///<  [m]
  double skin = 0.0;       ///< margin of the search between two triangles at rest  [m]
  bool conservative = false;
  Index materials = 0;
};

struct World {
  explicit World(const Exec& how);

  Exec exec;
  Lanes lanes;
  Parameters parameters;

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
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(triangles.external, joints.force.in_double, joints.force.in_single, joints.preset,
         exposed.changed, exposed.vertex, laws, bonds, contact_pairs, holds, load_starts,
         loaded_edges, dashpots, bundles.starts, bundles.nodes, bundles.leader, joint_ends, edges,
         motions, last_motions, load_laws, stress, overshoot, reached, domain.owned_there,
         domain.migration_reference);
  }
  /// Those that derive() and a search fill.
  template <class Visit>
  void each_derived(Visit&& visit) {
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(couple_incidence, broad_phase, parent_joint, node_vertex, edge_across, border_vertex,
         amplitudes, amplitude_times, amplitude_factors, prescribed_velocity, reach_place, clock,
         device_flags);
  }

  // State: what a checkpoint holds.
  Triangles triangles;
  Joints joints;
  Couples couples;
  TravelOfTriangles reach;
  ExposedVertices exposed;
  Ledger ledger;
  double time = 0.0;     ///< of positions and forces  [s]
  double last_dt = 0.0;  ///< the step that led here  [s]
  double next_dt = 0.0;  ///< the step to come  [s]
  std::int64_t step = 0;
  std::int64_t searches = 0;
  std::vector<ServoState> servos;  ///< of supports; empty: the case has none
  StageProgress stage;             ///< where it is among the stages of its case

  // What follows from the case.
  std::vector<std::string> groups;
  std::vector<EffectiveRock> rocks;   ///< each material with its joints
  std::vector<std::string> warnings;  ///< what set-up found doubtful, for people
  std::vector<NodeSet> sets;          ///< bodies first
  Buffer<ElasticTriangle> laws;
  Buffer<JointBond> bonds;
  Buffer<ContactPair> contact_pairs;
  Buffer<Hold> holds;
  std::vector<PrescribedMotion> prescribed;
  std::vector<ServoMotion> servo_motions;
  std::vector<LoadLaw> loads;
  std::vector<LoadAmplitude> load_amplitudes;
  Buffer<Index> load_starts;
  Buffer<LoadedEdge> loaded_edges;
  Buffer<EdgeDashpots> dashpots;  ///< of each triangle, where some edge absorbs
  Bundles bundles;
  Buffer<JointEnds> joint_ends;
  Buffer<EdgeJoints> edges;   ///< joints of each triangle by slot
  bool extrinsic = false;     ///< some joints are dormant, or were
  std::vector<Index> across;  ///< the same edge of the neighbour, -1: there is none
  std::vector<Index> vertex;  ///< vertex of the mesh at each node
  /// What a vertex of the mesh touches: bit 0 the border or an edge that nothing joins, bit 1 such
  /// an edge between two triangles.
  std::vector<std::uint8_t> open_vertex;

  // Which part of the whole it is.
  Domain domain;
  WholeMesh mesh;
  Halo tied_forces;  ///< ghosts whose corners move as one with own ones
  /// Of each joint_pack joints; empty: all of them wait for ghosts. On the host.
  std::vector<JointPack> joint_packs;

  // What follows from the state.
  Buffer<Index> node_vertex;           ///< `vertex`, where kernels can read it
  Buffer<Index> edge_across;           ///< `across`, likewise
  Buffer<std::uint8_t> border_vertex;  ///< `open_vertex`, likewise
  Buffer<Motion> motions;
  Buffer<LoadLaw> load_laws;
  Buffer<Sym2> stress;           ///< of each triangle, where joints are extrinsic  [Pa]
  Buffer<double> overshoot;      ///< of dormant joints: stress over strength  [-]
  Buffer<std::uint8_t> reached;  ///< 1: a dormant joint's strength is reached
  Buffer<Index> parent_joint;    ///< of each couple, see CoupleForces
  Buffer<Index> reach_place;     ///< of each triangle in `reach`, -1: a ghost, or it cannot touch
  bool margin_used = false;      ///< some own triangle has used its margin up
  Incidence couple_incidence;
  BroadPhase broad_phase;

  // On a device.
  Buffer<Motion> last_motions;        ///< while `motions` are those of the step to come
  Buffer<AmplitudeTable> amplitudes;  ///< two of each prescribed motion, then of each load
  Buffer<double> amplitude_times, amplitude_factors;
  Buffer<Vec2> prescribed_velocity;
  Buffer<StepClock> clock;
  /// Of a move launched at once: 1 if margin_used; and bit k if flag k of ExposedVertices::changed
  /// is set.
  Buffer<std::int32_t> device_flags;
  StepGraph graph;  ///< of a few steps
};

/// Moves a world's arrays to another space; derive() must follow.
void move_to(World& w, Space space);

/// A world at rest in its first state, forces evaluated. @throws InputError naming what does not
/// fit
World make_world(const Config& config, const Model& model, const Exec& exec);

/// Lets the world go on by another stage of its case: gravity, damping, friction, supports, loads.
/// The state stays as it is. @throws InputError if supports contradict each other
void configure(World& w, const Config& config);

/// Fills what follows from the state, after loading.
void derive(World& w);
void derive_couples(World& w);
/// The vertex of each node where kernels can read it; it changes only where triangles move between
/// ranks.
View<const Index> node_vertices(World& w);
/// Who moves with whom, from the stages of the joints.
void derive_bundles(World& w);

/// One step: the points of Lukas 2014, section 2.
void step(World& w);
/// One step on the host; on a device as many as a few hundredths of a second hold, ending at
/// `stop`.
Advanced advance(World& w, const StopAt& stop);
/// Velocities of supports at the middle of the step to come, into World::motions.
void list_motions(World& w);

/// The parts of a step that all runs share (fdem/stepping/step.hpp).
/// Asks all ranks whether couples must be searched for, and hears what they say.
void ask_for_search(World& w);
bool couples_are_due(World& w);
MarginRule margin_rule(const World& w);
void find_couples(World& w);
void insert_joints(World& w);
/// Safe share of the stable step of all triangles, rounded down to six bits.  [s]
double choose_time_step(const World& w);
/// The step to come, or less where these triangles allow less: after their joints have changed.
double shortened_time_step(const World& w, const Buffer<Index>& triangles);
void evaluate_forces(World& w);

Kick kick(const World& w);
StableStep stable_step(const World& w);

/// The time step from the least stable step of all triangles: it falls at once, when something
/// comes near, and grows slowly.
struct AllowedStep {
  double safety, max_step;  ///< share of the stable step  [-], limit  [s]

  BR_HD double operator()(double least, double last_dt) const {
    double dt = min(safety * least, max_step);
    if (last_dt > 0.0) dt = min(dt, 1.05 * last_dt);
    return rounded_down(dt);
  }
};
AllowedStep allowed_step(const World& w);

/// Starts the ledger at the present state.
void begin_ledger(World& w);

/// Where every joule is, per unit thickness.
struct EnergySplit {
  EnergyBalance balance;
  double fracture_open = 0.0, fracture_slide = 0.0;  ///< of fracture, by mode  [J/m]
};
EnergySplit energy_split(const World& w);
/// The same, and keeps the largest energy seen, for the relative error.
EnergySplit energies(World& w);

}  // namespace breccia::fdem
