#include "prepare/tetrahedra/crack_faces.hpp"

#include <algorithm>
#include <cmath>

#include "core/region.hpp"
#include "prepare/tetrahedra/least_cut.hpp"

namespace breccia::prepare {
namespace {

constexpr double on_crack = 1e-6;     ///< corners so near lie on it, over an edge of the face  [-]
constexpr double reach_of_cut = 2.0;  ///< of the search on each side, over the mean edge  [-]
constexpr double cheapest = 0.05;     ///< price of a face on the crack, see the header  [-]
constexpr double firmness = 4.0;      ///< cost of a volume on the wrong side, see the header  [-]

Vec3 unit(const Vec3& v) {
  return (1.0 / norm(v)) * v;
}

/// The largest edge of a tetrahedron, and the mean one.  [m]
std::pair<double, double> edges_of_one(const std::vector<Vec3>& point, const Tetrahedron& t) {
  double longest = 0.0, sum = 0.0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b) {
      const double length = norm(at(point, t[a]) - at(point, t[b]));
      longest = std::max(longest, length);
      sum += length;
    }
  return {longest, sum / 6.0};
}

/// The part of a mesh near a crack that does not follow it.
class NearCrack {
 public:
  NearCrack(const FlatCrack& crack, const std::vector<Vec3>& point,
            const std::vector<Tetrahedron>& tetrahedra, const std::vector<MeshFace>& faces,
            const std::function<bool(Index)>& follows)
      : crack_(crack), point_(point), tetrahedra_(tetrahedra) {
    region_.assign(tetrahedra.size(), out);
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
      const Vec3 place = centroid(point, tetrahedra[t]);
      if (!crack.covers(place) || follows(static_cast<Index>(t)) ||
          std::abs(crack.height(place)) > reach_of_cut * edges_of_one(point, tetrahedra[t]).first)
        continue;
      region_[t] = unknown;
      near_.push_back(static_cast<Index>(t));
    }
    if (near_.empty()) return;
    for (const MeshFace& face : faces)
      if (face.tetrahedra[1] >= 0 && is_near(face.tetrahedra[0]) && is_near(face.tetrahedra[1]))
        inner_.push_back(&face);
    number_regions();
  }

  /// The cheapest cut through each region.
  std::vector<Face> cut() const {
    std::vector<Face> found;
    for (std::size_t r = 0; r < members_.size(); ++r) {
      const auto more = cut_of(members_[r], between_[r]);
      found.insert(found.end(), more.begin(), more.end());
    }
    return found;
  }

 private:
  static constexpr Index out = -2, unknown = -1;
  Index& place_of(Index t) { return place_[static_cast<std::size_t>(t)]; }
  bool is_near(Index t) const { return region_[static_cast<std::size_t>(t)] != out; }

  void number_regions() {
    place_.assign(tetrahedra_.size(), -1);
    for (std::size_t k = 0; k < near_.size(); ++k) place_of(near_[k]) = static_cast<Index>(k);
    std::vector<std::vector<Index>> next(near_.size());
    for (const MeshFace* face : inner_)
      for (std::size_t side = 0; side < 2; ++side)
        next[static_cast<std::size_t>(place_of(face->tetrahedra[side]))].push_back(
            face->tetrahedra[1 - side]);
    for (const Index first : near_) {
      if (region_[static_cast<std::size_t>(first)] != unknown) continue;
      const auto number = static_cast<Index>(members_.size());
      std::vector<Index> members{first};
      region_[static_cast<std::size_t>(first)] = number;
      for (std::size_t k = 0; k < members.size(); ++k) {
        for (const Index n : next[static_cast<std::size_t>(place_of(members[k]))])
          if (Index& region = region_[static_cast<std::size_t>(n)]; region == unknown) {
            region = number;
            members.push_back(n);
          }
        place_of(members[k]) = static_cast<Index>(k);  // from now on within its region
      }
      members_.push_back(std::move(members));
    }
    between_.resize(members_.size());
    for (const MeshFace* face : inner_)
      between_[static_cast<std::size_t>(region_[static_cast<std::size_t>(face->tetrahedra[0])])]
          .push_back(face);
  }

