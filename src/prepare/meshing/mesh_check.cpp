#include "prepare/meshing/mesh_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"

namespace breccia::prepare {
namespace {

/// An edge as one triangle sees it.
struct Side {
  Edge ends;  ///< the smaller vertex first
  Index triangle;
  bool forward;  ///< the triangle runs from the smaller vertex to the larger one
};

std::vector<Side> sides_of(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<Index>(t), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
  });
  return sides;
}

class Checker {
 public:
  Checker(const Mesh& mesh, const MeshNames& names, std::size_t most)
      : mesh_(mesh), names_(names), most_(most) {}

  std::vector<std::string> run() {
    if (mesh_.triangle.empty()) problems_.push_back("there are no triangles");
    check_vertices();
    if (!problems_.empty()) return problems_;  // nothing else could be looked up
    check_areas();
    check_doubles();
    check_edges();
    check_use();
    return problems_;
  }

 private:
  /// Counts all of one kind, tells of the first ones.
  class Kind {
   public:
    explicit Kind(Checker& checker) : checker_(checker) {}
    ~Kind() {
      if (count_ > checker_.most_)
        checker_.problems_.push_back(
            fmt::format("... and {} more like the last one", count_ - checker_.most_));
    }
    void add(const std::string& text) {
      if (++count_ <= checker_.most_) checker_.problems_.push_back(text);
    }

   private:
    Checker& checker_;
    std::size_t count_ = 0;
  };

  void check_vertices() {
    Kind kind(*this);
    for (std::size_t i = 0; i < mesh_.point.size(); ++i)
      if (!std::isfinite(mesh_.point[i].x) || !std::isfinite(mesh_.point[i].y))
        kind.add(names_.vertex(static_cast<Index>(i)) + " has a coordinate that is no number");
    const auto count = static_cast<Index>(mesh_.point.size());
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (const Index v : mesh_.triangle[t])
        if (v < 0 || v >= count)
          kind.add(fmt::format("{} has corner {}; there are only {} vertices",
                               names_.triangle(static_cast<Index>(t)), v, count));
  }

  void check_areas() {
    Kind kind(*this);
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
      const Triangle& corner = mesh_.triangle[t];
      const Index index = static_cast<Index>(t);
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
        kind.add(names_.triangle(index) + " has the same corner twice");
        continue;
      }
      double longest = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest,
                           norm(at(mesh_.point, corner[(k + 1) % 3]) - at(mesh_.point, corner[k])));
      const double area = signed_area(mesh_.point, corner);
      const Vec2 place = centroid(mesh_.point, corner);
      if (!(std::abs(area) > 1e-7 * longest * longest))
        kind.add(fmt::format("{} at ({:.6g}, {:.6g}) m has no area: its corners lie on a line",
                             names_.triangle(index), place.x, place.y));
      else if (area < 0.0)
        kind.add(
            fmt::format("{} at ({:.6g}, {:.6g}) m has clockwise corners; needed is "
                        "counter-clockwise",
                        names_.triangle(index), place.x, place.y));
    }
  }

  void check_doubles() {
    Kind kind(*this);
    std::vector<std::pair<Triangle, Index>> sorted;
    sorted.reserve(mesh_.triangle.size());
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
      Triangle corner = mesh_.triangle[t];
      std::sort(corner.begin(), corner.end());
      sorted.emplace_back(corner, static_cast<Index>(t));
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 1; k < sorted.size(); ++k)
      if (sorted[k].first == sorted[k - 1].first) {
        kind.add(fmt::format("{} and {} are the same triangle",
                             names_.triangle(sorted[k - 1].second),
                             names_.triangle(sorted[k].second)));
        has_doubles_ = true;
      }
  }

  void check_edges() {
    if (has_doubles_) return;  // already said, and each would be told three times more
    Kind kind(*this);
    const std::vector<Side> sides = sides_of(mesh_.triangle);
    for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
      for (end = k; end < sides.size() && sides[end].ends == sides[k].ends;) ++end;
      const auto edge = [&] {
        return fmt::format("the edge from {} to {}", names_.vertex(sides[k].ends[0]),
                           names_.vertex(sides[k].ends[1]));
      };
      if (end - k > 2)
        kind.add(fmt::format("{} belongs to {} triangles ({}, {}, {}{}); at most 2 can share one",
                             edge(), end - k, names_.triangle(sides[k].triangle),
                             names_.triangle(sides[k + 1].triangle),
                             names_.triangle(sides[k + 2].triangle), end - k > 3 ? ", ..." : ""));
      else if (end - k == 2 && sides[k].forward == sides[k + 1].forward)
        kind.add(fmt::format("{} and {} lie on the same side of {}: they overlap",
                             names_.triangle(sides[k].triangle),
                             names_.triangle(sides[k + 1].triangle), edge()));
    }
  }

  void check_use() {
    Kind kind(*this);
    std::vector<bool> used(mesh_.point.size());
    for (const Triangle& t : mesh_.triangle)
      for (const Index v : t) used[static_cast<std::size_t>(v)] = true;
    for (std::size_t i = 0; i < used.size(); ++i)
      if (!used[i]) kind.add(names_.vertex(static_cast<Index>(i)) + " belongs to no triangle");
  }

  const Mesh& mesh_;
  const MeshNames& names_;
  std::size_t most_;
  bool has_doubles_ = false;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<MeshEdge> edges_of(const std::vector<Triangle>& triangles) {
  const std::vector<Side> sides = sides_of(triangles);
  std::vector<MeshEdge> edges;
  edges.reserve(sides.size() / 2 + 1);
  for (const Side& side : sides)
    if (edges.empty() || edges.back().ends != side.ends)
      edges.push_back({side.ends, {side.triangle, -1}});
    else if (edges.back().triangles[1] < 0)
      edges.back().triangles[1] = side.triangle;
  return edges;
}

MeshNames plain_names() {
  return {[](Index t) { return fmt::format("triangle {}", t); },
          [](Index v) { return fmt::format("vertex {}", v); }};
}

std::vector<std::string> mesh_problems(const Mesh& mesh, const MeshNames& names, std::size_t most) {
  return Checker(mesh, names, most).run();
}

void check_mesh(const Mesh& mesh) {
  const std::vector<std::string> problems = mesh_problems(mesh, plain_names());
  if (!problems.empty()) throw InputError(fmt::format("{}", fmt::join(problems, "\n  ")));
}

}  // namespace breccia::prepare
