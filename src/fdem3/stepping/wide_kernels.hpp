#pragma once
// Couples of tetrahedra as a device evaluates them: eight threads take one. Forces are those of
// CoupleForces, to the bit.

#include "exec/lockstep.hpp"
#include "fdem3/contact/couples.hpp"

namespace breccia::fdem3 {

/// Work that few couples need.
BR_COLD inline void cold_begin(const CoupleForces* couples, Index c) {
  stay_in_place(couples);
  couples->begin(c);
}

/// CoupleForces by eight threads a couple: each takes a face and the corner opposite to it, 0 to 3
/// of a and 4 to 7 of b. A corner adds up what faces do to it in their order; of what belongs to
/// the couple every thread adds up all.
struct CouplesWide {
  static constexpr const char* name = "fdem3.couples";
  static constexpr int width = 8;
  CoupleForces all;

  BR_HD void set(const StepTime& now) { all.set(now); }
  BR_HD double dt() const { return all.dt; }
  BR_HD bool is_due(Index c) const { return all.is_due(c); }
  BR_HD Index items() const { return all.a.size; }

  /// @param number  of a couple, or items(): then the group goes along with the others of its
  ///                warp, looks at the last couple and leaves it alone
  BR_HD void evaluate(double dt, Index number, int lane) const {
    const LaneGroup<width> group;
    const bool is_item = number < items();
    const Index c = is_item ? number : items() - 1;
    const bool of_a = lane < 4;
    const int corner = of_a ? lane : lane - 4;
    const Index own = of_a ? all.a[c] : all.b[c], other = of_a ? all.b[c] : all.a[c];
    const auto vector_from = [group](int from, const Vec3& v) {
      return Vec3{group.from(from, v.x), group.from(from, v.y), group.from(from, v.z)};
    };
    CoupleState kept = all.state[c];
    const bool is_new = kept.scale == 0.0;
    if (is_new) kept.scale = 1.0;
    const bool holds = kept.work != 0.0 || kept.slid != 0.0, resting = !is_new && !holds;

    Vec3 x[4], of_other[4];
    places(all.nodes[own], x);
    places(all.nodes[other], of_other);
    const Vec3 velocity = all.nodes[own].at[corner].velocity;
    Target target = Target::of(of_other);
    const CornersInside in_target = CornersInside::of(x, target);
    const bool apart =
        boxes_apart(x, of_other, 0.0) || !(target.six_volumes > 0.0) || in_target.beyond_a_face();
    const bool meeting = group.ballot(apart) == 0 && is_item;
    bool works = is_item && (meeting || !resting);
    if (!group.any_of_warp(works)) return;

    const ContactPair& law = all.law_of(c);
    const bool begins = meeting && is_new && all.parent_joint[c] >= 0;
    if (group.any_of_warp(begins)) {
      if (begins && lane == 0) cold_begin(&all, c);
      group.wait();
      if (begins) kept = all.state[c];
    }
    target.measure_heights();
    const bool exposed = (all.exposed[own] >> corner & 1) != 0;
    const bool reaches = meeting && (holds || (exposed && reaches_into(in_target, corner, target)));
    const bool presses = group.ballot(reaches) != 0;
    Pressing sum;
    Vec3 force{};  // on the own corner
    if (group.any_of_warp(presses))
      press(group, x, in_target, target, lane, exposed, law.penalty * kept.scale, presses, holds,
            sum, force);
    const bool may_begin = meeting && !holds && kept.work == 0.0;
    if (group.any_of_warp(may_begin)) {
      const double power = dot(force, velocity);
      double powers = 0.0;
      for (int k = 0; k < 4; ++k) powers += group.from(k, power) + group.from(k + 4, power);
      if (may_begin) note_begun(is_new, -dt * powers, kept, sum);
    }
    if (meeting && kept.begun > 0.0) {
      const double share = sum.share_beyond(kept.begun);
      force = share * force;
      sum.on_a = share * sum.on_a;
    }
    const bool rubs = meeting && sum.rubs(law);
    if (group.any_of_warp(rubs)) {
      double share[4];
      Target::of(x).coordinates(sum.middle(), share);
      Vec3 rate{};  // of a against b
      for (int k = 0; k < 4; ++k)
        rate += group.from(0, share[k]) * vector_from(k, velocity) -
                group.from(4, share[k]) * vector_from(k + 4, velocity);
      if (rubs) {
        const Vec3 pull = pull_of(law, dt, rate, sum, kept);
        const double mine =
            corner < 2 ? (corner == 0 ? share[0] : share[1]) : (corner == 2 ? share[2] : share[3]);
        if (of_a)
          force += mine * pull;
        else
          force -= mine * pull;
      }
    }
    works = works && (sum.touches() || !resting);
    if (!group.any_of_warp(works)) return;
    Vec3& stored = (of_a ? all.force[c].on_a : all.force[c].on_b).at[corner];
    const double taken = 0.5 * dt * dot(stored + force, velocity);
    for (int k = 0; k < 4; ++k) {
      kept.work -= group.from(k, taken);
      kept.work -= group.from(k + 4, taken);
    }
    if (!works) return;
    stored = force;
    end_step(sum.touches(), kept);
    if (lane == 0) all.state[c] = kept;  // all have read it
  }

