#include "prepare/meshing/joint_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "math/constants.hpp"
#include "prepare/csv_numbers.hpp"

namespace breccia::prepare {
namespace {

using fdem::DiscontinuityConfig;
using fdem::JointSetConfig;

constexpr std::uint32_t set_stream = 0x40000;  ///< of random numbers; one more for each set

/// Reads lines of WKT; of points with z and m these are dropped.
class Wkt {
 public:
  Wkt(std::string text, std::string path) : text_(std::move(text)), path_(std::move(path)) {}

  std::vector<std::vector<Vec2>> lines() {
    for (skip(); at_ < text_.size(); skip()) geometry(0);
    return std::move(lines_);
  }

 private:
  /// White space, and what stands between geometries: ';' and lines that begin with '#'.
  void skip() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '#') at_ = std::min(text_.find('\n', at_), text_.size() - 1);
      if (c != '#' && c != ';' && std::isspace(static_cast<unsigned char>(c)) == 0) return;
    }
  }
  std::string next_word() {
    std::string word;
    for (; at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_])) != 0; ++at_)
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
    return word;
  }
  /// A geometry, or those in it.
  void geometry(int depth) {
    skip();
    std::string word = next_word();
    const std::size_t name = word.find_last_not_of("ZM") + 1;
    const std::string more = word.substr(name);
    if (more == "Z" || more == "M" || more == "ZM") word.resize(name);
    const std::size_t behind = at_;
    skip();
    if (const std::string next = next_word(); next != "Z" && next != "M" && next != "ZM")
      at_ = behind;
    if (word == "LINESTRING") {
      if (!is_empty()) lines_.push_back(points());
    } else if (word == "MULTILINESTRING") {
      each([&] {
        if (!is_empty()) lines_.push_back(points());
      });
    } else if (word == "GEOMETRYCOLLECTION" && depth < deepest) {
      each([&] { geometry(depth + 1); });
    } else {
      refuse(word.empty() ? "a character that begins no geometry" : "\"" + word + "\"");
    }
  }
  bool is_empty() {
    skip();
    if (text_.compare(at_, 5, "EMPTY") != 0) return false;
    at_ += 5;
    return true;
  }
  template <class Read>
  void each(const Read& read) {
    if (is_empty()) return;
    expect('(');
    do read();
    while (take(','));
    expect(')');
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) refuse(fmt::format("no '{}'", c));
  }
  bool ends_or_is(const char* one_of) {
    skip();
    return at_ >= text_.size() || std::string_view(one_of).find(text_[at_]) != std::string::npos;
  }
  double number() {
    skip();
    double value = 0.0;
    const auto [rest, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) refuse("no number");
    at_ = static_cast<std::size_t>(rest - text_.data());
    return value;
  }
  std::vector<Vec2> points() {
    std::vector<Vec2> line;
    expect('(');
    do {
      const double x = number(), y = number();
      line.push_back({x, y});
      for (int more = 0; more < 2 && !ends_or_is(",)"); ++more) number();
    } while (take(','));
    expect(')');
    return line;
  }
  [[noreturn]] void refuse(const std::string& found) const {
    const auto here = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    throw InputError(
        fmt::format("{}, line {}: there is {} where WKT has LINESTRING (x y, x y, ...), "
                    "MULTILINESTRING ((x y, ...), ...) or a GEOMETRYCOLLECTION of them",
                    path_, 1 + std::count(text_.begin(), here, '\n'), found));
  }

  static constexpr int deepest = 20;  // of collections in each other

  std::string text_, path_;
  std::size_t at_ = 0;
  std::vector<std::vector<Vec2>> lines_;
};

std::vector<std::vector<Vec2>> lines_of_file(const std::string& path) {
  if (path.ends_with(".wkt")) return Wkt(read_whole_file(path), path).lines();
  std::vector<std::vector<Vec2>> lines;
  read_csv(path, 4, "x1,y1,x2,y2 in metres", [&](const std::vector<double>& v) {
    lines.push_back({{v[0], v[1]}, {v[2], v[3]}});
    return true;
  });
  return lines;
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
    const double longest = set_.length_law == "constant" ? set_.length : 10.0 * set_.length;
    const double reach = 0.5 * (set_.most > 0.0 ? set_.most : longest);
    double missing = set_.intensity * size.x * size.y;
    std::vector<std::vector<Vec2>> all;
    for (; missing > 0.0; ++line_) {
      if (line_ >= static_cast<std::uint64_t>(most_lines))
        throw InputError(fmt::format(
            "after {:.0f} random lines the rectangle has {:.3g} m of the {:.3g} m that its "
            "intensity asks for",
            most_lines, set_.intensity * size.x * size.y - missing,
            set_.intensity * size.x * size.y));
      const double length = drawn_length();
      const double angle = set_.angle + set_.spread * normal(0);
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

  /// By Box and Muller.
  double normal(std::uint32_t draw) const {
    const double u = random_.uniform(line_, draw), v = random_.uniform(line_, draw + 1);
    return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * pi * v);
  }
  double drawn_length() const {
    constexpr std::uint32_t tries = 1000;
    for (std::uint32_t k = 0; k < tries; ++k) {
      const double l = length(10 + 2 * k);
      if (l > 0.0 && l >= set_.least && (set_.most == 0.0 || l <= set_.most)) return l;
    }
    throw InputError("no length between least and most was drawn in 1000 tries");
  }
  double length(std::uint32_t draw) const {
    const double u = random_.uniform(line_, draw);
    if (set_.length_law == "exponential") return -set_.length * std::log(1.0 - u);
    if (set_.length_law == "lognormal") {
      const double ratio = set_.length_deviation / set_.length;
      const double square = std::log(1.0 + ratio * ratio);
      return set_.length * std::exp(std::sqrt(square) * normal(draw) - 0.5 * square);
    }
    if (set_.length_law == "power") {
      const double power = 1.0 - set_.length_exponent;
      if (std::abs(power) < 1e-9) return set_.least * std::pow(set_.most / set_.least, u);
      const double low = std::pow(set_.least, power), high = std::pow(set_.most, power);
      return std::clamp(std::pow(low + u * (high - low), 1.0 / power), set_.least, set_.most);
    }
    return set_.length;
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
  require(set.kind != "cohesive" ||
              std::find(joints.begin(), joints.end(), set.material) != joints.end(),
          fmt::format(".material = \"{}\" is not a joint law; there are: {}", set.material,
                      joints.empty() ? "none" : fmt::format("{}", fmt::join(joints, ", "))));
  if (!set.file.empty()) {
    require(set.file.ends_with(".csv") || set.file.ends_with(".wkt"),
            fmt::format(".file = \"{}\" is neither a .csv nor a .wkt file", set.file));
    require(set.intensity == 0.0, ".intensity is of random lines, and these come from a file");
    return problems;
  }
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
  if (set.length_law == "power") {
    require(set.least > 0.0 && set.most > set.least,
            ": lengths by a power law need 0 < least < most");
    return problems;
  }
  require(set.length > 0.0, ".length must be above 0");
  const Vec2 size = set.max - set.min;
  if (set.length > 0.0) refuse_many(".intensity", set.intensity * size.x * size.y / set.length);
  require(set.length_law != "lognormal" || set.length_deviation > 0.0,
          ".length_deviation must be above 0 for lognormal lengths");
  require(set.most == 0.0 || set.most > set.least, ".most must be above least");
  require(set.length_law != "constant" ||
              (set.length >= set.least && (set.most == 0.0 || set.length <= set.most)),
          ".length lies outside least and most");
  return problems;
}

}  // namespace breccia::prepare
