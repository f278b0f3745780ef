#include "fdem3/setup/mesh_faces.hpp"

#include <algorithm>
#include <tuple>

#include "exec/error.hpp"
#include "fdem3/elements/tetrahedra.hpp"

namespace breccia::fdem3 {

std::vector<MeshFace> mesh_faces(const Model& model) {
  std::vector<MeshFace> sides;
  sides.reserve(4 * model.tetrahedron.size());
  for (std::size_t t = 0; t < model.tetrahedron.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      MeshFace side{{}, static_cast<Index>(4 * t) + k, -1};
      for (int i = 0; i < 3; ++i)
        side.corners[static_cast<std::size_t>(i)] =
            model.tetrahedron[t][static_cast<std::size_t>(corner_of_face(k, i))];
      std::sort(side.corners.begin(), side.corners.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end(), [](const MeshFace& p, const MeshFace& q) {
    return std::tie(p.corners, p.a) < std::tie(q.corners, q.a);
  });
  std::vector<MeshFace> faces;
  faces.reserve(sides.size() / 2);
  for (const MeshFace& side : sides) {
    if (faces.empty() || faces.back().corners != side.corners) {
      faces.push_back(side);
    } else if (faces.back().b < 0) {
      faces.back().b = side.a;
    } else {
      throw InputError("tetrahedra " + std::to_string(faces.back().a / 4) + ", " +
                       std::to_string(faces.back().b / 4) + " and " + std::to_string(side.a / 4) +
                       " share one face");
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const MeshFace& p, const MeshFace& q) { return p.a < q.a; });
  return faces;
}

}  // namespace breccia::fdem3
