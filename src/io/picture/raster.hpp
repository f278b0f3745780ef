#pragma once
// Which item shows in which pixel: a depth buffer for spheres, lines and triangles.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/picture/camera.hpp"

namespace breccia {

/// Per pixel the depth of the nearest surface and the item it belongs to. Rows are padded to a
/// whole number of blocks, so that a loop over a row needs no remainder.
struct Canvas {
  static constexpr int block = 8;           ///< pixels
  static constexpr float empty = -1e30F;    ///< depth where nothing is
  static constexpr std::int32_t none = -1;  ///< item where nothing is

  Canvas(int wide, int high);
  std::size_t row(int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride);
  }

  int width, height, stride;
  std::vector<float> depth;        ///< towards the viewer  [pixels]
  std::vector<std::int32_t> item;  ///< number given to draw_...
};

/// A sphere on the picture.  [pixels]
struct ScreenSphere {
  float u, v, depth, radius;
};

/// Rows of the picture, the last one included: what one thread draws into.
struct Rows {
  int top, bottom;
};

/// Draws all spheres; the item of each is its place in the list, a radius of 0 leaves it out. Those
/// that a clip plane crosses show the cut. Work is done tile by tile from front to back, and a tile
/// is left as soon as nothing farther can show in it: cost grows with what is seen.
void draw_spheres(Canvas& canvas, std::span<const ScreenSphere> spheres,
                  const std::optional<ScreenClip>& clip, int threads);

/// As much of a line `thickness` pixels wide as lies in the rows.
void draw_line(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               std::int32_t item, const std::optional<ScreenClip>& clip);

/// As much of a line as lies in the rows and on the surface that is drawn: not behind it, and not
/// in the air before it. It paints that surface, whose depth stays.
void draw_mark(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               std::int32_t item, const std::optional<ScreenClip>& clip);

/// As much of a triangle as lies in the rows.
void draw_triangle(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b,
                   const ScreenPoint& c, std::int32_t item, const std::optional<ScreenClip>& clip);

}  // namespace breccia
