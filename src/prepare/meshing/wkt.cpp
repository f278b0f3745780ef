#include "prepare/meshing/wkt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia::prepare {
namespace {

class Wkt {
 public:
  /// @param polygons  whether it holds polygons, or lines
  Wkt(std::string text, std::string path, bool polygons)
      : text_(std::move(text)), path_(std::move(path)), polygons_(polygons) {}

  std::vector<std::vector<Vec3>> all() {
    for (skip(); at_ < text_.size(); skip()) geometry(0);
    return std::move(all_);
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
    flat_ = more == "M";
    const std::size_t behind = at_;
    skip();
    const std::string next = next_word();
    if (next != "Z" && next != "M" && next != "ZM") at_ = behind;
    if (next == "M") flat_ = true;
    const std::string one = polygons_ ? "POLYGON" : "LINESTRING";
    if (word == one) {
      add();
    } else if (word == "MULTI" + one) {
      each([&] { add(); });
    } else if (word == "GEOMETRYCOLLECTION" && depth < deepest) {
      each([&] { geometry(depth + 1); });
    } else {
      refuse(word.empty() ? "a character that begins no geometry" : "\"" + word + "\"");
    }
  }
  void add() {
    if (is_empty()) return;
    if (!polygons_) return all_.push_back(points());
    expect('(');
    all_.push_back(points());
    if (take(',')) refuse("a polygon with a hole");
    expect(')');
    std::vector<Vec3>& ring = all_.back();
    if (ring.size() > 1 && norm(ring.front() - ring.back()) == 0.0) ring.pop_back();
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
  std::vector<Vec3> points() {
    std::vector<Vec3> line;
    expect('(');
    do {
      const double x = number(), y = number();
      line.push_back({x, y, 0.0});
      if (!ends_or_is(",)")) (flat_ ? ignored_ : line.back().z) = number();
      if (!ends_or_is(",)")) number();
    } while (take(','));
    expect(')');
    return line;
  }
  [[noreturn]] void refuse(const std::string& found) const {
    const auto here = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    throw InputError(
        fmt::format("{}, line {}: there is {} where WKT has {} or a GEOMETRYCOLLECTION of them",
                    path_, 1 + std::count(text_.begin(), here, '\n'), found,
                    polygons_ ? "POLYGON Z ((x y z, x y z, ...)), MULTIPOLYGON Z (((x y z, ...)), "
                                "...)"
                              : "LINESTRING (x y, x y, ...), MULTILINESTRING ((x y, ...), ...)"));
  }

  static constexpr int deepest = 20;  // of collections in each other

  std::string text_, path_;
  bool polygons_;
  bool flat_ = false;     // a third number of its points is m
  double ignored_ = 0.0;  // such a number
  std::size_t at_ = 0;
  std::vector<std::vector<Vec3>> all_;
};

}  // namespace

std::vector<std::vector<Vec3>> lines_of_wkt(const std::string& path) {
  return Wkt(read_whole_file(path), path, false).all();
}
std::vector<std::vector<Vec3>> polygons_of_wkt(const std::string& path) {
  return Wkt(read_whole_file(path), path, true).all();
}

}  // namespace breccia::prepare
