#pragma once
// Everything a DEM run consists of between two steps.

#include <vector>

#include "core/energy.hpp"
#include "core/incidence.hpp"
#include "core/read_only.hpp"
#include "core/stages.hpp"
#include "core/step_clock.hpp"
#include "core/travel.hpp"
#include "dem/case.hpp"
#include "dem/element_kernels.hpp"
#include "dem/links/all.hpp"
#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "dem/setup/supports.hpp"
#include "dem/stepping/kernel_lanes.hpp"
#include "dem/tiles/tile_plan.hpp"
#include "domain/domain.hpp"
#include "domain/set_here.hpp"
#include "exec/step_graph.hpp"
#include "exec/timers.hpp"

namespace breccia::dem {

/// How the threads of the host share concrete links (and facets) and elements: each takes a run of
/// elements with the links that start there. Links lead from lower to higher elements, so once a
/// thread has done the links of a run, the sums of its elements are complete, but for those that an
/// earlier run reaches.
struct LinkPlan {
  std::vector<Index> begin;  ///< first element of each thread's run, and the end
  std::vector<Index>
      first_private;         ///< first element of each run that no link of an earlier run reaches
  Index reach = 0;           ///< from the lower to the higher end of a link, at most
  std::vector<Index> tiles;  ///< first element of each tile, and the end
  std::vector<std::vector<DeferredForce>> deferred;  ///< of each run, in the order of its links
  bool facets = false;  ///< facets of LDPM are shared likewise, not summed by bar_incidence
};
/// Elements whose links of all groups are done before the next ones, by global id: runs begin at
/// tiles, so that the order of sums is the same for any number of threads and ranks.
inline constexpr Index sweep_tile = 256;

/// A wall with mass: a part of a run's state, beside its place and velocity.
struct FreeWallState {
  Vec3 force{};            ///< of contacts, at the time of the positions  [N]
  double stiffness = 0.0;  ///< of its contacts as the step asks for it, their dashpots in it  [N/m]
  double work = 0.0;       ///< of its given force until half of the last step  [J]
  // If it turns:
  Vec3 torque{};    ///< of contacts about the centre of mass, at the time of the positions  [N m]
  Vec3 velocity{};  ///< of the centre of mass, half a step before now  [m/s]
  Vec3 angular{};   ///< angular momentum about it, likewise, in the case  [kg m2/s]
};

/// Each line tells meaning and unit, then (length; who writes it). Lengths: elements, contacts, ...
/// of this rank, ghosts included; no length: one number. Writers, in the order of a run:
///
///   set-up   make_world()
///   stage    configure(), where a stage of the case begins and after loading a checkpoint
///   servo    correct_servos(), every servo_every steps
///   move, search, pairs, sums, walls, dt
///            within a step, by dem/stepping/step.hpp: moving elements and walls; find_contacts();
///            forces of links and contacts; sums of elements; forces of walls; the next step
///   ranks    when elements change ranks (dem/ranks.cpp) or the world changes its space
///   derive   derive(), after set-up, loading and ranks; advance: advance(), on a device
///
/// An array that ranks write moves with its element, link or contact.
struct World : LinkSets {  // links: (links of a law; set-up, pairs, ranks), see dem/links/
  /// Empty, every array in the space of `how`.
  explicit World(const Exec& how);

  Exec exec;             ///< (ranks: its space)
  Lanes lanes;           ///< (set-up)
  ReadOnly<Case> given;  ///< constants: dem/case.hpp (set-up, stage)

  // Prescribed motions: constant but for those that servos lead.
  GivenMotions prescribed;        ///< of supports, then of walls (set-up, stage, servo)
  Buffer<Motion> motions;         ///< their motions, for kernels (motions; set-up, stage, servo)
  Buffer<LedBy> led;              ///< which servos lead them (motions; set-up, stage)
  Buffer<double> motion_times;    ///< their tables, for kernels  [s]  (entries; set-up, stage)
  Buffer<double> motion_factors;  ///< likewise  [-]  (entries; set-up, stage)

