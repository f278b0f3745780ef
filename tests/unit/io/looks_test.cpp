// How pictures look beside colours: cameras that follow, walls and supports, x-rays, arrows,
// crosses of stress, displacements, transparent grounds.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "exec/error.hpp"
#include "io/picture/camera.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/picture.hpp"
#include "io/picture/vector_picture.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/vtu_reader.hpp"

namespace breccia {
namespace looks_test {

using Pixel = std::array<int, 3>;
Pixel pixel(const Image& image, int x, int y) {
  const auto at = static_cast<std::size_t>(3 * (y * image.width + x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}
bool is_red(const Pixel& p) {
  return p[0] > p[1] + 60 && p[0] > p[2] + 60;
}
bool is_blue(const Pixel& p) {
  return p[2] > p[0] + 60 && p[2] > p[1] + 30;
}
bool is_teal(const Pixel& p) {
  return p[1] > p[0] + 50 && p[2] > p[0] + 40 && p[1] < 160;
}

/// Pixels of a kind left of the legend: how many, and how far they reach.
struct Found {
  int count = 0, left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
};
template <class Is>
Found find(const Image& image, const Is& is) {
  Found found;
  for (int y = image.height / 10; y < image.height * 9 / 10; ++y)
    for (int x = 0; x < image.width * 7 / 10; ++x) {
      if (!is(pixel(image, x, y))) continue;
      ++found.count;
      found.left = std::min(found.left, x), found.right = std::max(found.right, x);
      found.top = std::min(found.top, y), found.bottom = std::max(found.bottom, y);
    }
  return found;
}

Frame spheres(const std::vector<Vec3>& centres, double radius) {
  Frame frame;
  frame.position = centres;
  frame.radius.assign(centres.size(), radius);
  return frame;
}
/// A plate of two triangles, as wide as given and 1 m high, with nodes of their own.
Frame plate(double width) {
  Frame frame;
  frame.position = {{0, 0, 0}, {width, 0, 0}, {width, 1, 0}, {0, 0, 0}, {width, 1, 0}, {0, 1, 0}};
  frame.triangles = {0, 1, 2, 3, 4, 5};
  frame.triangle_fields = {{"group", "-", 1, {0, 0}}};
  frame.groups = {"plate"};
  return frame;
}
RenderOptions plain(const std::string& view = "y") {
  RenderOptions options;
  options.field = "";
  options.view = view;
  options.width = 800, options.height = 600;
  return options;
}

TEST(looks, a_picture_without_a_height_is_as_high_as_its_model_needs) {
  RenderOptions options = plain("z");
  options.width = 1280, options.height = 0;
  const int flat = render(plate(10.0), options).height, square = render(plate(1.0), options).height;
  EXPECT_LT(flat, 400);
  EXPECT_EQ(square, 960);
  EXPECT_EQ(picture_height(plate(10.0), options), flat);
  const Found beam = find(render(plate(10.0), options), [](const Pixel& p) { return p[2] < 225; });
  EXPECT_GT(beam.width(), 800);
}

TEST(looks, what_is_transparent_shows_any_ground) {
  RenderOptions options = plain();
  const Frame ball = spheres({{0, 0, 0}}, 1.0);
  const Image opaque = render(ball, options);
  options.transparent = true;
  const Image image = render(ball, options);
  ASSERT_EQ(image.alpha.size(), 800U * 600U);
  EXPECT_EQ(image.alpha.front(), 0);
  EXPECT_EQ(image.alpha[300 * 800 + 400], 255);
  int edge = 0;
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    edge += image.alpha[i] > 20 && image.alpha[i] < 235 ? 1 : 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double white = 255.0 - image.alpha[i] + image.rgb[c] * image.alpha[i] / 255.0;
      ASSERT_NEAR(white, opaque.rgb[c], 1.5) << i;
    }
  }
  EXPECT_GT(edge, 500);  // the outline
  const std::string path =
      (std::filesystem::temp_directory_path() / ("looks" + std::to_string(::getpid()) + ".png"))
          .string();
  write_png(path, image);
  const Image read = read_png_with_alpha(path);
  EXPECT_EQ(read.rgb, image.rgb);
  EXPECT_EQ(read.alpha, image.alpha);
  EXPECT_TRUE(read_png(path).alpha.empty());
  std::filesystem::remove(path);
}

/// A ball of group 1 that eight of group 0 hide, and a link of two of these that broke.
Frame hidden_ball() {
  Frame frame = spheres({{0, 0, 0}}, 0.4);
  for (int k = 0; k < 8; ++k)
    frame.position.push_back(
        {(k & 1) != 0 ? 0.5 : -0.5, (k & 2) != 0 ? 0.5 : -0.5, (k & 4) != 0 ? 0.5 : -0.5});
  frame.radius.resize(9, 0.7);
  frame.point_fields = {{"group", "-", 1, {1, 0, 0, 0, 0, 0, 0, 0, 0}}};
  frame.groups = {"shell", "core"};
  frame.lines = {1, 2, 5, 6};
  frame.line_fields = {{"kind", "-", 1, {0, 0}}, {"state", "-", 1, {2, 0}}};
  return frame;
}

TEST(looks, an_x_ray_shows_what_lies_within_and_links_that_broke) {
  RenderOptions options = plain();
  const Image usual = render(hidden_ball(), options);
  EXPECT_LT(find(usual, is_blue).count, 20);  // through a gap
  EXPECT_EQ(find(usual, is_red).count, 0);
  options.xray = true;
  const Image image = render(hidden_ball(), options);
  EXPECT_GT(find(image, is_blue).count, 2000);
  const Found broken = find(image, is_red);
  EXPECT_GT(broken.count, 100);
  EXPECT_GT(broken.width(),
            10 * broken.height());  // one line, along x; the whole link is not drawn
  const auto faded = [](const Image& of) { return pixel(of, 300, 150)[0] + 0; };
  EXPECT_GT(faded(image), faded(usual) + 20);
}

TEST(looks, an_x_ray_of_a_plate_fades_it) {
  RenderOptions options = plain("z");
  const int usual = pixel(render(plate(1.0), options), 400, 300)[2];
  options.xray = true;
  EXPECT_GT(pixel(render(plate(1.0), options), 400, 300)[2], usual + 20);
}

TEST(looks, arrows_point_along_their_vectors_and_the_legend_says_how_long) {
  Frame frame = plate(1.0);
  FrameField velocity{"velocity", "m/s", 3, {}};
  for (int i = 0; i < 6; ++i)
    for (const float v : {0.0F, 3.0F, 0.0F}) velocity.values.push_back(v);
  frame.point_fields = {velocity};
  RenderOptions options = plain("z");
  options.arrows = "velocity";
  options.extent = Extent{{-1, -1, 0}, {2, 2, 0}};
  const auto is_ink = [](const Pixel& p) { return p[0] + p[1] + p[2] < 420; };
  const Found upwards = find(render(frame, options), is_ink);
  ASSERT_GT(upwards.count, 30);
  for (std::size_t i = 0; i < 6; ++i) frame.point_fields[0].values[3 * i + 1] = -3.0F;
  const Found downwards = find(render(frame, options), is_ink);
  EXPECT_LT(upwards.top, downwards.top - 10);
  EXPECT_LT(upwards.bottom, downwards.bottom - 10);
  for (std::size_t i = 0; i < 6; ++i)
    std::swap(frame.point_fields[0].values[3 * i], frame.point_fields[0].values[3 * i + 1]);
  const Found sideways = find(render(frame, options), is_ink);
  EXPECT_GT(upwards.height() - sideways.height(), 20);
  EXPECT_GT(sideways.width() - upwards.width(), 20);
  EXPECT_NE(svg_content(frame, options).find("longest 3 m/s"), std::string::npos);
  options.arrows = "force";
  EXPECT_THROW(render(frame, options), InputError);
}

TEST(looks, crosses_lie_along_principal_stresses_red_for_tension_blue_for_compression) {
  Frame frame = plate(1.0);
  const auto with_stress = [&](float xx, float yy, float xy) {
    frame.triangle_fields = {{"stress_xx", "Pa", 1, {xx, xx}},
                             {"stress_yy", "Pa", 1, {yy, yy}},
                             {"stress_xy", "Pa", 1, {xy, xy}}};
    RenderOptions options = plain("z");
    options.crosses = true;
    return render(frame, options);
  };
  const Image pulled = with_stress(1e6F, 0.0F, 0.0F);
  EXPECT_EQ(find(pulled, is_blue).count, 0);
  const Image both = with_stress(-1e6F, 1e6F, 0.0F);
  EXPECT_GT(find(both, is_blue).count, 20);
  // Shear pulls along the diagonal that rises to the right.
  const Image sheared = with_stress(0.0F, 0.0F, 1e6F);
  const Found red = find(sheared, is_red);
  ASSERT_GT(red.count, 20);
  double sum_xy = 0.0;
  for (int y = red.top; y <= red.bottom; ++y)
    for (int x = red.left; x <= red.right; ++x)
      if (is_red(pixel(sheared, x, y)))
        sum_xy += (x - 0.5 * (red.left + red.right)) * (y - 0.5 * (red.top + red.bottom));
  EXPECT_NE(sum_xy, 0.0);
  // Of one sphere with a tensor of six parts, seen along -y: zz is upwards.
  Frame ball = spheres({{0, 0, 0}}, 1.0);
  ball.point_fields = {{"stress", "Pa", 6, {0, 0, 2e6F, 0, 0, 0}}};
  RenderOptions options = plain();
  options.crosses = true;
  const Found upright = find(render(ball, options), is_red);
  EXPECT_GT(upright.height(), 5 * upright.width());
  EXPECT_TRUE(has_field(ball, "stress_zz"));
  EXPECT_FALSE(has_field(ball, "stress_zy"));
  ball.point_fields.clear();
  EXPECT_THROW(render(ball, options), InputError);
}

TEST(looks, displacements_come_from_the_first_frame_by_id_and_are_drawn_larger) {
  Frame first = spheres({{0, 0, 0}, {1, 0, 0}}, 0.1),
        now = spheres({{1.1, 0, 0}, {0, 0, 0.2}}, 0.1);
  first.point_fields = {{"id", "-", 1, {0, 1}}};
  now.point_fields = {{"id", "-", 1, {1, 0}}};
  add_displacement(now, first);
  const Frame moved = displaced(now, 10.0);
  EXPECT_NEAR(moved.position[0].x, 2.0, 1e-6);
  EXPECT_NEAR(moved.position[1].z, 2.0, 1e-6);
  EXPECT_NEAR(displaced(now, 0.0).position[0].x, 1.0, 1e-6);
  EXPECT_THROW(displaced(first, 2.0), InputError);
  Frame other = spheres({{0, 0, 0}}, 0.1);
  other.point_fields = {{"id", "-", 1, {7}}};
  EXPECT_THROW(add_displacement(other, first), InputError);
}

TEST(looks, a_crack_goes_with_the_middle_of_its_sides) {
  const auto halves = [](double gap) {
    Frame frame;
    for (const double x : {0.0, 1.0 + gap})
      for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 0, 0},
                                 Vec3{1, 1, 0}, Vec3{0, 1, 0}})
        frame.position.push_back({x + corner.x, corner.y, 0.0});
    for (int i = 0; i < 12; ++i) frame.triangles.push_back(i);
    return frame;
  };
  Frame now = halves(0.02);
  now.position.push_back({1.01, 0, 0}), now.position.push_back({1.01, 1, 0});
  now.lines = {12, 13};
  add_displacement(now, halves(0.0));
  const Frame moved = displaced(now, 50.0);
  EXPECT_NEAR(moved.position[6].x, 2.0, 1e-5);
  EXPECT_NEAR(moved.position[12].x, 1.5, 1e-5);
  EXPECT_NEAR(moved.position[13].x, 1.5, 1e-5);
}

