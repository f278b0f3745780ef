#pragma once
// Sorted pairs of elements that keep their history from one search to the next.
//
// A pair is known by its key (lower and higher global id), so its history survives any change of
// memory order. Lists are sorted by key: old and new ones are matched by looking each key up.

#include <utility>

#include "core/fields.hpp"
#include "exec/for_each.hpp"

namespace breccia {

/// Pairs of elements, each once, in ascending order of their keys. One item a pair, written by the
/// search; a and b also where elements change places.
struct Pairs {
  Buffer<PairKey> key;  ///< lower and higher global id  [-]
  Buffer<Index> a, b;   ///< where they lie in memory; a has the lower global id  [-]

  explicit Pairs(Space space = Space::host) : key(space), a(space), b(space) {}

  template <class Visit>
  void each_field(Visit&& field) {
    field("key", "-", key);
    field("a", "-", a);
    field("b", "-", b);
  }
  Index size() const { return key.size(); }
};

/// For each new key its place among the old keys, or -1. Both lists are sorted and without repeats.
void match_keys(const Exec& exec, const Buffer<PairKey>& old_keys, const Buffer<PairKey>& new_keys,
                Buffer<Index>& source);

/// The places of the old keys that are not among the new ones, ascending: what these pairs have
/// booked must be summed before their history goes.
void find_dropped(const Exec& exec, const Buffer<PairKey>& old_keys,
                  const Buffer<PairKey>& new_keys, Buffer<Index>& dropped);

/// Kernel of gather_fields: item i becomes the one at `source[i]`, or zero where that is -1.
template <class T>
struct GatherItems {
  static constexpr const char* name = "core.gather_items";
  View<const Index> source;
  View<const T> from;
  View<T> to;

  BR_HD void operator()(Index i) const {
    if (source[i] >= 0)
      to[i] = from[source[i]];
    else
      __builtin_memset(static_cast<void*>(&to[i]), 0, sizeof(T));
  }
};

/// Gathers vectors that are stored by component.
template <class Number>
struct GatherVectors {
  static constexpr const char* name = "core.gather_vectors";
  View<const Index> source;
  PlanesView<const Number> from;
  PlanesView<Number> to;  ///< zero before

  BR_HD void operator()(Index i) const {
    if (source[i] >= 0) to.store(i, from[source[i]]);
  }
};

template <class T>
void gather(const Exec& exec, const Buffer<Index>& source, Buffer<T>& items) {
  Buffer<T> gathered = unfilled<T>(items.space(), source.size());
  const GatherItems<T> kernel{source.view(), std::as_const(items).view(), gathered.view()};
  for_each(exec, source.size(), kernel);
  items.swap(gathered);
}
template <class Number>
void gather(const Exec& exec, const Buffer<Index>& source, PlanesOf<Number>& vectors) {
  PlanesOf<Number> gathered(vectors.space());
  gathered.resize(source.size());
  const GatherVectors<Number> kernel{source.view(), std::as_const(vectors).view(), gathered.view()};
  for_each(exec, source.size(), kernel);
  vectors = std::move(gathered);
}

/// Item i of every array of the state becomes the old item `source[i]`, or zero where that is -1.
template <class State>
void gather_fields(const Exec& exec, const Buffer<Index>& source, State& state) {
  state.each_field([&](const char*, const char*, auto& array) { gather(exec, source, array); });
}

/// History that belonged to `old_keys` then belongs to `new_keys`: surviving pairs keep theirs to
/// the bit, new pairs start from zero. Both lists are sorted and without repeats.
template <class State>
void carry_history(const Exec& exec, const Buffer<PairKey>& old_keys, State& history,
                   const Buffer<PairKey>& new_keys) {
  Buffer<Index> source(new_keys.space());
  match_keys(exec, old_keys, new_keys, source);
  gather_fields(exec, source, history);
}

/// Pairs and what they remember. `History` lists its arrays once (each_field).
template <class History>
struct PairList {
  Pairs pairs;
  History history;

  /// The pairs of a new search take over and keep the history of those that were here before. Call
  /// find_dropped first where the history of the others must be summed.
  void replace(const Exec& exec, Pairs&& found) {
    carry_history(exec, pairs.key, history, found.key);
    pairs = std::move(found);
  }

  template <class Visit>
  void each_field(Visit&& field) {
    pairs.each_field(field);
    history.each_field(field);
  }
  Index size() const { return pairs.size(); }
};

}  // namespace breccia
