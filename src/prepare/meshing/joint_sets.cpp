#include "prepare/meshing/joint_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "prepare/csv_numbers.hpp"
#include "prepare/meshing/length_law.hpp"
#include "prepare/meshing/set_problems.hpp"
#include "prepare/meshing/wkt.hpp"

namespace breccia::prepare {
namespace {

using fdem::DiscontinuityConfig;
using fdem::JointSetConfig;

constexpr std::uint32_t set_stream = 0x40000;  ///< of random numbers; one more for each set

std::vector<std::vector<Vec2>> lines_of_file(const std::string& path) {
  std::vector<std::vector<Vec2>> lines;
  if (path.ends_with(".wkt")) {
    for (const std::vector<Vec3>& line : lines_of_wkt(path)) {
      lines.emplace_back();
      for (const Vec3& point : line) lines.back().push_back({point.x, point.y});
    }
    return lines;
  }
  read_csv(path, 4, "x1,y1,x2,y2 in metres", [&](const std::vector<double>& v) {
    lines.push_back({{v[0], v[1]}, {v[2], v[3]}});
    return true;
  });
  return lines;
}

LengthLaw law_of(const JointSetConfig& set) {
  return {set.length_law,      set.length, set.length_deviation,
          set.length_exponent, set.least,  set.most};
}

constexpr double most_lines = 1e6;  ///< of a set

/// Rows of regular lines on either side of the middle one, and lines of a row likewise.
struct Rows {
  double rows, pieces, period, piece;
  explicit Rows(const JointSetConfig& set) {
    const double reach = 0.5 * norm(set.max - set.min);
    piece = set.length > 0.0 ? set.length : 2.0 * reach;
    period = piece + (set.length > 0.0 ? set.gap : 0.0);
    rows = std::floor(reach / set.spacing);
    pieces = set.length > 0.0 ? std::ceil(reach / period) + 1.0 : 0.0;
  }
  double lines() const { return (2.0 * rows + 1.0) * (2.0 * pieces + 1.0); }
};

/// Draws lines one after the other; a number of uniform values for each.
class Drawn {
 public:
  Drawn(const JointSetConfig& set, const Random& random) : set_(set), random_(random) {}

  std::vector<std::vector<Vec2>> lines() { return set_.spacing > 0.0 ? regular() : random(); }

 private:
  /// Lines through the rectangle, counted from its middle, which one of them crosses.
  std::vector<std::vector<Vec2>> regular() const {
    const Vec2 along{std::cos(set_.angle), std::sin(set_.angle)}, across{-along.y, along.x};
    const Vec2 middle = 0.5 * (set_.min + set_.max);
    const Rows of(set_);
    const auto rows = static_cast<int>(of.rows), pieces = static_cast<int>(of.pieces);
    std::vector<std::vector<Vec2>> all;
    for (int row = -rows; row <= rows; ++row)
      for (int k = -pieces; k <= pieces; ++k) {
        const double shift = (k + (row % 2 != 0 ? 0.5 : 0.0)) * of.period;
        const Vec2 at =
            middle + (row * set_.spacing) * across + (set_.length > 0.0 ? shift : 0.0) * along;
        Vec2 from = at - (0.5 * of.piece) * along, to = at + (0.5 * of.piece) * along;
        if (cut(from, to) && norm(to - from) > 1e-9 * of.piece) all.push_back({from, to});
      }
    return all;
  }
  std::vector<std::vector<Vec2>> random() {
    const Vec2 size = set_.max - set_.min;
    // Of middles beyond the rectangle; the same for all lengths, or long lines were too few.
    const double reach = 0.5 * law_of(set_).longest();
    double missing = set_.intensity * size.x * size.y;
    std::vector<std::vector<Vec2>> all;
    for (; missing > 0.0; ++line_) {
      if (line_ >= static_cast<std::uint64_t>(most_lines))
        throw InputError(fmt::format(
            "after {:.0f} random lines the rectangle has {:.3g} m of the {:.3g} m that its "
            "intensity asks for",
            most_lines, set_.intensity * size.x * size.y - missing,
            set_.intensity * size.x * size.y));
      const double length = law_of(set_).drawn(random_, line_);
      const double angle = set_.angle + set_.spread * normal_of(random_, line_, 0);
      const Vec2 half = (0.5 * length) * Vec2{std::cos(angle), std::sin(angle)};
      const Vec2 middle{set_.min.x - reach + (size.x + 2.0 * reach) * random_.uniform(line_, 2),
                        set_.min.y - reach + (size.y + 2.0 * reach) * random_.uniform(line_, 3)};
      Vec2 from = middle - half, to = middle + half;
      if (!cut(from, to)) continue;
      const double inside = norm(to - from);
      if (inside < 1e-9 * length) continue;
      if (inside > missing) to = from + (missing / inside) * (to - from);
      missing -= std::min(inside, missing);
      all.push_back({from, to});
    }
    return all;
  }

