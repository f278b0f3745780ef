#include "prepare/meshing/structured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/meshing/mesh_check.hpp"

namespace breccia::prepare {
namespace {

const double half_root3 = 0.5 * std::sqrt(3.0);  ///< height of an equilateral triangle of edge 1

Index at_least_one(double number) {
  return static_cast<Index>(std::max(1.0, std::round(number)));
}

Vec2 corner_of(const Rectangle& r) {
  return r.center - 0.5 * r.size;
}

}  // namespace

Mesh equilateral_rectangle(const Rectangle& r, double edge) {
  const Index columns = at_least_one(r.size.x / edge);
  const Index rows = at_least_one(r.size.y / (half_root3 * edge));
  const Vec2 corner = corner_of(r);
  const double step = r.size.x / columns;
  Mesh mesh;
  // Even rows have a vertex every step; odd rows are shifted by half a step and closed at the
  // sides.
  std::vector<Index> first;
  for (Index j = 0; j <= rows; ++j) {
    first.push_back(static_cast<Index>(mesh.point.size()));
    const double y = corner.y + r.size.y * j / rows;
    const bool shifted = j % 2 == 1;
    for (Index i = 0; i <= columns + (shifted ? 1 : 0); ++i) {
      const double along = shifted ? std::clamp(i - 0.5, 0.0, static_cast<double>(columns)) : i;
      mesh.point.push_back({corner.x + step * along, y});
    }
  }
  for (Index j = 0; j < rows; ++j) {
    const bool shifted = j % 2 == 1;
    const Index even = first[static_cast<std::size_t>(shifted ? j + 1 : j)];
    const Index odd = first[static_cast<std::size_t>(shifted ? j : j + 1)];
    const auto add = [&](Index a, Index b, Index c) {  // counter-clockwise if the even row is below
      mesh.triangle.push_back(shifted ? Triangle{a, c, b} : Triangle{a, b, c});
    };
    for (Index i = 0; i <= columns; ++i) {
      add(even + i, odd + i + 1, odd + i);
      if (i < columns) add(even + i, even + i + 1, odd + i + 1);
    }
  }
  return mesh;
}

Mesh crossed_rectangle(const Rectangle& r, double edge) {
  const Index columns = at_least_one(r.size.x / edge), rows = at_least_one(r.size.y / edge);
  const Vec2 corner = corner_of(r);
  const auto place = [&](double i, double j) {
    return Vec2{corner.x + r.size.x * i / columns, corner.y + r.size.y * j / rows};
  };
  Mesh mesh;
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i <= columns; ++i) mesh.point.push_back(place(i, j));
  const Index centres = static_cast<Index>(mesh.point.size());
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i) {
      mesh.point.push_back(place(i + 0.5, j + 0.5));
      const Index a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      const Index m = centres + j * columns + i;
      for (const Triangle& t :
           {Triangle{a, b, m}, Triangle{b, c, m}, Triangle{c, d, m}, Triangle{d, a, m}})
        mesh.triangle.push_back(t);
    }
  return mesh;
}

Mesh ringed_disc(const Vec2& center, double radius, double edge) {
  const Index rings = at_least_one(radius / edge);
  Mesh mesh;
  mesh.point.push_back(center);
  for (Index k = 1; k <= rings; ++k) {
    const double r = radius * k / rings;
    for (Index j = 0; j < 6 * k; ++j) {
      const double angle = 2.0 * pi * j / (6 * k);
      mesh.point.push_back({center.x + r * std::cos(angle), center.y + r * std::sin(angle)});
    }
    const auto outer = [&](Index j) { return 1 + 3 * k * (k - 1) + j % (6 * k); };
    const auto inner = [&](Index j) {
      return k == 1 ? 0 : 1 + 3 * (k - 1) * (k - 2) + j % (6 * (k - 1));
    };
    for (Index sector = 0; sector < 6; ++sector)
      for (Index i = 0; i < k; ++i) {
        const Index out = sector * k + i, in = sector * (k - 1) + i;
        mesh.triangle.push_back({inner(in), outer(out), outer(out + 1)});
        if (i + 1 < k) mesh.triangle.push_back({inner(in), outer(out + 1), inner(in + 1)});
      }
  }
  return mesh;
}

namespace {

/// Columns and the distance of neighbours on a lattice of staggered rows.
struct Lattice {
  Index columns;
  double pitch;  ///<  [m]
};

/// The lattice of the largest pitch whose `count` hexagons fit into a rectangle.
Lattice widest_lattice(const HexagonField& field) {
  const double across = 2.0 * half_root3 * field.side, high = 2.0 * field.side;
  Lattice best{1, 0.0};
  for (Index columns = 1; columns <= field.count; ++columns) {
    const Index rows = (field.count + columns - 1) / columns;
    const double steps = columns - 1 + (rows > 1 ? 0.5 : 0.0);
    const double wide = field.size.x - across, tall = field.size.y - high;
    if (wide < 0.0 || tall < 0.0) break;
    double pitch = 1e300;
    if (steps > 0.0) pitch = wide / steps;
    if (rows > 1) pitch = std::min(pitch, tall / ((rows - 1) * half_root3));
    if (pitch > best.pitch) best = {columns, pitch};
  }
  return best;
}

}  // namespace