/// A roller on a beam is in the picture; a long rod, one that is away and a plane do not widen it.
TEST(looks, the_extent_holds_rollers_and_platens) {
  std::vector<Vec3> row;
  for (int i = 0; i < 41; ++i) row.push_back({0.1 * i - 2.0, 0.0, 0.0});
  Frame frame = spheres(row, 0.05);
  const auto wall = [](double from, double to) {
    return FrameWall{{0, 0, from}, {0, 0, -1}, {{-0.1, 0, from}, {0.1, 0, from}, {0, 0, to}}};
  };
  const Extent alone = bulk_extent(frame);
  frame.walls = {wall(0.05, 0.35), {{0, 0, -1}, {0, 0, 1}}};
  const Extent with = bulk_extent(frame);
  EXPECT_NEAR(with.high.z, 0.35, 1e-12);
  EXPECT_EQ(with.low.z, alone.low.z);
  EXPECT_EQ(with.high.x, alone.high.x);
  EXPECT_EQ(with.outline_points, 0);
  frame.walls = {wall(0.05, 3.0), wall(8.0, 8.3)};
  EXPECT_EQ(bulk_extent(frame).high.z, alone.high.z);
}

TEST(looks, the_extent_grows_with_what_leaves_it_and_follows_what_flies_far) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < 125; ++i) cloud.push_back({0.1 * (i % 5), 0.1 * (i / 5 % 5), 0.1 * (i / 25)});
  const auto moved = [&](double z) {
    Frame frame = spheres(cloud, 0.05);
    for (Vec3& p : frame.position) p.z -= z;
    return frame;
  };
  const Extent first = bulk_extent(moved(0.0));
  const Extent same = grown_extent(first, first, moved(0.001), 0.5);
  EXPECT_EQ(same.low.z, first.low.z);
  const Extent lower = grown_extent(first, first, moved(0.4), 0.5);
  EXPECT_NEAR(lower.low.z, first.low.z - 0.6, 1e-9);
  EXPECT_EQ(lower.high.z, first.high.z);
  const Extent far = grown_extent(first, first, moved(20.0), 0.5);
  EXPECT_NEAR(far.high.z, first.high.z - 20.0, 1e-9);
  RenderOptions options = plain();
  options.extent = first;
  EXPECT_GT(render(moved(0.0), options).model_pixels, 1000);
  EXPECT_EQ(render(moved(20.0), options).model_pixels, 0);
  options.extent = far;
  EXPECT_GT(render(moved(20.0), options).model_pixels, 1000);
  // A small body that flies far does not make the large one small.
  Frame two = moved(0.0);
  two.position.push_back({0, 0, 90.0});
  two.radius.push_back(0.05);
  two.point_fields = {{"group", "-", 1, std::vector<float>(126, 0.0F)}};
  two.point_fields[0].values.back() = 1.0F;
  EXPECT_EQ(grown_extent(first, first, two, 0.5).high.z, first.high.z);
}

