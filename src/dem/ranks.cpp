#include "dem/ranks.hpp"

#include <algorithm>

#include "dem/energy.hpp"
#include "dem/relations.hpp"
#include "domain/drift.hpp"
#include "domain/ghosts.hpp"
#include "domain/owned.hpp"

namespace breccia::dem {
namespace {

/// Sends everything to the ranks that need it: elements and what ties them together.
class Migration {
 public:
  /// @param owner    rank that each local element will belong to
  /// @param actions  of contacts, on the host, that go with them; null: none
  Migration(World& w, const std::vector<int>& owner, Buffer<PairForce>* actions)
      : w_(w),
        actions_(actions),
        elements_(w.domain.ranks->size()),
        shared_items_(w.domain, owner, elements_) {}

  /// Besides the owner, the ranks whose elements may touch one get a copy.
  void add_copies(const std::vector<Sphere>& around) {
    add_ghosts(w_.domain, around, shared_items_, elements_);
  }

  void go() {
    for (Index e = 0; e < w_.elements.size(); ++e)
      if (w_.domain.owns(e)) elements_.add(shared_items_.owner_of(e), e);
    const int ranks = w_.domain.ranks->size();
    std::vector<SendLists> links(link_kinds, SendLists(ranks));
    SendLists contacts(ranks), walls(ranks);
    w_.each_set([&](const auto& set) {
      shared_items_.keep_all_together(element_ends(w_, set.name), set.size(),
                                      links[static_cast<std::size_t>(set.kind)]);
    });
    shared_items_.keep_all_together(element_ends(w_, "contacts"), w_.contacts.size(), contacts);
    shared_items_.keep_all_together(element_ends(w_, "wall_contacts"), w_.wall_contacts.size(),
                                    walls);

    renumber_relations(w_, [this](Index e) { return w_.elements.id.data()[e]; });
    Communicator& all = *w_.domain.ranks;
    redistribute(all, together(w_.elements, w_.travel), elements_, w_.elements.id);
    std::vector<Buffer<PairForce>> on_links = split_actions();
    w_.each_set([&](auto& set) {
      const auto kind = static_cast<std::size_t>(set.kind);
      auto number = one_field(set.numbers);
      auto actions = one_field(on_links[kind]);
      if constexpr (std::remove_reference_t<decltype(set)>::swept)
        redistribute(all, together(set.arrays(), number), links[kind], set.numbers);
      else
        redistribute(all, together(set.arrays(), number, actions), links[kind], set.numbers);
    });
    if (actions_ != nullptr) {
      auto actions = one_field(*actions_);
      redistribute(all, together(w_.contacts, actions), contacts, w_.contacts.pairs.key);
    } else {
      redistribute(all, w_.contacts, contacts, w_.contacts.pairs.key);
    }
    redistribute(all, w_.wall_contacts, walls, w_.wall_contacts.pairs.key);
    join_actions(on_links);
    Places places(w_.elements.id);
    renumber_relations(w_, [&places](Index id) { return places.of(id); });
  }

 private:
  /// Bar forces are output between steps, so they migrate with their links.
  std::vector<Buffer<PairForce>> split_actions() const {
    std::vector<Buffer<PairForce>> on_links(link_kinds);
    const PairForce* from = w_.bar_actions.data();
    w_.each_set([&](const auto& set) {
      if (set.swept) return;
      Buffer<PairForce>& own = on_links[static_cast<std::size_t>(set.kind)];
      own.resize(set.size());
      std::copy_n(from, set.size(), own.data());
      from += set.size();
    });
    return on_links;
  }
  void join_actions(const std::vector<Buffer<PairForce>>& on_links) {
    Index count = 0;
    for (const Buffer<PairForce>& own : on_links) count += own.size();
    w_.bar_actions.resize(count);
    PairForce* to = w_.bar_actions.data();
    for (const Buffer<PairForce>& own : on_links) to = std::copy_n(own.data(), own.size(), to);
  }

  World& w_;
  Buffer<PairForce>* actions_;
  SendLists elements_;
  SharedItems shared_items_;
};

/// Links of each group lie together in memory, as in the whole model.
template <class Law>
void divide(LinkSet<Law>& set) {
  const auto all = set.numbers.host();
  const auto place = [&](Index number) {
    return static_cast<Index>(std::lower_bound(all.begin(), all.end(), number) - all.begin());
  };
  for (LinkGroup<Law>& group : set.groups) {
    group.begin = place(group.first_number);
    group.end = place(group.end_number);
  }
}

struct MarginNow {
  MarginRule rule;
  Vec3 drift;  ///<  [m/s]
  View<const ElementState> state;
  BR_HD double operator()(Index e) const { return rule.margin(state[e].velocity - drift); }
};

/// 1 where an element has left the buffer.
struct HasLeft {
  double allowed;  ///< square of the way that it may go  [m2]
  Vec3 drifted;    ///< common to all since they were shared out  [m]
  View<const ElementState> state;
  View<const Vec3> reference;
  BR_HD double operator()(Index e) const {
    const Vec3 moved = (state[e].position - reference[e]) - drifted;
    return dot(moved, moved) <= allowed ? 0.0 : 1.0;
  }
};

class Spheres final : public Shareable {
 public:
  /// @param space          where the elements go when they have settled in
  /// @param between_steps  probes may read what contacts do before the next step finds it anew
  Spheres(World& w, Space space, bool between_steps)
      : w_(w), space_(space), between_steps_(between_steps) {
    if (!between_steps) return;
    copy_to(actions_, w.contact_actions);
    actions_.resize(w.contacts.size());
  }

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
    w_.each_set([&](const auto& set) {
      for (const Buffer<Index>* ends : {&set.a, &set.b})
        add(*ends, set.swept ? end_of_link : other_end);
    });
    for (const Buffer<Index>* ends :
         {&w_.contacts.pairs.a, &w_.contacts.pairs.b, &w_.wall_contacts.pairs.a})
      add(*ends, other_end);
    return weight;
  }
  double margin() const override {
    return fold_owned(w_.exec, w_.domain, w_.elements.size(), 0.0,
                      MarginNow{margin_rule(w_), w_.travel.drift.velocity,
                                std::as_const(w_.elements.state).view()},
                      Largest{});
  }
  bool has_left() const override {
    const HasLeft left{w_.domain.buffer * w_.domain.buffer, w_.domain.drifted,
                       std::as_const(w_.elements.state).view(),
                       std::as_const(w_.domain.migration_reference).view()};
    return fold_owned(w_.exec, w_.domain, w_.elements.size(), 0.0, left, Largest{}) > 0.0;
  }
  double largest_margin() const override { return w_.given->largest_margin; }
  void send(const std::vector<int>& owner, const std::vector<Sphere>& around) override {
    Migration migration(w_, owner, between_steps_ ? &actions_ : nullptr);
    migration.add_copies(around);
    migration.go();
  }
  void settle_in() override {
    w_.each_set([](auto& set) { divide(set); });
    w_.domain.tied.assign(static_cast<std::size_t>(w_.elements.size()), 0);
    mark_joined(w_, w_.domain.tied);
    move_to(w_, space_);
    set_linked_pairs(w_);
    derive(w_);
    if (between_steps_) copy_to(w_.contact_actions, actions_);
  }

