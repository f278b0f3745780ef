#include "prepare/meshing/clean_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/constants.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia::prepare {
namespace clean_lines_test {

using Line = std::array<Vec2, 2>;

const std::vector<Line> no_rim;

bool same(const std::vector<Line>& a, const std::vector<Line>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (a[i][k].x != b[i][k].x || a[i][k].y != b[i][k].y) return false;
  return true;
}

std::vector<Line> random_lines(int count) {
  std::mt19937 random(3);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<Line> lines;
  for (int i = 0; i < count; ++i) {
    const Vec2 middle{uniform(-5.0, 5.0), uniform(-5.0, 5.0)};
    const double angle = uniform(0.0, pi), half = uniform(0.25, 1.5);
    const Vec2 way{half * std::cos(angle), half * std::sin(angle)};
    lines.push_back({middle - way, middle + way});
  }
  return lines;
}

TEST(CleanLines, leave_what_is_far_apart_as_it_is) {
  const std::vector<Line> lines{{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}},
                                {Vec2{0.5, -0.5}, Vec2{0.5, 0.5}},  // crosses the first
                                {Vec2{1.0, 0.0}, Vec2{2.0, 1.0}},   // goes on where it ends
                                {Vec2{0.0, 0.3}, Vec2{0.4, 0.3}}};
  EXPECT_TRUE(same(cleaned(lines, no_rim, 0.05), lines));
}

TEST(CleanLines, merge_ends_and_let_lines_end_where_they_nearly_meet_another) {
  const auto merged =
      cleaned({{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}}, {Vec2{1.01, 0.01}, Vec2{2.0, 0.0}}}, no_rim, 0.05);
  EXPECT_TRUE(same(merged, {{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}}, {Vec2{1.0, 0.0}, Vec2{2.0, 0.0}}}));
  // the second one stops short of the first, the third overshoots it
  for (const double end : {0.02, -0.02}) {
    const auto meeting =
        cleaned({{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}}, {Vec2{0.5, end}, Vec2{0.5, 1.0}}}, no_rim, 0.05);
    ASSERT_EQ(meeting.size(), 3U) << end;
    int there = 0;
    for (const Line& line : meeting)
      for (const Vec2& p : line)
        if (std::abs(p.x - 0.5) < 1e-12 && std::abs(p.y) < 0.021) ++there;
    EXPECT_EQ(there, 3) << end;
  }
}

TEST(CleanLines, bring_ends_near_the_rim_onto_it) {
  const std::vector<Line> rim{{Vec2{0.0, 0.0}, Vec2{10.0, 0.0}},
                              {Vec2{10.0, 0.0}, Vec2{10.0, 9.0}}};
  const auto onto =
      cleaned({{Vec2{5.0, 0.03}, Vec2{5.0, 2.0}}, {Vec2{9.98, -0.01}, Vec2{8.0, 2.0}}}, rim, 0.05);
  EXPECT_TRUE(same(onto, {{Vec2{5.0, 0.0}, Vec2{5.0, 2.0}}, {Vec2{10.0, 0.0}, Vec2{8.0, 2.0}}}));
}

/// Afterwards no two points are nearer than the tolerance, and no line passes a point so nearby.
TEST(CleanLines, of_random_fractures_leave_no_small_distance) {
  constexpr double h = 0.5;
  for (const double share : {0.1, 0.25}) {
    const double tolerance = share * h;
    const std::vector<Line> lines = random_lines(120);
    const std::vector<Line> clean = cleaned(lines, no_rim, tolerance);
    EXPECT_GT(clean.size(), lines.size());
    double before = 0.0, after = 0.0, least = 1e300;
    for (const Line& line : lines) before += norm(line[1] - line[0]);
    for (const Line& a : clean) {
      after += norm(a[1] - a[0]);
      least = std::min(least, norm(a[1] - a[0]));
      for (const Line& b : clean)
        for (const Vec2& p : b) {
          if (norm(p - a[0]) == 0.0 || norm(p - a[1]) == 0.0) continue;
          const Vec2 along = a[1] - a[0];
          const double s = std::min(1.0, std::max(0.0, dot(p - a[0], along) / dot(along, along)));
          least = std::min(least, norm(p - (a[0] + s * along)));
        }
    }
    std::printf("tolerance %.3f: %zu parts, least distance %.4f, length %.1f of %.1f\n", tolerance,
                clean.size(), least, after, before);
    EXPECT_GT(least, 0.999 * tolerance);
    EXPECT_GT(after, 0.75 * before);
    EXPECT_LE(after, 1.02 * before);
  }
}

