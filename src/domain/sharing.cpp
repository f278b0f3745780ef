#include "domain/sharing.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

namespace breccia {
namespace {

/// Runs of packs with own elements: ghosts among them cost less than what is left over.
std::vector<ElementRun> own_runs(const Domain& d) {
  constexpr Index pack = 8;
  const Index count = d.owned.size();
  std::vector<ElementRun> runs;
  for (Index e = 0; e < count; ++e) {
    if (!d.owns(e)) continue;
    const Index begin = e / pack * pack;
    if (runs.empty() || begin > runs.back().end) runs.push_back({begin, begin});
    runs.back().end = std::min(begin + pack, count);
  }
  return runs;
}

/// The cost of a rank's own elements.
std::int64_t load_of(const Domain& d, const std::vector<std::int64_t>& weights) {
  std::int64_t sum = 0;
  for (std::size_t e = 0; e < weights.size(); ++e)
    if (d.owns(static_cast<Index>(e))) sum += weights[e];
  return sum;
}

/// Whether ghosts of an own element, or of what is near it, may be missing somewhere: it has left
/// the buffer and matters now to ranks that do not hold it, or is no longer at home
/// (docs/theory-domain.md, section 2).
bool strays(const Domain& d, const Shareable& elements, Index e) {
  const SharingSets& sets = d.sharing_sets;
  const Sphere& then = d.migration_reference_spheres[static_cast<std::size_t>(e)];
  const Sphere now{elements.centre(e) - d.drifted, elements.radius(e)};
  const Vec3 moved = now.centre - then.centre;
  const double half = 0.5 * d.buffer;
  if (dot(moved, moved) <= half * half && now.radius <= then.radius + half &&
      sets.is_large(now.radius) == sets.is_large(then.radius))
    return false;  // near where it was, whatever that is near to
  bool at_home = false, held = true;
  if (sets.is_large(then.radius)) {
    at_home = sets.is_within(now, then);
  } else if (!sets.is_large(now.radius)) {
    d.partition.each_near(now.centre, d.buffer, [&](int r) { at_home |= r == d.ranks->rank(); });
  }
  sets.each_sharer(d.partition, now, 0.0, [&](int wanted) {
    bool before = false;
    sets.each_sharer(d.partition, then, sets.buffer(then.radius),
                     [&](int r) { before |= r == wanted; });
    held = held && before;
  });
  return !at_home || !held;
}

/// Whether this rank's load has become too much. On devices elements must be fetched to know.
bool has_grown(const Domain& d, const Shareable& elements) {
  if (!d.config.balance || elements.space() != Space::host) return false;
  const auto then = static_cast<double>(std::max(d.counts.load, d.mean_load));
  return static_cast<double>(load_of(d, elements.weights())) >
         (1.0 + 2.0 * d.config.imbalance) * then;
}

bool some_stray(const Domain& d, Shareable& elements) {
  if (!elements.has_left()) return false;
  elements.look();
  for (Index e = 0; e < elements.ids().size(); ++e)
    if (d.owns(e) && strays(d, elements, e)) return true;
  return false;
}

}  // namespace

void begin_sharing(Domain& d, Communicator& ranks, const DomainConfig& config,
                   const Shareable& elements, double mean_size, int depth) {
  d.ranks = &ranks;
  d.config = config;
  d.buffer = config.buffer * mean_size;
  const Index count = elements.ids().size();
  d.owned.resize(count);
  std::fill(d.owned.host().begin(), d.owned.host().end(), std::uint8_t{1});
  d.owned_there = d.owned;
  constexpr double far = std::numeric_limits<double>::max();
  Vec3 low{far, far, far}, minus_high = low;
  for (Index e = 0; e < count; ++e) {
    const Vec3 x = elements.centre(e);
    low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
    minus_high = {std::min(minus_high.x, -x.x), std::min(minus_high.y, -x.y),
                  std::min(minus_high.z, -x.z)};
  }
  low = {ranks.least(low.x), ranks.least(low.y), ranks.least(low.z)};
  minus_high = {ranks.least(minus_high.x), ranks.least(minus_high.y), ranks.least(minus_high.z)};
  d.partition =
      Partition(ranks.size(), low, -minus_high - low, mean_size / config.refinement, depth);
}

namespace {

std::vector<Sphere> around_each(const Shareable& elements) {
  std::vector<Sphere> around;
  around.reserve(static_cast<std::size_t>(elements.ids().size()));
  for (Index e = 0; e < elements.ids().size(); ++e)
    around.push_back({elements.centre(e), elements.radius(e)});
  return around;
}

/// The ranks that own the elements by the borders of now.
std::vector<int> owners(const Partition& partition, const std::vector<Sphere>& around) {
  std::vector<int> owner;
  owner.reserve(around.size());
  for (const Sphere& e : around) owner.push_back(partition.owner(e.centre));
  return owner;
}

void cut(Domain& d, const std::vector<Sphere>& around, const std::vector<std::int64_t>& weights) {
  std::vector<Load> loads;
  for (std::size_t e = 0; e < around.size(); ++e)
    if (d.owns(static_cast<Index>(e))) loads.push_back({around[e].centre, weights[e]});
  d.partition.cut(*d.ranks, loads);
  ++d.counts.cuts;
}

void build_sharing_sets(Domain& d, const std::vector<Sphere>& around,
                        const std::vector<int>& owner) {
  std::vector<Sphere> own;
  std::vector<int> owner_of_own;
  for (std::size_t e = 0; e < around.size(); ++e) {
    if (!d.owns(static_cast<Index>(e))) continue;
    own.push_back(around[e]);
    owner_of_own.push_back(owner[e]);
  }
  d.sharing_sets.build(*d.ranks, own, owner_of_own, {d.margin, d.buffer, d.config.buffer});
}

}  // namespace

void share_anew(Domain& d, Shareable& elements, bool first) {
  const auto begin = std::chrono::steady_clock::now();
  d.partition.move(d.drifted);
  d.drifted = {};
  if (!first && d.config.balance) d.pace.measure(*d.ranks, d.counts.load);
  std::vector<Sphere> around = around_each(elements);
  std::vector<std::int64_t> weights = elements.weights();
  for (std::int64_t& weight : weights) weight = d.pace.weighed(weight);
  if (first || (d.config.balance && imbalance(*d.ranks, load_of(d, weights)) > d.config.imbalance))
    cut(d, around, weights);
  // Elements may become faster until they are shared out again.
  d.margin = std::min(elements.largest_margin(), -1.5 * d.least(-elements.margin()));
  std::vector<GlobalId> mine;  // before
  for (Index e = 0; e < elements.ids().size(); ++e)
    if (d.owns(e)) mine.push_back(elements.ids().data()[e]);
  std::vector<int> owner = owners(d.partition, around);
  build_sharing_sets(d, around, owner);
  elements.send(owner, around);

  around = around_each(elements);
  owner = owners(d.partition, around);
  const Index count = elements.ids().size();
  d.owned.resize(count);
  auto known = mine.begin();
  for (Index e = 0; e < count; ++e) {
    const bool own = owner[static_cast<std::size_t>(e)] == d.ranks->rank();
    d.owned.data()[e] = own ? 1 : 0;
    const GlobalId id = elements.ids().data()[e];
    while (known != mine.end() && *known < id) ++known;
    if (own && (known == mine.end() || *known != id)) ++d.counts.moved;
  }
  d.ghosts.clear();
  for (Index e = 0; e < count; ++e)
    if (!d.owns(e)) d.ghosts.push_back({e, owner[static_cast<std::size_t>(e)]});
  d.ghosts_selected = false;
  d.runs = d.boundary_runs = own_runs(d);
  d.interior_runs.clear();
  copy_to(d.migration_reference, elements.points());
  d.migration_reference_spheres = std::move(around);
  copy_to(d.owned_there, d.owned);
  d.halo.build(*d.ranks, elements.ids(), d.ghosts, elements.space());
  d.counts.ghosts = d.halo.ghosts();
  d.counts.owned = count - d.halo.ghosts();
  d.counts.load = load_of(d, elements.weights());
  std::vector<std::int64_t> all{d.counts.load};
  d.ranks->add_up(all);
  d.mean_load = all[0] / d.ranks->size();
  d.counts.weighed = d.pace.weighed(d.counts.load);
  ++d.counts.migrations;
  elements.settle_in();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  // The first time is not as long another time; but to and from a device it is long.
  const bool tells = !first || elements.space() != Space::host;
  d.pace.begin_again(*d.ranks, tells ? took.count() : 0.0);
}

void share_if_needed(Domain& d, Shareable& elements) {
  const bool beyond =
      some_stray(d, elements) || !(elements.margin() <= d.margin) || has_grown(d, elements);
  if (!d.any(beyond)) return;
  elements.come_to_host();
  share_anew(d, elements, false);
}

bool is_uneven(const Domain& d) {
  return !d.single_rank() && d.config.balance &&
         d.pace.spent(*d.ranks).is_uneven(d.config.imbalance);
}

}  // namespace breccia
