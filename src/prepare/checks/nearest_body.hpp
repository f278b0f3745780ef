#pragma once
// Which body is nearest to a region, and how far it is.

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "prepare/checks/outlines.hpp"

namespace breccia::prepare {

/// Along the axis along which they are furthest apart; 0 if they meet.  [m]
std::pair<double, std::size_t> gap(const Bounds& a, const Bounds& b);

/// Widens a box to a place.
void add_to(Bounds& b, const std::array<double, 3>& at);

/// A coordinate as people write it.
std::string place(double x);

/// The body nearest to a region, how far it is away, and along which axis.
struct Nearest {
  const Outline* body = nullptr;  ///< none: the region may take something, or no outline is known
  double away = 0.0;              ///<  [m]
  std::size_t axis = 0;
};
/// @param on  the one body that counts; empty: all
Nearest nearest_to(const Bounds& region, const std::string& on,
                   const std::vector<Outline>& outlines);

/// The problem of a region; empty: it may take something, or no outline is known.
std::string problem_of(const std::string& key, const Bounds& region, const std::string& on,
                       const std::vector<Outline>& outlines);

}  // namespace breccia::prepare
