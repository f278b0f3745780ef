// Forces of contacts as lines of pictures, and single numbers of stresses as their colours.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/picture.hpp"
#include "io/picture/stress_measures.hpp"
#include "io/picture/vector_picture.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/touching.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "math/principal.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace contacts_picture_test {

/// Three balls in a row: the first pair presses with 30 N, the second with 10 N.
Frame row() {
  Frame frame;
  frame.position = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}};
  frame.radius = {1, 1, 1};
  frame.point_fields = {whole_numbers("id", {0, 1, 2}), {"group", "-", 1, {0, 0, 1}}};
  frame.groups = {"left", "right"};
  frame.line_fields = {{"force", "N", 1, {}}};
  frame.contacts = {{0, 1, {0, 0, 0}, {2, 0, 0}, {30, 0, 0}},
                    {1, 2, {2, 0, 0}, {4, 0, 0}, {6, 8, 0}}};
  return frame;
}
RenderOptions from_front(const std::string& field) {
  RenderOptions options;
  options.field = field;
  options.view = "y";
  options.width = 800, options.height = 300;
  return options;
}
/// Pixels of yellow, the brightest colour of the map, and of its darkest.
struct Seen {
  int yellow = 0, violet = 0, black = 0;
};
Seen seen_in(const Image& image) {
  Seen seen;
  for (int y = image.height / 3; y < image.height; ++y)
    for (int x = 0; x < image.width * 3 / 4; ++x) {
      const std::uint8_t* const p = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
      seen.yellow += p[0] > 200 && p[1] > 180 && p[2] < 90 ? 1 : 0;
      seen.violet += p[2] > p[1] + 25 && p[2] > p[0] + 60 ? 1 : 0;
      seen.black += p[0] < 60 && p[1] < 60 && p[2] < 70 ? 1 : 0;
    }
  return seen;
}

TEST(ContactsPicture, force_of_grains_without_links_is_that_of_their_contacts) {
  const Coloring coloring = color_frame(row(), "force", {});
  ASSERT_EQ(coloring.contacts.size(), 2U);
  EXPECT_EQ(coloring.contacts[0].contact, 1U);  // the weakest first: it lies below
  EXPECT_NEAR(coloring.contacts[0].width, 1.0 / 3.0, 1e-6);
  EXPECT_EQ(coloring.contacts[1].width, 1.0);
  EXPECT_EQ(coloring.legend.title, "contact force [N]");
  EXPECT_EQ(coloring.legend.bar->range.low, 0.0);
  EXPECT_EQ(coloring.legend.bar->range.high, 30.0);
  const Seen seen = seen_in(render(row(), from_front("force")));
  EXPECT_GT(seen.yellow, 200);
  EXPECT_GT(seen.violet, 50);
}

TEST(ContactsPicture, links_keep_the_name_force_and_contacts_have_their_own) {
  Frame linked = row();
  linked.lines = {0, 1};
  linked.line_fields = {{"force", "N", 1, {5.0F}}};
  EXPECT_TRUE(color_frame(linked, "force", {}).of_lines);
  EXPECT_TRUE(color_frame(linked, "force", {}).contacts.empty());
  EXPECT_EQ(color_frame(linked, "contact_force", {}).contacts.size(), 2U);
}

TEST(ContactsPicture, contacts_lie_over_any_other_colour_and_are_hidden_with_their_body) {
  RenderOptions options = from_front("group");
  const int before = seen_in(render(row(), options)).black;
  options.forces = true;
  const int both = seen_in(render(row(), options)).black;
  EXPECT_GT(both, before + 300);
  options.hidden = {"right"};
  EXPECT_GT(seen_in(render(row(), options)).black, before + 200);
  options.hidden = {"left"};
  EXPECT_LT(seen_in(render(row(), options)).black, before + 20);
  options.hidden = {};
  options.clip = "x<2.5";
  const int cut = seen_in(render(row(), options)).black;
  EXPECT_GT(cut, before + 100);
  options.clip = "x<-3";
  EXPECT_LT(seen_in(render(row(), options)).black, before + 20);
}

TEST(ContactsPicture, a_frame_where_nothing_presses_says_so) {
  Frame loose = row();
  loose.contacts.clear();
  const Coloring coloring = color_frame(loose, "force", {});
  ASSERT_FALSE(coloring.legend.notes.empty());
  EXPECT_EQ(coloring.legend.notes.back(), "no contact presses");
}

TEST(ContactsPicture, enlarged_displacements_would_part_them_from_their_bodies) {
  RenderOptions options = from_front("force");
  options.scale = 10.0;
  EXPECT_THROW(render(row(), options), InputError);
}

TEST(ContactsPicture, a_drawing_of_a_plane_case_has_them_as_strokes) {
  Frame plate;
  plate.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  plate.triangles = {0, 1, 2, 3, 4, 5};
  plate.triangle_fields = {whole_numbers("id", {0, 1})};
  plate.contacts = {{0, 1, {0.6, 0.3, 0}, {2.6, 0.3, 0}, {-7e5, 0, 0}}};
  RenderOptions options = from_front("force");
  options.bare = true;
  const std::string drawing = svg_content(plate, options, "");
  EXPECT_NE(drawing.find("<path d=\"M"), std::string::npos) << drawing;
  EXPECT_EQ(color_frame(plate, "force", {}).legend.title, "contact force [kN/m]");
}

