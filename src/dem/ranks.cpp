#include "dem/ranks.hpp"

#include <algorithm>
#include <array>

#include "dem/energy.hpp"
#include "domain/sharing.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// Numbers memory indices of a link's ends by `number`: to global ids before a journey, to places
/// in memory after it.
template <class Number>
void renumber(Buffer<Index>& ends, Number& number) {
  for (Index& end : ends.host()) end = number(end);
}
template <class Number>
void renumber_all(World& w, Number number) {
  for (Buffer<Index>* ends : {&w.concrete.a, &w.concrete.b, &w.steel.a, &w.steel.b, &w.interface.a,
                              &w.interface.b, &w.interface.before, &w.interface.after,
                              &w.contacts.pairs.a, &w.contacts.pairs.b, &w.wall_contacts.pairs.a})
    renumber(*ends, number);
}

/// Sends everything to the ranks that need it: elements and what ties them together.
class Journey {
 public:
  /// @param owner  rank that each local element will belong to
  Journey(World& w, const std::vector<int>& owner)
      : w_(w), elements_(w.domain.ranks->size()), ties_(w.domain, owner, elements_) {}

  /// Besides the owner, the ranks whose elements may touch one get a copy.
  void add_copies(const std::vector<Sphere>& around) {
    for (Index e = 0; e < w_.elements.size(); ++e)
      if (w_.domain.owns(e))
        w_.domain.each_sharer(around[static_cast<std::size_t>(e)], [&](int r) {
          if (r != ties_.owner_of(e)) elements_.add(r, e);
        });
  }

  void go() {
    for (Index e = 0; e < w_.elements.size(); ++e)
      if (w_.domain.owns(e)) elements_.add(ties_.owner_of(e), e);
    const int ranks = w_.domain.ranks->size();
    Deliveries concrete(ranks), steel(ranks), interface(ranks), contacts(ranks), walls(ranks);
    const InterfaceLinks& b = w_.interface;
    for (Index i = 0; i < b.size(); ++i)
      ties_.tie(std::array{b.a.data()[i], b.b.data()[i], b.before.data()[i], b.after.data()[i]}, i,
                interface);
    tie_all(w_.concrete, concrete);
    tie_all(w_.steel, steel);
    tie_all(w_.contacts.pairs, contacts);
    const Pairs& at_walls = w_.wall_contacts.pairs;
    for (Index i = 0; i < at_walls.size(); ++i)
      ties_.tie(std::array{at_walls.a.data()[i]}, i, walls);

    renumber_all(w_, [this](Index e) { return w_.elements.id.data()[e]; });
    Communicator& all = *w_.domain.ranks;
    deal(all, together(w_.elements, w_.travel), elements_, w_.elements.id);
    auto concrete_number = one_field(w_.numbers.concrete),
         steel_number = one_field(w_.numbers.steel),
         interface_number = one_field(w_.numbers.interface);
    Buffer<Action> on_steel, on_interface;
    split_actions(on_steel, on_interface);
    auto steel_actions = one_field(on_steel), interface_actions = one_field(on_interface);
    deal(all, together(w_.concrete, concrete_number), concrete, w_.numbers.concrete);
    deal(all, together(w_.steel, steel_number, steel_actions), steel, w_.numbers.steel);
    deal(all, together(w_.interface, interface_number, interface_actions), interface,
         w_.numbers.interface);
    deal(all, w_.contacts, contacts, w_.contacts.pairs.key);
    deal(all, w_.wall_contacts, walls, w_.wall_contacts.pairs.key);
    join_actions(on_steel, on_interface);
    renumber_all(w_, [places = Places(w_.elements.id)](Index id) mutable { return places.of(id); });
  }

 private:
  template <class Links>
  void tie_all(const Links& links, Deliveries& items) {
    for (Index i = 0; i < links.size(); ++i)
      ties_.tie(std::array{links.a.data()[i], links.b.data()[i]}, i, items);
  }

  /// Bar forces are output between steps, so they migrate with their links.
  void split_actions(Buffer<Action>& on_steel, Buffer<Action>& on_interface) const {
    on_steel.resize(w_.steel.size());
    on_interface.resize(w_.interface.size());
    const auto all = w_.bar_actions.host();
    std::copy_n(all.begin(), on_steel.size(), on_steel.host().begin());
    std::copy_n(all.begin() + on_steel.size(), on_interface.size(), on_interface.host().begin());
  }
  void join_actions(const Buffer<Action>& on_steel, const Buffer<Action>& on_interface) {
    w_.bar_actions.resize(on_steel.size() + on_interface.size());
    const auto all = w_.bar_actions.host();
    std::copy(on_steel.host().begin(), on_steel.host().end(), all.begin());
    std::copy(on_interface.host().begin(), on_interface.host().end(),
              all.begin() + on_steel.size());
  }

