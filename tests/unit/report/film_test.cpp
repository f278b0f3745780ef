// A film read back: what the page will see.

#include "report/film.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "exec/error.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/touching.hpp"
#include "report/thinning.hpp"
#include "texts.hpp"
#include "unit/io/slab_scene.hpp"
#include "unit/io/solid_scene.hpp"
#include "unit/report/result_scene.hpp"
#include "unit/report/unpacked.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::report {
namespace film_test {

using Json = nlohmann::json;

test::PlaneReader opened(const Film& film, std::size_t frame) {
  return test::PlaneReader(test::inflated(test::from_base64(film.blobs.at(frame))));
}

TEST(Film, SpheresComeBackToHalfAStep) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const Survey survey = survey_of(folder.path(), 3);
  const Film film = film_of(folder.path(), survey, 5, 10'000'000);
  const Json json = parsed_json(film.json);
  ASSERT_EQ(film.blobs.size(), 3U);
  EXPECT_EQ(json["frames"][2]["blob"], 7);
  EXPECT_EQ(json["frames"][2]["step"], 20);
  ASSERT_EQ(json["width"], 2);

  const double step = json["step"];
  EXPECT_LT(step, 1e-5);
  const auto place = [&](std::uint32_t steps, int axis) {
    return json["low"][static_cast<std::size_t>(axis)].get<double>() + step * steps;
  };
  test::PlaneReader first = opened(film, 0), last = opened(film, 2);
  const Frame at_first = test::chain_frame(0, 8, 2), at_last = test::chain_frame(2, 8, 2);
  for (int axis = 0; axis < 3; ++axis) {
    const auto start = first.numbers(8, 2), moved = last.numbers(8, 2);
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec3 a = at_first.position[i], b = at_last.position[i];
      const auto now = static_cast<std::uint32_t>(
                           start[i] + static_cast<std::uint32_t>(test::unzigzag(moved[i]))) &
                       0xffffU;
      EXPECT_NEAR(place(start[i], axis), axis == 0 ? a.x : axis == 1 ? a.y : a.z, 0.51 * step);
      EXPECT_NEAR(place(now, axis), axis == 0 ? b.x : axis == 1 ? b.y : b.z, 0.51 * step);
    }
  }
  const auto radius = first.numbers(8, 2);
  EXPECT_NEAR(radius[3] * json["largest_radius"].get<double>() / 65535.0, 0.01, 1e-6);
}

TEST(Film, WhatStaysAlikeIsToldOnce) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const Survey survey = survey_of(folder.path(), 3);
  EXPECT_TRUE(survey.lines_constant);
  const Json json = parsed_json(film_of(folder.path(), survey, 0, 10'000'000).json);
  EXPECT_EQ(json["frames"][0]["ends"], true);
  EXPECT_EQ(json["frames"][1]["ends"], false);
  for (const Json& field : json["fields"])
    EXPECT_EQ(field["constant"],
              field["name"] == "velocity" || field["name"] == "group" || field["name"] == "kind")
        << field;
}

TEST(Film, EveryByteOfAFrameHasItsPlace) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const Film film = film_of(folder.path(), survey_of(folder.path(), 3), 0, 10'000'000);
  test::PlaneReader last = opened(film, 2);
  last.numbers(3 * 8, 2);                 // positions
  EXPECT_EQ(last.numbers(8, 1)[0], 64U);  // damage: 0.25 of 255 steps
  EXPECT_EQ(last.numbers(7, 1)[3], 2U);   // state: the link in the middle
  last.numbers(7, 1);                     // force
  EXPECT_TRUE(last.at_end());
}

TEST(Film, TheStrongestContactsComeFirstWithBothEnds) {
  const ScratchFolder folder;
  Frame frame = test::chain_frame(0, 8, 2);
  ParaviewSeries series(folder.path(), FrameFormat::vtu);
  FrameContents files = contents_of(frame, 1, FrameFormat::vtu);
  const Vec3 low = frame.position.front(), high = frame.position.back();
  add_touching(files, frame, {{{0, 7, low, high, {3, 0, 4}}, {1, -1, high, low, {0, 0, -20}}}, {}},
               FrameFormat::vtu, 1);
  series.write(files);
  series.finish();
  const Survey survey = survey_of(folder.path(), 1);
  EXPECT_EQ(survey.contacts, 2U);
  EXPECT_EQ(survey.contact_force, 20.0);
  const Film film = film_of(folder.path(), survey, 0, 10'000'000);
  const Json json = parsed_json(film.json);
  EXPECT_EQ(json["contact_force"], 20.0);
  ASSERT_EQ(json["frames"][0]["contacts"], 2);
  const std::string bytes = test::inflated(test::from_base64(film.blobs.at(0)));
  // The last of a frame: three axes of four ends in two bytes each, and a byte of force.
  test::PlaneReader reader(bytes.substr(bytes.size() - 3 * 4 * 2 - 2));
  const auto x = reader.numbers(4, 2);
  const double step = json["step"], from = json["low"][0];
  EXPECT_NEAR(from + step * x[0], high.x, step);
  EXPECT_NEAR(from + step * x[1], low.x, step);
  EXPECT_NEAR(from + step * x[2], low.x, step);
  reader.numbers(4, 2);
  reader.numbers(4, 2);
  const auto force = reader.numbers(2, 1);
  EXPECT_EQ(force[0], 63U);
  EXPECT_NEAR(std::pow(force[1] / 63.0, 2.0), 0.25, 0.01);
}

