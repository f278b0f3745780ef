#pragma once
// Walking a state's `each_field(visit)`: the one list of what a state carries.
//
// A visitor is called as visit(name, unit, array) for every array. Arrays are Buffer<T> (one item
// per element, link or pair) or PlanesOf<Number> (three planes). What grows, reorders, saves
// or sends a state is written once, here and in io/checkpoint, and never lists members again.

#include <type_traits>
#include <vector>

#include "core/planes.hpp"
#include "exec/buffer.hpp"

namespace breccia {

/// Gives every array of the state `count` items; new ones are zero.
template <class State>
void resize_fields(State& state, Index count) {
  state.each_field([count](const char*, const char*, auto& array) { array.resize(count); });
}

/// Replaces an array by one in `space`, holding the same items.
template <class Array>
void move_array(Array& array, Space space) {
  Array there(space);
  copy_to(there, array);
  array = std::move(there);
}
/// Moves every array of a state.
template <class State>
void move_fields(State& state, Space space) {
  state.each_field([space](const char*, const char*, auto& array) { move_array(array, space); });
}

/// Arrays of a state get the items of another's, each in its own space.
template <class State>
void copy_fields(State& to, const State& from) {
  std::vector<const void*> sources;  // each_field visits both states in the same order
  const_cast<State&>(from).each_field(
      [&](const char*, const char*, const auto& array) { sources.push_back(&array); });
  auto source = sources.begin();
  to.each_field([&](const char*, const char*, auto& array) {
    copy_to(array, *static_cast<const std::remove_reference_t<decltype(array)>*>(*source++));
  });
}

/// A copy in the host's memory, for output and checks. Of a state that is_arrays_alone, these
/// alone: none is made in its own space.
template <class State>
State host_copy(const State& state) {
  if constexpr (requires { requires State::is_arrays_alone; }) {
    State copy;
    copy_fields(copy, state);
    return copy;
  } else {
    State copy = state;
    move_fields(copy, Space::host);
    return copy;
  }
}
template <class T>
Buffer<T> host_copy(const Buffer<T>& array) {
  Buffer<T> copy;
  copy_to(copy, array);
  return copy;
}

}  // namespace breccia
