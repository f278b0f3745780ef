// Walls from STL files: read, checked, kept in prepared models.

#include "prepare/shapes/wall_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "exec/error.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/check_regions.hpp"
#include "prepare/model_file.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace wall_files_test {

/// A tetrahedron of edges of 100 units along the axes; its last facet turned over if asked.
std::string tetrahedron(bool turned) {
  const char *const o = "0 0 0", *const x = "100 0 0", *const y = "0 100 0", *const z = "0 0 100";
  std::string text = "solid tool\n";
  const auto facet = [&](const char* a, const char* b, const char* c) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const char* v : {a, b, c}) text += std::string("vertex ") + v + "\n";
    text += "endloop\nendfacet\n";
  };
  facet(o, y, x);
  facet(o, x, z);
  facet(o, z, y);
  turned ? facet(x, z, y) : facet(x, y, z);
  return text + "endsolid\n";
}

dem::Config with_tool(const ScratchFolder& scratch, bool turned = false) {
  std::ofstream(scratch / "tool.stl") << tetrahedron(turned);
  dem::Config config = dem::case_with_materials();
  config.bodies = {dem::box_body("slab", {0.2, 0.2, 0.1}, 100, 0.56)};
  dem::WallConfig tool;
  tool.name = "tool";
  tool.shape = "stl";
  tool.file = "tool.stl";
  tool.file_unit = 1e-3;
  tool.point = {0.0, 0.0, 0.05};
  config.walls = {tool};
  return config;
}

TEST(WallFiles, give_their_triangles_to_the_model_and_its_file) {
  const ScratchFolder scratch;
  const dem::Config config = with_tool(scratch);
  const dem::Model built = build_model(config, scratch.path());
  ASSERT_EQ(built.wall_meshes.size(), 1U);
  ASSERT_EQ(built.wall_meshes[0].size(), 12U);
  EXPECT_NEAR(built.wall_meshes[0][1].y, 0.1, 1e-15);
  CheckpointWriter writer;
  save_model(writer, built);
  writer.write(scratch / "model.br");
  const CheckpointReader reader(scratch / "model.br");
  const dem::Model read = load_model(reader);
  ASSERT_EQ(read.wall_meshes.size(), 1U);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_EQ(norm(read.wall_meshes[0][k] - built.wall_meshes[0][k]), 0.0);
  refuse_misfits(read, config);
  dem::Config without = config;
  without.walls.clear();
  EXPECT_THROW(refuse_misfits(read, without), CheckpointError);
}

std::string problem_of(const dem::Config& config, const ScratchFolder& scratch) {
  try {
    prepare::check_files(config, scratch.path());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(WallFiles, are_checked) {
  const ScratchFolder scratch;
  EXPECT_EQ(problem_of(with_tool(scratch), scratch), "");
  const std::string turned = problem_of(with_tool(scratch, true), scratch);
  EXPECT_NE(turned.find("wall.tool.file: "), std::string::npos) << turned;
  EXPECT_NE(turned.find("tool.stl: two triangles run along one edge in the same direction"),
            std::string::npos)
      << turned;
  dem::Config config = with_tool(scratch);
  config.walls[0].file = "tol.stl";
  EXPECT_NE(problem_of(config, scratch).find("wall.tool.file: "), std::string::npos);
}

TEST(WallFiles, are_told_of_where_nothing_touches_them) {
  const ScratchFolder scratch;
  dem::Config config = with_tool(scratch);
  const std::string folder = scratch.path();
  EXPECT_TRUE(prepare::doubtful_walls(config, folder).empty());
  config.walls[0].point.z = 0.06;
  const auto told = prepare::doubtful_walls(config, folder);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0],
            "wall.tool.point: no body touches the wall at the start; slab is nearest, 10 mm away");
  config.walls[0].normal = {0.0, 0.0, -1.0};  // it hangs down to z = -0.04
  EXPECT_TRUE(prepare::doubtful_walls(config, folder).empty());
}

}  // namespace wall_files_test
}  // namespace breccia
