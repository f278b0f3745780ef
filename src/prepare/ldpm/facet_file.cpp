#include "prepare/ldpm/facet_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exec/error.hpp"
#include "prepare/ldpm/rows.hpp"

namespace breccia::prepare {
namespace {

constexpr double alike = 1e-3;  ///< of directions and places that files hold with ten digits  [-]

std::vector<Vec3> read_corners(const std::string& path) {
  std::vector<Vec3> corners;
  read_rows(path, "x y z, a corner of a facet, in mm",
            [&](const std::vector<double>& v, std::size_t) {
              if (v.size() != 3) return false;
              corners.push_back(millimetre * Vec3{v[0], v[1], v[2]});
              return true;
            });
  return corners;
}

/// The edges of a tetrahedron, each with the other two corners.
class Edges {
 public:
  Edges(const std::vector<Vec3>& position, const Tetrahedron& t) : position_(position), t_(t) {}

  /// The facet on the edge for which `misfit` is least. @returns the misfit there
  template <class Misfit>
  double find(const Misfit& misfit, LdpmFacet& facet) const {
    double least = 1e300;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Vec3 along = position_[at(t_[j])] - position_[at(t_[i])];
        const double length = norm(along);
        const double found = misfit(position_[at(t_[i])], (1.0 / length) * along, length);
        if (!(found < least)) continue;
        least = found;
        const std::size_t k = i != 0 ? 0 : j != 1 ? 1 : 2;
        facet.a = t_[i], facet.b = t_[j];
        facet.c = t_[k], facet.d = t_[6 - i - j - k];
      }
    return least;
  }

 private:
  const std::vector<Vec3>& position_;
  const Tetrahedron& t_;
};

double projected_area(const LdpmFacet& f, const std::vector<Vec3>& x) {
  const Vec3 along = x[at(f.b)] - x[at(f.a)];
  const Vec3 twice = cross(f.corners[1] - f.corners[0], f.corners[2] - f.corners[0]);
  return 0.5 * std::abs(dot(twice, along)) / norm(along);
}
double volume_between(const LdpmFacet& f, const std::vector<Vec3>& x) {
  double six = 0.0;
  for (const Index particle : {f.a, f.b})
    six += std::abs(six_volumes(x[at(particle)], f.corners[0], f.corners[1], f.corners[2]));
  return six / 6.0;
}

/// A whole number of [0, count).
bool is_index(double value, std::size_t count) {
  return value >= 0.0 && value < static_cast<double>(count) && value == std::floor(value);
}

class FacetRows {
 public:
  FacetRows(const std::string& path, const std::vector<Vec3>& position,
            const std::vector<Tetrahedron>& tetrahedra, const std::vector<Vec3>& corners)
      : path_(path), position_(position), tetrahedra_(tetrahedra), corners_(corners) {}

  /// A row as the file has it: its numbers are the facet's.
  LdpmFacet facet(const std::vector<double>& v, std::size_t line) {
    const auto metres = [&](std::size_t k, double unit) {
      return unit * Vec3{v[k], v[k + 1], v[k + 2]};
    };
    LdpmFacet f{};
    const Vec3 normal = metres(9, 1.0);
    const auto& t = tetrahedra_[static_cast<std::size_t>(v[0])];
    const double misfit =
        Edges(position_, t)
            .find([&](const Vec3&, const Vec3& along,
                      double) { return std::min(norm(normal - along), norm(normal + along)); },
                  f);
    if (!(misfit < alike))
      refuse(line, "the unit vector along its edge is along no edge of tetrahedron {:.0f}", v[0]);
    for (std::size_t k = 0; k < 3; ++k) f.corners[k] = corners_[static_cast<std::size_t>(v[1 + k])];
    f.area = millimetre * millimetre * v[5];
    f.center = metres(6, millimetre);
    const double volume = 1e-9 * v[4], between = volume_between(f, position_);
    const double whole = std::abs(six_volumes(position_[at(t[0])], position_[at(t[1])],
                                              position_[at(t[2])], position_[at(t[3])])) /
                         6.0;
    if (!(std::abs(volume - between) < alike * whole))
      refuse(line, "its volume of {:.6g} mm3 is not the {:.6g} mm3 of its corners", v[4],
             1e9 * between);
    const double side = norm(position_[at(f.b)] - position_[at(f.a)]);
    const double area = projected_area(f, position_);
    if (!(std::abs(f.area - area) < alike * side * side))
      refuse(line, "its projected area of {:.6g} mm2 is not the {:.6g} mm2 of its corners", v[5],
             1e6 * area);
    check_flag(v[18], line);
    return f;
  }

