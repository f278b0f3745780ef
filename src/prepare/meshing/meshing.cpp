#include "prepare/meshing/meshing.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/meshing/run_gmsh.hpp"

namespace breccia::prepare {
namespace {

Mesh plane_mesh(const std::string& content, const std::string& what) {
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
    for (const auto& slot : region_.slots) cuts.push_back(polygon(slot));
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

Mesh mesh_region(const Region& region, std::int64_t seed) {
  const TemporaryFolder folder;
  const std::string geo = folder.file("body.geo");
  replace_file(geo, geo_text(region));
  return plane_mesh(run_gmsh({.geo = geo, .what = "this shape", .seed = seed}, folder),
                    "this shape");
}

Mesh mesh_geo_file_with(const std::string& program, const std::string& path, double edge,
                        std::int64_t seed) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + " is no file");
  const TemporaryFolder folder;
  return plane_mesh(
      run_gmsh({.geo = path, .what = path, .edge = edge, .seed = seed, .program = program}, folder),
      path);
}

Mesh mesh_geo_file(const std::string& path, double edge, std::int64_t seed) {
  return mesh_geo_file_with("gmsh", path, edge, seed);
}

}  // namespace breccia::prepare
