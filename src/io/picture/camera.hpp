#pragma once
// From space to the picture: parallel projection, and the plane that cuts the scene open.

#include <optional>
#include <string>

#include "io/picture/picture.hpp"

namespace breccia {

/// A place on the picture: u to the right, v down, depth towards the viewer.  [pixels]
struct ScreenPoint {
  double u, v, depth;
};

/// Three directions of unit length at right angles, right x up = towards the viewer.
struct Axes {
  Vec3 right, up, toward;
};

/// The axes of a view named as in RenderOptions. @throws InputError listing the names
Axes axes_of_view(const std::string& view);

/// The part of the picture that the scene may fill.  [pixels]
struct Window {
  double left, top, right, bottom;
};

struct Camera {
  Axes axes;
  Vec3 centre;        ///< shown at (u, v)  [m]
  double u, v;        ///<  [pixels]
  double resolution;  ///<  [pixels/m]

  ScreenPoint project(const Vec3& point) const {
    const Vec3 offset = point - centre;
    return {u + resolution * dot(offset, axes.right), v - resolution * dot(offset, axes.up),
            resolution * dot(offset, axes.toward)};
  }
};

/// The camera that shows the whole extent as large as the window allows.
Camera fitted_camera(const Axes& axes, const Extent& extent, const Window& window);

/// The free camera: the window is as high as its angle takes in at the target.
/// @throws InputError if eye, target, up or angle make no sense
Camera camera_at(const Viewpoint& from, const Window& window);

/// A plane; what lies on the side of its normal is dropped.
struct Clip {
  Vec3 normal;
  double offset;  ///< of the plane from the origin, along the normal  [m]

  bool keeps(const Vec3& point) const { return dot(point, normal) <= offset; }
};

/// The part of an extent that a plane at right angles to an axis leaves.
Extent cut_extent(const Extent& extent, const Clip& clip);

/// Reads RenderOptions::clip; nothing for an empty text. @throws InputError with what is allowed
std::optional<Clip> clip_of(const std::string& text, const Axes& axes);

/// A clip plane on the picture: points with u nu + v nv + depth nd + n0 > 0 are dropped.
struct ScreenClip {
  double nu, nv, nd, n0;

  double beyond(double u, double v, double depth) const {
    return nu * u + nv * v + nd * depth + n0;
  }
};
ScreenClip on_screen(const Clip& clip, const Camera& camera);

}  // namespace breccia
