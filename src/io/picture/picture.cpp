#include "io/picture/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"
#include "io/frame_pair.hpp"
#include "io/picture/annotation.hpp"
#include "io/picture/layout.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/sides.hpp"
#include "io/picture/solid.hpp"
#include "io/picture/walls.hpp"

namespace breccia {
namespace {

constexpr double sphere_share_beside_links = 0.4;    ///< of the radius, so that links show
constexpr double sphere_share_beside_colours = 0.2;  ///< of the radius, where links carry the field
constexpr std::uint8_t white_byte = 255, black_byte = 0;

/// `share` of another picture in a pixel.
void mix(Image& image, const Image& other, std::size_t pixel, float share) {
  for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
    const float here = image.rgb[c], there = other.rgb[c];
    image.rgb[c] = static_cast<std::uint8_t>(here + share * (there - here) + 0.5F);
  }
}

/// The spheres of a scene that are chosen.
std::vector<ScreenSphere> chosen_of(const Scene& scene, const std::vector<bool>& chosen) {
  std::vector<ScreenSphere> spheres(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) spheres[i] = scene.looks[i].sphere;
  return spheres;
}

/// Reinforcement that others hide, drawn over them as if they were veils.
void draw_bars(Image& image, const Canvas& canvas, const Coloring& coloring, const Scene& scene,
               float relief, int threads) {
  Canvas behind(image.width, image.height);
  draw_spheres(behind, chosen_of(scene, coloring.bars), scene.clip, threads);
  Image own = shade(behind, scene.looks, scene.clip, relief, threads);
  smooth_outlines(own, behind, scene.looks, threads);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = canvas.row(y) + static_cast<std::size_t>(x);
      const std::int32_t front = canvas.item[at];
      if (behind.item[at] == Canvas::none || front == Canvas::none || front == behind.item[at])
        continue;
      const auto item = static_cast<std::size_t>(front);
      const float veil = item < coloring.veil.size() ? coloring.veil[item] : 0.0F;
      mix(image, own,
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(x),
          veil);
    }
}

/// Lays what is faded over what lies within it.
/// @param image  of what lies within, on its canvas
void lay_veil(Image& image, const Canvas& within, const Image& veil, const Canvas& canvas) {
  constexpr float left = 0.22F;    // of what is faded
  constexpr float before = 0.16F;  // of what is faded, over what it hides
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = canvas.row(y) + static_cast<std::size_t>(x);
      const bool shows = within.item[at] != Canvas::none;
      if (shows && within.depth[at] >= canvas.depth[at] - 0.5F) continue;
      mix(image, veil,
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(x),
          shows ? before : left);
    }
}

/// Spheres that are faded, and what lies among them: bars, other bodies, lines.
Image see_through(const Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                  float relief, int threads, std::uint8_t ground) {
  Canvas within(canvas.width, canvas.height);
  draw_spheres(within, chosen_of(scene, coloring.inside), scene.clip, threads);
  draw_lines(within, frame, coloring, scene, threads);
  Image veil = shade(canvas, scene.looks, scene.clip, relief, threads, ground);
  smooth_outlines(veil, canvas, scene.looks, threads);
  Image image = shade(within, scene.looks, scene.clip, relief, threads, ground);
  smooth_outlines(image, within, scene.looks, threads);
  lay_veil(image, within, veil, canvas);
  return image;
}

/// Depth that looks deep: about a radius of the usual sphere, or an edge of tetrahedra.  [pixels]
float relief_of(const Frame& frame, double resolution) {
  if (!frame.tetrahedra.empty()) {
    const std::size_t some = std::min<std::size_t>(frame.tetrahedra.size() / 4, 1000);
    double sum = 0.0;
    for (std::size_t t = 0; t < some; ++t)
      sum += norm(frame.position[static_cast<std::size_t>(frame.tetrahedra[4 * t])] -
                  frame.position[static_cast<std::size_t>(frame.tetrahedra[4 * t + 1])]);
    return static_cast<float>(std::clamp(resolution * sum / static_cast<double>(some), 10.0, 1e4));
  }
  if (frame.radius.empty()) return 10.0F;
  std::vector<double> radius = frame.radius;
  const auto middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
  std::nth_element(radius.begin(), middle, radius.end());
  return static_cast<float>(std::clamp(1.5 * resolution * *middle, 2.0, 1e4));
}

/// Pixels that are drawn side by side for one of the picture: edges of faces and cracks come
/// out smooth, and gaps between faces narrower than a pixel leave no holes. Spheres have
/// outlines of their own.
int fineness(const Frame& frame, const RenderOptions& options) {
  if (frame.triangles.empty() && frame.tetrahedra.empty()) return 1;
  const double pixels = 1.0 * options.width * options.height;
  return pixels <= 4e6 ? 3 : pixels <= 16e6 ? 2 : 1;
}

