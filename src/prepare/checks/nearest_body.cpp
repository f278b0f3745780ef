#include "prepare/checks/nearest_body.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/round_numbers.hpp"

namespace breccia::prepare {

std::pair<double, std::size_t> gap(const Bounds& a, const Bounds& b) {
  std::pair<double, std::size_t> most{0.0, 0};
  for (std::size_t k = 0; k < 3; ++k)
    most = std::max(most, {std::max(a.low[k] - b.high[k], b.low[k] - a.high[k]), k});
  return most;
}

std::string place(double x) {
  return x < 0.0 ? "-" + length_text(-x) : x > 0.0 ? length_text(x) : "0 m";
}

Nearest nearest_to(const Bounds& region, const std::string& on,
                   const std::vector<Outline>& outlines) {
  for (std::size_t k = 0; k < 3; ++k)
    if (region.low[k] > region.high[k]) return {};  // check_case tells
  const Outline* nearest = nullptr;
  std::pair<double, std::size_t> least{0.0, 0};
  for (const Outline& outline : outlines) {
    if (!on.empty() && outline.name != on) continue;
    if (outline.in_another && on.empty()) continue;
    if (!outline.bounds) return {};
    const auto apart = gap(region, *outline.bounds);
    if (apart.first <= 1e-9) return {};
    if (nearest == nullptr || apart < least) {
      least = apart;
      nearest = &outline;
    }
  }
  return {nearest, least.first, least.second};
}

std::string problem_of(const std::string& key, const Bounds& region, const std::string& on,
                       const std::vector<Outline>& outlines) {
  const auto [nearest, away, axis] = nearest_to(region, on, outlines);
  if (nearest == nullptr) return "";
  constexpr std::array<char, 3> axes{'x', 'y', 'z'};
  const bool below = region.high[axis] < nearest->bounds->low[axis];
  return fmt::format(
      "{}.{} = {}: the region takes nothing; {} is nearest, {} away, with {} from {} to {}", key,
      below ? "max" : "min", place(below ? region.high[axis] : region.low[axis]), nearest->name,
      length_text(away), axes[axis], place(nearest->bounds->low[axis]),
      place(nearest->bounds->high[axis]));
}

void add_to(Bounds& b, const std::array<double, 3>& at) {
  for (std::size_t k = 0; k < 3; ++k) {
    b.low[k] = std::min(b.low[k], at[k]);
    b.high[k] = std::max(b.high[k], at[k]);
  }
}

}  // namespace breccia::prepare