  World& w_;
  Deliveries elements_;
  Ties ties_;
};

/// Links of each group lie together in memory, as in the whole model.
template <class Law>
void divide(std::vector<LinkGroup<Law>>& groups, const Buffer<Index>& numbers) {
  const auto all = numbers.host();
  const auto place = [&](Index number) {
    return static_cast<Index>(std::lower_bound(all.begin(), all.end(), number) - all.begin());
  };
  for (LinkGroup<Law>& group : groups) {
    group.begin = place(group.first_number);
    group.end = place(group.end_number);
  }
}
template <class Law>
void note_numbers(std::vector<LinkGroup<Law>>& groups) {
  for (LinkGroup<Law>& group : groups) {
    group.first_number = group.begin;
    group.end_number = group.end;
  }
}

struct MarginNow {
  MarginRule rule;
  OwnedView owned;
  View<const ElementState> state;
  BR_HD double operator()(Index e) const { return owned(e) ? rule.margin(state[e].velocity) : 0.0; }
};

/// 1 where an element has left the buffer.
struct HasLeft {
  double allowed;  ///< square of the way that it may go  [m2]
  OwnedView owned;
  View<const ElementState> state;
  View<const Vec3> placed;
  BR_HD double operator()(Index e) const {
    const Vec3 moved = state[e].position - placed[e];
    return owned(e) && !(dot(moved, moved) <= allowed) ? 1.0 : 0.0;
  }
};

class Spheres final : public Shareable {
 public:
  /// @param space  where the elements go when they have settled in
  Spheres(World& w, Space space) : w_(w), space_(space) {}

  Space space() const override { return space_; }
  void come_to_host() override { move_to(w_, Space::host); }

  const Buffer<GlobalId>& ids() const override { return w_.elements.id; }
  void look() override {
    if (w_.elements.state.space() != Space::host) copy_to(seen_, w_.elements.state);
  }
  Vec3 centre(Index e) const override { return states().data()[e].position; }
  double radius(Index e) const override { return states().data()[e].radius; }
  std::vector<Vec3> points() const override {
    std::vector<Vec3> points;
    points.reserve(static_cast<std::size_t>(w_.elements.size()));
    for (const ElementState& s : w_.elements.state.host()) points.push_back(s.position);
    return points;
  }
  std::vector<std::int64_t> weights() const override {
    // By what they cost, in units of some 6 ns on one core (bench/notes/cpu.md).
    constexpr std::int64_t element = 5, end_of_link = 2, other_end = 3;
    std::vector<std::int64_t> weight(static_cast<std::size_t>(w_.elements.size()), element);
    const auto add = [&weight](const Buffer<Index>& ends, std::int64_t cost) {
      for (const Index e : ends.host()) weight[static_cast<std::size_t>(e)] += cost;
    };
    for (const Buffer<Index>* ends : {&w_.concrete.a, &w_.concrete.b}) add(*ends, end_of_link);
    for (const Buffer<Index>* ends :
         {&w_.steel.a, &w_.steel.b, &w_.interface.a, &w_.interface.b, &w_.contacts.pairs.a,
          &w_.contacts.pairs.b, &w_.wall_contacts.pairs.a})
      add(*ends, other_end);
    return weight;
  }
  double margin() const override {
    return fold(
        w_.exec, w_.elements.size(), 0.0,
        MarginNow{margin_rule(w_), w_.domain.owned_view(), std::as_const(w_.elements.state).view()},
        Largest{});
  }
  bool has_left() const override {
    return fold(w_.exec, w_.elements.size(), 0.0, has_left_kernel(), Largest{}) > 0.0;
  }
  double largest_margin() const override { return w_.parameters.largest_margin; }
  void send(const std::vector<int>& owner, const std::vector<Sphere>& around) override {
    Journey journey(w_, owner);
    journey.add_copies(around);
    journey.go();
  }
  void settle_in() override {
    divide(w_.concrete_groups, w_.numbers.concrete);
    divide(w_.steel_groups, w_.numbers.steel);
    divide(w_.interface_groups, w_.numbers.interface);
    w_.domain.tied.assign(static_cast<std::size_t>(w_.elements.size()), 0);
    for (const Buffer<Index>* ends :
         {&w_.concrete.a, &w_.concrete.b, &w_.steel.a, &w_.steel.b, &w_.interface.a,
          &w_.interface.b, &w_.interface.before, &w_.interface.after})
      for (const Index e : ends->host())
        if (e >= 0) w_.domain.tied[static_cast<std::size_t>(e)] = 1;
    move_to(w_, space_);
    set_linked_pairs(w_);
    derive(w_);
  }

