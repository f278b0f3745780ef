// The only file that sees stb_truetype.

#include "io/picture/font.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "io/picture/pixel.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

// The assembler copies the file (as in report/bundle.cpp).
__asm__(
    ".pushsection .rodata\n"
    ".global breccia_letters\n"
    ".hidden breccia_letters\n"
    "breccia_letters:\n"
    ".incbin \"" BR_LETTERS_FILE
    "\"\n"
    ".popsection\n");
extern "C" const unsigned char breccia_letters[];

namespace breccia {
namespace {

const stbtt_fontinfo& typeface() {
  static const stbtt_fontinfo font = [] {
    stbtt_fontinfo made;
    stbtt_InitFont(&made, breccia_letters, 0);
    return made;
  }();
  return font;
}

constexpr double capitals = 0.729;  ///< height of capital letters  [em]

/// Pixels a unit of the typeface, so that capitals are seven units of text high.
float size_of(int scale) {
  return stbtt_ScaleForMappingEmToPixels(&typeface(), static_cast<float>(7.0 * scale / capitals));
}

struct Glyph {
  int number;
  float at;  ///< left end of its room  [pixels]
};
struct Line {
  std::vector<Glyph> glyphs;
  float width = 0.0F;  ///<  [pixels]
};
Line set_line(std::string_view text, int scale) {
  Line line;
  const float size = size_of(scale);
  for (const char32_t letter : code_points(text)) {
    const int number = stbtt_FindGlyphIndex(&typeface(), static_cast<int>(letter));
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&typeface(), number, &advance, &bearing);
    line.glyphs.push_back({number, line.width});
    line.width += size * static_cast<float>(advance);
  }
  return line;
}

}  // namespace

std::u32string code_points(std::string_view text) {
  std::u32string points;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char first = byte(i);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    char32_t point = length < 2 ? first : first & (0x7FU >> length);
    bool good = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; good && k < length; ++k) {
      good = (byte(i + k) & 0xC0U) == 0x80U;
      point = (point << 6) | (byte(i + k) & 0x3FU);
    }
    points.push_back(good ? point : U'\uFFFD');
    i += good ? length : 1;
  }
  return points;
}

int text_width(std::string_view text, int scale) {
  return static_cast<int>(std::ceil(set_line(text, scale).width));
}

void draw_text(Image& image, int x, int y, std::string_view text, int scale, const Color& color) {
  const float size = size_of(scale);
  const int base = y + 7 * scale;
  std::vector<unsigned char> cover;
  for (const Glyph& glyph : set_line(text, scale).glyphs) {
    const float whole = std::floor(glyph.at), part = glyph.at - whole;
    int left = 0, top = 0, right = 0, bottom = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&typeface(), glyph.number, size, size, part, 0.0F, &left, &top,
                                    &right, &bottom);
    const int wide = right - left, high = bottom - top;
    if (wide <= 0 || high <= 0) continue;
    cover.assign(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), 0);
    stbtt_MakeGlyphBitmapSubpixel(&typeface(), cover.data(), wide, high, wide, size, size, part,
                                  0.0F, glyph.number);
    for (int row = 0; row < high; ++row)
      for (int column = 0; column < wide; ++column) {
        const auto share = cover[static_cast<std::size_t>(row * wide + column)];
        if (share > 0)
          mix_pixel(image, x + static_cast<int>(whole) + left + column, base + top + row, color,
                    static_cast<float>(share) / 255.0F);
      }
  }
}

}  // namespace breccia
