// Frames that ranks make together have the bytes of those that one process makes.

#include <gtest/gtest.h>

#include <map>

#include "core/state_hash.hpp"
#include "fdem/setup/mesh_edges.hpp"
#include "mpi/on_ranks.hpp"
#include "run/frames/frame_parts.hpp"

namespace breccia {
namespace frames_test {

using namespace mpi_testing;

FrameWish wish_for(const std::string& field) {
  FrameWish wish;
  RenderOptions& picture = wish.picture.emplace();
  picture.field = field;
  picture.width = 160;
  picture.height = 120;
  return wish;
}

/// Bytes of a frame's files and picture.
struct Made {
  std::string points, lines, contacts, walls, png;
  double time = 0.0;
  Extent extent{};
};
Made made_of(FrameOutput output) {
  const FrameContents& files = output.files;
  return {files.points, files.lines, files.contacts, files.walls,
          output.png,   files.time,  output.extent};
}
void expect_same(const std::vector<Made>& a, const std::vector<Made>& b, const std::string& where) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {  // no diff of binary files
    EXPECT_TRUE(a[i].points == b[i].points) << where << ", elements of frame " << i;
    EXPECT_TRUE(a[i].lines == b[i].lines) << where << ", lines of frame " << i;
    EXPECT_TRUE(a[i].contacts == b[i].contacts) << where << ", contacts of frame " << i;
    EXPECT_TRUE(a[i].walls == b[i].walls) << where << ", walls of frame " << i;
    EXPECT_TRUE(a[i].png == b[i].png) << where << ", picture of frame " << i;
    EXPECT_EQ(a[i].time, b[i].time) << where;
    EXPECT_EQ(a[i].extent.high.x, b[i].extent.high.x) << where;
  }
}

std::int64_t broken_in(Method& method) {
  for (const Fact& fact : method.facts())
    if (fact.path.starts_with("fracture.broken_")) return static_cast<std::int64_t>(fact.value);
  return 0;
}

/// A frame every so many steps, a field in the picture after the other. Whatever is made of the
/// parts is what the whole world shows.
template <class AScene>
std::vector<Made> frames(int count, int threads, const AScene& scene, int steps, int every,
                         const std::vector<std::string>& fields, bool breaks = false,
                         Space space = Space::host) {
  return on_all_ranks(
      count, threads, scene,
      [&](Method& method, bool first) {
        std::vector<Made> all;
        for (std::size_t k = 0;; ++k) {
          const FrameWish wish = wish_for(fields[k % fields.size()]);
          all.push_back(made_of(method.frame_output(wish)));
          const Frame frame = method.frame();
          const FrameContents whole = first ? contents_of(frame) : FrameContents{};
          EXPECT_TRUE(all.back().points == whole.points) << count << " ranks, frame " << k;
          EXPECT_TRUE(all.back().lines == whole.lines) << count << " ranks, frame " << k;
          if (method.steps() >= steps) {
            const std::int64_t broken = broken_in(method);
            if (breaks && first) {
              EXPECT_GT(broken, 10) << "too few to tell";
            }
            return all;
          }
          const std::int64_t next = method.steps() + every;
          while (method.steps() < next) method.advance({1e300, next});
        }
      },
      space);
}

template <class AScene>
void compare(const AScene& scene, int steps, int every, const std::vector<std::string>& fields,
             bool breaks) {
  const std::vector<Made> expected = frames(1, 1, scene, steps, every, fields, breaks);
  for (const int count : {2, 3, 5, 32})
    expect_same(frames(count, 1 + count % 2, scene, steps, every, fields), expected,
                std::to_string(count) + " ranks");
}

TEST(Frames, of_a_slab_that_breaks_are_the_same_by_parts) {
  Slab piece = slab_piece();
  compare(piece, 200, 40, {"damage", "force", "contact_force", "velocity_z", "id", "state", ""},
          true);
  piece.config.domain.show = true;  // partitions differ
  EXPECT_NE(frames(2, 1, piece, 0, 1, {"rank"})[0].png, frames(3, 1, piece, 0, 1, {"rank"})[0].png);
}

TEST(Frames, of_triangles_that_break_are_the_same_by_parts) {
  const std::vector<std::string> fields{"damage",   "fragment", "velocity",      "mode",
                                        "pressure", "time",     "contact_force", "stress_mises"};
  for (const char* joints : {"intrinsic", "extrinsic"})
    compare(impact(joints), 200, 40, fields, true);
}

/// A disc that strikes a plate with a crack across, which was open before.
Scene notched_impact() {
  Scene scene = impact("intrinsic");
  const fdem::Model& model = scene.model;
  const auto corner = [&](Index vertex) { return model.point[static_cast<std::size_t>(vertex)]; };
  std::vector<fdem::Model::Discontinuity> open;
  for (const fdem::MeshEdge& e : mesh_edges(model)) {
    const Vec2 middle = 0.5 * (corner(e.low) + corner(e.high));
    if (e.b >= 0 && middle.y < -0.002 && middle.x > 0.004 && middle.x < 0.01)
      open.push_back({{e.low, e.high}, -1});
  }
  scene.model.discontinuities = open;
  return scene;
}

TEST(Frames, of_cracks_that_were_open_before_are_the_same_by_parts) {
  const Scene scene = notched_impact();
  compare(scene, 180, 60, {"damage", "mode", ""}, false);
  const Frame frame =
      on_all_ranks(1, 1, scene, [](Method& method, bool) { return method.frame(); });
  const std::size_t sides = 2 * scene.model.discontinuities.size();
  ASSERT_GT(sides, 10U);
  ASSERT_EQ(frame.line_fields[0].name, "mode");
  EXPECT_EQ(frame.line_fields[0].values, std::vector<float>(sides, -1.0F));
  // Their ends are corners of the mesh, each side on a triangle of its own.
  std::map<std::pair<double, double>, int> ends;
  for (const std::int32_t point : frame.lines) {
    const Vec3& x = frame.position[static_cast<std::size_t>(point)];
    ++ends[{x.x, x.y}];
  }
  for (const fdem::Model::Discontinuity& d : scene.model.discontinuities)
    for (const Index vertex : d.edge) {
      const Vec2& x = scene.model.point[static_cast<std::size_t>(vertex)];
      ends[{x.x, x.y}] -= 2;
    }
  for (const auto& [place, left] : ends) EXPECT_EQ(left, 0) << place.first << ' ' << place.second;
}

TEST(Frames, as_vtkhdf_are_the_same_by_parts) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  const auto made = [](int count) {
    return on_all_ranks(count, 1 + count % 2, slab_piece(), [](Method& method, bool) {
      FrameWish wish;
      wish.format = FrameFormat::vtkhdf;
      while (method.steps() < 120) method.advance({1e300, 120});
      return std::vector<Made>{made_of(method.frame_output(wish))};
    });
  };
  const std::vector<Made> alone = made(1);
  EXPECT_GT(alone[0].points.size(), 1000U);
  for (const int count : {2, 5}) expect_same(made(count), alone, std::to_string(count) + " ranks");
}