  // State: what a checkpoint holds, and the links in LinkSets.
  Elements elements;                      ///< (elements; see its lines)
  Contacts contacts;                      ///< between elements (contacts; search, pairs, ranks)
  WallContacts wall_contacts;             ///< (contacts with walls; search, walls, ranks)
  Travel travel;                          ///< since the last search (elements; search, ranks)
  std::vector<Wall> walls;                ///< (walls; set-up, move; its way, search and stage, too)
  std::vector<FreeWallState> free_walls;  ///< empty: none has mass (walls; move, walls)
  Ledger ledger;                          ///< (search, stage, probes)
  double time = 0.0;                      ///< of positions and forces  [s]  (move)
  double last_dt = 0.0;                   ///< the step that led here  [s]  (move)
  double next_dt = 0.0;                   ///< the step to come  [s]  (dt)
  std::int64_t step = 0;                  ///< steps taken  [-]  (end of a step)
  std::int64_t searches = 0;              ///< [-]  (search)
  std::vector<ServoState> servos;  ///< of walls, then of supports; empty: none (servos; servo)
  StageProgress stage;             ///< where it is among the stages of its case (stage)

  /// Visits the arrays that kernels read: state, and what follows from the case.
  template <class Visit>
  void each_kept(Visit&& visit) {
    const auto state = [&](auto& s) {
      s.each_field([&](const char*, const char*, auto& array) { visit(array); });
    };
    state(elements);
    each_set([&](auto& set) { state(set); });
    state(contacts);
    state(wall_contacts);
    state(travel);
    given.each_array(visit);
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(motions, led, motion_times, motion_factors, linked_starts, linked_partners, linked_links,
         bar_actions, domain.owned_there, domain.migration_reference);
  }
  /// Visits the arrays that derive() and a search fill.
  template <class Visit>
  void each_derived(Visit&& visit) {
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(bar_incidence, contact_incidence, broad_phase, held_partners, contact_actions, link_sums,
         critical, rows_a, rows_b, link_actions.in_double, link_actions.in_single, device_walls,
         clock, beyond);
    each_set([&](auto& set) { each(set.on_device.laws, set.on_device.ends); });
    each(concrete.on_device.in_single);
    each(ldpm.edges.of, ldpm.edges.leads, ldpm.edges.stiffness, ldpm.edges.shares);
  }

  // Which part of the whole it is, and where its elements lie: constant between two migrations.
  Domain domain;                   ///< (ranks; its ghosts that follow their owners: search)
  std::vector<SetHere> sets_here;  ///< places of Case::sets on this rank (sets; probes, servo)
  std::vector<SetHere> tied_here;  ///< likewise of Case::tied (supports; servo)
  // All links by their ends, rows of compressed form: an element's place and global id ascend
  // alike.
  Buffer<Index> linked_starts;    ///< first link of each lower end, and the end  [-]
                                  ///< (elements + 1; set-up, ranks)
  Buffer<Index> linked_partners;  ///< place of the higher end  [-]  (links; set-up, ranks)
  Buffer<Index> linked_links;     ///< place among links of all kinds  [-]  (links; set-up, ranks)
  LinkPlan link_plan;             ///< how threads share swept links; `deferred`: sums (derive)
  Incidence bar_incidence;        ///< of all links but swept ones, kind by kind, of facets
                                  ///< the first of each edge (elements; derive)

  // Results of a search.
  Buffer<Index> held_partners;    ///< linked_partners, -1 where the link has let go  [-]
                                  ///< (links; search)
  Incidence contact_incidence;    ///< (elements; search, derive)
  BroadPhase broad_phase;         ///< scratch of the search (search)
  std::vector<Index> wall_begin;  ///< first contact of each wall, and the end  [-]
                                  ///< (walls + 1; search, derive)

