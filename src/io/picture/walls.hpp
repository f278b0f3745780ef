#pragma once
// Walls on a picture: what of an endless plane lies about the model, with a grid on it.

#include "io/picture/paper.hpp"
#include "io/picture/scene.hpp"

namespace breccia {

/// Draws the walls: behind the model hidden by it, before it as a veil; one seen from its edge as a
/// stroke, hatched on the side that is solid.
/// @param fine  pixels of the canvas and the scene for one of the image
void draw_walls(Image& image, const std::vector<FrameWall>& walls, const Canvas& canvas,
                const Scene& scene, const Extent& extent, int fine, int scale);

/// Draws walls that are seen from their edge as strokes.  @param camera  in pixels of the paper
void draw_wall_edges(Paper& paper, const std::vector<FrameWall>& walls, const Camera& camera,
                     const Extent& extent, int scale);

}  // namespace breccia
