#pragma once
// Content of one tile in the memory of a multiprocessor: it comes from the arrays of the world and
// goes back there.

#include "dem/tiles/tile_case.hpp"

namespace breccia::dem {

/// A tile's part of a world. Functions of several threads take the thread's number among them.
/// @tparam Number  as ConcreteLinkForces
template <class Number>
struct TileContent {
  using Stores = StoredAs<Number>;
  const TileCase<Number>& all;
  Index number;
  const TileMemory<Number>& memory;
  const Tile& tile;

  /// @param base  of the tile's memory, which lay_out() has laid out
  BR_HD TileContent(const TileCase<Number>& of, Index tile_number, std::byte* base)
      : all(of),
        number(tile_number),
        memory(*reinterpret_cast<const TileMemory<Number>*>(base)),
        tile(memory.tile) {}
  /// @param lists  as the last search has left them
  BR_HD static void lay_out(const TileCase<Number>& of, const TileLists& lists, Index tile_number,
                            std::byte* base) {
    auto& memory = *reinterpret_cast<TileMemory<Number>*>(base);
    memory.lay_out(lists.tiles.data[tile_number], of.tiles.groups);
    if (memory.tile.constants_outside) memory.constants = of.constants + memory.tile.first_link;
  }

  /// Brings everything from the arrays of the world; nothing of what others may write after
  /// enter().
  BR_HD void enter(const TileLists& lists, Index thread, Index threads) const {
    bring_elements(lists, thread, threads);
    meet_in_tile();
    order_links(thread, threads);
    bring_links(thread, threads);
    bring_lists(lists, thread, threads);
  }

  /// Leaves everything that has changed.
  BR_HD void leave(Index thread, Index threads) const {
    for (Index e = thread; e < tile.own; e += threads) {
      const Index g = memory.place[e];
      all.move.state[g] = memory.state[e];
      all.move.orientation[g] = memory.orientation[e];
      all.move.damping_work[g] = memory.damping_work[e];
      all.move.load_work[g] = memory.load_work[e];
      all.force[g] = memory.load[e].force;
      all.torque[g] = memory.load[e].torque;
    }
    for (Index l = thread; l < tile.concrete; l += threads) {
      const TileLink link = memory.concrete[l];
      if (!is_own(link)) continue;
      const auto g = static_cast<Index>(link.number);
      all.concrete.length[g] = memory.length[l];
      all.concrete.opening[g] = memory.opening[l];
      all.concrete.shear.store(g, shear()[l]);
      all.concrete.moment.store(g, moment()[l]);
      if (!all.tiles.groups.damped) continue;
      all.concrete.branch_normal[g] = memory.branch_normal[l];
      all.concrete.branch_shear.store(g, branch_shear()[l]);
    }
    for (Index l = thread; l < tile.steel; l += threads)
      if (is_own(memory.steel[l]))
        all.steel.state[static_cast<Index>(memory.steel[l].number)] = memory.bar_state[l];
    for (Index l = thread; l < tile.interface; l += threads)
      if (is_own(memory.interface[l]))
        all.interface.state[static_cast<Index>(memory.interface[l].number)] = memory.bond_state[l];
  }
  /// Actions of bars and contacts outlast a step: those of the last one.
  BR_HD void leave_actions(Index thread, Index threads) const {
    for (Index k = thread; k < tile.contacts; k += threads) {
      const TileContact contact = memory.contacts[k];
      PairForce& to = (contact.side == 0 ? all.contacts : all.twins).actions.data[contact.pair];
      if (memory.acts[k] == 0)
        to = PairForce{};
      else if (memory.acts[k] <= tile.acting)
        to = *action_of(k);
    }
    for (Index l = thread; l < tile.bars(); l += threads) {
      const bool bond = l >= tile.steel;
      const TileLink link = bond ? memory.interface[l - tile.steel] : memory.steel[l];
      if (!is_own(link)) continue;
      const Index first = bond ? all.interface.first_action : all.steel.first_action;
      all.steel.actions[first + static_cast<Index>(link.number)] = memory.bar_actions[l];
    }
  }

 protected:
  template <class T, class Of>
  BR_HD static View<T> seen(const Placed<Of>& items, Index size) {
    View<T> view;
    view.data = items.data();
    view.size = size;
    return view;
  }
  template <class T>
  BR_HD static View<T> seen(const Placed<T>& items, Index size) {
    return seen<T, T>(items, size);
  }
  BR_HD bool is_own(const TileLink& link) const { return link.a < tile.own; }
  BR_HD PlanesView<Stores> shear() const {
    return {seen(memory.shear, 3 * tile.concrete), tile.concrete};
  }
  BR_HD PlanesView<Stores> moment() const {
    return {seen(memory.moment, 3 * tile.concrete), tile.concrete};
  }
  BR_HD PlanesView<float> branch_shear() const {
    return {seen(memory.branch_shear, 3 * tile.concrete), tile.concrete};
  }
  /// The action of a contact that has one in this step.
  BR_HD PairForce* action_of(Index k) const {
    const TileContact contact = memory.contacts[k];
    if (memory.acts[k] <= tile.acting) return memory.contact_actions + memory.acts[k] - 1;
    return (contact.side == 0 ? all.contacts : all.twins).actions.data + contact.pair;
  }