TEST(Frames, of_triangles_that_fly_are_the_same_by_parts) {
  compare(box(), 120, 40, {"group", "velocity_x"}, false);
}

TEST(Frames, are_the_same_where_kernels_have_memory_of_their_own) {
  const Slab piece = slab_piece();
  expect_same(frames(3, 2, piece, 120, 60, {"damage"}, false, Space::shadow),
              frames(1, 1, piece, 120, 60, {"damage"}), "slab");
  const Scene disc = impact("intrinsic");
  expect_same(frames(3, 2, disc, 120, 60, {"damage"}, false, Space::shadow),
              frames(1, 1, disc, 120, 60, {"damage"}), "triangles");
}

/// A frame with arrays of several blocks, items across their borders, and a last, shorter block.
/// Tetrahedra of the points, and triangles as their joints.
void add_solids(Frame& frame) {
  FrameField mode{"mode", "-", 1, {}}, damage{"damage", "-", 1, {}}, group{"group", "-", 1, {}};
  FrameField exposed{"exposed", "-", 1, {}}, pressure{"pressure", "Pa", 1, {}};
  for (std::int32_t i = 0; i + 3 < 40000; i += 4) {
    frame.tetrahedra.insert(frame.tetrahedra.end(), {i, i + 1, i + 2, i + 3});
    group.values.push_back(static_cast<float>(i / 4 % 2));
    exposed.values.push_back(static_cast<float>(i / 4 % 16));
    pressure.values.push_back(static_cast<float>(i));
  }
  for (std::int32_t i = 40000; i + 2 < 70000; i += 3) {
    frame.triangles.insert(frame.triangles.end(), {i, i + 1, i + 2});
    mode.values.push_back(static_cast<float>(i % 3) / 2.0F);
    damage.values.push_back(static_cast<float>(i % 7 / 5));
  }
  frame.tetrahedron_fields = {group, pressure, exposed};
  frame.triangle_fields = {mode, damage};
  frame.line_fields.clear();
}

enum class Bodies { spheres, triangles, tetrahedra };

Frame large_frame(Bodies bodies) {
  const bool triangles = bodies == Bodies::triangles, solid = bodies == Bodies::tetrahedra;
  constexpr std::int32_t points = 70001;
  Frame frame;
  frame.step = 12;
  frame.time = 3e-4;
  frame.groups = {"slab", "rock"};
  const auto number = [](std::uint64_t i) {  // between 0 and 1
    return static_cast<double>(mixed(i) >> 11) / 9007199254740992.0;
  };
  FrameField velocity{"velocity", "m/s", 3, {}}, damage{"damage", "-", 1, {}};
  for (std::int32_t i = 0; i < points; ++i) {
    const auto k = static_cast<std::uint64_t>(4 * i);
    frame.position.push_back({number(k), number(k + 1), number(k + 2)});
    if (bodies == Bodies::spheres) frame.radius.push_back(0.01 + 1e-3 * number(k + 3));
    damage.values.push_back(static_cast<float>(number(k + 3)));
    for (int c = 0; c < 3; ++c) velocity.values.push_back(static_cast<float>(c * i % 1000));
  }
  FrameField force{"force", "N", 1, {}}, group{"group", "-", 1, {}};
  for (std::int32_t i = 0; !solid && i + 20 < points; i += 2) {
    frame.lines.insert(frame.lines.end(), {i, i + 20});
    force.values.push_back(static_cast<float>(i));
  }
  for (std::int32_t i = 0; triangles && i + 2 < points; i += 3) {
    frame.triangles.insert(frame.triangles.end(), {i, i + 1, i + 2});
    group.values.push_back(static_cast<float>(i % 2));
  }
  frame.point_fields = {velocity, damage};
  frame.line_fields = {force};
  if (triangles) frame.triangle_fields = {group};
  if (solid) add_solids(frame);
  return frame;
}

