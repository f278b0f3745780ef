#include "domain/sharing_sets.hpp"

#include <array>
#include <numeric>

#include "domain/together.hpp"

namespace breccia {
namespace {

/// The largest radius that most elements are below: no more than one of 64 is above it, and those
/// at the top are at least half as large again. Otherwise the largest of all.  [m]
double common_radius(Communicator& ranks, const std::vector<Sphere>& elements) {
  constexpr std::size_t rungs = 48;
  constexpr double rung = 1.189207115002721, fewer = 1.0 / 64.0, much = 1.5;  // 2^(1/4)
  double largest = 0.0;
  for (const Sphere& e : elements) largest = std::max(largest, e.radius);
  largest = -ranks.least(-largest);
  if (!(largest > 0.0)) return largest;
  std::array<double, rungs> bound;
  for (std::size_t i = 0; i < rungs; ++i) bound[i] = i == 0 ? largest : bound[i - 1] / rung;
  std::array<std::int64_t, rungs + 1> above{};  // each bound, and all elements
  for (const Sphere& e : elements) {
    std::size_t i = 0;
    while (i < rungs && !(e.radius > bound[i])) ++i;
    if (i < rungs) ++above[i];
  }
  for (std::size_t i = 1; i < rungs; ++i) above[i] += above[i - 1];  // above higher ones, too
  above[rungs] = static_cast<std::int64_t>(elements.size());
  ranks.add_up(above);
  std::size_t lowest = 0;
  while (lowest + 1 < rungs &&
         static_cast<double>(above[lowest + 1]) <= fewer * static_cast<double>(above[rungs]))
    ++lowest;
  double common = 0.0;
  for (const Sphere& e : elements)
    if (e.radius <= bound[lowest]) common = std::max(common, e.radius);
  common = -ranks.least(-common);
  return largest > much * common ? common : largest;
}

}  // namespace

double SharingSets::buffer(double radius) const {
  return is_large(radius)
             ? std::max(migration_buffer_.buffer, migration_buffer_.per_size * 2.0 * radius)
             : migration_buffer_.buffer;
}

void SharingSets::build(Communicator& ranks, const std::vector<Sphere>& elements,
                        const std::vector<int>& owners, const MigrationBuffer& migration_buffer) {
  migration_buffer_ = migration_buffer;
  constexpr double stretched = 1.05;  // an element may be, meanwhile
  common_ = stretched * common_radius(ranks, elements);
  std::vector<Large> own;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Sphere& s = elements[e];
    if (!is_large(s.radius)) continue;
    own.push_back({s.centre, (s.radius + buffer(s.radius)) * (1.0 + 1e-6), owners[e]});
  }
  large_ = joined(ranks, own);
  widest_ = 0.0;
  for (const Large& l : large_) widest_ = std::max(widest_, l.width);
  sort_into_rows();
}

void SharingSets::sort_into_rows() {
  row_starts_.clear();
  if (large_.empty()) return;
  double rows_end = rows_begin_ = large_.front().centre.x;
  for (const Large& l : large_) {
    rows_begin_ = std::min(rows_begin_, l.centre.x);
    rows_end = std::max(rows_end, l.centre.x);
  }
  // Wide enough that a search meets few rows, and that few of them are empty.
  const auto most = static_cast<double>(large_.size());
  row_width_ = std::max(2.0 * (common_ + widest_ + reach()), (rows_end - rows_begin_) / most);
  if (!(row_width_ > 0.0)) row_width_ = 1.0;
  const double rows = std::min(std::floor((rows_end - rows_begin_) / row_width_) + 1.0, most);
  row_starts_.assign(rows > 1.0 ? static_cast<std::size_t>(rows) + 1 : 2, 0);
  std::sort(large_.begin(), large_.end(), [this](const Large& a, const Large& b) {
    const std::size_t row = row_of(a.centre.x), other = row_of(b.centre.x);
    return row < other || (row == other && a.centre.y < b.centre.y);
  });
  for (const Large& l : large_) ++row_starts_[row_of(l.centre.x) + 1];
  std::partial_sum(row_starts_.begin(), row_starts_.end(), row_starts_.begin());
}

}  // namespace breccia
