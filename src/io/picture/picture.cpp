#include "io/picture/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"
#include "exec/tasks.hpp"
#include "io/picture/annotation.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/hidden.hpp"
#include "io/picture/shading.hpp"

namespace breccia {
namespace {

constexpr double sphere_share_beside_links = 0.4;    ///< of the radius, so that links show
constexpr double sphere_share_beside_colours = 0.2;  ///< of the radius, where links carry the field

/// The items to draw, in the order of their numbers: spheres, then lines, then triangles.
struct Scene {
  Camera camera;
  std::optional<ScreenClip> clip;
  std::vector<ScreenPoint> points;
  std::vector<ItemLook> looks;
};

/// A flat frame has nothing to show from the side: there the slanted view looks from above.
Axes axes_for(const Extent& extent, const RenderOptions& options) {
  const bool flat = extent.low.z == extent.high.z;
  return axes_of_view(flat && options.view == "iso" ? "z" : options.view);
}

/// Spheres come first, so that their place in the list is their item.
void place_spheres(Canvas& canvas, const Frame& frame, double share, Scene& scene, int threads) {
  constexpr double smallest = 0.75;  // pixels: nothing that flies about is lost
  std::vector<ScreenSphere> spheres(frame.position.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const ScreenPoint& point = scene.points[i];
    const double radius = std::max(smallest, share * scene.camera.resolution * frame.radius[i]);
    spheres[i] = {static_cast<float>(point.u), static_cast<float>(point.v),
                  static_cast<float>(point.depth), static_cast<float>(radius)};
    scene.looks[i].sphere = spheres[i];
  }
  draw_spheres(canvas, spheres, scene.clip, threads);
}

/// Reinforcement that others hide, drawn over them as if they were veils.
void draw_bars(Image& image, const Canvas& canvas, const Coloring& coloring, const Scene& scene,
               float relief, int threads) {
  std::vector<ScreenSphere> bars(coloring.bars.size());
  for (std::size_t i = 0; i < bars.size(); ++i)
    if (coloring.bars[i]) bars[i] = scene.looks[i].sphere;
  Canvas behind(image.width, image.height);
  draw_spheres(behind, bars, scene.clip, threads);
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
      const std::size_t pixel =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(x));
      for (std::size_t c = pixel; c < pixel + 3; ++c) {
        const float here = image.rgb[c], there = own.rgb[c];
        image.rgb[c] = static_cast<std::uint8_t>(here + veil * (there - here) + 0.5F);
      }
    }
}

/// work(i) for every i in [0, count), a few thousand by one thread at a time.
template <class Work>
void for_chunks(int threads, std::size_t count, const Work& work) {
  constexpr std::size_t chunk = 4096;
  for_each_task(threads, static_cast<int>((count + chunk - 1) / chunk), [&](int number) {
    const std::size_t begin = chunk * static_cast<std::size_t>(number);
    for (std::size_t i = begin; i < std::min(count, begin + chunk); ++i) work(i);
  });
}

/// Flat items by the bands of rows that they may cover, and each band drawn by one thread, its
/// items in their order.
class Bands {
 public:
  Bands(const Canvas& canvas, int threads)
      : height_(canvas.height),
        threads_(threads),
        items_(static_cast<std::size_t>(threads > 1 ? (canvas.height + band - 1) / band : 1)) {}

  /// Notes an item between two heights of the picture, give or take `reach`.  [pixels]
  void add(std::size_t item, double top, double bottom, double reach) {
    if (!(bottom + reach >= 0.0 && top - reach <= height_)) return;
    const auto band_of = [this](double v) {
      const double row = std::clamp(v, 0.0, height_ - 1.0);
      return items_.size() == 1 ? 0 : static_cast<std::size_t>(row) / band;
    };
    for (std::size_t b = band_of(top - reach); b <= band_of(bottom + reach); ++b)
      items_[b].push_back(item);
  }
  /// draw(item, rows) for all
  template <class Draw>
  void draw(const Draw& draw_item) const {
    for_each_task(threads_, static_cast<int>(items_.size()), [&](int b) {
      Rows rows{0, height_ - 1};
      if (items_.size() > 1) rows = {b * band, std::min(height_, (b + 1) * band) - 1};
      for (const std::size_t item : items_[static_cast<std::size_t>(b)]) draw_item(item, rows);
    });
  }

 private:
  static constexpr int band = 32;  // pixels
  int height_, threads_;
  std::vector<std::vector<std::size_t>> items_;
};

