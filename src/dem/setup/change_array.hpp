#pragma once
// Arrays of a world, wherever they lie, changed on the host as a stage begins.

#include <type_traits>
#include <vector>

#include "exec/buffer.hpp"

namespace breccia::dem {

/// @param change  is given all values
template <class Array, class Change>
void change_array(Array& array, const Change& change) {
  std::vector<std::remove_reference_t<decltype(*array.data())>> values;
  copy_to(values, array);
  change(values);
  copy_to(array, values);
}

}  // namespace breccia::dem
