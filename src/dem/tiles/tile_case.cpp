// Whether a world has tiles, what a launch of them gets, and what it leaves.

#include "dem/tiles/tile_case.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/stepping/launches.hpp"
#include "dem/tiles/tile_run.hpp"
#include "exec/error.hpp"
#include "exec/launch_times.hpp"
#include "exec/multiprocessors.hpp"

namespace breccia::dem {
namespace {

/// An array with room for more items than it has, which kernels may write.
template <class T>
View<T> with_room(Buffer<T>& items, Index room) {
  items.reserve(room);
  View<T> view = items.view();
  view.size = room;
  return view;
}
/// Gives an array the items that kernels have written there, beyond its own, too.
template <class T>
void take_items(Buffer<T>& items, Index count) {
  if (count <= items.size()) return items.resize(count);
  items.extend_to(count);
}
/// Contacts of elements that are their ends a, or b.
ContactForces contacts_of(World& w, Index room, Buffer<ContactState>& state, Buffer<double>& slid,
                          Buffer<double>& damped, Buffer<PairForce>& actions) {
  ContactForces contacts = contact_kernel(w);
  contacts.state = with_room(state, room);
  contacts.slid = with_room(slid, room);
  contacts.damped = with_room(damped, room);
  contacts.actions = with_room(actions, room);
  return contacts;
}

/// Arrays that searches of a launch read and write.
TileSearchCase search_case(World& w, TilePlan& plan, Index room, std::size_t bytes) {
  constexpr Index dropped = 1 << 14;
  TileSearches& s = plan.searches;
  const Index elements = w.elements.size(), tiles = static_cast<Index>(plan.tiles.size()),
              found = tiles * most_contacts_of_tile;
  MarginRule margins = margin_rule(w);
  margins.horizon = margin_horizon;
  Pairs& pairs = w.contacts.pairs;
  return {margins,
          w.travel.reference.view(),
          w.travel.margin.view(),
          w.elements.id.view(),
          w.linked_starts.view(),
          w.linked_partners.view(),
          w.linked_links.view(),
          w.interface.released<double>(),
          w.concrete.size(),
          w.steel.size(),
          room,
          w.contacts.size(),
          with_room(pairs.key, room),
          with_room(pairs.a, room),
          with_room(pairs.b, room),
          w.contact_incidence.starts.view(),
          with_room(w.contact_incidence.entries, 2 * room),
          with_room(s.spheres, 5 * elements),
          with_room(s.motion, 4 * tiles),
          with_room(s.counts, elements),
          with_room(s.first_pair, elements),
          with_room(s.old_key, room),
          with_room(s.old_state, room),
          with_room(s.old_spent, room),
          with_room(s.dropped, dropped),
          with_room(s.tiles, tiles),
          with_room(s.touched, found),
          with_room(s.starts, elements + tiles),
          with_room(s.contacts, found),
          bytes,
          most_acting(w.exec.space)};
}

/// Something that a world has and tiles do not know; null: nothing.
const char* unknown_to_tiles(const World& w) {
  if (!w.walls.empty()) return "walls";
  if (!w.prescribed.motions.empty()) return "prescribed motions";
  if (w.given->search.every != 0) return "search.every";
  if (w.parallel.size() != 0) return "parallel bonds";
  if (w.ldpm.size() != 0) return "facets of LDPM";
  if (w.concrete.rated) return "strengths that depend on the rate";
  return w.links() > 0 ? nullptr : "no links";
}

/// Multiprocessors that may have a tile, and the memory of each.
Multiprocessors multiprocessors_for(const World& w) {
  if (w.exec.tiles == 0) return {};
  if (w.exec.space != Space::cuda) {
    constexpr Index most = 132;  // as if it were a GPU
    return {w.exec.tiles < 0 ? most : w.exec.tiles, w.tiles.memory};
  }
  const Multiprocessors all = multiprocessors();
  return {w.exec.tiles < 0 ? all.count : std::min(all.count, w.exec.tiles), all.memory};
}

/// Tiles for a world; null where launches are to take its steps.
std::unique_ptr<TilePlan> tiles_for(const World& w) {
  const auto [most, memory] = multiprocessors_for(w);
  constexpr Index least_elements = 8;      // of a tile
  constexpr std::size_t link_bytes = 190;  // about; here for a quick answer
  // With 75 links a tile (the small slab) launches take 4 % less, with 600 (the slab) 15 % more.
  constexpr Index links_that_pay = 300;
  if (most <= 0 || !w.domain.single_rank() || w.exec.space == Space::host) return nullptr;
  const char* reason = unknown_to_tiles(w);
  if (reason == nullptr && at(w.links()) * link_bytes >= at(most) * memory)
    reason = "more links than the memory of its multiprocessors holds";
  if (w.exec.tiles < 0 && w.links() < links_that_pay * most) return nullptr;
  std::unique_ptr<TilePlan> plan;
  if (reason == nullptr) {
    plan = share_out_to_tiles(w, std::clamp(w.elements.size() / least_elements, Index{1}, most));
    if (plan == nullptr) reason = "more in a tile, or more laws, than tiles can number";
  }
  if (plan == nullptr && w.exec.tiles == tiles_in_any_case)
    throw InputError(std::string("device +tiles: the model has ") + reason +
                     "; leave +tiles out, and launches take the steps");
  return plan;
}

/// Whether the last search has left tiles a list that fits them.
bool has_contacts(World& w) {
  TilePlan& plan = *w.tiles.plan;
  if (!w.tiles.contacts_known) {
    tell_contacts(w, plan, multiprocessors_for(w).memory);
    w.tiles.contacts_known = true;
  }
  const Vec3& drift = w.travel.drift.velocity;
  return plan.bytes <= multiprocessors_for(w).memory && !(dot(drift, drift) > 0.0);
}

}  // namespace

bool runs_by_tiles(World& w) {
  if (!w.tiles.known) {
    w.tiles.forget();
    w.tiles.plan = tiles_for(w);
    w.tiles.known = true;
  }
  return w.tiles.plan != nullptr && !LaunchTimes::wanted() && has_contacts(w);
}

template <class Number>
TileCase<Number> case_of(World& w, TilePlan& plan, const StopAt& stop) {
  // The contacts that a search brings must fit as well.
  std::size_t bytes = multiprocessors_for(w).memory;
  if (w.exec.space != Space::cuda) bytes = std::min(bytes, plan.bytes + (1U << 17));
  const Index room = 8192 + 4 * w.contacts.size();
  ContactHistory& history = w.contacts.history;
  const ContactForces contacts = contacts_of(w, room, history.state, history.slid, history.damped,
                                             w.contact_actions),
                      twins = contacts_of(w, room, plan.twin_state, plan.twin_slid,
                                          plan.twin_damped, plan.twin_actions);
  StepClock start;
  const EndOfStep<StepRule> end{step_rule(w), w.given->time.evaluate_every};
  start.to_evaluation = end.to_evaluation(w.step);
  start.now = {w.time, w.last_dt, w.next_dt, w.step};
  start.stop = stop;
  start.least = ordered_bits(largest_least);
  plan.searches.news.resize(1);
  using Law = typename TileCase<Number>::Law;
  return {link_kernel<Number>(w, w.concrete, {}, 0),
          w.concrete.released<StoredAs<Number>>(),
          parts_of(w.concrete),
          link_kernel<Number>(w, w.steel, {}, 0),
          link_kernel<Number>(w, w.interface, {}, w.steel.size()),
          contacts,
          twins,
          move_kernel(w),
          w.elements.force.view(),
          w.elements.torque.view(),
          std::as_const(w.concrete.on_device.as<Law>()).view(),
          std::as_const(w.steel.on_device.laws).view(),
          std::as_const(w.interface.on_device.laws).view(),
          end,
          plan.view(),
          reinterpret_cast<TileConstants<typename TileMemory<Number>::Constant>*>(
              plan.constants.data()),
          plan.forces.data(),
          plan.least.data(),
          plan.tag,
          start,
          search_case(w, plan, room, bytes),
          plan.searches.news.data()};
}

template TileCase<double> case_of(World& w, TilePlan& plan, const StopAt& stop);
template TileCase<float> case_of(World& w, TilePlan& plan, const StopAt& stop);
template TileCase<Single> case_of(World& w, TilePlan& plan, const StopAt& stop);

TileNews take_over(World& w, TilePlan& plan) {
  const Space space = w.exec.space;
  const TileSearches& found = plan.searches;
  TileNews news;
  copy_bytes(&news, Space::host, found.news.data(), space, sizeof news);
  plan.tag = news.tag;
  if (news.searches == 0) return news;
  w.searches += news.searches;
  w.contacts.each_field(
      [&](const char*, const char*, auto& array) { take_items(array, news.contacts); });
  take_items(w.contact_actions, news.contacts);
  take_items(w.contact_incidence.entries, 2 * news.contacts);
  w.graph.clear();
  plan.found_there = true;
  std::vector<DroppedContact> dropped(at(news.dropped));
  if (!dropped.empty())
    copy_bytes(dropped.data(), Space::host, found.dropped.data(), space,
               dropped.size() * sizeof(DroppedContact));
  for (const DroppedContact& one : dropped) {
    w.ledger.friction.add(one.slid);
    w.ledger.contact.add(one.damped);
  }
  return news;
}

}  // namespace breccia::dem
