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

/// The step to a neighbour that open_sky looks at; it looks three of them far.  [pixels]
int sky_unit(const Canvas& canvas) {
  return std::max(1, canvas.height / 640);
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
  const int unit = sky_unit(canvas);
  const float* const here = &canvas.depth[canvas.row(y)];
  const float sharpness = 1.0F / relief;
  float* const sum = light.data();
  std::fill(sum + stretch.first, sum + stretch.last + 1, 0.0F);
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

/// Lights pixels of rows, one row after the other.
class RowShader {
 public:
  RowShader(const Canvas& canvas, std::span<const ItemLook> looks,
            const std::optional<ScreenClip>& clip, float relief)
      : canvas_(canvas),
        looks_(looks),
        clip_(clip),
        relief_(relief),
        light_(static_cast<std::size_t>(canvas.width)),
        gloss_(static_cast<std::size_t>(canvas.width)),
        directions_(static_cast<std::size_t>(canvas.width)) {
    const Vec3 lamp = lamp_direction();
    lamp_ = {static_cast<float>(lamp.x), static_cast<float>(lamp.y), static_cast<float>(lamp.z),
             1.0F};
    if (!clip) return;
    const double facing = clip->nu * lamp.x - clip->nv * lamp.y + clip->nd * lamp.z;
    lamp_.cut = static_cast<float>(0.84 + 0.16 * std::max(0.0, facing));
  }
  /// @param row  colours of pixel 0 and those after it; where nothing is they stay as they are
  void shade(int y, Stretch stretch, std::uint8_t* row) {
    open_sky(canvas_, y, stretch, relief_, light_);
    find_directions(canvas_, looks_, clip_, y, stretch, directions_);
    add_lamp(lamp_, stretch, directions_, light_, gloss_);
    const std::int32_t* const item = &canvas_.item[canvas_.row(y)];
    for (int x = stretch.first; x <= stretch.last; ++x) {
      if (item[x] == Canvas::none) continue;
      const Color& color = looks_[static_cast<std::size_t>(item[x])].color;
      const float factor = light_[static_cast<std::size_t>(x)];
      const float shine = gloss_[static_cast<std::size_t>(x)];
      row[3 * x] = byte_of(factor * color.red + shine);
      row[3 * x + 1] = byte_of(factor * color.green + shine);
      row[3 * x + 2] = byte_of(factor * color.blue + shine);
    }
  }

 private:
  const Canvas& canvas_;
  std::span<const ItemLook> looks_;
  const std::optional<ScreenClip>& clip_;
  float relief_;
  Lighting lamp_;
  std::vector<float> light_, gloss_;
  Directions directions_;
};

/// Depths in blocks of rows: where no neighbour stands nearer, flat items show their own colour.
class Levels {
 public:
  /// @param block  width of a block: open_sky looks no further  [pixels]
  Levels(const Canvas& canvas, int block, int threads)
      : canvas_(canvas), block_(block), blocks_((canvas.width + block - 1) / block) {
    const auto count = static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(canvas.height);
    lowest_.resize(count);
    highest_.resize(count);
    for_each_task(threads, canvas.height, [&](int y) {
      for (int b = 0; b < blocks_; ++b) measure(y, b);
    });
  }
  int blocks() const { return blocks_; }
  bool has_items(int y, int b) const { return lowest_[at(y, b)] < nowhere; }
  bool is_level(int y, int b) const {
    const int unit = sky_unit(canvas_);
    float nearest = Canvas::empty;
    for (const int down : {0, -1, 1, -3, 3}) {
      const int row = std::clamp(y + unit * down, 0, canvas_.height - 1);
      for (int k = std::max(0, b - 1); k <= std::min(blocks_ - 1, b + 1); ++k)
        nearest = std::max(nearest, highest_[at(row, k)]);
    }
    return nearest <= lowest_[at(y, b)];
  }

 private:
  static constexpr float nowhere = 1e30F;
  std::size_t at(int y, int b) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_) +
           static_cast<std::size_t>(b);
  }
  void measure(int y, int b) {
    const float* const depth = &canvas_.depth[canvas_.row(y)];
    float lowest = nowhere, highest = Canvas::empty;
    for (int x = b * block_; x < std::min(canvas_.width, (b + 1) * block_); ++x) {
      const float covered = depth[x] > Canvas::empty ? depth[x] : nowhere;
      lowest = std::min(lowest, covered);
      highest = std::max(highest, depth[x]);
    }
    lowest_[at(y, b)] = lowest;
    highest_[at(y, b)] = highest;
  }

  const Canvas& canvas_;
  int block_, blocks_;
  std::vector<float> lowest_, highest_;  ///< of what is covered, by row and block  [pixels]
};

using Pixel = std::array<std::uint8_t, 3>;