/// A picture's margin is about a hundredth of it: less is forgiven while a film runs, nothing
/// after.
TEST(looks, the_extent_of_a_run_holds_all_that_its_frames_show) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < 125; ++i) cloud.push_back({0.1 * (i % 5), 0.1 * (i / 5 % 5), 0.1 * (i / 25)});
  const Frame frame = spheres(cloud, 0.05);
  Frame later = frame;
  for (Vec3& p : later.position) p.z += 0.01;  // 1.2 % of the cloud's diagonal
  const Extent first = bulk_extent(frame), now = bulk_extent(later);
  EXPECT_NEAR(grown_extent(first, first, later, 0.5).high.z, first.high.z + 0.015, 1e-9);
  const Extent all = grown_extent(first, first, later, 0.0);
  EXPECT_EQ(all.high.z, now.high.z);
  EXPECT_EQ(all.low.z, first.low.z);
  for (Vec3& p : later.position) p.z -= 0.0099;
  EXPECT_EQ(grown_extent(first, first, later, 0.5).high.z, first.high.z);
  EXPECT_EQ(grown_extent(first, first, later, 0.0).high.z, bulk_extent(later).high.z);
  // Seen aslant it is as large as before.
  ASSERT_EQ(all.outline_points, 4);
  const auto up = axes_of_view("iso").up;
  EXPECT_EQ(dot(all.outline[2], up), dot(now.outline[2], up));
  EXPECT_EQ(dot(all.outline[3], up), dot(first.outline[3], up));
}

