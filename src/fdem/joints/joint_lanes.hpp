#pragma once
// Joints with more work than those that are whole, side by side on the host.

#include "fdem/joints/joint_kernels.hpp"

namespace breccia::fdem {

/// Joints for a pack: softened ones that have failed alike, or whole ones beside rock that may
/// fail.
struct AlikeJoints {
  Index joint[8] = {};  ///< from `count` on any of them again
  Index count = 0;
  bool whole = false;
  Failure how = Failure::none;
};

/// Work of JointForces::slow() for each of them, unless it collapses, breaks, fails with the rock
/// or begins to soften. @returns a bit for each that does, of which nothing is written
template <class R, class Number>
inline unsigned run_alike(const JointForces<Number>& joints, const AlikeJoints& pack) {
  using Stores = StoredAs<Number>;
  constexpr Index width = width_of<R>;
  Index own[width], law[width], end[4][width];
  double length[width], share[width];
  for (Index k = 0; k < width; ++k) {
    const Index i = own[k] = pack.joint[k];
    const JointEnds& e = joints.ends[i];
    end[0][k] = e.a0;
    end[1][k] = e.a1;
    end[2][k] = e.b0;
    end[3][k] = e.b1;
    law[k] = joints.law[i];
    length[k] = joints.length[i];
    share[k] = joints.strength[i];
  }
  const Indices<R> which = indices<R>(own);
  const R h = pack_of<R>(length), strength = pack_of<R>(share), none = constant<R>(0.0),
          two = constant<R>(2.0), dt = constant<R>(joints.dt);
  Vec2Of<R> x[4], v[4];
  for (int c = 0; c < 4; ++c) {
    R corner[4];
    gather_records(joints.nodes, indices<R>(end[c]), corner);
    x[c] = {corner[0], corner[1]};
    v[c] = {corner[2], corner[3]};
  }
  R numbers[12], offset[2] = {none, none};
  gather_records(joints.bonds, indices<R>(law), numbers);
  BondOf<R> bond;
  static_assert(sizeof bond == sizeof numbers);
  __builtin_memcpy(&bond, numbers, sizeof bond);
  if (joints.preset.size > 0) gather_records(joints.preset, which, offset);
  BondState<R> before[3]{}, point[3]{};
  if (!pack.whole) {
    R states[24];
    static_assert(sizeof before == sizeof states);
    gather_records(View<const JointPoints>(joints.points), which, states);
    __builtin_memcpy(before, states, sizeof before);
    __builtin_memcpy(point, states, sizeof point);
  }

  // Tractions.
  const JointOpening<R> now = opening_of(x[0], x[1], x[2], x[3]);
  auto left = !(now.size > 1e-12 * h);
  BondTraction<R> t[3];
  for (int q = 0; q < 3; ++q)
    t[q] = response(pack.how, bond, strength, h, now.open[q] + offset[0], now.slide[q] + offset[1],
                    point[q]);
  if (pack.how == Failure::none && any(bond.by_rock())) {
    R normal = none, shear = none;  // means
    auto half_soft = none > none;
    for (int q = 0; q < 3; ++q) {
      normal = normal + weight_of(q) * t[q].normal;
      shear = shear + weight_of(q) * t[q].shear;
      half_soft = half_soft || (point[q].damage > 0.0 && softening(point[q].damage) < 0.5);
    }
    const R along = stress_along(now.along, now.size / h - 1.0, normal, shear, bond.young,
                                 bond.poisson, bond.skew, joints.in_situ);
    const RockFailureOf<R> f = rock_failure(bond, strength, RockStressOf<R>{normal, shear, along});
    left = left || (bond.by_rock() && !half_soft && (f.torn >= 1.0 || f.sheared >= 1.0));
  }
  const auto fails_0 = point[0].damage >= 1.0, fails_1 = point[1].damage >= 1.0,
             fails_2 = point[2].damage >= 1.0;
  left = left || (fails_0 && fails_1) || (fails_1 && fails_2) || (fails_0 && fails_2);
  if (pack.whole)
    left = left || point[0].damage > 0.0 || point[1].damage > 0.0 || point[2].damage > 0.0;
  unsigned slow = 0;
  for (Index k = 0; k < pack.count; ++k)
    if (left[k] != 0) slow |= 1U << k;

  // Forces
  Vec2Of<R> traction[3];
  for (int q = 0; q < 3; ++q) traction[q] = t[q].shear * now.along + t[q].normal * now.normal;
  const R weight = (-1.0 / 6.0) * h;
  const Vec2Of<R> on_first = weight * (traction[0] + two * traction[1]);
  const Vec2Of<R> on_second = weight * (traction[2] + two * traction[1]);
  R last[4], acts[4];
  gather_four<Stores>(View<const JointForceOf<Stores>>(joints.force), which, last);
  const R sums[4] = {on_first.x, on_first.y, on_second.x, on_second.y};
  for (Index k = 0; k < pack.count; ++k) {
    if ((slow >> k & 1U) != 0) continue;
    const double four[4] = {sums[0][k], sums[1][k], sums[2][k], sums[3][k]};
    store_four<Stores>(joints.force, own[k], four);
  }

  // and what they do.
  const JointOpening<R> then =
      opening_of(x[0] - dt * v[0], x[1] - dt * v[1], x[2] - dt * v[2], x[3] - dt * v[3]);
  if (pack.whole) {
    const R sum = spent_by_pressures<R>(bond.stiffness / h, bond.cohesion * strength, bond.friction,
                                        h, then, now, offset);
    for (Index k = 0; k < pack.count; ++k)
      if ((slow >> k & 1U) == 0) joints.work[own[k]].slide += sum[k];
    return slow;
  }
  gather_four<Stores>(View<const JointForceOf<Stores>>(joints.force), which, acts);  // as stored
  const Vec2Of<R> f{last[0] + acts[0], last[1] + acts[1]}, s{last[2] + acts[2], last[3] + acts[3]};
  const Vec2Of<R> first = dt * (v[0] - v[2]), second = dt * (v[1] - v[3]);
  const R opened = 0.5 * (dot(f, now.normal) * dot(first, now.normal) +
                          dot(s, now.normal) * dot(second, now.normal));
  const R slid = 0.5 * (dot(f, now.along) * dot(first, now.along) +
                        dot(s, now.along) * dot(second, now.along));
  R rubbed = none;
  const auto rubs = bond.residual > 0.0;
  if (any(rubs)) {
    for (int q = 0; q < 3; ++q) {
      const R from = then.slide[q] + offset[1], to = now.slide[q] + offset[1];
      const R began =
          residual_traction(pack.how, bond, strength, h, then.open[q] + offset[0], from, before[q]);
      const R ended =
          residual_traction(pack.how, bond, strength, h, now.open[q] + offset[0], to, point[q]);
      rubbed = rubbed + weight_of(q) * 0.5 * (began + ended) * (to - from);
    }
    rubbed = h * rubbed;
  }
  double after[24][width];
  __builtin_memcpy(after, point, sizeof after);
  for (Index k = 0; k < pack.count; ++k) {
    if ((slow >> k & 1U) != 0) continue;
    const Index i = own[k];
    joints.work[i].open -= opened[k];
    joints.work[i].slide -= slid[k];
    if (rubs[k] != 0) joints.rubbed[i] += rubbed[k];
    double record[24];
    for (int c = 0; c < 24; ++c) record[c] = after[c][k];
    __builtin_memcpy(&joints.points[i], record, sizeof record);
  }
  return slow;
}

}  // namespace breccia::fdem
