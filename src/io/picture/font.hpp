#pragma once
// Text on pictures: Breccia's own bitmap letters, five dots wide and seven high.

#include <string_view>

#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"

namespace breccia {

constexpr int font_height = 9;  ///< dots, two of them below the base line

/// Width of a line of text when one dot is `scale` pixels wide.  [pixels]
int text_width(std::string_view text, int scale);

/// Writes a line of text; (x, y) is its upper left corner. Letters without a form show as a box.
/// `scale` is 1, 2, 3, 4, 6 or 12; what falls outside the image is left out.
void draw_text(Image& image, int x, int y, std::string_view text, int scale, const Color& color);

}  // namespace breccia
