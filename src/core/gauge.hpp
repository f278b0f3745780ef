#pragma once
// Means of probes of regions: a box in space, a point, where things stood, the best linear
// displacement.

#include <string>
#include <vector>

#include "core/keys.hpp"
#include "exec/types.hpp"
#include "math/vec.hpp"

namespace breccia {

/// A box that stands still; without limits by default.
struct ReadBox {
  Vec3 min{-no_limit, -no_limit, -no_limit}, max{no_limit, no_limit, no_limit};  ///<  [m]

  ReadBox() = default;
  /// @param low, high  two or three coordinates each; empty: no limits
  ReadBox(const std::vector<double>& low, const std::vector<double>& high) {
    const auto take = [](const std::vector<double>& from, Vec3& to) {
      if (from.size() > 0) to.x = from[0];
      if (from.size() > 1) to.y = from[1];
      if (from.size() > 2) to.z = from[2];
    };
    take(low, min);
    take(high, max);
  }
  BR_HD bool holds(const Vec3& x) const {
    return x.x >= min.x && x.y >= min.y && x.z >= min.z && x.x <= max.x && x.y <= max.y &&
           x.z <= max.z;
  }
  double volume() const {
    const Vec3 size = max - min;
    return size.x * size.y * size.z;
  }
  /// Share of the straight way from p to q that lies inside.  [-]
  BR_HD double share(const Vec3& p, const Vec3& q) const {
    double begin = 0.0, end = 1.0;
    clip(p.x, q.x, min.x, max.x, begin, end);
    clip(p.y, q.y, min.y, max.y, begin, end);
    clip(p.z, q.z, min.z, max.z, begin, end);
    return end > begin ? end - begin : 0.0;
  }

 private:
  BR_HD static void clip(double p, double q, double low, double high, double& begin, double& end) {
    const double way = q - p;
    if (way == 0.0) {
      if (p < low || p >= high) end = 0.0;
      return;
    }
    const double at_low = (low - p) / way, at_high = (high - p) / way;
    const double in = at_low < at_high ? at_low : at_high;
    const double out = at_low < at_high ? at_high : at_low;
    if (in > begin) begin = in;
    if (out < end) end = out;
  }
};

inline Vec3 point_of(const std::vector<double>& about) {
  const ReadBox at(about, {});
  return about.empty() ? Vec3{} : Vec3{at.min.x, at.min.y, about.size() > 2 ? at.min.z : 0.0};
}

/// Component of a vector.
BR_HD inline double on_axis(const Vec3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// The linear displacement field that fits those of a set of points best (least squares): its
/// strain is the mean of one term a point.
struct StrainFit {
  Vec3 centre{};      ///< of the points at the start  [m]
  Vec3 inverse[3]{};  ///< rows of the inverse of their mean (X - centre) (X - centre)^T  [1/m2]

  /// Share of a point in strain (i, j), before the mean over all points.  [-]
  BR_HD double term(const Vec3& start, const Vec3& displacement, int i, int j) const {
    const Vec3 from = start - centre;
    const Vec3 weight{dot(inverse[0], from), dot(inverse[1], from), dot(inverse[2], from)};
    return 0.5 * (on_axis(displacement, i) * on_axis(weight, j) +
                  on_axis(displacement, j) * on_axis(weight, i));
  }
};

struct ProbeFit {
  std::string probe;
  StrainFit fit;
};

/// @param points  at the start, in an order that follows from the model alone
/// @param axes    2: they lie in the plane z = 0
/// @param fits    false: they are too few, or lie in a plane (on a line) and show no strain
inline StrainFit strain_fit(const std::vector<Vec3>& points, int axes, bool& fits) {
  StrainFit fit;
  const double over_count = points.empty() ? 0.0 : 1.0 / static_cast<double>(points.size());
  for (const Vec3& x : points) fit.centre += over_count * x;
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
  for (const Vec3& x : points) {
    const Vec3 d = x - fit.centre;
    xx += over_count * d.x * d.x;
    yy += over_count * d.y * d.y;
    zz += over_count * d.z * d.z;
    xy += over_count * d.x * d.y;
    xz += over_count * d.x * d.z;
    yz += over_count * d.y * d.z;
  }
  const double most = xx > yy ? (xx > zz ? xx : zz) : (yy > zz ? yy : zz);
  if (axes == 2) zz = most;
  const Vec3 a{xx, xy, xz}, b{xy, yy, yz}, c{xz, yz, zz};
  const Vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double size = dot(a, bc);
  fits = size > 1e-12 * most * most * most;
  if (!fits) return fit;
  const double over = 1.0 / size;
  fit.inverse[0] = over * bc;  // the matrix is symmetric, so is its inverse
  fit.inverse[1] = over * ca;
  fit.inverse[2] = over * ab;
  return fit;
}

}  // namespace breccia
