#pragma once
// Surfaces of triangles made in code.

#include <vector>

#include "math/vec.hpp"

namespace breccia::dem::testing {

using Corners = std::vector<Vec3>;  ///< three of each triangle

/// Two triangles with these corners, anticlockwise.
inline Corners quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {a, b, c, a, c, d};
}

/// A patch of n by n squares.
inline void add_patch(Corners& to, const Vec3& from, const Vec3& u, const Vec3& v, int n) {
  const auto at = [&](int i, int j) {
    return from + (static_cast<double>(i) / n) * u + (static_cast<double>(j) / n) * v;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (const Vec3& c : quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
        to.push_back(c);
}

/// In the plane z = 0, normals up, from -size to size.
inline Corners floor_mesh(double size, int n) {
  Corners all;
  add_patch(all, {-size, -size, 0.0}, {2.0 * size, 0.0, 0.0}, {0.0, 2.0 * size, 0.0}, n);
  return all;
}

/// A box, its faces divided n by n so that edges of neighbours meet to the bit.
inline Corners box_mesh(const Vec3& low, const Vec3& high, int n) {
  const auto at = [&](int i, int j, int k) {
    const auto part = [n](double from, double to, int s) {
      return s == n ? to : from + (to - from) * s / n;
    };
    return Vec3{part(low.x, high.x, i), part(low.y, high.y, j), part(low.z, high.z, k)};
  };
  Corners all;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    for (const Vec3& corner : quad(a, b, c, d)) all.push_back(corner);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      add(at(i, j, n), at(i + 1, j, n), at(i + 1, j + 1, n), at(i, j + 1, n));
      add(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      add(at(n, i, j), at(n, i + 1, j), at(n, i + 1, j + 1), at(n, i, j + 1));
      add(at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j));
      add(at(j, n, i), at(j, n, i + 1), at(j + 1, n, i + 1), at(j + 1, n, i));
      add(at(j, 0, i), at(j + 1, 0, i), at(j + 1, 0, i + 1), at(j, 0, i + 1));
    }
  return all;
}

/// A square sheet with a square hole, in the plane z = 0, normals up.
inline Corners frame_mesh(double hole, double size) {
  const Vec3 in[4] = {
      {-hole, -hole, 0.0}, {hole, -hole, 0.0}, {hole, hole, 0.0}, {-hole, hole, 0.0}};
  const Vec3 out[4] = {
      {-size, -size, 0.0}, {size, -size, 0.0}, {size, size, 0.0}, {-size, size, 0.0}};
  Corners all;
  for (int k = 0; k < 4; ++k)
    for (const Vec3& c : quad(out[k], out[(k + 1) % 4], in[(k + 1) % 4], in[k])) all.push_back(c);
  return all;
}

}  // namespace breccia::dem::testing
