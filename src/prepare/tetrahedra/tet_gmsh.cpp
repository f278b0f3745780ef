#include "prepare/tetrahedra/tet_gmsh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "prepare/meshing/run_gmsh.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

/// MeshAdapt on surfaces, whose edges point everywhere alike, and Delaunay inside.
constexpr const char* tet_settings =
    "Mesh.Algorithm = 1;\nMesh.Algorithm3D = 1;\nMesh.MeshSizeFromCurvature = 0;\n"
    "Mesh.Optimize = 1;\n";

std::string place_text(const Vec3& p) {
  return fmt::format("{}, {}, {}", p.x, p.y, p.z);
}

std::string solid_text(const fdem3::BodyConfig& b) {
  if (b.shape == "box")
    return fmt::format("Box(1) = {{{}, {}}};\n", place_text(b.center - 0.5 * b.size),
                       place_text(b.size));
  if (b.shape == "sphere")
    return fmt::format("Sphere(1) = {{{}, {}}};\n", place_text(b.center), b.radius);
  Vec3 along{};
  (b.axis == "x" ? along.x : b.axis == "y" ? along.y : along.z) = b.height;
  return fmt::format("Cylinder(1) = {{{}, {}, {}, 2*Pi}};\n", place_text(b.center - 0.5 * along),
                     place_text(along), b.radius);
}

/// A surface of number s.
std::string crack_text(const fdem3::DiscontinuityConfig& d) {
  std::string text = "s = news;\n";
  if (d.points.empty()) {
    text += fmt::format("Disk(s) = {{{}, {}}};\n", place_text(d.center), d.radius);
    const Vec3 normal = (1.0 / norm(d.normal)) * d.normal, axis{-normal.y, normal.x, 0.0};
    if (norm(axis) > 0.0)  // from z to the normal
      text += fmt::format("Rotate{{ {{{}}}, {{{}}}, {} }} {{ Surface{{s}}; }}\n", place_text(axis),
                          place_text(d.center), std::atan2(norm(axis), normal.z));
    return text;
  }
  text += "p = newp;\nl = newl;\n";
  std::vector<std::string> sides;
  for (std::size_t k = 0; k < d.points.size(); ++k)
    text += fmt::format("Point(p + {}) = {{{}}};\n", k, place_text(d.points[k]));
  for (std::size_t k = 0; k < d.points.size(); ++k) {
    text += fmt::format("Line(l + {0}) = {{p + {0}, p + {1}}};\n", k, (k + 1) % d.points.size());
    sides.push_back(fmt::format("l + {}", k));
  }
  return text +
         fmt::format("c = newll;\nCurve Loop(c) = {{{}}};\ns = news;\nPlane Surface(s) = {{c}};\n",
                     fmt::join(sides, ", "));
}

TetMesh tetrahedra_by_gmsh(const std::string& text, const std::string& what, std::int64_t seed,
                           const TemporaryFolder& folder) {
  const std::string geo = folder.file("body.geo");
  replace_file(geo, text);
  const std::string content =
      run_gmsh({.geo = geo, .what = what, .seed = seed, .dimension = 3}, folder);
  return parse_tet_gmsh(content, "the mesh that gmsh made of " + what);
}

}  // namespace

std::string geo_text(const fdem3::BodyConfig& body, const FlatCracks& cracks) {
  std::string text = std::string("SetFactory(\"OpenCASCADE\");\nGeometry.Tolerance = 1e-9;\n") +
                     tet_settings + solid_text(body);
  if (!cracks.empty()) text += "v() = {1};\nk() = {};\n";
  for (const fdem3::DiscontinuityConfig& crack : cracks)
    text += crack_text(crack) +
            "i() = BooleanIntersection{ Surface{s}; Delete; }{ Volume{v()}; };\nk() += i();\n";
  if (!cracks.empty())
    text +=
        "If (#k() > 0)\n"
        "v() = BooleanFragments{ Volume{v()}; Delete; }{ Surface{k()}; Delete; };\n"
        "EndIf\n";
  return text + fmt::format(
                    "Mesh.MeshSizeMax = {0};\nMeshSize{{ PointsOf{{ Volume{{:}}; }} }} = {0};\n"
                    "Physical Volume(\"body\") = Volume{{:}};\n",
                    body.mesh_size);
}

TetMesh mesh_solid(const fdem3::BodyConfig& body, const FlatCracks& cracks, std::int64_t seed) {
  const TemporaryFolder folder;
  TetMesh mesh = tetrahedra_by_gmsh(geo_text(body, cracks), "this shape", seed, folder);
  mesh.volumes.clear();
  return mesh;
}

TetMesh mesh_stl(const std::string& path, double edge, std::int64_t seed) {
  const Surface surface = read_surface(path, 1.0);
  const TemporaryFolder folder;
  std::filesystem::copy_file(path, folder.file("surface.stl"));
  const std::string text =
      std::string(tet_settings) +
      fmt::format(
          "Merge \"{0}\";\nClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};\nCreateGeometry;\n"
          "Surface Loop(1) = Surface{{:}};\nVolume(1) = {{1}};\n"
          "Mesh.MeshSizeMin = {1};\nMesh.MeshSizeMax = {1};\n"
          "Physical Volume(\"body\") = Volume{{:}};\n",
          folder.file("surface.stl"), edge);
  TetMesh mesh = tetrahedra_by_gmsh(text, path, seed, folder);
  mesh.volumes.clear();
  double volume = 0.0;
  for (const Tetrahedron& t : mesh.tetrahedron) volume += signed_volume(mesh.point, t);
  if (std::abs(volume - surface.volume()) > 0.1 * surface.volume())
    throw InputError(fmt::format(
        "{}: the mesh that gmsh made has a volume of {:.4g} m3, the surface one of {:.4g} m3; give "
        "a smaller mesh_size, and each separate piece a file of its own",
        path, volume, surface.volume()));
  return mesh;
}

}  // namespace breccia::prepare
