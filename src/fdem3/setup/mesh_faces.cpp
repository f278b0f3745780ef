#include "fdem3/setup/mesh_faces.hpp"

#include "exec/error.hpp"
#include "exec/tasks.hpp"

namespace breccia::fdem3 {
namespace {

/// A side of those whose lowest vertex is the same.
struct Side {
  Index middle, high;  ///< its other vertices
  Index number;
  bool same_face(const Side& other) const { return middle == other.middle && high == other.high; }
};

[[noreturn]] void refuse_third(Index a, Index b, Index c) {
  throw InputError("tetrahedra " + std::to_string(a / 4) + ", " + std::to_string(b / 4) + " and " +
                   std::to_string(c / 4) + " share one face");
}

}  // namespace

/// Sides are put together by their lowest vertices: a few each, which are sorted by themselves.
std::vector<Index> sides_across(const Model& model, int threads) {
  const auto sides = static_cast<Index>(4 * model.tetrahedron.size());
  const auto vertices = static_cast<Index>(model.point.size());
  std::vector<Index> end(model.point.size() + 1, 0);  // of each vertex' sides
  for (Index s = 0; s < sides; ++s) ++end[at(vertices_of(model, s)[0]) + 1];
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Index> listed(at(sides));
  for (Index s = 0; s < sides; ++s) listed[at(end[at(vertices_of(model, s)[0])]++)] = s;

  std::vector<Index> across(at(sides), -1);
  const auto pair_up = [&](std::vector<Side>& around) {
    std::sort(around.begin(), around.end(), [](const Side& p, const Side& q) {
      return p.middle != q.middle ? p.middle < q.middle
             : p.high != q.high   ? p.high < q.high
                                  : p.number < q.number;
    });
    for (std::size_t k = 1; k < around.size(); ++k) {
      const Side &one = around[k - 1], &other = around[k];
      if (!one.same_face(other)) continue;
      if (across[at(one.number)] >= 0)
        refuse_third(across[at(one.number)], one.number, other.number);
      across[at(one.number)] = other.number;
      across[at(other.number)] = one.number;
    }
  };
  constexpr Index portion = 4096;
  for_each_task(threads, (vertices + portion - 1) / portion, [&](int part) {
    std::vector<Side> around;
    for (Index v = part * portion; v < std::min(vertices, (part + 1) * portion); ++v) {
      around.clear();
      for (Index k = v > 0 ? end[at(v - 1)] : 0; k < end[at(v)]; ++k) {
        const auto corners = vertices_of(model, listed[at(k)]);
        around.push_back({corners[1], corners[2], listed[at(k)]});
      }
      pair_up(around);
    }
  });
  return across;
}

}  // namespace breccia::fdem3