Mesh hexagons(const HexagonField& field) {
  const double across = 2.0 * half_root3 * field.side;
  const bool fills = field.size.x > 0.0 && field.size.y > 0.0;
  Lattice lattice{at_least_one(std::ceil(std::sqrt(static_cast<double>(field.count)))),
                  across + field.gap};
  if (fills) lattice = widest_lattice(field);
  if (!(lattice.pitch >= (across + field.gap) * (1.0 - 1e-12)))
    throw InputError(fmt::format(
        "{} hexagons of side {:.4g} m, {:.4g} m apart, do not fit into {:.4g} x {:.4g} m",
        field.count, field.side, field.gap, field.size.x, field.size.y));
  if (field.count == 1) lattice.pitch = across;
  const Index rows = (field.count + lattice.columns - 1) / lattice.columns;
  const Vec2 first =
      field.center - Vec2{0.5 * (lattice.columns - 1 + (rows > 1 ? 0.5 : 0.0)) * lattice.pitch,
                          0.5 * (rows - 1) * half_root3 * lattice.pitch};
  // Two neighbours come closer by two moves at most; the gap is kept.
  const double move =
      std::min(field.jitter * (lattice.pitch - across), 0.5 * (lattice.pitch - across - field.gap));
  Mesh mesh;
  mesh.point.reserve(7 * static_cast<std::size_t>(field.count));
  mesh.triangle.reserve(6 * static_cast<std::size_t>(field.count));
  for (Index h = 0; h < field.count; ++h) {
    const Index row = h / lattice.columns, column = h % lattice.columns;
    Vec2 centre = first + Vec2{(column + (row % 2 == 1 ? 0.5 : 0.0)) * lattice.pitch,
                               row * half_root3 * lattice.pitch};
    if (move > 0.0) {
      const double angle = 2.0 * pi * field.random.uniform(static_cast<std::uint64_t>(h), 0);
      const double far = move * std::sqrt(field.random.uniform(static_cast<std::uint64_t>(h), 1));
      centre += Vec2{far * std::cos(angle), far * std::sin(angle)};
    }
    const Index base = 7 * h;
    mesh.point.push_back(centre);
    for (Index k = 0; k < 6; ++k) {
      const double angle =
          pi * (2 * k + 1) / 6.0;  // a corner points up: flat sides face along a row
      mesh.point.push_back(centre +
                           Vec2{field.side * std::cos(angle), field.side * std::sin(angle)});
      mesh.triangle.push_back({base, base + 1 + k, base + 1 + (k + 1) % 6});
    }
  }
  return mesh;
}

void jitter(Mesh& mesh, double share, const Random& random, const std::vector<bool>& fixed) {
  if (share <= 0.0) return;
  std::vector<bool> stays = fixed;
  stays.resize(mesh.point.size());
  std::vector<double> shortest(mesh.point.size(), 1e300);
  for (const MeshEdge& edge : edges_of(mesh.triangle))
    for (const Index v : edge.ends) {
      const auto i = static_cast<std::size_t>(v);
      const double length = norm(at(mesh.point, edge.ends[0]) - at(mesh.point, edge.ends[1]));
      shortest[i] = std::min(shortest[i], length);
      if (edge.triangles[1] < 0) stays[i] = true;
    }
  std::vector<std::vector<Index>> around(mesh.point.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const Index v : mesh.triangle[t])
      around[static_cast<std::size_t>(v)].push_back(static_cast<Index>(t));

  for (std::size_t i = 0; i < mesh.point.size(); ++i) {
    if (stays[i]) continue;
    const double angle = 2.0 * pi * random.uniform(i, 0);
    double far = share * shortest[i] * std::sqrt(random.uniform(i, 1));
    const Vec2 before = mesh.point[i];
    std::vector<double> area;
    for (const Index t : around[i])
      area.push_back(signed_area(mesh.point, mesh.triangle[static_cast<std::size_t>(t)]));
    const auto fits = [&] {
      for (std::size_t k = 0; k < area.size(); ++k)
        if (signed_area(mesh.point, mesh.triangle[static_cast<std::size_t>(around[i][k])]) <
            0.5 * area[k])
          return false;
      return true;
    };
    for (int halving = 0; halving < 4; ++halving, far *= 0.5) {
      mesh.point[i] = before + Vec2{far * std::cos(angle), far * std::sin(angle)};
      if (fits()) break;
      mesh.point[i] = before;
    }
  }
}

}  // namespace breccia::prepare
