// The mesh part of Abaqus input files: keyword lines that begin with *, data lines of words between
// commas.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <unordered_map>

#include "exec/error.hpp"
#include "prepare/meshing/mesh_file.hpp"

namespace breccia::prepare {
namespace {

std::string_view trimmed(std::string_view text) {
  const char* blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string upper(std::string_view text) {
  std::string word(text);
  for (char& c : word)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return word;
}

/// Words between commas; none after a comma at the end.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    words.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  while (!words.empty() && words.back().empty()) words.pop_back();
  return words;
}

const std::set<std::string> triangle_types{"CPS3", "CPE3", "S3", "S3R", "M3D3", "STRI3"};
const std::set<std::string> quadrangle_types{"CPS4", "CPE4", "CPS4R", "CPE4R", "S4", "S4R", "M3D4"};
const std::set<std::string> line_types{"T2D2", "T3D2", "B21", "B31"};
const std::set<std::string> tetrahedron_types{"C3D4"};
/// Keywords that bring nodes or elements, or move them: a mesh read without them would be another.
const std::set<std::string> refused{"INCLUDE", "NGEN",   "NFILL",  "NCOPY",    "NMAP",
                                    "ELGEN",   "ELCOPY", "SYSTEM", "TRANSFORM"};

class AbaqusReader {
 public:
  AbaqusReader(std::string_view content, const std::string& name, int dimension)
      : content_(content),
        name_(name),
        element_types_(dimension == 2 ? triangle_types : tetrahedron_types),
        side_types_(dimension == 2 ? line_types : triangle_types),
        corners_(dimension == 2 ? 3 : 4) {}

  RawMesh run() {
    for (std::size_t at = 0; at < content_.size();) {
      const std::size_t end = std::min(content_.find('\n', at), content_.size());
      const std::string_view text = trimmed(content_.substr(at, end - at));
      ++line_;
      at = end + 1;
      if (text.empty() || text.starts_with("**")) continue;
      if (text[0] == '*')
        begin_block(text);
      else
        read_data(text);
    }
    if (!has_keywords_)
      throw InputError(name_ +
                       ": there is no line that begins with *; is it an Abaqus input file?");
    resolve_element_sets();
    resolve_node_sets();
    return std::move(raw_);
  }