TEST(Film, BoltsComeWithBothEndsAndTheirForce) {
  const ScratchFolder folder;
  Frame frame = test::chain_frame(0, 8, 2);
  const Vec3 low = frame.position.front(), high = frame.position.back();
  frame.bolted = true;
  frame.bars = {{low, high, 40.0F, 0.0F, 0.0F, 0}, {high, low, -10.0F, 0.0F, 0.0F, 1}};
  ParaviewSeries series(folder.path(), FrameFormat::vtu);
  FrameContents files = contents_of(frame, 1, FrameFormat::vtu);
  add_touching(files, frame, {}, FrameFormat::vtu, 1);
  series.write(files);
  series.finish();
  const Survey survey = survey_of(folder.path(), 1);
  EXPECT_EQ(survey.bolts, 2U);
  const Film film = film_of(folder.path(), survey, 0, 10'000'000);
  const Json json = parsed_json(film.json);
  EXPECT_EQ(json["bolt_force"], 40.0);
  ASSERT_EQ(json["frames"][0]["bolts"], 2);
  const std::string bytes = test::inflated(test::from_base64(film.blobs.at(0)));
  test::PlaneReader reader(bytes.substr(bytes.size() - 3 * 4 * 2 - 2));
  const auto x = reader.numbers(4, 2);
  const double step = json["step"], from = json["low"][0];
  EXPECT_NEAR(from + step * x[0], low.x, step);
  EXPECT_NEAR(from + step * x[1], high.x, step);
  EXPECT_NEAR(from + step * x[2], high.x, step);
  reader.numbers(4, 2);
  reader.numbers(4, 2);
  const auto force = reader.numbers(2, 1);
  EXPECT_EQ(force[0], 254U);
  EXPECT_NEAR(force[1] / 127.0 - 1.0, -0.25, 0.01);
}

TEST(Film, CornersThatPartComeBackFromTheirLeader) {
  const ScratchFolder folder;
  ParaviewSeries series(folder.path());
  series.write(test::pair_frame(0, 0.0));
  series.write(test::pair_frame(1, 0.01));
  series.finish();
  const Survey survey = survey_of(folder.path(), 2);
  EXPECT_TRUE(survey.plane);
  const Film film = film_of(folder.path(), survey, 0, 10'000'000);
  const Json json = parsed_json(film.json);
  ASSERT_EQ(json["width"], 3);
  const double step = json["step"], low = json["low"][0];
  const auto start = opened(film, 0).numbers(6, 3);
  const auto told = opened(film, 1).numbers(6, 3);
  // Corners 3 and 5 began where 1 and 2 did, which did not move.
  const double gap = 0.01;
  for (const auto& [corner, leader] :
       {std::pair<std::size_t, std::size_t>{3, 1}, {5, 2}, {4, 4}, {1, 1}}) {
    const double moved = test::unzigzag(told[corner]) * step;
    EXPECT_NEAR(moved, corner == 1 ? 0.0 : gap, 2.0 * step) << corner << " after " << leader;
  }
  EXPECT_NEAR(low + step * start[4], 0.1, 0.6 * step);
}

/// A block of tetrahedra that a crack parts.
Frame solid_frame(int k) {
  solid_scene::Block block(4, 2, 2);
  block.add_field("damage", "-", [](Vec3) { return 0.0; });
  block.add_numbers("group", [](Vec3) { return 0; });
  if (k > 0) block.crack(2.0, [](Vec3) { return 0.25; }, {0.02, 0.01, 0.03});
  FrameField velocity{"velocity", "m/s", 3, std::vector<float>(3 * block.frame.position.size())};
  for (std::size_t i = 0; i < velocity.values.size(); i += 3) velocity.values[i] = 2.0F;
  block.frame.point_fields = {velocity};
  if (k == 0) block.frame.triangle_fields = {{"mode", "-", 1, {}}, {"damage", "-", 1, {}}};
  block.frame.groups = {"rock"};
  block.frame.time = 1e-3 * k;
  return block.frame;
}