 private:
  BR_HD void bring_elements(const TileLists& lists, Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    for (Index e = thread; e < tile.elements(); e += threads) {
      const Index g = e < tile.own ? t.own[tile.first_own + e]
                      : e < tile.own + tile.linked
                          ? t.linked[tile.first_linked + e - tile.own]
                          : lists.touched[tile.first_touched + e - tile.own - tile.linked];
      // All is read before the first is written, so that it is on its way at one time.
      const ElementState state = read_record(all.move.kick.state, g);
      const double mass = all.move.kick.mass[g], inertia = all.move.kick.inertia[g];
      const std::int16_t material = all.contacts.material[g], motion = all.move.kick.motion[g];
      const std::uint8_t fixed = all.move.kick.fixed[g];
      const ElementLoad load{all.move.kick.force[g], all.move.kick.torque[g]};
      const bool own = e < tile.own;
      const Quaternion orientation = own ? all.move.orientation[g] : Quaternion{};
      const Vec3 reference = own ? all.move.used.reference[g] : Vec3{};
      const double margin = own ? all.move.used.margin[g] : 0.0,
                   damping_work = own ? all.move.damping_work[g] : 0.0,
                   load_work = own ? all.move.load_work[g] : 0.0;
      memory.place[e] = g;
      memory.state[e] = state;
      memory.mass[e] = mass;
      memory.inertia[e] = inertia;
      memory.material[e] = material;
      memory.motion[e] = motion;
      memory.fixed[e] = fixed;
      if (!own) {
        memory.received[e - tile.own] = load;
        continue;
      }
      memory.load[e] = load;
      memory.orientation[e] = orientation;
      memory.reference[e] = reference;
      memory.margin[e] = margin;
      memory.damping_work[e] = damping_work;
      memory.load_work[e] = load_work;
      memory.over_mass[e] = 1.0F / static_cast<float>(mass);
      const auto rough = static_cast<float>(margin);
      memory.room[e] = rough * rough / 1.0001F;
    }
  }
  /// How much a step asks of a link's law: of softened ones most, of broken ones apart nothing.
  BR_HD int stage_of(const TileLink& link) const {
    constexpr int softened = 0, touching = 1, whole = 2, apart = 3;
    const auto g = static_cast<Index>(link.number);
    const Stores opening = all.concrete.opening[g];
    const double stiffness = all.concrete.stiffness[g], area = all.concrete.area[g],
                 length = all.concrete.length[g];
    const double strength = all.concrete_laws[static_cast<Index>(link.group)].tensile_strength;
    if (opening >= 0.0) return stiffness * opening < strength * area ? whole : softened;
    const Vec3 way = memory.state[link.b].position - memory.state[link.a].position;
    constexpr double soon = 1.01;  // may touch in the steps to come
    return dot(way, way) < soon * soon * length * length ? touching : apart;
  }
  /// Concrete links lie by these stages, since a warp takes the longest way that any of its links
  /// needs; in the order of the tile's list otherwise. No sum depends on where they lie.
  BR_HD void order_links(Index thread, Index threads) const {
    const Index links = tile.concrete, runs = tile_runs(links);
    for (Index l = thread; l < links; l += threads)
      memory.stage[l] = static_cast<std::uint8_t>(stage_of(all.tiles.links[tile.first_link + l]));
    meet_in_tile();
    for (Index k = thread; k < tile_stages * runs; k += threads)
      memory.stages[k] = in_run(k % runs, tile_run_length, k / runs);
    meet_in_tile();
    for (Index l = thread; l < links; l += threads) {
      const Index run = l / tile_run_length, stage = memory.stage[l];
      Index before = in_run(run, l % tile_run_length, stage);
      for (Index k = 0; k < stage * runs + run; ++k) before += memory.stages[k];
      memory.order[l] = static_cast<TilePlace>(before);
    }
    meet_in_tile();
  }
  /// Links of a stage among the first ones of a run.
  BR_HD Index in_run(Index run, Index first, Index stage) const {
    Index count = 0;
    for (Index l = run * tile_run_length; first > 0 && l < tile.concrete; ++l, --first)
      count += memory.stage[l] == stage ? 1 : 0;
    return count;
  }
  BR_HD void bring_links(Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    for (Index l = thread; l < tile.concrete; l += threads) {
      const TileLink link = t.links[tile.first_link + l];
      const auto g = static_cast<Index>(link.number);
      using Constant = typename TileMemory<Number>::Constant;
      const double length = all.concrete.length[g];
      const auto stiffness = static_cast<Constant>(all.concrete.stiffness[g]),
                 area = static_cast<Constant>(all.concrete.area[g]);
      const Stores opening = all.concrete.opening[g];
      const auto shear_force = all.concrete.shear[g], bending = all.concrete.moment[g];
      const Index at = memory.order[l];
      memory.concrete[at] = link;
      memory.length[at] = length;
      memory.constants[at] = {stiffness, area};
      memory.opening[at] = opening;
      shear().store(at, shear_force);
      moment().store(at, bending);
      if (!all.tiles.groups.damped) continue;
      memory.branch_normal[at] = all.concrete.branch_normal[g];
      branch_shear().store(at, all.concrete.branch_shear[g]);
    }
    for (Index l = thread; l < tile.steel; l += threads) {
      const TileLink link = t.links[tile.first_link + tile.concrete + l];
      const double length = all.steel.length[static_cast<Index>(link.number)];
      const SteelState state = all.steel.state[static_cast<Index>(link.number)];
      memory.steel[l] = link;
      memory.bar_length[l] = length;
      memory.bar_state[l] = state;
    }
    for (Index l = thread; l < tile.interface; l += threads) {
      const TileLink link = t.links[tile.first_link + tile.concrete + tile.steel + l];
      const auto g = static_cast<Index>(link.number);
      const TileAxis axis = t.axes[tile.first_axis + l];
      const double stiffness = all.interface.stiffness[g], area = all.interface.area[g];
      const InterfaceState state = all.interface.state[g];
      memory.interface[l] = link;
      memory.axis[l] = axis;
      memory.bond_stiffness[l] = stiffness;
      memory.bond_area[l] = area;
      memory.bond_state[l] = state;
    }
  }
  /// Number k of `rows`, of the list as it was made.
  BR_HD TilePlace row_number(Index k, TilePlace listed) const {
    const Index link = static_cast<Index>(listed) - tile.bars() - 1;
    if (k < tile.first_entry() || link < 0) return listed;
    return static_cast<TilePlace>(tile.bars() + 1 + memory.order[link]);
  }
  /// Items word by word, neighbouring threads neighbouring words.
  template <class T>
  BR_HD static void bring(T* to, const View<const T>& from, Index count, Index thread,
                          Index threads) {
    using Word = std::uint32_t;
    static_assert(sizeof(T) % sizeof(Word) == 0 && alignof(T) >= alignof(Word));
    const Index words = count * static_cast<Index>(sizeof(T) / sizeof(Word));
    for (Index k = thread; k < words; k += threads)
      reinterpret_cast<Word*>(to)[k] = reinterpret_cast<const Word*>(from.data)[k];
  }
  BR_HD void bring_lists(const TileLists& lists, Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    const Index numbers = tile.row_numbers();
    if (thread == 0) memory.bar_actions[tile.bars()] = PairForce{};
    constexpr Index ahead = 4;  // are on their way at one time
    for (Index k = thread; k < numbers; k += ahead * threads) {
      TilePlace next[ahead];
      BR_UNROLL
      for (Index j = 0; j < ahead; ++j)
        next[j] = t.rows[tile.first_row + (k + j * threads < numbers ? k + j * threads : k)];
      BR_UNROLL
      for (Index j = 0; j < ahead; ++j)
        if (k + j * threads < numbers)
          memory.rows[k + j * threads] = row_number(k + j * threads, next[j]);
    }
    for (Index k = thread; k <= tile.own; k += threads)
      memory.starts[k] = lists.starts[tile.first_start + k];
    for (Index k = thread; k < tile.contacts; k += threads) {
      const TileContact contact = lists.contacts[tile.first_contact + k];
      const ContactState state = all.contacts.state[contact.pair];
      memory.contacts[k] = contact;
      if (contact.side != 0) all.twins.state[contact.pair] = state;
      memory.touching[k] = state.overlap > 0.0 ? 1 : 0;
      memory.acts[k] = 0;
    }
    bring(memory.concrete_laws.data(), all.concrete_laws, t.groups.concrete, thread, threads);
    bring(memory.steel_laws.data(), all.steel_laws, t.groups.steel, thread, threads);
    bring(memory.interface_laws.data(), all.interface_laws, t.groups.interface, thread, threads);
  }
};

}  // namespace breccia::dem
