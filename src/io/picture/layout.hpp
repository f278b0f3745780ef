#pragma once
// From a frame and the options of its picture to colours, camera and legend.

#include <optional>

#include "io/picture/camera.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/overlay.hpp"

namespace breccia {

/// The frame as the options change it, and the options for what is left. A frame that they leave
/// as it is must outlive it.
struct AsDrawn {
  RenderOptions options;

  AsDrawn(const Frame& whole, const RenderOptions& wanted);
  const Frame& frame() const { return changed_ ? *changed_ : *whole_; }

 private:
  const Frame* whole_;
  std::optional<Frame> changed_;
};

/// Of a frame as it is drawn, which must outlive it.
struct Layout {
  Coloring coloring;
  Extent extent;
  Axes axes;
  Overlay overlay;

  Layout(const Frame& frame, const RenderOptions& options);
  Camera camera(const RenderOptions& options) const;
};

}  // namespace breccia
