#include "fdem/fluid/fluid.hpp"

#include <algorithm>

#include "core/on_host.hpp"
#include "core/select.hpp"
#include "domain/redistribute.hpp"
#include "domain/together.hpp"
#include "exec/for_each.hpp"

namespace breccia::fdem {
namespace {

/// Broken joints up to a time; the owner of side a tells of them.
struct IsOpenCrack {
  double until;  ///<  [s]
  OwnedView owned;
  View<const JointStage> stage;
  View<const double> broke_at;
  View<const Index> edge_a;
  BR_HD bool operator()(Index i) const {
    return stage[i] == JointStage::broken && broke_at[i] <= until && owned(edge_a[i] / 3);
  }
};

struct TellCrack {
  static constexpr const char* name = "fdem.tell_cracks";
  View<const Index> joint, edge_a, edge_b, vertex;
  View<const GlobalId> id;
  View<const double> length, broke_at;
  View<CrackSide> crack;
  BR_HD void operator()(Index i) const {
    const Index j = joint[i], a = edge_a[j], b = edge_b[j];
    crack[i] = {3 * id[a / 3] + a % 3,
                3 * id[b / 3] + b % 3,
                vertex[a],
                vertex[JointEnds::next_corner(a)],
                length[j],
                broke_at[j]};
  }
};

std::vector<CrackSide> cracks_until(World& part, double until) {
  const Joints& j = part.joints;
  const Buffer<Index> broken =
      items_where(part.exec, j.size(),
                  IsOpenCrack{until, part.domain.owned_view(), j.stage.view(), j.broke_at.view(),
                              j.edge_a.view()});
  Buffer<CrackSide> told(part.exec.space, broken.size());
  for_each(part.exec, broken.size(),
           TellCrack{broken.view(), j.edge_a.view(), j.edge_b.view(), node_vertices(part),
                     std::as_const(part.triangles.id).view(), j.length.view(), j.broke_at.view(),
                     told.view()});
  std::vector<CrackSide> all;
  copy_to(all, told);
  if (!part.domain.single_rank()) all = joined(*part.domain.ranks, all);
  all.insert(all.end(), part.given->open_cracks.begin(), part.given->open_cracks.end());
  std::sort(all.begin(), all.end(),
            [](const CrackSide& p, const CrackSide& q) { return p.a < q.a; });
  return all;
}

void spread_until(World& part, double now) {
  std::vector<LoadedEdge> wet;
  const std::vector<CrackSide> cracks = cracks_until(part, now);
  for (const FluidSource& source : part.given->fluids)
    for (const FilledCrack& filled : filled_cracks(cracks, source.vertices, source.speed, now))
      for (const Index edge : {filled.a, filled.b})
        wet.push_back(
            {edge / 3, static_cast<std::int16_t>(edge % 3), source.load, filled.share, 0.0, 0.0});
  part.fluid.time = now;
  const bool same = std::equal(wet.begin(), wet.end(), part.fluid.wet.begin(), part.fluid.wet.end(),
                               [](const auto& p, const auto& q) {
                                 return p.triangle == q.triangle && p.edge == q.edge &&
                                        p.load == q.load && p.share == q.share;
                               });
  if (same) return;
  part.fluid.wet = std::move(wet);
  list_loaded_edges(part);
}

}  // namespace

std::vector<CrackSide> open_cracks(World& part) {
  return cracks_until(part, part.time);
}

void spread_fluid(World& part) {
  const StageTime timed(part.exec, "fluid");
  spread_until(part, part.time);
}
void restore_fluid(World& part) {
  if (part.fluid.time >= 0.0) spread_until(part, part.fluid.time);
}

void list_loaded_edges(World& w) {
  std::vector<LoadedEdge> all = w.given->loaded;
  all.insert(all.end(), w.fluid.wet.begin(), w.fluid.wet.end());
  std::stable_sort(all.begin(), all.end(), [](const LoadedEdge& a, const LoadedEdge& b) {
    return a.triangle < b.triangle;
  });
  std::vector<LoadedEdge> loaded;
  std::vector<Index> starts, ids;
  copy_to(ids, w.triangles.id);
  auto at = ids.begin();
  for (LoadedEdge& edge : all) {
    at = std::lower_bound(at, ids.end(), edge.triangle);
    if (at == ids.end()) break;
    if (*at != edge.triangle) continue;
    edge.triangle = static_cast<Index>(at - ids.begin());
    if (loaded.empty() || loaded.back().triangle != edge.triangle)
      starts.push_back(static_cast<Index>(loaded.size()));
    loaded.push_back(edge);
  }
  starts.push_back(static_cast<Index>(loaded.size()));
  copy_to(w.loaded_edges, loaded);
  copy_to(w.load_starts, starts);
  w.amplitudes.clear();  // listed anew by the next launches
  w.clock.clear();
  w.graph.clear();
}

FilledPart filled_part(const World& whole, std::size_t load) {
  FilledPart sum;
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, whole.triangles.nodes);
  const auto corner = [&](Index n) {
    return nodes[static_cast<std::size_t>(n / 3)].at[n % 3].position;
  };
  const std::vector<LoadedEdge>& wet = whole.fluid.wet;
  for (std::size_t i = 0; i + 1 < wet.size(); i += 2) {
    if (static_cast<std::size_t>(wet[i].load) != load) continue;
    const JointEnds e =
        JointEnds::of(3 * wet[i].triangle + wet[i].edge, 3 * wet[i + 1].triangle + wet[i + 1].edge);
    const JointOpening<double> o =
        opening_of(corner(e.a0), corner(e.a1), corner(e.b0), corner(e.b1));
    sum.length += wet[i].share * o.size;
    sum.volume += wet[i].share * o.size * std::max(o.open[1], 0.0);
  }
  return sum;
}

}  // namespace breccia::fdem
