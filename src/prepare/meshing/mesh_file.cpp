#include "prepare/meshing/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/mesh_check.hpp"

namespace breccia::prepare {
namespace {

std::string in_line(int line) {
  return line > 0 ? fmt::format("line {}, ", line) : "";
}

class Finisher {
 public:
  Finisher(const RawMesh& raw, const std::string& name, bool seams)
      : raw_(raw), name_(name), seams_(seams) {}

  Mesh run() {
    number_nodes();
    take_triangles();
    refuse_if_any();
    check_flat();
    drop_nodes_of_others();
    MeshNames names{[this](Index t) { return triangle_name(static_cast<std::size_t>(t)); },
                    [this](Index v) { return node_name(kept_[static_cast<std::size_t>(v)]); }};
    for (const std::string& problem : mesh_problems(mesh_, names)) add(problem);
    refuse_if_any();
    if (!seams_) {
      check_seams(names);
      refuse_if_any();
    }
    take_sets();
    return std::move(mesh_);
  }

 private:
  void add(const std::string& problem) {
    if (++count_ <= 20) problems_.push_back(problem);
  }
  void refuse_if_any() const {
    if (count_ == 0) return;
    std::string text =
        fmt::format("{} problem{} in {}; nothing was run.", count_, count_ == 1 ? "" : "s", name_);
    for (const std::string& problem : problems_) text += "\n  " + problem;
    if (count_ > problems_.size())
      text += fmt::format("\n  ... and {} more", count_ - problems_.size());
    throw InputError(text);
  }
  std::string triangle_name(std::size_t t) const {
    return fmt::format("{}element {}", in_line(raw_.triangles[t].line), raw_.triangles[t].number);
  }
  std::string node_name(std::size_t n) const {
    return fmt::format("node {}", raw_.nodes[n].number);
  }