/// The items that a rank has of a field.
std::vector<float> taken(const FrameField& field, const std::vector<std::int32_t>& items) {
  std::vector<float> values;
  for (const std::int32_t i : items)
    for (int c = 0; c < field.components; ++c)
      values.push_back(field.values[static_cast<std::size_t>(i * field.components + c)]);
  return values;
}

/// Items belong to ranks in any order; the last rank has none.
FramePart part_of(const Frame& whole, int rank, int ranks) {
  FramePart part;
  FramePlaces& places = part.places = places_in(whole);
  places.whole = false;
  const auto owner = [ranks](std::int32_t item) {
    return static_cast<int>(mixed(static_cast<std::uint64_t>(item) / 10) %
                            static_cast<std::uint64_t>(ranks - 1));
  };
  const auto redistribute = [&](std::int64_t count, std::vector<std::int32_t>& own) {
    for (std::int32_t i = 0; i < count; ++i)
      if (owner(i) == rank) own.push_back(i);
  };
  redistribute(places.points, places.point);
  redistribute(places.lines, places.line);
  redistribute(places.triangles, places.triangle);
  redistribute(places.tetrahedra, places.tetrahedron);
  Frame& f = part.frame;
  f.step = whole.step;
  f.time = whole.time;
  f.groups = whole.groups;
  for (const std::int32_t i : places.point) {
    f.position.push_back(whole.position[static_cast<std::size_t>(i)]);
    if (places.has_spheres) f.radius.push_back(whole.radius[static_cast<std::size_t>(i)]);
  }
  for (const std::int32_t i : places.line)
    for (int k = 0; k < 2; ++k) f.lines.push_back(whole.lines[static_cast<std::size_t>(2 * i + k)]);
  for (const std::int32_t i : places.triangle)
    for (int k = 0; k < 3; ++k)
      f.triangles.push_back(whole.triangles[static_cast<std::size_t>(3 * i + k)]);
  for (const std::int32_t i : places.tetrahedron)
    for (int k = 0; k < 4; ++k)
      f.tetrahedra.push_back(whole.tetrahedra[static_cast<std::size_t>(4 * i + k)]);
  const auto deal_fields = [](const std::vector<FrameField>& all, std::vector<FrameField>& own,
                              const std::vector<std::int32_t>& items) {
    for (const FrameField& field : all)
      own.push_back({field.name, field.unit, field.components, taken(field, items)});
  };
  deal_fields(whole.point_fields, f.point_fields, places.point);
  deal_fields(whole.line_fields, f.line_fields, places.line);
  deal_fields(whole.triangle_fields, f.triangle_fields, places.triangle);
  deal_fields(whole.tetrahedron_fields, f.tetrahedron_fields, places.tetrahedron);
  return part;
}

TEST(Frames, of_many_blocks_are_the_same_by_parts) {
  for (const Bodies bodies : {Bodies::spheres, Bodies::triangles, Bodies::tetrahedra}) {
    const Frame whole = large_frame(bodies);
    const bool solid = bodies == Bodies::tetrahedra;
    for (const char* field : {"damage", solid ? "mode" : "force"}) {
      const FrameWish wish = wish_for(field);
      const Made expected = made_of(frame_output(FramePart{whole, places_in(whole)}, wish, 1));
      for (const int count : {2, 3, 7}) {
        Made made;
        simulate_ranks(count, 5, [&](Communicator& ranks) {
          FrameOfParts frame(part_of(whole, ranks.rank(), count), wish, ranks, 2);
          const Made own = made_of(frame.output());
          if (ranks.rank() == 0) made = own;
        });
        expect_same({made}, {expected}, std::to_string(count) + " ranks");
      }
    }
  }
}

TEST(Frames, without_a_picture_or_without_files_have_the_other_alone) {
  const Slab piece = slab_piece();
  on_all_ranks(3, 1, piece, [&](Method& method, bool first) {
    FrameWish wish = wish_for("damage");
    wish.files = false;
    FrameOutput output = method.frame_output(wish);
    EXPECT_TRUE(output.files.points.empty());
    EXPECT_EQ(output.png.empty(), !first);
    output = method.frame_output({});
    EXPECT_TRUE(output.png.empty());
    const Frame whole = method.frame();
    EXPECT_TRUE(!first || output.files.points == contents_of(whole).points);
    return true;
  });
}

}  // namespace frames_test
}  // namespace breccia
