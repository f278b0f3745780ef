#pragma once
// Walking a state's `each_field(visit)`: the one list of what a state carries.
//
// A visitor is called as visit(name, unit, array) for every array. Arrays are Buffer<T> (one item
// per element, link or pair) or PlanesOf<Number> (three planes). What grows, reorders, saves
// or sends a state is written once, here and in io/checkpoint, and never lists members again.

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

/// A copy in the host's memory, for output and checks.
template <class State>
State host_copy(const State& state) {
  State copy = state;
  move_fields(copy, Space::host);
  return copy;
}
template <class T>
Buffer<T> host_copy(const Buffer<T>& array) {
  Buffer<T> copy;
  copy_to(copy, array);
  return copy;
}

}  // namespace breccia
