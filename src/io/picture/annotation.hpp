#pragma once
// Annotation of a picture: title, legend, scale bar, axes.

#include <string>

#include "io/picture/camera.hpp"
#include "io/picture/field_colors.hpp"

namespace breccia {

/// Pixels a dot of text: 2 at a height of 960.
int text_scale(const RenderOptions& options);

/// Room that the scene gets beside the annotations.
Window scene_window(const RenderOptions& options, const Legend& legend);

void draw_title(Image& image, const std::string& title, const Frame& frame, int scale);
void draw_legend(Image& image, const Legend& legend, int scale);
/// A bar of round length, true everywhere in the picture since the projection is parallel.
void draw_scale_bar(Image& image, double resolution, int scale);
/// Directions of x, y and z in the lower right corner.
void draw_axes(Image& image, const Axes& axes, int scale);

}  // namespace breccia