void draw_lines(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                int threads) {
  const std::vector<Color>& colors = coloring.lines;
  const int thickness =
      std::max(coloring.cracks ? 3 : 2, canvas.height / (coloring.cracks ? 360 : 480));
  const double lift = frame.triangles.empty() ? 0.0 : 2.0;  // lines on the edges of triangles show
  const Vec3 lamp = lamp_direction();
  const std::size_t first = scene.looks.size();
  Bands bands(canvas, threads);
  const auto ends = [&](std::size_t line) {
    ScreenPoint a = scene.points[static_cast<std::size_t>(frame.lines[2 * line])];
    ScreenPoint b = scene.points[static_cast<std::size_t>(frame.lines[2 * line + 1])];
    a.depth += lift;
    b.depth += lift;
    return std::pair{a, b};
  };
  for (std::size_t line = 0; line < colors.size(); ++line) {
    scene.looks.push_back({});
    if (!coloring.hidden_lines.empty() && coloring.hidden_lines[line]) continue;
    const auto [a, b] = ends(line);
    // A thin cylinder is as bright as its steepest side towards the lamp.
    const Vec3 axis{b.u - a.u, a.v - b.v, b.depth - a.depth};
    const double along = dot(axis, lamp), square = dot(axis, axis);
    const double across = square > 0.0 ? std::max(0.0, 1.0 - along * along / square) : 1.0;
    const auto light = static_cast<float>(0.55 + 0.45 * std::sqrt(across));
    scene.looks.back().color = shaded(colors[line], light);
    bands.add(line, std::min(a.v, b.v), std::max(a.v, b.v), thickness + 1.0);
  }
  bands.draw([&](std::size_t line, Rows rows) {
    const auto [a, b] = ends(line);
    const auto item = static_cast<std::int32_t>(first + line);
    draw_line(canvas, rows, a, b, thickness, item, scene.clip);
  });
}

void draw_triangles(Canvas& canvas, const Frame& frame, const std::vector<Color>& colors,
                    Scene& scene, int threads) {
  const Vec3 lamp = lamp_direction();
  const std::size_t first = scene.looks.size();
  Bands bands(canvas, threads);
  const auto corners = [&](std::size_t triangle) {
    const auto corner = [&](std::size_t k) {
      return scene.points[static_cast<std::size_t>(frame.triangles[3 * triangle + k])];
    };
    return std::array{corner(0), corner(1), corner(2)};
  };
  scene.looks.resize(first + colors.size());
  for_chunks(threads, colors.size(), [&](std::size_t triangle) {
    const auto [a, b, c] = corners(triangle);
    const Vec3 normal = cross(Vec3{b.u - a.u, a.v - b.v, b.depth - a.depth},
                              Vec3{c.u - a.u, a.v - c.v, c.depth - a.depth});
    const double size = norm(normal);
    const double facing = size > 0.0 ? std::fabs(dot(normal, lamp)) / size / lamp.z : 1.0;
    const auto light = static_cast<float>(0.5 + 0.5 * std::min(1.0, facing));
    scene.looks[first + triangle].color = shaded(colors[triangle], light);
  });
  for (std::size_t triangle = 0; triangle < colors.size(); ++triangle) {
    const auto [a, b, c] = corners(triangle);
    bands.add(triangle, std::min({a.v, b.v, c.v}), std::max({a.v, b.v, c.v}), 1.0);
  }
  bands.draw([&](std::size_t triangle, Rows rows) {
    const auto [a, b, c] = corners(triangle);
    const auto item = static_cast<std::int32_t>(first + triangle);
    draw_triangle(canvas, rows, a, b, c, item, scene.clip);
  });
}

/// Depth that looks deep: about a radius of the usual sphere.  [pixels]
float relief_of(const Frame& frame, double resolution) {
  if (frame.radius.empty()) return 10.0F;
  std::vector<double> radius = frame.radius;
  const auto middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
  std::nth_element(radius.begin(), middle, radius.end());
  return static_cast<float>(std::clamp(1.5 * resolution * *middle, 2.0, 1e4));
}

/// Pixels that are drawn side by side for one of the picture: edges of triangles and cracks come
/// out smooth, and gaps between triangles narrower than a pixel leave no holes. Spheres have
/// outlines of their own.
int fineness(const Frame& frame, const RenderOptions& options) {
  if (frame.triangles.empty()) return 1;
  const double pixels = 1.0 * options.width * options.height;
  return pixels <= 4e6 ? 3 : pixels <= 16e6 ? 2 : 1;
}

