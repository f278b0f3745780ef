#include "dem/ranks.hpp"

#include <algorithm>
#include <array>

namespace breccia::dem {
namespace {

/// Numbers memory indices of a link's ends by `number`: to global ids before a journey, to places
/// in memory after it.
template <class Number>
void renumber(Buffer<Index>& ends, const Number& number) {
  for (Index& end : ends.host()) end = number(end);
}
template <class Number>
void renumber_all(World& w, const Number& number) {
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
      : w_(w), owner_(owner), elements_(w.domain.ranks->size()) {}

  /// Besides the owner, the ranks whose rectangle is within `width` of an element get a copy.
  void add_copies(double width) {
    const Partition& partition = w_.domain.partition;
    for (Index e = 0; e < w_.elements.size(); ++e) {
      if (!w_.domain.owns(e)) continue;
      const ElementState& s = w_.elements.state.data()[e];
      partition.each_near(s.position, s.radius + width, [&](int r) { elements_.add(r, e); });
    }
  }

  void go() {
    for (Index e = 0; e < w_.elements.size(); ++e)
      if (w_.domain.owns(e)) elements_.add(owner_of(e), e);
    const int ranks = w_.domain.ranks->size();
    Deliveries concrete(ranks), steel(ranks), interface(ranks), contacts(ranks), walls(ranks);
    const ConcreteLinks& c = w_.concrete;
    for (Index i = 0; i < c.size(); ++i) tie(std::array{c.a.data()[i], c.b.data()[i]}, i, concrete);
    const SteelLinks& s = w_.steel;
    for (Index i = 0; i < s.size(); ++i) tie(std::array{s.a.data()[i], s.b.data()[i]}, i, steel);
    const InterfaceLinks& b = w_.interface;
    for (Index i = 0; i < b.size(); ++i)
      tie(std::array{b.a.data()[i], b.b.data()[i], b.before.data()[i], b.after.data()[i]}, i,
          interface);
    const Pairs &pairs = w_.contacts.pairs, &at_walls = w_.wall_contacts.pairs;
    for (Index i = 0; i < pairs.size(); ++i)
      tie(std::array{pairs.a.data()[i], pairs.b.data()[i]}, i, contacts);
    for (Index i = 0; i < at_walls.size(); ++i) tie(std::array{at_walls.a.data()[i]}, i, walls);

    renumber_all(w_, [this](Index e) { return w_.elements.id.data()[e]; });
    send(together(w_.elements, w_.travel), elements_, w_.elements.id);
    auto concrete_number = one_field(w_.numbers.concrete),
         steel_number = one_field(w_.numbers.steel),
         interface_number = one_field(w_.numbers.interface);
    Buffer<Action> on_steel, on_interface;
    split_actions(on_steel, on_interface);
    auto steel_actions = one_field(on_steel), interface_actions = one_field(on_interface);
    send(together(w_.concrete, concrete_number), concrete, w_.numbers.concrete);
    send(together(w_.steel, steel_number, steel_actions), steel, w_.numbers.steel);
    send(together(w_.interface, interface_number, interface_actions), interface,
         w_.numbers.interface);
    send(w_.contacts, contacts, w_.contacts.pairs.key);
    send(w_.wall_contacts, walls, w_.wall_contacts.pairs.key);
    join_actions(on_steel, on_interface);
    renumber_all(w_, [this](Index id) { return place_of(w_.elements.id, id); });
  }

 private:
  int owner_of(Index e) const { return owner_[static_cast<std::size_t>(e)]; }

  /// What refers to several elements lives wherever one of them is owned, and so do all of them.
  template <std::size_t n>
  void tie(const std::array<Index, n>& elements, Index item, Deliveries& items) {
    for (const Index e : elements) {
      if (!w_.domain.owns(e)) continue;
      for (const Index other : elements) {
        if (e == elements[0]) items.add(owner_of(other), item);
        if (owner_of(other) != owner_of(e)) elements_.add(owner_of(other), e);
      }
    }
  }

  template <class State, class Key>
  void send(State&& state, Deliveries& to, const Buffer<Key>& key) {
    to.settle();
    deal(*w_.domain.ranks, state, to);
    sort_by(state, key);
  }

  /// What bars do is observed between steps, so it goes along.
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
  const std::vector<int>& owner_;
  Deliveries elements_;
};

/// The largest margin that a search now would give an element that this rank owns.  [m]
double margin_now(const World& w) {
  const MarginRule rule = margin_rule(w);
  double largest = 0.0;
  for (Index e = 0; e < w.elements.size(); ++e)
    if (w.domain.owns(e))
      largest = std::max(largest, rule.margin(w.elements.state.data()[e].velocity));
  return largest;
}

/// How far beyond their own radius elements reach others of the same rank, until they are shared
/// out again (docs/theory-domain.md, section 2).
double halo_width(const World& w) {
  double largest = 0.0;
  for (const ElementState& s : w.elements.state.host()) largest = std::max(largest, s.radius);
  largest = -w.domain.least(-largest);
  const double width = largest + 2.0 * w.domain.margin + 2.0 * w.domain.buffer;
  return width * (1.0 + 1e-6);
}

/// What an element costs: itself, and each of its links and contacts; shared ones by half.
std::vector<Load> loads_of(const World& w) {
  std::vector<std::int64_t> weight(static_cast<std::size_t>(w.elements.size()), 2);
  const auto count = [&](const Buffer<Index>& ends) {
    for (const Index e : ends.host()) ++weight[static_cast<std::size_t>(e)];
  };
  for (const Buffer<Index>* ends :
       {&w.concrete.a, &w.concrete.b, &w.steel.a, &w.steel.b, &w.interface.a, &w.interface.b,
        &w.contacts.pairs.a, &w.contacts.pairs.b, &w.wall_contacts.pairs.a})
    count(*ends);
  std::vector<Load> loads;
  for (Index e = 0; e < w.elements.size(); ++e)
    if (w.domain.owns(e))
      loads.push_back({w.elements.state.data()[e].position, weight[static_cast<std::size_t>(e)]});
  return loads;
}

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

std::vector<int> owners(const World& w) {
  std::vector<int> owner;
  for (const ElementState& s : w.elements.state.host())
    owner.push_back(w.domain.partition.owner(s.position));
  return owner;
}

void share_anew(World& w, bool first) {
  Domain& d = w.domain;
  const std::vector<Load> loads = loads_of(w);
  std::int64_t load = 0;
  for (const Load& l : loads) load += l.weight;
  if (first || (d.config.balance && imbalance(*d.ranks, load) > d.config.imbalance)) {
    d.partition.cut(*d.ranks, loads);
    ++d.counts.cuts;
  }
  // Elements may become faster until they are shared out again.
  d.margin = std::min(w.parameters.largest_margin, -1.5 * d.least(-margin_now(w)));
  const std::vector<int> next_owner = owners(w);
  Journey journey(w, next_owner);
  journey.add_copies(halo_width(w));
  std::vector<GlobalId> mine;  // before
  for (Index e = 0; e < w.elements.size(); ++e)
    if (d.owns(e)) mine.push_back(w.elements.id.data()[e]);
  journey.go();

  const std::vector<int> owner = owners(w);
  const Index count = w.elements.size();
  d.owned.resize(count);
  d.placed.resize(static_cast<std::size_t>(count));
  for (Index e = 0; e < count; ++e) {
    const bool own = owner[static_cast<std::size_t>(e)] == d.ranks->rank();
    d.owned.data()[e] = own ? 1 : 0;
    d.placed[static_cast<std::size_t>(e)] = w.elements.state.data()[e].position;
    if (own && !std::binary_search(mine.begin(), mine.end(), w.elements.id.data()[e]))
      ++d.counts.moved;
  }
  d.halo.build(*d.ranks, w.elements.id, owner);
  d.counts.copies = d.halo.copies();
  d.counts.owned = count - d.halo.copies();
  d.counts.load = 0;
  for (const Load& l : loads_of(w)) d.counts.load += l.weight;
  ++d.counts.migrations;
  divide(w.concrete_groups, w.numbers.concrete);
  divide(w.steel_groups, w.numbers.steel);
  divide(w.interface_groups, w.numbers.interface);
  set_linked_pairs(w);
  derive(w);
}

/// Whether some element has left the buffer; nowhere (NaN) counts as left.
bool has_left(const World& w) {
  const double allowed = w.domain.buffer * w.domain.buffer;
  for (Index e = 0; e < w.elements.size(); ++e) {
    const Vec3 moved =
        w.elements.state.data()[e].position - w.domain.placed[static_cast<std::size_t>(e)];
    if (w.domain.owns(e) && !(dot(moved, moved) <= allowed)) return true;
  }
  return false;
}

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

void refresh_copies(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh(w.elements.state);
}

World share_out(const World& whole, Communicator& ranks, const DomainConfig& config) {
  World w = whole;
  Domain& d = w.domain;
  d.ranks = &ranks;
  d.config = config;
  d.buffer = config.buffer * 2.0 * w.parameters.mean_radius;
  note_numbers(w.concrete_groups);
  note_numbers(w.steel_groups);
  note_numbers(w.interface_groups);
  if (ranks.rank() != 0) drop_state(w);
  for (double* time : {&w.time, &w.last_dt, &w.next_dt}) take_from_first(ranks, *time);
  take_from_first(ranks, w.step);
  take_from_first(ranks, w.searches);
  for (Wall& wall : w.walls) take_from_first(ranks, wall);
  w.ledger = {};  // what this rank books from here on
  d.owned.resize(w.elements.size());
  std::fill(d.owned.host().begin(), d.owned.host().end(), std::uint8_t{1});
  number(w.numbers.concrete, w.concrete.size());
  number(w.numbers.steel, w.steel.size());
  number(w.numbers.interface, w.interface.size());

  Vec3 low{no_limit, no_limit, no_limit}, minus_high = low;
  for (const ElementState& s : w.elements.state.host()) {
    const Vec3& x = s.position;
    low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
    minus_high = {std::min(minus_high.x, -x.x), std::min(minus_high.y, -x.y),
                  std::min(minus_high.z, -x.z)};
  }
  low = {ranks.least(low.x), ranks.least(low.y), ranks.least(low.z)};
  minus_high = {ranks.least(minus_high.x), ranks.least(minus_high.y), ranks.least(minus_high.z)};
  d.partition = Partition(ranks.size(), low, -minus_high - low,
                          2.0 * w.parameters.mean_radius / config.refinement, 3);
  share_anew(w, true);
  return w;
}

void migrate(World& w) {
  if (w.domain.alone()) return;
  const StageTime timed(w.exec, "migration");
  const bool beyond = has_left(w) || !(margin_now(w) <= w.domain.margin);
  if (w.domain.any(beyond)) share_anew(w, false);
}

void collect(World& part, World& whole) {
  World copy(part.exec);
  copy.elements = part.elements;
  copy.travel = part.travel;
  copy.concrete = part.concrete;
  copy.steel = part.steel;
  copy.interface = part.interface;
  copy.contacts = part.contacts;
  copy.wall_contacts = part.wall_contacts;
  copy.numbers = part.numbers;
  copy.bar_actions = part.bar_actions;
  copy.domain.ranks = part.domain.ranks;
  copy.domain.owned = part.domain.owned;
  Journey(copy, std::vector<int>(static_cast<std::size_t>(part.elements.size()), 0)).go();

  Message booked(sizeof part.ledger);
  std::memcpy(booked.data(), &part.ledger, sizeof part.ledger);
  const std::vector<Message> all = part.domain.ranks->from_all(booked);
  part.ledger = {};
  if (part.domain.ranks->rank() != 0) return;
  for (const Message& message : all) {
    Ledger ledger;
    std::memcpy(&ledger, message.data(), sizeof ledger);
    whole.ledger.slid.add(ledger.slid);
    whole.ledger.damped.add(ledger.damped);
    whole.ledger.driven.add(ledger.driven);
  }
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
  whole.time = part.time;
  whole.last_dt = part.last_dt;
  whole.next_dt = part.next_dt;
  whole.step = part.step;
  whole.searches = part.searches;
}

}  // namespace breccia::dem