 private:
  BR_HD static bool reaches_into(const CornersInside& in_target, int face, const Target& target) {
    double lambda[3][4];
    corners_of_face(in_target, face, lambda);
    return face_reaches_into(target, lambda);
  }
  /// CoupleForces::press.
  /// @param presses  whether the own couple does
  BR_HD static void press(const LaneGroup<width>& group, const Vec3 (&x)[4],
                          const CornersInside& in_target, const Target& target, int lane,
                          bool exposed, double penalty, bool presses, bool holds, Pressing& sum,
                          Vec3& force) {
    const bool of_a = lane < 4;
    const int corner = of_a ? lane : lane - 4;
    FacePart mine{};
    const unsigned inside =
        group.ballot(presses && part_of_face(x, in_target, corner, exposed, target, Inside(target),
                                             penalty, of_a, mine));
    Target of_own = Target::of(x);
    of_own.measure_heights();
    Inside in_own(of_own);
    for (int s = 0; s < width; ++s) {
      const bool is_inside = (inside >> s & 1U) != 0;
      if (!group.any_of_warp(is_inside)) continue;
      const FacePart part = part_from(group, s, mine);
      if (!is_inside) continue;
      const bool own_face = (s < 4) == of_a;
      const int face = s < 4 ? s : s - 4;
      sum.add(part, s < 4);
      if (own_face)
        in_own.add_own(face, part.inside.area);
      else
        in_own.add_other(part.inside);
      for (int k = 0; k < 4; ++k)
        if (!own_face && k == corner) force += part.on_target[k];
      for (int k = 0; k < 3; ++k)
        if (own_face && corner_of_face(face, k) == corner) force += part.on_face[k];
    }
    const bool acts = presses && (holds || sum.touches());
    if (!acts) {
      sum = {};
      force = {};
    }
    if (!group.any_of_warp(acts)) return;
    const double own_energy = in_own.energy(penalty);
    const double energy = group.from(0, own_energy) + group.from(4, own_energy);
    if (!acts) return;
    sum.energy = energy;
    Vec3 of_shape[4];
    for (int k = 0; k < 4; ++k) of_shape[k] = k == corner ? force : Vec3{};
    in_own.add_shape_forces(of_own, penalty, of_shape);
    for (int k = 0; k < 4; ++k)
      if (k == corner) force = of_shape[k];
  }
  BR_HD static FacePart part_from(const LaneGroup<width>& group, int s, const FacePart& mine) {
    static_assert(sizeof(FacePart) == 35 * sizeof(double));  // each number is handed over below
#if !defined(__CUDA_ARCH__)
    return group.record_from(s, mine);
#else
    FacePart part;
    const auto take = [&](double& to, double from) { to = group.from(s, from); };
    const auto take_vector = [&](Vec3& to, const Vec3& from) {
      take(to.x, from.x), take(to.y, from.y), take(to.z, from.z);
    };
    for (int k = 0; k < 3; ++k) take_vector(part.on_face[k], mine.on_face[k]);
    for (int k = 0; k < 4; ++k) take_vector(part.on_target[k], mine.on_target[k]);
    for (int k = 0; k < 4; ++k) take(part.inside.volume_sum[k], mine.inside.volume_sum[k]);
    take(part.inside.area, mine.inside.area);
    take(part.inside.face_sum, mine.inside.face_sum);
    const int kind = group.from(s, (mine.exposed ? 1 : 0) + (mine.pushes ? 2 : 0));
    part.exposed = (kind & 1) != 0;
    part.pushes = (kind & 2) != 0;
    take(part.size, mine.size);
    take_vector(part.push, mine.push);
    take_vector(part.moment, mine.moment);
    return part;
#endif
  }
};

}  // namespace breccia::fdem3
