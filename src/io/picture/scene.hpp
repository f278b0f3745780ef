#pragma once
// The items of a frame on their way to the canvas: spheres, lines, triangles; of solid bodies see
// solid.hpp.

#include <algorithm>
#include <optional>
#include <vector>

#include "exec/tasks.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/shading.hpp"

namespace breccia {

/// The items to draw, in the order of their numbers: spheres, then lines, then triangles.
struct Scene {
  Camera camera;
  std::optional<ScreenClip> clip;
  const std::vector<Vec3>* points;  ///< of the frame  [m]
  std::vector<ItemLook> looks;
  std::vector<bool> solids_seen = {};  ///< tetrahedra that show; known once they are drawn

  ScreenPoint point(std::size_t i) const { return camera.project((*points)[i]); }
};

/// work(i) for every i in [0, count), a few thousand by one thread at a time.
template <class Work>
void for_chunks(int threads, std::size_t count, const Work& work) {
  constexpr std::size_t chunk = 4096;
  for_each_task(threads, static_cast<int>((count + chunk - 1) / chunk), [&](int number) {
    const std::size_t begin = chunk * static_cast<std::size_t>(number);
    for (std::size_t i = begin; i < std::min(count, begin + chunk); ++i) work(i);
  });
}

/// Flat items by the bands of rows that they may cover, and each band drawn by one thread, its
/// items in their order.
class Bands {
 public:
  Bands(const Canvas& canvas, int threads)
      : height_(canvas.height),
        threads_(threads),
        items_(static_cast<std::size_t>(threads > 1 ? (canvas.height + band - 1) / band : 1)) {}

  /// Notes an item between two heights of the picture, give or take `reach`.  [pixels]
  void add(std::size_t item, double top, double bottom, double reach) {
    if (!(bottom + reach >= 0.0 && top - reach <= height_)) return;
    const auto band_of = [this](double v) {
      const double row = std::clamp(v, 0.0, height_ - 1.0);
      return items_.size() == 1 ? 0 : static_cast<std::size_t>(row) / band;
    };
    for (std::size_t b = band_of(top - reach); b <= band_of(bottom + reach); ++b)
      items_[b].push_back(item);
  }
  /// draw(item, rows) for all
  template <class Draw>
  void draw(const Draw& draw_item) const {
    for_each_task(threads_, static_cast<int>(items_.size()), [&](int b) {
      Rows rows{0, height_ - 1};
      if (items_.size() > 1) rows = {b * band, std::min(height_, (b + 1) * band) - 1};
      for (const std::size_t item : items_[static_cast<std::size_t>(b)]) draw_item(item, rows);
    });
  }

 private:
  static constexpr int band = 32;  // pixels
  int height_, threads_;
  std::vector<std::vector<std::size_t>> items_;
};

/// Spheres come first, so that their place in the list is their item.
/// @param share  of their radius that is drawn
void place_spheres(Canvas& canvas, const Frame& frame, double share, Scene& scene, int threads);

void draw_lines(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                int threads);

void draw_triangles(Canvas& canvas, const Frame& frame, const std::vector<Color>& colors,
                    Scene& scene, int threads);

}  // namespace breccia
