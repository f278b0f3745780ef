#include <algorithm>
#include <filesystem>
#include <functional>

#include "io/picture/picture.hpp"
#include "io/whole_file.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/holes.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/meshing/meshing.hpp"
#include "prepare/packing/rebar.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/shapes/wall_files.hpp"
#include "prepare/tetrahedra/joint_discs.hpp"
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

void refuse_missing_part(const std::string& part, const std::string& problem) {
  if (!problem.empty()) throw InputError("body." + part + " " + problem);
}

/// @param parts  of the body
void read_body(const fdem::BodyConfig& body, const std::string& path,
               const std::vector<fdem::BodyConfig>& parts) {
  if (body.shape == "outline") {
    std::vector<Vec2> outline = read_outline(path);
    for (Vec2& corner : outline) corner += body.center;
    if (const auto problems = missing_cuts(body, outline); !problems.empty())
      throw InputError(path + ": " + problems.front());
    for (const fdem::BodyConfig& part : parts)
      refuse_missing_part(part.name, missing_part(part, body, outline));
  }
  if (body.shape == "geo") read_whole_file(path);
  if (body.shape != "mesh") return;
  const Mesh mesh = read_mesh(path, body.seams == "open");
  check_mesh(mesh);
  const std::vector<Index> own = triangles_of(body, mesh);
  for (const fdem::BodyConfig& part : parts)
    if (std::none_of(own.begin(), own.end(), [&](Index t) {
          const Triangle& corners = mesh.triangle[static_cast<std::size_t>(t)];
          return in_part(part, body.center + centroid(mesh.point, corners));
        }))
      refuse_missing_part(part.name, none_in_part("triangle", body.name));
}

void read_body(const fdem3::BodyConfig& body, const std::string& path,
               const std::vector<fdem3::BodyConfig>& parts) {
  const TetMesh mesh = read_tet_mesh(path);
  const std::vector<Index> own = tetrahedra_of(body, mesh);
  for (const fdem3::BodyConfig& part : parts)
    if (std::none_of(own.begin(), own.end(), [&](Index t) {
          const Tetrahedron& corners = mesh.tetrahedron[static_cast<std::size_t>(t)];
          return in_part(part, body.center + centroid(mesh.point, corners));
        }))
      refuse_missing_part(part.name, none_in_part("tetrahedron", body.name));
}

/// A part of a body that a surface encloses.
void check_part(const fdem3::BodyConfig& part, const fdem3::BodyConfig& body,
                const Surface& surface) {
  fdem3::BodyConfig around;
  around.name = body.name;
  around.shape = "box";
  around.size = surface.high() - surface.low();
  around.center = body.center + 0.5 * (surface.high() + surface.low());
  refuse_missing_part(part.name, missing_part(part, around));
}

/// The parts of a body.
template <class Body>
std::vector<Body> parts_of(const Body& body, const std::vector<Body>& bodies) {
  std::vector<Body> parts;
  for (const Body& each : bodies)
    if (each.shape == "part" && each.of == body.name) parts.push_back(each);
  return parts;
}

}  // namespace

void check_files(const dem::Config& config, const std::string& case_folder) {
  FileChecks files(case_folder);
  for (const dem::BodyConfig& body : config.bodies) {
    if (body.shape == "stl")
      files.check("body." + body.name + ".file", body.file, [&](const std::string& path) {
        const Surface surface = read_surface(path, body.file_unit);
        for (const std::string& problem : bars_outside(config.bodies, body, surface))
          files.add(problem);
      });
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
      files.check("body." + body.name + ".file", body.file, [&](const std::string& path) {
        read_body(body, path, parts_of(body, config.bodies));
      });
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
    const std::vector<fdem3::BodyConfig> parts = parts_of(body, config.bodies);
    if (body.shape == "stl")
      files.check("body." + body.name + ".file", body.file, [&](const std::string& path) {
        const Surface surface = read_surface(path, 1.0);
        for (const fdem3::BodyConfig& part : parts) check_part(part, body, surface);
      });
    if (body.shape == "mesh")
      files.check("body." + body.name + ".file", body.file,
                  [&](const std::string& path) { read_body(body, path, parts); });
  }
  for (const fdem3::JointSetConfig& set : config.joint_sets)
    if (!set.file.empty())
      files.check("joint_set." + set.name + ".file", set.file, [&](const std::string&) {
        CrackNetwork any(0.0);
        polygons_of_set(set, config.seed, 0, case_folder, any);
      });
  files.refuse_all();
}

}  // namespace breccia::prepare
