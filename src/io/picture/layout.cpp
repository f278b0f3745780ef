#include "io/picture/layout.hpp"

#include "io/picture/annotation.hpp"
#include "io/picture/hidden.hpp"

namespace breccia {
namespace {

/// A flat frame has nothing to show from the side: there the slanted view looks from above.
Axes axes_for(const Extent& extent, const RenderOptions& options) {
  const bool flat = extent.low.z == extent.high.z;
  return axes_of_view(flat && options.view == "iso" ? "z" : options.view);
}

/// The part that a cut leaves, if it can be shown larger than the whole: else the camera stays.
Extent nearer(const Extent& whole, const Extent& cut, const Axes& axes,
              const RenderOptions& options) {
  const double height = options.height > 0 ? options.height : 0.75 * options.width;
  const Window window{0.0, 0.0, 1.0 * options.width, height};
  constexpr double gain = 1.05;
  return fitted_camera(axes, cut, window).resolution >
                 gain * fitted_camera(axes, whole, window).resolution
             ? cut
             : whole;
}

}  // namespace

AsDrawn::AsDrawn(const Frame& whole, const RenderOptions& wanted)
    : options(wanted), whole_(&whole) {
  if (options.scale != 1.0) changed_ = displaced(whole, options.scale);
  if (!options.extent) options.extent = bulk_extent(frame());
  if (!options.hidden.empty()) changed_ = without_groups(frame(), options.hidden);
  options.scale = 1.0;
  options.hidden.clear();
  if (options.height == 0) options.height = picture_height(frame(), options);
}

Layout::Layout(const Frame& frame, const RenderOptions& options)
    : coloring(color_frame(frame, options)),
      extent(options.extent ? *options.extent : bulk_extent(frame)),
      axes(options.camera ? camera_at(*options.camera, {0, 0, 1, 1}).axes
                          : axes_for(extent, options)),
      overlay(frame, options, coloring) {
  if (const std::optional<Clip> clip = clip_of(options.clip, axes))
    extent = nearer(extent, cut_extent(extent, *clip), axes, options);
}

Camera Layout::camera(const RenderOptions& options) const {
  const Window window = scene_window(options, coloring.legend);
  return options.camera ? camera_at(*options.camera, window) : fitted_camera(axes, extent, window);
}

int picture_height(const Frame& frame, const RenderOptions& options) {
  if (options.height > 0) return options.height;
  if (options.scale != 1.0 || !options.hidden.empty())
    return AsDrawn(frame, options).options.height;
  const Layout layout(frame, options);
  if (options.camera) return options.width * 3 / 4;
  const Camera unit = fitted_camera(layout.axes, layout.extent, {0.0, 0.0, 1.0, 1e9});
  const Camera tall = fitted_camera(layout.axes, layout.extent, {0.0, 0.0, 1e9, 1.0});
  return fitted_height(options, layout.coloring.legend, unit.resolution / tall.resolution);
}

}  // namespace breccia
