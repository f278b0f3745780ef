#pragma once
// Which elements lie around a vertex.

#include <algorithm>
#include <vector>

#include "exec/sort_scan.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// All elements around a vertex whose nodes are tied; a rank that owns one needs ghosts of all.
template <class World>
class Rings {
  static constexpr Index corners = ShapeOf<World>::corners;

 public:
  explicit Rings(const World& w) {
    Index count = 0;
    each_corner(w, [&](Index, Index) { ++count; });
    corners_.resize(count);
    KeyedIndex* next = corners_.data();
    each_corner(w, [&](Index vertex, Index corner) {
      *next++ = {static_cast<std::uint64_t>(vertex), corner};
    });
    sort_by_key(w.exec, corners_);
  }
  /// Calls visit(first corner, end) for each ring; corners ascend.
  template <class Visit>
  void each(const Visit& visit) const {
    const KeyedIndex* const last = corners_.data() + corners_.size();
    for (const KeyedIndex* begin = corners_.data(); begin != last;) {
      const KeyedIndex* end = begin;
      while (end != last && end->key == begin->key) ++end;
      visit(begin, end);
      begin = end;
    }
  }
  /// Appends the elements around one vertex.
  void add_elements(Index vertex, std::vector<Index>& elements) const {
    const auto key = static_cast<std::uint64_t>(vertex);
    const auto all = corners_.host();
    auto c = std::partition_point(all.begin(), all.end(),
                                  [key](const KeyedIndex& other) { return other.key < key; });
    for (; c != all.end() && c->key == key; ++c) elements.push_back(c->item / corners);
  }

 private:
  template <class Visit>
  static void each_corner(const World& w, const Visit& visit) {
    if (!w.mesh.bundled) return;
    for (std::size_t n = 0; n < w.vertex.size(); ++n)
      if (w.mesh.tied[static_cast<std::size_t>(w.vertex[n])] != 0)
        visit(w.vertex[n], static_cast<Index>(n));
  }

  Buffer<KeyedIndex> corners_;  ///< by vertex
};

}  // namespace breccia::fdem_shared
