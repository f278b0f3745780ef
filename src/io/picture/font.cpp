#include "io/picture/font.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace breccia {
namespace {

constexpr int dots_wide = 5, dots_high = font_height, glyphs_a_row = 16;

// The letters from space (32) to tilde (126), sixteen a row, and a box for all others.
constexpr std::string_view letters = R"(
..... ..#.. .#.#. .#.#. ..#.. ##... .##.. ..#.. ...#. .#... ..... ..... ..... ..... ..... ....#
..... ..#.. .#.#. .#.#. .#### ##..# #..#. ..#.. ..#.. ..#.. ..#.. ..#.. ..... ..... ..... ....#
..... ..#.. .#.#. ##### #.#.. ...#. #.#.. .#... .#... ...#. #.#.# ..#.. ..... ..... ..... ...#.
..... ..#.. ..... .#.#. .###. ..#.. .#... ..... .#... ...#. .###. ##### ..... .###. ..... ..#..
..... ..#.. ..... ##### ..#.# .#... #.#.# ..... .#... ...#. #.#.# ..#.. ..... ..... ..... .#...
..... ..... ..... .#.#. ####. #..## #..#. ..... ..#.. ..#.. ..#.. ..#.. .##.. ..... .##.. #....
..... ..#.. ..... .#.#. ..#.. ...## .##.# ..... ...#. .#... ..... ..... .##.. ..... .##.. #....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..#.. ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... .....
.###. ..#.. .###. ##### ...#. ##### ..##. ##### .###. .###. ..... ..... ...#. ..... .#... .###.
#...# .##.. #...# ...#. ..##. #.... .#... ....# #...# #...# ..... ..... ..#.. ..... ..#.. #...#
#...# ..#.. ....# ..#.. .#.#. ####. #.... ...#. #...# #...# .##.. .##.. .#... ##### ...#. ....#
#...# ..#.. ...#. ...#. #..#. ....# ####. ..#.. .###. .#### .##.. .##.. #.... ..... ....# ...#.
#...# ..#.. ..#.. ....# ##### ....# #...# .#... #...# ....# ..... ..... .#... ##### ...#. ..#..
#...# ..#.. .#... #...# ...#. #...# #...# .#... #...# ...#. .##.. .##.. ..#.. ..... ..#.. .....
.###. .###. ##### .###. ...#. .###. .###. .#... .###. .##.. .##.. .##.. ...#. ..... .#... ..#..
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..#.. ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... ..... .....
.###. .###. ####. .###. ####. ##### ##### .###. #...# .###. ..### #...# #.... #...# #...# .###.
#...# #...# #...# #...# #...# #.... #.... #...# #...# ..#.. ...#. #..#. #.... ##.## #...# #...#
....# #...# #...# #.... #...# #.... #.... #.... #...# ..#.. ...#. #.#.. #.... #.#.# ##..# #...#
.##.# ##### ####. #.... #...# ####. ####. #.### ##### ..#.. ...#. ##... #.... #.#.# #.#.# #...#
#.#.# #...# #...# #.... #...# #.... #.... #...# #...# ..#.. ...#. #.#.. #.... #...# #..## #...#
#.#.# #...# #...# #...# #...# #.... #.... #...# #...# ..#.. #..#. #..#. #.... #...# #...# #...#
.###. #...# ####. .###. ####. ##### #.... .#### #...# .###. .##.. #...# ##### #...# #...# .###.
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
####. .###. ####. .#### ##### #...# #...# #...# #...# #...# ##### .###. #.... .###. ..#.. .....
#...# #...# #...# #.... ..#.. #...# #...# #...# #...# #...# ....# .#... #.... ...#. .#.#. .....
#...# #...# #...# #.... ..#.. #...# #...# #...# .#.#. #...# ...#. .#... .#... ...#. #...# .....
####. #...# ####. .###. ..#.. #...# #...# #.#.# ..#.. .#.#. ..#.. .#... ..#.. ...#. ..... .....
#.... #.#.# #.#.. ....# ..#.. #...# #...# #.#.# .#.#. ..#.. .#... .#... ...#. ...#. ..... .....
#.... #..#. #..#. ....# ..#.. #...# .#.#. #.#.# #...# ..#.. #.... .#... ....# ...#. ..... .....
#.... .##.# #...# ####. ..#.. .###. ..#.. .#.#. #...# ..#.. ##### .###. ....# .###. ..... #####
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
.#... ..... #.... ..... ....# ..... ..##. ..... #.... ..#.. ...#. #.... .##.. ..... ..... .....
..#.. ..... #.... ..... ....# ..... .#... ..... #.... ..... ..... #.... ..#.. ..... ..... .....
...#. .###. ####. .###. .#### .###. .#... .#### ####. ..#.. ...#. #..#. ..#.. ####. ####. .###.
..... ....# #...# #...# #...# #...# ###.. #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#
..... .#### #...# #.... #...# ##### .#... #...# #...# ..#.. ...#. ##... ..#.. #.#.# #...# #...#
..... #...# #...# #...# #...# #.... .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#
..... .#### ####. .###. .#### .###. .#... .#### #...# ..#.. ...#. #..#. ..#.. #.#.# #...# .###.
..... ..... ..... ..... ..... ..... ..... ....# ..... ..... #..#. ..... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... .###. ..... ..... .##.. ..... ..... ..... ..... .....
..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ...#. ..#.. .#... ..... #####
..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ..#.. ..#.. ..#.. ..... #...#
####. .#### .#.## .#### ###.. #...# #...# #.#.# #...# #...# ##### ..#.. ..#.. ..#.. .#... #...#
#...# #...# .##.. #.... .#... #...# #...# #.#.# .#.#. #...# ...#. .#... ..#.. ...#. #.#.# #...#
#...# #...# .#... .###. .#... #...# #...# #.#.# ..#.. #...# ..#.. ..#.. ..#.. ..#.. ...#. #...#
#...# #...# .#... ....# .#... #...# .#.#. #.#.# .#.#. #...# .#... ..#.. ..#.. ..#.. ..... #...#
####. .#### .#... ####. ..##. .#### ..#.. .#.#. #...# .#### ##### ...#. ..#.. .#... ..... #####
#.... ....# ..... ..... ..... ..... ..... ..... ..... ....# ..... ..... ..... ..... ..... .....
#.... ....# ..... ..... ..... ..... ..... ..... ..... .###. ..... ..... ..... ..... ..... .....
)";

