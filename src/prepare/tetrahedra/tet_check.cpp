#include "prepare/tetrahedra/tet_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "exec/error.hpp"

namespace breccia::prepare {
namespace {

constexpr double least_volume = 1e-7;  ///< over the longest edge's cube  [-]

/// A face as one tetrahedron sees it.
struct FaceSide {
  Face corners;  ///< ascending
  Index tetrahedron;
  bool even;  ///< the tetrahedron's own order of the corners is an even permutation of them
};

/// Sorts items, those of each lowest vertex by themselves.
/// @param lowest  vertex of an item  @param before  compares their lowest vertices first
template <class Item, class Lowest, class Before>
void sort_by_vertices(std::vector<Item>& items, const Lowest& lowest, const Before& before) {
  Index most = -1;
  for (const Item& item : items) most = std::max(most, lowest(item));
  std::vector<std::size_t> end(at(most + 1) + 1, 0);  // of each vertex' items
  for (const Item& item : items) ++end[at(lowest(item)) + 1];
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Item> placed(items.size());
  for (const Item& item : items) placed[end[at(lowest(item))]++] = item;
  std::size_t begin = 0;
  for (const std::size_t next : end) {
    std::sort(placed.begin() + static_cast<std::ptrdiff_t>(begin),
              placed.begin() + static_cast<std::ptrdiff_t>(next), before);
    begin = next;
  }
  items.swap(placed);
}

bool is_even(const Face& f) {
  return (f[0] < f[1]) ^ (f[1] < f[2]) ^ (f[0] < f[2]);
}

std::vector<FaceSide> face_sides(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<FaceSide> sides;
  sides.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      const Face face = face_of(tetrahedra[t], k);
      sides.push_back({sorted(face), static_cast<Index>(t), is_even(face)});
    }
  sort_by_vertices(
      sides, [](const FaceSide& side) { return side.corners[0]; },
      [](const FaceSide& a, const FaceSide& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.tetrahedron < b.tetrahedron;
      });
  return sides;
}

class TetChecker {
 public:
  TetChecker(const TetMesh& mesh, const TetNames& names, std::size_t most)
      : mesh_(mesh), names_(names), most_(most) {}

  std::vector<std::string> run() {
    if (mesh_.tetrahedron.empty()) problems_.push_back("there are no tetrahedra");
    check_vertices();
    if (!problems_.empty()) return problems_;  // nothing else could be looked up
    check_volumes();
    check_doubles();
    check_faces();
    check_use();
    return problems_;
  }

 private:
  /// Counts all of one kind, tells of the first ones.
  class Kind {
   public:
    explicit Kind(TetChecker& checker) : checker_(checker) {}
    ~Kind() {
      if (count_ > checker_.most_)
        checker_.problems_.push_back(
            fmt::format("... and {} more like the last one", count_ - checker_.most_));
    }
    /// @param text  makes the sentence, only if it is told
    template <class Text>
    void add(const Text& text) {
      if (++count_ <= checker_.most_) checker_.problems_.push_back(text());
    }

   private:
    TetChecker& checker_;
    std::size_t count_ = 0;
  };

  std::string name(std::size_t t) const { return names_.tetrahedron(static_cast<Index>(t)); }

  void check_vertices() {
    Kind kind(*this);
    for (std::size_t i = 0; i < mesh_.point.size(); ++i)
      if (const Vec3& p = mesh_.point[i];
          !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        kind.add([&] {
          return names_.vertex(static_cast<Index>(i)) + " has a coordinate that is no number";
        });
    const auto count = static_cast<Index>(mesh_.point.size());
    for (std::size_t t = 0; t < mesh_.tetrahedron.size(); ++t)
      for (const Index v : mesh_.tetrahedron[t])
        if (v < 0 || v >= count)
          kind.add([&] {
            return fmt::format("{} has corner {}; there are only {} vertices", name(t), v, count);
          });
  }

  void check_volumes() {
    Kind kind(*this);
    for (std::size_t t = 0; t < mesh_.tetrahedron.size(); ++t) {
      const Tetrahedron& corner = mesh_.tetrahedron[t];
      bool twice = false;
      double longest = 0.0;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b) {
          twice = twice || corner[a] == corner[b];
          longest =
              std::max(longest, norm(at(mesh_.point, corner[a]) - at(mesh_.point, corner[b])));
        }
      if (twice) {
        kind.add([&] { return name(t) + " has the same corner twice"; });
        continue;
      }
      const double volume = signed_volume(mesh_.point, corner);
      const Vec3 place = centroid(mesh_.point, corner);
      if (!(std::abs(volume) > least_volume * longest * longest * longest))
        kind.add([&] {
          return fmt::format(
              "{} at ({:.6g}, {:.6g}, {:.6g}) m has no volume: its corners lie in a plane", name(t),
              place.x, place.y, place.z);
        });
      else if (volume < 0.0)
        kind.add([&] {
          return fmt::format(
              "{} at ({:.6g}, {:.6g}, {:.6g}) m is turned inside out: its first three corners must "
              "run counter-clockwise seen from the fourth",
              name(t), place.x, place.y, place.z);
        });
    }
  }

