#pragma once
// Mass for the few elements whose stable steps are the shortest: all others then take longer steps.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "exec/types.hpp"

namespace breccia {

/// Mass that was added, and the longer steps that it brings.
struct AddedMass {
  Index elements = 0;   ///< that became heavier
  double share = 0.0;   ///< of the mass that there was  [-]
  double longer = 1.0;  ///< least stable step of all over that before  [-]
};

/// Makes elements heavier, the ones with the shortest steps first, until all steps are as long as a
/// share of the whole mass allows. A step grows with the square root of the mass b that bounds it,
/// so elements with steps below f times the least need b (f / r)^2, r their step over the least:
/// f^2 = (share sum(m) + sum'(b)) / sum'(b / r^2), with sum' over those below f.
/// @param share  of the whole mass that may be added  [-]
/// @param step   stable step of each element; above 1e299: any  [s]
/// @param bears  the mass b of each: its own, or its share of that of all that move with it  [kg]
/// @param mass   of each element, changed  [kg]
/// @returns elements and share; `longer` is f, as far as damping plays no part
inline AddedMass add_mass(double share, const std::vector<double>& step, std::vector<double> bears,
                          std::vector<double>& mass) {
  AddedMass added;
  std::vector<std::size_t> order(step.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return step[a] < step[b]; });
  if (order.empty() || !(step[order.front()] < 1e299) || !(share > 0.0)) return added;
  const double least = step[order.front()];
  const double room = share * std::accumulate(mass.begin(), mass.end(), 0.0);
  double own = 0.0, lightened = 0.0, square = 1.0;  // sum'(b), sum'(b / r^2), f^2
  std::size_t count = 0;
  while (count < order.size()) {
    const double ratio = step[order[count]] / least;
    if (count > 0 && square <= ratio * ratio) break;
    own += bears[order[count]];
    lightened += bears[order[count]] / (ratio * ratio);
    square = (room + own) / lightened;
    ++count;
  }
  double more = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double ratio = step[order[i]] / least;
    const double b = bears[order[i]], heavier = b * std::max(1.0, square / (ratio * ratio));
    more += heavier - b;
    mass[order[i]] = (mass[order[i]] - b) + heavier;
  }
  added.elements = static_cast<Index>(count);
  added.share = share * more / room;
  added.longer = std::sqrt(square);
  return added;
}

}  // namespace breccia