/// A grid of dots, filled or not; outside it is empty.
struct Dots {
  int width, height;
  std::vector<bool> filled;

  bool at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    return filled[static_cast<std::size_t>(y * width + x)];
  }
};

Dots glyph_dots(int glyph) {
  Dots dots{dots_wide, dots_high, std::vector<bool>(dots_wide * dots_high)};
  constexpr int line = glyphs_a_row * (dots_wide + 1);  // with its line end
  for (int y = 0; y < dots_high; ++y) {
    const int row = 1 + (glyph / glyphs_a_row * dots_high + y) * line;
    for (int x = 0; x < dots_wide; ++x) {
      const int place = row + glyph % glyphs_a_row * (dots_wide + 1) + x;
      dots.filled[static_cast<std::size_t>(y * dots_wide + x)] =
          letters[static_cast<std::size_t>(place)] == '#';
    }
  }
  return dots;
}

/// Twice as large, with the steps of slanted strokes rounded: the rule known as EPX (E. Johnston,
/// 1992): a quarter of a dot takes the state of its two outer neighbours where only they agree.
Dots doubled(const Dots& dots) {
  Dots large{2 * dots.width, 2 * dots.height, {}};
  large.filled.resize(4 * dots.filled.size());
  for (int y = 0; y < dots.height; ++y) {
    for (int x = 0; x < dots.width; ++x) {
      const bool above = dots.at(x, y - 1), below = dots.at(x, y + 1);
      const bool left = dots.at(x - 1, y), right = dots.at(x + 1, y);
      const bool distinct = above != below && left != right;
      for (int part = 0; part < 4; ++part) {
        const bool vertical = part < 2 ? above : below;
        const bool horizontal = part % 2 == 0 ? left : right;
        const bool rounded = distinct && vertical == horizontal;
        const int place = (2 * y + part / 2) * large.width + 2 * x + part % 2;
        large.filled[static_cast<std::size_t>(place)] = rounded ? vertical : dots.at(x, y);
      }
    }
  }
  return large;
}

