#pragma once
// Where a method's world lies. It lists its arrays once: each_kept visits those that go along when
// it moves, each_derived those that are filled anew.

#include <type_traits>

#include "core/fields.hpp"

namespace breccia {

/// Makes every array of a new world one of its space.
template <class World>
void place_arrays(World& w) {
  const auto place = [&w](auto& array) {
    array = std::remove_reference_t<decltype(array)>(w.exec.space);
  };
  w.each_kept(place);
  w.each_derived(place);
}

/// Moves a world to another space; derive() must follow.
template <class World>
void move_world(World& w, Space space) {
  if (w.exec.space == space) return;
  w.each_kept([space](auto& array) { move_array(array, space); });
  w.each_derived([space](auto& array) { array = std::remove_reference_t<decltype(array)>(space); });
  w.graph.clear();
  w.exec.space = space;
}

}  // namespace breccia
