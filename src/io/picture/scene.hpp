#pragma once
// The items of a frame on their way to the canvas: spheres, lines, triangles.

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
  std::vector<ScreenPoint> points;
  std::vector<ItemLook> looks;
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

/// Spheres come first, so that their place in the list is their item.
/// @param share  of their radius that is drawn
void place_spheres(Canvas& canvas, const Frame& frame, double share, Scene& scene, int threads);

void draw_lines(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                int threads);

void draw_triangles(Canvas& canvas, const Frame& frame, const std::vector<Color>& colors,
                    Scene& scene, int threads);

}  // namespace breccia
