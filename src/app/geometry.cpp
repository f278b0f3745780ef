#include "app/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <tuple>
#include <type_traits>

#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/vtu/vtu_writer.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/model_file.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

/// Lists of cells by the body of each, without those of bodies that have none.
template <class List>
std::vector<List> lists_by_group(const std::vector<std::string>& names,
                                 const std::vector<std::int32_t>& group,
                                 std::vector<Index> List::*members) {
  std::vector<List> lists;
  for (const std::string& name : names) lists.push_back({name, {}});
  for (std::size_t t = 0; t < group.size(); ++t)
    if (const auto g = static_cast<std::size_t>(group[t]); g < lists.size())
      (lists[g].*members).push_back(static_cast<Index>(t));
  std::erase_if(lists, [members](const List& list) { return (list.*members).empty(); });
  return lists;
}
std::vector<prepare::Part> parts_by_group(const std::vector<std::string>& names,
                                          const std::vector<std::int32_t>& group) {
  return lists_by_group(names, group, &prepare::Part::triangles);
}
std::vector<prepare::Volume> volumes_by_group(const std::vector<std::string>& names,
                                              const std::vector<std::int32_t>& group) {
  return lists_by_group(names, group, &prepare::Volume::tetrahedra);
}

std::vector<std::int32_t> integers_of(const std::vector<FrameField>& fields, const char* name) {
  for (const FrameField& field : fields)
    if (field.name == name)
      return field.integers ? *field.integers
                            : std::vector<std::int32_t>(field.values.begin(), field.values.end());
  return {};
}

/// Vertices of a mesh from a frame, which lists each cell's own corners: those at one place are
/// one.
template <class Point>
class Vertices {
 public:
  Vertices(const Frame& frame, std::vector<Point>& point) : frame_(frame), point_(point) {}

  /// The vertices of a cell from its corners, and on from `first` of them.
  template <std::size_t count>
  std::array<Index, count> of(const std::vector<std::int32_t>& corners, std::size_t first) {
    std::array<Index, count> cell{};
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& p = frame_.position[static_cast<std::size_t>(corners[first + k])];
      const auto [place, added] =
          number_.emplace(std::tuple{p.x, p.y, p.z}, static_cast<Index>(point_.size()));
      if (added) point_.push_back(in_mesh(p));
      cell[k] = place->second;
    }
    return cell;
  }

 private:
  static Point in_mesh(const Vec3& p) {
    if constexpr (std::is_same_v<Point, Vec3>)
      return p;
    else
      return {p.x, p.y};
  }
  const Frame& frame_;
  std::vector<Point>& point_;
  std::map<std::tuple<double, double, double>, Index> number_;
};

Geometry of_frame(Frame frame) {
  Geometry g;
  g.groups = frame.groups;
  if (!frame.tetrahedra.empty()) {  // its triangles are joints
    Vertices<Vec3> vertices(frame, g.solid.point);
    for (std::size_t t = 0; t + 3 < frame.tetrahedra.size(); t += 4)
      g.solid.tetrahedron.push_back(vertices.of<4>(frame.tetrahedra, t));
    g.solid.volumes = volumes_by_group(g.groups, integers_of(frame.tetrahedron_fields, "group"));
    return g;
  }
  if (frame.triangles.empty()) {
    g.center = std::move(frame.position);
    g.radius = std::move(frame.radius);
    g.radius.resize(g.center.size(), 0.0);
    g.group = integers_of(frame.point_fields, "group");
    return g;
  }
  Vertices<Vec2> vertices(frame, g.mesh.point);
  for (std::size_t t = 0; t + 2 < frame.triangles.size(); t += 3)
    g.mesh.triangle.push_back(vertices.of<3>(frame.triangles, t));
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
  if (reader.has("model.tetrahedron")) {
    const fdem3::Model model = load_fdem3_model(reader);
    g.solid.point = model.point;
    g.solid.tetrahedron = model.tetrahedron;
    for (const auto& set : model.face_sets) g.solid.face_sets.push_back({set.name, set.faces});
    g.solid.volumes = volumes_by_group(model.groups, {model.group.begin(), model.group.end()});
    return g;
  }
  const dem::Model model = load_model(reader);
  g.center.assign(model.position.begin(), model.position.end());
  g.radius.assign(model.radius.begin(), model.radius.end());
  g.groups = model.groups;
  g.group.assign(model.group.begin(), model.group.end());
  return g;
}

