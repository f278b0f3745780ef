#pragma once
// From a number to a colour.

#include <cstddef>
#include <string>

namespace breccia {

/// Red, green and blue as a screen shows them, 0 to 1.
struct Color {
  float red = 0.0F, green = 0.0F, blue = 0.0F;
};

/// `share` of b, the rest of a.
Color blend(const Color& a, const Color& b, float share);
/// Every channel times `factor`, at most 1.
Color shaded(const Color& color, float factor);

/// How a share of the range, 0 to 1, becomes a colour.
enum class ColorMap {
  viridis,    ///< dark blue to yellow, even steps of lightness: for what has no sign
  diverging,  ///< blue through light grey to red: for what has one; 0.5 is zero
  damage,     ///< light concrete over orange to dark red
  magma,      ///< black over purple and orange to light yellow, even steps of lightness
  gray,       ///< dark to light
  ground,     ///< `damage` in pale: the ground on which cracks are drawn
};

/// A map by its name here. @throws InputError listing the names
ColorMap map_named(const std::string& name);

/// The colour at `share`, which is held to 0..1; magenta for what is not a number.
Color map_color(ColorMap map, float share);

/// A colour for category `number`: distinct for the first 32, then again from the start.
Color category_color(std::size_t number);

}  // namespace breccia
