#pragma once
// Joints as long as they are whole: what they answer, one or a pack, in double or in single
// precision.

#include "fdem/joints/joints.hpp"
#include "math/fours.hpp"

namespace breccia::fdem {

/// Weight of an integration point in a mean.  [-]
BR_HD constexpr double weight_of(int point) {
  return point == 1 ? 4.0 / 6.0 : 1.0 / 6.0;
}

/// Forces of joints that are whole.
template <class R>
struct WholeOf {
  using Mask = decltype(R{} < R{});
  R force[4];   ///< on both corners of side a  [N/m]
  Mask beyond;  ///< it does not stay so: its forces mean nothing
  Mask drags;   ///< it is, or may have been, pressed and slips enough for book_slips()
};

/// By which they answer.
template <class R>
struct ElasticBond {
  R bond[12], offset[2];
  R slope, tension, cohesion, quarter;

  /// All but `bond` and `offset`.
  BR_HD void derive(const R& length, const R& strength) {
    slope = bond[0] / length;
    tension = bond[1] * strength;
    cohesion = bond[2] * strength;
    quarter = 0.25 / tension;
  }
  /// A point of this opening and slip, offset included.
  template <class Mask>
  BR_HD BondTraction<R> at(const R& open, const R& slide, Mask& beyond, Mask& drags) const {
    const BondTraction<R> t =
        elastic_response(slope, tension, quarter, cohesion, bond[3], open, slide, beyond);
    // While it is pressed its normal traction is straight; it may have been a step ago.
    const R resists = cohesion - bond[3] * min(t.normal, constant<R>(0.0));
    drags = drags || (t.normal < 0.05 * tension && abs(t.shear) > least_drag * resists);
    return t;
  }
  /// Stress along the edge. @param stretch  |e|/h - 1  [-]  @param in_situ  at the start  [Pa]
  template <class Start>
  BR_HD R along(const Vec2Of<R>& axis, const R& stretch, const R& normal, const R& shear,
                const Start& in_situ) const {
    return stress_along(axis, stretch, normal, shear, bond[8], bond[9], bond[10], in_situ);
  }
  /// Tractions of all points; marks what does not stay whole, and what slips.
  BR_HD void points(const JointOpening<R>& o, const R& length, BondTraction<R> (&t)[3],
                    WholeOf<R>& w) const {
    w.beyond = !(o.size > 1e-12 * length);
    w.drags = w.beyond;
    for (int q = 0; q < 3; ++q)
      t[q] = at(o.open[q] + offset[0], o.slide[q] + offset[1], w.beyond, w.drags);
  }
};

/// Forces of whole joints from their points, and whether the rock there may fail.
/// @param h  length at the start  [m]
/// @param along_by  along_by(normal, shear): stress along the edge, from means of the points'  [Pa]
template <class R, class Along>
BR_HD void add_points(const R& h, const ElasticBond<R>& elastic, const JointOpening<R>& o,
                      const BondTraction<R> (&t)[3], WholeOf<R>& w, const Along& along_by) {
  const R(&bond)[12] = elastic.bond;
  Vec2Of<R> traction[3];
  R normal = constant<R>(0.0), shear = normal;
  for (int q = 0; q < 3; ++q) {
    traction[q] = t[q].shear * o.along + t[q].normal * o.normal;
    normal = normal + weight_of(q) * t[q].normal;
    shear = shear + weight_of(q) * t[q].shear;
  }
  const R along = along_by(normal, shear);
  const auto failing = may_fail(elastic.tension, elastic.cohesion, bond[3], normal, shear, along);
  w.beyond = w.beyond || (bond[8] > 0.0 && failing);
  const R weight = (-1.0 / 6.0) * h, two = constant<R>(2.0);
  const Vec2Of<R> first = weight * (traction[0] + two * traction[1]);
  const Vec2Of<R> second = weight * (traction[2] + two * traction[1]);
  w.force[0] = first.x;
  w.force[1] = first.y;
  w.force[2] = second.x;
  w.force[3] = second.y;
}

/// Work of spent_by_pressure() of a joint in a step.  [J/m]
/// @param slope  p_f / h  [Pa/m]  @param cohesion  of this joint  [Pa]  @param h  its length  [m]
template <class R>
BR_HD R spent_by_pressures(const R& slope, const R& cohesion, const R& friction, const R& h,
                           const JointOpening<R>& before, const JointOpening<R>& now,
                           const R (&offset)[2]) {
  R sum = constant<R>(0.0);
  for (int q = 0; q < 3; ++q)
    sum = sum + weight_of(q) *
                    spent_by_pressure<R>(slope, cohesion, friction,
                                         {before.open[q] + offset[0], now.open[q] + offset[0]},
                                         {before.slide[q] + offset[1], now.slide[q] + offset[1]});
  return h * sum;
}

/// Forces of a joint from its points.  [N/m]
BR_HD inline JointForce force_of(const BondTraction<double> (&t)[3], const JointOpening<double>& o,
                                 double h) {
  Vec2 traction[3];
  for (int q = 0; q < 3; ++q) traction[q] = t[q].shear * o.along + t[q].normal * o.normal;
  const double weight = (-1.0 / 6.0) * h;
  return {weight * (traction[0] + 2.0 * traction[1]), weight * (traction[2] + 2.0 * traction[1])};
}
/// Such a joint does not fail with the rock any more.
BR_HD inline bool is_half_soft(const BondState<double>& point) {
  return point.damage > 0.0 && softening(point.damage) < 0.5;
}

/// Of joints that are computed in single precision, what is taken in double and rounded then.
template <class R>
struct JointDifferences {
  Vec2Of<R> first, second;  ///< a0 - b0 and a1 - b1  [m]
  Vec2Of<R> edge;           ///< a1 - a0  [m]
  R excess;                 ///< |edge|^2 - h^2  [m2]
  R length, strength;       ///< h  [m]; over its law's  [-]
  R offset[2];              ///< opening and slip at which it was joined  [m]
  Sym2Of<R> start;          ///< stress at the start  [Pa]
};

/// @param corner  position and velocity of a0, a1, b0, b1  @param W  double or a pack of doubles
template <class W>
BR_HD JointDifferences<W> differences_of(const W (&corner)[4][4], const W& length,
                                         const W& strength, const W (&offset)[2],
                                         const Sym2Of<W>& start) {
  Vec2Of<W> x[4];
  for (int k = 0; k < 4; ++k) x[k] = {corner[k][0], corner[k][1]};
  const Vec2Of<W> edge = x[1] - x[0];
  return {x[0] - x[2],
          x[1] - x[3],
          edge,
          dot(edge, edge) - length * length,
          length,
          strength,
          {offset[0], offset[1]},
          start};
}

/// @param R  Single, or a pack of them
template <class R>
BR_HD WholeOf<R> whole_in_single(const View<const BondOf<float>>& bonds,
                                 const Index (&law)[width_of<R>], const JointDifferences<R>& d) {
  ElasticBond<R> elastic;
  gather_floats(bonds, law, elastic.bond);
  elastic.offset[0] = d.offset[0];
  elastic.offset[1] = d.offset[1];
  elastic.derive(d.length, d.strength);
  const Vec2Of<R> apart = d.first - d.second;  // (b1 - b0) - (a1 - a0)
  const JointOpening<R> o = opening_by(d.first, d.second, d.edge + constant<R>(0.5) * apart);
  // |e|^2 - h^2 of the middle line
  const R excess = d.excess + dot(d.edge, apart) + 0.25 * dot(apart, apart);
  WholeOf<R> w;
  BondTraction<R> t[3];
  elastic.points(o, d.length, t, w);
  add_points(d.length, elastic, o, t, w, [&](const R& normal, const R& shear) {
    return elastic.along(o.along, excess / (d.length * (o.size + d.length)), normal, shear,
                         d.start);
  });
  return w;
}

}  // namespace breccia::fdem