/// A mesh as its files see it, in the plane and in space.
const auto& elements_of(const prepare::Mesh& m) {
  return m.triangle;
}
const auto& elements_of(const prepare::TetMesh& m) {
  return m.tetrahedron;
}
const auto& parts_of(const prepare::Mesh& m) {
  return m.parts;
}
const auto& parts_of(const prepare::TetMesh& m) {
  return m.volumes;
}
const auto& members_of(const prepare::Part& part) {
  return part.triangles;
}
const auto& members_of(const prepare::Volume& volume) {
  return volume.tetrahedra;
}
const auto& side_sets_of(const prepare::Mesh& m) {
  return m.edge_sets;
}
const auto& side_sets_of(const prepare::TetMesh& m) {
  return m.face_sets;
}
const auto& sides_of(const prepare::EdgeSet& set) {
  return set.edges;
}
const auto& sides_of(const prepare::FaceSet& set) {
  return set.faces;
}
Vec3 in_three(const Vec2& p) {
  return {p.x, p.y, 0.0};
}
Vec3 in_three(const Vec3& p) {
  return p;
}
template <class SomeMesh>
constexpr bool in_space = std::is_same_v<SomeMesh, prepare::TetMesh>;

/// Gmsh 2.2 as text: parts are physical surfaces or volumes, sets of sides physical lines or
/// surfaces.
template <class SomeMesh>
std::string gmsh_text(const SomeMesh& mesh) {
  constexpr int dimension = in_space<SomeMesh> ? 3 : 2;
  const auto& sets = side_sets_of(mesh);
  const auto& parts = parts_of(mesh);
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  if (sets.size() + parts.size() > 0) {
    text += fmt::format("$PhysicalNames\n{}\n", sets.size() + parts.size());
    for (std::size_t s = 0; s < sets.size(); ++s)
      text += fmt::format("{} {} \"{}\"\n", dimension - 1, s + 1, sets[s].name);
    for (std::size_t p = 0; p < parts.size(); ++p)
      text += fmt::format("{} {} \"{}\"\n", dimension, sets.size() + p + 1, parts[p].name);
    text += "$EndPhysicalNames\n";
  }
  text += fmt::format("$Nodes\n{}\n", mesh.point.size());
  for (std::size_t i = 0; i < mesh.point.size(); ++i) {
    const Vec3 p = in_three(mesh.point[i]);
    text += fmt::format("{} {} {} {}\n", i + 1, p.x, p.y, p.z);
  }
  std::size_t count = 0;
  std::string elements;
  const auto add = [&](int type, std::size_t physical, const auto& nodes) {
    elements += fmt::format("{} {} 2 {} {}", ++count, type, physical, physical);
    for (const Index node : nodes) elements += fmt::format(" {}", node + 1);
    elements += '\n';
  };
  constexpr int line = 1, triangle = 2, tetrahedron = 4;
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (const auto& side : sides_of(sets[s])) add(dimension == 3 ? triangle : line, s + 1, side);
  std::vector<std::size_t> part(elements_of(mesh).size(), 0);
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const Index t : members_of(parts[p]))
      part[static_cast<std::size_t>(t)] = sets.size() + p + 1;
  for (std::size_t t = 0; t < part.size(); ++t)
    add(dimension == 3 ? tetrahedron : triangle, part[t], elements_of(mesh)[t]);
  return text + fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", count, elements);
}

