#include "app/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <tuple>

#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/vtu/vtu_writer.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/model_file.hpp"
#include "prepare/packing/spheres_file.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

/// Parts of a mesh by the body of each triangle.
std::vector<prepare::Part> parts_by_group(const std::vector<std::string>& names,
                                          const std::vector<std::int32_t>& group) {
  std::vector<prepare::Part> parts;
  for (const std::string& name : names) parts.push_back({name, {}});
  for (std::size_t t = 0; t < group.size(); ++t)
    if (const auto g = static_cast<std::size_t>(group[t]); g < parts.size())
      parts[g].triangles.push_back(static_cast<Index>(t));
  std::erase_if(parts, [](const prepare::Part& part) { return part.triangles.empty(); });
  return parts;
}

std::vector<std::int32_t> integers_of(const std::vector<FrameField>& fields, const char* name) {
  for (const FrameField& field : fields)
    if (field.name == name)
      return field.integers ? *field.integers
                            : std::vector<std::int32_t>(field.values.begin(), field.values.end());
  return {};
}

/// Corners of triangles that are at one place become one vertex: frames list each triangle's own.
Geometry of_frame(Frame frame) {
  Geometry g;
  if (!frame.tetrahedra.empty())
    throw InputError(
        "a frame of tetrahedra is no plane mesh and no packing; `breccia convert --frames` carries "
        "frames to another format, and ParaView and meshio read their files as they are");
  g.groups = frame.groups;
  if (frame.triangles.empty()) {
    g.center = std::move(frame.position);
    g.radius = std::move(frame.radius);
    g.radius.resize(g.center.size(), 0.0);
    g.group = integers_of(frame.point_fields, "group");
    return g;
  }
  std::map<std::tuple<double, double>, Index> vertex;
  for (std::size_t t = 0; t + 2 < frame.triangles.size(); t += 3) {
    prepare::Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = frame.position[static_cast<std::size_t>(frame.triangles[t + k])];
      const auto [place, added] =
          vertex.emplace(std::tuple{p.x, p.y}, static_cast<Index>(g.mesh.point.size()));
      if (added) g.mesh.point.push_back({p.x, p.y});
      corners[k] = place->second;
    }
    g.mesh.triangle.push_back(corners);
  }
  g.mesh.parts = parts_by_group(g.groups, integers_of(frame.triangle_fields, "group"));
  return g;
}

Geometry of_model(const std::string& path) {
  const CheckpointReader reader(path);
  if (!holds_model(reader))
    throw InputError(path + ": is the state of a run; give its result folder, or a prepared model");
  Geometry g;
  if (reader.has("model.triangle")) {
    const fdem::Model model = load_fdem_model(reader);
    g.mesh.point = model.point;
    g.mesh.triangle = model.triangle;
    for (const auto& set : model.edge_sets) g.mesh.edge_sets.push_back({set.name, set.edges});
    g.groups = model.groups;
    g.mesh.parts = parts_by_group(g.groups, {model.group.begin(), model.group.end()});
    return g;
  }
  const dem::Model model = load_model(reader);
  g.center = model.position;
  g.radius = model.radius;
  g.groups = model.groups;
  g.group.assign(model.group.begin(), model.group.end());
  return g;
}

/// Gmsh 2.2 as text: parts are physical surfaces, edge sets physical lines.
std::string gmsh_text(const prepare::Mesh& mesh) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::size_t named = mesh.edge_sets.size() + mesh.parts.size();
  if (named > 0) {
    text += fmt::format("$PhysicalNames\n{}\n", named);
    for (std::size_t s = 0; s < mesh.edge_sets.size(); ++s)
      text += fmt::format("1 {} \"{}\"\n", s + 1, mesh.edge_sets[s].name);
    for (std::size_t p = 0; p < mesh.parts.size(); ++p)
      text += fmt::format("2 {} \"{}\"\n", mesh.edge_sets.size() + p + 1, mesh.parts[p].name);
    text += "$EndPhysicalNames\n";
  }
  text += fmt::format("$Nodes\n{}\n", mesh.point.size());
  for (std::size_t i = 0; i < mesh.point.size(); ++i)
    text += fmt::format("{} {} {} 0\n", i + 1, mesh.point[i].x, mesh.point[i].y);
  std::size_t count = 0;
  std::string elements;
  const auto add = [&](int type, std::size_t physical, const auto& nodes) {
    elements += fmt::format("{} {} 2 {} {}", ++count, type, physical, physical);
    for (const Index node : nodes) elements += fmt::format(" {}", node + 1);
    elements += '\n';
  };
  for (std::size_t s = 0; s < mesh.edge_sets.size(); ++s)
    for (const prepare::Edge& edge : mesh.edge_sets[s].edges) add(1, s + 1, edge);
  std::vector<std::size_t> part(mesh.triangle.size(), 0);
  for (std::size_t p = 0; p < mesh.parts.size(); ++p)
    for (const Index t : mesh.parts[p].triangles)
      part[static_cast<std::size_t>(t)] = mesh.edge_sets.size() + p + 1;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) add(2, part[t], mesh.triangle[t]);
  return text + fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", count, elements);
}

