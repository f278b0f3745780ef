#include "prepare/tetrahedra/least_cut.hpp"

#include <algorithm>
#include <limits>

namespace breccia::prepare {

LeastCut::LeastCut(Index nodes) : nodes_(nodes), from_(static_cast<std::size_t>(nodes) + 2) {}

void LeastCut::connect(Index from, Index to, std::int64_t forth, std::int64_t back) {
  from_[static_cast<std::size_t>(from)].push_back(static_cast<Index>(arcs_.size()));
  arcs_.push_back({to, forth});
  from_[static_cast<std::size_t>(to)].push_back(static_cast<Index>(arcs_.size()));
  arcs_.push_back({from, back});
}

bool LeastCut::set_levels() {
  level_.assign(from_.size(), -1);
  level_[static_cast<std::size_t>(source())] = 0;
  std::vector<Index> open{source()};
  for (std::size_t k = 0; k < open.size(); ++k)
    for (const Index a : from_[static_cast<std::size_t>(open[k])]) {
      const Arc& arc = arcs_[static_cast<std::size_t>(a)];
      Index& level = level_[static_cast<std::size_t>(arc.to)];
      if (arc.left <= 0 || level >= 0) continue;
      level = level_[static_cast<std::size_t>(open[k])] + 1;
      open.push_back(arc.to);
    }
  return level_[static_cast<std::size_t>(sink())] >= 0;
}

bool LeastCut::push_one_path() {
  std::vector<Index> path;  // arcs
  Index at = source();
  while (at != sink()) {
    std::size_t& next = next_[static_cast<std::size_t>(at)];
    const std::vector<Index>& arcs = from_[static_cast<std::size_t>(at)];
    if (next == arcs.size()) {  // a dead end: one step back, and never here again
      if (path.empty()) return false;
      at = arcs_[static_cast<std::size_t>(path.back() ^ 1)].to;
      path.pop_back();
      ++next_[static_cast<std::size_t>(at)];
      continue;
    }
    const Arc& arc = arcs_[static_cast<std::size_t>(arcs[next])];
    if (arc.left > 0 &&
        level_[static_cast<std::size_t>(arc.to)] == level_[static_cast<std::size_t>(at)] + 1) {
      path.push_back(arcs[next]);
      at = arc.to;
    } else {
      ++next;
    }
  }
  std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const Index a : path) most = std::min(most, arcs_[static_cast<std::size_t>(a)].left);
  for (const Index a : path) {
    arcs_[static_cast<std::size_t>(a)].left -= most;
    arcs_[static_cast<std::size_t>(a ^ 1)].left += most;
  }
  return true;
}

std::vector<bool> LeastCut::with_source() {
  while (set_levels()) {
    next_.assign(from_.size(), 0);
    while (push_one_path()) {
    }
  }
  std::vector<bool> with(static_cast<std::size_t>(nodes_));
  for (std::size_t k = 0; k < with.size(); ++k) with[k] = level_[k] >= 0;
  return with;
}

}  // namespace breccia::prepare
