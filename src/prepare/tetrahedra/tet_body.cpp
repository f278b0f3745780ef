#include "prepare/tetrahedra/tet_body.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exec/error.hpp"
#include "prepare/tetrahedra/kuhn_box.hpp"

namespace breccia::prepare {
namespace {

/// The stream of random numbers of body 0; those of the plane method are of other methods' cases.
constexpr std::uint32_t tet_jitter_stream = 0x10000;

}  // namespace

bool needs_gmsh(const fdem3::BodyConfig& body) {
  return body.shape != "mesh" && !body.structured;
}

TetMesh mesh_of(const fdem3::BodyConfig& body, const TetContext& context) {
  if (body.shape != "box" || !body.structured)
    throw InputError("only structured boxes can be meshed yet");
  TetMesh mesh = kuhn_box(body.center, body.size, body.mesh_size);
  jitter(mesh, body.jitter,
         {static_cast<std::uint64_t>(context.seed), tet_jitter_stream + context.number});
  return mesh;
}

std::vector<Index> tetrahedra_of(const fdem3::BodyConfig& body, const TetMesh& mesh) {
  std::vector<Index> tetrahedra;
  if (body.parts.empty())
    for (std::size_t t = 0; t < mesh.tetrahedron.size(); ++t)
      tetrahedra.push_back(static_cast<Index>(t));
  for (const std::string& name : body.parts) {
    const auto found = std::find_if(mesh.volumes.begin(), mesh.volumes.end(),
                                    [&](const Volume& volume) { return volume.name == name; });
    if (found != mesh.volumes.end()) {
      tetrahedra.insert(tetrahedra.end(), found->tetrahedra.begin(), found->tetrahedra.end());
      continue;
    }
    std::string there;
    for (const Volume& volume : mesh.volumes) there += (there.empty() ? "" : ", ") + volume.name;
    throw InputError(fmt::format("parts: {} has no part \"{}\"; it has: {}", body.file, name,
                                 there.empty() ? "none" : there));
  }
  return tetrahedra;
}

}  // namespace breccia::prepare
