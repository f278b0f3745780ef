#pragma once
// Faces of a mesh of tetrahedra and the neighbours across them.

#include <algorithm>
#include <array>
#include <vector>

#include "fdem3/elements/tetrahedra.hpp"
#include "fdem3/setup/model.hpp"

namespace breccia::fdem3 {

/// A face: number 4 t + k on its one or two sides.
struct MeshFace {
  std::array<Index, 3> corners;  ///< vertices, ascending
  Index a, b;                    ///< a of the lower number; b = -1: on the border
};

/// The vertices of side 4 t + k, ascending.
inline std::array<Index, 3> vertices_of(const Model& model, Index side) {
  const auto& corners = model.tetrahedron[static_cast<std::size_t>(side / 4)];
  const auto vertex = [&](int i) {
    return corners[static_cast<std::size_t>(corner_of_face(side % 4, i))];
  };
  const Index p = vertex(0), q = vertex(1), r = vertex(2);
  const Index low = std::min({p, q, r}), high = std::max({p, q, r});
  return {low, p ^ q ^ r ^ low ^ high, high};
}

/// The side of the neighbour across each side, -1: none. @throws InputError if three tetrahedra
/// share one face
std::vector<Index> sides_across(const Model& model, int threads);

/// Calls visit(face) for all faces, in ascending order of `a`.
template <class Visit>
void each_face(const Model& model, const std::vector<Index>& across, const Visit& visit) {
  for (std::size_t side = 0; side < across.size(); ++side)
    if (const auto a = static_cast<Index>(side); across[side] < 0 || a < across[side])
      visit(MeshFace{vertices_of(model, a), a, across[side]});
}

}  // namespace breccia::fdem3
