#pragma once
// Joints: bonds of triangles along common edges, their arrays and geometry.

#include "core/precision.hpp"
#include "exec/buffer.hpp"
#include "fdem/laws/rock_failure.hpp"
#include "fdem/triangles/triangles.hpp"
#include "fdem_shared/laws/residual_work.hpp"

namespace breccia::fdem {

using fdem_shared::spent_on_friction;

/// How far a joint has gone.
/// dormant: its elements move as one until the stress between them reaches its strength;
/// cut: a body at it has been taken out of the model.
enum class JointStage : std::uint8_t { whole, softened, broken, dormant, cut };

/// Whether a joint has lost some of its strength.
BR_HD constexpr bool is_damaged(JointStage stage) {
  return stage == JointStage::softened || stage == JointStage::broken;
}

/// Whether nothing joins its elements any more.
BR_HD constexpr bool is_parted(JointStage stage) {
  return stage == JointStage::broken || stage == JointStage::cut;
}

/// Whether its law acts.
BR_HD constexpr bool is_live(JointStage stage) {
  return stage == JointStage::whole || stage == JointStage::softened;
}

/// Integration points: at the first end, in the middle, at the second end; weights 1/6, 4/6, 1/6.
struct JointPoints {
  BondState<double> point[3];
};

/// Forces of a joint on the two nodes of its side a; those of side b get the opposite.  [N/m]
template <class Number>
struct JointForceOf {
  Vec2Of<Number> first, second;
};
using JointForce = JointForceOf<double>;
template <class To, class From>
BR_HD JointForceOf<To> converted(const JointForceOf<From>& f) {
  return {converted<To>(f.first), converted<To>(f.second)};
}
template <class Number>
using JointForcesOf = Buffer<JointForceOf<Number>>;

/// Work that a joint has taken up since it began to soften, and what it held then, by direction.
/// [J/m]
struct JointWork {
  double open = 0.0, slide = 0.0;

  BR_HD void add(double weight, const StoredEnergy& e) {
    open += weight * e.open;
    slide += weight * e.slide;
  }
  /// As much of it as there is of another.
  BR_HD JointWork within(const JointWork& most) const {
    return {min(open, most.open), min(slide, most.slide)};
  }
  /// Of work beyond what a softened joint would give back, what it has spent: never less than
  /// nothing of both together. One whose pressure has grown since it slipped would give back more
  /// than it took up (docs/theory-fdem.md, 7).
  BR_HD JointWork spent() const {
    const double sum = open + slide;
    if (!(sum > 0.0)) return {};
    const double by_opening = max(0.0, min(open, sum));
    return {by_opening, sum - by_opening};
  }
};

/// Energies that a joint that is cut has spent.
struct SpentByCut {
  JointWork work;
  double rubbed = 0.0;  ///< of it, on residual friction

  /// Of a softened joint: of its work, less what it still holds.
  static SpentByCut of(const JointWork& work, const StoredEnergy& held, double rubbed) {
    const JointWork spent = JointWork{work.open - held.open, work.slide - held.slide}.spent();
    return {spent, spent_on_friction(rubbed, held.rubs, spent.slide)};
  }
};

/// Forces and work that a joint which breaks hands to the contact of its faces.
struct JointHandover {
  double pressing = 0.0;  ///< compressive force  [N/m]
  double shear = 0.0;     ///< on side a along its edge  [N/m]
  JointWork held;         ///< by its pressed points  [J/m]
};

/// Cohesive joints. Edge 3 t + k leads from corner k of triangle t to the next one. Side a is the
/// triangle with the lower global id; its edge's first node lies at the second node of side b's.
/// One item for each joint, `force` has one more that stays zero; who writes it, in brackets, in
/// the words of World. Constant: written by set-up; all of it moves with its joint between ranks.
struct Joints {
  /// Others read the fields that each_field visits, no more: host_copy() makes no other array.
  static constexpr bool is_arrays_alone = true;

  Buffer<Index> edge_a, edge_b;    ///< the two edges that it joins  [-]  (set-up, ranks)
  Buffer<Index> law;               ///< index into Case::bonds  [-]  (constant)
  Buffer<double> length;           ///< at the start  [m]  (constant)
  Buffer<double> strength;         ///< over its law's  [-]  (constant)
  Buffer<Vec2> preset;             ///< opening and slip at which it was joined; empty: none  [m]
                                   ///< (set-up, insertion)
  Buffer<JointStage> stage;        ///<  [-]  (insertion, pairs, stage)
  Buffer<JointPoints> points;      ///< damage and largest opening and slip  (pairs)
  Stored<JointForcesOf> force;     ///< of this time  [N/m]  (pairs)
  Buffer<JointWork> work;          ///< taken up so far  [J/m]  (pairs)
  Buffer<double> broke_at;         ///< below 0: it is not broken  [s]  (pairs)
  Buffer<JointHandover> handover;  ///< of when it broke  [SI]  (pairs)
  /// Of its work, what contact of its faces began with; of a joint that is cut, what it had spent
  /// by then.  [J/m]  (pairs, stage)
  Buffer<JointWork> inherited_work;
  Buffer<double> rubbed;  ///< of its work, that of residual friction; of a joint that is cut, what
                          ///< that had spent by then  [J/m]  (pairs, stage)

