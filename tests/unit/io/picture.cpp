#include "io/picture/picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "unit/io/slab_scene.hpp"

namespace breccia {
namespace picture_test {

using Pixel = std::array<int, 3>;

Pixel pixel(const Image& image, int x, int y) {
  const auto place = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x));
  return {image.rgb[place], image.rgb[place + 1], image.rgb[place + 2]};
}

/// The part of a picture that holds pixels of a kind.
struct Patch {
  double pixels = 0.0;  ///< number of them
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;

  void add(int x, int y) {
    pixels += 1.0;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  double centre_x() const { return 0.5 * (left + right + 1); }
  double centre_y() const { return 0.5 * (top + bottom + 1); }
};

Patch patch_of(const Image& image, const std::function<bool(const Pixel&)>& belongs) {
  Patch patch;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (belongs(pixel(image, x, y))) patch.add(x, y);
    }
  }
  return patch;
}

bool is_blue(const Pixel& p) {
  return p[2] > p[0] + 30 && p[2] > p[1] + 15;
}
bool is_concrete(const Pixel& p) {
  return p[0] < 250 && p[0] > 70 && p[0] >= p[2] + 5 && std::abs(p[0] - p[1]) < 25;
}
bool is_red(const Pixel& p) {
  return p[0] > p[1] + 40 && p[0] > p[2] + 40;
}
/// Spheres of no field, far from annotations; group 1 is blue beside a larger group 0.
Frame spheres(const std::vector<Vec3>& centres, double radius) {
  Frame frame;
  frame.position = centres;
  frame.radius.assign(centres.size(), radius);
  return frame;
}

/// A picture of the cube from -1 to 1 m without a legend.
RenderOptions cube_options() {
  RenderOptions options;
  options.field = "";
  options.view = "y";
  options.extent = Extent{{-1, -1, -1}, {1, 1, 1}};
  options.width = 800;
  options.height = 800;
  return options;
}

/// Where a frame without fields shows: what differs from the picture of nothing.
Patch scene_patch(const Frame& frame, const RenderOptions& options) {
  const Image image = render(frame, options), nothing = render(Frame{}, options);
  Patch patch;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Pixel with = pixel(image, x, y), without = pixel(nothing, x, y);
      const int change = std::abs(with[0] - without[0]) + std::abs(with[1] - without[1]) +
                         std::abs(with[2] - without[2]);
      if (change > 30) patch.add(x, y);
    }
  }
  return patch;
}

double pixels_per_metre(const RenderOptions& options) {
  const Patch patch = scene_patch(spheres({{-0.5, 0, 0}, {0.5, 0, 0}}, 0.02), options);
  return (patch.right + 1 - patch.left) / 1.04;
}

TEST(picture, a_sphere_of_radius_r_covers_pi_r_squared_pixels) {
  const RenderOptions options = cube_options();
  const double resolution = pixels_per_metre(options);
  for (const double radius : {0.2, 0.5, 0.9}) {
    const Patch patch = scene_patch(spheres({{0.05, 0.3, 0.02}}, radius), options);
    const double area = pi * radius * radius * resolution * resolution;
    EXPECT_NEAR(patch.pixels, area, 0.02 * area) << radius;
  }
}

TEST(picture, the_nearer_sphere_hides_the_farther_from_every_side) {
  struct Side {
    const char* view;
    Vec3 near;
  };
  for (const Side& side : {Side{"y", {0, -0.5, 0}}, Side{"x", {0.5, 0, 0}}, Side{"z", {0, 0, 0.5}},
                           Side{"iso", {0.25, -0.4, 0.29}}}) {
    Frame frame = spheres({side.near, -side.near}, 0.3);
    frame.point_fields = {{"damage", "-", 1, {1.0F, 0.0F}}};
    RenderOptions options = cube_options();
    options.view = side.view;
    options.field = "damage";
    options.extent = Extent{{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}};
    const auto centre = [](const Image& image) {
      return pixel(image, image.width * 9 / 20, image.height / 2);
    };
    EXPECT_TRUE(is_red(centre(render(frame, options)))) << side.view;
    std::swap(frame.position[0], frame.position[1]);
    EXPECT_FALSE(is_red(centre(render(frame, options)))) << side.view;
  }
}

