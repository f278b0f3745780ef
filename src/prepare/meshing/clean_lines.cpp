#include "prepare/meshing/clean_lines.hpp"

#include <algorithm>
#include <set>

namespace breccia::prepare {
namespace {

using Line = std::array<Vec2, 2>;
using Ends = std::array<std::size_t, 2>;  ///< points of a line

class Net {
 public:
  Net(const std::vector<Line>& lines, const std::vector<Line>& rim, double tolerance)
      : tolerance_(tolerance) {
    for (const Line& line : rim) rim_.push_back({added(line[0]), added(line[1])});
    fixed_ = points_.size();
    for (const Line& line : lines) lines_.push_back({added(line[0]), added(line[1])});
  }

  /// @returns whether anything was merged
  bool clean() {
    constexpr int rounds = 20;  // two or three are enough, unless lines keep bending into others
    for (int k = 0; k < rounds; ++k) {
      split_at_crossings();
      const bool moved = merge_points();
      if (!split_at_points() && !moved) break;
      merge_lines();
    }
    return merged_;
  }
  std::vector<Line> lines() const {
    std::vector<Line> all;
    for (const Ends& line : lines_) all.push_back({points_[line[0]], points_[line[1]]});
    return all;
  }

 private:
  std::size_t added(const Vec2& at) {
    points_.push_back(at);
    return points_.size() - 1;
  }
  static bool is_within(const Vec2& a, const Vec2& b, double way) {
    return dot(a - b, a - b) < way * way;
  }
  bool is_at(const Vec2& a, const Vec2& b) const { return is_within(a, b, 1e-6 * tolerance_); }

  /// Splits a line at a point; the second part is a new line.
  void split(std::size_t line, std::size_t at) {
    lines_.push_back({at, lines_[line][1]});
    lines_[line][1] = at;
  }

  /// Lines that are added on the way are compared with all before them.
  void split_at_crossings() {
    for (std::size_t i = 0; i < lines_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        Vec2 place;
        if (!cross_at(lines_[i], lines_[j], place)) continue;
        const std::size_t p = added(place);
        split(i, p);
        split(j, p);
      }
  }
  bool cross_at(const Ends& a, const Ends& b, Vec2& place) const {
    for (const std::size_t p : a)
      if (p == b[0] || p == b[1]) return false;
    const Vec2 u = points_[a[1]] - points_[a[0]], v = points_[b[1]] - points_[b[0]];
    const Vec2 between = points_[b[0]] - points_[a[0]];
    const double turn = cross(u, v);
    if (turn == 0.0) return false;
    const double s = cross(between, v) / turn, t = cross(between, u) / turn;
    if (!(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)) return false;
    place = points_[a[0]] + s * u;
    return true;
  }

  /// Points near each other become the first of them; points near the rim move onto it.
  /// @returns whether any did
  bool merge_points() {
    std::vector<std::size_t> first;  // of each group of points, those of the rim before all others
    for (std::size_t p = 0; p < fixed_; ++p) first.push_back(p);
    std::vector<std::size_t> of(points_.size());
    bool any = false;
    for (const std::size_t p : used_points()) {
      const auto near = std::find_if(first.begin(), first.end(), [&](std::size_t q) {
        return is_within(points_[p], points_[q], tolerance_);
      });
      of[p] = near == first.end() ? p : *near;
      if (near == first.end()) {
        any = to_rim(points_[p]) || any;
        first.push_back(p);
      } else {
        any = any || !is_at(points_[p], points_[*near]);
      }
    }
    for (Ends& line : lines_) line = {of[line[0]], of[line[1]]};
    merged_ = merged_ || any;
    return any;
  }
  std::set<std::size_t> used_points() const {
    std::set<std::size_t> used;
    for (const Ends& line : lines_) used.insert(line.begin(), line.end());
    return used;
  }
  bool to_rim(Vec2& point) const {
    for (const Ends& side : rim_) {
      Vec2 foot;
      if (!foot_on(side, point, foot) || is_at(point, foot)) continue;
      point = foot;
      return true;
    }
    return false;
  }
  /// The nearest place on a line between its ends, if it is within the tolerance.
  bool foot_on(const Ends& line, const Vec2& point, Vec2& foot) const {
    const Vec2& from = points_[line[0]];
    const Vec2 along = points_[line[1]] - from;
    const double s = dot(point - from, along) / dot(along, along);
    foot = from + s * along;
    return s > 0.0 && s < 1.0 && is_within(point, foot, tolerance_);
  }

  /// Lines bend to the points that they pass nearby.
  bool split_at_points() {
    std::set<std::size_t> points = used_points();
    for (std::size_t p = 0; p < fixed_; ++p) points.insert(p);
    bool any = false;
    const std::size_t count = lines_.size();
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::pair<double, std::size_t>> passed;  // by the square of the way to it
      const Ends line = lines_[i];
      if (line[0] == line[1]) continue;
      for (const std::size_t p : points) {
        Vec2 foot;
        if (p == line[0] || p == line[1] || !foot_on(line, points_[p], foot)) continue;
        any = any || !is_at(points_[p], foot);
        const Vec2 way = foot - points_[line[0]];
        passed.emplace_back(dot(way, way), p);
      }
      std::sort(passed.begin(), passed.end());
      std::size_t part = i;
      for (const auto& [way, p] : passed) {
        split(part, p);
        part = lines_.size() - 1;
      }
    }
    merged_ = merged_ || any;
    return any;
  }

  /// Each line once, and none from a point to itself.
  void merge_lines() {
    std::set<Ends> seen;
    std::vector<Ends> kept;
    for (const Ends& line : lines_) {
      if (line[0] == line[1]) continue;
      if (seen.insert({std::min(line[0], line[1]), std::max(line[0], line[1])}).second)
        kept.push_back(line);
    }
    lines_ = std::move(kept);
  }

  double tolerance_;
  std::vector<Vec2> points_;
  std::size_t fixed_ = 0;  ///< points of the rim
  std::vector<Ends> rim_, lines_;
  bool merged_ = false;
};

}  // namespace

std::vector<Line> cleaned(const std::vector<Line>& lines, const std::vector<Line>& rim,
                          double tolerance) {
  Net net(lines, rim, tolerance);
  return net.clean() ? net.lines() : lines;
}

}  // namespace breccia::prepare