/// Pixels of a picture from blocks of `fine` times `fine` of its canvas.
class Reducer {
 public:
  Reducer(const Canvas& canvas, std::span<const ItemLook> looks, int fine, std::uint8_t ground)
      : canvas_(canvas), fine_(fine), ground_(ground) {
    colors_.reserve(looks.size());
    for (const ItemLook& look : looks)
      colors_.push_back(
          {byte_of(look.color.red), byte_of(look.color.green), byte_of(look.color.blue)});
  }
  /// Pixel (x, y) of the picture where all items show their own colours.
  Pixel own_color(int x, int y) const {
    const std::int32_t first = canvas_.item[place(x, y, 0, 0)];
    bool alike = true;
    for (int down = 0; down < fine_; ++down)
      for (int right = 0; right < fine_; ++right)
        alike = alike && canvas_.item[place(x, y, right, down)] == first;
    if (alike) return color_of(first);
    std::array<unsigned, 3> sum{};
    for (int down = 0; down < fine_; ++down)
      for (int right = 0; right < fine_; ++right) {
        const Pixel color = color_of(canvas_.item[place(x, y, right, down)]);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
      }
    return mean(sum);
  }
  /// The mean of pixels that have been lit.
  /// @param rows  of the canvas, those of the picture's row, `stride` bytes from each to the next
  Pixel mean_of(const std::uint8_t* rows, std::size_t stride, int x) const {
    std::array<unsigned, 3> sum{};
    for (int down = 0; down < fine_; ++down) {
      const std::uint8_t* from = rows + static_cast<std::size_t>(down) * stride + 3 * fine_ * x;
      for (int right = 0; right < fine_; ++right)
        for (std::size_t c = 0; c < 3; ++c) sum[c] += *from++;
    }
    return mean(sum);
  }

 private:
  std::size_t place(int x, int y, int right, int down) const {
    return canvas_.row(fine_ * y + down) + static_cast<std::size_t>(fine_ * x + right);
  }
  Pixel color_of(std::int32_t item) const {
    return item == Canvas::none ? Pixel{ground_, ground_, ground_}
                                : colors_[static_cast<std::size_t>(item)];
  }
  Pixel mean(const std::array<unsigned, 3>& sum) const {
    const auto count = static_cast<unsigned>(fine_ * fine_);
    Pixel bytes{};
    for (std::size_t c = 0; c < 3; ++c)
      bytes[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    return bytes;
  }

  const Canvas& canvas_;
  int fine_;
  std::uint8_t ground_;
  std::vector<Pixel> colors_;  ///< of each item, where nothing shades it
};

}  // namespace

Vec3 lamp_direction() {
  const Vec3 direction{-0.45, 0.62, 0.75};
  return (1.0 / norm(direction)) * direction;
}

Image shade(const Canvas& canvas, std::span<const ItemLook> looks,
            const std::optional<ScreenClip>& clip, float relief, int threads, std::uint8_t ground) {
  const auto width = static_cast<std::size_t>(canvas.width);
  Image image{canvas.width, canvas.height, {}};
  image.rgb.assign(3 * width * static_cast<std::size_t>(canvas.height), ground);
  constexpr int band = 16;  // rows that one thread takes
  for_each_task(threads, (canvas.height + band - 1) / band, [&](int number) {
    RowShader shader(canvas, looks, clip, relief);
    for (int y = band * number; y < std::min(canvas.height, band * (number + 1)); ++y) {
      const Stretch stretch = covered(canvas, y);
      if (stretch.first <= stretch.last)
        shader.shade(y, stretch, &image.rgb[3 * width * static_cast<std::size_t>(y)]);
    }
  });
  return image;
}

Image shade_reduced(const Canvas& canvas, std::span<const ItemLook> looks,
                    const std::optional<ScreenClip>& clip, float relief, int fine, int threads,
                    std::uint8_t ground) {
  const int wide = std::max(16, 3 * sky_unit(canvas) / fine + 1);  // of a block, in the picture
  const bool flat = std::none_of(looks.begin(), looks.end(),
                                 [](const ItemLook& look) { return look.sphere.radius > 0.0F; });
  const Levels levels(canvas, fine * wide, threads);
  const Reducer reducer(canvas, looks, fine, ground);
  Image image{canvas.width / fine, canvas.height / fine, {}};
  image.rgb.assign(
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), ground);
  const std::size_t stride = 3 * static_cast<std::size_t>(canvas.width);
  constexpr int band = 8;  // rows that one thread takes
  for_each_task(threads, (image.height + band - 1) / band, [&](int number) {
    RowShader shader(canvas, looks, clip, relief);
    std::vector<std::uint8_t> lit(stride * static_cast<std::size_t>(fine));
    for (int y = band * number; y < std::min(image.height, band * (number + 1)); ++y)
      for (int b = 0; b < levels.blocks(); ++b) {
        bool any = false, level = flat;
        for (int row = fine * y; row < fine * (y + 1); ++row) {
          any = any || levels.has_items(row, b);
          level = level && levels.is_level(row, b);
        }
        if (!any) continue;
        const int first = wide * b, last = std::min(image.width, wide * (b + 1)) - 1;
        for (int down = 0; !level && down < fine; ++down) {
          std::uint8_t* const row = &lit[stride * static_cast<std::size_t>(down)];
          std::fill(row + 3 * fine * first, row + 3 * fine * (last + 1), ground);
          shader.shade(fine * y + down, {fine * first, fine * (last + 1) - 1}, row);
        }
        std::uint8_t* to =
            &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(first))];
        for (int x = first; x <= last; ++x) {
          const Pixel color =
              level ? reducer.own_color(x, y) : reducer.mean_of(lit.data(), stride, x);
          to = std::copy(color.begin(), color.end(), to);
        }
      }
  });
  return image;
}

}  // namespace breccia
