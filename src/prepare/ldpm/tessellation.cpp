#include "prepare/ldpm/tessellation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <tuple>

#include "exec/error.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace breccia::prepare {
namespace {

/// In the middle of the mortar between a point and the sphere of a particle.
Vec3 mid_mortar(const Vec3& point, const Vec3& particle, double radius) {
  const Vec3 to = particle - point;
  const double h = norm(to);
  return point + (0.5 * (h - radius) / h) * to;
}

/// Points of one tetrahedron; corners are counted from 0 to 3.
class Points {
 public:
  Points(const std::vector<Vec3>& x, const std::vector<double>& diameter, const Tetrahedron& t) {
    for (std::size_t k = 0; k < 4; ++k) {
      x_[k] = x[at(t[k])];
      radius_[k] = 0.5 * diameter[at(t[k])];
    }
    for (std::size_t f = 0; f < 4; ++f) face_[f] = on_face(f);
    for (std::size_t v = 0; v < 4; ++v) inner_ += mid_mortar(face_[v], x_[v], radius_[v]);
    inner_ = 0.25 * inner_;
  }
  Vec3 edge(std::size_t i, std::size_t j) const {
    const Vec3 along = x_[j] - x_[i];
    const double length = norm(along);
    return x_[i] + ((radius_[i] + 0.5 * (length - radius_[i] - radius_[j])) / length) * along;
  }
  const Vec3& face(std::size_t opposite) const { return face_[opposite]; }
  const Vec3& inner() const { return inner_; }

 private:
  Vec3 on_face(std::size_t opposite) const {
    Vec3 sum{};
    for (std::size_t v = 0; v < 4; ++v) {
      if (v == opposite) continue;
      std::size_t others[2], found = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != v && k != opposite) others[found++] = k;
      sum += mid_mortar(edge(others[0], others[1]), x_[v], radius_[v]);
    }
    return (1.0 / 3.0) * sum;
  }
  Vec3 x_[4], face_[4], inner_{};
  double radius_[4];
};

/// Delaunay's triangulation by Qhull, for as long as it is needed.
class Triangulation {
 public:
  explicit Triangulation(std::vector<double>& coordinates) {
    qh_zero(&qhull_, nullptr);
    char* text = nullptr;
    std::size_t length = 0;
    std::FILE* const messages = open_memstream(&text, &length);
    // d: Delaunay, Qbb: scaled last coordinate, Qt: simplices where points lie on one sphere
    char command[] = "qhull d Qbb Qt";
    const int failed = qh_new_qhull(&qhull_, 3, static_cast<int>(coordinates.size() / 3),
                                    coordinates.data(), False, command, nullptr, messages);
    std::fclose(messages);
    const std::unique_ptr<char, decltype(&std::free)> kept(text, &std::free);
    if (failed == 0) return;
    const std::string said = text;
    clear();
    throw InputError("the particles have no Delaunay triangulation: " + said);
  }
  Triangulation(const Triangulation&) = delete;
  Triangulation& operator=(const Triangulation&) = delete;
  ~Triangulation() { clear(); }

  template <class Visit>
  void each_simplex(const Visit& visit) {
    qhT* const qh = &qhull_;
    facetT* facet = nullptr;
    vertexT *vertex = nullptr, **vertexp = nullptr;
    FORALLfacets {
      if (facet->upperdelaunay) continue;
      Tetrahedron t{};
      std::size_t k = 0;
      FOREACHvertex_(facet->vertices) t.at(k++) = qh_pointid(qh, vertex->point);
      visit(t);
    }
  }

 private:
  void clear() {
    qh_freeqhull(&qhull_, !qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(&qhull_, &current, &total);
  }
  qhT qhull_;
};

/// Six points far away, so that points on a plane face are not all on one facet of the hull, which
/// Qhull would take in the square of their number. Spheres around tetrahedra do not reach them.
void add_far_points(std::vector<double>& coordinates) {
  double low[3], high[3];
  for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = high[axis] = coordinates[axis];
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    low[k % 3] = std::min(low[k % 3], coordinates[k]);
    high[k % 3] = std::max(high[k % 3], coordinates[k]);
  }
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-300.0, 300.0})
      for (std::size_t k = 0; k < 3; ++k)
        coordinates.push_back(0.5 * (low[k] + high[k]) + (k == axis ? side * size : 0.0));
}

}  // namespace

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(b - a, cross(c - a, d - a));
}