 private:
  const Buffer<ElementState>& states() const {
    return w_.elements.state.space() == Space::host ? w_.elements.state : seen_;
  }

  World& w_;
  Space space_;
  bool between_steps_;
  Buffer<ElementState> seen_;  ///< on the host, while elements are elsewhere
  Buffer<PairForce> actions_;  ///< of contacts, on the host; between steps only
};

/// Numbers the links of a whole model.
template <class Law>
void number(LinkSet<Law>& set) {
  set.numbers.resize(set.size());
  for (Index i = 0; i < set.size(); ++i) set.numbers.data()[i] = i;
}

}  // namespace

void drop_state(World& w) {
  resize_fields(w.elements, 0);
  resize_fields(w.travel, 0);
  w.each_set([](auto& set) { resize_fields(set, 0); });
  resize_fields(w.contacts, 0);
  resize_fields(w.wall_contacts, 0);
  w.bar_actions.resize(0);
}

World share_out(const World& whole, Communicator& ranks, const DomainConfig& config, Space space) {
  World w = whole;
  w.each_set([](auto& set) {
    for (auto& group : set.groups) {
      group.first_number = group.begin;
      group.end_number = group.end;
    }
  });
  if (ranks.rank() != 0) drop_state(w);
  w.each_set([](auto& set) { number(set); });
  return share_parts(std::move(w), ranks, config, space);
}

World share_parts(World part, Communicator& ranks, const DomainConfig& config, Space space) {
  take_time_from_first(ranks, part);
  for (Wall& wall : part.walls) take_from_first(ranks, wall);
  for (FreeWallState& wall : part.free_walls) take_from_first(ranks, wall);
  take_from_first(ranks, part.travel.drift);
  for (ServoState& servo : part.servos) take_from_first(ranks, servo);
  part.ledger = {};  // what this rank books from here on
  Spheres spheres(part, space, true);
  begin_sharing(part.domain, ranks, config, spheres, 2.0 * part.given->mean_radius, 3);
  part.domain.drifted_until = part.time;
  share_anew(part.domain, spheres, true);
  select_active_ghosts(part);
  return part;
}

void migrate(World& w) {
  if (w.domain.single_rank()) return;
  Spheres spheres(w, w.exec.space, false);
  breccia::migrate(w, spheres);
}

void rebalance(World& w) {
  if (!is_uneven(w.domain)) return;
  Spheres spheres(w, w.exec.space, true);
  breccia::rebalance(w, w.travel.drift.velocity, spheres);
  select_active_ghosts(w);
}

void collect(World& part, World& whole) {
  World copy(Exec{});
  copy.elements = host_copy(part.elements);
  copy.travel = host_copy(part.travel);
  each_two_sets(copy, part, [](auto& to, const auto& from) {
    to.arrays() = host_copy(from.arrays());
    to.numbers = from.numbers;
  });
  copy.contacts = host_copy(part.contacts);
  copy.wall_contacts = host_copy(part.wall_contacts);
  copy_to(copy.bar_actions, part.bar_actions);
  copy.domain.ranks = part.domain.ranks;
  copy.domain.owned = part.domain.owned;
  Migration(copy, std::vector<int>(static_cast<std::size_t>(part.elements.size()), 0), nullptr)
      .go();

  const std::vector<Ledger> booked = from_each(*part.domain.ranks, part.ledger);
  part.ledger = {};
  if (part.domain.ranks->rank() != 0) return;
  for (const Ledger& ledger : booked) whole.ledger.add(ledger);
  whole.elements = std::move(copy.elements);
  whole.travel = std::move(copy.travel);
  each_two_sets(whole, copy, [](auto& to, auto& from) { to.arrays() = std::move(from.arrays()); });
  whole.contacts = std::move(copy.contacts);
  whole.wall_contacts = std::move(copy.wall_contacts);
  whole.bar_actions = std::move(copy.bar_actions);
  whole.walls = part.walls;
  whole.free_walls = part.free_walls;
  whole.servos = part.servos;
  whole.domain.partition = partition_at(part.domain, part.travel.drift.velocity, part.time);
  copy_time(part, whole);
}

}  // namespace breccia::dem