 private:
  const Buffer<ElementState>& states() const {
    return w_.elements.state.space() == Space::host ? w_.elements.state : seen_;
  }
  HasLeft has_left_kernel() const {
    return {w_.domain.buffer * w_.domain.buffer, w_.domain.owned_view(),
            std::as_const(w_.elements.state).view(), std::as_const(w_.domain.placed).view()};
  }

  World& w_;
  Space space_;
  Buffer<ElementState> seen_;  ///< on the host, while elements are elsewhere
};

void number(Buffer<Index>& numbers, Index count) {
  numbers.resize(count);
  for (Index i = 0; i < count; ++i) numbers.data()[i] = i;
}

}  // namespace

void drop_state(World& w) {
  resize_fields(w.elements, 0);
  resize_fields(w.travel, 0);
  resize_fields(w.concrete, 0);
  resize_fields(w.steel, 0);
  resize_fields(w.interface, 0);
  resize_fields(w.contacts, 0);
  resize_fields(w.wall_contacts, 0);
  w.bar_actions.resize(0);
}

void start_copies(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.start_refresh(w.exec, w.elements.state);
}
void finish_copies(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.finish_refresh(w.exec, w.elements.state);
}
void refresh_copies(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh_all(w.exec, w.elements.state);
}

void feel_contacts(World& w) {
  // On a device the list costs more than it saves.
  if (w.domain.alone() || w.exec.space != Space::host) return;
  w.domain.feel(w.elements.id, w.contacts.pairs.a, w.contacts.pairs.b);
}

World share_out(const World& whole, Communicator& ranks, const DomainConfig& config, Space space) {
  World w = whole;
  note_numbers(w.concrete_groups);
  note_numbers(w.steel_groups);
  note_numbers(w.interface_groups);
  if (ranks.rank() != 0) drop_state(w);
  number(w.numbers.concrete, w.concrete.size());
  number(w.numbers.steel, w.steel.size());
  number(w.numbers.interface, w.interface.size());
  return share_parts(std::move(w), ranks, config, space);
}

World share_parts(World part, Communicator& ranks, const DomainConfig& config, Space space) {
  take_time_from_first(ranks, part);
  for (Wall& wall : part.walls) take_from_first(ranks, wall);
  part.ledger = {};  // what this rank books from here on
  Spheres spheres(part, space);
  begin_sharing(part.domain, ranks, config, spheres, 2.0 * part.parameters.mean_radius, 3);
  share_anew(part.domain, spheres, true);
  feel_contacts(part);
  return part;
}

void migrate(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "migration");
  Spheres spheres(w, w.exec.space);
  share_if_needed(w.domain, spheres);
}

void rebalance(World& w) {
  if (!is_uneven(w.domain)) return;
  const StageTime timed(w.exec, "migration");
  Spheres spheres(w, w.exec.space);
  spheres.come_to_host();
  share_anew(w.domain, spheres, false);
  feel_contacts(w);
}

void collect(World& part, World& whole) {
  World copy(Exec{});
  copy.elements = host_copy(part.elements);
  copy.travel = host_copy(part.travel);
  copy.concrete = host_copy(part.concrete);
  copy.steel = host_copy(part.steel);
  copy.interface = host_copy(part.interface);
  copy.contacts = host_copy(part.contacts);
  copy.wall_contacts = host_copy(part.wall_contacts);
  copy.numbers = part.numbers;
  copy_to(copy.bar_actions, part.bar_actions);
  copy.domain.ranks = part.domain.ranks;
  copy.domain.owned = part.domain.owned;
  Journey(copy, std::vector<int>(static_cast<std::size_t>(part.elements.size()), 0)).go();

  const std::vector<Ledger> booked = from_each(*part.domain.ranks, part.ledger);
  part.ledger = {};
  if (part.domain.ranks->rank() != 0) return;
  for (const Ledger& ledger : booked) whole.ledger.add(ledger);
  whole.elements = std::move(copy.elements);
  whole.travel = std::move(copy.travel);
  whole.concrete = std::move(copy.concrete);
  whole.steel = std::move(copy.steel);
  whole.interface = std::move(copy.interface);
  whole.contacts = std::move(copy.contacts);
  whole.wall_contacts = std::move(copy.wall_contacts);
  whole.bar_actions = std::move(copy.bar_actions);
  whole.walls = part.walls;
  whole.domain.partition = part.domain.partition;
  copy_time(part, whole);
}

}  // namespace breccia::dem
