#pragma once
// Joints of tetrahedra across their common faces: arrays and geometry.

#include "core/rare_array.hpp"
#include "exec/buffer.hpp"
#include "fdem/joints/joints.hpp"
#include "fdem3/elements/tetrahedra.hpp"

namespace breccia::fdem3 {

using fdem::is_damaged;
using fdem::is_live;
using fdem::is_parted;
using fdem::JointBond;
using fdem::JointPoints;
using fdem::JointStage;
using fdem::JointWork;

/// Forces of a joint on the three nodes of its side a, in the order of side b's list; those of side
/// b get the opposite.  [N]
struct JointForce {
  Vec3 at[3];
};

/// The nodes that a joint ties: on[0] of side a, on[1] of side b, opposite each other.
struct JointEnds {
  Index a[3], b[3];

  /// @param turn  place in a's list of the corner that lies at b's first one
  BR_HD static JointEnds of(Index face_a, Index face_b, int turn) {
    JointEnds e;
    for (int k = 0; k < 3; ++k) {
      e.b[k] = 4 * (face_b / 4) + corner_of_face(face_b % 4, k);
      e.a[k] = 4 * (face_a / 4) + corner_of_face(face_a % 4, (turn + 3 - k) % 3);
    }
    return e;
  }
};

/// The middle surface of the joint's two faces at the start, in its own plane: edges from corner 0
/// to corner 1, (size, 0), and to corner 2.  [m]
template <class R>
struct FaceShapeOf {
  R size, along, across;

  BR_HD static FaceShapeOf of(const Vec3Of<R>& p, const Vec3Of<R>& q, const Vec3Of<R>& r) {
    const Vec3Of<R> first = q - p, second = r - p;
    const R size = norm(first), along = dot(first, second) / size;
    return {size, along, sqrt(max(constant<R>(0.0), dot(second, second) - along * along))};
  }
  BR_HD R area() const { return 0.5 * size * across; }
};
using FaceShape = FaceShapeOf<double>;

/// The record of a joint from the step on in which it softens, breaks or is cut. All others are
/// as this begins.
struct JointFailure {
  JointPoints points;      ///< damage and largest opening and slip
  double broke_at = -1.0;  ///< below 0: it is not broken  [s]
  double pressing = 0.0;   ///< compressive force when it broke  [N]
  Vec3 shear_at_break;     ///< on side a  [N]
  JointWork held;          ///< by its pressed points when it broke  [J]
  JointWork inherited;     ///< of its work, what contact of its faces began with  [J]
  double rubbed = 0.0;  ///< of its work, that of residual friction; cut: what that had spent  [J]

  /// Visits its members by the names that checkpoints have for them.
  template <class Visit>
  static void each_member(Visit&& member) {
    member("points", "SI", &JointFailure::points);
    member("broke_at", "s", &JointFailure::broke_at);
    member("pressing", "N", &JointFailure::pressing);
    member("shear_at_break", "N", &JointFailure::shear_at_break);
    member("held", "J", &JointFailure::held);
    member("inherited_work", "J", &JointFailure::inherited);
    member("rubbed", "J", &JointFailure::rubbed);
  }
};

/// Cohesive joints. Side a is the tetrahedron with the lower global id. Integration points lie in
/// the middles of the edges (0, 1), (1, 2), (2, 0) of the face, a third of its area each. One item
/// for each joint. Who writes it: as of Tetrahedra.
struct Joints {
  /// Others read the fields that each_field visits, no more: host_copy() makes no other array.
  static constexpr bool is_arrays_alone = true;

