#include "fdem/fluid/cavity.hpp"

#include <algorithm>
#include <map>

#include "exec/error.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/shape.hpp"

namespace breccia::fdem {

std::vector<std::vector<Index>> holes_along(const Model& model, const std::vector<Index>& edges,
                                            const std::string& where) {
  const auto vertex = [&](Index edge, Index end) {
    return model.triangle[at(edge / 3)][at((edge + end) % 3)];
  };
  std::map<Index, Index> starting;  // at a vertex
  for (const Index edge : edges)
    if (!starting.emplace(vertex(3 * (edge / 3) + edge % 3, 0), edge).second)
      throw InputError(where + ": two borders of its region meet at one point");
  std::vector<std::vector<Index>> holes;
  while (!starting.empty()) {
    std::vector<Index> hole;
    double twice = 0.0;
    for (auto next = starting.begin(); next != starting.end();) {
      const Index edge = next->second;
      starting.erase(next);
      hole.push_back(edge);
      const Index t = edge / 3, k = edge % 3;
      const Index from = model.triangle[at(t)][at(k)], to = model.triangle[at(t)][at((k + 1) % 3)];
      twice += cross(model.point[at(from)], model.point[at(to)]);
      next = starting.find(to);
      const Index first = hole.front();
      if (next == starting.end() && to != model.triangle[at(first / 3)][at(first % 3)])
        throw InputError(where +
                         ": its region takes a part of a border only; an explosive needs "
                         "the whole wall of a hole");
    }
    if (twice > 0.0)
      throw InputError(where +
                       ": its region takes the outer border of a body; an explosive lies "
                       "in a hole");
    holes.push_back(std::move(hole));
  }
  return holes;
}

double volume_within(const std::vector<Index>& hole, const std::vector<EdgeNow>& edges) {
  const Vec2 origin = side_in(edges, hole.front()).at[0];
  double twice = 0.0;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const EdgeNow& e = side_in(edges, hole[i]);
    const Vec2 next = side_in(edges, hole[(i + 1) % hole.size()]).at[0];
    twice -= cross(e.at[0] - origin, e.at[1] - origin) + cross(e.at[1] - origin, next - origin);
  }
  return 0.5 * twice;
}

}  // namespace breccia::fdem
