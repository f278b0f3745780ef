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
    reinterpret_cast<TileMemory<Number>*>(base)->lay_out(lists.tiles.data[tile_number],
                                                         of.tiles.groups);
  }

  /// Brings everything from the arrays of the world; nothing of what others may write after
  /// enter().
  BR_HD void enter(const TileLists& lists, Index thread, Index threads) const {
    bring_elements(lists, thread, threads);
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
    }
    for (Index l = thread; l < tile.steel; l += threads)
      if (is_own(memory.steel[l]))
        all.steel.state[static_cast<Index>(memory.steel[l].number)] = memory.bar_state[l];
    for (Index l = thread; l < tile.interface; l += threads)
      if (is_own(memory.interface[l]))
        all.interface.state[static_cast<Index>(memory.interface[l].number)] = memory.bond_state[l];
  }
  /// Critical numbers and actions of bars and contacts outlast a step: those of the last one.
  BR_HD void leave_actions(Index thread, Index threads) const {
    for (Index e = thread; e < tile.own; e += threads)
      all.critical[memory.place[e]] = critical_of(memory.slowest[e]);
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
      memory.place[e] = g;
      memory.state[e] = read_record(all.move.kick.state, g);
      memory.mass[e] = all.move.kick.mass[g];
      memory.inertia[e] = all.move.kick.inertia[g];
      memory.material[e] = all.contacts.material[g];
      memory.motion[e] = all.move.kick.motion[g];
      memory.fixed[e] = all.move.kick.fixed[g];
      const ElementLoad load{all.move.kick.force[g], all.move.kick.torque[g]};
      if (e >= tile.own) {
        memory.received[e - tile.own] = load;
        continue;
      }
      memory.load[e] = load;
      memory.orientation[e] = all.move.orientation[g];
      memory.reference[e] = all.move.used.reference[g];
      memory.margin[e] = all.move.used.margin[g];
      memory.damping_work[e] = all.move.damping_work[g];
      memory.load_work[e] = all.move.load_work[g];
      memory.over_mass[e] = 1.0F / static_cast<float>(memory.mass[e]);
      const auto margin = static_cast<float>(memory.margin[e]);
      memory.room[e] = margin * margin / 1.0001F;
    }
  }
  BR_HD void bring_links(Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    for (Index l = thread; l < tile.concrete; l += threads) {
      const TileLink link = t.links[tile.first_link + l];
      const auto g = static_cast<Index>(link.number);
      memory.concrete[l] = link;
      memory.length[l] = all.concrete.length[g];
      using Constant = typename TileMemory<Number>::Constant;
      memory.stiffness[l] = static_cast<Constant>(all.concrete.stiffness[g]);
      memory.area[l] = static_cast<Constant>(all.concrete.area[g]);
      memory.opening[l] = all.concrete.opening[g];
      shear().store(l, all.concrete.shear[g]);
      moment().store(l, all.concrete.moment[g]);
    }
    for (Index l = thread; l < tile.steel; l += threads) {
      const TileLink link = t.links[tile.first_link + tile.concrete + l];
      memory.steel[l] = link;
      memory.bar_length[l] = all.steel.length[static_cast<Index>(link.number)];
      memory.bar_state[l] = all.steel.state[static_cast<Index>(link.number)];
    }
    for (Index l = thread; l < tile.interface; l += threads) {
      const TileLink link = t.links[tile.first_link + tile.concrete + tile.steel + l];
      const auto g = static_cast<Index>(link.number);
      memory.interface[l] = link;
      memory.axis[l] = t.axes[tile.first_axis + l];
      memory.bond_stiffness[l] = all.interface.stiffness[g];
      memory.bond_area[l] = all.interface.area[g];
      memory.bond_state[l] = all.interface.state[g];
    }
  }
  BR_HD void bring_lists(const TileLists& lists, Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    const Index numbers = TileMemory<Number>::row_numbers(tile);
    for (Index k = thread; k < numbers; k += threads) memory.rows[k] = t.rows[tile.first_row + k];
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
    for (Index k = thread; k < t.groups.concrete; k += threads)
      memory.concrete_laws[k] = all.concrete_laws[k];
    for (Index k = thread; k < t.groups.steel; k += threads)
      memory.steel_laws[k] = all.steel_laws[k];
    for (Index k = thread; k < t.groups.interface; k += threads)
      memory.interface_laws[k] = all.interface_laws[k];
  }
};

}  // namespace breccia::dem