TEST(picture, up_is_up_and_right_is_right_in_every_view) {
  struct Place {
    const char* view;
    Vec3 right, up;
  };
  for (const Place& place :
       {Place{"x", {0, 1, 0}, {0, 0, 1}}, Place{"y", {1, 0, 0}, {0, 0, 1}},
        Place{"z", {1, 0, 0}, {0, 1, 0}}, Place{"iso", {0.5, 0.2, 0}, {0, 0, 1}}}) {
    RenderOptions options = cube_options();
    options.view = place.view;
    const auto seen = [&](const Vec3& centre) {
      return scene_patch(spheres({centre}, 0.1), options);
    };
    const Patch middle = seen({0, 0, 0});
    EXPECT_GT(seen(0.8 * place.right).centre_x(), middle.centre_x() + 50) << place.view;
    EXPECT_LT(seen(0.8 * place.up).centre_y(), middle.centre_y() - 50) << place.view;
  }
}

TEST(picture, a_clip_plane_drops_the_right_half) {
  RenderOptions options = cube_options();
  const Frame frame = spheres({{0, 0, 0}}, 0.6);
  const Patch whole = scene_patch(frame, options);
  options.clip = "x=0";
  const Patch left = scene_patch(frame, options);
  EXPECT_NEAR(left.pixels, 0.5 * whole.pixels, 0.01 * whole.pixels);
  EXPECT_EQ(left.left, whole.left);
  EXPECT_NEAR(left.right, whole.centre_x(), 1.5);
  options.clip = "x>0";
  EXPECT_NEAR(scene_patch(frame, options).left, whole.centre_x(), 1.5);
}

TEST(picture, a_clip_towards_the_viewer_shows_the_face_of_the_cut) {
  RenderOptions options = cube_options();
  const double resolution = pixels_per_metre(options);
  options.clip = "y=0.36";  // what lies before it goes; the circle left has a radius of 0.48
  const Frame frame = spheres({{0, 0, 0}}, 0.6);
  const Patch cut = scene_patch(frame, options);
  EXPECT_NEAR(cut.pixels, pi * 0.48 * 0.48 * resolution * resolution,
              0.03 * 0.73 * resolution * resolution);
  options.clip = "y=0.7";
  EXPECT_EQ(scene_patch(frame, options).pixels, 0.0);
  options.clip = "y=-0.7";
  EXPECT_GT(scene_patch(frame, options).pixels, cut.pixels);
}

TEST(picture, links_and_triangles_are_drawn_and_clipped) {
  Frame frame;
  frame.position = {{-0.8, 0, 0}, {0.8, 0, 0}, {0, 0, 0.8}};
  frame.lines = {0, 1};
  frame.line_fields = {{"force", "N", 1, {5.0F}}};
  RenderOptions options = cube_options();
  options.show_links = true;
  const auto is_ink = [](const Pixel& p) { return p[0] < 200; };
  const auto ink_in_middle = [&](const Image& image) {
    double count = 0;
    for (int y = 300; y < 500; ++y) {
      for (int x = 0; x < 800; ++x) count += is_ink(pixel(image, x, y)) ? 1.0 : 0.0;
    }
    return count;
  };
  const double line = ink_in_middle(render(frame, options));
  EXPECT_GT(line, 400.0);
  options.clip = "x=0";
  EXPECT_NEAR(ink_in_middle(render(frame, options)), 0.5 * line, 0.02 * line);
  options.clip = "";
  options.show_links = false;
  EXPECT_EQ(ink_in_middle(render(frame, options)), 0.0);
  frame.triangles = {0, 1, 2};
  frame.triangle_fields = {{"stress", "Pa", 1, {2.5e6F}}};
  options.field = "stress";
  options.range = ValueRange{0.0, 2.5e6};
  const auto is_yellow = [](const Pixel& p) { return p[0] > 150 && p[1] > 140 && p[2] < 90; };
  const Patch triangle = patch_of(render(frame, options), is_yellow);
  EXPECT_GT(triangle.pixels, 0.45 * (triangle.bottom - triangle.top) * 500.0);
}

TEST(picture, a_mesh_of_triangles_has_no_holes) {
  Frame frame;
  constexpr int cells = 60;
  for (int n = 0; n < (cells + 1) * (cells + 1); ++n) {
    const double x = 2.0 * (n % (cells + 1)) / cells - 1.0;
    const double y = 2.0 * (n / (cells + 1)) / cells - 1.0;
    frame.position.push_back(
        {0.04 * x * std::sqrt(1.0 - 0.5 * y * y), 0.04 * y * std::sqrt(1.0 - 0.5 * x * x), 0.0});
  }
  for (int n = 0; n < cells * cells; ++n) {
    const int corner = n / cells * (cells + 1) + n % cells, above = corner + cells + 1;
    frame.triangles.insert(frame.triangles.end(),
                           {corner, corner + 1, above + 1, corner, above + 1, above});
  }
  RenderOptions options;
  options.field = "";
  for (int width = 1200; width < 1290; width += 10) {
    options.width = width;
    const Image image = render(frame, options);
    const auto is_white = [&image](int x, int y) { return pixel(image, x, y)[2] > 250; };
    for (int y = 80; y < 880; ++y) {
      for (int x = width / 2 - 250; x < width / 2 + 250; ++x) {
        ASSERT_FALSE(is_white(x, y) && !is_white(x - 1, y) && !is_white(x + 1, y))
            << x << " " << y << " at width " << width;
      }
    }
  }
}