  // Results of a step, overwritten by the next one.
  Buffer<PairForce> bar_actions;      ///< zero but for the first facet of an
                                      ///< edge  [N, N m, N/m]  (links but swept ones; pairs, ranks)
  Buffer<PairForce> contact_actions;  ///< zero where apart; as many as contacts, but where parts
                                      ///< were brought together  [N, N m, N/m]  (contacts; pairs)
  Buffer<LinkSums> link_sums;  ///< zero between steps  [N, N m, N/m]  (elements; pairs, sums)
  Buffer<double> critical;     ///< inertia over stiffness  [s2]  (elements; sums, walls)
  bool margin_used = false;    ///< some element has used its margin up (move)

  // On a device.
  LinkRows rows_a, rows_b;  ///< concrete links that start, that end, at each (elements; derive)
  Stored<ActionsOf> link_actions;  ///< [N, N m, N/m]  (concrete links; pairs)
  Buffer<Wall> device_walls;       ///< `walls`, for kernels (walls; move, search)
  Buffer<StepClock> clock;         ///< time there (2; move)
  Buffer<std::int32_t> beyond;     ///< 1: an element has used its margin up; ranks only (1; move)
  StepGraph graph;                 ///< of a few steps (advance)
  Tiles tiles;                     ///< where a device's own memory holds the model (advance)
};

/// A world at rest in its first state, forces evaluated. @throws InputError naming what does not
/// fit
World make_world(const Config& config, const Model& model, const Exec& exec);

/// Lets the world go on by another stage of its case: gravity, damping, friction, supports, walls.
/// The state stays as it is. @throws InputError if supports contradict each other
void configure(World& w, const Config& config);
/// Gravity alone: the ledger asks what a change of it is worth.
void set_gravity(World& w, const Vec3& gravity);

/// Hands the laws of links to kernels that take all groups at once.
void list_laws(World& w);

/// Hands World::prescribed to kernels.
void place_motions(World& w);

/// All links by their ends, so that a search can leave them out while they hold.
void set_linked_pairs(World& w);

/// Fills what follows from the state: incidence lists, scratch arrays. After set-up and loading.
void derive(World& w);
/// Fills what follows from contacts alone, after a search.
void derive_contacts(World& w);

/// Moves a world's arrays to another space; derive() must follow.
void move_to(World& w, Space space);

/// One step of the scheme of Durand et al. 2012, Figure 1 and section 3.3.
void step(World& w);

/// One step on the host; on a device as many as a few hundredths of a second hold, ending at
/// `stop`.
Advanced advance(World& w, const StopAt& stop);
/// Walls, and the host's time, at the end of a step to come.
void move_walls(World& w);
/// Asks all ranks whether contacts must be searched for, and hears what they say.
void ask_for_search(World& w);
bool contacts_are_due(const World& w);
MarginRule margin_rule(const World& w);
void find_contacts(World& w);

/// Forces and time step at the time of the positions: once, before the first step.
void evaluate_forces(World& w);

/// Element arrays that pair kernels read.
ElementsView elements_view(const World& w);
/// Kick of the elements at the time of the forces.
Kick kick(const World& w);

/// Walls where kernels can read them.
View<const Wall> walls_view(const World& w);
/// The triangles of a wall; empty: it has another shape.
WallMesh mesh_of(const World& w, Index wall);

/// The time step from the least inertia over stiffness of all elements (Durand 2012, section 4.4).
struct StepRule {
  double safety, max_step, contact_step;  ///< share of the critical step  [-], limits  [s]

  BR_HD double operator()(double least, double last_dt) const {
    // sqrt(2): two neighbours in opposite motion (docs/theory.md, time step).
    double dt = safety * sqrt(2.0 * least);
    dt = min(dt, min(max_step, contact_step));
    if (last_dt > 0.0) dt = min(dt, 1.05 * last_dt);  // falls at once, grows slowly
    return rounded_down(dt);
  }
};
StepRule step_rule(const World& w);

/// Where every joule is; keeps the largest energy for the relative error.
EnergyBalance balance(World& w);

}  // namespace breccia::dem
