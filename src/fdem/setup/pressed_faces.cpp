#include "fdem/setup/pressed_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include "core/set_up.hpp"
#include "fdem/stepping/launches.hpp"

namespace breccia::fdem {
namespace {

struct Side {
  Index edge;
  Vec2 from, to;
  double left, right;  ///< least and largest x  [m]
};

struct Given {
  std::vector<TriangleNodes> nodes;
  std::vector<Index> material;
  std::vector<EdgeJoints> edges;
  std::vector<ContactPair> contacts;

  explicit Given(const World& w) {
    copy_to(nodes, w.triangles.nodes);
    copy_to(material, w.triangles.material);
    copy_to(edges, w.edges);
    copy_to(contacts, w.given->contact_pairs);
  }
  Vec2 corner(Index t, Index k) const { return nodes[at(t)].at[k % 3].position; }
  const ContactPair& contact(Index t, Index u) const {
    const auto materials = static_cast<Index>(std::lround(std::sqrt(contacts.size())));
    return contacts[at(material[at(t)] * materials + material[at(u)])];
  }
  /// Height of a triangle above one of its edges.  [m]
  double height(Index edge) const {
    const Index t = edge / 3, k = edge % 3;
    const Vec2 along = corner(t, k + 1) - corner(t, k);
    return cross(along, corner(t, k + 2) - corner(t, k)) / norm(along);
  }
};

std::vector<Side> exposed_sides(const Given& given) {
  std::vector<Side> sides;
  for (std::size_t t = 0; t < given.edges.size(); ++t)
    for (Index k = 0; k < 3; ++k) {
      if (given.edges[t].at[k] != edge_free) continue;
      const auto triangle = static_cast<Index>(t);
      const Vec2 from = given.corner(triangle, k), to = given.corner(triangle, k + 1);
      sides.push_back({3 * triangle + k, from, to, std::min(from.x, to.x), std::max(from.x, to.x)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.left != b.left ? a.left < b.left : a.edge < b.edge;
  });
  return sides;
}

/// The length over which two edges lie on each other, face to face; 0: they do not.  [m]
double common_length(const Side& a, const Side& b) {
  constexpr double close = 1e-6;  // over the edge
  const Vec2 line = a.to - a.from;
  const double size = norm(line);
  const Vec2 along = (1.0 / size) * line;
  if (std::abs(cross(along, b.from - a.from)) > close * size ||
      std::abs(cross(along, b.to - a.from)) > close * size)
    return 0.0;
  const double begin = dot(b.to - a.from, along), end = dot(b.from - a.from, along);
  const double length = std::min(end, size) - std::max(begin, 0.0);
  return length > 1e-3 * std::min(size, norm(b.to - b.from)) ? length : 0.0;
}

/// Shifts of triangles by which each of its faces goes into what lies on it.
class Shifts {
 public:
  void ask(Index edge, double way) {
    double& asked = ways_[edge / 3][at(edge % 3)];
    asked = std::max(asked, way);
  }
  /// @returns none where all three faces are asked for
  std::optional<Vec2> of(const Given& given, Index t) const {
    const auto found = ways_.find(t);
    if (found == ways_.end()) return Vec2{};
    std::array<Vec2, 3> normal;
    std::vector<std::size_t> asked;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = static_cast<Index>(k);
      const Vec2 along = given.corner(t, corner + 1) - given.corner(t, corner);
      normal[k] = (1.0 / norm(along)) * Vec2{along.y, -along.x};
      if (found->second[k] > 0.0) asked.push_back(k);
    }
    if (asked.size() > 2) return std::nullopt;
    const Vec2 &n = normal[asked[0]], &m = normal[asked.back()];
    const double p = found->second[asked[0]], q = found->second[asked.back()];
    if (asked.size() == 1) return p * n;
    return (1.0 / cross(n, m)) * Vec2{p * m.y - q * n.y, q * n.x - p * m.x};
  }
  std::vector<Index> triangles() const {
    std::vector<Index> all;
    for (const auto& [t, ways] : ways_) all.push_back(t);
    return all;
  }

 private:
  std::map<Index, std::array<double, 3>> ways_;
};

/// Joints keep their tractions where the triangles beside them have moved apart by a constant.
void tell_joints(World& w, const Given& given, const std::map<Index, Vec2>& shift) {
  std::vector<Index> edge_a, edge_b;
  std::vector<Vec2> preset;
  copy_to(edge_a, w.joints.edge_a);
  copy_to(edge_b, w.joints.edge_b);
  copy_to(preset, w.joints.preset);
  const auto of = [&](Index edge) {
    const auto found = shift.find(edge / 3);
    return found == shift.end() ? Vec2{} : found->second;
  };
  for (std::size_t i = 0; i < preset.size(); ++i) {
    const Vec2 apart = of(edge_a[i]) - of(edge_b[i]);
    if (apart.x == 0.0 && apart.y == 0.0) continue;
    const Vec2 line =
        given.corner(edge_a[i] / 3, edge_a[i] % 3 + 1) - given.corner(edge_a[i] / 3, edge_a[i] % 3);
    const Vec2 along = (1.0 / norm(line)) * line, across{-along.y, along.x};
    preset[i] -= Vec2{dot(apart, across), dot(apart, along)};
  }
  copy_to(w.joints.preset, preset);
}

void warn(World& w, const Given& given, const std::vector<Index>& unable) {
  if (unable.empty()) return;
  const Index edge = unable.front();
  const Vec2 place =
      0.5 * (given.corner(edge / 3, edge % 3) + given.corner(edge / 3, edge % 3 + 1));
  char text[400];
  std::snprintf(text, sizeof text,
                "%zu pairs of faces, as that at (%.6g, %.6g) m, cannot bear the stress in situ: it "
                "pulls at them, or rubs more than their friction holds; they start unloaded, and "
                "what they hold moves at once",
                unable.size(), place.x, place.y);
  w.given.change(SetUp{}).warnings.emplace_back(text);
}

}  // namespace

std::vector<PressedFace> press_faces(World& w) {
  const InSituConfig& in_situ = w.given->in_situ;
  if (!in_situ.any()) return {};
  Given given(w);
  constexpr double any = std::numeric_limits<double>::infinity();
  std::vector<PressedFace> faces;
  std::vector<Index> unable;
  Shifts shifts;
  const std::vector<Side> sides = exposed_sides(given);
  double widest = 0.0;
  for (const Side& s : sides) widest = std::max(widest, s.right - s.left);
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      if (sides[j].left > sides[i].right + 1e-6 * widest) break;
      const bool in_order = sides[i].edge < sides[j].edge;
      const Side &a = in_order ? sides[i] : sides[j], &b = in_order ? sides[j] : sides[i];
      if (a.edge / 3 == b.edge / 3) continue;
      const double length = common_length(a, b);
      if (!(length > 0.0)) continue;
      const Vec2 line = a.to - a.from, along = (1.0 / norm(line)) * line;
      const Vec2 outward{along.y, -along.x}, middle = 0.5 * (a.from + a.to);
      const Vec2 traction = in_situ.at(middle) * outward;
      const double normal = dot(traction, outward), shear = dot(traction, along);
      const ContactPair& law = given.contact(a.edge / 3, b.edge / 3);
      if (normal == 0.0 && shear == 0.0) continue;
      if (!(normal < 0.0) || std::abs(shear) > -law.friction * normal) {
        unable.push_back(a.edge);
        continue;
      }
      // Faces press with 3 p d (1/H_a + 1/H_b).
      const double overlap =
          -normal / (3.0 * law.penalty * (1.0 / given.height(a.edge) + 1.0 / given.height(b.edge)));
      shifts.ask(a.edge, 0.5 * overlap);
      shifts.ask(b.edge, 0.5 * overlap);
      faces.push_back({a.edge, b.edge, {-normal * length, shear * length, {any, any}}});
    }
  std::map<Index, Vec2> shift;
  for (const Index t : shifts.triangles()) {
    if (const std::optional<Vec2> way = shifts.of(given, t))
      shift[t] = *way;
    else
      unable.push_back(3 * t);
  }
  tell_joints(w, given, shift);
  for (const auto& [t, way] : shift)
    for (NodeState& n : given.nodes[at(t)].at) n.position += way;
  copy_to(w.triangles.nodes, given.nodes);
  warn(w, given, unable);
  return faces;
}

void load_faces(World& w, const std::vector<PressedFace>& faces) {
  if (faces.empty()) return;
  const Given given(w);
  std::vector<Index> a, b;
  std::vector<CoupleState> state;
  copy_to(a, w.couples.pairs.a);
  copy_to(b, w.couples.pairs.b);
  copy_to(state, w.couples.history.state);
  std::map<std::pair<Index, Index>, std::size_t> couple;
  for (std::size_t i = 0; i < a.size(); ++i) couple[{a[i], b[i]}] = i;
  for (const PressedFace& face : faces) {
    const auto found = couple.find({face.edge_a / 3, face.edge_b / 3});
    if (found == couple.end()) continue;
    Vec2 xa[3], va[3], xb[3], vb[3];
    split(given.nodes[at(face.edge_a / 3)], xa, va);
    split(given.nodes[at(face.edge_b / 3)], xb, vb);
    const int edges[2] = {face.edge_a % 3, face.edge_b % 3};
    CoupleForces<double>::begin_pressed(
        face.bears, edges, given.contact(face.edge_a / 3, face.edge_b / 3), state[found->second],
        xa, Target::of(xa), xb, Target::of(xb));
  }
  copy_to(w.couples.history.state, state);
}

}  // namespace breccia::fdem