  /// The part of a line inside the rectangle; false: none. (Liang and Barsky)
  bool cut(Vec2& from, Vec2& to) const {
    const Vec2 way = to - from;
    double begin = 0.0, end = 1.0;
    const auto side = [&](double speed, double room) {
      if (speed == 0.0) return room >= 0.0;
      const double t = room / speed;
      (speed < 0.0 ? begin : end) = speed < 0.0 ? std::max(begin, t) : std::min(end, t);
      return begin <= end;
    };
    if (!side(-way.x, from.x - set_.min.x) || !side(way.x, set_.max.x - from.x) ||
        !side(-way.y, from.y - set_.min.y) || !side(way.y, set_.max.y - from.y))
      return false;
    const Vec2 start = from;
    from = start + begin * way;
    to = start + end * way;
    return true;
  }

  const JointSetConfig& set_;
  Random random_;
  std::uint64_t line_ = 0;
};

}  // namespace

std::vector<DiscontinuityConfig> lines_of_set(const JointSetConfig& set, std::int64_t seed,
                                              std::size_t number, const std::string& case_folder) {
  std::vector<std::vector<Vec2>> lines;
  if (set.file.empty())
    lines = Drawn(set, {static_cast<std::uint64_t>(seed),
                        set_stream + static_cast<std::uint32_t>(number)})
                .lines();
  else
    lines = lines_of_file((std::filesystem::path(case_folder) / set.file).string());
  std::vector<DiscontinuityConfig> all;
  for (std::vector<Vec2>& line : lines) {
    line.erase(std::unique(line.begin(), line.end(),
                           [](const Vec2& a, const Vec2& b) { return norm(a - b) == 0.0; }),
               line.end());
    if (line.size() < 2) throw InputError(fmt::format("{}: a line has no length", set.file));
    all.push_back({set.name, std::move(line), set.kind, set.material, set.embedded});
  }
  if (all.empty()) throw InputError("it has no line");
  return all;
}

std::vector<std::string> joint_set_problems(const JointSetConfig& set,
                                            const std::vector<std::string>& joints) {
  std::vector<std::string> problems;
  const auto require = [&](bool holds, const std::string& text) {
    if (!holds) problems.push_back("joint_set." + set.name + text);
  };
  const auto refuse_many = [&](const char* key, double lines) {
    require(lines <= most_lines, fmt::format("{}: about {:.3g} lines; at most {:.0f} are possible",
                                             key, lines, most_lines));
  };
  if (check_shared_keys(set, joints, "lines", require)) return problems;
  require(set.max.x > set.min.x && set.max.y > set.min.y,
          ": random lines need the rectangle that they fill, min and max");
  if (set.spacing > 0.0) {
    require(set.intensity == 0.0, ".intensity is of random lines, and spacing makes regular ones");
    require(set.gap == 0.0 || set.length > 0.0, ".gap is between lines that have a length");
    refuse_many(".spacing", Rows(set).lines());
    return problems;
  }
  require(set.gap == 0.0, ".gap is of regular lines, with a spacing");
  require(set.intensity > 0.0, ".intensity or spacing must be above 0, or file must name one");
  for (const std::string& problem : law_of(set).problems("length")) require(false, problem);
  const Vec2 size = set.max - set.min;
  if (set.length > 0.0 && set.length_law != "power")
    refuse_many(".intensity", set.intensity * size.x * size.y / set.length);
  return problems;
}

}  // namespace breccia::prepare
