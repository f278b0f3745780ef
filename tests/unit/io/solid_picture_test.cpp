// Pictures of tetrahedra: surfaces, sections and silhouettes have the areas that geometry says.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "exec/error.hpp"
#include "io/picture/annotation.hpp"
#include "io/picture/solid.hpp"
#include "io/picture/vector_picture.hpp"
#include "unit/io/solid_scene.hpp"

namespace breccia {
namespace solid_picture_test {

using solid_scene::Block;

/// A block that has all fields of a frame, cracked below half of its height; if it opens, all over.
Frame cracked_block(const Vec3& opening = {}) {
  Block block(6, 3, 4);
  block.add_field("damage", "-", [](Vec3 c) { return 0.1 * c.x; });
  block.add_field("pressure", "Pa", [](Vec3 c) { return 1e6 * (c.z - 2.0); });
  for (const char* part : {"_xx", "_yy", "_zz", "_xy", "_yz", "_xz"})
    block.add_field((std::string("stress") + part).c_str(), "Pa", [](Vec3 c) { return c.x; });
  block.add_numbers("group", [](Vec3 c) { return c.x > 4.0 ? 1 : 0; });
  block.crack(
      3.0, [&](Vec3 c) { return c.z < 2.0 || opening.x > 0.0 ? 0.0 : -1.0; }, opening);
  block.frame.groups = {"beam", "end"};
  FrameField velocity{"velocity", "m/s", 3, {}};
  for (const Vec3& p : block.frame.position)
    for (const double v : {p.z, 0.0, -p.x}) velocity.values.push_back(static_cast<float>(v));
  block.frame.point_fields = {velocity};
  return block.frame;
}

RenderOptions bare(const std::string& field) {
  RenderOptions options;
  options.field = field;
  options.width = 400;
  options.height = 300;
  options.bare = true;
  return options;
}

/// A camera of 10 m from the lower to the upper border, and its pixels for a square metre.
Viewpoint ten_metres(const Vec3& from) {
  const Vec3 target{3.0, 1.5, 2.0};
  return {target + 10.0 * from, target, {0, 0, 1}, 2.0 * std::atan(0.5 / norm(from))};
}
double pixels_for_metre(const RenderOptions& options) {
  const Window window = scene_window(options, {});
  return (window.bottom - window.top) / 10.0;
}
double pixels_for_area(const RenderOptions& options) {
  return std::pow(pixels_for_metre(options), 2);
}

double area_of(const SolidPiece& piece) {
  double area = 0.0;
  const auto at = [&](std::size_t k) {
    return Vec3{piece.corner[k].u, piece.corner[k].v, piece.corner[k].depth};
  };
  for (std::size_t k = 2; k < piece.corners; ++k)
    area += 0.5 * norm(cross(at(k - 1) - at(0), at(k) - at(0)));
  return area;
}

/// Areas of all pieces on a picture of one pixel for a metre: of sections, and of faces.
struct Areas {
  double sections = 0.0, faces = 0.0;
};
Areas areas_of(const Frame& frame, const std::string& clip, const std::string& view) {
  const Axes axes = axes_of_view(view);
  Scene scene{{axes, {}, 0.0, 0.0, 1.0}, std::nullopt, &frame.position, {}, {}};
  if (const auto plane = clip_of(clip, axes)) scene.clip = on_screen(*plane, scene.camera);
  Areas areas;
  for (const SolidPiece& piece : pieces_of(frame, scene))
    (piece.section ? areas.sections : areas.faces) += area_of(piece);
  return areas;
}

std::int64_t differing(const Image& a, const Image& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3)
    count += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2];
  return count;
}

TEST(SolidPicture, blocks_of_the_tests_fill_space) {
  const Block block(6, 3, 4);
  double volume = 0.0;
  for (std::size_t t = 0; t < block.frame.tetrahedra.size() / 4; ++t) {
    EXPECT_GT(solid_scene::six_volumes(block.frame, t), 0.0);
    volume += solid_scene::six_volumes(block.frame, t) / 6.0;
  }
  EXPECT_NEAR(volume, 72.0, 1e-12);
}

