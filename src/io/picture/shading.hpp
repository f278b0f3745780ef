#pragma once
// From depths and items to light and colour.

#include <span>
#include <vector>

#include "io/picture/color_map.hpp"
#include "io/picture/raster.hpp"

namespace breccia {

/// Colour and shape of an item in a pixel, before lighting.
struct ItemLook {
  Color color;
  ScreenSphere sphere;  ///< radius 0: a flat item, which its colour already shades
};

/// Direction of the lamp from the scene: right, up, towards the viewer; of unit length.
Vec3 lamp_direction();

/// Lights every pixel: diffuse and a little gloss on spheres, darker where nearer things stand
/// around a pixel (after C. Boucheny's eye-dome lighting, 2009), the ground where nothing is. Faces
/// of a cut are flat. `ground` is a shade of grey, 255: white. `relief` is the difference in depth
/// that counts as deep  [pixels]
Image shade(const Canvas& canvas, std::span<const ItemLook> looks,
            const std::optional<ScreenClip>& clip, float relief, int threads,
            std::uint8_t ground = 255);

/// That of each block of `fine` times `fine` pixels its mean: a picture smaller than its canvas.
Image shade_reduced(const Canvas& canvas, std::span<const ItemLook> looks,
                    const std::optional<ScreenClip>& clip, float relief, int fine, int threads,
                    std::uint8_t ground = 255);

/// Softens the steps on the outlines of spheres: a pixel that an outline crosses takes part of the
/// colour of either side, by the distance of its centre from the outline.
void smooth_outlines(Image& image, const Canvas& canvas, std::span<const ItemLook> looks,
                     int threads);

}  // namespace breccia
