#include "io/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace breccia {
namespace {

/// Light that reaches the pixels of row y, 0 to 1: less where neighbours stand nearer.
void light_of_row(const Canvas& canvas, int y, float relief, std::vector<float>& light) {
  struct Ring {
    int reach;       // pixels
    float strength;  // of one neighbour
  };
  const int unit = std::max(1, canvas.height / 640);
  const std::array rings{Ring{unit, 0.16F}, Ring{4 * unit, 0.10F}};
  const float* const here = &canvas.depth[canvas.row(y)];
  const float sharpness = 1.0F / relief;
  std::fill(light.begin(), light.end(), 0.0F);
  float* const sum = light.data();
  for (const Ring& ring : rings) {
    const int above = std::max(0, y - ring.reach);
    const int below = std::min(canvas.height - 1, y + ring.reach);
    const int diagonal = std::max(1, ring.reach * 7 / 10);
    const int diagonal_above = std::max(0, y - diagonal);
    const int diagonal_below = std::min(canvas.height - 1, y + diagonal);
    struct Neighbour {
      int row, shift;
    };
    const std::array neighbours{Neighbour{above, 0},
                                Neighbour{below, 0},
                                Neighbour{y, ring.reach},
                                Neighbour{y, -ring.reach},
                                Neighbour{diagonal_above, -diagonal},
                                Neighbour{diagonal_above, diagonal},
                                Neighbour{diagonal_below, -diagonal},
                                Neighbour{diagonal_below, diagonal}};
    for (const Neighbour& neighbour : neighbours) {
      const float* const there = &canvas.depth[canvas.row(neighbour.row)] + neighbour.shift;
      const int first = std::max(0, -neighbour.shift);
      const int end = canvas.width - std::max(0, neighbour.shift);
      for (int x = first; x < end; ++x) {
        const float step = (there[x] - here[x]) * sharpness;
        sum[x] += ring.strength * std::min(1.0F, std::max(0.0F, step));
      }
    }
  }
  for (int x = 0; x < canvas.width; ++x) sum[x] = 1.0F / (1.0F + sum[x]);
}

struct Lighting {
  float right, up, toward;  ///< direction of the lamp
  float cut;                ///< light on the faces of a cut
};

/// Light on a sphere at a pixel: its own shading, gloss in `gloss`.
struct Lit {
  float light, gloss;
};
Lit light_on(const ScreenSphere& sphere, const Lighting& lighting, float u, float v, float depth) {
  const float inverse = 1.0F / sphere.radius;
  const float right = (u - sphere.u) * inverse, up = (sphere.v - v) * inverse;
  const float toward = (depth - sphere.depth) * inverse;
  const float square = right * right + up * up + toward * toward;
  if (square < 0.98F) return {lighting.cut, 0.0F};  // inside the sphere: the face of a cut
  const float facing =
      std::max(0.0F, right * lighting.right + up * lighting.up + toward * lighting.toward);
  const float sky = 0.5F + 0.5F * up;
  // Half way between lamp and viewer, up to its length: bright only within a small cone.
  const float half_square = 2.0F + 2.0F * lighting.toward;
  const float half = right * lighting.right + up * lighting.up + toward * (lighting.toward + 1.0F);
  float gloss = std::max(0.0F, half * half / half_square);
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;
  const float rim = 0.82F + 0.18F * std::min(1.0F, 2.0F * std::max(0.0F, toward));
  return {rim * (0.44F + 0.14F * sky + 0.50F * facing), 0.10F * gloss * gloss};
}

std::uint8_t byte_of(float channel) {
  return static_cast<std::uint8_t>(std::min(1.0F, channel) * 255.0F + 0.5F);
}

}  // namespace

Vec3 lamp_direction() {
  const Vec3 direction{-0.45, 0.62, 0.75};
  return (1.0 / norm(direction)) * direction;
}

Image shade(const Canvas& canvas, std::span<const ItemLook> looks,
            const std::optional<ScreenClip>& clip, float relief) {
  const Vec3 lamp = lamp_direction();
  Lighting lighting{static_cast<float>(lamp.x), static_cast<float>(lamp.y),
                    static_cast<float>(lamp.z), 1.0F};
  if (clip) {
    const double facing = clip->nu * lamp.x - clip->nv * lamp.y + clip->nd * lamp.z;
    lighting.cut = static_cast<float>(0.70 + 0.30 * std::max(0.0, facing));
  }
  Image image{canvas.width, canvas.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(canvas.width) *
                   static_cast<std::size_t>(canvas.height));
  std::vector<float> light(static_cast<std::size_t>(canvas.width));
  std::uint8_t* pixel = image.rgb.data();
  for (int y = 0; y < canvas.height; ++y) {
    light_of_row(canvas, y, relief, light);
    const float* const depth = &canvas.depth[canvas.row(y)];
    const std::int32_t* const item = &canvas.item[canvas.row(y)];
    for (int x = 0; x < canvas.width; ++x, pixel += 3) {
      if (item[x] == Canvas::none) {
        pixel[0] = pixel[1] = pixel[2] = 255;
        continue;
      }
      const ItemLook& look = looks[static_cast<std::size_t>(item[x])];
      Lit lit{1.0F, 0.0F};
      if (look.sphere.radius > 0.0F) {
        lit = light_on(look.sphere, lighting, static_cast<float>(x) + 0.5F,
                       static_cast<float>(y) + 0.5F, depth[x]);
      }
      const float factor = lit.light * light[static_cast<std::size_t>(x)];
      pixel[0] = byte_of(factor * look.color.red + lit.gloss);
      pixel[1] = byte_of(factor * look.color.green + lit.gloss);
      pixel[2] = byte_of(factor * look.color.blue + lit.gloss);
    }
  }
  return image;
}

}  // namespace breccia
