#pragma once
// Where sides of the whole mesh are now, for what the host works out in each step.

#include <algorithm>
#include <vector>

#include "domain/together.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// A side with the places of its corners: edges of triangles, faces of tetrahedra.
template <class Shape>
struct SideNow {
  Index side;  ///< corners element + k of the whole mesh  [-]
  typename Shape::Vector at[Shape::dimension];
};

template <class Shape>
struct TellSides {
  static constexpr const char* name = "fdem.tell_sides";
  View<const Index> side, number;  ///< here, and in the whole mesh
  View<const typename Shape::Nodes> nodes;
  View<SideNow<Shape>> told;
  BR_HD void operator()(Index i) const {
    const Index t = side[i] / Shape::corners, k = side[i] % Shape::corners;
    SideNow<Shape> now;
    now.side = number[i];
    for (Index c = 0; c < Shape::dimension; ++c)
      now.at[c] = nodes[t].at[Shape::corner_of_side(k, c)].position;
    told[i] = now;
  }
};

/// Which of the wanted sides this rank owns: their numbers here and in the whole mesh.
template <class World>
void find_own_sides(const World& part, const std::vector<Index>& wanted, std::vector<Index>& here,
                    std::vector<Index>& number) {
  using Shape = ShapeOf<World>;
  std::vector<GlobalId> ids;
  copy_to(ids, Shape::elements(part).id);
  for (const Index side : wanted) {
    const Index element = side / Shape::corners;
    const auto found = std::lower_bound(ids.begin(), ids.end(), element);
    if (found == ids.end() || *found != element) continue;
    const auto t = static_cast<Index>(found - ids.begin());
    if (!part.domain.owns(t)) continue;
    here.push_back(Shape::corners * t + side % Shape::corners);
    number.push_back(side);
  }
}

/// Sides of the whole mesh where they are now, ascending; on ranks all get all.
/// @param wanted  corners element + k
template <class World>
std::vector<SideNow<ShapeOf<World>>> sides_now(const World& part,
                                               const std::vector<Index>& wanted) {
  using Shape = ShapeOf<World>;
  std::vector<Index> here, number;
  if (part.domain.single_rank())
    here = number = wanted;
  else
    find_own_sides(part, wanted, here, number);
  Buffer<Index> sides(part.exec.space), numbers(part.exec.space);
  copy_to(sides, here);
  copy_to(numbers, number);
  Buffer<SideNow<Shape>> told(part.exec.space, sides.size());
  for_each(part.exec, sides.size(),
           TellSides<Shape>{std::as_const(sides).view(), std::as_const(numbers).view(),
                            Shape::elements(part).nodes.view(), told.view()});
  std::vector<SideNow<Shape>> all;
  copy_to(all, told);
  if (!part.domain.single_rank()) all = joined(*part.domain.ranks, all);
  std::sort(all.begin(), all.end(), [](const auto& p, const auto& q) { return p.side < q.side; });
  return all;
}

/// One of them.
template <class Shape>
const SideNow<Shape>& side_in(const std::vector<SideNow<Shape>>& sides, Index number) {
  return *std::lower_bound(sides.begin(), sides.end(), number,
                           [](const auto& s, Index wanted) { return s.side < wanted; });
}

}  // namespace breccia::fdem_shared
