#pragma once
// Fields of frames, called as the table of quantities calls them.

#include <utility>
#include <vector>

#include "core/quantity.hpp"
#include "io/frame.hpp"

namespace breccia {

/// @param per_thickness  of a plane case: forces count each metre of it
inline FrameField field_of(const Quantity& quantity, std::size_t items = 0,
                           bool per_thickness = false) {
  FieldWord word = field_word(quantity, per_thickness);
  return {std::move(word.name), std::move(word.unit), word.components,
          std::vector<float>(static_cast<std::size_t>(word.components) * items, 0.0F)};
}
inline FrameField numbers_of(Quantity::Kind kind, std::vector<std::int32_t> numbers) {
  return whole_numbers(field_word({kind}).name, std::move(numbers));
}

}  // namespace breccia
