#include "io/vtu/paraview.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "exec/error.hpp"
#include "io/vtu/in_child.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "paths.hpp"
#include "unit/io/slab_scene.hpp"

namespace breccia {
namespace paraview_test {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at the end.
class ParaviewSeriesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder =
        (fs::temp_directory_path() / fmt::format("breccia_series_{}_{}", info->name(), getpid()))
            .string();
    fs::remove_all(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string folder;
};

Frame small_frame(double time, int count) {
  Frame frame;
  frame.time = time;
  frame.step = static_cast<std::int64_t>(1e6 * time);
  frame.groups = {"slab & <rock>", "ball"};
  FrameField damage{"damage", "-", 1, {}}, velocity{"velocity", "m/s", 3, {}};
  for (int i = 0; i < count; ++i) {
    frame.position.push_back({0.25 * i, -0.5 * i, 0.125});
    frame.radius.push_back(0.0625);
    damage.values.push_back(0.5F * static_cast<float>(i));
    for (const float v : {1.0F, -2.0F, static_cast<float>(i)}) velocity.values.push_back(v);
  }
  std::vector<std::int32_t> kinds, ids;
  for (int i = 0; i < count; ++i)
    ids.push_back((1 << 24) + 1 + i);  // no float is the first of them
  FrameField force{"force", "N", 1, {}};
  for (int i = 0; i + 1 < count; ++i) {
    frame.lines.insert(frame.lines.end(), {i, i + 1});
    kinds.push_back(i % 3);
    force.values.push_back(-100.0F * static_cast<float>(i));
  }
  frame.point_fields = {damage, velocity, whole_numbers("id", ids)};
  frame.line_fields = {whole_numbers("kind", kinds), force};
  return frame;
}

Frame triangle_frame(double time) {
  Frame frame = small_frame(time, 4);
  frame.radius.clear();
  frame.triangles = {0, 1, 2, 1, 2, 3};
  frame.triangle_fields = {{"stress_xx", "Pa", 1, {1, 2}},
                           {"stress_yy", "Pa", 1, {3, 4}},
                           {"stress_zz", "Pa", 1, {7, 8}},
                           {"stress_xy", "Pa", 1, {5, 6}},
                           whole_numbers("group", {0, 1})};
  return frame;
}

/// Two tetrahedra on either side of a joint.
Frame solid_frame(double time) {
  Frame frame = small_frame(time, 11);
  frame.radius.clear();
  frame.lines.clear();
  frame.line_fields.clear();
  frame.tetrahedra = {0, 1, 2, 3, 4, 5, 6, 7};
  frame.triangles = {8, 9, 10};
  const char* const names[] = {"stress_xx", "stress_yy", "stress_zz",
                               "stress_xy", "stress_yz", "stress_xz"};
  for (int k = 0; k < 6; ++k)
    frame.tetrahedron_fields.push_back(
        {names[k], "Pa", 1, {static_cast<float>(k), static_cast<float>(10 + k)}});
  frame.tetrahedron_fields.push_back({"pressure", "Pa", 1, {-1, 2.5}});
  frame.tetrahedron_fields.push_back(whole_numbers("exposed", {15, 7}));
  frame.triangle_fields = {{"mode", "-", 1, {0.25}}, {"time", "s", 1, {1e-3F}}};
  return frame;
}

nlohmann::json fields_json(const std::vector<FrameField>& fields) {
  nlohmann::json result = nlohmann::json::object();
  for (const FrameField& field : fields) {
    float low = 0.0F, high = 0.0F;
    for (std::size_t i = 0; i < field.values.size();
         i += static_cast<std::size_t>(field.components)) {
      low = i == 0 ? field.values[i] : std::min(low, field.values[i]);
      high = i == 0 ? field.values[i] : std::max(high, field.values[i]);
    }
    nlohmann::json& found = result[field.name];
    found = {field.components, field.unit, low, high, field.integers ? "int" : "float"};
    if (field.integers && !field.integers->empty()) {  // exact, however large
      const auto [least, most] =
          std::minmax_element(field.integers->begin(), field.integers->end());
      found[2] = *least;
      found[3] = *most;
    }
  }
  return result;
}

/// Numbers that VTK must find in a series of these frames.
std::string expectation(const std::vector<Frame>& frames) {
  nlohmann::json list = nlohmann::json::array();
  for (const Frame& frame : frames) {
    std::vector<FrameField> point_fields = frame.point_fields;
    if (!frame.radius.empty()) {
      point_fields.push_back({"radius", "m", 1, {frame.radius.begin(), frame.radius.end()}});
    }
    const bool solid = !frame.tetrahedra.empty();
    const bool triangles = !solid && !frame.triangles.empty();
    const std::size_t cells = solid       ? frame.tetrahedra.size() / 4
                              : triangles ? frame.triangles.size() / 3
                                          : frame.position.size();
    list.push_back(
        {{"time", frame.time},
         {"step", frame.step},
         {"groups", frame.groups},
         {"points", frame.position.size()},
         {"cells", cells},
         {"cell_type", solid       ? 10
                       : triangles ? 5
                                   : 1},
         {"links", solid ? frame.triangles.size() / 3 : frame.lines.size() / 2},
         {"link_type", solid ? 5 : 3},
         {"point_fields", fields_json(point_fields)},
         {"line_fields", fields_json(solid ? frame.triangle_fields : frame.line_fields)}});
  }
  return list.dump();
}

void expect_vtk_reads(const std::string& folder, const std::vector<Frame>& frames) {
  replace_file(folder + "/expected.json", expectation(frames));
  const std::string command = fmt::format(
      "/usr/bin/python3 '{0}/tests/unit/io/read_with_vtk.py' '{1}' '{1}/expected.json' 2>&1",
      source_dir, folder);
  std::string said;
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char buffer[512];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) said += buffer;
  EXPECT_EQ(pclose(pipe), 0) << said << "(package python3-vtk9 must be installed)";
}

void expect_same_fields(const std::vector<FrameField>& a, const std::vector<FrameField>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].unit, b[i].unit);
    EXPECT_EQ(a[i].components, b[i].components);
    EXPECT_EQ(a[i].values, b[i].values);
    EXPECT_EQ(a[i].integers, b[i].integers);
  }
}

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.groups, b.groups);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  ASSERT_EQ(a.position.size(), b.position.size());
  ASSERT_EQ(a.radius.size(), b.radius.size());
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    EXPECT_EQ(static_cast<float>(a.position[i].x), static_cast<float>(b.position[i].x));
    EXPECT_EQ(static_cast<float>(a.position[i].y), static_cast<float>(b.position[i].y));
    EXPECT_EQ(static_cast<float>(a.position[i].z), static_cast<float>(b.position[i].z));
  }
  for (std::size_t i = 0; i < a.radius.size(); ++i) {
    EXPECT_EQ(static_cast<float>(a.radius[i]), static_cast<float>(b.radius[i]));
  }
  expect_same_fields(a.point_fields, b.point_fields);
  expect_same_fields(a.line_fields, b.line_fields);
  expect_same_fields(a.triangle_fields, b.triangle_fields);
  expect_same_fields(a.tetrahedron_fields, b.tetrahedron_fields);
}