TEST(SolidPicture, sections_of_a_tetrahedron_have_the_exact_area) {
  const std::array<ScreenPoint, 4> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (const double h : {0.1, 0.5, 0.75}) {
    const SolidPiece below = section_of(corners, {0, 0, 1, -h});  // three corners are kept
    EXPECT_EQ(below.corners, 3U);
    EXPECT_NEAR(area_of(below), 0.5 * (1 - h) * (1 - h), 1e-12) << h;
    const SolidPiece above = section_of(corners, {0, 0, -1, h});  // one
    EXPECT_NEAR(area_of(above), 0.5 * (1 - h) * (1 - h), 1e-12) << h;
    // Through edges of two corners either side: a rectangle of the sides sqrt(2) h and 1 - h.
    const SolidPiece two = section_of(corners, {1, 0, 1, -h});
    EXPECT_EQ(two.corners, 4U);
    EXPECT_NEAR(area_of(two), std::sqrt(2.0) * h * (1 - h), 1e-12) << h;
  }
  EXPECT_EQ(section_of(corners, {0, 0, 1, -1.1}).corners, 0U);
  EXPECT_EQ(section_of(corners, {0, 0, 1, 0.1}).corners, 0U);
}

TEST(SolidPicture, sections_of_a_block_cover_the_plane_of_the_cut_once) {
  const Frame frame = Block(6, 3, 4).frame;
  for (const char* clip : {"z=1.3", "z=2", "z=3.999"})
    EXPECT_NEAR(areas_of(frame, clip, "z").sections, 18.0, 1e-9) << clip;
  EXPECT_NEAR(areas_of(frame, "y=1", "y").sections, 24.0, 1e-9);  // between elements
  EXPECT_NEAR(areas_of(frame, "x=2.5", "iso").sections, 12.0, 1e-9);
  EXPECT_NEAR(areas_of(frame, "", "iso").faces, 24.0 + 18.0 + 12.0, 1e-9);  // towards the viewer
}

TEST(SolidPicture, sections_between_elements_have_no_gaps_where_nodes_are_a_little_off) {
  for (const double off : {1e-12, 1e-6}) {
    Frame frame = Block(6, 3, 4).frame;
    for (std::size_t i = 0; i < frame.position.size(); ++i)
      frame.position[i].z += off * (static_cast<double>(i * 37 % 11) - 5.0);
    EXPECT_NEAR(areas_of(frame, "z=2", "z").sections, 18.0, 18.0 * 1e-4) << off;
  }
}

TEST(SolidPicture, the_silhouette_of_a_block_has_the_exact_area) {
  const Frame frame = cracked_block();
  for (const Vec3& from : {Vec3{0, 0, 1}, Vec3{0.3, -0.9, 0.4}, Vec3{-0.5, 0.5, -0.7}}) {
    RenderOptions options = bare("pressure");
    options.camera = ten_metres(from);
    if (from.x == 0.0) options.camera->up = {0, 1, 0};
    const Vec3 n = (1.0 / norm(from)) * from;
    const double area = 12.0 * std::fabs(n.x) + 24.0 * std::fabs(n.y) + 18.0 * std::fabs(n.z);
    const double pixels = area * pixels_for_area(options);
    // Of a pixel drawn in three, that on the border may be wrong: 26 m at most.
    const double border = 26.0 * options.height / 10.0 / 3.0;
    EXPECT_NEAR(static_cast<double>(render(frame, options).model_pixels), pixels, border);
  }
}

TEST(SolidPicture, faces_within_are_left_out_without_a_trace) {
  for (const char* clip : {"", "y=1.4", "x<3"}) {
    Frame frame = cracked_block({0.2, 0.0, 0.1});
    RenderOptions options = bare("pressure");
    options.clip = clip;
    const Image some = render(frame, options);
    std::erase_if(frame.tetrahedron_fields, [](const auto& f) { return f.name == "exposed"; });
    EXPECT_EQ(differing(render(frame, options), some), 0) << clip;
  }
}

TEST(SolidPicture, cracks_show_where_they_meet_the_surface) {
  const Frame cracked = cracked_block();
  Frame whole = cracked;
  whole.triangles.clear();
  whole.triangle_fields.clear();
  const auto marked = [&](RenderOptions options) {
    return static_cast<double>(differing(render(cracked, options), render(whole, options)));
  };
  RenderOptions front = bare("pressure"), above = front, through = front, cut = front;
  front.camera = ten_metres({0, -1, 0});
  const double length = 2.0 * pixels_for_metre(front);  // it is one pixel wide, smoothed two
  EXPECT_GT(marked(front), length);
  EXPECT_LT(marked(front), 2.2 * length);
  above.view = "z";
  EXPECT_EQ(marked(above), 0.0);
  cut = front;
  cut.clip = "y=1.4";
  EXPECT_NEAR(marked(cut), marked(front), 12.0);
  through.camera = ten_metres({1, 0, 0});
  EXPECT_EQ(marked(through), 0.0);
  through.xray = true;  // 3 m by 2 m
  EXPECT_NEAR(marked(through), 6.0 * pixels_for_area(through), 10.0 * through.height / 10.0);
}

