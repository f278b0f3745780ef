// Pictures of plane cases: cracks by mode, smooth edges, drawings; parts that are hidden; letters.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "exec/error.hpp"
#include "io/picture/font.hpp"
#include "io/picture/picture.hpp"
#include "io/picture/vector_picture.hpp"

namespace breccia {
namespace drawing_test {

/// A plate of two squares, each of two triangles, and a joint between the squares that broke.
Frame plate(float mode, double gap = 0.0) {
  Frame frame;
  const auto corner = [&](double x, double y) { frame.position.push_back({x, y, 0.0}); };
  for (const double left : {-1.0, gap}) {
    const double right = left < 0.0 ? 0.0 : 1.0;
    corner(left, -1), corner(right, -1), corner(right, 1);
    corner(left, -1), corner(right, 1), corner(left, 1);
  }
  for (std::int32_t i = 0; i < 12; ++i) frame.triangles.push_back(i);
  corner(0.5 * gap, -1), corner(0.5 * gap, 1);
  frame.lines = {12, 13};
  frame.triangle_fields = {{"damage", "-", 1, {0, 0, 0, 0}}, {"group", "-", 1, {0, 0, 1, 1}}};
  frame.line_fields = {{"mode", "-", 1, {mode}}, {"damage", "-", 1, {1.0F}}};
  frame.groups = {"left", "right"};
  return frame;
}

RenderOptions of_page() {
  RenderOptions options;
  options.width = 960, options.height = 720;
  return options;
}

struct Rgb {
  int red, green, blue;
};
Rgb at(const Image& image, int x, int y) {
  const auto place = static_cast<std::size_t>(3 * (y * image.width + x));
  return {image.rgb[place], image.rgb[place + 1], image.rgb[place + 2]};
}

/// The darkest pixel of the middle row.
Rgb darkest(const Image& image) {
  Rgb found{255, 255, 255};
  for (int x = 0; x < image.width * 2 / 3; ++x) {
    const Rgb p = at(image, x, image.height / 2);
    if (p.red + p.green + p.blue < found.red + found.green + found.blue) found = p;
  }
  return found;
}

TEST(drawing, cracks_that_opened_are_black_and_those_that_slid_blue) {
  const Rgb opened = darkest(render(plate(0.0F), of_page()));
  EXPECT_LT(std::max({opened.red, opened.green, opened.blue}), 70);
  const Rgb slid = darkest(render(plate(1.0F), of_page()));
  EXPECT_GT(slid.blue, slid.red + 80);
  Frame whole = plate(0.0F);
  whole.line_fields[1].values[0] = 0.5F;  // softened, not broken: no line
  EXPECT_GT(darkest(render(whole, of_page())).red, 180);
}

TEST(drawing, cracks_open_from_the_start_are_brown_and_the_legend_says_so) {
  const Rgb notch = darkest(render(plate(-1.0F), of_page()));
  EXPECT_GT(notch.red, notch.blue + 40);
  EXPECT_LT(notch.red, 150);
  const std::string svg = svg_content(plate(-1.0F), of_page());
  EXPECT_NE(svg.find("open from the start"), std::string::npos);
  EXPECT_EQ(svg.find("crack, opened"), std::string::npos);
}

TEST(drawing, gaps_narrower_than_a_pixel_leave_no_holes) {
  Frame frame = plate(0.0F, 1e-3);  // 0.06 pixels
  frame.line_fields[1].values[0] = 0.0F;
  const Image image = render(frame, of_page());
  int first = image.width, last = 0;
  for (int x = 0; x < image.width * 2 / 3; ++x)
    if (at(image, x, image.height / 2).blue < 240) first = std::min(first, x), last = x;
  ASSERT_GT(last - first, 50);
  for (int x = first + 1; x < last; ++x) EXPECT_LT(at(image, x, image.height / 2).blue, 240) << x;
}

TEST(drawing, a_plane_case_is_an_svg_with_its_triangles_crack_and_words) {
  const std::string svg = svg_content(plate(1.0F), of_page());
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  const auto count = [&svg](const std::string& word) {
    int found = 0;
    for (std::size_t at = svg.find(word); at != std::string::npos; at = svg.find(word, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("Z"), 4);  // four triangles
  EXPECT_EQ(count("crack, slid"), 1);
  EXPECT_EQ(count("<text"), count("</text>"));
  EXPECT_EQ(count("damage"), 1);
  Frame spheres;
  spheres.position = {{0, 0, 0}};
  spheres.radius = {1.0};
  EXPECT_THROW(svg_content(spheres, of_page()), InputError);
}

TEST(drawing, the_table_of_a_pdf_leads_to_its_objects) {
  const std::string pdf = pdf_content(plate(0.0F), of_page());
  ASSERT_TRUE(pdf.starts_with("%PDF-1.4"));
  const std::size_t named = pdf.rfind("startxref\n") + 10;
  const auto table = static_cast<std::size_t>(std::atol(pdf.c_str() + named));
  ASSERT_EQ(pdf.compare(table, 9, "xref\n0 7\n"), 0);
  for (int object = 1; object < 7; ++object) {
    const auto entry = table + 9 + 20 * static_cast<std::size_t>(object);
    const auto place = static_cast<std::size_t>(std::atol(pdf.c_str() + entry));
    const std::string begin = std::to_string(object) + " 0 obj\n";
    EXPECT_EQ(pdf.compare(place, begin.size(), begin), 0) << object;
  }
}

TEST(drawing, a_hidden_body_is_not_drawn_and_the_camera_stays) {
  RenderOptions options = of_page();
  const Image both = render(plate(0.0F), options);
  options.hidden = {"right"};
  const Image left = render(plate(0.0F), options);
  const int y = both.height / 2;
  const auto shown = [y](const Image& image, int x) { return at(image, x, y).blue < 240; };
  int only_left = 0, only_both = 0;
  for (int x = 0; x < both.width * 2 / 3; ++x) {
    only_left += shown(left, x) && !shown(both, x) ? 1 : 0;
    only_both += shown(both, x) && !shown(left, x) ? 1 : 0;
  }
  EXPECT_EQ(only_left, 0);
  EXPECT_GT(only_both, 20);
  options.hidden = {"roof"};
  EXPECT_THROW(render(plate(0.0F), options), InputError);
}

TEST(drawing, a_map_of_colours_is_chosen_by_name) {
  RenderOptions options = of_page();
  const Image usual = render(plate(0.0F), options);
  options.map = "viridis";
  EXPECT_NE(render(plate(0.0F), options).rgb, usual.rgb);
  options.map = "jet";
  EXPECT_THROW(render(plate(0.0F), options), InputError);
}

TEST(drawing, letters_have_forms_and_bytes_that_are_no_letters_show_as_one) {
  const auto ink = [](std::string_view text) {
    Image image{120, 40, std::vector<std::uint8_t>(3 * 120 * 40, 255)};
    draw_text(image, 4, 4, text, 2, {});
    double sum = 0.0;
    for (const std::uint8_t byte : image.rgb) sum += 255.0 - byte;
    return sum;
  };
  EXPECT_EQ(ink(" "), 0.0);
  EXPECT_GT(ink("µ"), ink("."));
  EXPECT_NE(ink("µ"), ink("u"));
  EXPECT_GT(text_width("mm", 2), text_width("il", 2));
  EXPECT_EQ(text_width("11", 2), text_width("88", 2));  // digits stand below each other
  EXPECT_EQ(code_points("a\xC2\xB5\xFF"), (std::u32string{U'a', U'µ', U'\uFFFD'}));
  EXPECT_GT(ink("\xFF"), 0.0);
}

}  // namespace drawing_test
}  // namespace breccia
