#pragma once
// Corners that move as one: those of elements which bonds, or joints that have not woken, tie.

#include <type_traits>

#include "core/kernel.hpp"
#include "exec/buffer.hpp"

namespace breccia::fdem_shared {

/// Corners that move as one: at each vertex where some do, all corners, and who goes with whom.
struct Bundles {
  Buffer<Index> starts;  ///< first corner of each vertex, and the end
  Buffer<Index> nodes;   ///< corners, ascending by global number
  Buffer<Index> leader;  ///< place in `nodes` of the first corner of the same bundle
};

/// Shares the sum of a bundle's forces by mass: all its corners get one acceleration.
/// @tparam Corners  the forces on an element, one vector for each corner
template <class Corners>
struct BundleForces {
  static constexpr const char* name = "fdem.bundles";
  static constexpr Index corners = static_cast<Index>(std::extent_v<decltype(Corners::at)>);
  View<const Index> starts, nodes, leader;
  View<const double> mass;
  View<Corners> force;

  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index vertex) const {
    const Index end = starts[vertex + 1];
    for (Index first = starts[vertex]; first < end; ++first) {
      if (leader[first] != first) continue;
      auto sum = decltype(Corners{}.at[0] + Corners{}.at[0]){};
      double total = 0.0;
      for (Index k = first; k < end; ++k) {
        if (leader[k] != first) continue;
        const Index n = nodes[k];
        sum += force[n / corners].at[n % corners];
        total += mass[n / corners];
      }
      const auto acceleration = (1.0 / total) * sum;
      for (Index k = first; k < end; ++k)
        if (leader[k] == first)
          force[nodes[k] / corners].at[nodes[k] % corners] =
              mass[nodes[k] / corners] * acceleration;
    }
  }
};

}  // namespace breccia::fdem_shared
