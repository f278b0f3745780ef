#pragma once
// Shear action of a bar across a joint (dowel action). It knows no triangles.

#include <algorithm>

#include "math/vec2.hpp"

namespace breccia::fdem {

/// How far the two ends of a piece of a bar lie out of line. With the way d between its ends and
/// the directions t_a, t_b in which the rock at each end has carried it,
///
///   w = m x d,   m = (t_a + t_b)/|t_a + t_b|
///
/// which is zero of any turn and of any even strain: of slip of a joint alone, and half as much of
/// what bends. The bar pushes one end with -Q n, the other with Q n, n across m, and turns the rock
/// at each of them, which carries t with it: no sum, no moment.
struct Offset {
  Vec2 across{};       ///< n  [-]
  double way = 0.0;    ///< w  [m]
  double lever = 0.0;  ///< d m/|t_a + t_b|: of forces that turn, over Q, times corners' parts in t

  static Offset of(const Vec2& d, const Vec2& at_a, const Vec2& at_b) {
    const Vec2 sum = at_a + at_b;
    const double size = norm(sum);
    const Vec2 m = (1.0 / size) * sum;
    return {{-m.y, m.x}, cross(m, d), dot(d, m) / size};
  }
};

/// Q = K (w - p), |Q| <= Q_y; offset beyond goes into p.
///
/// A bar of bending stiffness E I in grout that resists its way across with k per length bends on
/// both sides of a joint as a beam on an elastic foundation: Q = E I beta^3 w, beta = (k/(4 E
/// I))^(1/4) (Friberg 1940). It bears at most 1.27 d^2 sqrt(f_c f_y), when the bar yields in
/// bending and the grout is crushed (He and Kwan 2001; Rasmussen 1963 found 1.3).
struct Dowel {
  double stiffness = 0.0;  ///< K, 0: none; per unit thickness  [N/m2]
  double strength = 0.0;   ///< Q_y  [N/m]

  double force(double offset, double kept) const {
    return std::clamp(stiffness * (offset - kept), -strength, strength);
  }
};

}  // namespace breccia::fdem
