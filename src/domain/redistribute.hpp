#pragma once
// Sending items of a state to other ranks: whatever its each_field lists goes along.

#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "core/pair_list.hpp"
#include "core/rare_array.hpp"
#include "domain/communicator.hpp"

namespace breccia {

/// The items that go to each rank.
class SendLists {
 public:
  explicit SendLists(int ranks) : to_(static_cast<std::size_t>(ranks)) {}

  void add(int rank, Index item) {
    std::vector<Index>& items = to_[static_cast<std::size_t>(rank)];
    if (items.empty() || items.back() != item) items.push_back(item);
  }
  /// Each item once for each rank, ascending.
  void settle() {
    for (std::vector<Index>& items : to_) {
      if (!std::is_sorted(items.begin(), items.end())) std::sort(items.begin(), items.end());
      items.erase(std::unique(items.begin(), items.end()), items.end());
    }
  }
  const std::vector<Index>& of(std::size_t rank) const { return to_[rank]; }

 private:
  std::vector<std::vector<Index>> to_;
};

/// Several states with one item each for the same things.
template <class... States>
struct Together {
  std::tuple<States&...> states;

  template <class Visit>
  void each_field(Visit&& field) {
    std::apply([&, this](auto&... state) { (state.each_field(field), ...); }, states);
  }
};
template <class... States>
Together<States...> together(States&... states) {
  return {{states...}};
}

/// One array as a state.
template <class T>
struct OneField {
  Buffer<T>& array;
  template <class Visit>
  void each_field(Visit&& field) {
    field("", "-", array);
  }
};
template <class T>
OneField<T> one_field(Buffer<T>& array) {
  return {array};
}

namespace redistribute_detail {

template <class T>
std::size_t item_bytes(const Buffer<T>&) {
  return sizeof(T);
}
template <class Number>
std::size_t item_bytes(const PlanesOf<Number>&) {
  return 3 * sizeof(Number);
}

template <class T>
std::size_t item_bytes(const RareArray<T>&) {
  return sizeof(T);
}

template <class T>
void put(Message& message, const Buffer<T>& array, const std::vector<Index>& items) {
  const std::size_t before = message.size();
  message.resize(before + items.size() * sizeof(T));
  std::byte* to = message.data() + before;
  for (const Index i : items) {
    std::memcpy(to, array.data() + i, sizeof(T));
    to += sizeof(T);
  }
}
template <class Number>
void put(Message& message, const PlanesOf<Number>& planes, const std::vector<Index>& items) {
  std::vector<Index> each(items);
  for (int plane = 0; plane < 3; ++plane) {
    put(message, planes.items(), each);
    for (Index& i : each) i += planes.size();
  }
}

template <class T>
void put(Message& message, const RareArray<T>& array, const std::vector<Index>& items) {
  const std::size_t before = message.size();
  message.resize(before + items.size() * sizeof(T));
  std::byte* to = message.data() + before;
  for (const Index i : items) {
    const T item = array.item(i);
    std::memcpy(to, &item, sizeof(T));
    to += sizeof(T);
  }
}

template <class T>
const std::byte* take(const std::byte* from, Buffer<T>& array, Index first, Index count) {
  const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(T);
  if (bytes > 0) std::memcpy(array.data() + first, from, bytes);
  return from + bytes;
}
template <class Number>
const std::byte* take(const std::byte* from, PlanesOf<Number>& planes, Index first, Index count) {
  for (int plane = 0; plane < 3; ++plane)
    from = take(from, planes.items(), plane * planes.size() + first, count);
  return from;
}

template <class T>
const std::byte* take(const std::byte* from, RareArray<T>& array, Index first, Index count) {
  for (Index i = 0; i < count; ++i) {
    T item;
    std::memcpy(&item, from, sizeof(T));
    array.set(first + i, item);
    from += sizeof(T);
  }
  return from;
}

/// How many items, and all their fields. Of none nothing.
template <class State>
Message packed(State& state, const std::vector<Index>& items) {
  if (items.empty()) return {};
  const auto count = static_cast<Index>(items.size());
  std::size_t bytes = sizeof count;
  state.each_field(
      [&](const char*, const char*, auto& array) { bytes += items.size() * item_bytes(array); });
  Message message;
  message.reserve(bytes);
  message.resize(sizeof count);
  std::memcpy(message.data(), &count, sizeof count);
  state.each_field([&](const char*, const char*, auto& array) {
    BR_ASSERT(array.space() == Space::host);
    put(message, array, items);
  });
  return message;
}

/// Puts what came behind the items that were here.
template <class State>
void append(State& state, const std::vector<Message>& came, Index here) {
  std::vector<Index> counts;
  Index total = here;
  for (const Message& message : came) {
    counts.push_back(0);
    if (!message.empty()) std::memcpy(&counts.back(), message.data(), sizeof(Index));
    total += counts.back();
  }
  resize_fields(state, total);
  Index first = here;
  for (std::size_t r = 0; r < came.size(); ++r) {
    if (counts[r] == 0) continue;
    const std::byte* from = came[r].data() + sizeof(Index);
    state.each_field(
        [&](const char*, const char*, auto& array) { from = take(from, array, first, counts[r]); });
    first += counts[r];
  }
}

/// Where the items of an array go when what came, behind those that were here, takes its places
/// among those that stay.
struct Merging {
  const std::vector<Index>& stay;  ///< ascending
  Index here;                      ///< items before those that came
  const Buffer<Index>& order;      ///< of what stays, as in `stay`, and what came