TEST(looks, a_wall_lies_behind_the_model_and_is_hatched_from_its_edge) {
  Frame frame = spheres({{0, 0, 0}}, 1.0);
  frame.walls = {{{0, 0, -1}, {0, 0, 1}}};
  RenderOptions options = plain("z");
  const auto tinted = [](const Pixel& p) { return p[2] > p[0] + 8 && p[0] > 100; };
  const Image above = render(frame, options);
  EXPECT_GT(find(above, tinted).count, 10000);
  options.walls = false;
  EXPECT_EQ(pixel(above, 400, 300), pixel(render(frame, options), 400, 300));  // the ball is before
  EXPECT_EQ(find(render(frame, options), tinted).count, 0);
  options = plain("y");
  options.extent = Extent{{-2, -2, -2}, {2, 2, 2}};
  const Found edge = find(render(frame, options), tinted);
  EXPECT_GT(edge.width(), 300);
  EXPECT_LT(edge.height(), 40);
}

TEST(looks, marks_show_what_is_held) {
  Frame frame = plate(1.0);
  frame.point_fields = {{"held", "-", 1, {3, 3, 0, 3, 0, 0}}};
  RenderOptions options = plain("z");
  options.extent = Extent{{-1, -0.5, 0}, {2, 1.5, 0}};
  const Found low = find(render(frame, options), is_teal);
  ASSERT_GT(low.count, 5);
  EXPECT_GT(low.top, 400);  // the lower edge
  options.walls = false;
  EXPECT_EQ(find(render(frame, options), is_teal).count, 0);
  EXPECT_NE(svg_content(frame, plain("z")).find(">held<"), std::string::npos);
}

