#include "coupled/setup/tie.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dem/wall_mesh.hpp"
#include "exec/error.hpp"

namespace breccia::coupled {
namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// A face of the border.
struct BorderFace {
  Index face;  ///< 4 t + k
  Vec3 corner[3];
  double area;
};
std::vector<BorderFace> border_of(const fdem3::Tetrahedra& solids, Index body) {
  std::vector<BorderFace> border;
  for (Index t = 0; t < solids.size(); ++t) {
    if (solids.group.data()[t] != body) continue;
    for (Index k = 0; k < 4; ++k) {
      if ((solids.exposed.data()[t] >> k & 1) == 0) continue;
      BorderFace f{4 * t + k, {}, 0.0};
      for (int c = 0; c < 3; ++c)
        f.corner[c] = solids.nodes.data()[t].at[fdem3::corner_of_face(k, c)].position;
      f.area = 0.5 * norm(cross(f.corner[1] - f.corner[0], f.corner[2] - f.corner[0]));
      border.push_back(f);
    }
  }
  return border;
}

Box box_of(const BorderFace& f) {
  Box box{f.corner[0], f.corner[0]};
  for (const Vec3& x : f.corner) {
    box.low = {std::min(box.low.x, x.x), std::min(box.low.y, x.y), std::min(box.low.z, x.z)};
    box.high = {std::max(box.high.x, x.x), std::max(box.high.y, x.y), std::max(box.high.z, x.z)};
  }
  return box;
}

/// Pairs (sphere of the list, face of the list) that are within reach.
std::vector<std::pair<Index, Index>> near_pairs(const dem::Elements& elements, int threads,
                                                const std::vector<Index>& spheres,
                                                const std::vector<BorderFace>& border,
                                                double range) {
  std::vector<Box> boxes;
  std::vector<GlobalId> ids;
  for (const Index e : spheres) {
    const dem::ElementState& s = elements.state.data()[e];
    const double r = range * s.radius;
    const Vec3 by{r, r, r};
    boxes.push_back({s.position - by, s.position + by});
  }
  for (const BorderFace& f : border) boxes.push_back(box_of(f));
  for (std::size_t i = 0; i < boxes.size(); ++i) ids.push_back(static_cast<GlobalId>(i));
  Buffer<Box> all_boxes;
  Buffer<GlobalId> all_ids;
  copy_to(all_boxes, boxes);
  copy_to(all_ids, ids);
  Pairs found;
  Exec exec;
  exec.threads = threads;
  BroadPhase().search(exec, all_boxes, all_ids, found);
  const auto first = static_cast<Index>(spheres.size());
  std::vector<std::pair<Index, Index>> pairs;
  for (Index i = 0; i < found.size(); ++i)
    if (found.a.data()[i] < first && found.b.data()[i] >= first)
      pairs.emplace_back(found.a.data()[i], found.b.data()[i] - first);
  return pairs;
}

/// Number of the body of this name; -1: there is none.
template <class Names, class NameOf>
Index place_of(const Names& names, const std::string& name, const NameOf& name_of) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name_of(names[i]) == name) return static_cast<Index>(i);
  return -1;
}

BallBond bond_at(const fdem3::Tetrahedra& solids, const dem::ElementState& s, const BorderFace& f,
                 const Vec3& point) {
  BallBond b{};
  b.tetrahedron = f.face / 4;
  b.arm = point - s.position;
  b.length = norm(b.arm);
  const Vec3 n = cross(f.corner[1] - f.corner[0], f.corner[2] - f.corner[0]);
  const double square = dot(n, n);
  double sum = 0.0;
  for (int c = 1; c < 3; ++c) {
    const Vec3 edge = f.corner[(c + 2) % 3] - f.corner[(c + 1) % 3];
    const double share = dot(cross(edge, point - f.corner[(c + 1) % 3]), n) / square;
    b.share[fdem3::corner_of_face(f.face % 4, c)] = std::clamp(share, 0.0, 1.0);
    sum += std::clamp(share, 0.0, 1.0);
  }
  b.share[fdem3::corner_of_face(f.face % 4, 0)] = std::max(0.0, 1.0 - sum);
  b.body = solids.group.data()[b.tetrahedron];
  return b;
}

}  // namespace

std::vector<BallBond> ties_of(const BondConfig& bond, Index law, const World& w,
                              const dem::Elements& elements, const fdem3::Tetrahedra& solids) {
  const Index ball_body = place_of(w.spheres->given->sets, bond.spheres,
                                   [](const dem::ElementSet& set) { return set.name; });
  const Index body = place_of(w.tetrahedra->given->groups, bond.tetrahedra,
                              [](const std::string& name) { return name; });
  std::vector<Index> members;
  for (Index e = 0; e < elements.size(); ++e)
    if (elements.group.data()[e] == ball_body) members.push_back(e);
  const std::vector<BorderFace> border = border_of(solids, body);
  std::vector<BallBond> ties;
  std::set<Index> tied_faces;
  double area = 0.0, sections = 0.0;
  std::vector<Vec3> points;  // of the present sphere
  std::size_t first = 0;     // its bonds
  const auto share_section = [&] {
    if (ties.size() == first) return;
    const double radius = elements.state.data()[ties[first].sphere].radius;
    sections += radius * radius;
    for (std::size_t i = first; i < ties.size(); ++i)
      ties[i].area = radius * radius / static_cast<double>(ties.size() - first);
    first = ties.size();
    points.clear();
  };
  for (const auto& [place, face] :
       near_pairs(elements, w.spheres->exec.threads, members, border, bond.range)) {
    const Index e = members[at(place)];
    if (ties.size() > first && ties.back().sphere != e) share_section();
    const dem::ElementState& s = elements.state.data()[e];
    const BorderFace& f = border[at(face)];
    dem::MeshTriangle triangle{};
    std::copy(std::begin(f.corner), std::end(f.corner), std::begin(triangle.corner));
    const Vec3 point = dem::mesh_detail::nearest(triangle, s.position).place;
    const double away = norm(point - s.position);
    if (!(away <= bond.range * s.radius) || !(away > 0.1 * s.radius)) continue;
    if (tied_faces.insert(f.face).second) area += f.area;
    const bool known = std::any_of(points.begin(), points.end(), [&](const Vec3& p) {
      return norm(p - point) < 1e-6 * s.radius;
    });
    if (known) continue;
    points.push_back(point);
    ties.push_back(bond_at(solids, s, f, point));
    ties.back().sphere = e;
    ties.back().law = law;
  }
  share_section();
  if (ties.empty())
    throw InputError(fmt::format(
        "bond.{}: no sphere of {} has a point of the surface of {} within {} radii of its centre; "
        "move one of the bodies, or enlarge bond.{}.range",
        bond.name, bond.spheres, bond.tetrahedra, bond.range, bond.name));
  for (BallBond& b : ties) b.area *= area / sections;
  return ties;
}

}  // namespace breccia::coupled
