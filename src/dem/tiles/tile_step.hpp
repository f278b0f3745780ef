#pragma once
// The step of one tile: kernels of the DEM over the memory of a multiprocessor. A launch carries it
// out by threads that meet between phases; Space::shadow, tile by tile, by the processor.
//
// A tile moves its own elements and those that it knows of its neighbours, evaluates all links and
// contacts of its own elements, and adds these up. Links across tiles are evaluated by both. Once a
// step tiles tell each other the forces on their elements and their least critical number.

#include "dem/tiles/tile_content.hpp"
#include "exec/lockstep.hpp"

namespace breccia::dem {

template <class Number>
struct TileStep : TileContent<Number> {
  using Base = TileContent<Number>;
  using Base::all;
  using Base::Base;
  using Base::memory;
  using Base::number;
  using Base::tile;
  using Stores = StoredAs<Number>;
  using Item = ComputedIn<Number>;

  // Phases of a step. Threads meet between them.

  /// Before a step's links: portions are counted from the first that no warp begins with.
  BR_HD void count_from(Index first) const {
    memory.counters[0] = first;
    memory.counters[1] = 1;
  }
  /// @returns the next number, another one for each thread that asks
  BR_HD static Index take_number(Index* next) {
#if defined(__CUDA_ARCH__)
    return atomicAdd(next, 1);
#else
    return (*next)++;
#endif
  }