TEST(picture, a_broken_link_is_drawn_only_where_the_state_is_shown) {
  Frame frame;
  frame.position = {{-0.8, 0, 0}, {0.8, 0, 0}};
  frame.lines = {0, 1};
  frame.line_fields = {{"state", "-", 1, {0.0F}}};
  RenderOptions options = cube_options();
  options.show_links = true;
  EXPECT_GT(scene_patch(frame, options).pixels, 400.0);
  frame.line_fields[0].values[0] = 2.0F;
  EXPECT_EQ(scene_patch(frame, options).pixels, 0.0);
  options.field = "state";
  const Image image = render(frame, options);
  const Image without = [&] {
    Frame apart = frame;
    apart.position = {{-0.8, 0, 7}, {0.8, 0, 7}};
    return render(apart, options);
  }();
  EXPECT_NE(image.rgb, without.rgb);
}

TEST(picture, a_field_brings_a_legend_with_its_range_and_no_field_none) {
  Frame frame = spheres({{-0.4, 0, 0}, {0.4, 0, 0}}, 0.3);
  frame.point_fields = {{"velocity", "m/s", 3, {0, 0, 0, 3, 4, 0}}};
  RenderOptions options = cube_options();
  const auto colours_at_right = [](const Image& image) {
    double coloured = 0;
    for (int y = 0; y < image.height * 3 / 4; ++y) {
      for (int x = image.width * 8 / 10; x < image.width; ++x) {
        const Pixel p = pixel(image, x, y);
        coloured +=
            *std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end()) > 60
                ? 1.0
                : 0.0;
      }
    }
    return coloured;
  };
  EXPECT_EQ(colours_at_right(render(frame, options)), 0.0);
  options.field = "velocity";
  const Image automatic = render(frame, options);
  EXPECT_GT(colours_at_right(automatic), 2000.0);
  options.range = ValueRange{0.0, 5.0};  // the length of (3, 4, 0) is the end of the range
  EXPECT_EQ(automatic.rgb, render(frame, options).rgb);
  options.range = ValueRange{0.0, 50.0};
  EXPECT_NE(automatic.rgb, render(frame, options).rgb);
}

TEST(picture, a_component_of_a_vector_can_be_chosen) {
  Frame frame = spheres({{-0.4, 0, 0}, {0.4, 0, 0}}, 0.3);
  frame.point_fields = {{"velocity", "m/s", 3, {9, 9, -1, 9, 9, 1}}};
  RenderOptions options = cube_options();
  options.field = "velocity_z";
  const Image image = render(frame, options);
  const Patch blue = patch_of(image, is_blue), red = patch_of(image, is_red);
  EXPECT_GT(blue.pixels, 5000.0);
  EXPECT_GT(red.pixels, 5000.0);
  EXPECT_LT(blue.left, red.left);
  EXPECT_TRUE(has_field(frame, "velocity_x"));
  EXPECT_FALSE(has_field(frame, "velocity_w"));
  EXPECT_FALSE(has_field(frame, "stress"));
  EXPECT_TRUE(has_field(frame, ""));
}

TEST(picture, damage_reddens_concrete_and_steel_stays_blue) {
  Frame frame = spheres({{-0.7, 0, 0}, {-0.2, 0, 0}, {0.3, 0, 0}}, 0.2);
  frame.point_fields = {{"group", "-", 1, {0, 0, 1}}, {"damage", "-", 1, {0.0F, 0.9F, 0.0F}}};
  RenderOptions options = cube_options();
  options.field = "damage";
  const Image image = render(frame, options);
  const auto row = [&image](int x) { return pixel(image, x, image.height / 2); };
  int concrete = 0, red = 0, blue = 0;
  for (int x = 0; x < image.width * 3 / 4; ++x) {
    concrete += is_concrete(row(x)) ? 1 : 0;
    red += is_red(row(x)) ? 1 : 0;
    blue += is_blue(row(x)) ? 1 : 0;
  }
  EXPECT_GT(concrete, 60);
  EXPECT_GT(red, 60);
  EXPECT_GT(blue, 60);
}