  Buffer<Index> face_a, face_b;     ///< the two faces that it joins  [-]  (set-up, ranks)
  Buffer<std::uint8_t> turn;        ///< see JointEnds  [-]  (constant)
  Buffer<Index> law;                ///< index into Case::bonds  [-]  (constant)
  Buffer<FaceShape> shape;          ///< at the start  [m]  (constant)
  Buffer<double> length;            ///< h = (V_a + V_b) / A  [m]  (constant)
  Buffer<double> strength;          ///< over its law's  [-]  (constant)
  Buffer<Vec3> preset;              ///< opening and slip along (0, 1) and across it at which it was
                                    ///< joined; empty: none  [m]  (set-up, insertion)
  Buffer<JointStage> stage;         ///<  [-]  (insertion, pairs)
  Buffer<JointForce> force;         ///< of this time  [N]  (pairs)
  Buffer<JointWork> work;           ///< taken up so far  [J]  (pairs)
  RareArray<JointFailure> failure;  ///< of those that are not whole, or no longer  (pairs, stage)

  template <class Visit>
  void each_field(Visit&& field) {
    field("face_a", "-", face_a);
    field("face_b", "-", face_b);
    field("turn", "-", turn);
    field("law", "-", law);
    field("shape", "m", shape);
    field("length", "m", length);
    field("strength", "-", strength);
    field("stage", "-", stage);
    field("work", "J", work);
    field("failed", "SI", failure);
  }
  Index size() const { return face_a.size(); }
};

// Of joint i, on the host; the plane method has the same words (fdem/joints/joints.hpp).
inline JointPoints points_of(const Joints& j, Index i) {
  return j.failure.view().part<&JointFailure::points>(i);
}
inline double broke_at(const Joints& j, Index i) {
  return j.failure.view().part<&JointFailure::broke_at>(i);
}
inline JointWork inherited_work(const Joints& j, Index i) {
  return j.failure.view().part<&JointFailure::inherited>(i);
}
inline double rubbed(const Joints& j, Index i) {
  return j.failure.view().part<&JointFailure::rubbed>(i);
}
inline void inherit(Joints& j, Index i, const JointWork& work, double rubbed) {
  JointFailure& record = j.failure.make(i);
  record.inherited = work;
  record.rubbed = rubbed;
}
inline void take_inherited(Joints& to, const Joints& from) {
  copy_to(to.failure, from.failure);
}

// Of all joints, for kernels.
using FailedJoints = RareView<const JointFailure>;
using TimesOfBreak = PartOfRecords<JointFailure, &JointFailure::broke_at>;
using InheritedWork = PartOfRecords<JointFailure, &JointFailure::inherited>;
using RubbedWork = PartOfRecords<JointFailure, &JointFailure::rubbed>;
inline TimesOfBreak times_of_break(const Joints& j) {
  return {j.failure.view()};
}
inline InheritedWork works_inherited(const Joints& j) {
  return {j.failure.view()};
}
inline RubbedWork works_rubbed(const Joints& j) {
  return {j.failure.view()};
}
using fdem::friction_of_broken;

/// Of a joint's area, what a corner presses with where the point opposite has failed. It bounds the
/// stiffness of softened joints (StableStep).  [-]
inline constexpr double corner_share = 1.0 / 12.0;

/// Where a point softens, the other two let the faces turn about the line between them and run into
/// each other: the corner beyond that line presses in the place of what the point has lost, no
/// farther than the point is open.
struct PressedCorner {
  double depth;  ///< that counts; not above 0: it does not press  [m]
  double work;   ///< of a spring of 1 N/m on the way there, for a point as open as this one  [J]

