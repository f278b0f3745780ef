#pragma once
// Which triangles lie around a vertex.

#include <algorithm>
#include <utility>
#include <vector>

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Triangles around each vertex where corners move as one: what one of them does, all must know.
class Rings {
 public:
  explicit Rings(const World& w) {
    for (std::size_t n = 0; n < w.vertex.size(); ++n)
      if (w.mesh.tied[static_cast<std::size_t>(w.vertex[n])] != 0)
        corners_.push_back({w.vertex[n], static_cast<Index>(n)});
    std::sort(corners_.begin(), corners_.end());
  }
  /// Calls visit(first corner, end) for each ring; corners ascend.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < corners_.size();) {
      std::size_t end = i;
      while (end < corners_.size() && corners_[end].first == corners_[i].first) ++end;
      visit(corners_.data() + i, corners_.data() + end);
      i = end;
    }
  }
  /// Those around one vertex, behind what is listed.
  void add_triangles(Index vertex, std::vector<Index>& triangles) const {
    const auto first =
        std::lower_bound(corners_.begin(), corners_.end(), std::pair<Index, Index>{vertex, -1});
    for (auto c = first; c != corners_.end() && c->first == vertex; ++c)
      triangles.push_back(c->second / 3);
  }

 private:
  std::vector<std::pair<Index, Index>> corners_;  ///< vertex and corner
};

}  // namespace breccia::fdem
