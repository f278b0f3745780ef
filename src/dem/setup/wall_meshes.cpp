#include "dem/setup/wall_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "exec/error.hpp"
#include "math/bounds.hpp"

namespace breccia::dem {
namespace {

/// A surface with numbered corners.
struct Surface {
  std::vector<Vec3> corner;                    ///< three of each triangle  [m]
  std::vector<Index> vertex;                   ///< number of each corner's place
  std::map<std::array<Index, 2>, Index> edge;  ///< from, to: its triangle
  Index vertices = 0;

  explicit Surface(const std::vector<Vec3>& corners) : corner(corners) {
    std::map<Place, Index> number;
    for (const Vec3& c : corner)
      vertex.push_back(
          number.try_emplace(place_of(c), static_cast<Index>(number.size())).first->second);
    vertices = static_cast<Index>(number.size());
  }
  Index triangles() const { return static_cast<Index>(corner.size() / 3); }
  std::array<Index, 2> edge_of(Index t, int k) const {
    return {vertex[static_cast<std::size_t>(3 * t + k)],
            vertex[static_cast<std::size_t>(3 * t + (k + 1) % 3)]};
  }
  const Vec3& at(Index t, int k) const { return corner[static_cast<std::size_t>(3 * t + k % 3)]; }
  /// The triangle beyond an edge and which of its corners is not on it; -1: none.
  std::array<Index, 2> beyond(Index t, int k) const {
    const auto [from, to] = edge_of(t, k);
    const auto other = edge.find({to, from});
    if (other == edge.end()) return {-1, -1};
    for (Index c = 0; c < 3; ++c) {
      const Index v = vertex[static_cast<std::size_t>(3 * other->second + c)];
      if (v != from && v != to) return {other->second, c};
    }
    return {-1, -1};
  }
  std::string corner_text(Index t, int k) const {
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", at(t, k).x, at(t, k).y, at(t, k).z);
  }
};

/// Finds the edges. @returns what is wrong with them
std::string join(Surface& s) {
  for (Index t = 0; t < s.triangles(); ++t) {
    const Vec3 a = s.at(t, 1) - s.at(t, 0), b = s.at(t, 2) - s.at(t, 0);
    if (!(norm(cross(a, b)) > 1e-12 * std::max(dot(a, a), dot(b, b))))
      return fmt::format("triangle {} has no area; one of its corners is at {}", t,
                         s.corner_text(t, 0));
    for (int k = 0; k < 3; ++k)
      if (!s.edge.try_emplace(s.edge_of(t, k), t).second)
        return fmt::format(
            "two triangles run along one edge in the same direction, or more than two share it; it "
            "begins at {}",
            s.corner_text(t, k));
  }
  return "";
}

struct Box {
  Vec3 low, high;
};
Box box_of(const Surface& s, Index t) {
  return {least_of(least_of(s.at(t, 0), s.at(t, 1)), s.at(t, 2)),
          most_of(most_of(s.at(t, 0), s.at(t, 1)), s.at(t, 2))};
}

/// Divides triangles by their middles, along the longest side of the box of these.
class Tree {
 public:
  std::vector<MeshNode> nodes;
  std::vector<Index> order;  ///< of the triangles

  /// @param node, triangle  numbers of the first ones among those of all walls
  Tree(const Surface& surface, Index node, Index triangle)
      : order(static_cast<std::size_t>(surface.triangles())),
        surface_(surface),
        first_node_(node),
        first_triangle_(triangle) {
    std::iota(order.begin(), order.end(), 0);
    divide(0, order.size());
  }

 private:
  static constexpr std::size_t in_a_leaf = 4;

  void divide(std::size_t begin, std::size_t end) {
    const std::size_t here = nodes.size();
    nodes.emplace_back();
    Box all = box_of(surface_, order[begin]);
    Box middles{middle(order[begin]), middle(order[begin])};
    for (std::size_t i = begin; i < end; ++i) {
      const Box own = box_of(surface_, order[i]);
      all = {least_of(all.low, own.low), most_of(all.high, own.high)};
      middles = {least_of(middles.low, middle(order[i])), most_of(middles.high, middle(order[i]))};
    }
    MeshNode node{all.low, all.high, 0, 0, 0};
    if (end - begin <= in_a_leaf) {
      node.first = first_triangle_ + static_cast<Index>(begin);
      node.count = static_cast<Index>(end - begin);
    } else {
      sort(begin, end, middles.high - middles.low);
      const std::size_t half = (begin + end) / 2;
      divide(begin, half);
      divide(half, end);
    }
    node.next = first_node_ + static_cast<Index>(nodes.size());
    nodes[here] = node;
  }
  Vec3 middle(Index t) const {
    const Box box = box_of(surface_, t);
    return 0.5 * (box.low + box.high);
  }
  void sort(std::size_t begin, std::size_t end, const Vec3& span) {
    const int axis = span.x >= span.y && span.x >= span.z ? 0 : span.y >= span.z ? 1 : 2;
    const auto place = [&](Index t) { return place_of(middle(t))[static_cast<std::size_t>(axis)]; };
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end), [&](Index p, Index q) {
                const double a = place(p), b = place(q);
                return a < b || (a == b && p < q);
              });
  }
  const Surface& surface_;
  Index first_node_, first_triangle_;
};

