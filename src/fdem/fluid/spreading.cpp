#include "fdem/fluid/spreading.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace breccia::fdem {
namespace {

constexpr double never = 1e300;

/// The earliest time at which fluid is at each vertex that it has reached.
std::map<Index, double> arrivals(const std::vector<CrackSide>& cracks,
                                 const std::vector<Index>& sources, double speed, double now) {
  std::vector<std::pair<Index, std::size_t>> at_vertex;
  at_vertex.reserve(2 * cracks.size());
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    at_vertex.emplace_back(cracks[i].from, i);
    at_vertex.emplace_back(cracks[i].to, i);
  }
  std::sort(at_vertex.begin(), at_vertex.end());
  using Front = std::pair<double, Index>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  std::map<Index, double> reached;
  for (const Index vertex : sources)
    if (reached.emplace(vertex, 0.0).second) fronts.emplace(0.0, vertex);
  while (!fronts.empty()) {
    const auto [time, vertex] = fronts.top();
    fronts.pop();
    if (time > reached.at(vertex)) continue;
    for (auto next = std::lower_bound(at_vertex.begin(), at_vertex.end(),
                                      std::make_pair(vertex, std::size_t{0}));
         next != at_vertex.end() && next->first == vertex; ++next) {
      const CrackSide& crack = cracks[next->second];
      const double way = speed > 0.0 ? crack.length / speed : 0.0;
      const double there = std::max(time, crack.since) + way;
      const Index other = crack.from == vertex ? crack.to : crack.from;
      if (there > now) continue;
      const auto found = reached.emplace(other, never).first;
      if (there >= found->second) continue;
      found->second = there;
      fronts.emplace(there, other);
    }
  }
  return reached;
}

}  // namespace

std::vector<FilledCrack> filled_cracks(const std::vector<CrackSide>& cracks,
                                       const std::vector<Index>& sources, double speed,
                                       double now) {
  const std::map<Index, double> reached = arrivals(cracks, sources, speed, now);
  std::vector<FilledCrack> filled;
  for (const CrackSide& crack : cracks) {
    double share = 0.0;
    for (const Index vertex : {crack.from, crack.to}) {
      const auto found = reached.find(vertex);
      if (found == reached.end()) continue;
      const double spent = now - std::max(found->second, crack.since);
      if (spent < 0.0) continue;
      share += speed > 0.0 ? spent * speed / crack.length : 1.0;
    }
    if (share > 0.0) filled.push_back({crack.a, crack.b, std::min(share, 1.0), crack.length});
  }
  return filled;
}

}  // namespace breccia::fdem
