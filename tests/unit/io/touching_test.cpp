// Files of contacts and walls: what they hold, in which order, and shapes of walls.

#include "io/vtu/touching.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/picture/picture.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "run/frames/wall_triangles.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace touching_test {

const FrameContact pair{3, 7, {0, 0, 1}, {0, 0, 2}, {0, 3, 4}};
const FrameContact earlier{2, 9, {1, 0, 1}, {1, 0, 2}, {1, 0, 0}};
const FrameContact on_ground{3, -1, {0, 0, 1}, {0, 0, 0}, {0, 0, -5}};
const FrameContact also_on_ground{4, -1, {2, 0, 1}, {2, 0, 0}, {0, 1, -6}};
const FrameContact on_ball{4, -2, {2, 0, 1}, {2, 1, 1}, {0, 8, 0}};

Frame model() {
  Frame frame;
  frame.time = 0.5;
  frame.position = {{0, 0, 1}, {2, 1, 2}};
  frame.walls = {{{0, 0, 0}, {0, 0, 1}}, {{2, 3, 1}, {0, 0, 1}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
  return frame;
}
Touching touching(std::vector<FrameContact> contacts) {
  Touching all{std::move(contacts), {}, false};
  all.around.add(model().position);
  all.sort();
  return all;
}

/// Area of triangles, and their centre by area.
double area_of(const std::vector<Vec3>& corners, Vec3* centre = nullptr) {
  double area = 0.0;
  Vec3 sum{};
  for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
    const double own = 0.5 * norm(cross(corners[k + 1] - corners[k], corners[k + 2] - corners[k]));
    area += own;
    sum += (own / 3.0) * (corners[k] + corners[k + 1] + corners[k + 2]);
  }
  if (centre != nullptr) *centre = (1.0 / area) * sum;
  return area;
}

TEST(Touching, contacts_are_lines_with_forces_by_ascending_ids) {
  const Frame one = contacts_frame(model(), touching({on_ground, pair, earlier}));
  const Frame other = contacts_frame(model(), touching({earlier, pair, on_ground}));
  EXPECT_EQ(contents_of(one).lines, contents_of(other).lines);
  EXPECT_EQ(one.time, 0.5);
  ASSERT_EQ(one.lines.size(), 6U);
  const auto values = [&](const char* name) {
    for (const FrameField& f : one.line_fields)
      if (f.name == name) return f.values;
    return std::vector<float>{};
  };
  EXPECT_EQ(values("force"), (std::vector<float>{1, 5, 5}));
  EXPECT_EQ(values("force_on_b"), (std::vector<float>{1, 0, 0, 0, 0, -5, 0, 3, 4}));
  EXPECT_EQ(values("a"), (std::vector<float>{2, 3, 3}));
  EXPECT_EQ(values("b"), (std::vector<float>{9, -1, 7}));
  EXPECT_EQ(values("wall"), (std::vector<float>{-1, 0, -1}));
}

TEST(Touching, walls_are_triangles_with_the_force_of_all_contacts) {
  const Frame walls = walls_frame(model(), touching({on_ground, pair, on_ball, also_on_ground}));
  ASSERT_EQ(walls.triangles.size(), 9U);  // two of the plane, one of the other
  const FrameField &number = walls.triangle_fields[0], &force = walls.triangle_fields[1];
  EXPECT_EQ(number.values, (std::vector<float>{0, 0, 1}));
  EXPECT_EQ(force.values, (std::vector<float>{0, 1, -11, 0, 1, -11, 0, 8, 0}));
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(walls.position[k].z, 0.0);
  Vec3 centre;
  area_of({walls.position.begin(), walls.position.begin() + 6}, &centre);
  EXPECT_NEAR(centre.x, 1.0, 1e-12);  // about the model
  EXPECT_NEAR(centre.y, 0.5, 1e-12);
}

TEST(Touching, no_points_are_around_nothing) {
  Around around;
  around.add(std::vector<Vec3>{{1, 2, 3}});
  around.add(Around{});
  EXPECT_EQ(around.low.x, 1.0);
  EXPECT_EQ(around.high.z, 3.0);
}

TEST(Touching, shapes_of_walls_have_their_areas) {
  dem::Wall wall{{1, 2, 3}, {0, 0.6, 0.8}, {}, 1.0, 0.0};
  EXPECT_TRUE(wall_triangles(wall).empty());
  wall.radius = 0.5;
  wall.length = 2.0;
  wall.along = {1, 0, 0};
  wall.half[0] = 0.3;
  wall.half[1] = 0.4;
  Vec3 centre;
  wall.shape = dem::WallShape::box;
  EXPECT_NEAR(area_of(wall_triangles(wall), &centre), 2 * (0.6 * 0.8 + 0.6 * 2 + 0.8 * 2), 1e-12);
  const Vec3 middle = wall.point - wall.normal;
  EXPECT_NEAR(norm(centre - middle), 0.0, 1e-12);
  const double round = 32.0 * std::sin(pi / 32.0) / pi;  // of 32 sides, over that of a circle
  wall.shape = dem::WallShape::cylinder;
  const double ends = 2.0 * 16.0 * std::sin(2.0 * pi / 32.0) * 0.25;
  EXPECT_NEAR(area_of(wall_triangles(wall), &centre), 2.0 * pi * 0.5 * 2.0 * round + ends, 1e-12);
  EXPECT_NEAR(norm(centre - middle), 0.0, 1e-12);
  wall.shape = dem::WallShape::cone;  // a slant of 0.5 and 1.2
  wall.half[0] = 1.2;
  EXPECT_NEAR(area_of(wall_triangles(wall), nullptr) / (pi * (0.5 * 1.3 + 0.8 + 0.25)), 1.0, 0.01);
  wall.shape = dem::WallShape::ogive;  // a hemisphere
  wall.half[0] = 0.5;
  EXPECT_NEAR(area_of(wall_triangles(wall), nullptr) / (pi * (0.5 + 1.5 + 0.25)), 1.0, 0.02);
  wall.shape = dem::WallShape::sphere;
  EXPECT_NEAR(area_of(wall_triangles(wall), &centre) / (pi * 1.0), 1.0, 0.02);
  EXPECT_NEAR(norm(centre - wall.point), 0.0, 1e-12);
}

TEST(Touching, a_series_lists_contacts_and_walls_and_goes_on_with_them) {
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return folder / name; };
  ParaviewSeries series(folder.path());
  const auto frame_at = [](double time) {
    Frame frame = model();
    frame.time = time;
    frame.radius = {0.5, 0.5};
    FrameContents files = contents_of(frame);
    add_touching(files, frame, touching({pair}), FrameFormat::vtu, 1);
    return files;
  };
  series.write(frame_at(0.0));
  series.write(frame_at(1.0));
  EXPECT_TRUE(std::filesystem::exists(file("fields/walls_0001.vtu")));
  ParaviewSeries later = ParaviewSeries::resumed(folder.path(), 0.5);
  EXPECT_FALSE(std::filesystem::exists(file("fields/contacts_0001.vtu")));
  later.write(frame_at(2.0));
  later.finish();
  for (const char* list : {"contacts.pvd", "walls.pvd", "result.pvd"})
    EXPECT_NE(read_whole_file(file(list)).find("timestep=\"2\""), std::string::npos) << list;
  const Frame read = read_frame(folder.path(), 1);
  ASSERT_EQ(read.walls.size(), 2U);
  EXPECT_EQ(read.walls[0].normal.z, 1.0);
  EXPECT_EQ(read.walls[1].corners.size(), 3U);
}