TEST(picture, bars_show_through_concrete_the_more_it_is_damaged) {
  // Seen from the front: a bar behind a whole sphere, another behind a damaged one.
  Frame frame = spheres({{-0.5, -0.5, 0}, {0.3, -0.5, 0}, {-0.5, 0.2, 0}, {0.3, 0.2, 0}}, 0.2);
  frame.radius[2] = frame.radius[3] = 0.1;
  frame.point_fields = {{"group", "-", 1, {0, 0, 1, 1}},
                        {"damage", "-", 1, {0.0F, 1.0F, 0.9F, 0.9F}}};
  RenderOptions options = cube_options();
  options.field = "damage";
  options.view = "y";
  const Image hidden = render(frame, options);
  frame.point_fields.push_back({"bar", "-", 1, {0, 0, 1, 1}});
  const Image shown = render(frame, options);
  // How much bluer each half of the picture became.
  double bluer[2] = {};
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      const Pixel before = pixel(hidden, x, y), now = pixel(shown, x, y);
      bluer[x < shown.width * 2 / 5 ? 0 : 1] +=
          std::max(0, (now[2] - now[0]) - (before[2] - before[0]));
    }
  EXPECT_GT(bluer[0], 1000.0);
  EXPECT_GT(bluer[1], 2.0 * bluer[0]);
  EXPECT_EQ(shown.rgb, render(frame, options, 3).rgb);
}

TEST(picture, a_few_fragments_that_flew_far_do_not_shrink_the_rest) {
  Frame frame = test::slab_scene();
  const Extent extent = bulk_extent(frame);
  EXPECT_GT(extent.low.x, -0.55);
  EXPECT_LT(extent.high.x, 0.55);
  EXPECT_GT(extent.high.z, 0.30);  // the ball belongs to the scene
  EXPECT_LT(extent.high.z, 0.50);
}

/// A heap of many triangles in the lower left of a room with four walls of two triangles each; one
/// triangle of the heap has flown off.
Frame heap_in_a_room() {
  Frame frame;
  FrameField group{"group", "-", 1, {}};
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, float body) {
    for (const Vec3& corner : {a, b, c}) {
      frame.triangles.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back(corner);
    }
    group.values.push_back(body);
  };
  for (int i = 0; i < 2500; ++i) {
    const double x = -290.0 + 6.0 * (i % 50), y = -290.0 + 6.0 * (i / 50);
    add({x, y, 0}, {x + 4, y, 0}, {x, y + 4, 0}, 0.0F);
  }
  add({9e4, 9e4, 0}, {9e4 + 4, 9e4, 0}, {9e4, 9e4 + 4, 0}, 0.0F);
  const auto wall = [&](double left, double low, double right, double high, float body) {
    add({left, low, 0}, {right, low, 0}, {right, high, 0}, body);
    add({left, low, 0}, {right, high, 0}, {left, high, 0}, body);
  };
  wall(-310, -310, 310, -300, 1.0F);
  wall(-310, 300, 310, 310, 2.0F);
  wall(-310, -300, -300, 300, 3.0F);
  wall(300, -300, 310, 300, 4.0F);
  frame.triangle_fields = {group};
  return frame;
}

TEST(picture, every_body_is_shown_however_small_and_far_from_the_largest) {
  Frame frame = heap_in_a_room();
  for (const char* items : {"triangles", "points"}) {
    const Extent extent = bulk_extent(frame);
    EXPECT_EQ(extent.low.x, -310) << items;
    EXPECT_EQ(extent.low.y, -310) << items;
    EXPECT_EQ(extent.high.x, 310) << items;
    EXPECT_EQ(extent.high.y, 310) << items;
    FrameField of_points{"group", "-", 1, {}};
    if (frame.triangle_fields.empty()) break;
    for (const float body : frame.triangle_fields.front().values)
      of_points.values.insert(of_points.values.end(), 3, body);
    frame.triangle_fields.clear();
    frame.point_fields = {of_points};
  }
}

TEST(picture, texts_over_elements_stand_on_light_ground) {
  Frame frame;
  frame.position = {{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}};
  frame.triangles = {0, 1, 2, 0, 2, 3, 0, 0, 0, 0, 0, 0};
  frame.triangle_fields = {{"rank", "-", 1, {2.0F, 2.0F, 0.0F, 1.0F}}};  // the third is dark
  RenderOptions options = cube_options();
  options.field = "rank";
  options.title = "A title over elements";
  const Image image = render(frame, options);
  const Pixel dark = pixel(image, 400, 400);
  ASSERT_LT(dark[0], 120);
  struct Place {
    const char* what;
    int left, top, right, bottom;  ///< pixels
  };
  for (const Place& place : {Place{"title", 14, 14, 120, 20}, Place{"legend", 765, 114, 790, 124},
                             Place{"scale bar", 10, 775, 100, 789}}) {
    double light = 0.0, most = 0.0, least = 255.0;
    for (int y = place.top; y < place.bottom; ++y)
      for (int x = place.left; x < place.right; ++x) {
        const int red = pixel(image, x, y)[0];
        light += red > 200 ? 1.0 : 0.0;
        most = std::max(most, 1.0 * red);
        least = std::min(least, 1.0 * red);
      }
    const double area = (place.right - place.left) * (place.bottom - place.top);
    EXPECT_GT(light, 0.5 * area) << place.what << " " << most;
    EXPECT_LT(least, 100.0) << place.what;  // ink
  }
}