std::vector<Tetrahedron> tetrahedra_of(const std::vector<Vec3>& points, double scale) {
  if (points.size() == 4) return {{0, 1, 2, 3}};
  std::vector<double> coordinates;
  for (const Vec3& p : points)
    for (const double x : {p.x, p.y, p.z}) coordinates.push_back(x / scale);
  add_far_points(coordinates);
  const auto count = static_cast<Index>(points.size());
  std::vector<Tetrahedron> tetrahedra;
  Triangulation(coordinates).each_simplex([&](Tetrahedron t) {
    std::sort(t.begin(), t.end());
    if (t[3] >= count) return;
    const double six =
        six_volumes(points[at(t[0])], points[at(t[1])], points[at(t[2])], points[at(t[3])]);
    if (std::abs(six) > 6e-9 * scale * scale * scale) tetrahedra.push_back(t);
  });
  std::sort(tetrahedra.begin(), tetrahedra.end());
  std::vector<bool> met(points.size(), false);
  for (const Tetrahedron& t : tetrahedra)
    for (const Index corner : t) met[at(corner)] = true;
  const auto lost = std::find(met.begin(), met.end(), false);
  if (lost != met.end()) {
    const Vec3& p = points[static_cast<std::size_t>(lost - met.begin())];
    throw InputError(
        fmt::format("the particle at ({:.4g}, {:.4g}, {:.4g}) m is the corner of no tetrahedron",
                    p.x, p.y, p.z));
  }
  return tetrahedra;
}

std::vector<LdpmFacet> facets_of(const std::vector<Vec3>& x, const std::vector<double>& diameter,
                                 const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<LdpmFacet> facets;
  facets.reserve(12 * tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra) {
    const Points points(x, diameter, t);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        std::size_t others[2], found = 0;
        for (std::size_t k = 0; k < 4; ++k)
          if (k != i && k != j) others[found++] = k;
        const Vec3 along = x[at(t[j])] - x[at(t[i])];
        for (const std::size_t opposite : others) {
          const std::array<Vec3, 3> corners{points.inner(), points.face(opposite),
                                            points.edge(i, j)};
          const Vec3 twice = cross(corners[1] - corners[0], corners[2] - corners[0]);
          facets.push_back({t[i], t[j], t[others[0]], t[others[1]], corners,
                            (1.0 / 3.0) * (corners[0] + corners[1] + corners[2]),
                            0.5 * std::abs(dot(twice, along)) / norm(along)});
        }
      }
  }
  std::stable_sort(facets.begin(), facets.end(), [](const LdpmFacet& p, const LdpmFacet& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
  return facets;
}

std::vector<LdpmCell> cells_of(const std::vector<Vec3>& x, const std::vector<LdpmFacet>& facets) {
  std::vector<LdpmCell> cells(x.size());
  for (const LdpmFacet& f : facets)
    for (const Index particle : {f.a, f.b}) {
      const Vec3& tip = x[at(particle)];
      const Vec3 r[3] = {f.corners[0] - tip, f.corners[1] - tip, f.corners[2] - tip};
      const double volume = std::abs(dot(r[0], cross(r[1], r[2]))) / 6.0;
      const Vec3 sum = r[0] + r[1] + r[2];
      const double trace =
          volume / 20.0 * (dot(r[0], r[0]) + dot(r[1], r[1]) + dot(r[2], r[2]) + dot(sum, sum));
      LdpmCell& cell = cells[at(particle)];
      cell.volume += volume;
      cell.inertia += 2.0 / 3.0 * trace;  // I = tr(C) 1 - C, a third of its trace
    }
  return cells;
}

}  // namespace breccia::prepare
