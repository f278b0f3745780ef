#pragma once
// Text on pictures, in letters of DejaVu Sans that lie in the program.

#include <string_view>

#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"

namespace breccia {

constexpr int font_height = 9;  ///< units of text, two of them below the base line; capitals have 7

/// Width of a line of text in UTF-8 when one unit is `scale` pixels.  [pixels]
int text_width(std::string_view text, int scale);

/// Writes a line of text; (x, y) is its upper left corner. Letters without a form show as a box;
/// what falls outside the image is left out. Every machine draws the same bits.
void draw_text(Image& image, int x, int y, std::string_view text, int scale, const Color& color);

/// The code points of a text in UTF-8; U+FFFD for bytes that are none.
std::u32string code_points(std::string_view text);

}  // namespace breccia