TEST(ContactsPicture, files_of_contacts_are_read_with_their_frame) {
  const ScratchFolder folder;
  Frame frame = row();
  frame.walls = {{{0, 0, -1}, {0, 0, 1}}};
  frame.contacts.push_back({0, -1, {0, 0, 0}, {0, 0, -1}, {0, 0, -4}});
  ParaviewSeries series(folder / "run", FrameFormat::vtu);
  FrameContents files = contents_of(frame, 1, FrameFormat::vtu);
  series.write(files);
  series.finish();
  Frame without = read_frame(folder / "run", 0);
  EXPECT_FALSE(add_contacts_of(folder / "run", 0, without));

  ParaviewSeries more(folder / "more", FrameFormat::vtu);
  Touching touching{frame.contacts, {}, false};
  touching.around.add(frame.position);
  add_touching(files, frame, touching, FrameFormat::vtu, 1);
  more.write(files);
  more.finish();
  Frame with = read_frame(folder / "more", 0);
  ASSERT_TRUE(add_contacts_of(folder / "more", 0, with));
  ASSERT_EQ(with.contacts.size(), 3U);
  const FrameContact& wall = with.contacts.front();
  EXPECT_EQ(wall.a, 0);
  EXPECT_EQ(wall.b, -1);
  EXPECT_EQ(wall.force.z, -4.0);
  EXPECT_EQ(wall.at_b.z, -1.0);
  EXPECT_EQ(render(with, from_front("force")).rgb, render(frame, from_front("force")).rgb);
}

/// diag(3, 1, -2) in axes that are turned by some angle about (1, 2, 2) / 3.
Sym3 turned() {
  const Vec3 n{1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0};
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turn = [&](const Vec3& v) {
    return c * v + s * cross(n, v) + (1.0 - c) * dot(n, v) * n;
  };
  const Vec3 a = turn({1, 0, 0}), b = turn({0, 1, 0}), d = turn({0, 0, 1});
  const auto part = [&](double Vec3::*i, double Vec3::*j) {
    return 3.0 * a.*i * a.*j + 1.0 * b.*i * b.*j - 2.0 * d.*i * d.*j;
  };
  return {part(&Vec3::x, &Vec3::x), part(&Vec3::y, &Vec3::y), part(&Vec3::z, &Vec3::z),
          part(&Vec3::y, &Vec3::z), part(&Vec3::x, &Vec3::z), part(&Vec3::x, &Vec3::y)};
}

TEST(PrincipalValues, are_those_of_the_axes_a_tensor_was_turned_from) {
  const auto values = principal_values(turned());
  EXPECT_NEAR(values[0], 3.0, 1e-14);
  EXPECT_NEAR(values[1], 1.0, 1e-14);
  EXPECT_NEAR(values[2], -2.0, 1e-14);
  EXPECT_EQ(principal_values({}).front(), 0.0);
  EXPECT_EQ(principal_values({1, 5, 2, 0, 0, 0}).front(), 5.0);
  EXPECT_NEAR(principal_values({0, 0, 0, 0, 0, 4}).back(), -4.0, 1e-14);
}

TEST(StressMeasures, of_a_tensor_are_its_principal_values_mean_and_equivalent) {
  const Sym3 s = turned();
  Frame balls = row();
  const auto f = [](double x) { return static_cast<float>(x); };
  balls.point_fields.push_back(
      {"stress",
       "Pa",
       6,
       {f(s.xx), f(s.yy), f(s.zz), f(s.xy), f(s.yz), f(s.xz), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
  Frame solid;
  solid.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  solid.tetrahedra = {0, 1, 2, 3};
  for (const auto& [name, value] : {std::pair{"stress_xx", s.xx},
                                    {"stress_yy", s.yy},
                                    {"stress_zz", s.zz},
                                    {"stress_xy", s.xy},
                                    {"stress_yz", s.yz},
                                    {"stress_xz", s.xz}})
    solid.tetrahedron_fields.push_back({name, "Pa", 1, {f(value)}});
  for (const Frame& frame : {balls, solid}) {
    const auto first = [&](const char* name) {
      return stress_measure(frame, name)->values.front();
    };
    EXPECT_NEAR(first("stress_largest"), 3.0, 1e-6);
    EXPECT_NEAR(first("stress_smallest"), -2.0, 1e-6);
    EXPECT_NEAR(first("stress_mean"), 2.0 / 3.0, 1e-6);
    EXPECT_NEAR(first("stress_shear"), 2.5, 1e-6);
    EXPECT_NEAR(first("stress_mises"), std::sqrt(0.5 * (4.0 + 9.0 + 25.0)), 1e-6);
    EXPECT_TRUE(has_field(frame, "stress_mises"));
    EXPECT_FALSE(has_field(frame, "stress_median"));
    EXPECT_EQ(color_frame(frame, "stress_largest", {}).legend.title, "stress_largest [Pa]");
  }
  EXPECT_FALSE(has_field(row(), "stress_mises"));
}

TEST(StressMeasures, of_triangles_are_those_in_their_plane) {
  Frame plate;
  plate.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  plate.triangles = {0, 1, 2};
  plate.triangle_fields = {{"stress_xx", "Pa", 1, {-1.0F}},
                           {"stress_yy", "Pa", 1, {-3.0F}},
                           {"stress_zz", "Pa", 1, {-9.0F}},
                           {"stress_xy", "Pa", 1, {0.0F}}};
  EXPECT_EQ(stress_measure(plate, "stress_largest")->values.front(), -1.0F);
  EXPECT_EQ(stress_measure(plate, "stress_smallest")->values.front(), -3.0F);
  EXPECT_EQ(stress_measure(plate, "stress_shear")->values.front(), 1.0F);
  EXPECT_NEAR(stress_measure(plate, "stress_mean")->values.front(), -13.0 / 3.0, 1e-6);
}

}  // namespace contacts_picture_test
}  // namespace breccia
