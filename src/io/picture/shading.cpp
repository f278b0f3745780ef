#include "io/picture/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/tasks.hpp"

namespace breccia {
namespace {

/// The pixels of a row that something covers; first > last: none.
struct Stretch {
  int first, last;
};
Stretch covered(const Canvas& canvas, int y) {
  const std::int32_t* const item = &canvas.item[canvas.row(y)];
  Stretch stretch{0, canvas.width - 1};
  while (stretch.first < canvas.width && item[stretch.first] == Canvas::none) ++stretch.first;
  while (stretch.last > stretch.first && item[stretch.last] == Canvas::none) --stretch.last;
  return stretch;
}

/// Light that reaches the pixels of a row, 0 to 1: less where neighbours stand nearer.
void open_sky(const Canvas& canvas, int y, Stretch stretch, float relief,
              std::vector<float>& light) {
  struct Neighbour {
    int right, down;  // pixels at a height of 640
    float strength;
  };
  constexpr std::array neighbours{Neighbour{1, 0, 0.30F},  Neighbour{-1, 0, 0.30F},
                                  Neighbour{0, 1, 0.30F},  Neighbour{0, -1, 0.30F},
                                  Neighbour{3, 3, 0.17F},  Neighbour{3, -3, 0.17F},
                                  Neighbour{-3, 3, 0.17F}, Neighbour{-3, -3, 0.17F}};
  const int unit = std::max(1, canvas.height / 640);
  const float* const here = &canvas.depth[canvas.row(y)];
  const float sharpness = 1.0F / relief;
  float* const sum = light.data();
  std::fill(light.begin(), light.end(), 0.0F);
  for (const Neighbour& neighbour : neighbours) {
    const int row = std::clamp(y + unit * neighbour.down, 0, canvas.height - 1);
    const int shift = unit * neighbour.right;
    const float* const there = &canvas.depth[canvas.row(row)] + shift;
    const int first = std::max(stretch.first, -shift);
    const int last = std::min(stretch.last, canvas.width - 1 - shift);
    const float strength = neighbour.strength;
    for (int x = first; x <= last; ++x) {
      const float step = (there[x] - here[x]) * sharpness;
      sum[x] += strength * std::min(1.0F, std::max(0.0F, step));
    }
  }
  for (int x = stretch.first; x <= stretch.last; ++x) sum[x] = 1.0F / (1.0F + sum[x]);
}

/// Where on its item each pixel of a row lies: direction from the centre over the radius, to the
/// right, up and towards the viewer. Flat items have zeros.
struct Directions {
  explicit Directions(std::size_t width) : right(width), up(width), toward(width), face(width) {}
  std::vector<float> right, up, toward;
  std::vector<float> face;  ///< 1 on the plane of a cut
};

void find_directions(const Canvas& canvas, std::span<const ItemLook> looks,
                     const std::optional<ScreenClip>& clip, int y, Stretch stretch,
                     Directions& directions) {
  constexpr double thin = 0.05;  // pixels

  const float* const depth = &canvas.depth[canvas.row(y)];
  const std::int32_t* const item = &canvas.item[canvas.row(y)];
  for (int x = stretch.first; x <= stretch.last; ++x) {
    const auto place = static_cast<std::size_t>(x);
    directions.right[place] = directions.up[place] = directions.toward[place] = 0.0F;
    directions.face[place] = 0.0F;
    if (item[x] == Canvas::none) continue;
    const ScreenSphere& sphere = looks[static_cast<std::size_t>(item[x])].sphere;
    if (!(sphere.radius > 0.0F)) continue;
    if (clip && clip->beyond(x + 0.5, y + 0.5, depth[x]) > -thin) directions.face[place] = 1.0F;
    const float inverse = 1.0F / sphere.radius;
    directions.right[place] = (static_cast<float>(x) + 0.5F - sphere.u) * inverse;
    directions.up[place] = (sphere.v - static_cast<float>(y) - 0.5F) * inverse;
    directions.toward[place] = (depth[x] - sphere.depth) * inverse;
  }
}

struct Lighting {
  float right, up, toward;  ///< direction of the lamp
  float cut;                ///< light on the faces of a cut
};

/// Multiplies the light of a row by that of the lamp on each item; gloss comes on top.
void add_lamp(const Lighting& lamp, Stretch stretch, const Directions& directions,
              std::vector<float>& light, std::vector<float>& gloss) {
  const float half_squared = 2.0F + 2.0F * lamp.toward;  // of lamp plus viewer's direction
  for (auto x = static_cast<std::size_t>(stretch.first);
       x <= static_cast<std::size_t>(stretch.last); ++x) {
    const float right = directions.right[x], up = directions.up[x], toward = directions.toward[x];
    const float squared = right * right + up * up + toward * toward;
    const float facing = right * lamp.right + up * lamp.up + toward * lamp.toward;
    const float rim = 0.80F + 0.20F * std::min(1.0F, 2.0F * std::max(0.0F, toward));
    const float ball = rim * (0.58F + 0.06F * up + 0.47F * std::max(0.0F, facing));
    const float half = std::max(0.0F, facing + toward);
    float shine = half * half / half_squared;
    shine = shine * shine * shine * shine;
    shine = shine * shine * shine * shine;
    const float lit = light[x] * (squared == 0.0F ? 1.0F : ball);
    const float face = directions.face[x];
    light[x] = face > 0.0F ? lamp.cut : lit;
    gloss[x] = squared == 0.0F || face > 0.0F ? 0.0F : 0.07F * shine;
  }
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
            const std::optional<ScreenClip>& clip, float relief, int threads, std::uint8_t ground) {
  const Vec3 lamp = lamp_direction();
  Lighting lighting{static_cast<float>(lamp.x), static_cast<float>(lamp.y),
                    static_cast<float>(lamp.z), 1.0F};
  if (clip) {
    const double facing = clip->nu * lamp.x - clip->nv * lamp.y + clip->nd * lamp.z;
    lighting.cut = static_cast<float>(0.84 + 0.16 * std::max(0.0, facing));
  }
  const auto width = static_cast<std::size_t>(canvas.width);
  Image image{canvas.width, canvas.height, {}};
  image.rgb.assign(3 * width * static_cast<std::size_t>(canvas.height), ground);
  constexpr int band = 16;  // rows that one thread takes
  for_each_task(threads, (canvas.height + band - 1) / band, [&](int number) {
    std::vector<float> light(width), gloss(width);
    Directions directions(width);
    for (int y = band * number; y < std::min(canvas.height, band * (number + 1)); ++y) {
      const Stretch stretch = covered(canvas, y);
      if (stretch.first > stretch.last) continue;
      open_sky(canvas, y, stretch, relief, light);
      find_directions(canvas, looks, clip, y, stretch, directions);
      add_lamp(lighting, stretch, directions, light, gloss);
      const std::int32_t* const item = &canvas.item[canvas.row(y)];
      std::uint8_t* const row = &image.rgb[3 * width * static_cast<std::size_t>(y)];
      for (int x = stretch.first; x <= stretch.last; ++x) {
        if (item[x] == Canvas::none) continue;
        const Color& color = looks[static_cast<std::size_t>(item[x])].color;
        const float factor = light[static_cast<std::size_t>(x)];
        const float shine = gloss[static_cast<std::size_t>(x)];
        row[3 * x] = byte_of(factor * color.red + shine);
        row[3 * x + 1] = byte_of(factor * color.green + shine);
        row[3 * x + 2] = byte_of(factor * color.blue + shine);
      }
    }
  });
  return image;
}

}  // namespace breccia
