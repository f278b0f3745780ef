#include "fdem/edges_now.hpp"

#include <algorithm>

#include "domain/redistribute.hpp"
#include "domain/together.hpp"
#include "exec/for_each.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {
namespace {

struct TellEdge {
  static constexpr const char* name = "fdem.tell_edges";
  View<const Index> edge, number;  ///< here, and in the whole mesh
  View<const NodeState> nodes;
  View<EdgeNow> told;
  BR_HD void operator()(Index i) const {
    const Index here = edge[i];
    told[i] = {number[i], nodes[here].position, nodes[JointEnds::next_corner(here)].position};
  }
};

/// Which of the wanted edges this rank owns: their numbers here and in the whole mesh.
void find_own(World& part, const std::vector<Index>& wanted, std::vector<Index>& here,
              std::vector<Index>& number) {
  std::vector<GlobalId> ids;
  copy_to(ids, part.triangles.id);
  for (const Index edge : wanted) {
    const auto found = std::lower_bound(ids.begin(), ids.end(), edge / 3);
    if (found == ids.end() || *found != edge / 3) continue;
    const auto t = static_cast<Index>(found - ids.begin());
    if (!part.domain.owns(t)) continue;
    here.push_back(3 * t + edge % 3);
    number.push_back(edge);
  }
}

}  // namespace

std::vector<EdgeNow> edges_now(World& part, const std::vector<Index>& wanted) {
  std::vector<Index> here, number;
  if (part.domain.single_rank())
    here = number = wanted;
  else
    find_own(part, wanted, here, number);
  Buffer<Index> edges(part.exec.space), numbers(part.exec.space);
  copy_to(edges, here);
  copy_to(numbers, number);
  Buffer<EdgeNow> told(part.exec.space, edges.size());
  for_each(part.exec, edges.size(),
           TellEdge{std::as_const(edges).view(), std::as_const(numbers).view(),
                    by_number(std::as_const(part.triangles.nodes).view()), told.view()});
  std::vector<EdgeNow> all;
  copy_to(all, told);
  if (!part.domain.single_rank()) all = joined(*part.domain.ranks, all);
  std::sort(all.begin(), all.end(),
            [](const EdgeNow& p, const EdgeNow& q) { return p.edge < q.edge; });
  return all;
}

const EdgeNow& edge_in(const std::vector<EdgeNow>& edges, Index number) {
  return *std::lower_bound(edges.begin(), edges.end(), number,
                           [](const EdgeNow& e, Index wanted) { return e.edge < wanted; });
}

}  // namespace breccia::fdem
