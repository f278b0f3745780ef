#include <filesystem>
#include <functional>

#include "io/picture/picture.hpp"
#include "io/whole_file.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/holes.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/meshing/meshing.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/shapes/wall_files.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

class FileChecks {
 public:
  explicit FileChecks(const std::string& case_folder) : folder_(case_folder) {}

  /// Reads a file and notes what is wrong with it.
  /// @param key  that names it
  void check(const std::string& key, const std::string& file,
             const std::function<void(const std::string& path)>& read) {
    const auto note = [&](const Error& error) { problems_.push_back(key + ": " + error.what()); };
    try {
      read((folder_ / file).string());
    } catch (const IoError& error) {
      note(error);
    } catch (const InputError& error) {
      note(error);
      wrong_ = true;
    }
  }
  void add(const std::string& problem) {
    problems_.push_back(problem);
    wrong_ = true;
  }
  void refuse_all() const {
    const char* const of = "with the files of the case";
    wrong_ ? refuse(problems_, of) : refuse<Unreadable>(problems_, of);
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> problems_;
  bool wrong_ = false;  ///< in a file that can be read
};

void read_body(const fdem::BodyConfig& body, const std::string& path) {
  if (body.shape == "outline") {
    std::vector<Vec2> outline = read_outline(path);
    for (Vec2& corner : outline) corner += body.center;
    if (const auto problems = missing_holes(body, outline); !problems.empty())
      throw InputError(path + ": " + problems.front());
  }
  if (body.shape == "geo") read_whole_file(path);
  if (body.shape != "mesh") return;
  const Mesh mesh = read_mesh(path, body.seams == "open");
  check_mesh(mesh);
  triangles_of(body, mesh);
}

}  // namespace

void check_files(const dem::Config& config, const std::string& case_folder) {
  FileChecks files(case_folder);
  for (const dem::BodyConfig& body : config.bodies) {
    if (body.shape == "stl")
      files.check("body." + body.name + ".file", body.file,
                  [&](const std::string& path) { read_surface(path, body.file_unit); });
    for (const dem::CutConfig& cut : body.cuts)
      if (cut.shape == "stl")
        files.check("body." + body.name + ".cut", cut.file,
                    [&](const std::string& path) { read_surface(path, cut.file_unit); });
    if (body.shape == "file")
      files.check("body." + body.name + ".file", body.file, [&](const std::string& path) {
        const dem::MaterialConfig* of = item_named(config.materials, body.material);
        if (of != nullptr && of->law == "ldpm")
          read_ldpm_mesh(path);
        else
          read_spheres(path);
      });
  }
  for (const dem::WallConfig& wall : config.walls)
    if (wall.shape == "stl")
      files.check("wall." + wall.name + ".file", wall.file,
                  [&](const std::string&) { corners_of_wall(wall, case_folder); });
  files.refuse_all();
}

void check_files(const fdem::Config& config, const std::string& case_folder) {
  FileChecks files(case_folder);
  const bool meshes = !on_path("gmsh").empty();
  for (const fdem::BodyConfig& body : config.bodies) {
    if (!meshes && needs_gmsh(body)) files.add("body." + body.name + ": " + no_mesher("its shape"));
    if (!body.file.empty())
      files.check("body." + body.name + ".file", body.file,
                  [&](const std::string& path) { read_body(body, path); });
    if (body.grains.kind == "picture")
      files.check("body." + body.name + ".grains.file", body.grains.file,
                  [](const std::string& path) { read_png(path); });
  }
  for (const fdem::JointSetConfig& set : config.joint_sets)
    if (!set.file.empty())
      files.check("joint_set." + set.name + ".file", set.file,
                  [&](const std::string&) { lines_of_set(set, config.seed, 0, case_folder); });
  files.refuse_all();
}

void check_files(const fdem3::Config& config, const std::string& case_folder) {
  FileChecks files(case_folder);
  const bool meshes = !on_path("gmsh").empty();
  for (const fdem3::BodyConfig& body : config.bodies) {
    if (!meshes && needs_gmsh(body)) files.add("body." + body.name + ": " + no_mesher("its shape"));
    if (body.shape == "stl")
      files.check("body." + body.name + ".file", body.file,
                  [](const std::string& path) { read_surface(path, 1.0); });
    if (body.shape == "mesh")
      files.check("body." + body.name + ".file", body.file,
                  [&](const std::string& path) { tetrahedra_of(body, read_tet_mesh(path)); });
  }
  files.refuse_all();
}

}  // namespace breccia::prepare