TEST(picture, a_long_title_is_cut_so_that_the_time_stands_in_the_picture) {
  Frame frame = spheres({{0, 0, 0}}, 0.1);
  RenderOptions options = cube_options();
  options.width = 300;
  options.title = "Rock impact on a reinforced concrete slab, \u00bc of it, and some words more";
  const auto first_line = [&](double time) {
    frame.time = time;
    Image image = render(frame, options);
    image.height = 24;
    return patch_of(image, [](const Pixel& p) { return p[0] < 120; });
  };
  const Patch at_start = first_line(0.0), later = first_line(1.5e-3);
  EXPECT_NE(at_start.pixels, later.pixels);
  EXPECT_LT(std::max(at_start.right, later.right), 300 - 11);
  EXPECT_GT(std::min(at_start.right, later.right), 300 - 40);
}

TEST(picture, the_extent_of_the_first_frame_keeps_the_camera_of_a_series) {
  RenderOptions options = cube_options();
  options.extent = bulk_extent(spheres({{-0.5, 0, 0}, {0.5, 0, 0}}, 0.1));
  const Patch before = scene_patch(spheres({{-0.5, 0, 0}, {0.5, 0, 0}}, 0.1), options);
  const Patch after = scene_patch(spheres({{-0.5, 0, 0}, {9.0, 3.0, 5.0}}, 0.1), options);
  EXPECT_EQ(before.left, after.left);
  EXPECT_EQ(before.top, after.top);
}

TEST(picture, the_same_frame_gives_the_same_bits_on_any_number_of_threads) {
  Frame frame = test::slab_scene();
  RenderOptions options;
  options.clip = "x=0.1";
  options.show_links = true;
  const auto expect_the_same = [&] {
    const auto expected = render(frame, options).rgb;
    for (const int threads : {2, 5})
      EXPECT_EQ(render(frame, options, threads).rgb, expected) << threads;
  };
  expect_the_same();
  // Large triangles that lie across each other, among lines.
  frame.radius.clear();
  for (std::int32_t i = 0; i + 2000 < 12000; i += 23)
    frame.triangles.insert(frame.triangles.end(), {i, i + 900, i + 2000});
  expect_the_same();
}

TEST(picture, frames_with_nothing_or_nonsense_in_them_are_drawn) {
  RenderOptions options;
  options.field = "";
  EXPECT_EQ(render(Frame{}, options).rgb.size(), 3U * 1280U * 960U);
  Frame frame = spheres({{0, 0, 0}, {NAN, 0, 0}, {1e300, 0, 0}, {1, 1, 1}}, 0.1);
  frame.point_fields = {{"damage", "-", 1, {0.5F, NAN, INFINITY, 0.0F}}};
  options.field = "damage";
  EXPECT_EQ(render(frame, options).rgb.size(), 3U * 1280U * 960U);
  options.width = 64;
  options.height = 64;
  EXPECT_EQ(render(frame, options).rgb.size(), 3U * 64U * 64U);
}

TEST(picture, options_that_make_no_sense_are_named) {
  const auto message = [](RenderOptions options) -> std::string {
    Frame frame = spheres({{0, 0, 0}}, 0.1);
    frame.point_fields = {{"damage", "-", 1, {0.5F}}, {"velocity", "m/s", 3, {1, 2, 3}}};
    try {
      render(frame, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({}), "");
  EXPECT_NE(message({.field = "damge"}).find("damage, velocity"), std::string::npos);
  EXPECT_NE(message({.view = "top"}).find("iso, x, y, z"), std::string::npos);
  EXPECT_NE(message({.clip = "x:0"}).find("\"x=0\""), std::string::npos);
  EXPECT_NE(message({.clip = "w=0"}).find("\"w=0\""), std::string::npos);
  EXPECT_NE(message({.width = 0}).find("0 x 960"), std::string::npos);
}

}  // namespace picture_test
}  // namespace breccia
