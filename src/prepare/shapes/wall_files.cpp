#include "prepare/shapes/wall_files.hpp"

#include <filesystem>

#include "dem/setup/mass_spread.hpp"
#include "dem/setup/wall_meshes.hpp"
#include "exec/error.hpp"
#include "prepare/shapes/surface.hpp"

namespace breccia::prepare {

std::vector<Vec3> corners_of_wall(const dem::WallConfig& wall, const std::string& case_folder) {
  const std::string path = (std::filesystem::path(case_folder) / wall.file).string();
  std::vector<Vec3> corners;
  const std::vector<Surface::Triangle> triangles = read_triangles(path, wall.file_unit);
  for (const Surface::Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  const std::string problem = dem::wall_mesh_problem(corners);
  if (!problem.empty()) throw InputError(path + ": " + problem);
  if (wall.is_turning()) {
    const Surface closed(triangles, path);  // or it has no inside
    if (!(dem::enclosed_volume(corners) > 0.0))
      throw InputError(path +
                       ": a wall that turns has its mass inside, and the triangles of this "
                       "surface run clockwise seen from outside: it is a room");
  }
  return corners;
}

void add_wall_meshes(dem::Model& model, const dem::Config& config, const std::string& case_folder) {
  for (const dem::WallConfig& wall : config.walls)
    if (wall.shape == "stl") model.wall_meshes.push_back(corners_of_wall(wall, case_folder));
}

}  // namespace breccia::prepare
