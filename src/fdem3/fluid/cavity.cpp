#include "fdem3/fluid/cavity.hpp"

#include <algorithm>
#include <map>

#include "core/pieces.hpp"
#include "exec/error.hpp"

namespace breccia::fdem3 {
namespace {

/// Six times the volume within a wall whose vertices and caps lie there; the normals of its faces
/// point into it.
double six_volumes(const HoleWall& hole, const std::vector<Vec3>& place) {
  std::vector<Vec3> middle(at(hole.caps));
  std::vector<double> edges(at(hole.caps), 0.0);
  for (std::size_t e = 0; e < hole.rim.size(); ++e) {
    middle[at(hole.cap[e])] += place[at(hole.rim[e][0])];
    edges[at(hole.cap[e])] += 1.0;
  }
  const Vec3 origin = place.front();
  double sum = 0.0;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    sum -= dot(a - origin, cross(b - origin, c - origin));
  };
  for (const std::array<Index, 3>& c : hole.corner)
    add(place[at(c[0])], place[at(c[1])], place[at(c[2])]);
  for (std::size_t e = 0; e < hole.rim.size(); ++e) {
    const std::size_t cap = at(hole.cap[e]);
    add(place[at(hole.rim[e][1])], place[at(hole.rim[e][0])], (1.0 / edges[cap]) * middle[cap]);
  }
  return sum;
}

/// A wall of some of the faces, by vertices of the model.
class WallMaking {
 public:
  WallMaking(const Model& model, std::vector<Index> faces) : model_(model) {
    wall_.faces = std::move(faces);
    for (const Index face : wall_.faces) {
      std::array<Index, 3> corner{};
      for (int c = 0; c < 3; ++c)
        corner[at(c)] = number_of(
            model.tetrahedron[at(face / 4)][at(corner_of_face(static_cast<int>(face % 4), c))]);
      wall_.corner.push_back(corner);
    }
    wall_.vertices = static_cast<Index>(place_.size());
  }
  /// @throws InputError
  HoleWall made(bool capped, const std::string& where) {
    find_rims(where);
    if (!wall_.rim.empty() && !capped)
      throw InputError(where +
                       ": its region takes a part of a border only; an explosive needs the whole "
                       "wall of a hole, or `capped` where stemming closes it");
    if (!(six_volumes(wall_, place_) > 0.0))
      throw InputError(
          where + ": its region takes the outer border of a body; an explosive lies in a hole");
    return wall_;
  }

 private:
  Index number_of(Index vertex) {
    const auto [found, is_new] = number_.emplace(vertex, static_cast<Index>(place_.size()));
    if (is_new) place_.push_back(model_.point[at(vertex)]);
    return found->second;
  }
  /// Edges of one face alone.
  void find_rims(const std::string& where) {
    std::map<std::array<Index, 2>, int> edges;
    for (const std::array<Index, 3>& corner : wall_.corner)
      for (std::size_t k = 0; k < 3; ++k)
        if (++edges[{corner[k], corner[(k + 1) % 3]}] > 1)
          throw InputError(where + ": two walls of its region meet along one edge");
    Pieces joined(place_.size());
    for (const auto& [edge, count] : edges)
      if (edges.count({edge[1], edge[0]}) == 0) {
        wall_.rim.push_back(edge);
        joined.join(edge[0], edge[1]);
      }
    std::map<Index, Index> cap;  // of the least vertex of each rim
    for (const auto& edge : wall_.rim)
      wall_.cap.push_back(
          cap.emplace(joined.root(edge[0]), static_cast<Index>(cap.size())).first->second);
    wall_.caps = static_cast<Index>(cap.size());
  }

  const Model& model_;
  HoleWall wall_;
  std::map<Index, Index> number_;  ///< of vertices of the model
  std::vector<Vec3> place_;        ///< of the wall's vertices at the start  [m]
};

}  // namespace

std::vector<HoleWall> holes_along(const Model& model, const std::vector<Index>& faces, bool capped,
                                  const std::string& where) {
  Pieces joined(model.point.size());
  const auto vertex = [&](Index face, int c) {
    return model.tetrahedron[at(face / 4)][at(corner_of_face(static_cast<int>(face % 4), c))];
  };
  for (const Index face : faces)
    for (int c = 1; c < 3; ++c) joined.join(vertex(face, 0), vertex(face, c));
  std::map<Index, std::vector<Index>> walls;
  for (const Index face : faces) walls[joined.root(vertex(face, 0))].push_back(face);
  std::vector<HoleWall> holes;
  for (auto& [root, of_wall] : walls) {
    std::sort(of_wall.begin(), of_wall.end());
    holes.push_back(WallMaking(model, std::move(of_wall)).made(capped, where));
  }
  return holes;
}

double volume_within(const HoleWall& hole, const std::vector<FaceNow>& faces) {
  std::vector<Vec3> place(at(hole.vertices));
  std::vector<double> corners(at(hole.vertices), 0.0);
  for (std::size_t f = 0; f < hole.faces.size(); ++f) {
    const FaceNow& face = fdem_shared::side_in(faces, hole.faces[f]);
    for (std::size_t c = 0; c < 3; ++c) {
      place[at(hole.corner[f][c])] += face.at[c];
      corners[at(hole.corner[f][c])] += 1.0;
    }
  }
  for (std::size_t v = 0; v < place.size(); ++v) place[v] = (1.0 / corners[v]) * place[v];
  return six_volumes(hole, place) / 6.0;
}

}  // namespace breccia::fdem3
