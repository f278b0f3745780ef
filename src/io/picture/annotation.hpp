#pragma once
// Annotation of a picture: title, legend, scale bar, axes.

#include <string>

#include "io/picture/camera.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/paper.hpp"

namespace breccia {

/// Pixels a dot of text: 2 at a width of 1280.
int text_scale(const RenderOptions& options);

/// Height of a picture whose scene is `aspect` times as high as wide.  [pixels]
int fitted_height(const RenderOptions& options, const Legend& legend, double aspect);

/// Room that the scene gets beside the annotations.
Window scene_window(const RenderOptions& options, const Legend& legend);

void draw_title(Paper& paper, const std::string& title, const Frame& frame, int scale);
void draw_legend(Paper& paper, const Legend& legend, int scale);
/// A bar of round length, true everywhere in the picture since the projection is parallel.
void draw_scale_bar(Paper& paper, double resolution, int scale);
/// Directions of x, y and z in the lower right corner.
void draw_axes(Paper& paper, const Axes& axes, int scale);

}  // namespace breccia