TEST(SolidPicture, an_open_crack_shows_its_inside) {
  RenderOptions options = bare("pressure");
  options.camera = ten_metres({0, 0, 1});
  options.camera->up = {0, 1, 0};
  Block block(6, 3, 4);
  block.add_field("pressure", "Pa", [](Vec3) { return 1.0; });
  block.crack(3.0, [](Vec3) { return 0.0; }, {0.5, 0.0, 0.0});
  const double pixels = 18.0 * pixels_for_area(options);  // the gap is empty, seen from above
  EXPECT_NEAR(static_cast<double>(render(block.frame, options).model_pixels), pixels,
              24.0 * options.height / 10.0 / 3.0);
  options.camera = ten_metres({1, 0, 1});  // from aside the other face fills it
  const double wider = (18.0 + 12.0 + 0.5 * 3.0) / std::sqrt(2.0) * pixels_for_area(options);
  EXPECT_NEAR(static_cast<double>(render(block.frame, options).model_pixels), wider,
              26.0 * options.height / 10.0 / 3.0);
}

TEST(SolidPicture, hidden_bodies_leave_what_they_covered) {
  RenderOptions options = bare("pressure");
  options.hidden = {"end"};
  options.camera = ten_metres({1, 0, 0});
  EXPECT_NEAR(static_cast<double>(render(cracked_block(), options).model_pixels),
              12.0 * pixels_for_area(options), 14.0 * options.height / 10.0 / 3.0);
  options.camera = ten_metres({0, -1, 0});
  EXPECT_NEAR(static_cast<double>(render(cracked_block(), options).model_pixels),
              16.0 * pixels_for_area(options), 16.0 * options.height / 10.0 / 3.0);
}

TEST(SolidPicture, every_option_draws_the_same_bits_by_any_threads) {
  std::vector<RenderOptions> all(10, bare("pressure"));
  all[1].clip = "y=1.4";
  all[2].xray = true;
  all[3].edges = true;
  all[4].arrows = "velocity";
  all[5].crosses = true;
  all[6].field = "velocity_z";
  all[7].field = "mode";
  all[8].field = "group";
  all[9].transparent = true;
  const Frame frame = cracked_block({0.1, 0.0, 0.0});
  const Image plain = render(frame, all[0]);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Image one = render(frame, all[i], 1), seven = render(frame, all[i], 7);
    EXPECT_EQ(one.rgb, seven.rgb) << i;
    EXPECT_EQ(one.alpha, seven.alpha) << i;
    EXPECT_TRUE(i == 0 || one.rgb != plain.rgb) << i;
  }
}

TEST(SolidPicture, drawings_and_damaged_frames_are_refused) {
  Frame frame = cracked_block();
  EXPECT_THROW(svg_content(frame, bare("pressure")), InputError);
  try {
    render(frame, bare("nonsense"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("pressure"), std::string::npos) << error.what();
  }
  frame.tetrahedra.back() = static_cast<std::int32_t>(frame.position.size());
  EXPECT_THROW(render(frame, bare("pressure")), InputError);
}

TEST(SolidPicture, displacements_come_from_the_first_frame) {
  const Frame first = cracked_block();
  Frame now = cracked_block({0.2, 0.0, 0.1});
  add_displacement(now, first);
  const FrameField& way = now.point_fields.back();
  ASSERT_EQ(way.name, "displacement");
  const std::size_t corners = now.tetrahedra.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const bool moved = now.position[i].x != first.position[i].x;
    EXPECT_FLOAT_EQ(way.values[3 * i], moved ? 0.2F : 0.0F);
    EXPECT_FLOAT_EQ(way.values[3 * i + 2], moved ? 0.1F : 0.0F);
  }
  for (std::size_t i = corners; i < now.position.size(); ++i)  // of both sides the mean
    EXPECT_NEAR(way.values[3 * i], 0.1, 1e-6);
  RenderOptions options = bare("pressure");
  options.camera = ten_metres({0, -1, 0});
  options.scale = 3.0;  // the gap is three times as wide
  EXPECT_NEAR(static_cast<double>(render(now, options).model_pixels),
              24.0 * pixels_for_area(options), 20.0 * options.height / 10.0);
}

TEST(SolidPicture, the_extent_is_that_of_the_bodies) {
  const Extent extent = bulk_extent(cracked_block());
  EXPECT_EQ(extent.low.x, 0.0);
  EXPECT_EQ(extent.high.x, 6.0);
  EXPECT_EQ(extent.high.z, 4.0);
}

}  // namespace solid_picture_test
}  // namespace breccia