/// First and one past the last column of a glyph that count for its width. Digits are equally wide.
struct Columns {
  int first, end;
};
Columns columns_of(int glyph) {
  if (glyph == 0) return {0, 3};
  if (glyph >= '0' - ' ' && glyph <= '9' - ' ') return {0, dots_wide};
  const Dots dots = glyph_dots(glyph);
  Columns columns{dots_wide, 0};
  for (int x = 0; x < dots_wide; ++x) {
    for (int y = 0; y < dots_high; ++y) {
      if (!dots.at(x, y)) continue;
      columns.first = std::min(columns.first, x);
      columns.end = std::max(columns.end, x + 1);
    }
  }
  return columns;
}

/// Glyph numbers of a text in UTF-8; a few signs of units become their plain form.
std::vector<int> glyphs_of(std::string_view text) {
  constexpr int box = 95;
  std::vector<int> glyphs;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 128) {
      glyphs.push_back(byte >= 32 && byte < 127 ? byte - 32 : box);
      continue;
    }
    const unsigned char next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    while (i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xC0) == 0x80) ++i;
    char plain = 127;
    if (byte == 0xC2 && next == 0xB2) plain = '2';  // superscripts
    if (byte == 0xC2 && next == 0xB3) plain = '3';
    if (byte == 0xC2 && next == 0xB5) plain = 'u';  // micro
    if (byte == 0xC2 && next == 0xB7) plain = '.';  // middle dot
    if (byte == 0xC3 && next == 0x97) plain = 'x';  // times
    glyphs.push_back(plain - 32);
  }
  return glyphs;
}

void mix_pixel(Image& image, int x, int y, const Color& color, float share) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const std::array channels{color.red, color.green, color.blue};
  auto* pixel =
      &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x))];
  for (std::size_t c = 0; c < 3; ++c) {
    const float before = static_cast<float>(pixel[c]);
    pixel[c] = static_cast<std::uint8_t>(before + share * (255.0F * channels[c] - before) + 0.5F);
  }
}

}  // namespace

int text_width(std::string_view text, int scale) {
  int width = 0;
  for (const int glyph : glyphs_of(text)) {
    const Columns columns = columns_of(glyph);
    width += (columns.end - columns.first + 1) * scale;
  }
  return std::max(0, width - scale);
}

void draw_text(Image& image, int x, int y, std::string_view text, int scale, const Color& color) {
  // Doubled twice, a dot has 4 parts; where those do not divide by the scale each counts as 3.
  const int repeat = 4 % scale == 0 ? 1 : 3;
  const int part = 4 * repeat / scale;
  for (const int glyph : glyphs_of(text)) {
    const Columns columns = columns_of(glyph);
    const Dots dots = doubled(doubled(glyph_dots(glyph)));
    for (int row = 0; row < dots_high * scale; ++row) {
      for (int column = columns.first * scale; column < columns.end * scale; ++column) {
        int covered = 0;
        for (int k = 0; k < part * part; ++k) {
          const int fine_x = column * part + k % part, fine_y = row * part + k / part;
          covered += dots.at(fine_x / repeat, fine_y / repeat) ? 1 : 0;
        }
        if (covered == 0) continue;
        const float share = static_cast<float>(covered) / static_cast<float>(part * part);
        mix_pixel(image, x + column - columns.first * scale, y + row, color, share);
      }
    }
    x += (columns.end - columns.first + 1) * scale;
  }
}

}  // namespace breccia
