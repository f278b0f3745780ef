#pragma once
// The step of one tile: kernels of the DEM over the memory of a multiprocessor. A launch carries it
// out by threads that meet between phases; Space::shadow, tile by tile, by the processor.
//
// A tile moves its own elements and those that it knows of its neighbours, evaluates all links and
// contacts of its own elements, and adds these up. Links across tiles are evaluated by both. Once a
// step tiles tell each other the forces on their elements and their least critical number.

#include "dem/tiles/tile_case.hpp"
#include "exec/lockstep.hpp"

namespace breccia::dem {

struct TileStep {
  const TileCase& all;
  Index number;
  Tile tile;
  TileMemory memory;

  BR_HD TileStep(const TileCase& of, Index tile_number, std::byte* base)
      : all(of), number(tile_number), tile(of.tiles.tiles.data[tile_number]) {
    memory.lay_out(tile, of.tiles.groups, base);
  }

  /// Brings everything from the arrays of the world; nothing of what others may write after
  /// enter().
  BR_HD void enter(Index thread, Index threads) const {
    const TilesView& t = all.tiles;
    for (Index e = thread; e < tile.elements(); e += threads) {
      const Index g = e < tile.own ? t.own[tile.first_own + e]
                      : e < tile.own + tile.linked
                          ? t.linked[tile.first_linked + e - tile.own]
                          : t.touched[tile.first_touched + e - tile.own - tile.linked];
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
      memory.critical[e] = all.critical[g];
    }
    for (Index l = thread; l < tile.concrete; l += threads) {
      const TileLink link = t.links[tile.first_link + l];
      const auto g = static_cast<Index>(link.number);
      memory.concrete[l] = link;
      memory.length[l] = all.concrete.length[g];
      memory.stiffness[l] = all.concrete.stiffness[g];
      memory.area[l] = all.concrete.area[g];
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
    const Index numbers = TileMemory::row_numbers(tile);
    for (Index k = thread; k < numbers; k += threads) memory.rows[k] = t.rows[tile.first_row + k];
    for (Index k = thread; k <= tile.own; k += threads)
      memory.starts[k] = t.starts[tile.first_start + k];
    for (Index k = thread; k < tile.contacts; k += threads) {
      const TileContact contact = t.contacts[tile.first_contact + k];
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
    if (thread == 0) memory.clocks[0] = all.start;
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
      all.critical[g] = memory.critical[e];
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
  /// Actions of bars outlast a step: those of the last one.
  BR_HD void leave_actions(Index thread, Index threads) const {
    for (Index l = thread; l < tile.bars(); l += threads) {
      const bool bond = l >= tile.steel;
      const TileLink link = bond ? memory.interface[l - tile.steel] : memory.steel[l];
      if (!is_own(link)) continue;
      const Index first = bond ? all.interface.first_action : all.steel.first_action;
      all.steel.actions[first + static_cast<Index>(link.number)] = memory.bar_actions[l];
    }
  }

  // Phases of a step. Threads meet between them.

  /// Moves all elements that the tile knows, its own with their turns and works.
  BR_HD void move(const StepTime& now, Index thread, Index threads) const {
    MoveElements kernel = all.move;
    kernel.set(now);
    Kick& kick = kernel.kick;
    const Index own = tile.own;
    kick.mass = seen<const double>(memory.mass, tile.elements());
    kick.inertia = seen<const double>(memory.inertia, tile.elements());
    kick.fixed = seen<const std::uint8_t>(memory.fixed, tile.elements());
    kick.motion = seen<const std::int16_t>(memory.motion, tile.elements());
    kernel.state = seen(memory.state, own);
    kernel.orientation = seen(memory.orientation, own);
    kernel.damping_work = seen(memory.damping_work, own);
    kernel.load_work = seen(memory.load_work, own);
    for (Index e = thread; e < tile.elements(); e += threads) {
      MoveElements::Loaded<double> loaded;
      loaded.state = state_of(e);
      const ElementLoad load = e < own ? memory.load[e] : memory.received[e - own];
      loaded.given = {load.force, load.torque, memory.mass[e], memory.inertia[e], memory.fixed[e]};
      if (e < own) {
        loaded.turn = memory.orientation[e];
        loaded.reference = memory.reference[e];
        loaded.margin = memory.margin[e];
        kernel.update(e, loaded);
      } else {
        const Kick::Result r = kick(e, loaded.state, loaded.given);
        memory.state[e] = {kernel.place_after(loaded.state, r), r.velocity, r.spin,
                           loaded.state.radius};
      }
    }
  }

  /// Links and contacts.
  BR_HD void pair_forces(double dt, Index thread, Index threads) const {
    // Kinds begin with a warp, so that its threads do alike.
    const Index first_steel = whole_warps(tile.concrete),
                first_bond = first_steel + whole_warps(tile.steel);
    for (Index l = thread; l < first_bond + tile.interface; l += threads) {
      if (l < first_steel) {
        if (l < tile.concrete) concrete_link(dt, l);
      } else if (l < first_bond) {
        if (l - first_steel < tile.steel) steel_link(dt, l - first_steel);
      } else {
        bond(dt, l - first_bond);
      }
    }
    for (Index k = threads - 1 - thread; k < tile.contacts; k += threads) contact(dt, k);
  }

  static constexpr Index width = 8;  ///< threads that add up for an element
  BR_HD Index sum_items() const { return tile.own * width; }

  /// Thread i % 8 of the sums of an own element, in the order of GatherForces: the first four add
  /// up what it gets as a, the others as b; each along an axis, and two of the eight stiffnesses.
  /// The load goes to all tiles at once.
  /// @param span, longest  half of this step and the longest to come; that one  [s]
  BR_HD void sum(Index i, std::uint32_t tag, float span, float longest, TileNews& news) const {
    const Index e = memory.rows[i / width];
    const auto lane = static_cast<int>(i % width);
    const int side = lane / 4, part = lane % 4;
    const int axis = part < 3 ? part : 2;  // two threads have the same
    const int column = axis + 3 * side;
    PartSum sum{};
    const TilePlace *const starts = memory.rows + tile.own, *const rows = starts + 2 * tile.own + 1;
    const Index end = starts[2 * e + side + 1];
    for (Index k = starts[2 * e + side]; k < end; ++k)
      sum.add(read(memory.bar_actions[rows[k]], column, part));
    for (Index k = memory.starts[e]; k < memory.starts[e + 1]; ++k) {
      if (memory.acts[k] == 0 || memory.contacts[k].side != side) continue;
      const PairForce* const actions =
          side == 0 ? all.contacts.actions.data : all.twins.actions.data;
      sum.add(read(actions[memory.contacts[k].pair], column, part));
    }
    const LaneGroup<width> group;
    const double other = group.from(lane ^ 4, sum.first);
    const double load = side == 0 ? other - sum.second : sum.second + other;  // force, torque
    if (part < 3) {
      reinterpret_cast<double*>(memory.load + e)[column] = load;
      put(force_words(tag) + 6 * memory.place[e] + column, ordered_bits(load), tag);
    }
    const double critical = critical_of(group, e, lane, sum);
    const float reach = lane < 3 ? reach_of(e, lane, load, span, longest) : 0.0F;
    const float square = reach * reach;
    const float farthest = square + group.from(1, square) + group.from(2, square);
    if (lane != 0) return;
    memory.critical[e] = critical;
    news.least = min(news.least, critical);
    news.near = news.near || is_far(e, farthest);
  }
  /// This question of the forces that the tile has entered with.
  BR_HD bool near_at_entry(Index thread, Index threads) const {
    const StepTime& now = all.start.now;
    const auto span = static_cast<float>(0.5 * (now.last_dt + now.next_dt)),
               longest = static_cast<float>(now.next_dt);
    bool near = false;
    for (Index e = thread; e < tile.own; e += threads) {
      const Vec3& force = memory.load[e].force;
      const float x = reach_of(e, 0, force.x, span, longest),
                  y = reach_of(e, 1, force.y, span, longest),
                  z = reach_of(e, 2, force.z, span, longest);
      near = near || is_far(e, x * x + y * y + z * z);
    }
    return near;
  }

  /// Where elements tell their forces in a step, six words each.
  BR_HD TileWord* force_words(std::uint32_t tag) const {
    return all.forces +
           static_cast<std::size_t>(tag % 2) * 6 * static_cast<std::size_t>(all.force.size);
  }
  /// Where tile `from` tells `to` its news.
  BR_HD TileWord* news_word(std::uint32_t tag, Index from, Index to) const {
    const Index tiles = all.tiles.tiles.size;
    return all.least + (static_cast<Index>(tag % 2) * tiles + to) * tiles + from;
  }
  BR_HD static std::uint64_t packed(const TileNews& news) {
    return ordered_bits(news.least) | static_cast<std::uint64_t>(news.near ? 1 : 0) << 63;
  }
  BR_HD static void hear(TileNews& news, std::uint64_t bits) {
    news.near = news.near || bits >> 63 != 0;
    news.least = min(news.least, number_of(bits & ~(std::uint64_t{1} << 63)));
  }
  /// Numbers of the loads of others' elements, and where number k comes.
  BR_HD Index received() const { return 6 * (tile.linked + tile.touched); }
  BR_HD const TileWord* received_word(Index k, std::uint32_t tag) const {
    return force_words(tag) + 6 * memory.place[tile.own + k / 6] + k % 6;
  }
  BR_HD void receive(Index k, std::uint64_t bits) const {
    reinterpret_cast<double*>(memory.received)[k] = number_of(bits);
  }

 private:
  BR_HD static Index whole_warps(Index items) { return (items + 31) / 32 * 32; }
  template <class T, class Of>
  BR_HD static View<T> seen(Of* data, Index size) {
    View<T> view;
    view.data = data;
    view.size = size;
    return view;
  }
  template <class T>
  BR_HD static View<T> seen(T* data, Index size) {
    return seen<T, T>(data, size);
  }
  BR_HD bool is_own(const TileLink& link) const { return link.a < tile.own; }
  BR_HD TileActions actions(PairForce* records, const TileLink& link) const {
    return {records, static_cast<Index>(link.number), is_own(link)};
  }
  BR_HD PlanesView<double> shear() const {
    return {seen(memory.shear, 3 * tile.concrete), tile.concrete};
  }
  BR_HD PlanesView<double> moment() const {
    return {seen(memory.moment, 3 * tile.concrete), tile.concrete};
  }
  BR_HD ElementsView elements() const {
    const Index n = tile.elements();
    return {seen<const ElementState>(memory.state, n), seen<const double>(memory.mass, n),
            seen<const double>(memory.inertia, n)};
  }
  BR_HD ElementState state_of(Index e) const {
    return read_record(seen<const ElementState>(memory.state, tile.elements()), e);
  }
  BR_HD LinkEnd<double> end(Index e) const {
    const ElementState s = state_of(e);
    return {{s.position, s.velocity, s.spin}, s.radius};
  }

  BR_HD void concrete_link(double dt, Index l) const {
    const TileLink link = memory.concrete[l];
    const Index n = tile.concrete;
    ConcreteLink law = memory.concrete_laws[link.group];
    law.rate.exponent = 0.0;  // models with rates have no tiles
    const ConcreteLinkForces<double, TileActions> kernel{law,
                                                         dt,
                                                         {},
                                                         {},
                                                         {},
                                                         seen(memory.length, n),
                                                         {},
                                                         {},
                                                         seen(memory.opening, n),
                                                         shear(),
                                                         moment(),
                                                         all.concrete.slid,
                                                         all.concrete.yielded,
                                                         all.concrete.broke,
                                                         {},
                                                         actions(memory.actions, link),
                                                         0,
                                                         0};
    ConcreteLinkForces<double, TileActions>::Loaded<double> loaded;
    loaded.length = memory.length[l];
    loaded.stiffness = memory.stiffness[l];
    loaded.area = memory.area[l];
    loaded.state = {memory.opening[l], shear()[l], moment()[l]};
    loaded.end_a = end(link.a);
    loaded.end_b = end(link.b);
    kernel.update(law, l, loaded);
  }
  BR_HD void steel_link(double dt, Index l) const {
    const TileLink link = memory.steel[l];
    const SteelLink law = memory.steel_laws[link.group];
    const SteelLinkForcesTo<TileActions> kernel{law,
                                                dt,
                                                {},
                                                {},
                                                {},
                                                {},
                                                seen(memory.bar_state, tile.steel),
                                                all.steel.yielded,
                                                all.steel.broke,
                                                actions(memory.bar_actions, link),
                                                0};
    SteelLinkForcesTo<TileActions>::Loaded<double> loaded;
    loaded.length = memory.bar_length[l];
    loaded.state = memory.bar_state[l];
    loaded.end_a = end(link.a);
    loaded.end_b = end(link.b);
    kernel.update(law, l, loaded);
  }
  BR_HD void bond(double dt, Index l) const {
    const TileLink link = memory.interface[l];
    const InterfaceLinkForcesTo<TileActions> kernel{{},
                                                    dt,
                                                    {},
                                                    {},
                                                    {},
                                                    {},
                                                    {},
                                                    {},
                                                    {},
                                                    seen(memory.bond_state, tile.interface),
                                                    all.interface.slid,
                                                    all.interface.broke,
                                                    actions(memory.bar_actions, link),
                                                    tile.steel};
    InterfaceLinkForcesTo<TileActions>::Loaded<double> loaded;
    loaded.stiffness = memory.bond_stiffness[l];
    loaded.area = memory.bond_area[l];
    loaded.state = memory.bond_state[l];
    loaded.bar = end(link.a);
    loaded.concrete = end(link.b);
    const TileAxis axis = memory.axis[l];
    loaded.chord = memory.state[axis.after].position - memory.state[axis.before].position;
    kernel.update(memory.interface_laws[link.group], l, loaded);
  }
  /// A contact whose ends are apart, as they were before, keeps its action: none.
  BR_HD void contact(double dt, Index k) const {
    const TileContact contact = memory.contacts[k];
    const bool is_a = contact.side == 0;
    const Index a = is_a ? contact.own : contact.partner, b = is_a ? contact.partner : contact.own;
    const ContactForces& world = is_a ? all.contacts : all.twins;
    ContactForcesTo<TileActions> kernel{
        world.law,    dt,
        elements(),   seen<const std::int16_t>(memory.material, tile.elements()),
        world.pairs,  world.materials,
        {},           {},
        world.state,  world.slid,
        world.damped, {world.actions.data, 0, true}};
    const bool acts = memory.touching[k] != 0 || !kernel.apart(a, b);
    memory.acts[k] = acts ? 1 : 0;
    if (!acts) return;
    kernel.of_pair(contact.pair, a, b);
    memory.touching[k] = world.state[contact.pair].overlap > 0.0 ? 1 : 0;
  }

  /// Sums of one of an element's threads, of the actions on it as one of two ends.
  struct PartSum {
    double first, second;  ///< torque on a, force on b; or force on b, torque on b
    float straight[2], turning[2];
    BR_HD void add(const PartSum& other) {
      first += other.first;
      second += other.second;
      for (int k = 0; k < 2; ++k) {
        straight[k] += other.straight[k];
        turning[k] += other.turning[k];
      }
    }
  };
  BR_HD static PartSum read(const PairForce& action, int number, int part) {
    const float* const two = action.stiffness + 2 * part;
    const float ratio = action.stiffness[8];
    return {action.numbers[number],
            action.numbers[number + 3],
            {two[0], two[1]},
            {ratio * two[0], ratio * two[1]}};
  }
  /// Inertia over a bound of the largest stiffness, for lane 0.  [s2]
  BR_HD double critical_of(const LaneGroup<width>& group, Index e, int lane,
                           const PartSum& sum) const {
    float straight_part[2], turning_part[2];
    for (int k = 0; k < 2; ++k) {
      straight_part[k] = sum.straight[k] + group.from(lane ^ 4, sum.straight[k]);
      turning_part[k] = sum.turning[k] + group.from(lane ^ 4, sum.turning[k]);
    }
    Symmetric<float> straight, turning;  // numbers 1 to 6 of eight
    BR_UNROLL
    for (int k = 0; k < 6; ++k) {
      straight.c[k] = group.from((k + 1) / 2, straight_part[(k + 1) % 2]);
      turning.c[k] = group.from((k + 1) / 2, turning_part[(k + 1) % 2]);
    }
    const float turn = group.from(0, sum.straight[0]) + group.from(7, sum.straight[1]);
    const Stiffest most = stiffest(straight, turning, turn);
    const bool of_straight = lane % 2 == 0;
    const float largest = is_held(memory.fixed[e], of_straight ? 0 : 3) ? 0.0F
                          : of_straight                                 ? most.straight
                                                                        : most.turning;
    const double slow =
        static_cast<double>(largest) / (of_straight ? memory.mass[e] : memory.inertia[e]);
    const double slowest = max(slow, group.from(1, slow));
    return slowest > 0.0 ? 1.0 / slowest : largest_least;
  }

  /// How far from its reference an own element may be along an axis after the move to come: its
  /// force gives it its velocity. In single precision, with room for rounding.  [m]
  BR_HD float reach_of(Index e, int axis, double force, float span, float longest) const {
    const ElementState& state = memory.state[e];
    const auto away =
        static_cast<float>(reinterpret_cast<const double*>(&state.position)[axis] -
                           reinterpret_cast<const double*>(memory.reference + e)[axis]);
    if ((memory.fixed[e] >> axis & 1) != 0) return fabsf(away);
    const auto speed =
        fabsf(static_cast<float>(reinterpret_cast<const double*>(&state.velocity)[axis]));
    const Vec3& gravity = all.move.kick.gravity;
    const auto weight = static_cast<float>(axis == 0   ? gravity.x
                                           : axis == 1 ? gravity.y
                                                       : gravity.z);
    const float gained =
        fabsf(static_cast<float>(force)) / static_cast<float>(memory.mass[e]) + fabsf(weight);
    const auto driven = static_cast<float>(1.0 + all.move.kick.damping) * gained;
    return fabsf(away) + longest * (speed + span * driven);
  }
  /// @param square  of the way from its reference; NaN counts as far
  BR_HD bool is_far(Index e, float square) const {
    const auto margin = static_cast<float>(memory.margin[e]);
    return !(1.0001F * square < margin * margin);
  }
};

}  // namespace breccia::dem