/// Abaqus: parts are element sets, sets of edges node sets. Those of faces are sets of triangles,
/// since all corners of a face may be in a node set that does not mean it.
template <class SomeMesh>
std::string abaqus_text(const SomeMesh& mesh) {
  std::string text = "*HEADING\nby breccia convert; metres\n*NODE\n";
  for (std::size_t i = 0; i < mesh.point.size(); ++i) {
    const Vec3 p = in_three(mesh.point[i]);
    text += fmt::format("{}, {}, {}, {}\n", i + 1, p.x, p.y, p.z);
  }
  std::size_t count = 0;
  const auto add = [&](const auto& nodes) {
    text += fmt::format("{}", ++count);
    for (const Index node : nodes) text += fmt::format(", {}", node + 1);
    text += '\n';
  };
  text += in_space<SomeMesh> ? "*ELEMENT, TYPE=C3D4\n" : "*ELEMENT, TYPE=S3\n";
  for (const auto& corners : elements_of(mesh)) add(corners);
  const auto list = [&](const std::vector<Index>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      text += fmt::format("{}{}", numbers[i] + 1,
                          i % 12 == 11 || i + 1 == numbers.size() ? "\n" : ", ");
  };
  for (const auto& part : parts_of(mesh)) {
    text += fmt::format("*ELSET, ELSET={}\n", part.name);
    list(members_of(part));
  }
  for (const auto& set : side_sets_of(mesh)) {
    if (in_space<SomeMesh>) {
      text += fmt::format("*ELEMENT, TYPE=S3, ELSET={}\n", set.name);
      for (const auto& side : sides_of(set)) add(side);
      continue;
    }
    std::vector<Index> nodes;
    for (const auto& side : sides_of(set)) nodes.insert(nodes.end(), side.begin(), side.end());
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
  if (!g.is_mesh() && !g.is_solid()) {
    frame.position = g.center;
    frame.radius = g.radius;
    if (!g.group.empty()) frame.point_fields.push_back(whole_numbers("group", g.group));
    return contents_of(frame, 1, format).points;
  }
  frame.groups.clear();
  const auto add = [&](const auto& mesh, std::vector<std::int32_t>& corners,
                       std::vector<FrameField>& fields) {
    for (const auto& p : mesh.point) frame.position.push_back(in_three(p));
    std::vector<std::int32_t> group(elements_of(mesh).size(), -1);
    for (const auto& part : parts_of(mesh)) {
      for (const Index t : members_of(part))
        group[static_cast<std::size_t>(t)] = static_cast<std::int32_t>(frame.groups.size());
      frame.groups.push_back(part.name);
    }
    for (const auto& each : elements_of(mesh))
      corners.insert(corners.end(), each.begin(), each.end());
    if (!frame.groups.empty()) fields.push_back(whole_numbers("group", group));
  };
  if (g.is_solid())
    add(g.solid, frame.tetrahedra, frame.tetrahedron_fields);
  else
    add(g.mesh, frame.triangles, frame.triangle_fields);
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
    if (prepare::holds_tetrahedra(path))
      g.solid = prepare::read_tet_mesh(path);
    else
      g.mesh = prepare::read_mesh(path, true);
    return g;
  }
  for (const char* other : {".stl", ".vtk", ".vtu", ".vtp", ".pvd", ".hdf", ".geo", ".step", ".stp",
                            ".obj", ".ply", ".toml", ".png"})
    if (kind == other)
      throw InputError(path + ": " + kind +
                       " is no mesh and no packing that can be looked at; a mesh may be .msh or "
                       ".inp, spheres .csv, .txt, a dump or data of LAMMPS, a prepared model .br; "
                       "or give a result folder");
  prepare::Spheres spheres = prepare::read_spheres(path);
  g.center = std::move(spheres.position);
  g.radius = std::move(spheres.radius);
  return g;
}

std::string written_geometry(const Geometry& geometry, const std::string& name) {
  const std::string kind = fs::path(name).extension().string();
  if (kind == ".vtu") return vtk_content(geometry, FrameFormat::vtu);
  if (kind == ".hdf") return vtk_content(geometry, frame_format("vtkhdf"));
  if (geometry.is_solid() && kind == ".msh") return gmsh_text(geometry.solid);
  if (geometry.is_solid() && kind == ".inp") return abaqus_text(geometry.solid);
  if (geometry.is_mesh() && kind == ".msh") return gmsh_text(geometry.mesh);
  if (geometry.is_mesh() && kind == ".inp") return abaqus_text(geometry.mesh);
  if (geometry.is_mesh() || geometry.is_solid())
    throw InputError(name + ": a mesh is written as .msh (Gmsh 2.2), .inp (Abaqus), .vtu or .hdf");
  if (kind == ".csv") return spheres_text(geometry);
  throw InputError(name + ": spheres are written as .csv (x,y,z,radius), .vtu or .hdf");
}

}  // namespace breccia::app