 private:
  /// Numbers and names of other sets.
  struct Set {
    std::vector<std::int64_t> numbers;
    std::vector<std::string> others;
    int line = 0;
  };

  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, line_, text));
  }

  void begin_block(std::string_view text) {
    has_keywords_ = true;
    const auto words = words_of(text.substr(1));
    keyword_ = words.empty() ? "" : upper(words[0]);
    if (refused.contains(keyword_))
      fail(
          fmt::format("*{} cannot be read; write all nodes and elements out in one file, in global "
                      "coordinates",
                      keyword_));
    type_.clear();
    set_.clear();
    generate_ = false;
    for (std::size_t k = 1; k < words.size(); ++k) {
      const std::size_t equals = words[k].find('=');
      const std::string key = upper(trimmed(words[k].substr(0, equals)));
      const std::string value(equals == std::string_view::npos
                                  ? std::string_view()
                                  : trimmed(words[k].substr(equals + 1)));
      if (key == "TYPE") type_ = upper(value);
      if ((key == "ELSET" && keyword_ != "NSET") || (key == "NSET" && keyword_ != "ELEMENT"))
        set_ = value;
      if (key == "GENERATE") generate_ = true;
      if (key == "INPUT" && (keyword_ == "NODE" || keyword_ == "ELEMENT"))
        fail("*" + keyword_ + " from another file (INPUT=) cannot be read");
    }
    if ((keyword_ == "ELSET" || keyword_ == "NSET") && set_.empty())
      fail(fmt::format("*{0} needs a name, as in *{0}, {0}=left", keyword_));
    if (keyword_ == "ELEMENT" && type_.empty()) fail("*ELEMENT needs TYPE=");
  }

  std::int64_t whole(std::string_view word) const {
    std::int64_t value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range)
      fail(
          fmt::format("\"{}\" is too large for a number of a node or element", word.substr(0, 40)));
    if (error != std::errc{} || rest != word.data() + word.size())
      fail(fmt::format("\"{}\" is not a whole number", word.substr(0, 40)));
    return value;
  }
  double real(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || rest != word.data() + word.size() || !std::isfinite(value))
      fail(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    return value;
  }

  void read_data(std::string_view text) {
    if (keyword_ == "NODE")
      read_node(words_of(text));
    else if (keyword_ == "ELEMENT")
      read_element(words_of(text));
    else if (keyword_ == "ELSET")
      read_set(words_of(text), element_sets_[set_]);
    else if (keyword_ == "NSET")
      read_set(words_of(text), node_sets_[set_]);
    else if (keyword_ == "INSTANCE")
      fail("*INSTANCE moves its part; write the nodes in global coordinates");
    else if (!has_keywords_)
      fail(fmt::format("\"{}\" stands before the first keyword", text.substr(0, 40)));
  }

  void read_node(const std::vector<std::string_view>& words) {
    if (words.size() < 3 || words.size() > 4)
      fail(
          fmt::format("a node is its number, x, y and perhaps z; here are {} words", words.size()));
    raw_.nodes.push_back({whole(words[0]),
                          {real(words[1]), real(words[2]), words.size() > 3 ? real(words[3]) : 0.0},
                          line_});
    if (!set_.empty()) node_sets_[set_].numbers.push_back(raw_.nodes.back().number);
  }

  void read_element(const std::vector<std::string_view>& words) {
    const bool is_element = element_types_.contains(type_), is_side = side_types_.contains(type_);
    const bool ignored = !is_side && line_types.contains(type_);  // a line of a mesh in space
    const bool is_quadrangle = corners_ == 3 && quadrangle_types.contains(type_);
    if (!is_element && !is_side && !ignored && !is_quadrangle)
      fail(fmt::format(
          "element {} is of type {}; allowed are {} ({}{}) and, as names of {} ({})",
          words.empty() ? "" : words[0], type_, corners_ == 3 ? "triangles" : "tetrahedra",
          fmt::join(element_types_, ", "),
          corners_ == 3 ? fmt::format("), quadrangles ({}", fmt::join(quadrangle_types, ", ")) : "",
          corners_ == 3 ? "edges, lines" : "faces, triangles", fmt::join(side_types_, ", ")));
    const std::size_t nodes = is_quadrangle ? 4
                              : is_element  ? corners_
                              : is_side     ? corners_ - 1
                                            : 2;
    if (words.size() != 1 + nodes)
      fail(fmt::format("an element of type {} is its number and {} nodes; here are {} words", type_,
                       nodes, words.size()));
    RawMesh::Element element{whole(words[0]), {}, line_};
    for (std::size_t k = 0; k < nodes; ++k) element.nodes[k] = whole(words[1 + k]);
    if (ignored) {
      for (std::size_t k = 0; k < nodes; ++k) raw_.other_nodes.push_back(element.nodes[k]);
      ignored_.insert(element.number);
      return;
    }
    auto& elements = is_element || is_quadrangle ? raw_.elements : raw_.sides;
    const Place place{is_element || is_quadrangle, elements.size(), is_quadrangle ? 4U : 1U};
    if (!places_.emplace(element.number, place).second)
      fail(fmt::format("element {} is there twice", element.number));
    if (is_quadrangle)
      add_quadrangle(raw_, element);
    else
      elements.push_back(element);
    if (!set_.empty()) element_sets_[set_].numbers.push_back(element.number);
  }

  void read_set(const std::vector<std::string_view>& words, Set& set) {
    set.line = line_;
    if (generate_) {
      if (words.size() < 2 || words.size() > 3)
        fail("GENERATE needs first number, last number and perhaps step");
      const std::int64_t first = whole(words[0]), last = whole(words[1]),
                         step = words.size() > 2 ? whole(words[2]) : 1;
      if (step < 1 || last < first || (last - first) / step > most_generated)
        fail(
            fmt::format("GENERATE from {} to {} in steps of {} makes no sense", first, last, step));
      for (std::int64_t k = 0; k <= (last - first) / step; ++k)
        set.numbers.push_back(first + k * step);
      return;
    }
    for (const std::string_view word : words)
      if (!word.empty() && (word[0] == '-' || (word[0] >= '0' && word[0] <= '9')))
        set.numbers.push_back(whole(word));
      else if (!word.empty())
        set.others.emplace_back(word);
  }

  /// The numbers of a set and of the sets that it names, each once.
  std::vector<std::int64_t> all_of(const std::map<std::string, Set>& sets,
                                   const std::string& name) {
    std::set<std::string> seen;
    std::vector<std::string> open{name};
    std::vector<std::int64_t> numbers;
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      if (!seen.insert(next).second) continue;
      const auto found = sets.find(next);
      if (found == sets.end()) {
        line_ = sets.at(name).line;
        fail(fmt::format("the set \"{}\" names the set \"{}\", which is not there", name, next));
      }
      numbers.insert(numbers.end(), found->second.numbers.begin(), found->second.numbers.end());
      open.insert(open.end(), found->second.others.begin(), found->second.others.end());
    }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
  }

  void resolve_element_sets() {
    for (const auto& [name, set] : element_sets_)
      for (const std::int64_t number : all_of(element_sets_, name)) {
        const auto found = places_.find(number);
        if (found == places_.end() && ignored_.contains(number)) continue;
        if (found == places_.end()) {
          line_ = set.line;
          fail(fmt::format("the element set \"{}\" names element {}, which is not there", name,
                           number));
        }
        auto& sets = found->second.is_element ? raw_.parts : raw_.side_sets;
        for (std::size_t k = 0; k < found->second.count; ++k)
          sets[name].push_back(found->second.position + k);
      }
  }
  void resolve_node_sets() {
    for (const auto& entry : node_sets_)
      raw_.node_sets[entry.first] = all_of(node_sets_, entry.first);
  }

  struct Place {
    bool is_element;  ///< else a side
    std::size_t position;
    std::size_t count;  ///< of a quadrangle: its triangles
  };
  static constexpr std::int64_t most_generated = 100'000'000;

  std::string_view content_;
  const std::string& name_;
  const std::set<std::string>&element_types_, &side_types_;
  std::size_t corners_;  ///< of an element
  int line_ = 0;
  bool has_keywords_ = false, generate_ = false;
  std::string keyword_, type_, set_;  ///< of the block
  std::unordered_map<std::int64_t, Place> places_;
  std::set<std::int64_t> ignored_;  ///< elements that are no part of the mesh
  std::map<std::string, Set> element_sets_, node_sets_;
  RawMesh raw_;
};

}  // namespace

RawMesh raw_abaqus(std::string_view content, const std::string& name, int dimension) {
  return AbaqusReader(content, name, dimension).run();
}

Mesh parse_abaqus(std::string_view content, const std::string& name, bool seams) {
  return finished_mesh(raw_abaqus(content, name, 2), name, seams);
}

}  // namespace breccia::prepare
