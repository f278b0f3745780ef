#include "prepare/meshing/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <unordered_map>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/finisher.hpp"
#include "prepare/meshing/mesh_check.hpp"

namespace breccia::prepare {
namespace {

/// The number of the node in the middle of a quadrangle: no file has such numbers.
std::int64_t middle_of(std::size_t quadrangle) {
  return -1 - static_cast<std::int64_t>(quadrangle);
}

/// Mean place of the corners of each quadrangle. A corner that is not there is told of later.
void place_middles(RawMesh& raw) {
  if (raw.quadrangles.empty()) return;
  std::unordered_map<std::int64_t, Vec3> place;
  for (const RawMesh::Node& node : raw.nodes) place.emplace(node.number, node.position);
  for (std::size_t q = 0; q < raw.quadrangles.size(); ++q) {
    Vec3 sum{};
    for (const std::int64_t number : raw.quadrangles[q].nodes) sum += place[number];
    raw.nodes.push_back({middle_of(q), 0.25 * sum, raw.quadrangles[q].line});
  }
}

class Finisher : FinisherBase {
 public:
  Finisher(const RawMesh& raw, const std::string& name, bool seams)
      : FinisherBase(raw, name), seams_(seams) {}

  Mesh run() {
    number_nodes(3, "triangles");
    mesh_.triangle = taken_elements<Triangle>("triangles");
    refuse_if_any();
    check_flat();
    drop_nodes_of_others();
    MeshNames names{[this](Index t) { return element_name(static_cast<std::size_t>(t)); },
                    [this](Index v) { return node_name(kept_[static_cast<std::size_t>(v)]); }};
    for (const std::string& problem : mesh_problems(mesh_, names)) add(problem);
    refuse_if_any();
    if (!seams_) {
      check_seams(names);
      refuse_if_any();
    }
    take_sets();
    take_inner_edges();
    return std::move(mesh_);
  }

 private:
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
    for (const RawMesh::Element& line : raw_.sides) {
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

  void take_sets() {
    for (const auto& [name, triangles] : raw_.parts) {
      Part part{name, {}};
      for (const std::size_t t : triangles) part.triangles.push_back(static_cast<Index>(t));
      if (!part.triangles.empty()) mesh_.parts.push_back(std::move(part));
    }
    if (raw_.side_sets.empty() && raw_.node_sets.empty()) return;
    const std::vector<MeshEdge> edges = edges_of(mesh_.triangle);
    for (const auto& [name, lines] : raw_.side_sets) {
      EdgeSet set{name, {}};
      for (const std::size_t l : lines) {
        const Index a = vertex(raw_.sides[l].nodes[0]), b = vertex(raw_.sides[l].nodes[1]);
        const Edge ends{std::min(a, b), std::max(a, b)};
        const auto found =
            std::lower_bound(edges.begin(), edges.end(), ends,
                             [](const MeshEdge& e, const Edge& key) { return e.ends < key; });
        if (a >= 0 && b >= 0 && found != edges.end() && found->ends == ends)
          set.edges.push_back(ends);
        else
          add(fmt::format("{}element {} of the set \"{}\" is not an edge of a triangle",
                          in_line(raw_.sides[l].line), raw_.sides[l].number, name));
      }
      mesh_.edge_sets.push_back(std::move(set));
    }
    for (const auto& [name, numbers] : raw_.node_sets) {
      const std::vector<bool> in = vertices_in(name, numbers);
      EdgeSet set{name, {}};
      for (const MeshEdge& edge : edges)
        if (in[static_cast<std::size_t>(edge.ends[0])] &&
            in[static_cast<std::size_t>(edge.ends[1])])
          set.edges.push_back(edge.ends);
      mesh_.edge_sets.push_back(std::move(set));
    }
    refuse_if_any();
  }

  void take_inner_edges() {
    for (std::size_t q = 0; q < raw_.quadrangles.size(); ++q)
      for (const std::int64_t number : raw_.quadrangles[q].nodes) {
        const Index corner = vertex(number), middle = vertex(middle_of(q));
        mesh_.inner.push_back({std::min(corner, middle), std::max(corner, middle)});
      }
  }

  bool seams_;
  Mesh mesh_;
};

}  // namespace

void add_quadrangle(RawMesh& raw, const RawMesh::Element& quadrangle) {
  const std::int64_t middle = middle_of(raw.quadrangles.size());
  for (std::size_t k = 0; k < 4; ++k)
    raw.elements.push_back({quadrangle.number,
                            {quadrangle.nodes[k], quadrangle.nodes[(k + 1) % 4], middle, 0},
                            quadrangle.line});
  raw.quadrangles.push_back(quadrangle);
}

Mesh finished_mesh(RawMesh raw, const std::string& name, bool seams) {
  place_middles(raw);
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