TEST_F(ParaviewSeriesTest, vtk_reads_every_field_count_and_time_with_and_without_links) {
  Frame without_links = small_frame(3e-4, 5);
  without_links.lines.clear();
  for (FrameField& field : without_links.line_fields) {
    field.values.clear();
    if (field.integers) field.integers->clear();
  }
  const std::vector<Frame> frames{small_frame(0.0, 7), without_links, small_frame(1.0 / 3.0, 1),
                                  small_frame(0.5, 0)};
  ParaviewSeries series(folder);
  for (const Frame& frame : frames) series.write(frame);
  expect_vtk_reads(folder, frames);
}

TEST_F(ParaviewSeriesTest, vtk_reads_the_full_slab_and_frames_of_triangles_and_tetrahedra) {
  const std::vector<Frame> frames{triangle_frame(0.0), solid_frame(1e-5), test::slab_scene()};
  ParaviewSeries series(folder);
  for (const Frame& frame : frames) series.write(frame);
  expect_vtk_reads(folder, frames);
}

TEST_F(ParaviewSeriesTest, meshio_reads_every_field_with_its_type) {
  Frame alone = triangle_frame(0.25);
  alone.point_fields.front().values.front() = -7.5F;
  ParaviewSeries series(folder);
  series.write(alone);
  const std::string command = fmt::format(
      "/usr/bin/python3 '{0}/tests/unit/io/read_with_meshio.py' '{1}' 2>&1", source_dir, folder);
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(ParaviewSeriesTest, meshio_reads_tetrahedra_and_their_joints) {
  ParaviewSeries(folder).write(solid_frame(0.25));
  const std::string command =
      fmt::format("/usr/bin/python3 '{0}/tests/unit/io/read_with_meshio.py' '{1}' solid 2>&1",
                  source_dir, folder);
  EXPECT_EQ(std::system(command.c_str()), 0);
}

/// VTK sees the end of this tag in time, whether or not expat puts off what is not whole: see
/// vtu_writer.cpp. Debian 12's own ParaView refused every file without it.
TEST_F(ParaviewSeriesTest, the_tag_of_the_data_is_where_readers_see_it) {
  for (int count = 0; count < 40; ++count) {
    Frame frame = small_frame(0.1, count);
    frame.groups.push_back(std::string(static_cast<std::size_t>(97 * count), 'x'));
    const FrameContents files = contents_of(frame, 1, FrameFormat::vtu);
    for (const std::string& file : {files.points, files.lines}) {
      const std::string name = "<AppendedData";
      const std::size_t at = file.find(name), end = file.find('>', at);
      EXPECT_EQ((at + name.size()) % 4096, 0U);
      EXPECT_GE(end - at, 42U);
      EXPECT_LE(end - at, 49U);
      EXPECT_EQ(file.substr(end - 5, 8), "\"raw\">\n_");  // as meshio wants it
    }
  }
}

TEST_F(ParaviewSeriesTest, what_was_written_is_read_back) {
  const std::vector<Frame> frames{small_frame(0.0, 9), small_frame(0.1, 0), triangle_frame(0.2),
                                  solid_frame(0.3), test::slab_scene()};
  for (const Frame& frame : frames) {
    fs::remove_all(folder);
    ParaviewSeries series(folder);
    series.write(frame);
    EXPECT_EQ(frame_times(folder), std::vector<double>{frame.time});
    expect_same(read_frame(folder, 0), frame);
  }
}

TEST_F(ParaviewSeriesTest, vtkhdf_is_read_back_and_resumed) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  Frame with_walls = small_frame(0.1, 3);
  with_walls.walls = {{{0.0, 0.0, -0.5}, {0.0, 0.0, 1.0}}, {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}};
  std::vector<Frame> frames{small_frame(0.0, 9), with_walls, triangle_frame(0.2), solid_frame(0.3),
                            test::slab_scene()};
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].time = 0.1 * static_cast<double>(i);
  {
    ParaviewSeries series(folder, FrameFormat::vtkhdf);
    for (const Frame& frame : frames) series.write(frame);
    expect_vtk_reads(folder, frames);
    frames.push_back(small_frame(0.5, 0));  // VTK lists no fields of a grid without points
    series.write(frames.back());
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame found = read_frame(folder, static_cast<int>(i));
    expect_same(found, frames[i]);
    EXPECT_EQ(found.walls.size(), frames[i].walls.size());
  }
  EXPECT_EQ(read_frame(folder, 1).walls[1].normal.x, -1.0);
  ParaviewSeries series = ParaviewSeries::resumed(folder, 0.15, FrameFormat::vtkhdf);
  EXPECT_EQ(frame_times(folder).size(), 2U);
  EXPECT_FALSE(fs::exists(folder + "/fields/links_0002.hdf"));
  series.write(triangle_frame(0.25));
  EXPECT_EQ(frame_times(folder), (std::vector<double>{0.0, 0.1, 0.25}));
}

