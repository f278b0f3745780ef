#include "prepare/tetrahedra/tet_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/region.hpp"
#include "exec/error.hpp"
#include "prepare/tetrahedra/crack_faces.hpp"
#include "prepare/tetrahedra/kuhn_box.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

/// The stream of random numbers of the first body.
constexpr std::uint32_t tet_jitter_stream = 0x10000;

}  // namespace

bool needs_gmsh(const fdem3::BodyConfig& body) {
  return body.shape != "mesh" && body.shape != "part" && !body.structured;
}

bool follows_cracks(const fdem3::BodyConfig& body) {
  return needs_gmsh(body) && body.shape != "stl";
}

Frame3 frame_of(const fdem3::BodyConfig& body) {
  const bool given = norm(body.direction) > 0.0;
  return frame_of(given ? body.direction : Vec3{0.0, 0.0, 1.0}, body.across);
}

TetMesh mesh_of(const fdem3::BodyConfig& body, const TetContext& context) {
  if (body.is_turned()) {  // meshed upright, with the cracks as they lie to it
    const Frame3 frame = frame_of(body);
    fdem3::BodyConfig upright = body;
    upright.direction = upright.across = {};
    TetContext own = context;
    const auto in = [&](const Vec3& p) { return body.center + frame.in(p - body.center); };
    for (fdem3::DiscontinuityConfig& crack : own.cracks) {
      for (Vec3& p : crack.points) p = in(p);
      crack.center = in(crack.center);
      crack.normal = frame.in(crack.normal);
    }
    TetMesh mesh = mesh_of(upright, own);
    for (Vec3& p : mesh.point) p = body.center + frame.out(p - body.center);
    return mesh;
  }
  const std::string path = (std::filesystem::path(context.folder) / body.file).string();
  const auto moved = [&](TetMesh mesh) {
    for (Vec3& p : mesh.point) p += body.center;
    return mesh;
  };
  TetMesh mesh = body.shape == "mesh"  ? moved(read_tet_mesh(path))
                 : body.shape == "stl" ? moved(mesh_stl(path, body.mesh_size, context.seed))
                 : body.structured     ? kuhn_box(body.center, body.size, body.mesh_size)
                                       : mesh_solid(body, context.cracks, context.seed);
  if (!(body.jitter > 0.0)) return mesh;
  std::vector<bool> fixed(mesh.point.size());
  if (follows_cracks(body))
    for (const fdem3::DiscontinuityConfig& given : context.cracks) {
      const FlatCrack crack(given);
      for (std::size_t i = 0; i < fixed.size(); ++i)
        if (std::abs(crack.height(mesh.point[i])) < 1e-6 * body.mesh_size) fixed[i] = true;
    }
  jitter(mesh, body.jitter,
         {static_cast<std::uint64_t>(context.seed), tet_jitter_stream + context.number}, fixed);
  return mesh;
}

bool in_part(const fdem3::BodyConfig& part, const Vec3& point) {
  const Vec3 from = point - part.center;
  if (!(part.radius > 0.0))
    return std::abs(from.x) <= 0.5 * part.size.x && std::abs(from.y) <= 0.5 * part.size.y &&
           std::abs(from.z) <= 0.5 * part.size.z;
  if (!(part.height > 0.0)) return in_round(part.center, part.radius, "", point);
  const double along = part.axis == "x" ? from.x : part.axis == "y" ? from.y : from.z;
  return std::abs(along) <= 0.5 * part.height &&
         in_round(part.center, part.radius, part.axis, point);
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
