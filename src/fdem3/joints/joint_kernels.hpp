#pragma once
// The kernel of all joints: reads, one law call a point, one write.

#include "core/kernel.hpp"
#include "fdem/joints/joint_kernels.hpp"
#include "fdem3/joints/joints.hpp"
#include "fdem3/laws/rock_failure.hpp"
#include "fdem_shared/wanted.hpp"
#include "math/records.hpp"

namespace breccia::fdem3 {

/// Tractions at three points, damage and break of every joint (docs/theory-fdem3.md, 2). Joints
/// that are whole and stay so, nearly all, are taken side by side.
struct JointForces {
  static constexpr const char* name = "fdem3.joints";
  double time, dt;  ///< of the positions, and the step that led there  [s]
  View<const TetrahedronNodes> nodes;
  View<const JointBond> bonds;
  View<const Index> face_a, face_b;
  View<const std::uint8_t> turn;
  View<const Index> law;
  View<const FaceShape> shape;
  View<const double> length, strength;
  View<const Vec3> preset;
  Sym3 in_situ;                           ///< stress at the start  [Pa]
  View<const ElasticTetrahedron> graded;  ///< laws that hold it by global id; empty: no slope
  View<const GlobalId> id;                ///< of tetrahedra
  View<JointStage> stage;
  View<JointForce> force;
  View<JointWork> work;
  RareView<JointFailure> failure;
  View<std::uint8_t> changed;            ///< flags of fdem::Change: contacts must be searched
  std::int32_t* host_request = nullptr;  ///< gets request_room where a joint's record finds none;
                                         ///< null: whoever launches it looks

  static constexpr std::int32_t goes_on_at_request = fdem_shared::request_room;