/// The mean of each block of `fine` times `fine` pixels.
Image reduced(const Image& large, int fine, int threads) {
  Image image{large.width / fine, large.height / fine, {}};
  const auto width = static_cast<std::size_t>(image.width), step = static_cast<std::size_t>(fine);
  image.rgb.resize(3 * width * static_cast<std::size_t>(image.height));
  const unsigned block = static_cast<unsigned>(fine * fine);
  for_each_task(threads, image.height, [&](int y) {
    const std::size_t row = 3 * step * width;  // bytes of a row of the large image
    const std::uint8_t* const from = &large.rgb[static_cast<std::size_t>(y) * step * row];
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        unsigned sum = block / 2;
        for (std::size_t k = 0; k < step * step; ++k)
          sum += from[k / step * row + 3 * (step * x + k % step) + c];
        image.rgb[3 * (static_cast<std::size_t>(y) * width + x) + c] =
            static_cast<std::uint8_t>(sum / block);
      }
  });
  return image;
}

}  // namespace

void check_frame(const Frame& frame, const RenderOptions& options) {
  if (options.width < 16 || options.height < 16 || options.width > 16384 ||
      options.height > 16384) {
    throw InputError("a picture of " + std::to_string(options.width) + " x " +
                     std::to_string(options.height) + " pixels; 16 to 16384 are possible");
  }
  const auto count = static_cast<std::int64_t>(frame.position.size());
  const auto known = [count](std::int32_t point) { return point >= 0 && point < count; };
  const bool good = frame.lines.size() % 2 == 0 && frame.triangles.size() % 3 == 0 &&
                    (frame.radius.empty() || frame.radius.size() == frame.position.size()) &&
                    std::all_of(frame.lines.begin(), frame.lines.end(), known) &&
                    std::all_of(frame.triangles.begin(), frame.triangles.end(), known);
  if (!good) throw InputError("a frame whose lines, triangles or radii do not fit its points");
}

Image render(const Frame& frame, const RenderOptions& options, int threads) {
  check_frame(frame, options);
  if (!options.hidden.empty()) {
    RenderOptions of_rest = options;
    of_rest.hidden.clear();
    if (!of_rest.extent) of_rest.extent = bulk_extent(frame);
    return render(without_groups(frame, options.hidden), of_rest, threads);
  }
  Coloring coloring = color_frame(frame, options.field, options.range, options.map);
  if (options.show_links && coloring.cracks) coloring.hidden_lines.clear();
  const int fine = fineness(frame, options);
  const Extent extent = options.extent ? *options.extent : bulk_extent(frame);
  const Axes axes = axes_for(extent, options);
  Scene scene{
      fitted_camera(axes, extent, scene_window(options, coloring.legend)), std::nullopt, {}, {}};
  scene.camera.u *= fine;
  scene.camera.v *= fine;
  scene.camera.resolution *= fine;
  if (const std::optional<Clip> clip = clip_of(options.clip, axes)) {
    scene.clip = on_screen(*clip, scene.camera);
  }
  scene.points.resize(frame.position.size());
  for_chunks(threads, scene.points.size(),
             [&](std::size_t i) { scene.points[i] = scene.camera.project(frame.position[i]); });
  scene.looks.reserve(frame.position.size() + frame.lines.size() / 2 + frame.triangles.size() / 3);
  for (const Color& color : coloring.points) scene.looks.push_back({color, {}});

  Canvas canvas(fine * options.width, fine * options.height);
  const bool links = options.show_links || coloring.of_lines || coloring.cracks;
  if (options.show_spheres && !frame.radius.empty()) {
    const double beside_links =
        coloring.of_lines ? sphere_share_beside_colours : sphere_share_beside_links;
    place_spheres(canvas, frame, links ? beside_links : 1.0, scene, threads);
  }
  if (links) draw_lines(canvas, frame, coloring, scene, threads);
  draw_triangles(canvas, frame, coloring.triangles, scene, threads);

  const float relief = relief_of(frame, scene.camera.resolution);
  Image image = shade(canvas, scene.looks, scene.clip, relief, threads);
  if (fine > 1)
    image = reduced(image, fine, threads);
  else
    smooth_outlines(image, canvas, scene.looks, threads);
  if (!coloring.bars.empty() && options.show_spheres && !frame.radius.empty())
    draw_bars(image, canvas, coloring, scene, relief, threads);
  const int scale = text_scale(options);
  ImagePaper paper(image);
  draw_title(paper, options.title, frame, scale);
  draw_legend(paper, coloring.legend, scale);
  draw_scale_bar(paper, scene.camera.resolution / fine, scale);
  draw_axes(paper, axes, scale);
  return image;
}

}  // namespace breccia