  /// @param open  at the integration points  [m]  @param point  opposite the corner
  BR_HD static PressedCorner of(const double (&open)[3], int point) {
    const double far = open[point] - open[(point + 1) % 3] - open[(point + 2) % 3];
    const double depth = min(open[point], far);
    return {depth, depth * (far - 0.5 * depth)};
  }
  BR_HD bool presses() const { return depth > 0.0; }
};

/// @param damage  of the point  @returns stiffness  [N/m]
BR_HD inline double corner_spring(const JointBond& bond, double h, double area, double damage) {
  return corner_share * area * (1.0 - fdem::softening(damage)) * (bond.stiffness / h);
}

/// How far the two faces of a joint have moved apart.
template <class R>
struct JointOpeningOf {
  Vec3Of<R> normal;     ///< unit, from b into a, of the middle surface
  Vec3Of<R> along;      ///< unit, from corner 0 to corner 1
  R twice;              ///< twice the area of the middle surface  [m2]
  R open[3];            ///< at the integration points  [m]
  Vec3Of<R> slide[3];   ///< of side a against b, in the surface  [m]
  Vec3Of<R> middle[3];  ///< corners of the middle surface  [m]
};
using JointOpening = JointOpeningOf<double>;
template <class R>
BR_HD JointOpeningOf<R> opening_of(const Vec3Of<R> (&a)[3], const Vec3Of<R> (&b)[3]) {
  const R half = constant<R>(0.5);
  JointOpeningOf<R> o;
  for (int k = 0; k < 3; ++k) o.middle[k] = half * (a[k] + b[k]);
  const Vec3Of<R> edge = o.middle[1] - o.middle[0];
  const Vec3Of<R> twice = cross(edge, o.middle[2] - o.middle[0]);
  o.twice = norm(twice);
  o.normal = (1.0 / o.twice) * twice;
  o.along = (1.0 / norm(edge)) * edge;
  for (int q = 0; q < 3; ++q) {
    const int i = q, j = q == 2 ? 0 : q + 1;
    const Vec3Of<R> apart = half * ((a[i] - b[i]) + (a[j] - b[j]));
    o.open[q] = dot(apart, o.normal);
    o.slide[q] = apart - o.open[q] * o.normal;
  }
  return o;
}
/// A joint's offset in space.  [m]
/// @param preset  opening, slip along the first edge, slip across it
template <class R>
BR_HD Vec3Of<R> slip_in_space(const JointOpeningOf<R>& o, const Vec3Of<R>& preset) {
  return preset.y * o.along + preset.z * cross(o.normal, o.along);
}

/// Opening and slip at which a joint carries a traction, its strength permitting. False if not.
/// @param traction  normal, tension positive; along the first edge and across it  [Pa]
/// @param opening  likewise  [m]
BR_HD inline bool preset_opening(const JointBond& bond, double strength, double h,
                                 const Vec3& traction, Vec3& opening) {
  const double shear = sqrt(traction.y * traction.y + traction.z * traction.z);
  Vec2 open_and_slip;
  if (!fdem::preset_opening(bond, strength, h, traction.x, shear, open_and_slip)) return false;
  const double share = shear > 0.0 ? open_and_slip.y / shear : 0.0;
  opening = {open_and_slip.x, share * traction.y, share * traction.z};
  return true;
}

/// Energy that a joint would give back if it were unloaded now, by direction.  [J]
BR_HD inline fdem::StoredEnergy stored_in(const JointBond& bond, double strength, double h,
                                          double area, const Vec3& preset, const JointOpening& o,
                                          const JointPoints& points) {
  fdem::StoredEnergy sum{};
  const Vec3 slip = slip_in_space(o, preset);
  double open[3];
  for (int q = 0; q < 3; ++q) open[q] = o.open[q] + preset.x;
  for (int q = 0; q < 3; ++q) {
    const fdem::StoredEnergy e =
        fdem::stored(bond, strength, h, open[q], norm(o.slide[q] + slip), points.point[q]);
    sum.open += area / 3.0 * e.open;
    sum.slide += area / 3.0 * e.slide;
    sum.rubs += area / 3.0 * e.rubs;
    const double damage = points.point[q].damage;
    if (!(damage > 0.0)) continue;
    if (const PressedCorner corner = PressedCorner::of(open, q); corner.presses())
      sum.open += corner_spring(bond, h, area, damage) * corner.work;
  }
  return sum;
}

}  // namespace breccia::fdem3
