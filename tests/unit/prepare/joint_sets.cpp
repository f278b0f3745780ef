// Sets of joints: what was asked for is what is drawn, files are read or refused by line; parts of
// bodies.

#include "prepare/meshing/joint_sets.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/region.hpp"
#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build_fdem.hpp"

namespace breccia::prepare {
namespace joint_sets_test {

fdem::JointSetConfig random_set() {
  fdem::JointSetConfig set;
  set.name = "set";
  set.min = {-10.0, -5.0};
  set.max = {10.0, 5.0};
  set.intensity = 20.0;
  set.angle = 0.4;
  set.spread = 0.1;
  set.length = 0.5;
  return set;
}
TEST(JointSets, have_the_intensity_the_angles_and_the_lengths_that_were_asked_for) {
  for (const char* law : {"constant", "exponential", "lognormal", "power"}) {
    fdem::JointSetConfig set = random_set();
    set.length_law = law;
    set.length_deviation = 0.2;
    if (set.length_law == "power") {
      set.length_exponent = 3.0;
      set.least = 0.3;
      set.most = 3.0;
    }
    const auto lines = lines_of_set(set, 7, 0, "");
    double sum = 0.0, whole = 0.0, angles = 0.0, squares = 0.0, middle_x = 0.0;
    int inner = 0;
    for (const auto& line : lines) {
      const Vec2 &a = line.points[0], &b = line.points[1], way = b - a;
      sum += norm(way);
      angles += std::atan2(way.y, way.x);
      squares += std::pow(std::atan2(way.y, way.x) - 0.4, 2);
      for (const Vec2& p : {a, b})
        EXPECT_TRUE(std::abs(p.x) <= 10.0 + 1e-9 && std::abs(p.y) <= 5.0 + 1e-9);
      const auto is_inner = [](const Vec2& p) {
        return std::abs(p.x) < 10.0 - 1e-9 && std::abs(p.y) < 5.0 - 1e-9;
      };
      if (!is_inner(a) || !is_inner(b)) continue;
      ++inner;
      whole += norm(way);
      middle_x += 0.5 * (a.x + b.x);
    }
    EXPECT_NEAR(sum, 20.0 * 200.0, 1e-6) << law;
    const double count = static_cast<double>(lines.size());
    EXPECT_NEAR(angles / count, 0.4, 4.0 * 0.1 / std::sqrt(count)) << law;
    EXPECT_NEAR(std::sqrt(squares / count), 0.1, 4.0 * 0.1 / std::sqrt(2.0 * count)) << law;
    EXPECT_NEAR(middle_x / inner, 0.0, 4.0 * 5.8 / std::sqrt(inner)) << law;
    // mean of l^-3 between 0.3 and 3: 2 (1/0.3 - 1/3) / (1/0.09 - 1/9)
    const double mean = set.length_law == "power" ? 2.0 * 3.0 / 11.0 : 0.5;
    // longer ones cross the rim more often and are not counted: by l / 20 and l / 10
    EXPECT_NEAR(whole / inner, mean, 0.06 * mean) << law;
  }
}

/// Number of lines that a line across them meets over its length: P10 = 1/spacing; and P21 is that
/// times the share that is no bridge.
TEST(JointSets, are_regular_where_a_spacing_is_given) {
  fdem::JointSetConfig set = random_set();
  set.intensity = 0.0;
  set.length = 0.0;
  set.spacing = 0.1;
  double sum = 0.0;
  int met = 0;
  const Vec2 along{std::cos(0.4), std::sin(0.4)}, across{-along.y, along.x};
  for (const auto& line : lines_of_set(set, 7, 0, "")) {
    const Vec2 &a = line.points[0], way = line.points[1] - a;
    EXPECT_NEAR(std::atan2(way.y, way.x), 0.4, 1e-9);
    EXPECT_NEAR(std::remainder(dot(a, across), 0.1), 0.0, 1e-9);
    if (std::abs(dot(a, across)) < 2.95) ++met;
    sum += norm(way);
  }
  EXPECT_EQ(met, 59);
  EXPECT_NEAR(sum, 200.0 / 0.1, 20.0);
  set.length = 0.3;
  set.gap = 0.1;
  double bridged = 0.0;
  for (const auto& line : lines_of_set(set, 7, 0, "")) {
    const double length = norm(line.points[1] - line.points[0]);
    EXPECT_LE(length, 0.3 + 1e-9);
    bridged += length;
  }
  EXPECT_NEAR(bridged, 0.75 * sum, 0.01 * sum);
}
TEST(JointSets, are_a_function_of_seed_and_place) {
  const fdem::JointSetConfig set = random_set();
  const auto one = lines_of_set(set, 7, 0, ""), again = lines_of_set(set, 7, 0, "");
  ASSERT_EQ(one.size(), again.size());
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].points[0].x, again[k].points[0].x);
  EXPECT_NE(one[0].points[0].x, lines_of_set(set, 8, 0, "")[0].points[0].x);
  EXPECT_NE(one[0].points[0].x, lines_of_set(set, 7, 1, "")[0].points[0].x);
}