  template <class Visit>
  void each_field(Visit&& field) {
    field("edge_a", "-", edge_a);
    field("edge_b", "-", edge_b);
    field("law", "-", law);
    field("length", "m", length);
    field("strength", "-", strength);
    field("stage", "-", stage);
    field("points", "-", points);
    field("work", "J/m", work);
    field("broke_at", "s", broke_at);
    field("handover", "SI", handover);
    field("inherited_work", "J/m", inherited_work);
    field("rubbed", "J/m", rubbed);
  }
  Index size() const { return edge_a.size(); }
};

// Of joint i, on the host, and of all joints, for kernels: by the words that tetrahedra have, too
// (fdem3/joints/joints.hpp).
inline const JointPoints& points_of(const Joints& j, Index i) {
  return j.points.data()[i];
}
inline double broke_at(const Joints& j, Index i) {
  return j.broke_at.data()[i];
}
inline const JointWork& inherited_work(const Joints& j, Index i) {
  return j.inherited_work.data()[i];
}
inline double rubbed(const Joints& j, Index i) {
  return j.rubbed.data()[i];
}
inline void inherit(Joints& j, Index i, const JointWork& work, double rubbed) {
  j.inherited_work.data()[i] = work;
  j.rubbed.data()[i] = rubbed;
}
inline void take_inherited(Joints& to, const Joints& from) {
  copy_to(to.inherited_work, from.inherited_work);
  copy_to(to.rubbed, from.rubbed);
}
inline View<const double> times_of_break(const Joints& j) {
  return j.broke_at.view();
}
inline View<const JointWork> works_inherited(const Joints& j) {
  return j.inherited_work.view();
}
inline View<const double> works_rubbed(const Joints& j) {
  return j.rubbed.view();
}
/// Of the sliding work of a joint that is broken, what residual friction took.
template <class AnyJoints>
double friction_of_broken(const AnyJoints& j, Index i) {
  const double held = inherited_work(j, i).slide;
  return spent_on_friction(rubbed(j, i), held, j.work.data()[i].slide - held);
}

/// The corners that a joint ties: a0 and a1 along side a; b0 faces a0, b1 faces a1.
struct JointEnds {
  Index a0, a1, b0, b1;

  BR_HD static JointEnds of(Index edge_a, Index edge_b) {
    return {edge_a, next_corner(edge_a), next_corner(edge_b), edge_b};
  }
  BR_HD static Index next_corner(Index edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
};

/// Lists corners a0, a1, b0, b1 of a joint, or of it and its neighbours in a pack.
template <class R>
BR_HD inline void list_ends(const View<const JointEnds>& ends, Index i,
                            Index (&at)[4][width_of<R>]) {
  for (Index k = 0; k < width_of<R>; ++k) {
    const JointEnds& e = ends[i + k];
    at[0][k] = e.a0;
    at[1][k] = e.a1;
    at[2][k] = e.b0;
    at[3][k] = e.b1;
  }
}

/// How a joint is open: axes and relative displacements at its integration points.
template <class R>
struct JointOpening {
  Vec2Of<R> along, normal;  ///< e of the middle line, and n from side b into side a  [-]
  R size;                   ///< length of the middle line  [m]
  R open[3];                ///<  [m]
  R slide[3];               ///< of side a against b along e  [m]
};

/// @param first, second  a0 - b0 and a1 - b1  @param line  the middle line  [m]
template <class R>
BR_HD JointOpening<R> opening_by(const Vec2Of<R>& first, const Vec2Of<R>& second,
                                 const Vec2Of<R>& line) {
  JointOpening<R> o;
  const R half = constant<R>(0.5);
  o.size = norm(line);
  o.along = (1.0 / o.size) * line;
  o.normal = {-o.along.y, o.along.x};
  o.open[0] = dot(first, o.normal);
  o.open[2] = dot(second, o.normal);
  o.slide[0] = dot(first, o.along);
  o.slide[2] = dot(second, o.along);
  o.open[1] = half * (o.open[0] + o.open[2]);
  o.slide[1] = half * (o.slide[0] + o.slide[2]);
  return o;
}
template <class R>
BR_HD JointOpening<R> opening_of(const Vec2Of<R>& a0, const Vec2Of<R>& a1, const Vec2Of<R>& b0,
                                 const Vec2Of<R>& b1) {
  return opening_by(a0 - b0, a1 - b1, constant<R>(0.5) * ((a1 - a0) + (b1 - b0)));
}

/// Opening and slip at which a joint carries a traction, its strength permitting. False if not.
/// @param normal, shear  traction, tension positive  [Pa]
BR_HD inline bool preset_opening(const JointBond& bond, double strength, double length,
                                 double normal, double shear, Vec2& opening_and_slip) {
  const double tension = bond.tension * strength;
  const double limit = bond.cohesion * strength - bond.friction * min(normal, 0.0);
  if (normal >= tension || abs(shear) >= limit) return false;
  // (2 r - r^2) f = t on the rising branch
  const auto share = [](double t, double f) { return 1.0 - sqrt(1.0 - t / f); };
  const double slip = share(abs(shear), limit) * 2.0 * length * limit / bond.stiffness;
  opening_and_slip = {normal < 0.0
                          ? normal * length / bond.stiffness
                          : share(normal, tension) * 2.0 * length * tension / bond.stiffness,
                      copysign(slip, shear)};
  return true;
}

/// Energy that a joint would give back if it were unloaded now, by direction.  [J/m]
BR_HD inline StoredEnergy stored_in(const JointBond& bond, double strength, double length,
                                    const Vec2& offset, const JointOpening<double>& o,
                                    const JointPoints& points) {
  StoredEnergy sum{};
  for (int q = 0; q < 3; ++q) {
    const StoredEnergy e = stored(bond, strength, length, o.open[q] + offset.x,
                                  o.slide[q] + offset.y, points.point[q]);
    const double weight = (q == 1 ? 4.0 : 1.0) * length / 6.0;
    sum.open += weight * e.open;
    sum.slide += weight * e.slide;
    sum.rubs += weight * e.rubs;
  }
  return sum;
}

}  // namespace breccia::fdem