  /// Where triangles are not joined though they look so.
  void check_seams(const MeshNames& names) {
    const std::string remedy = "; if that is meant, set seams = \"open\" in the body";
    const std::vector<Vec2>& point = mesh_.point;
    std::vector<Index> order(point.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](Index v) { return point[static_cast<std::size_t>(v)]; };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return place(a).x != place(b).x ? place(a).x < place(b).x : a < b;
    });
    const double near = 1e-9 * (place(order.back()).x - place(order.front()).x);
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t k = i + 1; k < order.size() && place(order[k]).x - place(order[i]).x <= near;
           ++k)
        if (std::abs(place(order[k]).y - place(order[i]).y) <= near)
          add(fmt::format(
              "{} and {} lie at one place, ({:.6g}, {:.6g}) m: triangles beside them are not "
              "joined{}",
              names.vertex(std::min(order[i], order[k])),
              names.vertex(std::max(order[i], order[k])), place(order[i]).x, place(order[i]).y,
              remedy));
    if (mesh_.triangle.size() < 2) return;
    std::vector<bool> joined(mesh_.triangle.size());
    for (const MeshEdge& edge : edges_of(mesh_.triangle))
      if (edge.triangles[1] >= 0)
        for (const Index t : edge.triangles) joined[static_cast<std::size_t>(t)] = true;
    for (std::size_t t = 0; t < joined.size(); ++t)
      if (!joined[t])
        add(names.triangle(static_cast<Index>(t)) +
            " shares no edge with any other: it is not joined" + remedy);
  }

  void number_nodes() {
    if (raw_.nodes.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()) ||
        raw_.triangles.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 3))
      throw InputError(
          fmt::format("{}: {} nodes and {} triangles are too many; at most 715 "
                      "million triangles can be numbered",
                      name_, raw_.nodes.size(), raw_.triangles.size()));
    position_.reserve(raw_.nodes.size());
    for (std::size_t n = 0; n < raw_.nodes.size(); ++n)
      if (!position_.emplace(raw_.nodes[n].number, n).second)
        add(fmt::format("{}node {} is there twice", in_line(raw_.nodes[n].line),
                        raw_.nodes[n].number));
  }

  void take_triangles() {
    if (raw_.triangles.empty()) add("there are no triangles; is it a mesh of another dimension?");
    used_.assign(raw_.nodes.size(), false);
    for (std::size_t t = 0; t < raw_.triangles.size(); ++t) {
      Triangle corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto found = position_.find(raw_.triangles[t].nodes[k]);
        if (found == position_.end()) {
          add(fmt::format("{}: there is no node {}", triangle_name(t), raw_.triangles[t].nodes[k]));
          continue;
        }
        corners[k] = static_cast<Index>(found->second);
        used_[found->second] = true;
      }
      mesh_.triangle.push_back(corners);
    }
  }

  void check_flat() {
    std::size_t first = 0;
    while (first + 1 < used_.size() && !used_[first]) ++first;
    Vec3 low = raw_.nodes[first].position, high = low;
    for (std::size_t n = 0; n < used_.size(); ++n)
      if (used_[n]) {
        const Vec3& p = raw_.nodes[n].position;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    const double span = std::max(high.x - low.x, high.y - low.y);
    const double z = raw_.nodes[first].position.z;
    if (!(high.z - low.z > 1e-9 * span)) return;
    for (std::size_t n = 0; n < used_.size(); ++n)
      if (used_[n] && !(std::abs(raw_.nodes[n].position.z - z) <= 1e-9 * span))
        add(
            fmt::format("{}node {} has z = {:.6g}, {} has z = {:.6g}; a mesh must lie in one plane "
                        "of constant z",
                        in_line(raw_.nodes[n].line), raw_.nodes[n].number, raw_.nodes[n].position.z,
                        node_name(first), z));
    refuse_if_any();
  }

  /// Ends of lines and single points that no triangle uses are no part of the mesh.
  void drop_nodes_of_others() {
    std::vector<bool> others(raw_.nodes.size());
    const auto mark = [&](std::int64_t number) {
      const auto found = position_.find(number);
      if (found != position_.end()) others[found->second] = true;
    };
    for (const RawMesh::Element& line : raw_.lines) {
      mark(line.nodes[0]);
      mark(line.nodes[1]);
    }
    for (const std::int64_t number : raw_.other_nodes) mark(number);
    index_.assign(raw_.nodes.size(), -1);
    for (std::size_t n = 0; n < raw_.nodes.size(); ++n) {
      if (!used_[n] && others[n]) continue;
      index_[n] = static_cast<Index>(mesh_.point.size());
      kept_.push_back(n);
      mesh_.point.push_back({raw_.nodes[n].position.x, raw_.nodes[n].position.y});
    }
    for (Triangle& t : mesh_.triangle)
      for (Index& v : t) v = index_[static_cast<std::size_t>(v)];
  }

  /// A vertex of the mesh, or -1.
  Index vertex(std::int64_t number) const {
    const auto found = position_.find(number);
    return found == position_.end() ? -1 : index_[found->second];
  }

  void take_sets() {
    for (const auto& [name, triangles] : raw_.parts) {
      Part part{name, {}};
      for (const std::size_t t : triangles) part.triangles.push_back(static_cast<Index>(t));
      if (!part.triangles.empty()) mesh_.parts.push_back(std::move(part));
    }
    if (raw_.line_sets.empty() && raw_.node_sets.empty()) return;
    const std::vector<MeshEdge> edges = edges_of(mesh_.triangle);
    for (const auto& [name, lines] : raw_.line_sets) {
      EdgeSet set{name, {}};
      for (const std::size_t l : lines) {
        const Index a = vertex(raw_.lines[l].nodes[0]), b = vertex(raw_.lines[l].nodes[1]);
        const Edge ends{std::min(a, b), std::max(a, b)};
        const auto found =
            std::lower_bound(edges.begin(), edges.end(), ends,
                             [](const MeshEdge& e, const Edge& key) { return e.ends < key; });
        if (a >= 0 && b >= 0 && found != edges.end() && found->ends == ends)
          set.edges.push_back(ends);
        else
          add(fmt::format("{}element {} of the set \"{}\" is not an edge of a triangle",
                          in_line(raw_.lines[l].line), raw_.lines[l].number, name));
      }
      mesh_.edge_sets.push_back(std::move(set));
    }
    for (const auto& [name, numbers] : raw_.node_sets) {
      std::vector<bool> in(mesh_.point.size());
      for (const std::int64_t number : numbers)
        if (const Index v = vertex(number); v >= 0)
          in[static_cast<std::size_t>(v)] = true;
        else if (!position_.contains(number))
          add(fmt::format("the node set \"{}\" names node {}, which is not there", name, number));
      EdgeSet set{name, {}};
      for (const MeshEdge& edge : edges)
        if (in[static_cast<std::size_t>(edge.ends[0])] &&
            in[static_cast<std::size_t>(edge.ends[1])])
          set.edges.push_back(edge.ends);
      mesh_.edge_sets.push_back(std::move(set));
    }
    refuse_if_any();
  }

  const RawMesh& raw_;
  const std::string& name_;
  bool seams_;
  std::unordered_map<std::int64_t, std::size_t> position_;  ///< of a number, in raw_.nodes
  std::vector<bool> used_;                                  ///< node is a corner
  std::vector<Index> index_;                                ///< vertex of a node; -1: dropped
  std::vector<std::size_t> kept_;                           ///< node of a vertex
  Mesh mesh_;
  std::vector<std::string> problems_;
  std::size_t count_ = 0;
};

}  // namespace

Mesh finished_mesh(const RawMesh& raw, const std::string& name, bool seams) {
  return Finisher(raw, name, seams).run();
}

Mesh read_mesh(const std::string& path, bool seams) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".msh" && ending != ".inp")
    throw InputError(path +
                     " is no mesh that can be read; allowed are .msh (Gmsh 4.1) and .inp "
                     "(Abaqus)");
  const std::string content = read_whole_file(path);
  return ending == ".msh" ? parse_gmsh(content, path, seams) : parse_abaqus(content, path, seams);
}

}  // namespace breccia::prepare