/// All surfaces, before they are copied to a space.
struct Arrays {
  std::vector<MeshNode> nodes;
  std::vector<MeshTriangle> triangles;
  std::vector<Index> starts{0};
  std::vector<Vec3> ends, out;

  WallMeshes::Part add(const Surface& s) {
    WallMeshes::Part part;
    part.first = static_cast<Index>(nodes.size());
    part.first_triangle = static_cast<Index>(triangles.size());
    const auto first_vertex = static_cast<Index>(out.size());
    const Tree tree(s, part.first, part.first_triangle);
    nodes.insert(nodes.end(), tree.nodes.begin(), tree.nodes.end());
    part.last = static_cast<Index>(nodes.size());
    part.closed = true;
    for (const Index t : tree.order) {
      triangles.push_back(triangle(s, t, first_vertex));
      part.closed = part.closed && triangles.back().neighbours == 7;
    }
    part.last_triangle = static_cast<Index>(triangles.size());
    add_vertices(s);
    return part;
  }

 private:
  static MeshTriangle triangle(const Surface& s, Index t, Index first_vertex) {
    MeshTriangle made{};
    for (int k = 0; k < 3; ++k) {
      made.corner[k] = s.at(t, k);
      made.vertex[k] = first_vertex + s.edge_of(t, k)[0];
      const auto [other, corner] = s.beyond(t, k);
      if (other < 0) continue;
      made.neighbours |= 1 << k;
      made.across[k] = s.at(other, corner);
    }
    return made;
  }
  /// Edges at each vertex, and the sum of normals by the angles of the triangles there. Its sign
  /// alone is asked for, so that last bits of the angles do not matter.
  void add_vertices(const Surface& s) {
    std::vector<std::vector<Vec3>> of(static_cast<std::size_t>(s.vertices));
    std::vector<Vec3> sum(of.size());
    for (Index t = 0; t < s.triangles(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 &here = s.at(t, k), &next = s.at(t, k + 1), &last = s.at(t, k + 2);
        const auto v = static_cast<std::size_t>(s.edge_of(t, k)[0]);
        of[v].push_back(next);
        if (s.beyond(t, (k + 2) % 3)[0] < 0) of[v].push_back(last);  // no triangle begins there
        const Vec3 a = next - here, b = last - here, n = cross(a, b);
        sum[v] += (std::atan2(norm(n), dot(a, b)) / norm(n)) * n;
      }
    for (std::size_t v = 0; v < of.size(); ++v) {
      ends.insert(ends.end(), of[v].begin(), of[v].end());
      starts.push_back(static_cast<Index>(ends.size()));
      out.push_back(sum[v]);
    }
  }
};

}  // namespace

std::string wall_mesh_problem(const std::vector<Vec3>& corners) {
  if (corners.empty() || corners.size() % 3 != 0) return "it has no triangles";
  if (corners.size() / 3 > most_mesh_triangles)
    return fmt::format("it has {} triangles; a wall may have {}", corners.size() / 3,
                       most_mesh_triangles);
  Surface surface(corners);
  return join(surface);
}

WallMeshes wall_meshes(const Config& config, const Model& model, Space space) {
  WallMeshes made;
  const auto is_mesh = [](const WallConfig& wall) { return wall.shape == "stl"; };
  const auto count =
      static_cast<std::size_t>(std::count_if(config.walls.begin(), config.walls.end(), is_mesh));
  if (model.wall_meshes.size() != count)
    throw InputError(
        fmt::format("the case has {} walls from STL files, and its model has triangles of {}; "
                    "prepare it again",
                    count, model.wall_meshes.size()));
  if (count == 0) return made;
  Arrays arrays;
  auto corners = model.wall_meshes.begin();
  for (const WallConfig& wall : config.walls) {
    made.parts.emplace_back();
    if (!is_mesh(wall)) continue;
    Surface surface(*corners++);
    if (const std::string problem = join(surface); !problem.empty())
      throw InputError(fmt::format("wall.{}.file: {}", wall.name, problem));
    made.parts.back() = arrays.add(surface);
  }
  const auto place = [space](auto& buffer, const auto& items) {
    buffer = std::decay_t<decltype(buffer)>(space);
    copy_to(buffer, items);
  };
  place(made.nodes, arrays.nodes);
  place(made.triangles, arrays.triangles);
  place(made.starts, arrays.starts);
  place(made.ends, arrays.ends);
  place(made.out, arrays.out);
  return made;
}

double farthest_corner(const std::vector<Vec3>& corners) {
  double farthest = 0.0;
  for (const Vec3& c : corners) farthest = std::max(farthest, norm(c));
  return farthest;
}

}  // namespace breccia::dem