  /// The facet of corners (inner, face, edge point; or inner, edge, face point) of a tetrahedron.
  LdpmFacet facet_of_corners(std::size_t tetrahedron, std::size_t first) {
    LdpmFacet f{};
    for (std::size_t k = 0; k < 3; ++k) f.corners[k] = corners_[first + k];
    const double misfit =
        Edges(position_, tetrahedra_[tetrahedron])
            .find(
                [&](const Vec3& from, const Vec3& along, double length) {
                  double least = 1e300;
                  for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
                    least = std::min(least, norm(cross(f.corners[k] - from, along)) / length);
                  return least;
                },
                f);
    if (!(misfit < alike))
      throw InputError(
          fmt::format("{}: corners {} to {} lie on no edge of tetrahedron {}, whose facet they are "
                      "by their place",
                      path_, first, first + 2, tetrahedron));
    f.center = (1.0 / 3.0) * (f.corners[0] + f.corners[1] + f.corners[2]);
    f.area = projected_area(f, position_);
    return f;
  }

 private:
  template <class... Arguments>
  [[noreturn]] void refuse(std::size_t line, const char* text, const Arguments&... values) const {
    throw InputError(
        fmt::format("{}, line {}: {}", path_, line, fmt::format(fmt::runtime(text), values...)));
  }
  void check_flag(double flag, std::size_t line) {
    if (flag_ < 0.0) flag_ = flag;
    if (flag != flag_)
      refuse(line, "flag of material {:g} after {:g}: all facets of a body are of one material",
             flag, flag_);
  }

  std::string path_;
  const std::vector<Vec3>& position_;
  const std::vector<Tetrahedron>& tetrahedra_;
  const std::vector<Vec3>& corners_;
  double flag_ = -1.0;  ///< of the first facet
};

/// Facets of each tetrahedron that is not flat, by the file that describes them.
std::vector<LdpmFacet> described_facets(const std::string& path, const std::vector<Vec3>& position,
                                        const std::vector<Tetrahedron>& tetrahedra,
                                        const std::vector<Vec3>& corners,
                                        const std::vector<bool>& flat) {
  FacetRows rows(path, position, tetrahedra, corners);
  std::vector<int> count(tetrahedra.size(), 0);
  std::vector<LdpmFacet> facets;
  read_rows(path,
            fmt::format("a facet: one of {} tetrahedra, three of {} corners, volume, area, "
                        "centroid, three unit vectors, flag (19 numbers, in mm)",
                        tetrahedra.size(), corners.size()),
            [&](const std::vector<double>& v, std::size_t line) {
              if (v.size() != 19 || !is_index(v[0], tetrahedra.size())) return false;
              for (std::size_t k = 1; k < 4; ++k)
                if (!is_index(v[k], corners.size())) return false;
              if (v[4] < 0.0 || v[5] < 0.0 || v[18] < 0.0) return false;
              const auto t = static_cast<std::size_t>(v[0]);
              ++count[t];
              if (!flat[t]) facets.push_back(rows.facet(v, line));
              return true;
            });
  for (std::size_t t = 0; t < count.size(); ++t)
    if (count[t] != 12)
      throw InputError(
          fmt::format("{}: tetrahedron {} has {} facets instead of 12", path, t, count[t]));
  return facets;
}

}  // namespace

std::vector<LdpmFacet> read_ldpm_facets(const std::string& name, bool described,
                                        const std::vector<Vec3>& position,
                                        const std::vector<Tetrahedron>& tetrahedra,
                                        const std::vector<bool>& flat) {
  const std::string path = name + "-data-facetsVertices.dat";
  const std::vector<Vec3> corners = read_corners(path);
  std::vector<LdpmFacet> facets;
  if (described) {
    facets = described_facets(name + "-data-facets.dat", position, tetrahedra, corners, flat);
  } else {
    if (corners.size() != 36 * tetrahedra.size())
      throw InputError(
          fmt::format("{} holds {} corners of facets instead of 36 for each of {} "
                      "tetrahedra",
                      path, corners.size(), tetrahedra.size()));
    FacetRows rows(path, position, tetrahedra, corners);
    for (std::size_t t = 0; t < tetrahedra.size(); ++t)
      for (std::size_t k = 0; k < 12 && !flat[t]; ++k)
        facets.push_back(rows.facet_of_corners(t, 36 * t + 3 * k));
  }
  std::stable_sort(facets.begin(), facets.end(), [](const LdpmFacet& p, const LdpmFacet& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
  return facets;
}

}  // namespace breccia::prepare
