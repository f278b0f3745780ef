#include "prepare/meshing/meshing.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/mesh_file.hpp"

extern char** environ;

namespace breccia::prepare {
namespace {

/// A folder that goes when its owner does.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "breccia-mesh-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw IoError(fmt::format("{}: cannot make the folder: {}", name, std::strerror(errno)));
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs a program and waits for it; what it prints goes to a file.
/// @returns its exit status, 128 and the signal's number if one ended it, or -1 and errno if it
///          could not be started
int run_program(std::vector<std::string> words, const std::string& output,
                const std::string& settings_folder) {
  std::vector<std::string> variables;  // no settings of the user: the same mesh for everyone
  for (char** v = environ; *v != nullptr; ++v)
    if (std::strncmp(*v, "GMSH_HOME=", 10) != 0 && std::strncmp(*v, "OMP_", 4) != 0)
      variables.emplace_back(*v);
  variables.push_back("GMSH_HOME=" + settings_folder);
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  };
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t process = 0;
  const int error = posix_spawnp(&process, words[0].c_str(), &files, nullptr,
                                 pointers(words).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    errno = error;
    return -1;
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The lines in which gmsh says what went wrong, or its last ones.
std::string complaint(const std::string& output) {
  std::vector<std::string> lines, errors;
  for (std::size_t at = 0; at < output.size();) {
    const std::size_t end = std::min(output.find('\n', at), output.size());
    const std::string line = output.substr(at, end - at);
    if (!line.empty()) lines.push_back(line);
    if (line.starts_with("Error")) errors.push_back(line);
    at = end + 1;
  }
  const std::vector<std::string>& said = errors.empty() ? lines : errors;
  std::string text;
  for (std::size_t k = said.size() > 5 ? said.size() - 5 : 0; k < said.size(); ++k)
    text += "\n    " + said[k];
  return text.empty() ? " without a word" : ":" + text;
}

Mesh run_gmsh(const std::string& program, const std::string& geo, const std::string& what,
              double edge, std::int64_t seed, const TemporaryFolder& folder) {
  const std::string mesh = folder.file("mesh.msh"), output = folder.file("output.txt");
  std::vector<std::string> words{program,
                                 "-2",
                                 "-format",
                                 "msh41",
                                 "-bin",
                                 "-nt",
                                 "1",
                                 "-v",
                                 "2",
                                 "-setnumber",
                                 "Mesh.RandomSeed",
                                 std::to_string(seed % 2147483647 + 1)};
  if (edge > 0.0) words.insert(words.end(), {"-clmax", fmt::format("{}", edge)});
  words.insert(words.end(), {"-o", mesh, geo});
  const int status = run_program(words, output, folder.path());
  if (status == -1 && errno == ENOENT) throw InputError(no_mesher(what, program));
  if (status == -1)
    throw InputError(fmt::format("{}: cannot start {}: {}", what, program, std::strerror(errno)));
  const std::string said = read_whole_file(output);
  if (status != 0 || !std::filesystem::exists(mesh))
    throw InputError(
        fmt::format("{}: {} failed with status {}{}", what, program, status, complaint(said)));
  if (said.find("Error") != std::string::npos)
    throw InputError(fmt::format("{}: {} met an error{}", what, program, complaint(said)));
  const std::string content = read_whole_file(mesh);
  if (content.find("$Nodes") == std::string::npos)
    throw InputError(
        fmt::format("{}: {} made no mesh of it; does it draw a surface?", what, program));
  return parse_gmsh(content, "the mesh that gmsh made of " + what, true);
}

std::string point_text(const Vec2& p) {
  return fmt::format("{}, {}, 0", p.x, p.y);
}

/// Numbers of what has been written so far.
class GeoWriter {
 public:
  explicit GeoWriter(const Region& region) : region_(region) {}

  std::string run() {
    text_ =
        "SetFactory(\"OpenCASCADE\");\nMesh.Algorithm = 1;\nGeometry.Tolerance = 1e-9;\n"
        "Mesh.MeshSizeFromCurvature = 0;\nMesh.Optimize = 1;\n";
    write_outer();
    std::vector<int> cuts;
    for (const Region::Circle& hole : region_.holes) cuts.push_back(disc(hole));
    for (const auto& slot : region_.slots) cuts.push_back(polygon({slot.begin(), slot.end()}));
    if (cuts.empty())
      text_ += "s() = {1};\n";
    else
      text_ += fmt::format(
          "s() = BooleanDifference{{ Surface{{1}}; Delete; }}{{ Surface{{{}}}; "
          "Delete; }};\n",
          fmt::join(cuts, ", "));
    if (!region_.lines.empty()) write_lines();
    text_ += fmt::format(
        "Mesh.MeshSizeMax = {0};\nMeshSize{{ PointsOf{{ Surface{{:}}; }} }} = {0};\n"
        "Physical Surface(\"body\") = Surface{{:}};\n",
        region_.edge);
    return text_;
  }

 private:
  void write_outer() {
    switch (region_.shape) {
      case Region::Shape::disc:
        disc(region_.disc);
        break;
      case Region::Shape::rectangle: {
        const Vec2 low = region_.center - 0.5 * region_.size;
        text_ += fmt::format("Rectangle({}) = {{{}, {}, {}}};\n", ++surface_, point_text(low),
                             region_.size.x, region_.size.y);
        break;
      }
      case Region::Shape::polygon:
        polygon(region_.polygon);
        break;
    }
  }
  int disc(const Region::Circle& circle) {
    text_ += fmt::format("Disk({}) = {{{}, {}}};\n", ++surface_, point_text(circle.center),
                         circle.radius);
    return surface_;
  }
  int polygon(const std::vector<Vec2>& corners) {
    text_ += "p = newp;\nl = newl;\n";
    for (std::size_t k = 0; k < corners.size(); ++k)
      text_ += fmt::format("Point(p + {}) = {{{}}};\n", k, point_text(corners[k]));
    std::vector<std::string> sides;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      text_ += fmt::format("Line(l + {0}) = {{p + {0}, p + {1}}};\n", k, (k + 1) % corners.size());
      sides.push_back(fmt::format("l + {}", k));
    }
    text_ += fmt::format("c = newll;\nCurve Loop(c) = {{{}}};\nPlane Surface({}) = {{c}};\n",
                         fmt::join(sides, ", "), ++surface_);
    return surface_;
  }
  void write_lines() {
    text_ += "k() = {};\n";
    for (const auto& line : region_.lines)
      text_ += fmt::format(
          "p = newp;\nl = newl;\nPoint(p) = {{{}}};\nPoint(p + 1) = {{{}}};\n"
          "Line(l) = {{p, p + 1}};\n"
          "i() = BooleanIntersection{{ Curve{{l}}; Delete; }}{{ Surface{{s()}}; }};\n"
          "k() += i();\n",
          point_text(line[0]), point_text(line[1]));
    text_ +=
        "If (#k() > 0)\n"
        "s() = BooleanFragments{ Surface{s()}; Delete; }{ Curve{k()}; Delete; };\n"
        "EndIf\n";
  }

  const Region& region_;
  std::string text_;
  int surface_ = 0;
};

}  // namespace

std::string geo_text(const Region& region) {
  return GeoWriter(region).run();
}

std::string on_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = folder + "/" + program;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return file;
  }
  return "";
}

std::string no_mesher(const std::string& what, const std::string& program) {
  return fmt::format(
      "{} needs the program {} to make its mesh, and it is not installed; install it (Debian and "
      "Ubuntu: apt install gmsh), or use structured = true or shape = \"mesh\"",
      what, program);
}

Mesh mesh_region(const Region& region, std::int64_t seed) {
  const TemporaryFolder folder;
  const std::string geo = folder.file("body.geo");
  replace_file(geo, geo_text(region));
  return run_gmsh("gmsh", geo, "this shape", 0.0, seed, folder);
}

Mesh mesh_geo_file_with(const std::string& program, const std::string& path, double edge,
                        std::int64_t seed) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + " is no file");
  return run_gmsh(program, path, path, edge, seed, TemporaryFolder());
}

Mesh mesh_geo_file(const std::string& path, double edge, std::int64_t seed) {
  return mesh_geo_file_with("gmsh", path, edge, seed);
}

}  // namespace breccia::prepare