TEST_F(ParaviewSeriesTest, vtkhdf_has_the_same_bytes_from_any_threads_and_each_time) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  const Frame slab = test::slab_scene();
  const FrameContents once = contents_of(slab, 1, FrameFormat::vtkhdf);
  const std::string scratch(3 << 20, 'x');  // memory that was used differs
  const FrameContents again = contents_of(slab, 3, FrameFormat::vtkhdf);
  EXPECT_TRUE(once.points == again.points);
  EXPECT_TRUE(once.lines == again.lines);
}

TEST_F(ParaviewSeriesTest, a_damaged_vtkhdf_is_refused_with_its_path) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  ParaviewSeries series(folder, FrameFormat::vtkhdf);
  series.write(small_frame(0.0, 200));
  const std::string path = folder + "/fields/elements_0000.hdf";
  const std::string whole = read_whole_file(path);
  int refused = 0;
  for (std::size_t place = 0; place < whole.size(); place += 1009) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
    std::ofstream(path, std::ios::binary) << damaged;
    try {
      read_frame(folder, 0);
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
  for (const std::size_t size : {std::size_t{0}, whole.size() / 3, whole.size() / 2}) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(read_frame(folder, 0), IoError) << size;
  }
}

// Files that ended HDF5 1.10.8 by a signal, or had it write beyond what it was given, as the fuzzer
// found.
TEST_F(ParaviewSeriesTest, forged_vtkhdf_files_are_refused_with_their_path) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  ParaviewSeries series(folder, FrameFormat::vtkhdf);
  series.write(small_frame(0.0, 3));
  const std::string path = folder + "/fields/elements_0000.hdf";
  for (const auto& forged :
       fs::directory_iterator(source_dir + std::string("/tests/attack/corpus/vtkhdf"))) {
    fs::copy_file(forged, path, fs::copy_options::overwrite_existing);
    try {
      read_frame(folder, 0);
      ADD_FAILURE() << forged << " was read";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(folder + "/fields/"), std::string::npos);
    }
  }
}
TEST(InChild, answers_unless_a_signal_or_an_error_ended_it) {
  int here = 0;
  const auto long_one = [&] {
    here = 1;
    return std::string(1 << 20, 'x');
  };
  EXPECT_EQ(answer_of_child(long_one), std::string(1 << 20, 'x'));
  EXPECT_EQ(here, 0);
  EXPECT_EQ(answer_of_child([] { return std::string(); }), "");
  EXPECT_FALSE(answer_of_child([]() -> std::string { throw std::runtime_error("an error"); }));
  EXPECT_FALSE(answer_of_child([]() -> std::string {
    ::raise(SIGKILL);
    return "";
  }));
}

