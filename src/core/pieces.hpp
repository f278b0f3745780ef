#pragma once
// Pieces that items make which hold together.

#include <algorithm>
#include <numeric>
#include <vector>

#include "exec/types.hpp"

namespace breccia {

/// Sets of joined items; the root of a set is its lowest item.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0); }

  Index root(Index item) {
    while (root_[at(item)] != item) item = root_[at(item)] = root_[at(root_[at(item)])];
    return item;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    root_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<Index> root_;
};

}  // namespace breccia