  /// In place: nearly all items lie near their new places.
  template <class T>
  void apply(T* items) const {
    const auto kept = static_cast<Index>(stay.size());
    const std::vector<T> came(items + here, items + here + (order.size() - kept));
    Index i = 0;
    while (i < kept && stay[static_cast<std::size_t>(i)] == i) ++i;
    for (; i < kept; ++i) items[i] = items[stay[static_cast<std::size_t>(i)]];
    Index next = kept;  // behind what stays and has not found its place
    for (i = order.size(); next < i;) {
      const Index from = order.data()[--i];
      items[i] = from < here ? items[--next] : came[static_cast<std::size_t>(from - here)];
    }
  }
  template <class T>
  void apply(Buffer<T>& array) const {
    apply(array.data());
  }
  template <class T>
  void apply(RareArray<T>& records) const {
    apply(records.numbers());
  }
  template <class Number>
  void apply(PlanesOf<Number>& planes) const {
    for (int plane = 0; plane < 3; ++plane) apply(planes.items().data() + plane * planes.size());
  }
};

}  // namespace redistribute_detail

/// Each rank's items go to the ranks that `to` lists; the state then holds what stays and what
/// came, ascending by `keys`, one of its arrays, whose numbers are unlike. What stays is not
/// packed, and not sorted where it is in order. The arrays lie on the host, with an item for each
/// key.
template <class State, class Key>
void redistribute(Communicator& ranks, State&& state, SendLists& to, const Buffer<Key>& keys) {
  to.settle();
  const Index here = keys.size();
  const auto self = static_cast<std::size_t>(ranks.rank());
  std::vector<Message> messages(static_cast<std::size_t>(ranks.size()));
  for (std::size_t r = 0; r < messages.size(); ++r)
    if (r != self) messages[r] = redistribute_detail::packed(state, to.of(r));
  redistribute_detail::append(state, ranks.exchange(std::move(messages)), here);

  const std::vector<Index>& stay = to.of(self);
  const Key* const key = keys.data();
  Buffer<Index> order(Space::host, static_cast<Index>(stay.size()) + keys.size() - here);
  Index* const begin = order.data();
  Index* const middle = std::copy(stay.begin(), stay.end(), begin);
  Index* const end = begin + order.size();
  std::iota(middle, end, here);
  const auto before = [key](Index a, Index b) { return key[a] < key[b]; };
  const bool in_order = std::is_sorted(begin, middle, before);
  if (!in_order) std::sort(begin, middle, before);
  std::sort(middle, end, before);
  std::inplace_merge(begin, middle, end, before);
  bool in_place = order.size() == keys.size();
  for (Index i = 0; in_place && i < order.size(); ++i) in_place = begin[i] == i;
  if (in_place) return;
  // Where most has gone its memory goes, too.
  if (!in_order || 2 * static_cast<Index>(stay.size()) < here)
    return gather_fields(Exec{}, order, state);
  const redistribute_detail::Merging merging{stay, here, order};
  state.each_field([&](const char*, const char*, auto& array) { merging.apply(array); });
  resize_fields(state, order.size());
}

/// Where numbers lie in an ascending array, asked for one after the other. Elements that are near
/// each other mostly have all numbers between theirs on one rank: then the way from the place found
/// last is known.
class Places {
 public:
  explicit Places(const Buffer<Index>& sorted) : sorted_(sorted.host()) {}

  /// The place of a number, or -1 if it is not there.
  Index find(Index number) {
    const auto size = static_cast<std::int64_t>(sorted_.size());
    if (size == 0) return -1;
    const std::int64_t guess = last_ + (std::int64_t{number} - sorted_[last_]);
    if (guess >= 0 && guess < size && sorted_[static_cast<std::size_t>(guess)] == number) {
      last_ = static_cast<std::size_t>(guess);
      return static_cast<Index>(guess);
    }
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), number);
    if (found == sorted_.end() || *found != number) return -1;
    last_ = static_cast<std::size_t>(found - sorted_.begin());
    return static_cast<Index>(last_);
  }
  /// Of one that is there.
  Index of(Index number) {
    const Index place = find(number);
    BR_ASSERT(place >= 0);
    return place;
  }

 private:
  std::span<const Index> sorted_;
  std::size_t last_ = 0;
};

}  // namespace breccia