TEST(Film, TetrahedraComeBackWithTheirJoints) {
  const ScratchFolder folder;
  ParaviewSeries series(folder.path());
  for (int k = 0; k < 2; ++k) series.write(solid_frame(k));
  series.finish();
  const Survey survey = survey_of(folder.path(), 2);
  EXPECT_TRUE(survey.solid);
  EXPECT_EQ(survey.elements, 96U);
  const Film film = film_of(folder.path(), survey, 0, 10'000'000);
  const Json json = parsed_json(film.json);
  EXPECT_EQ(json["solid"], true);
  EXPECT_EQ(json["plane"], false);
  ASSERT_EQ(json["width"], 3);
  const double step = json["step"];
  const Frame last = solid_frame(1);
  const std::size_t points = last.tetrahedra.size();
  test::PlaneReader a = opened(film, 0), b = opened(film, 1);
  std::vector<std::vector<std::uint32_t>> start, told, now(3);
  for (int axis = 0; axis < 3; ++axis) start.push_back(a.numbers(points, 3));
  for (int axis = 0; axis < 3; ++axis) told.push_back(b.numbers(points, 3));
  std::size_t followers = 0;
  for (std::size_t i = 0; i < points; ++i) {
    std::size_t leader = 0;
    while (start[0][leader] != start[0][i] || start[1][leader] != start[1][i] ||
           start[2][leader] != start[2][i])
      ++leader;
    followers += leader != i ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto moved = static_cast<std::uint32_t>(test::unzigzag(told[axis][i]));
      const std::uint32_t with = leader == i ? 0 : now[axis][leader] - start[axis][leader];
      now[axis].push_back((start[axis][i] + moved + with) & 0xffffffU);
      const Vec3& p = last.position[i];
      const double place = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      EXPECT_NEAR(json["low"][axis].get<double>() + step * now[axis][i], place, 0.6 * step + 1e-6);
    }
  }
  EXPECT_EQ(followers, points - 5 * 3 * 3);  // one leads at each corner of the grid
  // exposed changes; damage, group and velocity do not. Then joints: corners, mode, damage.
  std::vector<std::string> changing;
  for (const Json& field : json["fields"])
    if (!field["constant"]) changing.push_back(field["name"]);
  EXPECT_EQ(changing, (std::vector<std::string>{"exposed", "mode", "damage", "time"}));
  const auto exposed = b.numbers(96, 1);
  const FrameField& wanted = last.tetrahedron_fields[0];
  for (std::size_t t = 0; t < 96; ++t) EXPECT_EQ(static_cast<float>(exposed[t]), wanted.values[t]);
  ASSERT_EQ(json["frames"][1]["lines"], 8);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto corners = b.numbers(24, 3);
    for (std::size_t i = 0; i < 24; ++i) {
      const Vec3& p = last.position[static_cast<std::size_t>(last.triangles[i])];
      EXPECT_NEAR(json["low"][axis].get<double>() + step * corners[i],
                  axis == 0   ? p.x
                  : axis == 1 ? p.y
                              : p.z,
                  0.6 * step + 1e-6);
    }
  }
  b.numbers(8, 1);
  b.numbers(8, 1);
  b.numbers(8, 1);
  EXPECT_TRUE(b.at_end());
}

TEST(Film, TetrahedraWithinGoBeforeThoseWithExposedFaces) {
  const ScratchFolder folder;
  solid_scene::Block block(8, 8, 8);
  block.add_field("damage", "-", [](Vec3) { return 0.0; });
  block.add_numbers("group", [](Vec3) { return 0; });
  ParaviewSeries series(folder.path());
  series.write(block.frame);
  series.finish();
  const std::vector<std::uint32_t> visible = visible_elements(survey_of(folder.path(), 1));
  EXPECT_EQ(visible.size(), 6U * 64U * 2U - 6U * 8U);  // two a square; some have two faces
}

TEST(Film, AFilmStaysUnderItsLimit) {
  const ScratchFolder folder;
  ParaviewSeries series(folder.path());
  Frame frame = test::slab_scene();
  for (int k = 0; k < 4; ++k) {
    frame.time = 1e-3 * k;
    frame.step = k;
    for (Vec3& p : frame.position) p.z += 1e-4 * p.x;
    for (float& v : frame.point_fields.front().values) v *= 0.9F;
    series.write(frame);
  }
  series.finish();
  const Survey survey = survey_of(folder.path(), 4);
  const Film whole = film_of(folder.path(), survey, 0, 20'000'000);
  EXPECT_TRUE(whole.notes.empty());
  std::size_t before = whole.bytes();
  for (const std::size_t limit : {120'000, 90'000, 60'000, 30'000}) {
    const Film film = film_of(folder.path(), survey, 0, limit);
    EXPECT_LE(film.bytes(), limit);
    EXPECT_LE(film.bytes(), before);
    EXPECT_FALSE(film.notes.empty());
    const Json json = parsed_json(film.json);
    EXPECT_EQ(json["frames"].front()["number"], 0);
    EXPECT_EQ(json["frames"].back()["number"], 3);
    before = film.bytes();
  }
}