  template <class R>
  struct Loaded {
    JointStage before;  ///< of a pack: whole if one is
    bool quiet;         ///< dormant, or parted for good; of a pack: none is whole. Nothing to do
    JointForce last;    ///< of the step before; of one joint
    JointEnds ends;     ///< likewise
    Indices<R> corner[6], law;  ///< corners of a, then of b; of a pack
    FaceShapeOf<R> shape;
    R length, strength;
    Vec3Of<R> offset;
    JointOpeningOf<R> opening;
    Index number;  ///< of the first joint
  };
  /// Of joints in a pack, a bit for each.
  struct Left {
    unsigned others;  ///< those of which nothing is written: for operator()
    unsigned drags;   ///< those that must book_slip()
  };
  BR_HD void set(const StepTime& now) {
    time = now.time;
    dt = now.last_dt;
  }
  /// All but the corners.
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.before = stage[i];
    loaded.number = i;
    if constexpr (width_of<R> == 1) {
      loaded.last = force[i];
      loaded.quiet = loaded.before == JointStage::dormant ||
                     (is_parted(loaded.before) && is_zero(loaded.last));
    } else {
      for (Index k = 1; k < width_of<R>; ++k)
        if (stage[i + k] == JointStage::whole) loaded.before = JointStage::whole;
      loaded.quiet = loaded.before != JointStage::whole;
    }
    if (loaded.quiet) return;
    if constexpr (width_of<R> == 1) {
      loaded.ends = ends_of(i);
      loaded.shape = shape[i];
    } else {
      Index at[6][width_of<R>];
      for (Index k = 0; k < width_of<R>; ++k) {
        const JointEnds e = ends_of(i + k);
        for (int c = 0; c < 3; ++c) {
          at[c][k] = e.a[c];
          at[c + 3][k] = e.b[c];
        }
      }
      for (int c = 0; c < 6; ++c) loaded.corner[c] = indices<R>(at[c]);
      R numbers[3];
      gather_odd(shape, consecutive<R>(i), numbers);
      loaded.shape = {numbers[0], numbers[1], numbers[2]};
    }
    loaded.law = load_indices_now<R>(law, i);
    loaded.length = load_now<R>(length, i);
    loaded.strength = load_now<R>(strength, i);
    loaded.offset = preset.size > 0 ? load_vectors<R>(preset, i) : Vec3Of<R>{};
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    if (loaded.quiet) return;
    Vec3Of<R> a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = place_of(loaded, k);
      b[k] = place_of(loaded, k + 3);
    }
    loaded.opening = opening_of(a, b);
  }
  /// One joint: false, with nothing written, unless it is whole, stays so and slips little, is
  /// dormant, or parted long ago. Of i and its neighbours in a pack: what is left to do.
  template <class R>
  BR_HD auto update(Index i, const Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1)
      return loaded.quiet || stays_whole(i, loaded, false);
    else
      return stay_whole(i, loaded);
  }
  /// A joint that is softened or broken, or becomes so, or slips.
  BR_HD void slow(Index i) const { (*this)(i); }
  BR_HD void operator()(Index i) const {
    Loaded<double> loaded;
    load_early(i, loaded);
    load_late(i, loaded);
    if (!loaded.quiet && !stays_whole(i, loaded, true)) fail_or_soften(i, loaded);
  }
  /// Whether a whole joint would not stay so if its strength were a part of it.
  BR_HD bool is_about_to_soften(Index i) const {
    constexpr double share = 0.7;  // of its strength
    if (stage[i] != JointStage::whole) return false;
    Loaded<double> loaded;
    load_early(i, loaded);
    if (loaded.quiet) return false;
    load_late(i, loaded);
    loaded.strength = share * loaded.strength;
    return whole(loaded).beyond;
  }

  /// The rest of the work for a joint of a pack that slips.
  void book_slip(Index i) const {
    const JointEnds ends = ends_of(i);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = node(ends.a[k]).position;
      b[k] = node(ends.b[k]).position;
    }
    book_drag(i, bonds[law[i]], preset.size > 0 ? preset[i] : Vec3{}, ends, opening_of(a, b));
  }

 private:
  /// Stress at the start of the rock at a joint: the mean of its two tetrahedra's.  [Pa]
  BR_HD Sym3 start_of(Index i) const {
    const Sym3 &a = graded[id[face_a[i] / 4]].preset, &b = graded[id[face_b[i] / 4]].preset;
    return {0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.zz + b.zz),
            0.5 * (a.yz + b.yz), 0.5 * (a.xz + b.xz), 0.5 * (a.xy + b.xy)};
  }
  template <class R>
  BR_HD Sym3Of<R> graded_start(Index i) const {
    double own[6][width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) {
      const Sym3 at = start_of(i + k);
      const double parts[6] = {at.xx, at.yy, at.zz, at.yz, at.xz, at.xy};
      for (int c = 0; c < 6; ++c) own[c][k] = parts[c];
    }
    return {pack_of<R>(own[0]), pack_of<R>(own[1]), pack_of<R>(own[2]),
            pack_of<R>(own[3]), pack_of<R>(own[4]), pack_of<R>(own[5])};
  }
  BR_HD const NodeState& node(Index n) const { return nodes[n / 4].at[n % 4]; }
  BR_HD JointEnds ends_of(Index i) const {
    return JointEnds::of(read_now(&face_a[i]), read_now(&face_b[i]), turn[i]);
  }
  /// Corner k of side a, or k - 3 of side b.  [m]
  template <class R>
  BR_HD Vec3Of<R> place_of(const Loaded<R>& loaded, int k) const {
    if constexpr (width_of<R> == 1) {
      return node(k < 3 ? loaded.ends.a[k] : loaded.ends.b[k - 3]).position;
    } else {
      R numbers[4];  // and x of the velocity
      gather_parts<TetrahedronNodes, NodeState>(nodes, loaded.corner[k], numbers);
      return {numbers[0], numbers[1], numbers[2]};
    }
  }
  BR_HD static bool is_zero(const JointForce& f) {
    return dot(f.at[0], f.at[0]) + dot(f.at[1], f.at[1]) + dot(f.at[2], f.at[2]) == 0.0;
  }
  /// On the corners of side a.
  template <class R>
  BR_HD static void share(const Vec3Of<R> (&traction)[3], const R& area, Vec3Of<R> (&f)[3]) {
    // Point q lies between corners q and q + 1, which bear half of its third each.
    const R weight = -area / 6.0;
    f[0] = weight * (traction[0] + traction[2]);
    f[1] = weight * (traction[1] + traction[0]);
    f[2] = weight * (traction[2] + traction[1]);
  }
  /// @returns the pressure of the corners that press (PressedCorner)  [N]
  BR_HD static double press_corners(const JointBond& bond, double h, double area,
                                    const Vec3& normal, const double (&open)[3],
                                    const JointPoints& state, JointForce& f) {
    double sum = 0.0;
    for (int q = 0; q < 3; ++q) {
      const PressedCorner corner = PressedCorner::of(open, q);
      const double damage = state.point[q].damage;
      if (!(damage > 0.0) || !corner.presses()) continue;
      const double pressed = corner_spring(bond, h, area, damage) * corner.depth;
      f.at[(q + 2) % 3] += pressed * normal;
      sum += pressed;
    }
    return sum;
  }

  /// Joints as long as they are whole.
  template <class R>
  struct Whole {
    using Mask = decltype(R{} < R{});
    Vec3Of<R> force[3];  ///< on the corners of side a  [N]
    Mask beyond;         ///< it does not stay so: its forces mean nothing
    Mask drags;          ///< it slips enough for book_drag()
  };
  template <class R>
  BR_HD Whole<R> whole(const Loaded<R>& loaded) const {
    const JointOpeningOf<R>& o = loaded.opening;
    R bond[12];
    gather_records(bonds, loaded.law, bond);
    const R slope = bond[0] / loaded.length, friction = bond[3];
    const R tension = bond[1] * loaded.strength, cohesion = bond[2] * loaded.strength;
    const R quarter = 0.25 / tension, area = loaded.shape.area(), zero = constant<R>(0.0);
    const Vec3Of<R> slip = slip_in_space(o, loaded.offset);
    Whole<R> w;
    w.beyond = !(o.twice > 2e-12 * area);
    w.drags = w.beyond;
    Vec3Of<R> traction[3], mean{};
    for (int q = 0; q < 3; ++q) {
      const Vec3Of<R> slide = o.slide[q] + slip;
      const R straight = slope * (o.open[q] + loaded.offset.x), size = slope * norm(slide);
      const R resists = cohesion - friction * min(straight, zero);
      w.beyond = w.beyond || straight > 2.0 * tension || size > 2.0 * resists;
      w.drags = w.drags || size > fdem::least_drag * resists;
      const R normal = select(straight < 0.0, straight, straight * (1.0 - straight * quarter));
      traction[q] = normal * o.normal + (slope * (1.0 - size * (0.25 / resists))) * slide;
      mean += traction[q];
    }
    const R young = bond[8];
    const auto by_rock = young > 0.0;
    if (any(by_rock)) {
      const R third = constant<R>(1.0 / 3.0);
      Sym3Of<R> start{zero + in_situ.xx, zero + in_situ.yy, zero + in_situ.zz,
                      zero + in_situ.yz, zero + in_situ.xz, zero + in_situ.xy};
      if (graded.size > 0) start = graded_start<R>(loaded.number);
      const RockStressOf<R> s = rock_stress(young, bond[9], loaded.shape, o, third * mean, start);
      w.beyond = w.beyond || (by_rock && may_fail(tension, cohesion, friction, s));
    }
    share(traction, area, w.force);
    return w;
  }

  /// A joint that is whole, nearly every one. @returns false, with nothing written, if it does not
  /// stay so, or slips and this is not booked
  /// @param books  for which the length of the step must be known
  BR_HD bool stays_whole(Index i, const Loaded<double>& loaded, bool books) const {
    if (loaded.before != JointStage::whole) return false;
    const Whole<double> now = whole(loaded);
    if (now.beyond || (now.drags && !books)) return false;
    force[i] = {{now.force[0], now.force[1], now.force[2]}};
    if (now.drags) book_drag(i, bonds[loaded.law.at], loaded.offset, loaded.ends, loaded.opening);
    return true;
  }
  template <class R>
  Left stay_whole(Index i, const Loaded<R>& loaded) const {
    constexpr unsigned all = (1U << width_of<R>)-1U;
    Left left{all, 0};
    if (loaded.quiet) return left;
    const Whole<R> now = whole(loaded);
    left.others = 0;
    for (Index k = 0; k < width_of<R>; ++k) {
      if (stage[i + k] != JointStage::whole || now.beyond[k] != 0)
        left.others |= 1U << k;
      else if (now.drags[k] != 0)
        left.drags |= 1U << k;
    }
    if (left.others == all) return left;
    const R numbers[9] = {now.force[0].x, now.force[0].y, now.force[0].z,
                          now.force[1].x, now.force[1].y, now.force[1].z,
                          now.force[2].x, now.force[2].y, now.force[2].z};
    store_odd_but(left.others, force, i, numbers);
    return left;
  }

  /// Finds or makes the record of a joint. False if there is no room: it waits, with nothing
  /// written.
  BR_HD bool has_record(Index i, JointFailure*& kept) const {
    kept = failure.find_or_make(i);
    if (kept == nullptr && host_request != nullptr) *host_request = fdem_shared::request_room;
    return kept != nullptr;
  }
  BR_HD void fail_or_soften(Index i, const Loaded<double>& loaded) const {
    const JointStage before = loaded.before;
    const JointEnds& e = loaded.ends;
    const JointOpening& o = loaded.opening;
    const Vec3& offset = loaded.offset;
    const JointForce& last = loaded.last;
    const double area = shape[i].area(), h = length[i];
    const bool collapsed = !(o.twice > 2e-12 * area);
    Vec3 way[3];
    for (int k = 0; k < 3; ++k) way[k] = dt * (node(e.a[k]).velocity - node(e.b[k]).velocity);
    if (is_parted(before) || collapsed) {
      JointFailure* kept = nullptr;
      if (!is_parted(before) && !has_record(i, kept)) return;
      if (before == JointStage::whole) begin_work(i, bonds[law[i]], offset, e);
      JointOpening flat = o;
      if (collapsed) flat.normal = {};  // it has none: all is sliding
      book_work(i, flat, way, last, JointForce{});
      if (kept != nullptr) finish(i, *kept);
      force[i] = {};
      return;
    }
    const JointBond& bond = bonds[law[i]];
    JointPoints state{};
    if (before != JointStage::whole) state = failure.part<&JointFailure::points>(i);
    const Vec3 slip = slip_in_space(o, offset);
    fdem::BondTraction<double> bond_traction[3];
    double open[3], slid[3];
    Vec3 slide[3];
    for (int q = 0; q < 3; ++q) {
      slide[q] = o.slide[q] + slip;
      slid[q] = norm(slide[q]);
      open[q] = o.open[q] + offset.x;
    }
    const bool asks_rock =
        bond.by_rock() && fdem::failure_of(state.point[1]) == fdem::Failure::none;
    if (!asks_rock || fails_with_rock(i, bond, o, open, slid, slide, state, bond_traction))
      for (int q = 0; q < 3; ++q)
        bond_traction[q] = fdem::response(bond, strength[i], h, open[q], slid[q], state.point[q]);
    Vec3 traction[3], drag{};
    double pressure = 0.0;
    int failed = 0;
    bool damaged = false;
    for (int q = 0; q < 3; ++q) {
      const Vec3 sideways = slid[q] > 0.0 ? (bond_traction[q].shear / slid[q]) * slide[q] : Vec3{};
      traction[q] = bond_traction[q].normal * o.normal + sideways;
      pressure -= area / 3.0 * bond_traction[q].normal;
      drag -= (area / 3.0) * sideways;
      failed += state.point[q].damage >= 1.0 ? 1 : 0;
      damaged = damaged || state.point[q].damage > 0.0;
    }
    JointFailure* kept = nullptr;
    if (damaged && !has_record(i, kept)) return;
    if (before == JointStage::whole) {
      if (damaged)
        begin_work(i, bond, offset, e);
      else
        book_drag(i, bond, offset, e, o);
    }
    JointForce now;
    share(traction, area, now.at);
    if (damaged) pressure += press_corners(bond, h, area, o.normal, open, state, now);
    force[i] = now;
    if (damaged) {
      book_work(i, o, way, last, force[i]);
      if (bond.residual > 0.0) book_friction(i, bond, offset, last_opening(e), o, state, *kept);
      kept->points = state;
      if (before == JointStage::whole) {
        stage[i] = JointStage::softened;
        fdem::raise(changed, fdem::change_softened);
      }
    }
    if (failed >= 2) {
      kept->pressing = max(0.0, pressure);
      kept->shear_at_break = drag;
      kept->held = {};
      for (int q = 0; q < 3; ++q)
        kept->held.add(area / 3.0, fdem::stored_pressed(bond, strength[i], h, open[q], slid[q],
                                                        state.point[q]));
      finish(i, *kept);
    }
  }

  /// Lets all points of a joint fail where the mean stress of the rock there fails near its face.
  /// @param bond_traction  of its points by the law of faces
  /// @returns false where it does not fail: `state` and `bond_traction` are those of this step then
  BR_HD bool fails_with_rock(Index i, const JointBond& bond, const JointOpening& o,
                             const double (&open)[3], const double (&slid)[3],
                             const Vec3 (&slide)[3], JointPoints& state,
                             fdem::BondTraction<double> (&bond_traction)[3]) const {
    const double h = length[i], share = strength[i];
    Vec3 mean{};
    bool half_soft = false;  // it goes its own way to the end
    for (int q = 0; q < 3; ++q) {
      fdem::BondState<double>& point = state.point[q];
      bond_traction[q] = fdem::response(bond, share, h, open[q], slid[q], point);
      mean += bond_traction[q].normal * o.normal;
      if (slid[q] > 0.0) mean += (bond_traction[q].shear / slid[q]) * slide[q];
      half_soft = half_soft || (point.damage > 0.0 && fdem::softening(point.damage) < 0.5);
    }
    if (half_soft) return false;
    const RockStress s = rock_stress(bond.young, bond.poisson, shape[i], o, (1.0 / 3.0) * mean,
                                     graded.size > 0 ? start_of(i) : in_situ);
    const fdem::Failure how = fdem::failure_of(rock_failure(bond, share, s));
    if (how == fdem::Failure::none) return false;
    for (int q = 0; q < 3; ++q)
      fdem::fail(bond, share, h, how, open[q], slid[q], bond_traction[q], state.point[q]);
    return true;
  }

  /// Its opening a step before.
  BR_HD JointOpening last_opening(const JointEnds& e) const {
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = node(e.a[k]).position - dt * node(e.a[k]).velocity;
      b[k] = node(e.b[k]).position - dt * node(e.b[k]).velocity;
    }
    return opening_of(a, b);
  }
  /// A joint that softens in this step had stored this much before it: with what it had spent, all
  /// that it had taken up.
  BR_HD void begin_work(Index i, const JointBond& bond, const Vec3& offset,
                        const JointEnds& e) const {
    const fdem::StoredEnergy held = stored_in(bond, strength[i], length[i], shape[i].area(), offset,
                                              last_opening(e), JointPoints{});
    work[i].open += held.open;
    work[i].slide += held.slide;
  }
  /// A joint that stays whole books what pressure that changes takes on its slip
  /// (docs/theory-fdem.md, 2).
  BR_HD void book_drag(Index i, const JointBond& bond, const Vec3& offset, const JointEnds& e,
                       const JointOpening& o) const {
    const JointOpening before = last_opening(e);
    const Vec3 slip_before = slip_in_space(before, offset), slip = slip_in_space(o, offset);
    const double slope = bond.stiffness / length[i], cohesion = bond.cohesion * strength[i];
    double sum = 0.0;
    for (int q = 0; q < 3; ++q)
      sum += fdem::spent_by_pressure<double>(
          slope, cohesion, bond.friction, {before.open[q] + offset.x, o.open[q] + offset.x},
          {norm(before.slide[q] + slip_before), norm(o.slide[q] + slip)});
    work[i].slide += shape[i].area() / 3.0 * sum;
  }
  /// Work of this step by the trapezoidal rule: with leapfrog velocities it sums to exactly what
  /// the nodes lose.
  BR_HD void book_work(Index i, const JointOpening& o, const Vec3 (&way)[3], const JointForce& last,
                       const JointForce& now) const {
    double open = 0.0, all = 0.0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 f = last.at[k] + now.at[k];
      open += dot(f, o.normal) * dot(way[k], o.normal);
      all += dot(f, way[k]);
    }
    JointWork& w = work[i];
    w.open -= 0.5 * open;
    w.slide -= 0.5 * (all - open);
  }
  /// Of the work of this step, that of residual friction, by the trapezoidal rule.
  /// @param state  its points now  @param kept  those of the step before
  BR_HD void book_friction(Index i, const JointBond& bond, const Vec3& offset,
                           const JointOpening& before, const JointOpening& now,
                           const JointPoints& state, JointFailure& kept) const {
    const double h = length[i];
    const Vec3 slip_before = slip_in_space(before, offset), slip = slip_in_space(now, offset);
    double sum = 0.0;
    for (int q = 0; q < 3; ++q) {
      const double from = norm(before.slide[q] + slip_before), to = norm(now.slide[q] + slip);
      const double began = fdem::residual_traction(bond, strength[i], h, before.open[q] + offset.x,
                                                   from, kept.points.point[q]);
      const double ended =
          fdem::residual_traction(bond, strength[i], h, now.open[q] + offset.x, to, state.point[q]);
      sum += 0.5 * (began + ended) * (to - from);
    }
    kept.rubbed += shape[i].area() / 3.0 * sum;
  }
  BR_HD void finish(Index i, JointFailure& kept) const {
    stage[i] = JointStage::broken;
    kept.broke_at = time;
    fdem::raise(changed, fdem::change_broken);
  }
};

/// Joints that found no room for their records, when there is some.
struct WaitingJoints {
  static constexpr const char* name = "fdem3.waiting_joints";
  JointForces joints;
  BR_HD void set(const StepTime& now) { joints.set(now); }
  BR_HD void operator()(Index i) const {
    if (joints.failure.waits(i)) joints(i);
  }
};

}  // namespace breccia::fdem3