  void check_doubles() {
    Kind kind(*this);
    std::vector<std::pair<Tetrahedron, Index>> all;
    all.reserve(mesh_.tetrahedron.size());
    for (std::size_t t = 0; t < mesh_.tetrahedron.size(); ++t) {
      Tetrahedron corner = mesh_.tetrahedron[t];
      std::sort(corner.begin(), corner.end());
      all.emplace_back(corner, static_cast<Index>(t));
    }
    sort_by_vertices(
        all, [](const auto& one) { return one.first[0]; }, std::less<>());
    for (std::size_t k = 1; k < all.size(); ++k)
      if (all[k].first == all[k - 1].first) {
        kind.add([&] {
          return fmt::format("{} and {} are the same tetrahedron",
                             names_.tetrahedron(all[k - 1].second),
                             names_.tetrahedron(all[k].second));
        });
        has_doubles_ = true;
      }
  }

  void check_faces() {
    if (has_doubles_) return;  // already said, and each would be told four times more
    Kind kind(*this);
    const std::vector<FaceSide> sides = face_sides(mesh_.tetrahedron);
    for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
      for (end = k; end < sides.size() && sides[end].corners == sides[k].corners;) ++end;
      const auto face = [&] {
        return fmt::format("the face of {}, {} and {}", names_.vertex(sides[k].corners[0]),
                           names_.vertex(sides[k].corners[1]), names_.vertex(sides[k].corners[2]));
      };
      const auto owner = [&](std::size_t i) {
        return names_.tetrahedron(sides[k + i].tetrahedron);
      };
      if (end - k > 2)
        kind.add([&] {
          return fmt::format("{} belongs to {} tetrahedra ({}, {}, {}{}); at most 2 can share one",
                             face(), end - k, owner(0), owner(1), owner(2),
                             end - k > 3 ? ", ..." : "");
        });
      else if (end - k == 2 && sides[k].even == sides[k + 1].even)
        kind.add([&] {
          return fmt::format("{} and {} lie on the same side of {}: they overlap", owner(0),
                             owner(1), face());
        });
    }
  }

  void check_use() {
    Kind kind(*this);
    std::vector<bool> used(mesh_.point.size());
    for (const Tetrahedron& t : mesh_.tetrahedron)
      for (const Index v : t) used[static_cast<std::size_t>(v)] = true;
    for (std::size_t i = 0; i < used.size(); ++i)
      if (!used[i])
        kind.add(
            [&] { return names_.vertex(static_cast<Index>(i)) + " belongs to no tetrahedron"; });
  }

  const TetMesh& mesh_;
  const TetNames& names_;
  std::size_t most_;
  bool has_doubles_ = false;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<MeshFace> faces_of(const std::vector<Tetrahedron>& tetrahedra) {
  const std::vector<FaceSide> sides = face_sides(tetrahedra);
  std::vector<MeshFace> faces;
  faces.reserve(sides.size() / 2 + 1);
  for (const FaceSide& side : sides)
    if (faces.empty() || faces.back().corners != side.corners)
      faces.push_back({side.corners, {side.tetrahedron, -1}});
    else if (faces.back().tetrahedra[1] < 0)
      faces.back().tetrahedra[1] = side.tetrahedron;
  return faces;
}

const MeshFace* find_face(const std::vector<MeshFace>& faces, const Face& corners) {
  const auto found =
      std::lower_bound(faces.begin(), faces.end(), corners,
                       [](const MeshFace& f, const Face& key) { return f.corners < key; });
  return found != faces.end() && found->corners == corners ? &*found : nullptr;
}

TetNames plain_tet_names() {
  return {[](Index t) { return fmt::format("tetrahedron {}", t); },
          [](Index v) { return fmt::format("vertex {}", v); }};
}

std::vector<std::string> mesh_problems(const TetMesh& mesh, const TetNames& names,
                                       std::size_t most) {
  return TetChecker(mesh, names, most).run();
}

void check_mesh(const TetMesh& mesh) {
  const std::vector<std::string> problems = mesh_problems(mesh, plain_tet_names());
  if (!problems.empty()) throw InputError(fmt::format("{}", fmt::join(problems, "\n  ")));
}

}  // namespace breccia::prepare