TEST_F(ParaviewSeriesTest, a_resumed_series_drops_what_came_after_and_goes_on) {
  {
    ParaviewSeries series(folder);
    for (const double time : {0.0, 0.1, 0.2, 0.3}) series.write(small_frame(time, 3));
  }
  ParaviewSeries series = ParaviewSeries::resumed(folder, 0.15);
  EXPECT_EQ(frame_times(folder), (std::vector<double>{0.0, 0.1}));
  EXPECT_FALSE(fs::exists(folder + "/fields/elements_0003.vtu"));
  series.write(small_frame(0.25, 4));
  expect_vtk_reads(folder, {small_frame(0.0, 3), small_frame(0.1, 3), small_frame(0.25, 4)});
  EXPECT_EQ(read_frame(folder, 2).position.size(), 4U);
}

TEST_F(ParaviewSeriesTest, a_frame_at_a_time_already_written_replaces_it) {
  ParaviewSeries series(folder);
  series.write(small_frame(0.0, 3));
  series.write(small_frame(0.1, 3));
  ParaviewSeries again = ParaviewSeries::resumed(folder, 0.1);
  again.write(small_frame(0.1, 5));
  EXPECT_EQ(frame_times(folder), (std::vector<double>{0.0, 0.1}));
  EXPECT_EQ(read_frame(folder, 1).position.size(), 5U);
}

TEST_F(ParaviewSeriesTest, resuming_a_folder_without_a_series_starts_one) {
  ParaviewSeries series = ParaviewSeries::resumed(folder, 1.0);
  series.write(small_frame(2.0, 2));
  EXPECT_EQ(frame_times(folder), std::vector<double>{2.0});
}

TEST_F(ParaviewSeriesTest, many_frames_are_listed_from_time_to_time_and_all_in_the_end) {
  ParaviewSeries series(folder);
  const Frame frame = small_frame(0.0, 1);
  std::size_t listings = 0, listed = 0;
  for (std::size_t n = 1; n <= 1500; ++n) {
    Frame next = frame;
    next.time = 1e-3 * static_cast<double>(n);
    series.write(next);
    const bool few = n <= 200, look = few || n % 100 == 0;
    if (!look) continue;
    const std::size_t now = frame_times(folder).size();
    ASSERT_LE(now, n);
    ASSERT_TRUE(now == n || !few);  // at once, as long as there are few
    listings += now == n && !few;
    listed = now;
  }
  EXPECT_LT(listings, 7U);  // of 13 looks; each frame rewrote the list of all
  EXPECT_GT(listed, 200U);
  series.finish();
  EXPECT_EQ(frame_times(folder), series.times());
  EXPECT_EQ(series.times().size(), 1500U);
  EXPECT_EQ(read_frame(folder, 1499).time, 1.5);
}

TEST_F(ParaviewSeriesTest, a_frame_that_does_not_exist_is_bad_input) {
  ParaviewSeries series(folder);
  series.write(small_frame(0.0, 2));
  EXPECT_THROW(read_frame(folder, 1), InputError);
  EXPECT_THROW(read_frame(folder, -1), InputError);
  EXPECT_THROW(frame_times(folder + "/nowhere"), IoError);
}

TEST_F(ParaviewSeriesTest, a_damaged_or_shortened_file_is_refused_with_its_path) {
  ParaviewSeries series(folder);
  series.write(small_frame(0.0, 200));
  const std::string path = folder + "/fields/elements_0000.vtu";
  const std::string whole = read_whole_file(path);
  int refused = 0, unharmed = 0;
  for (std::size_t place = 0; place < whole.size(); place += 37) {
    if (whole[place] == ' ') continue;  // before the data: nothing hangs on it
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
    std::ofstream(path, std::ios::binary) << damaged;
    try {
      read_frame(folder, 0);
      ++unharmed;  // a name or a unit
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, unharmed);
  for (const std::size_t size : {std::size_t{0}, whole.size() / 3, whole.size() / 2}) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(read_frame(folder, 0), IoError) << size;
  }
}

TEST_F(ParaviewSeriesTest, a_folder_that_cannot_be_made_is_an_error_with_its_path) {
  replace_file(folder, "a file stands here");
  try {
    ParaviewSeries series(folder);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find(folder), std::string::npos);
  }
}

}  // namespace paraview_test
}  // namespace breccia