/// The mean of each block of `fine` times `fine` pixels.
Image reduced(const Image& large, int fine, int threads) {
  Image image{large.width / fine, large.height / fine, {}};
  const auto width = static_cast<std::size_t>(image.width), step = static_cast<std::size_t>(fine);
  image.rgb.resize(3 * width * static_cast<std::size_t>(image.height));
  const std::size_t row = 3 * step * width;  // bytes of a row of the large image
  const unsigned block = static_cast<unsigned>(fine * fine);
  for_each_task(threads, image.height, [&](int y) {
    std::vector<std::uint16_t> column(row);  // sums over the rows of a block
    const std::uint8_t* from = &large.rgb[static_cast<std::size_t>(y) * step * row];
    for (std::size_t k = 0; k < step; ++k, from += row)
      for (std::size_t i = 0; i < row; ++i)
        column[i] = static_cast<std::uint16_t>(column[i] + from[i]);
    std::uint8_t* to = &image.rgb[3 * width * static_cast<std::size_t>(y)];
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        unsigned sum = block / 2;
        for (std::size_t k = 0; k < step; ++k) sum += column[3 * (step * x + k) + c];
        *to++ = static_cast<std::uint8_t>(sum / block);
      }
  });
  return image;
}

/// From the pictures before white and before black: what is alike in both is opaque.
Image without_ground(const Image& on_white, const Image& on_black) {
  Image image = on_black;
  const std::size_t pixels = image.rgb.size() / 3;
  image.alpha.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    int through = 255;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      through = std::min(through, std::max(0, on_white.rgb[c] - on_black.rgb[c]));
    const int alpha = 255 - through;
    image.alpha[i] = static_cast<std::uint8_t>(alpha);
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      image.rgb[c] = static_cast<std::uint8_t>(
          alpha > 0 ? std::min(255, (on_black.rgb[c] * 255 + alpha / 2) / alpha) : 255);
  }
  return image;
}

/// Bodies of tetrahedra, and cracks on their surface or, by x-ray, within.
Image draw_bodies(Canvas& canvas, const Frame& frame, const RenderOptions& options,
                  const Coloring& coloring, Scene& scene, int threads, std::uint8_t ground) {
  const bool joints = options.show_links || coloring.of_lines || coloring.cracks;
  const float relief = relief_of(frame, scene.camera.resolution);
  if (is_paired(frame) && options.show_spheres) place_spheres(canvas, frame, 1.0, scene, threads);
  draw_solids(canvas, frame, coloring, {joints && !options.xray, options.edges}, scene, threads);
  const int fine = canvas.width / options.width;
  if (!options.xray && fine > 1)
    return shade_reduced(canvas, scene.looks, scene.clip, relief, fine, threads, ground);
  Image image = shade(canvas, scene.looks, scene.clip, relief, threads, ground);
  if (!options.xray) return image;
  Canvas within(canvas.width, canvas.height);
  draw_joint_faces(within, frame, coloring, scene, threads);
  Image inside = shade(within, scene.looks, scene.clip, relief, threads, ground);
  lay_veil(inside, within, image, canvas);
  return fine > 1 ? reduced(inside, fine, threads) : inside;
}

/// Draws the items.
Image draw_items(Canvas& canvas, const Frame& frame, const RenderOptions& options,
                 const Coloring& coloring, Scene& scene, int threads, std::uint8_t ground) {
  if (!frame.tetrahedra.empty())
    return draw_bodies(canvas, frame, options, coloring, scene, threads, ground);
  const int fine = canvas.width / options.width;
  const bool links = options.show_links || coloring.of_lines || coloring.cracks;
  const bool spheres = options.show_spheres && !frame.radius.empty();
  const bool through = options.xray && spheres;
  if (spheres) {
    const double beside_links =
        coloring.of_lines ? sphere_share_beside_colours : sphere_share_beside_links;
    place_spheres(canvas, frame, links && !through ? beside_links : 1.0, scene, threads);
  }
  const float relief = relief_of(frame, scene.camera.resolution);
  if (through) return see_through(canvas, frame, coloring, scene, relief, threads, ground);
  if (links) draw_lines(canvas, frame, coloring, scene, threads);
  draw_triangles(canvas, frame, coloring.triangles, scene, threads);
  Image image;
  if (fine > 1) {
    image = shade_reduced(canvas, scene.looks, scene.clip, relief, fine, threads, ground);
  } else {
    image = shade(canvas, scene.looks, scene.clip, relief, threads, ground);
    smooth_outlines(image, canvas, scene.looks, threads);
  }
  if (!coloring.bars.empty() && spheres) draw_bars(image, canvas, coloring, scene, relief, threads);
  return image;
}

std::int64_t covered(const Canvas& canvas) {
  return std::count_if(canvas.item.begin(), canvas.item.end(),
                       [](std::int32_t item) { return item != Canvas::none; });
}