/// The least height of the triangles over the edge that is aimed at, and the length of open cracks.
std::pair<double, double> meshed(double merge) {
  fdem::BodyConfig body;
  body.name = "plate";
  body.material = "rock";
  body.size = {10.0, 10.0};
  body.mesh_size = 0.5;
  body.merge = merge;
  std::vector<fdem::DiscontinuityConfig> fractures;
  for (const Line& line : random_lines(60)) {
    fractures.emplace_back();
    fractures.back().name = "f" + std::to_string(fractures.size());
    fractures.back().points = {line[0], line[1]};
  }
  const fdem::Model model = fdem::built({body}, fractures);
  double least = 1e300, length = 0.0;
  for (const auto& t : model.triangle)
    for (std::size_t k = 0; k < 3; ++k)
      least = std::min(least, 2.0 * signed_area(model.point, t) /
                                  norm(at(model.point, t[(k + 1) % 3]) - at(model.point, t[k])));
  for (const fdem::Model::Discontinuity& d : model.discontinuities)
    length += norm(at(model.point, d.edge[0]) - at(model.point, d.edge[1]));
  return {least / body.mesh_size, length};
}

TEST(CleanLines, keep_slivers_out_of_meshes) {
  const auto [as_given, length] = meshed(0.0);
  const auto [merged, merged_length] = meshed(0.25);
  std::printf("least height over mesh_size: %.4f, merged %.4f; open cracks %.1f, merged %.1f m\n",
              as_given, merged, length, merged_length);
  EXPECT_LT(as_given, 0.02);
  EXPECT_GT(merged, 0.08);
  EXPECT_NEAR(merged_length, length, 0.1 * length);
}

TEST(CleanLines, tell_of_what_they_move) {
  fdem::BodyConfig body;
  body.size = {0.1, 0.1};
  body.mesh_size = 0.01;
  const MeshingContext apart{
      .seed = 1,
      .number = 0,
      .folder = ".",
      .lines = {{{Vec2{-0.03, 0.0}, {0.01, 0.0}}, {Vec2{0.02, 0.0}, {0.03, 0.03}}}}};
  EXPECT_EQ(merged_lines(body, apart), "");
  MeshingContext near = apart;
  near.lines[1][0] = {0.0105, 0.0005};
  const std::string told = merged_lines(body, near);
  EXPECT_TRUE(told.starts_with("merge moves 1 of 4 ends of the 2 lines")) << told;
  EXPECT_NE(told.find("by 0.000707 m at most"), std::string::npos) << told;
  near.lines.push_back({Vec2{-0.04, 0.04}, {-0.039, 0.04}});  // far from all others
  const std::string with_short = merged_lines(body, near);
  EXPECT_TRUE(with_short.starts_with("merge moves 1 of 6 ends of the 3 lines")) << with_short;
  EXPECT_NE(with_short.find("by 0.000707 m at most"), std::string::npos) << with_short;
  EXPECT_NE(with_short.find("leaves out 1 line shorter than that, 0.001 m in all"),
            std::string::npos)
      << with_short;
  body.merge = 0.0;
  EXPECT_EQ(merged_lines(body, near), "");
}

}  // namespace clean_lines_test
}  // namespace breccia::prepare
