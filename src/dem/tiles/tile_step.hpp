#pragma once
// The step of one tile: kernels of the DEM over the memory of a multiprocessor. A launch carries it
// out by threads that meet between phases; Space::shadow, tile by tile, by the processor.
//
// A tile moves its own elements and those that it knows of its neighbours, evaluates all links and
// contacts of its own elements, and adds these up. Links across tiles are evaluated by both. Once a
// step tiles tell each other the forces on their elements and their least critical number.

#include "dem/tiles/part_sum.hpp"
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

  static constexpr Index width = 4;  ///< threads that add up for an element
  using SumGroup = LaneGroup<width>;
  /// Threads, as many as whole warps have, since these call shuffles together.
  BR_HD Index sum_items() const {
    return whole_warps(tile.own * width);
  }

  /// Thread i % 4 of the sums of an own element, in the order of GatherForces: each adds up along
  /// an axis, and two of the eight stiffnesses. The load goes to all tiles at once.
  /// @param span, longest  half of this step and the longest to come; that one  [s]
  /// @param report  hears of the element's critical number, and whether its margin may be used up
  ///                by the move to come
  /// @tparam evaluates  as StepTime; otherwise stiffnesses are left out
  template <bool evaluates>
  BR_HD void sum(Index i, std::uint32_t tag, float span, float longest, TileReport& report) const {
    const bool is_item = i < tile.own * width;  // otherwise the last element again, nothing told
    const Index e = memory.rows[is_item ? i / width : tile.own - 1];
    const auto part = static_cast<int>(i % width);
    const int axis = part < 3 ? part : 2;  // two threads have the same
    const Reach unforced = reach_without_force(e, axis);
    const float room = memory.room[e];
    const Index place = memory.place[e];
    PartSum<evaluates> as_a{}, as_b{};
    add_links(as_a, as_b, e, axis, part);
    add_contacts(as_a, as_b, e, axis, part);
    const double force = as_b.first - as_a.second, torque = as_b.second + as_a.first;
    const SumGroup group;
    double slowest = 0.0;
    if constexpr (evaluates) slowest = slowest_of(group, e, part, as_a, as_b);
    const float reach = unforced.with(force, all.move.kick.damping, span, longest),
                square = reach * reach;
    const float of_y = group.from(1, square), of_z = group.from(2, square);
    if (!is_item) return;
    if (part < 3) {
      reinterpret_cast<double*>(&memory.load[e].force)[axis] = force;
      reinterpret_cast<double*>(&memory.load[e].torque)[axis] = torque;
      TileWord* const words = force_words(tag) + 6 * place;
      put(words + axis, ordered_bits(force), tag);
      put(words + 3 + axis, ordered_bits(torque), tag);
    }
    if (part != 0) return;
    report.slowest = slowest > report.slowest ? slowest : report.slowest;  // NaN does not count
    report.near = report.near || !(square + of_y + of_z < room);
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
    const auto constants = memory.constants[l];  // first, as they may come from outside
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
                        this->seen(memory.branch_normal, n),
                        this->branch_shear(),
                        all.concrete.damped_away,
                        actions(memory.actions.data(), link),
                        0,
                        now.step,
                        now.evaluates};
    typename Kernel::template Loaded<Item> loaded;
    loaded.length = memory.length[l];
    loaded.stiffness = Item(constants.stiffness);
    loaded.area = Item(constants.area);
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

  /// @param action  an entry of a row
  template <bool evaluates>
  BR_HD PartSum<evaluates> read(TilePlace action, int first, int part) const {
    const auto bars = static_cast<TilePlace>(tile.bars());
    if (sizeof(Stores) != sizeof(double) && action > bars)
      return part_of<evaluates>(memory.actions[action - bars - 1], first, part);
    return part_of<evaluates>(memory.bar_actions[action], first, part);
  }
  /// Without a division of zero, for which a GPU takes a slow way.
  BR_HD static double over(float stiffness, double inertia) {
    return stiffness > 0.0F ? static_cast<double>(stiffness) / inertia : 0.0;
  }
  /// The links of both rows of an element, which are of one even length: zeros fill them up. No sum
  /// is -0, so that these leave it as it is.
  template <bool evaluates>
  BR_HD void add_links(PartSum<evaluates>& as_a, PartSum<evaluates>& as_b, Index e, int axis,
                       int part) const {
    struct alignas(2 * sizeof(TilePlace)) Two {
      TilePlace first, second;
    };
    const TilePlace* const starts = memory.rows + tile.own + 2 * e;
    const Index length = (starts[1] - starts[0]) / 2;
    const Two* a = reinterpret_cast<const Two*>(memory.rows + tile.first_entry()) + starts[0] / 2;
    const Two *const end = a + length, *b = end;
    for (; a < end; ++a, ++b) {
      const Two in_a = *a, in_b = *b;
      const auto of_a = read<evaluates>(in_a.first, axis, part),
                 of_b = read<evaluates>(in_b.first, axis + 3, part),
                 next_a = read<evaluates>(in_a.second, axis, part),
                 next_b = read<evaluates>(in_b.second, axis + 3, part);
      as_a.add(of_a);
      as_b.add(of_b);
      as_a.add(next_a);
      as_b.add(next_b);
    }
  }
  template <bool evaluates>
  BR_HD void add_contacts(PartSum<evaluates>& as_a, PartSum<evaluates>& as_b, Index e, int axis,
                          int part) const {
    for (Index k = memory.starts[e]; k < memory.starts[e + 1]; ++k) {
      if (memory.acts[k] == 0) continue;
      const PairForce& action = *this->action_of(k);
      if (memory.contacts[k].side == 0)
        as_a.add(part_of<evaluates>(action, axis, part));
      else
        as_b.add(part_of<evaluates>(action, axis + 3, part));
    }
  }
  /// The largest stiffness over inertia of an element, by all of its threads.  [1/s2]
  BR_HD double slowest_of(const SumGroup& group, Index e, int part, const PartSum<true>& as_a,
                          const PartSum<true>& as_b) const {
    const int fixed = memory.fixed[e];
    const double mass = memory.mass[e], inertia = memory.inertia[e];
    Symmetric<float> straight, turning;  // numbers 1 to 6 of the eight that threads have by twos
    BR_UNROLL
    for (int k = 0; k < 2; ++k) {
      const float s = as_a.stiffness.straight[k] + as_b.stiffness.straight[k],
                  t = as_a.stiffness.turning[k] + as_b.stiffness.turning[k];
      BR_UNROLL
      for (int from = 0; from < width; ++from) {
        const int component = 2 * from + k - 1;
        if (component < 0 || component > 5) continue;
        straight.c[component] = group.from(from, s);
        turning.c[component] = group.from(from, t);
      }
    }
    const float turn =
        group.from(0, as_a.stiffness.straight[0]) + group.from(3, as_b.stiffness.straight[1]);
    const bool turns = part % 2 != 0;  // which of stiffest()'s numbers a thread finds
    Symmetric<float> c;
    BR_UNROLL
    for (int k = 0; k < 6; ++k) c.c[k] = turns ? turning.c[k] : straight.c[k];
    const float mean = c.mean(), most = (turns ? turn - mean : mean) + sqrtf(c.square_spread());
    const float largest = is_held(fixed, turns ? 3 : 0) ? 0.0F : most;
    const double slow = over(largest, turns ? inertia : mass);
    return max(group.from(0, slow), group.from(1, slow));
  }
  /// Whether an own element may be further from its reference than its margin after the move to
  /// come: its force gives it its velocity. In single precision, with room for rounding; NaN counts
  /// as far.
  BR_HD bool is_far(Index e, float span, float longest) const {
    const Vec3& force = memory.load[e].force;
    const double damping = all.move.kick.damping;
    const float x = reach_without_force(e, 0).with(force.x, damping, span, longest),
                y = reach_without_force(e, 1).with(force.y, damping, span, longest),
                z = reach_without_force(e, 2).with(force.z, damping, span, longest);
    return !(x * x + y * y + z * z < memory.room[e]);
  }
  /// How far an element may get along an axis: from its reference, its speed, the acceleration of
  /// gravity. None of the last three where it is held.
  struct Reach {
    float away, speed, weight, over_mass;  ///<  [m], [m/s], [m/s2], [1/kg]
    /// @returns it  [m]
    BR_HD float with(double force, double damping, float span, float longest) const {
      const float gained = fabsf(static_cast<float>(force)) * over_mass + weight;
      const float driven = static_cast<float>(1.0 + damping) * gained;
      return away + longest * (speed + span * driven);
    }
  };
  BR_HD Reach reach_without_force(Index e, int axis) const {
    const ElementState& state = memory.state[e];
    const auto away =
        static_cast<float>(reinterpret_cast<const double*>(&state.position)[axis] -
                           reinterpret_cast<const double*>(memory.reference + e)[axis]);
    const auto speed = static_cast<float>(reinterpret_cast<const double*>(&state.velocity)[axis]);
    const Vec3& gravity = all.move.kick.gravity;
    const auto weight = static_cast<float>(axis == 0   ? gravity.x
                                           : axis == 1 ? gravity.y
                                                       : gravity.z);
    if ((memory.fixed[e] >> axis & 1) != 0) return {fabsf(away), 0.0F, 0.0F, 0.0F};
    return {fabsf(away), fabsf(speed), fabsf(weight), memory.over_mass[e]};
  }
};

}  // namespace breccia::dem