  std::vector<Face> cut_of(const std::vector<Index>& members,
                           const std::vector<const MeshFace*>& between) const {
    double edge = 0.0;
    for (const Index t : members)
      edge += edges_of_one(point_, tetrahedra_[static_cast<std::size_t>(t)]).second;
    edge /= static_cast<double>(members.size());
    const auto cost = [&](double area) {  // in millionths of the edge's square
      return std::max<std::int64_t>(1, std::llround(1e6 * area / (edge * edge)));
    };
    constexpr auto firm = std::int64_t{1} << 50;
    LeastCut network(static_cast<Index>(members.size()));
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Tetrahedron& t = tetrahedra_[static_cast<std::size_t>(members[k])];
      const double height = crack_.height(centroid(point_, t));
      const double volume = signed_volume(point_, t);
      const std::int64_t tie = std::abs(height) > edge
                                   ? firm
                                   : cost(firmness * volume * std::abs(height) / (edge * edge));
      if (height > 0.0)
        network.tie_to_source(static_cast<Index>(k), tie);
      else
        network.tie_to_sink(static_cast<Index>(k), tie);
    }
    const auto place = [&](Index t) { return place_[static_cast<std::size_t>(t)]; };
    for (const MeshFace* face : between) {
      const Vec3 a = at(point_, face->corners[0]);
      const double area =
          0.5 * norm(cross(at(point_, face->corners[1]) - a, at(point_, face->corners[2]) - a));
      double off = 0.0;
      for (const Index v : face->corners) off += std::abs(crack_.height(at(point_, v))) / 3.0;
      network.join(place(face->tetrahedra[0]), place(face->tetrahedra[1]),
                   cost(std::min(1.0, cheapest + 2.0 * off / edge) * area));
    }
    const std::vector<bool> above = network.with_source();
    std::vector<Face> found;
    for (const MeshFace* face : between)
      if (above[static_cast<std::size_t>(place(face->tetrahedra[0]))] !=
          above[static_cast<std::size_t>(place(face->tetrahedra[1]))])
        found.push_back(face->corners);
    return found;
  }

  const FlatCrack& crack_;
  const std::vector<Vec3>& point_;
  const std::vector<Tetrahedron>& tetrahedra_;
  std::vector<const MeshFace*> inner_;
  std::vector<Index> near_;                  ///< tetrahedra
  std::vector<Index> region_, place_;        ///< of each tetrahedron; its place in the region
  std::vector<std::vector<Index>> members_;  ///< tetrahedra of each region
  std::vector<std::vector<const MeshFace*>> between_;  ///< faces within each region
};

}  // namespace

FlatCrack::FlatCrack(const fdem3::DiscontinuityConfig& given)
    : place_(given.center), normal_(given.normal), radius_(given.radius) {
  if (!given.points.empty()) {
    place_ = given.points[0];
    normal_ = {};
    for (std::size_t k = 1; k + 1 < given.points.size(); ++k)
      normal_ += cross(given.points[k] - place_, given.points[k + 1] - place_);
  }
  normal_ = unit(normal_);
  across_ = unit(std::abs(normal_.x) < 0.6 ? cross({1.0, 0.0, 0.0}, normal_)
                                           : cross({0.0, 1.0, 0.0}, normal_));
  up_ = cross(normal_, across_);
  for (const Vec3& p : given.points)
    corners_.push_back({dot(p - place_, across_), dot(p - place_, up_)});
}

bool FlatCrack::covers(const Vec3& x) const {
  const Vec2 foot{dot(x - place_, across_), dot(x - place_, up_)};
  return corners_.empty() ? in_circle({}, radius_, foot) : in_polygon(corners_, foot);
}

std::vector<Face> faces_along(const fdem3::DiscontinuityConfig& given,
                              const std::vector<Vec3>& point,
                              const std::vector<Tetrahedron>& tetrahedra,
                              const std::vector<MeshFace>& faces,
                              const std::function<bool(Index)>& follows) {
  const FlatCrack crack(given);
  std::vector<Face> found = NearCrack(crack, point, tetrahedra, faces, follows).cut();
  for (const MeshFace& face : faces) {
    if (face.tetrahedra[1] < 0 || !follows(face.tetrahedra[0])) continue;
    const double edge = norm(at(point, face.corners[1]) - at(point, face.corners[0]));
    if (std::all_of(
            face.corners.begin(), face.corners.end(),
            [&](Index v) { return std::abs(crack.height(at(point, v))) <= on_crack * edge; }) &&
        crack.covers(centroid(point, face.corners)))
      found.push_back(face.corners);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace breccia::prepare
