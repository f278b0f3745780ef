#include "domain/domain.hpp"

#include <cmath>

namespace breccia {

DomainFacts domain_facts(Communicator& ranks, const DomainCounts& own, double waited) {
  std::vector<std::int64_t> sums{own.moved, own.ghosts, own.owned, own.weighed,
                                 std::llround(1e9 * waited)};
  ranks.add_up(sums);
  const double largest = -ranks.least(-static_cast<double>(own.weighed));
  DomainFacts facts{ranks.size(), own.migrations, own.cuts, sums[0]};
  facts.waited_least = ranks.least(waited);
  facts.waited_most = -ranks.least(-waited);
  facts.waited_mean = 1e-9 * static_cast<double>(sums[4]) / ranks.size();
  if (sums[2] > 0) facts.ghosts = static_cast<double>(sums[1]) / static_cast<double>(sums[2]);
  if (sums[3] > 0) facts.imbalance = largest * ranks.size() / static_cast<double>(sums[3]) - 1.0;
  return facts;
}

namespace {

/// Parts the runs of packs: those with one of these elements, and the others.
void part_runs(Domain& d, const Buffer<Index>& elements) {
  constexpr Index pack = 8;
  std::vector<std::uint8_t> boundary(static_cast<std::size_t>(d.owned.size() / pack + 1), 0);
  for (const Index e : elements.host()) boundary[static_cast<std::size_t>(e / pack)] = 1;
  d.boundary_runs.clear();
  d.interior_runs.clear();
  for (const ElementRun& run : d.runs)
    for (Index begin = run.begin; begin < run.end; begin += pack) {
      std::vector<ElementRun>& part =
          boundary[static_cast<std::size_t>(begin / pack)] != 0 ? d.boundary_runs : d.interior_runs;
      if (part.empty() || part.back().end != begin) part.push_back({begin, begin});
      part.back().end = std::min(begin + pack, run.end);
    }
}

}  // namespace

void Domain::select_active_ghosts(const Buffer<GlobalId>& ids, const Buffer<Index>& a,
                                  const Buffer<Index>& b) {
  if (single_rank()) return;
  std::vector<std::uint8_t> wanted = tied;
  for (const Buffer<Index>* ends : {&a, &b})
    for (const Index e : ends->host()) wanted[static_cast<std::size_t>(e)] = 1;
  std::vector<Ghost> followed;
  for (const Ghost& ghost : ghosts)
    if (wanted[static_cast<std::size_t>(ghost.element)] != 0) followed.push_back(ghost);
  active_ghosts.build(*ranks, ids, followed);
  part_runs(*this, active_ghosts.sent());
  ghosts_selected = true;
}

}  // namespace breccia