/// Abaqus: parts are element sets, edge sets node sets.
std::string abaqus_text(const prepare::Mesh& mesh) {
  std::string text = "*HEADING\nby breccia convert; metres\n*NODE\n";
  for (std::size_t i = 0; i < mesh.point.size(); ++i)
    text += fmt::format("{}, {}, {}, 0\n", i + 1, mesh.point[i].x, mesh.point[i].y);
  text += "*ELEMENT, TYPE=S3\n";
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    text += fmt::format("{}, {}, {}, {}\n", t + 1, mesh.triangle[t][0] + 1, mesh.triangle[t][1] + 1,
                        mesh.triangle[t][2] + 1);
  const auto list = [&](const std::vector<Index>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      text += fmt::format("{}{}", numbers[i] + 1,
                          i % 12 == 11 || i + 1 == numbers.size() ? "\n" : ", ");
  };
  for (const prepare::Part& part : mesh.parts) {
    text += fmt::format("*ELSET, ELSET={}\n", part.name);
    list(part.triangles);
  }
  for (const prepare::EdgeSet& set : mesh.edge_sets) {
    std::vector<Index> nodes;
    for (const prepare::Edge& edge : set.edges) nodes.insert(nodes.end(), edge.begin(), edge.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    text += fmt::format("*NSET, NSET={}\n", set.name);
    list(nodes);
  }
  return text;
}

std::string spheres_text(const Geometry& g) {
  std::string text = "x,y,z,radius\n";
  std::int32_t last = -1;
  for (std::size_t i = 0; i < g.center.size(); ++i) {
    if (i < g.group.size() && g.group[i] != last && g.group[i] >= 0 &&
        static_cast<std::size_t>(g.group[i]) < g.groups.size()) {
      last = g.group[i];
      text += "# " + g.groups[static_cast<std::size_t>(last)] + "\n";
    }
    text += fmt::format("{},{},{},{}\n", g.center[i].x, g.center[i].y, g.center[i].z, g.radius[i]);
  }
  return text;
}

std::string vtk_content(const Geometry& g, FrameFormat format) {
  Frame frame;
  frame.groups = g.groups;
  if (!g.is_mesh()) {
    frame.position = g.center;
    frame.radius = g.radius;
    if (!g.group.empty()) frame.point_fields.push_back(whole_numbers("group", g.group));
    return contents_of(frame, 1, format).points;
  }
  for (const Vec2& p : g.mesh.point) frame.position.push_back({p.x, p.y, 0.0});
  std::vector<std::int32_t> group(g.mesh.triangle.size(), -1);
  frame.groups.clear();
  for (const prepare::Part& part : g.mesh.parts) {
    for (const Index t : part.triangles)
      group[static_cast<std::size_t>(t)] = static_cast<std::int32_t>(frame.groups.size());
    frame.groups.push_back(part.name);
  }
  for (const prepare::Triangle& t : g.mesh.triangle)
    frame.triangles.insert(frame.triangles.end(), t.begin(), t.end());
  if (!frame.groups.empty()) frame.triangle_fields.push_back(whole_numbers("group", group));
  return contents_of(frame, 1, format).points;
}

}  // namespace

Geometry read_geometry(const std::string& path, int frame) {
  if (fs::is_directory(path)) {
    const auto count = static_cast<int>(frame_times(path).size());
    return of_frame(read_frame(path, frame < 0 ? count - 1 : frame));
  }
  const std::string kind = fs::path(path).extension().string();
  if (kind == ".br") return of_model(path);
  Geometry g;
  if (kind == ".msh" || kind == ".inp") {
    g.mesh = prepare::read_mesh(path, true);
    return g;
  }
  prepare::Spheres spheres = prepare::read_spheres(path);
  g.center = std::move(spheres.position);
  g.radius = std::move(spheres.radius);
  return g;
}

std::string written_geometry(const Geometry& geometry, const std::string& name) {
  const std::string kind = fs::path(name).extension().string();
  if (kind == ".vtu") return vtk_content(geometry, FrameFormat::vtu);
  if (kind == ".hdf") return vtk_content(geometry, frame_format("vtkhdf"));
  if (geometry.is_mesh()) {
    if (kind == ".msh") return gmsh_text(geometry.mesh);
    if (kind == ".inp") return abaqus_text(geometry.mesh);
    throw InputError(name + ": a mesh is written as .msh (Gmsh 2.2), .inp (Abaqus), .vtu or .hdf");
  }
  if (kind == ".csv") return spheres_text(geometry);
  throw InputError(name + ": spheres are written as .csv (x,y,z,radius), .vtu or .hdf");
}

}  // namespace breccia::app