TEST(Film, WhatPacksBetterThanThoughtIsNotLeftOut) {
  const ScratchFolder folder;
  test::write_chain(folder.path(), 4000, 9);
  const Survey survey = survey_of(folder.path(), 3);
  const double thought = Selection::whole(survey).estimate(survey);
  const Film all = film_of(folder.path(), survey, 0, 100'000'000);
  ASSERT_LT(4.0 * static_cast<double>(all.bytes()), thought);
  const Film film = film_of(folder.path(), survey, 0, static_cast<std::size_t>(thought / 1.05));
  EXPECT_EQ(film.bytes(), all.bytes());
}

TEST(Film, ElementsThatNobodySeesGoBeforeOthers) {
  const ScratchFolder folder;
  ParaviewSeries series(folder.path());
  Frame cube;
  cube.groups = {"cube"};
  FrameField group{"group", "-", 1, {}}, damage{"damage", "-", 1, {}};
  constexpr int n = 20;
  for (int i = 0; i < n * n * n; ++i) {
    cube.position.push_back({0.02 * (i % n), 0.02 * (i / n % n), 0.02 * (i / n / n)});
    cube.radius.push_back(0.01);
    group.values.push_back(0.0F);
    damage.values.push_back(i == n * n * n / 2 + n * n / 2 + n / 2 ? 1.0F : 0.0F);
  }
  cube.point_fields = {group, damage};
  series.write(cube);
  series.finish();
  const Survey survey = survey_of(folder.path(), 1);
  const std::vector<std::uint32_t> visible = visible_elements(survey);
  std::size_t faces = 0;
  for (const std::uint32_t i : visible)
    for (const double c : {cube.position[i].x, cube.position[i].y, cube.position[i].z})
      if (c < 0.001 || c > 0.379) {
        ++faces;
        break;
      }
  EXPECT_EQ(faces, static_cast<std::size_t>(n * n * n - (n - 2) * (n - 2) * (n - 2)));
  EXPECT_LT(visible.size(), cube.position.size() * 7 / 10);
  EXPECT_TRUE(std::find(visible.begin(), visible.end(), n * n * n / 2 + n * n / 2 + n / 2) !=
              visible.end());
}

TEST(Film, BodiesThatAStageTakesOutShowNothingMore) {
  for (const bool plane : {false, true}) {
    Shot first, later;
    first.plane = later.plane = plane;
    const std::size_t each = plane ? 3 : 1;
    FrameField group{"group", "-", 1, {0, 1, 1, 2}}, size{"size", "m", 1, {1, 2, 3, 4}};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t c = 0; c < each; ++c)
        first.corner.push_back({double(i), 0.25 * double(c), 0.0});
      if (!plane) first.radius.push_back(0.1 * double(i + 1));
    }
    first.element_fields = {group, size};
    later = first;  // without the second body
    const auto begin = static_cast<std::ptrdiff_t>(each),
               end = static_cast<std::ptrdiff_t>(3 * each);
    later.corner.erase(later.corner.begin() + begin, later.corner.begin() + end);
    if (!plane) later.radius = {0.1, 0.4};
    if (!plane) later.ends = {0, 1};
    later.element_fields[0].values = {0, 2};
    later.element_fields[1].values = {1.5F, 4.5F};
    ASSERT_TRUE(match(later, first));
    ASSERT_EQ(later.elements(), 4U);
    EXPECT_EQ(later.corner[0].x, 0.0);
    EXPECT_EQ(later.corner[3 * each].x, 3.0);
    EXPECT_EQ(later.element_fields[1].values[0], 1.5F);
    EXPECT_EQ(later.element_fields[1].values[3], 4.5F);
    if (plane) {
      EXPECT_EQ(later.corner[3].y, later.corner[5].y);  // no area
      continue;
    }
    EXPECT_EQ(later.corner[1].x, 3.0);  // inside the largest
    EXPECT_EQ(later.radius[2], 0.0);
    EXPECT_EQ(later.ends, (std::vector<std::int32_t>{0, 3}));
    later.element_fields[0].values = {0, 1};  // half a body
    later.corner.resize(2);
    EXPECT_FALSE(match(later, first));
  }
}

TEST(Film, FramesOfOtherElementsAreRefused) {
  const ScratchFolder folder;
  ParaviewSeries series(folder.path());
  series.write(test::chain_frame(0, 8, 9));
  series.write(test::chain_frame(1, 7, 9));
  series.finish();
  EXPECT_THROW(survey_of(folder.path(), 2), IoError);
}

}  // namespace film_test
}  // namespace breccia::report