/// Whether the point of a frame is on the surface that shows: a sphere may stand half a radius
/// behind what its neighbours show, a corner of a solid a few pixels.
bool is_seen(const Canvas& canvas, const Frame& frame, const Scene& scene, std::size_t point) {
  const ScreenPoint p = scene.point(point);
  if (scene.clip && scene.clip->beyond(p.u, p.v, p.depth) > 0.0) return false;
  if (frame.radius.empty() && frame.tetrahedra.empty()) return true;
  if (!(p.u >= 0.0 && p.v >= 0.0 && p.u < canvas.width && p.v < canvas.height)) return false;
  const std::size_t at = canvas.row(static_cast<int>(p.v)) + static_cast<std::size_t>(p.u);
  if (frame.radius.empty()) return p.depth + 3.0 >= canvas.depth[at];
  const double radius = scene.camera.resolution * frame.radius[point];
  return frame.radius[point] > 0.0 && p.depth + 1.6 * radius >= canvas.depth[at];
}

/// A picture on a ground of white or black.
Image render_on(const Frame& frame, const RenderOptions& options, int threads,
                std::uint8_t ground) {
  const Layout layout(frame, options);
  const Coloring& coloring = layout.coloring;
  const int fine = fineness(frame, options);
  const Camera camera = layout.camera(options);
  Scene scene{camera, std::nullopt, &frame.position, {}, {}};
  scene.camera.u *= fine;
  scene.camera.v *= fine;
  scene.camera.resolution *= fine;
  if (const std::optional<Clip> clip = clip_of(options.clip, layout.axes))
    scene.clip = on_screen(*clip, scene.camera);
  if (!frame.radius.empty()) {
    scene.looks.reserve(frame.position.size() + frame.lines.size() / 2 +
                        frame.triangles.size() / 3);
    for (const Color& color : coloring.points) scene.looks.push_back({color, {}});
  }

  Canvas canvas(fine * options.width, fine * options.height);
  Image image = draw_items(canvas, frame, options, coloring, scene, threads, ground);
  image.model_pixels = covered(canvas) / (fine * fine);
  const int scale = text_scale(options);
  ImagePaper paper(image);
  if (options.walls && !frame.walls.empty()) {
    draw_walls(image, frame.walls, canvas, scene, layout.extent, fine, scale);
    draw_wall_edges(paper, frame.walls, camera, layout.extent, scale);
  }
  layout.overlay.draw(paper,
                      {camera, [&](std::size_t i) { return is_seen(canvas, frame, scene, i); },
                       [&](std::size_t i) { return scene.solids_seen[i]; },
                       [&](const Vec3& place) {
                         const ScreenPoint p = scene.camera.project(place);
                         return !scene.clip || scene.clip->beyond(p.u, p.v, p.depth) <= 0.0;
                       }},
                      scale);
  if (options.bare) return image;
  draw_title(paper, options.title, frame, scale);
  draw_legend(paper, coloring.legend, scale);
  draw_scale_bar(paper, camera.resolution, scale);
  draw_axes(paper, layout.axes, scale);
  return image;
}

}  // namespace

void check_frame(const Frame& frame, const RenderOptions& options) {
  if (!is_side(options.width) || (options.height != 0 && !is_side(options.height))) {
    const std::string by = options.height != 0 ? " x " + std::to_string(options.height) : "";
    throw InputError("a picture of " + std::to_string(options.width) + by + " pixels; " +
                     std::to_string(least_side) + " to " + std::to_string(largest_side) +
                     " are possible");
  }
  const auto count = static_cast<std::int64_t>(frame.position.size());
  const auto known = [count](std::int32_t point) { return point >= 0 && point < count; };
  const bool good = frame.lines.size() % 2 == 0 && frame.triangles.size() % 3 == 0 &&
                    (frame.radius.empty() || frame.radius.size() == frame.position.size()) &&
                    std::all_of(frame.lines.begin(), frame.lines.end(), known) &&
                    std::all_of(frame.triangles.begin(), frame.triangles.end(), known) &&
                    frame.tetrahedra.size() % 4 == 0 &&
                    std::all_of(frame.tetrahedra.begin(), frame.tetrahedra.end(), known);
  if (!good)
    throw InputError("a frame whose lines, triangles, tetrahedra or radii do not fit its points");
}

Image render(const Frame& frame, const RenderOptions& options, int threads) {
  check_frame(frame, options);
  if (options.scale != 1.0 && shows_contacts(frame, options))
    throw InputError("forces of contacts are drawn where they act: scale must be 1 with them");
  if (options.scale != 1.0 || !options.hidden.empty() || options.height == 0) {
    const AsDrawn drawn(frame, options);
    return render(drawn.frame(), drawn.options, threads);
  }
  Image image = render_on(frame, options, threads, white_byte);
  if (options.transparent)
    image = without_ground(image, render_on(frame, options, threads, black_byte));
  return image;
}

}  // namespace breccia
