#include "prepare/tetrahedra/kuhn_box.hpp"

#include <algorithm>
#include <cmath>

#include "math/constants.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::prepare {
namespace {

Index cells_along(double size, double edge) {
  return static_cast<Index>(std::max(1.0, std::round(size / edge)));
}

/// A point of the unit ball, uniform.
Vec3 in_unit_ball(const Random& random, std::uint64_t index) {
  const double z = 2.0 * random.uniform(index, 0) - 1.0;
  const double angle = 2.0 * pi * random.uniform(index, 1);
  const double radius = std::cbrt(random.uniform(index, 2)), across = std::sqrt(1.0 - z * z);
  return radius * Vec3{across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

TetMesh kuhn_box(const Vec3& center, const Vec3& size, double edge) {
  const Index nx = cells_along(size.x, edge), ny = cells_along(size.y, edge),
              nz = cells_along(size.z, edge);
  const Vec3 low = center - 0.5 * size;
  TetMesh mesh;
  mesh.point.reserve(static_cast<std::size_t>(nx + 1) * static_cast<std::size_t>(ny + 1) *
                     static_cast<std::size_t>(nz + 1));
  for (Index k = 0; k <= nz; ++k)
    for (Index j = 0; j <= ny; ++j)
      for (Index i = 0; i <= nx; ++i)
        mesh.point.push_back(
            {low.x + size.x * i / nx, low.y + size.y * j / ny, low.z + size.z * k / nz});
  const std::array<Index, 3> stride{1, nx + 1, (nx + 1) * (ny + 1)};
  // Even permutations first: their determinant is positive; of the others the middle is swapped.
  constexpr std::array<std::array<std::size_t, 3>, 6> paths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  mesh.tetrahedron.reserve(6 * static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                           static_cast<std::size_t>(nz));
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i) {
        const Index first = i * stride[0] + j * stride[1] + k * stride[2];
        const Index last = first + stride[0] + stride[1] + stride[2];
        for (std::size_t p = 0; p < paths.size(); ++p) {
          const Index second = first + stride[paths[p][0]], third = second + stride[paths[p][1]];
          mesh.tetrahedron.push_back(p < 3 ? Tetrahedron{first, second, third, last}
                                           : Tetrahedron{first, third, second, last});
        }
      }
  return mesh;
}

void jitter(TetMesh& mesh, double share, const Random& random, const std::vector<bool>& fixed) {
  if (share <= 0.0) return;
  std::vector<bool> stays = fixed;
  stays.resize(mesh.point.size());
  for (const MeshFace& face : faces_of(mesh.tetrahedron))
    if (face.tetrahedra[1] < 0)
      for (const Index v : face.corners) stays[static_cast<std::size_t>(v)] = true;
  std::vector<double> shortest(mesh.point.size(), 1e300);
  std::vector<std::vector<Index>> around(mesh.point.size());
  for (std::size_t t = 0; t < mesh.tetrahedron.size(); ++t)
    for (const Index v : mesh.tetrahedron[t]) {
      around[static_cast<std::size_t>(v)].push_back(static_cast<Index>(t));
      double& least = shortest[static_cast<std::size_t>(v)];
      for (const Index other : mesh.tetrahedron[t])
        if (other != v) least = std::min(least, norm(at(mesh.point, v) - at(mesh.point, other)));
    }
  for (std::size_t i = 0; i < mesh.point.size(); ++i) {
    if (stays[i]) continue;
    const Vec3 before = mesh.point[i];
    Vec3 move = (share * shortest[i]) * in_unit_ball(random, i);
    const auto volume = [&](Index t) {
      return signed_volume(mesh.point, mesh.tetrahedron[static_cast<std::size_t>(t)]);
    };
    std::vector<double> volumes;
    for (const Index t : around[i]) volumes.push_back(volume(t));
    const auto fits = [&] {
      for (std::size_t k = 0; k < volumes.size(); ++k)
        if (volume(around[i][k]) < 0.5 * volumes[k]) return false;
      return true;
    };
    for (int halving = 0; halving < 4; ++halving, move = 0.5 * move) {
      mesh.point[i] = before + move;
      if (fits()) break;
      mesh.point[i] = before;
    }
  }
}

}  // namespace breccia::prepare
