#include "prepare/tetrahedra/tet_file.hpp"

#include <algorithm>
#include <filesystem>

#include "io/whole_file.hpp"
#include "prepare/meshing/finisher.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::prepare {
namespace {

class TetFinisher : FinisherBase {
 public:
  TetFinisher(const RawMesh& raw, const std::string& name) : FinisherBase(raw, name) {}

  TetMesh run() {
    number_nodes(4, "tetrahedra");
    mesh_.tetrahedron = taken_elements<Tetrahedron>("tetrahedra");
    refuse_if_any();
    keep_used_nodes();
    turn_if_all_are_turned();
    const TetNames names{[this](Index t) { return element_name(static_cast<std::size_t>(t)); },
                         [this](Index v) { return node_name(kept_[static_cast<std::size_t>(v)]); }};
    for (const std::string& problem : mesh_problems(mesh_, names)) add(problem);
    refuse_if_any();
    take_sets();
    return std::move(mesh_);
  }

 private:
  void keep_used_nodes() {
    index_.assign(raw_.nodes.size(), -1);
    for (std::size_t n = 0; n < raw_.nodes.size(); ++n) {
      if (!used_[n]) continue;
      index_[n] = static_cast<Index>(mesh_.point.size());
      kept_.push_back(n);
      mesh_.point.push_back(raw_.nodes[n].position);
    }
    for (Tetrahedron& t : mesh_.tetrahedron)
      for (Index& v : t) v = index_[static_cast<std::size_t>(v)];
  }

  /// Some programs number corners the other way round. A mesh of both kinds is not touched: it is
  /// refused.
  void turn_if_all_are_turned() {
    const bool all =
        std::all_of(mesh_.tetrahedron.begin(), mesh_.tetrahedron.end(),
                    [&](const Tetrahedron& t) { return signed_volume(mesh_.point, t) < 0.0; });
    for (Tetrahedron& t : mesh_.tetrahedron)
      if (all) std::swap(t[2], t[3]);
  }

  void take_sets() {
    for (const auto& [name, tetrahedra] : raw_.parts) {
      Volume volume{name, {}};
      for (const std::size_t t : tetrahedra) volume.tetrahedra.push_back(static_cast<Index>(t));
      if (!volume.tetrahedra.empty()) mesh_.volumes.push_back(std::move(volume));
    }
    if (raw_.side_sets.empty() && raw_.node_sets.empty()) return;
    const std::vector<MeshFace> faces = faces_of(mesh_.tetrahedron);
    for (const auto& [name, sides] : raw_.side_sets) {
      FaceSet set{name, {}};
      for (const std::size_t s : sides) {
        const RawMesh::Element& side = raw_.sides[s];
        const Face corners =
            sorted({vertex(side.nodes[0]), vertex(side.nodes[1]), vertex(side.nodes[2])});
        if (corners[0] >= 0 && find_face(faces, corners) != nullptr)
          set.faces.push_back(corners);
        else
          add(fmt::format("{}element {} of the set \"{}\" is not a face of a tetrahedron",
                          in_line(side.line), side.number, name));
      }
      mesh_.face_sets.push_back(std::move(set));
    }
    for (const auto& [name, numbers] : raw_.node_sets) {
      const std::vector<bool> in = vertices_in(name, numbers);
      FaceSet set{name, {}};
      for (const MeshFace& face : faces)
        if (std::all_of(face.corners.begin(), face.corners.end(),
                        [&](Index v) { return in[static_cast<std::size_t>(v)]; }))
          set.faces.push_back(face.corners);
      mesh_.face_sets.push_back(std::move(set));
    }
    refuse_if_any();
  }

  TetMesh mesh_;
};

}  // namespace

TetMesh parse_tet_gmsh(std::string_view content, const std::string& name) {
  return TetFinisher(raw_gmsh(content, name, 3), name).run();
}

TetMesh parse_tet_abaqus(std::string_view content, const std::string& name) {
  return TetFinisher(raw_abaqus(content, name, 3), name).run();
}

bool holds_tetrahedra(const std::string& path) {
  try {
    const std::string content = read_whole_file(path);
    const RawMesh raw =
        path.ends_with(".msh") ? raw_gmsh(content, path, 3) : raw_abaqus(content, path, 3);
    return !raw.elements.empty();
  } catch (const Error&) {
    return false;  // the reader of plane meshes says why
  }
}

TetMesh read_tet_mesh(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".msh" && ending != ".inp")
    throw InputError(path +
                     " is no mesh that can be read; allowed are .msh (Gmsh 4.1 or 2.2) and .inp "
                     "(Abaqus)");
  const std::string content = read_whole_file(path);
  return ending == ".msh" ? parse_tet_gmsh(content, path) : parse_tet_abaqus(content, path);
}

}  // namespace breccia::prepare