  /// Moves all elements that the tile knows, its own with their turns and works.
  BR_HD void move(const StepTime& now, Index thread, Index threads) const {
    MoveElements kernel = all.move;
    kernel.set(now);
    Kick& kick = kernel.kick;
    const Index own = tile.own;
    kick.mass = this->template seen<const double>(memory.mass, tile.elements());
    kick.inertia = this->template seen<const double>(memory.inertia, tile.elements());
    kick.fixed = this->template seen<const std::uint8_t>(memory.fixed, tile.elements());
    kick.motion = this->template seen<const std::int16_t>(memory.motion, tile.elements());
    kernel.state = this->seen(memory.state, own);
    kernel.orientation = this->seen(memory.orientation, own);
    kernel.damping_work = this->seen(memory.damping_work, own);
    kernel.load_work = this->seen(memory.load_work, own);
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

  /// Whether an own element has used its margin up by that move.
  BR_HD bool used_margin(const StepTime& now, Index thread, Index threads) const {
    UsedMargin used = all.move.used;
    used.set_time(now.time + now.next_dt);
    bool any = used.too_far;
    for (Index e = thread; e < tile.own; e += threads)
      any = any ||
            used.beyond<double>(memory.state[e].position, memory.reference[e], memory.margin[e]);
    return any;
  }

  /// Links and contacts in portions of a warp, each of a kind, so that its threads do alike. Those
  /// that take longest come first.
  static constexpr Index portion = 32;
  BR_HD Index portions() const {
    return portions_of(tile.contacts) + portions_of(tile.interface) + portions_of(tile.steel) +
           portions_of(tile.concrete);
  }
  /// @param now  after the move: its last step is the one that moved the elements to where they are
  /// @tparam parts  those that laws of cohesive links may have
  template <ConcreteParts parts>
  BR_HD void pair_force(const StepTime& now, Index at, Index lane) const {
    const double dt = now.last_dt;
    Index k = at * portion + lane;
    if (k < portions_of(tile.contacts) * portion) {
      if (k < tile.contacts) contact(dt, k);
      return;
    }
    k -= portions_of(tile.contacts) * portion;
    if (k < portions_of(tile.interface) * portion) {
      if (k < tile.interface) bond(dt, k);
      return;
    }
    k -= portions_of(tile.interface) * portion;
    if (k < portions_of(tile.steel) * portion) {
      if (k < tile.steel) steel_link(dt, k);
      return;
    }
    k -= portions_of(tile.steel) * portion;
    if (k < tile.concrete) concrete_link<parts>(now, k);
  }

  static constexpr Index width = 8;  ///< threads that add up for an element
  BR_HD Index sum_items() const {
    return tile.own * width;
  }

  /// Thread i % 8 of the sums of an own element, in the order of GatherForces: the first four add
  /// up what it gets as a, the others as b; each along an axis, and two of the eight stiffnesses.
  /// The load goes to all tiles at once.
  BR_HD void sum(Index i, std::uint32_t tag) const {
    const Index e = memory.rows[i / width];
    const auto lane = static_cast<int>(i % width);
    const int side = lane / 4, part = lane % 4;
    const int axis = part < 3 ? part : 2;  // two threads have the same
    const int column = axis + 3 * side;
    PartSum sum{};
    add_links(sum, e, side, column, part);
    add_contacts(sum, e, side, column, part);
    const LaneGroup<width> group;
    const double other = group.from(lane ^ 4, sum.first);
    const double load = side == 0 ? other - sum.second : sum.second + other;  // force, torque
    if (part < 3) {
      reinterpret_cast<double*>(memory.load + e)[column] = load;
      put(force_words(tag) + 6 * memory.place[e] + column, ordered_bits(load), tag);
    }
    // Numbers 2 part and 2 part + 1 of eight: the first is turn of a, the last turn of b.
    const float turn_b = group.from(7, sum.straight[1]);
    BR_UNROLL
    for (int k = 0; k < 2; ++k) {
      const float straight = sum.straight[k] + group.from(lane ^ 4, sum.straight[k]);
      const float turning = sum.turning[k] + group.from(lane ^ 4, sum.turning[k]);
      const int which = 2 * part + k;
      if (side != 0 || which == 7) continue;
      stiffness_sum(which, e) = which == 0 ? sum.straight[0] + turn_b : straight;
      if (which > 0) stiffness_sum(6 + which, e) = turning;
    }
  }
  /// Results of an own element's sums: its critical number, and whether its margin may be
  /// used up by the move to come.
  /// @param span, longest  half of this step and the longest to come; that one  [s]
  BR_HD void judge(Index e, float span, float longest, TileReport& report) const {
    Symmetric<float> straight, turning;
    BR_UNROLL
    for (int k = 0; k < 6; ++k) {
      straight.c[k] = stiffness_sum(1 + k, e);
      turning.c[k] = stiffness_sum(7 + k, e);
    }
    const Stiffest most = stiffest(straight, turning, stiffness_sum(0, e));
    const int fixed = memory.fixed[e];
    const float push = is_held(fixed, 0) ? 0.0F : most.straight,
                twist = is_held(fixed, 3) ? 0.0F : most.turning;
    const double slowest = max(over(push, memory.mass[e]), over(twist, memory.inertia[e]));
    memory.slowest[e] = slowest;
    report.slowest = slowest > report.slowest ? slowest : report.slowest;  // NaN does not count
    report.near = report.near || is_far(e, span, longest);
  }
  /// This question of the forces that the tile has entered with.
  BR_HD bool near_at_entry(Index thread, Index threads) const {
    const StepTime& now = all.start.now;
    const auto span = static_cast<float>(0.5 * (now.last_dt + now.next_dt)),
               longest = static_cast<float>(now.next_dt);
    bool near = false;
    for (Index e = thread; e < tile.own; e += threads) near = near || is_far(e, span, longest);
    return near;
  }

  /// Where elements tell their forces in a step, six words each.
  BR_HD TileWord* force_words(std::uint32_t tag) const {
    return all.forces +
           static_cast<std::size_t>(tag % 2) * 6 * static_cast<std::size_t>(all.force.size);
  }
  /// Where tile `from` tells `to` its report.
  BR_HD TileWord* news_word(std::uint32_t tag, Index from, Index to) const {
    return news_word(all, tag, from, to);
  }
  BR_HD static TileWord* news_word(const TileCase<Number>& all, std::uint32_t tag, Index from,
                                   Index to) {
    const Index tiles = all.tiles.count;
    return all.least + (static_cast<Index>(tag % 2) * tiles + to) * tiles + from;
  }
  /// Numbers of the loads of others' elements, and where number k comes.
  BR_HD Index received() const {
    return 6 * (tile.linked + tile.touched);
  }
  BR_HD const TileWord* received_word(Index k, std::uint32_t tag) const {
    return force_words(tag) + 6 * memory.place[tile.own + k / 6] + k % 6;
  }
  BR_HD void receive(Index k, std::uint64_t bits) const {
    reinterpret_cast<double*>(memory.received.data())[k] = number_of(bits);
  }

 private:
  BR_HD static Index portions_of(Index items) {
    return (items + portion - 1) / portion;
  }
  template <class Stored>
  BR_HD TileActionsOf<Stored> actions(PairForceOf<Stored>* records, const TileLink& link) const {
    return {records, static_cast<Index>(link.number), this->is_own(link)};
  }
  BR_HD ElementsView elements() const {
    const Index n = tile.elements();
    return {this->template seen<const ElementState>(memory.state, n),
            this->template seen<const double>(memory.mass, n),
            this->template seen<const double>(memory.inertia, n)};
  }
  BR_HD ElementState state_of(Index e) const {
    return read_record(this->template seen<const ElementState>(memory.state, tile.elements()), e);
  }
  BR_HD LinkEnd<double> end(Index e) const {
    const ElementState s = state_of(e);
    return {{s.position, s.velocity, s.spin}, s.radius};
  }

  BR_HD Vec3Of<Item> vector(const Stores* planes, Index l) const {
    const Index n = tile.concrete;
    return {Item(planes[l]), Item(planes[n + l]), Item(planes[2 * n + l])};
  }
  template <ConcreteParts parts>
  BR_HD void concrete_link(const StepTime& now, Index l) const {
    const TileLink link = memory.concrete[l];
    const Index n = tile.concrete;
    using Kernel = ConcreteLinkForces<Number, TileActionsOf<Stores>>;
    const Kernel kernel{{},
                        now.last_dt,
                        {},
                        {},
                        {},
                        this->seen(memory.length, n),
                        {},
                        {},
                        this->seen(memory.opening, n),
                        this->shear(),
                        this->moment(),
                        all.concrete.slid,
                        all.concrete.yielded,
                        all.concrete.broke,
                        {},
                        actions(memory.actions.data(), link),
                        0,
                        now.step};
    typename Kernel::template Loaded<Item> loaded;
    loaded.length = memory.length[l];
    loaded.stiffness = Item(memory.stiffness[l]);
    loaded.area = Item(memory.area[l]);
    loaded.state = {Item(memory.opening[l]), vector(memory.shear, l), vector(memory.moment, l)};
    const LinkPair<double> ends = link_pair(end(link.a), end(link.b));
    if constexpr (is_single<Item>)
      loaded.ends = single_pair(ends, memory.length[l]);
    else
      loaded.ends = ends;
    const typename Kernel::Law& law = memory.concrete_laws[link.group];
    kernel.template update<parts>(law, l, loaded);
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
                                                this->seen(memory.bar_state, tile.steel),
                                                all.steel.yielded,
                                                all.steel.broke,
                                                actions(memory.bar_actions.data(), link),
                                                0};
    SteelLinkForcesTo<TileActions>::Loaded<double> loaded;
    loaded.length = memory.bar_length[l];
    loaded.state = memory.bar_state[l];
    loaded.ends = link_pair(end(link.a), end(link.b));
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
                                                    this->seen(memory.bond_state, tile.interface),
                                                    all.interface.slid,
                                                    all.interface.broke,
                                                    actions(memory.bar_actions.data(), link),
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
  /// A contact whose ends are apart, as they were before, has no action. Those that have one get a
  /// place in the tile's memory, as long as there is room.
  BR_HD void contact(double dt, Index k) const {
    const TileContact contact = memory.contacts[k];
    const bool is_a = contact.side == 0;
    const Index a = is_a ? contact.own : contact.partner, b = is_a ? contact.partner : contact.own;
    const ContactForces& world = is_a ? all.contacts : all.twins;
    ContactForcesTo<TileActions> kernel{
        world.law,    dt,
        elements(),   this->template seen<const std::int16_t>(memory.material, tile.elements()),
        world.pairs,  world.materials,
        {},           {},
        world.state,  world.slid,
        world.damped, {nullptr, 0, true}};
    const bool acts = memory.touching[k] != 0 || !kernel.apart(a, b);
    memory.acts[k] = acts ? static_cast<TilePlace>(take_number(memory.counters + 1)) : 0;
    if (!acts) return;
    // The kernel writes action `pair`.
    kernel.actions.records = this->action_of(k) - contact.pair;
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
  template <class Stored>
  BR_HD static PartSum read(const PairForceOf<Stored>& action, int first, int part) {
    const float* const two = action.stiffness + 2 * part;
    const float ratio = action.stiffness[8];
    return {action.numbers[first],
            action.numbers[first + 3],
            {two[0], two[1]},
            {ratio * two[0], ratio * two[1]}};
  }
  /// @param action  an entry of a row
  BR_HD PartSum read(TilePlace action, int first, int part) const {
    const auto bars = static_cast<TilePlace>(tile.bars());
    if (sizeof(Stores) != sizeof(double) && action >= bars)
      return read(memory.actions[action - bars], first, part);
    return read(memory.bar_actions[action], first, part);
  }
  /// Without a division of zero, for which a GPU takes a slow way.
  BR_HD static double over(float stiffness, double inertia) {
    return stiffness > 0.0F ? static_cast<double>(stiffness) / inertia : 0.0;
  }
  BR_HD float& stiffness_sum(int which, Index e) const {
    return memory.stiffness_sums[which * tile.own + e];
  }
  /// The links of a row, two of which are read before the first is added.
  BR_HD void add_links(PartSum& sum, Index e, int side, int column, int part) const {
    const TilePlace *const starts = memory.rows + tile.own, *const rows = starts + 2 * tile.own + 1;
    const Index end = starts[2 * e + side + 1];
    Index k = starts[2 * e + side];
    for (; k + 1 < end; k += 2) {
      const PartSum first = read(rows[k], column, part), second = read(rows[k + 1], column, part);
      sum.add(first);
      sum.add(second);
    }
    if (k < end) sum.add(read(rows[k], column, part));
  }
  BR_HD void add_contacts(PartSum& sum, Index e, int side, int column, int part) const {
    for (Index k = memory.starts[e]; k < memory.starts[e + 1]; ++k)
      if (memory.acts[k] != 0 && memory.contacts[k].side == side)
        sum.add(read(*this->action_of(k), column, part));
  }
  /// Whether an own element may be further from its reference than its margin after the move to
  /// come: its force gives it its velocity. In single precision, with room for rounding; NaN counts
  /// as far.
  BR_HD bool is_far(Index e, float span, float longest) const {
    const float over_mass = memory.over_mass[e];
    const Vec3& force = memory.load[e].force;
    const float x = reach_of(e, 0, force.x, over_mass, span, longest),
                y = reach_of(e, 1, force.y, over_mass, span, longest),
                z = reach_of(e, 2, force.z, over_mass, span, longest);
    return !(x * x + y * y + z * z < memory.room[e]);
  }
  /// How far along an axis.  [m]
  BR_HD float reach_of(Index e, int axis, double force, float over_mass, float span,
                       float longest) const {
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
    const float gained = fabsf(static_cast<float>(force)) * over_mass + fabsf(weight);
    const auto driven = static_cast<float>(1.0 + all.move.kick.damping) * gained;
    return fabsf(away) + longest * (speed + span * driven);
  }
};

}  // namespace breccia::dem