TEST(Touching, bolts_are_lines_with_forces_that_are_read_and_drawn) {
  const ScratchFolder folder;
  Frame frame = model();
  frame.radius = {0.5, 0.5};
  frame.bolted = true;
  ParaviewSeries series(folder.path());
  const auto write = [&](double time) {
    frame.time = time;
    FrameContents files = contents_of(frame);
    add_touching(files, frame, touching({}), FrameFormat::vtu, 1);
    series.write(files);
  };
  write(0.0);  // they come later
  frame.bars = {{{0, 0, 0}, {0, 0, 1}, 5.0F, 0.25F, 1e-3F, 0},
                {{0, 0, 1}, {1, 0, 1}, -2.5F, 0, 0, 1}};
  write(1.0);
  series.finish();
  EXPECT_NE(read_whole_file(folder / "bolts.pvd").find("bolts_0001.vtu"), std::string::npos);
  EXPECT_TRUE(read_frame(folder.path(), 0).bars.empty());
  const Frame read = read_frame(folder.path(), 1);
  ASSERT_EQ(read.bars.size(), 2U);
  EXPECT_EQ(read.bars[0].end.z, 1.0);
  EXPECT_EQ(read.bars[0].force, 5.0F);
  EXPECT_EQ(read.bars[0].across, 0.25F);
  EXPECT_EQ(read.bars[1].force, -2.5F);
  EXPECT_EQ(read.bars[1].bolt, 1);

  RenderOptions options;
  options.field = "";
  options.width = 64;
  options.height = 64;
  Frame bare = read;
  bare.bars.clear();
  EXPECT_NE(render(read, options).rgb, render(bare, options).rgb);
  options.walls = false;
  EXPECT_EQ(render(read, options).rgb, render(bare, options).rgb);
}

}  // namespace touching_test
}  // namespace breccia
