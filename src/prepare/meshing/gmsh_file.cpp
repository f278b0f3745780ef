// The formats of Gmsh (its reference manual, "MSH file format"): MSH 4.1, text and binary, and the
// legacy MSH 2.2, text.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "exec/error.hpp"
#include "prepare/meshing/mesh_file.hpp"

namespace breccia::prepare {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// The content from front to back, as text or as bytes.
class Input {
 public:
  Input(std::string_view content, const std::string& name) : content_(content), name_(name) {}

  bool binary = false;
  std::string section;  ///< being read, with its $

  int line() const { return binary ? 0 : line_; }
  bool at_end() {
    skip_blanks();
    return at_ == content_.size();
  }
  [[noreturn]] void fail(const std::string& text) const {
    const std::string where = binary ? fmt::format("byte {}", at_) : fmt::format("line {}", line_);
    throw InputError(fmt::format("{}, {}: {}", name_, where, text));
  }
  [[noreturn]] void cut_off() const {
    fail(fmt::format("the file ends within {}; it is cut off", section));
  }

  /// A word of text, whatever the mode.
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < content_.size() && !is_blank(content_[at_])) ++at_;
    if (begin == at_) cut_off();
    return content_.substr(begin, at_ - begin);
  }
  template <class T>
  T number() {
    const std::string_view text = word();
    T value{};
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range)
      fail(fmt::format("\"{}\" in {} is too large", text.substr(0, 40), section));
    if (error != std::errc{} || rest != text.data() + text.size())
      fail(fmt::format("\"{}\" in {} is not {}", text.substr(0, 40), section,
                       std::is_integral_v<T> ? "a whole number" : "a number"));
    return value;
  }
  int integer() { return binary ? bytes<int>() : number<int>(); }
  std::uint64_t size() { return binary ? bytes<std::uint64_t>() : number<std::uint64_t>(); }
  double real() { return binary ? bytes<double>() : number<double>(); }
  template <class T>
  T bytes() {
    T value{};
    if (content_.size() - at_ < sizeof value) cut_off();
    std::memcpy(&value, content_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  /// How many items follow; each takes at least `least` bytes.
  std::size_t count(const char* of, std::size_t least) {
    const std::uint64_t given = size();
    if (given > content_.size() / least)
      fail(fmt::format("{} says that there are {} {}; the whole file has {} bytes", section, given,
                       of, content_.size()));
    return static_cast<std::size_t>(given);
  }
  /// The number of a node or element.
  std::int64_t tag() {
    const std::uint64_t given = size();
    if (given > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      fail(fmt::format("{} is too large for a number of a node or element", given));
    return static_cast<std::int64_t>(given);
  }
  /// A text between quotation marks.
  std::string quoted() {
    skip_blanks();
    const std::size_t end = at_ < content_.size() && content_[at_] == '"'
                                ? content_.find('"', at_ + 1)
                                : std::string_view::npos;
    if (end == std::string_view::npos) fail("a name between quotation marks is missing");
    const std::string text(content_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return text;
  }
  void rest_of_line() {
    while (at_ < content_.size() && content_[at_] != '\n') ++at_;
    if (at_ < content_.size()) {
      ++at_;
      ++line_;
    }
  }
  void skip_section() {
    const std::string end = "$End" + section.substr(1);
    const std::size_t found = content_.find(end, at_);
    if (found == std::string_view::npos) cut_off();
    for (; at_ < found; ++at_) line_ += content_[at_] == '\n';
    at_ += end.size();
  }
  void end_section() {
    const std::string end = "$End" + section.substr(1);
    if (const std::string_view found = word(); found != end)
      fail(fmt::format("\"{}\" stands where {} should", found.substr(0, 40), end));
  }

 private:
  void skip_blanks() {
    for (; at_ < content_.size() && is_blank(content_[at_]); ++at_) line_ += content_[at_] == '\n';
  }

  std::string_view content_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Kinds of elements by their number in the file; nodes 0: not known.
struct Kind {
  const char* name;
  std::size_t nodes;
};
Kind kind_of(int type) {
  switch (type) {
    case 1:
      return {"a line", 2};
    case 2:
      return {"a triangle", 3};
    case 3:
      return {"a quadrangle", 4};
    case 4:
      return {"a tetrahedron", 4};
    case 5:
      return {"a hexahedron", 8};
    case 6:
      return {"a prism", 6};
    case 7:
      return {"a pyramid", 5};
    case 8:
      return {"a line of second order", 3};
    case 9:
      return {"a triangle of second order", 6};
    case 11:
      return {"a tetrahedron of second order", 10};
    case 15:
      return {"a point", 1};
    default:
      return {"an element of a higher order", 0};
  }
}

class GmshReader {
 public:
  GmshReader(std::string_view content, const std::string& name, int dimension)
      : in_(content, name), dimension_(dimension) {}

  RawMesh run() {
    in_.section = "its first section";
    if (in_.at_end()) in_.fail("the file is empty");
    bool has_nodes = false, has_elements = false;
    while (!in_.at_end()) {
      // Names of sections are text even in binary files.
      const std::string_view word = in_.word();
      if (word.front() != '$')
        in_.fail(fmt::format("\"{}\" stands where a section like $Nodes should begin",
                             word.substr(0, 40)));
      in_.section = word;
      if (!format_known_ && in_.section != "$MeshFormat")
        in_.fail("the file does not begin with $MeshFormat; is it a mesh of Gmsh?");
      in_.rest_of_line();
      if (in_.section == "$MeshFormat") {
        read_format();
      } else if (in_.section == "$PhysicalNames") {
        read_names();
      } else if (in_.section == "$Entities") {
        read_entities();
      } else if (in_.section == "$Nodes") {
        legacy_ ? read_legacy_nodes() : read_nodes();
        has_nodes = true;
      } else if (in_.section == "$Elements") {
        if (!has_nodes) in_.fail("$Elements comes before $Nodes");
        legacy_ ? read_legacy_elements() : read_elements();
        has_elements = true;
      } else {
        in_.skip_section();
        continue;
      }
      in_.end_section();
    }
    if (!has_nodes || !has_elements)
      in_.fail(fmt::format("the file ends without {}; it is cut off",
                           has_nodes ? "$Elements" : "$Nodes"));
    return std::move(raw_);
  }

 private:
  void read_format() {
    const std::string version(in_.word());
    if (version != "4.1" && version != "2.2")
      in_.fail(fmt::format("the file has version {}; needed is 4.1 (gmsh -format msh41) or 2.2",
                           version.substr(0, 10)));
    legacy_ = version == "2.2";
    const int mode = in_.number<int>(), data_size = in_.number<int>();
    if ((mode != 0 && mode != 1) || data_size != 8)
      in_.fail(
          fmt::format("mode {} with words of {} bytes cannot be read; allowed are 0 (text) "
                      "and 1 (binary) with 8 bytes",
                      mode, data_size));
    if (legacy_ && mode != 0)
      in_.fail("files of version 2.2 are read as text only; gmsh -format msh41 makes a newer one");
    in_.rest_of_line();
    in_.binary = mode == 1;
    if (in_.binary && in_.bytes<int>() != 1)
      in_.fail("the bytes are in the order of another kind of machine");
    format_known_ = true;
  }

  void read_names() {  // always text
    const bool binary = in_.binary;
    in_.binary = false;
    for (std::size_t left = in_.count("names", 5); left > 0; --left) {
      const int dimension = in_.number<int>(), group = in_.number<int>();
      names_[{dimension, group}] = in_.quoted();
    }
    in_.binary = binary;
  }

  void read_entities() {
    const std::size_t points = in_.count("points", 8), curves = in_.count("curves", 8),
                      surfaces = in_.count("surfaces", 8), volumes = in_.count("volumes", 8);
    const std::array<std::size_t, 4> counts{points, curves, surfaces, volumes};
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t left = counts[static_cast<std::size_t>(dimension)]; left > 0; --left) {
        const int entity = in_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.real();  // its box
        for (std::size_t groups = in_.count("physical groups", 2); groups > 0; --groups)
          groups_[{dimension, entity}].push_back(group_number(in_.integer()));
        if (dimension == 0) continue;
        for (std::size_t bounds = in_.count("bounding entities", 2); bounds > 0; --bounds)
          in_.integer();
      }
  }

  /// A minus only says that an entity is seen from behind.
  static int group_number(int given) {
    return given < 0 && given > std::numeric_limits<int>::min() ? -given : given;
  }

  void read_nodes() {
    const std::size_t blocks = in_.count("blocks", 4), nodes = in_.count("nodes", 8);
    in_.size();
    in_.size();
    raw_.nodes.reserve(nodes);
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = in_.integer();
      in_.integer();
      const bool parametric = in_.integer() != 0;
      const std::size_t count = in_.count("nodes", 8), first = raw_.nodes.size();
      for (std::size_t n = 0; n < count; ++n) raw_.nodes.push_back({in_.tag(), {}, 0});
      for (std::size_t n = first; n < raw_.nodes.size(); ++n) {
        const double x = in_.real(), y = in_.real(), z = in_.real();
        raw_.nodes[n].position = {x, y, z};
        raw_.nodes[n].line = in_.line();
        for (int k = 0; parametric && k < dimension; ++k) in_.real();
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
          in_.fail(fmt::format("node {} has a coordinate that is no number", raw_.nodes[n].number));
      }
    }
    if (raw_.nodes.size() != nodes)
      in_.fail(fmt::format("$Nodes holds {} nodes, but says {}", raw_.nodes.size(), nodes));
  }

  void read_elements() {
    const std::size_t blocks = in_.count("blocks", 4), elements = in_.count("elements", 4);
    in_.size();
    in_.size();
    std::size_t read = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = in_.integer(), entity = in_.integer(), type = in_.integer();
      const std::size_t count = in_.count("elements", 4);
      const Kind kind = kind_of(type);
      for (std::size_t e = 0; e < count; ++e, ++read) {
        RawMesh::Element element{in_.tag(), {}, in_.line()};
        refuse_others(element, type);
        for (std::size_t k = 0; k < kind.nodes; ++k) element.nodes[k] = in_.tag();
        add(element, type, dimension, groups_[{dimension, entity}]);
      }
    }
    if (read != elements)
      in_.fail(fmt::format("$Elements holds {} elements, but says {}", read, elements));
  }

  /// Number and place, a line each.
  void read_legacy_nodes() {
    for (std::size_t left = in_.count("nodes", 8); left > 0; --left) {
      const std::int64_t number = in_.tag();
      const double x = in_.real(), y = in_.real(), z = in_.real();
      raw_.nodes.push_back({number, {x, y, z}, in_.line()});
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
        in_.fail(fmt::format("node {} has a coordinate that is no number", number));
    }
  }

  /// Number, type, tags (the first one is the physical group, 0: none), nodes; a line each.
  void read_legacy_elements() {
    for (std::size_t left = in_.count("elements", 8); left > 0; --left) {
      RawMesh::Element element{in_.tag(), {}, in_.line()};
      const int type = in_.integer();
      std::vector<int> group;
      for (std::size_t tag = 0, tags = in_.count("tags", 2); tag < tags; ++tag) {
        const int given = in_.integer();
        if (tag == 0 && given != 0) group.push_back(group_number(given));
      }
      refuse_others(element, type);
      for (std::size_t k = 0; k < kind_of(type).nodes; ++k) element.nodes[k] = in_.tag();
      add(element, type, type == 4 ? 3 : std::min(type, 2), group);  // dimensions
    }
  }

  /// Types of elements that a mesh is made of, and that name their sides.
  int element_type() const { return dimension_ == 2 ? 2 : 4; }
  int side_type() const { return dimension_ == 2 ? 1 : 2; }

  /// One that a plane mesh takes as four triangles.
  bool is_quadrangle(int type) const { return dimension_ == 2 && type == 3; }

  void refuse_others(const RawMesh::Element& element, int type) {
    if (type == element_type() || type == side_type() || type == 1 || type == 15) return;
    if (is_quadrangle(type)) return;
    if (type >= 8 && type != 15)
      in_.fail(fmt::format("element {} is {}; a mesh may hold those of first order (gmsh -order 1)",
                           element.number, kind_of(type).name));
    const bool recombined = type == 3 || type == 5 || type == 6 || type == 7;
    in_.fail(fmt::format("element {} is {}; a mesh may hold {}{}", element.number,
                         kind_of(type).name,
                         dimension_ == 2 ? "triangles, quadrangles, and lines that name edges"
                                         : "tetrahedra, and triangles that name faces",
                         recombined ? " (leave out Recombine)" : ""));
  }

  void add(const RawMesh::Element& element, int type, int dimension,
           const std::vector<int>& groups) {
    if (type != element_type() && type != side_type() && !is_quadrangle(type)) {
      for (std::size_t k = 0; k < kind_of(type).nodes; ++k)
        raw_.other_nodes.push_back(element.nodes[k]);
      return;
    }
    auto& elements = type == side_type() ? raw_.sides : raw_.elements;
    auto& sets = type == side_type() ? raw_.side_sets : raw_.parts;
    const std::size_t pieces = is_quadrangle(type) ? 4 : 1;
    for (const int group : groups) {
      const auto name = names_.find({dimension, group});
      auto& set = sets[name != names_.end() ? name->second : std::to_string(group)];
      for (std::size_t k = 0; k < pieces; ++k) set.push_back(elements.size() + k);
    }
    if (is_quadrangle(type))
      add_quadrangle(raw_, element);
    else
      elements.push_back(element);
  }

  using DimensionAndTag = std::pair<int, int>;
  Input in_;
  int dimension_;
  bool format_known_ = false, legacy_ = false;
  std::map<DimensionAndTag, std::string> names_;        ///< of physical groups
  std::map<DimensionAndTag, std::vector<int>> groups_;  ///< physical groups of an entity
  RawMesh raw_;
};

}  // namespace

RawMesh raw_gmsh(std::string_view content, const std::string& name, int dimension) {
  return GmshReader(content, name, dimension).run();
}

Mesh parse_gmsh(std::string_view content, const std::string& name, bool seams) {
  return finished_mesh(raw_gmsh(content, name, 2), name, seams);
}

}  // namespace breccia::prepare
