#pragma once
// Everything a DEM run consists of between two steps.

#include <string>
#include <vector>

#include "core/energy.hpp"
#include "core/incidence.hpp"
#include "core/stages.hpp"
#include "core/step_clock.hpp"
#include "core/travel.hpp"
#include "dem/element_kernels.hpp"
#include "dem/links/all.hpp"
#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "dem/setup/supports.hpp"
#include "dem/stepping/kernel_lanes.hpp"
#include "domain/domain.hpp"
#include "domain/set_here.hpp"
#include "exec/step_graph.hpp"
#include "exec/timers.hpp"

namespace breccia::dem {

/// How the threads of the host share concrete links and elements: each takes a run of elements with
/// the links that start there. Links lead from lower to higher elements, so once a thread has done
/// the links of a run, the sums of its elements are complete, but for those that an earlier run
/// reaches.
struct LinkPlan {
  std::vector<Index> begin;  ///< first element of each thread's run, and the end
  std::vector<Index>
      first_private;         ///< first element of each run that no link of an earlier run reaches
  Index reach = 0;           ///< from the lower to the higher end of a link, at most
  std::vector<Index> tiles;  ///< first element of each tile, and the end
  std::vector<std::vector<DeferredForce>> deferred;  ///< of each run, in the order of its links
};
/// Elements whose links of all groups are done before the next ones, by global id: runs begin at
/// tiles, so that the order of sums is the same for any number of threads and ranks.
inline constexpr Index sweep_tile = 256;

/// A named set of elements that probes read: a body or a support.
struct ElementSet {
  std::string name;
  Buffer<Index> members;  ///< in the whole model, ascending
  SetHere here{};         ///< in a rank's part, for its probes
};

/// Numbers that stay as the case gave them.
struct Parameters {
  TimeConfig time;
  SearchConfig search;
  Vec3 gravity{};
  double local_damping = 0.0;
  double mean_radius = 0.0;     ///< of all elements  [m]
  double largest_margin = 0.0;  ///< half the smallest radius of linked concrete  [m]
  ContactLaw contact{};
  double contact_step = no_limit;  ///< that resolves a contact of two like elements  [s]
  Index materials = 0;
  std::vector<std::uint8_t> bars;  ///< by material: 1 where its elements are bars
};

struct World : LinkSets {
  /// Empty, every array in the space of `how`.
  explicit World(const Exec& how);

  Exec exec;
  Lanes lanes;
  Parameters parameters;

  // State: what a checkpoint holds.
  Elements elements;  // and the links, in LinkSets
  Contacts contacts;  ///< between elements
  WallContacts wall_contacts;
  Travel travel;  ///< since the last search
  std::vector<Wall> walls;
  Ledger ledger;
  double time = 0.0;     ///< of positions and forces  [s]
  double last_dt = 0.0;  ///< the step that led here  [s]
  double next_dt = 0.0;  ///< the step to come  [s]
  std::int64_t step = 0;
  std::int64_t searches = 0;
  std::vector<ServoState> servos;  ///< of walls, then of supports; empty: the case has none
  StageProgress stage;             ///< where it is among the stages of its case

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
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(contact_pairs, wall_pairs, motions, motion_times, motion_factors, linked_starts,
         linked_partners, linked_links, bar_actions, domain.owned_there,
         domain.migration_reference);
  }
  /// Those that derive() and a search fill.
  template <class Visit>
  void each_derived(Visit&& visit) {
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(bar_incidence, contact_incidence, broad_phase, held_partners, contact_actions, link_sums,
         critical, rows_a, rows_b, link_actions.in_double, link_actions.in_single, device_walls,
         clock, beyond);
    each_set([&](auto& set) { each(set.on_device.laws, set.on_device.ends); });
  }

  // What follows from the case.
  std::vector<std::string> warnings;  ///< what set-up found doubtful, for people
  std::vector<ElementSet> sets;
  std::vector<std::string> wall_names;
  std::vector<double> wall_friction;  ///< below 0: that of all contacts  [-]
  Buffer<ContactPair> contact_pairs;  ///< by two materials
  Buffer<ContactPair> wall_pairs;     ///< by one material
  GivenMotions prescribed;            ///< of supports, then of walls
  Buffer<Motion> motions;             ///< the same where kernels can read them
  Buffer<double> motion_times, motion_factors;
  // All links by their ends, rows of compressed form: an element's place and global id ascend
  // alike.
  Buffer<Index> linked_starts;    ///< first link of each lower end, and the number of links
  Buffer<Index> linked_partners;  ///< the higher end of each
  Buffer<Index> linked_links;     ///< its place among the links of all kinds

  // Which part of the whole it is.
  Domain domain;

  // What follows from the state.
  Buffer<Index> held_partners;  ///< linked_partners, -1 where the link has let go; for a search
  Incidence bar_incidence, contact_incidence;  ///< bars: all links but swept ones, kind by kind
  LinkPlan link_plan;
  BroadPhase broad_phase;
  std::vector<Index> wall_begin;  ///< first contact of each wall, and the end
  Buffer<PairForce> bar_actions, contact_actions;
  Buffer<LinkSums> link_sums;  ///< of each element, zero between steps
  Buffer<double> critical;     ///< [s2]
  bool margin_used = false;    ///< some element has used its margin up

  // On a device.
  LinkRows rows_a, rows_b;         ///< concrete links that start, and that end, at each element
  Stored<ActionsOf> link_actions;  ///< of concrete links
  Buffer<Wall> device_walls;
  Buffer<StepClock> clock;
  Buffer<std::int32_t> beyond;  ///< one: 1 if an element has used its margin up; ranks only
  StepGraph graph;              ///< of a few steps
};

/// A world at rest in its first state, forces evaluated. @throws InputError naming what does not
/// fit
World make_world(const Config& config, const Model& model, const Exec& exec);

/// Lets the world go on by another stage of its case: gravity, damping, friction, supports, walls.
/// The state stays as it is. @throws InputError if supports contradict each other
void configure(World& w, const Config& config);

/// Hands World::prescribed to kernels.
void place_motions(World& w);

/// All links by their ends, so that a search can leave them out while they hold.
void set_linked_pairs(World& w);

/// Fills what follows from the state: incidence lists, scratch arrays. After set-up and loading.
void derive(World& w);
/// The same for contacts alone, after a search.
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

/// What pair kernels read of the elements.
ElementsView elements_view(const World& w);
/// Kick of the elements at the time of the forces.
Kick kick(const World& w);

/// Walls where kernels can read them.
View<const Wall> walls_view(const World& w);

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
