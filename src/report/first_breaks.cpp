#include "report/first_breaks.hpp"

#include <algorithm>
#include <limits>

namespace breccia::report {

void leave_first(const Record& record, const Shot& shot, std::vector<std::uint8_t>& broken) {
  constexpr double near = 0.05;  // of the diagonal of all that breaks
  if (record.breaks.empty() || !record.breaks.front().at) return;
  Vec3 low = *record.breaks.front().at, high = low;
  for (const Break& b : record.breaks) {
    low = {std::min(low.x, b.at->x), std::min(low.y, b.at->y), std::min(low.z, b.at->z)};
    high = {std::max(high.x, b.at->x), std::max(high.y, b.at->y), std::max(high.z, b.at->z)};
  }
  const Vec3 first = *record.breaks.front().at;
  double least = std::numeric_limits<double>::max();
  for (std::size_t l = 0; l < broken.size(); ++l)
    if (broken[l] != 0) least = std::min(least, norm(shot.middle(l) - first));
  for (std::size_t l = 0; l < broken.size(); ++l)
    if (norm(shot.middle(l) - first) > least + near * norm(high - low)) broken[l] = 0;
}

Vec3 middle_of(const Shot& shot, const std::vector<std::uint8_t>& broken) {
  Vec3 sum{};
  double count = 0.0;
  for (std::size_t l = 0; l < broken.size(); ++l) {
    if (broken[l] == 0) continue;
    sum = sum + shot.middle(l);
    count += 1.0;
  }
  return (1.0 / count) * sum;
}

}  // namespace breccia::report
