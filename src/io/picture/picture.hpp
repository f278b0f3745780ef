#pragma once
// Pictures of a frame: drawn in software, without a display or a GPU, with the same bits
// everywhere.

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/frame.hpp"

namespace breccia {

/// Eight bits a channel; rows from the top, pixels from the left, red green blue.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;         ///< 3 width height bytes
  std::vector<std::uint8_t> alpha = {};  ///< width height bytes; empty: opaque
  std::int64_t model_pixels = 0;         ///< of a rendered frame: where items of it show
  int dpi = 0;                           ///< for printers; 0: not said
};

/// The part of space that a picture shows: a box, cut off at the corners where points on the
/// outline of its content are known. Plain data, so that a checkpoint can hold it.
struct Extent {
  Vec3 low, high;                    ///<  [m]
  std::array<Vec3, 4> outline = {};  ///< as far as the content reaches  [m]
  std::int64_t outline_points = 0;   ///< of them that are known; 0: the whole box is shown
};

/// The values at the two ends of the colour bar, in the unit of the field.
struct ValueRange {
  double low, high;
};

/// A free camera. The projection is parallel: the picture is as high as what the angle takes in at
/// the target.
struct Viewpoint {
  Vec3 eye, target;            ///<  [m]
  Vec3 up = {0, 0, 1};         ///< about upwards in the picture
  double field_of_view = 0.6;  ///< from the lower to the upper border  [rad]
};

/// View, clip plane, field and size of a picture. `view` is one of
///   iso  from above, front and right, z up        x  from +x, y to the right, z up
///   y    from the front (-y), x right, z up       z  from above, x right, y up
/// `clip` is empty or a plane such as "x=0": what lies between it and the viewer is dropped and the
/// cut is shown (seen along the plane: what lies beyond in the direction of the axis is dropped).
/// "x<0.1" and "x>0.1" say which side stays. A height of 0 is as much as the model needs.
struct RenderOptions {
  std::string field = "damage";  ///< of points, lines or triangles; "velocity": its length,
                                 ///< "velocity_z": a component; "": one colour a group;
                                 ///< "contact_force": that of contacts, as "force" without links
  std::string view = "iso";
  std::string clip = {};
  int width = 1280, height = 960;  ///<  [pixels]
  bool show_spheres = true;        ///< draw the elements
  bool show_links = false;         ///< draw the lines, with smaller spheres; on for a line field
  std::string map = {};  ///< of colours: viridis, diverging, damage or ground; empty: by the field
  std::set<std::string> hidden = {};     ///< groups that are not drawn
  std::optional<ValueRange> range = {};  ///< default: the values of this frame, rounded outwards
  std::optional<Extent> extent = {};     ///< default: bulk_extent(frame); fix it for a series
  std::string title = {};                ///< stands before the time in the first line
  std::optional<Viewpoint> camera = {};  ///< instead of `view` and `extent`
  std::string arrows = {};               ///< a field of vectors of points
  bool forces = false;                   ///< of contacts, as lines
  bool crosses = false;                  ///< principal stresses in the plane of the picture
  bool xray = false;                     ///< what bars, cracks and broken links lie in is faded
  bool walls = true;                     ///< draw walls, and marks on what supports hold
  bool transparent = false;              ///< no ground
  double scale = 1.0;                    ///< of displacements  [-]
  bool log = false;                      ///< colours by the logarithm of the field
  bool edges = false;                    ///< edges of triangles
  bool bare = false;                     ///< without title, legend, scale bar and axes
};

/// The box around the bulk of each body of a frame, by its field "group": a small body far from a
/// large one is shown, while a few fragments of a body that flew far do not widen the box. Rollers
/// and platens beside them are in it.
Extent bulk_extent(const Frame& frame);

/// The extent for a later frame: the given one, widened where a body leaves it. What flies far
/// widens it to four times the first extent at most, the largest body to twelve; where that has
/// gone farther, the extent is that of the body.
/// @param share  of what is missing that is added on top, so that the next frames fit, too  [-]
Extent grown_extent(const Extent& extent, const Extent& first, const Frame& frame, double share);

/// The frame with `scale` times its displacements. @throws InputError if it has no such field
Frame displaced(const Frame& frame, double scale);
/// Adds the field "displacement" from the first frame of the run, where the frame lacks it.
/// @throws InputError if the frames have not the same bodies
void add_displacement(Frame& frame, const Frame& first);
/// Whether a picture shows displacements.
bool needs_displacement(const RenderOptions& options);

/// The height of a picture of height 0.  [pixels]
int picture_height(const Frame& frame, const RenderOptions& options);

/// Whether `field` of RenderOptions names something this frame has.
bool has_field(const Frame& frame, const std::string& field);

/// Whether a picture by this field shows the lines for their colours.
bool colors_lines(const Frame& frame, const std::string& field);

/// Whether it shows forces of contacts, which frames of a folder are read with if they are wanted.
bool shows_contacts(const Frame& frame, const RenderOptions& options);

/// Whether some frame could show them with these options: alike for all parts of one.
bool may_show_contacts(const RenderOptions& options);

/// Whether the lines have what tells cracks apart: pictures of triangles show them with any field.
bool has_cracks(const Frame& frame);

/// @throws InputError if a picture's size makes no sense, or a frame's parts do not fit each other
void check_frame(const Frame& frame, const RenderOptions& options);

/// Draws the frame: parallel projection, shaded spheres, lines and triangles, colour bar, scale
/// bar, title with time. The first frame of a run gives the extent of its whole series:
///
///   RenderOptions options{.field = "damage", .extent = bulk_extent(first)};
///   write_png("picture.png", render(frame, options));
///
/// @throws InputError if field, view, clip or size make no sense (names what is allowed)
///
/// Any number of threads draws the same bits.
///
/// Cost: about 20 ms for 14,274 spheres at 1280 x 960 on one core.
Image render(const Frame& frame, const RenderOptions& options, int threads = 1);

/// The image as PNG; empty if it cannot be encoded.
std::string png_content(const Image& image);

/// Writes the image under a temporary name, then renames it: a reader never sees half a picture.
/// @throws IoError with path and reason
void write_png(const std::string& path, const Image& image);
void write_png(const std::string& path, const std::string& content);

/// Any PNG, as eight bits a channel; what is transparent is white.
/// @throws IoError    if the file cannot be read
/// @throws InputError if it is no PNG, damaged, or has more than 2^28 pixels
Image read_png(const std::string& path);
/// Reads a PNG with its transparency.
Image read_png_with_alpha(const std::string& path);

}  // namespace breccia