TEST(looks, a_free_camera_takes_in_its_angle) {
  const Viewpoint from{{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 2.0 * std::atan(0.5)};  // 5 m high
  const Camera camera = camera_at(from, {0, 0, 400, 300});
  EXPECT_NEAR(camera.resolution, 60.0, 1e-9);
  EXPECT_NEAR(camera.axes.right.x, 1.0, 1e-12);
  EXPECT_NEAR(camera.project({1, 0, 0}).u, 260.0, 1e-9);
  EXPECT_NEAR(camera.project({0, 0, 1}).v, 90.0, 1e-9);
  EXPECT_THROW(camera_at({{0, 0, 5}, {0, 0, 0}}, {0, 0, 4, 3}), InputError);
  RenderOptions options = plain("x");
  options.camera = from;
  const Image image = render(spheres({{1, 0, 0}}, 0.5), options);
  EXPECT_GT(find(image, [](const Pixel& p) { return p[2] < 225; }).left, image.width / 3);
}

TEST(looks, the_camera_comes_nearer_to_what_a_clip_leaves) {
  std::vector<Vec3> row;
  for (int i = 0; i < 8; ++i) row.push_back({0.5 + i, 0, 0});
  RenderOptions options = plain("iso");
  const auto size = [&] {
    return find(render(spheres(row, 0.5), options), [](const Pixel& p) { return p[2] < 225; });
  };
  const Found whole = size();
  options.clip = "x<1";
  EXPECT_GT(size().height(), 1.2 * whole.height());
}

TEST(looks, the_face_of_a_cut_is_flat) {
  RenderOptions options = plain("y");
  options.clip = "y=0";
  const Image image = render(spheres({{0, 0, 0}, {0, 0.8, 0.9}}, 1.0), options);
  const Pixel middle = pixel(image, 400, 330);
  int alike = 0;
  for (int x = 330; x < 470; ++x) alike += pixel(image, x, 330) == middle ? 1 : 0;
  EXPECT_EQ(alike, 140);
}

TEST(looks, links_are_wide_by_their_force_and_red_where_they_broke) {
  Frame frame =
      spheres({{-1, 0, 1}, {1, 0, 1}, {-1, 0, 0}, {1, 0, 0}, {-1, 0, -1}, {1, 0, -1}}, 0.1);
  frame.lines = {0, 1, 2, 3, 4, 5};
  frame.line_fields = {{"force", "N", 1, {100, 30, 1}}, {"state", "-", 1, {0, 1, 2}}};
  RenderOptions options = plain();
  options.field = "force";
  const Coloring coloring = color_frame(frame, options);
  EXPECT_GT(coloring.line_widths[0], 2.0F * coloring.line_widths[1]);
  EXPECT_FALSE(coloring.hidden_lines[1]);
  EXPECT_TRUE(coloring.hidden_lines[2]);
  options.field = "state";
  EXPECT_GT(find(render(frame, options), is_red).width(), 150);
}

TEST(looks, colours_by_logarithm_have_even_steps_for_powers_of_ten) {
  Frame frame = spheres({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.4);
  frame.point_fields = {{"pull", "N", 1, {1.0F, 100.0F, 10000.0F}}};
  RenderOptions options = plain();
  options.field = "pull";
  options.log = true;
  options.map = "gray";
  const Coloring coloring = color_frame(frame, options);
  const auto& p = coloring.points;
  EXPECT_NEAR(p[1].red, 0.5F * (p[0].red + p[2].red), 1e-3);
  EXPECT_GT(p[2].red, p[0].red + 0.5F);
  ASSERT_EQ(coloring.legend.bar->ticks.size(), 5U);
  EXPECT_EQ(coloring.legend.bar->ticks[4].text, "10");
  EXPECT_EQ(coloring.legend.title, "pull [kN]");
}

TEST(looks, rounding_of_nothing_is_not_shown_at_full_colour) {
  Frame frame = spheres({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.4);
  RenderOptions options = plain();
  options.field = "stress";
  const auto shown = [&](float largest) {
    frame.point_fields = {{"stress", "Pa", 1, {-largest, 0.0F, largest}}};
    return color_frame(frame, options).legend.bar->range;
  };
  EXPECT_EQ(shown(8e-6F).high, 1.0);  // a body at rest, stiff enough for 1e-16 of its modulus
  EXPECT_EQ(shown(8e-6F).low, -1.0);
  EXPECT_EQ(shown(8.0F).high, 8.0);
}

TEST(looks, edges_of_triangles_are_drawn_and_words_are_left_out_if_asked_for) {
  RenderOptions options = plain("z");
  const std::string usual = svg_content(plate(1.0), options);
  options.edges = options.bare = true;
  const std::string bare = svg_content(plate(1.0), options);
  EXPECT_NE(usual.find("<text"), std::string::npos);
  EXPECT_EQ(bare.find("<text"), std::string::npos);
  const auto strokes = [](const std::string& svg) {
    std::size_t count = 0;
    for (std::size_t at = svg.find("linecap"); at != std::string::npos;
         at = svg.find("linecap", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(strokes(bare), 6U);
  Image image = render(plate(1.0), options);
  const Found all = find(image, [](const Pixel& p) { return p[2] < 225; });
  EXPECT_EQ(all.top, image.height / 10);  // the plate fills the page
  image.dpi = 300;
  EXPECT_NE(png_content(image).find("pHYs"), std::string::npos);
}

TEST(looks, frames_in_files_keep_walls_and_tensors) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("looks" + std::to_string(::getpid()))).string();
  Frame frame = spheres({{0, 0, 0}}, 1.0);
  frame.walls = {{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 1, 0}}};
  frame.point_fields = {{"stress", "Pa", 6, {1, 2, 3, 4, 5, 6}}};
  {
    ParaviewSeries series(folder);
    series.write(contents_of(frame));
    series.finish();
  }
  const Frame read = read_frame(folder, 0);
  std::filesystem::remove_all(folder);
  ASSERT_EQ(read.walls.size(), 2U);
  EXPECT_EQ(read.walls[1].point.z, 6.0);
  EXPECT_EQ(read.walls[1].normal.y, 1.0);
  ASSERT_EQ(read.point_fields.size(), 1U);
  EXPECT_EQ(read.point_fields[0].components, 6);
  EXPECT_EQ(read.point_fields[0].values, frame.point_fields[0].values);
}

}  // namespace looks_test
}  // namespace breccia