class JointSetFiles : public testing::Test {
 protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("joint_sets_" + std::to_string(::getpid()));
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::vector<fdem::DiscontinuityConfig> read(const char* name, const char* text) {
    std::ofstream(folder_ / name) << text;
    fdem::JointSetConfig set;
    set.name = "set";
    set.file = name;
    return lines_of_set(set, 1, 0, folder_.string());
  }
  std::string refusal(const char* name, const char* text) {
    try {
      read(name, text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(JointSetFiles, of_csv_and_wkt_are_read) {
  const auto csv = read("a.csv", "x1,y1,x2,y2\n0,0,1,2\n# a remark\n3,4,5,6.5\n");
  ASSERT_EQ(csv.size(), 2U);
  EXPECT_EQ(csv[1].points[1].y, 6.5);
  const auto wkt = read("a.wkt",
                        "# remark\nLINESTRING (0 0, 1 2, 1 2, 3e0 -2)\n"
                        "MultiLineString ((0 0, 1 1), (2 2, 3 3));\nlinestring(5 5,6 6)");
  ASSERT_EQ(wkt.size(), 4U);
  EXPECT_EQ(wkt[0].points.size(), 3U);
  EXPECT_EQ(wkt[0].points[2].y, -2.0);
  EXPECT_EQ(wkt[2].points[1].x, 3.0);
}
TEST_F(JointSetFiles, of_wkt_in_space_lose_z_and_collections_are_gone_into) {
  const auto wkt = read("z.wkt",
                        "LINESTRING Z (0 0 7, 1 2 8)\nLineStringZM(0 0 1 2, 4 5 6 7)\n"
                        "GEOMETRYCOLLECTION (MULTILINESTRING M ((0 0 9, 3 1 9), (2 2 9, 6 3 9)), "
                        "LINESTRING EMPTY, GEOMETRYCOLLECTION Z (LINESTRING Z (1 1 0, 8 9 0)))");
  ASSERT_EQ(wkt.size(), 5U);
  EXPECT_EQ(wkt[0].points[1].y, 2.0);
  EXPECT_EQ(wkt[1].points[1].x, 4.0);
  EXPECT_EQ(wkt[3].points[1].x, 6.0);
  EXPECT_EQ(wkt[4].points[1].y, 9.0);
  EXPECT_NE(
      refusal("b.wkt", "GEOMETRYCOLLECTION (LINESTRING (0 0, 1 1),\nPOINT (1 1))").find("line 2"),
      std::string::npos);
  EXPECT_NE(refusal("b.wkt", "LINESTRING (0 0 1 2 3, 1 1)").find("no ')'"), std::string::npos);
}
TEST_F(JointSetFiles, that_are_wrong_are_refused_by_line) {
  EXPECT_NE(refusal("b.wkt", "LINESTRING (0 0, 1 1)\nPOINT (1 1)").find("line 2"),
            std::string::npos);
  EXPECT_NE(refusal("b.wkt", "LINESTRING (0 0, 1)").find("no number"), std::string::npos);
  EXPECT_NE(refusal("b.wkt", "LINESTRING (0 0, 1 1").find("no ')'"), std::string::npos);
  EXPECT_NE(refusal("b.wkt", "LINESTRING (1 1, 1 1)").find("no length"), std::string::npos);
  EXPECT_NE(refusal("b.csv", "0,0,1,1\n0,0,1\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("b.csv", "").find("no line"), std::string::npos);
}

TEST(JointSets, say_what_is_missing) {
  fdem::JointSetConfig set;
  set.name = "s";
  set.kind = "cohesive";
  set.material = "weak";
  const auto said = joint_set_problems(set, {"strong"});
  ASSERT_EQ(said.size(), 4U);
  EXPECT_EQ(said[0], "joint_set.s.material = \"weak\" is not a joint law; there are: strong");
  EXPECT_EQ(said[1], "joint_set.s: random lines need the rectangle that they fill, min and max");
  EXPECT_TRUE(joint_set_problems(random_set(), {}).empty());
}

TEST(JointSets, of_more_lines_than_can_be_are_refused) {
  fdem::JointSetConfig set = random_set();
  set.intensity = 1e7;
  auto said = joint_set_problems(set, {});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0], "joint_set.set.intensity: about 4e+09 lines; at most 1000000 are possible");
  set.intensity = 0.0;
  set.spacing = 1.0;
  set.length = 1e-12;
  said = joint_set_problems(set, {});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find(".spacing: about "), std::string::npos) << said[0];

  set = random_set();  // lengths up to so many that few lines meet the rectangle
  set.most = 1e9;
  try {
    lines_of_set(set, 7, 0, "");
    ADD_FAILURE() << "fewer lines than asked for";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("of the 4e+03 m"), std::string::npos) << error.what();
  }
}

double area_of(const fdem::Model& model, std::size_t t) {
  const auto corner = [&](std::size_t k) {
    return model.point[static_cast<std::size_t>(model.triangle[t][k])];
  };
  return 0.5 * cross(corner(1) - corner(0), corner(2) - corner(0));
}

/// Bodies and sets of a regular plate: no gmsh.
TEST(JointSets, and_parts_are_in_the_model) {
  fdem::BodyConfig plate, core;
  plate.name = "plate";
  plate.material = core.material = "rock";
  plate.size = {4.0, 4.0};
  plate.mesh_size = 0.1;
  plate.structured = true;
  plate.pattern = "crossed";
  core.name = "core";
  core.shape = "part";
  core.of = "plate";
  core.radius = 1.0;
  fdem::JointSetConfig set = random_set();  // partly outside of the plate
  set.intensity = 0.5;
  set.length = 2.0;
  set.embedded = false;
  const fdem::Model model = build_fdem_model({plate, core}, {}, {{"rock"}, {}}, 1, "", {set});
  double area = 0.0;
  for (std::size_t t = 0; t < model.triangle.size(); ++t)
    if (model.group[t] == 1) area += area_of(model, t);
  EXPECT_NEAR(area, pi, 0.03 * pi);  // stairs of 50 mm
  double length = 0.0;
  for (const auto& d : model.discontinuities)
    length += norm(model.point[static_cast<std::size_t>(d.edge[0])] -
                   model.point[static_cast<std::size_t>(d.edge[1])]);
  EXPECT_GT(length, 0.5 * 16.0 * 0.5);  // of a set of 0.5/m; the path of edges is longer
  EXPECT_LT(length, 2.0 * 16.0 * 0.5);
  core.of = "core";
  EXPECT_THROW(build_fdem_model({plate, core}, {}, {{"rock"}, {}}, 1, ""), InputError);
  core.of = "plate";
  core.center = {10.0, 0.0};
  EXPECT_THROW(build_fdem_model({plate, core}, {}, {{"rock"}, {}}, 1, ""), InputError);
}

TEST(Regions, of_circles_cylinders_and_polygons) {
  EXPECT_TRUE(in_circle({1.0, 0.0}, 1.0, {2.0, 0.0}));
  EXPECT_FALSE(in_circle({1.0, 0.0}, 1.0, {2.001, 0.0}));
  EXPECT_TRUE(in_round({0.0, 0.0, 0.0}, 1.0, "z", {0.6, 0.8, 100.0}));
  EXPECT_FALSE(in_round({0.0, 0.0, 0.0}, 1.0, "x", {0.6, 0.8, 100.0}));
  EXPECT_FALSE(in_round({0.0, 0.0, 0.0}, 1.0, "", {0.6, 0.8, 0.1}));
  const std::vector<Vec2> hook{{0.0, 0.0}, {3.0, 0.0}, {3.0, 3.0},
                               {2.0, 3.0}, {2.0, 1.0}, {0.0, 1.0}};
  EXPECT_TRUE(in_polygon(hook, {2.5, 2.5}));
  EXPECT_TRUE(in_polygon(hook, {0.5, 0.5}));
  EXPECT_FALSE(in_polygon(hook, {1.0, 2.0}));
}

}  // namespace joint_sets_test
}  // namespace breccia::prepare
