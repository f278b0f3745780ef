#pragma once
// The kernel of all joints: reads, one law call, one write.

#include "core/kernel.hpp"
#include "fdem/joints/elastic_joints.hpp"
#include "fdem_shared/exposed.hpp"

namespace breccia::fdem {

using fdem_shared::Change;
using fdem_shared::change_broken;
using fdem_shared::change_softened;
using fdem_shared::marking_due;
using fdem_shared::raise;
using fdem_shared::set_flag;

/// Tractions at three points, damage and break of every joint (Lukas 2014, section 2). Joints that
/// are whole and stay so, nearly all, are taken side by side.
/// @tparam Number  what their forces are stored in, and Single, too, what whole ones are computed
///                 in
template <class Number>
struct JointForces {
  static constexpr const char* name = "fdem.joints";
  using Stores = StoredAs<Number>;
  using Computed = ComputedIn<Number>;
  static constexpr bool in_single = is_single<Computed>;
  double time, dt;  ///< of the positions, and the step that led there  [s]
  View<const NodeState> nodes;
  View<const JointBond> bonds;
  View<const BondOf<float>> bonds_in_single;  ///< where they are computed so
  View<const JointEnds> ends;
  View<const Index> law;
  View<const double> length, strength;
  View<const Vec2> preset;
  Sym2 in_situ;                        ///< stress at the start  [Pa]
  View<const ElasticTriangle> graded;  ///< laws that hold it by global id; empty: it has no slope
  View<const GlobalId> id;             ///< of triangles
  View<JointStage> stage;
  View<JointPoints> points;
  View<JointForceOf<Stores>> force;
  View<JointWork> work;
  View<double> broke_at;
  View<JointHandover> handover;
  View<double> rubbed;
  View<std::uint8_t> changed;  ///< flags of Change: contacts must be searched

  template <class R>
  struct Loaded {
    Indices<R> end[4], law;  ///< corners a0, a1, b0, b1
    R length, strength;
    JointStage stage;  ///< of a pack: whole if one is
    R corner[4][4];    ///< position and velocity
    R start[3];        ///< stress at the start, if it has a slope  [Pa]
  };
  /// A pack that is computed in single precision.
  template <class V>
  struct Loaded<SingleOf<V>> {
    using R = SingleOf<V>;
    Loaded<PartOf<R>> part[PartsOf<R>::count];
    JointStage stage;
  };
  /// Of joints in a pack, a bit for each.
  struct Left {
    unsigned others;  ///< those of which nothing is written: for slow()
    unsigned drags;   ///< those that must book_slips()
  };
  BR_HD void set(const StepTime& now) {
    time = now.time;
    dt = now.last_dt;
  }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.stage = stage[i];
    for (Index k = 1; k < width_of<R>; ++k)
      if (stage[i + k] == JointStage::whole) loaded.stage = JointStage::whole;
    if (!left<R>(loaded)) load_constants(i, loaded);
  }
  template <class R>
  BR_HD void load_constants(Index i, Loaded<R>& loaded) const {
    if constexpr (is_single<R>) {
      each_part(i, loaded, [this](Index first, auto& part) {
        part.stage = JointStage::whole;
        load_constants(first, part);
      });
    } else {
      Index at[4][width_of<R>];
      list_ends<R>(ends, i, at);
      for (int k = 0; k < 4; ++k) loaded.end[k] = indices<R>(at[k]);
      loaded.law = load_indices_now<R>(law, i);
      if (graded.size > 0) load_start(i, loaded.start);
      loaded.length = load_now<R>(length, i);
      loaded.strength = load_now<R>(strength, i);
    }
  }
  template <class R>
  BR_HD void load_late(Index i, Loaded<R>& loaded) const {
    if (left<R>(loaded)) return;
    if constexpr (is_single<R>)
      each_part(i, loaded, [this](Index first, auto& part) { load_late(first, part); });
    else
      for (int k = 0; k < 4; ++k) gather_records_now(nodes, loaded.end[k], loaded.corner[k]);
  }
  /// One joint: false, with nothing written, unless it is whole, stays so and slips little under
  /// pressure, is dormant, or parted and without a force. Of i and its neighbours in a pack: what
  /// is left to do.
  template <class R>
  BR_HD auto update(Index i, const Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1) {
      return is_quiet(i, loaded) || stays_whole(i, loaded, false);
    } else {
      constexpr unsigned all = (1U << width_of<R>)-1U;
      if (left<R>(loaded)) return Left{all, 0};
      const WholeOf<R> now = whole_in_run(i, loaded);
      Left still{0, 0};
      for (Index k = 0; k < width_of<R>; ++k) {
        if (stage[i + k] != JointStage::whole || now.beyond[k] != 0)
          still.others |= 1U << k;
        else if (now.drags[k] != 0)
          still.drags |= 1U << k;
      }
      if (still.others == 0)
        store_four<Stores>(force, i, now.force);
      else if (still.others != all)
        store_but(still.others, i, now.force);
      return still;
    }
  }

  /// One joint: false only where it softens, breaks, or has a force though it is parted.
  BR_HD bool update_at(const StepTime& now, Index i, const Loaded<double>& loaded) const {
    return update_by(i, loaded,
                     [&, this] { work[i].slide += spent_on_slips(i, loaded, now.last_dt); });
  }
  /// As that. @param book  books the slip of a joint that stays whole
  template <class Book>
  BR_HD bool update_by(Index i, const Loaded<double>& loaded, const Book& book) const {
    if (is_quiet(i, loaded)) return true;
    if (loaded.stage != JointStage::whole) return false;
    const WholeOf<Computed> w = whole_in_run(i, loaded);
    if (w.beyond) return false;
    if (w.drags) book();
    store_four<Stores>(force, i, w.force);
    return true;
  }

  BR_HD void operator()(Index i) const {
    if (!run_at<double>(*this, i)) slow(i);
  }
  /// Whether a whole joint would not stay so if its strength were a part of it.
  BR_HD bool is_about_to_soften(Index i) const {
    constexpr double share = 0.7;  // of its strength
    if (stage[i] != JointStage::whole) return false;
    Loaded<double> loaded;
    load_early(i, loaded);
    load_late(i, loaded);
    loaded.strength = share * loaded.strength;
    return whole(i, loaded).beyond;
  }

  /// A joint that is softened or broken, or becomes so, or slips under pressure.
  BR_HD void slow(Index i) const {
    const JointStage before = stage[i];
    if (before == JointStage::dormant) return;
    if (before == JointStage::whole) {
      Loaded<double> loaded;
      load_early(i, loaded);
      load_late(i, loaded);
      if (stays_whole(i, loaded, true)) return;
    }
    if (is_parted(before) && !acts(i)) return;
    const JointEnds& e = ends[i];
    const NodeState &a0 = nodes[e.a0], &a1 = nodes[e.a1], &b0 = nodes[e.b0], &b1 = nodes[e.b1];
    const Vec2 first = dt * (a0.velocity - b0.velocity), second = dt * (a1.velocity - b1.velocity);
    const JointOpening<double> o = opening_of(a0.position, a1.position, b0.position, b1.position);
    const double h = length[i];
    const bool collapsed = !(o.size > 1e-12 * h);  // of the middle line no length is left
    if (is_parted(before) || collapsed) {
      if (!collapsed) book_work(i, o, first, second, JointForce{});
      if (!is_parted(before)) finish(i);
      force[i] = {};
      return;
    }
    const JointBond& bond = bonds[law[i]];
    const Vec2 offset = preset.size > 0 ? preset[i] : Vec2{};
    JointPoints state{};
    if (before != JointStage::whole) state = points[i];
    BondTraction<double> bond_traction[3];
    const bool asks_rock = bond.by_rock() && failure_of(state.point[1]) == Failure::none;
    if (!asks_rock || fails_with_rock(i, bond, o, offset, state, bond_traction))
      for (int q = 0; q < 3; ++q)
        bond_traction[q] = response(bond, strength[i], h, o.open[q] + offset.x,
                                    o.slide[q] + offset.y, state.point[q]);
    double pressure = 0.0, drag = 0.0;
    int failed = 0;
    bool damaged = false;
    for (int q = 0; q < 3; ++q) {
      const BondTraction<double>& t = bond_traction[q];
      const double weight = (q == 1 ? -4.0 : -1.0) * h / 6.0;
      pressure += weight * t.normal;
      drag += weight * t.shear;
      failed += state.point[q].damage >= 1.0 ? 1 : 0;
      damaged = damaged || state.point[q].damage > 0.0;
    }
    // Work is booked of the forces that act: as they are stored.
    JointForceOf<Stores> now = converted<Stores>(force_of(bond_traction, o, h));
    if (before == JointStage::whole) {
      if (damaged)
        begin_work(i, bond, offset, a0, a1, b0, b1);
      else
        book_slips<double>(i, 1);
    }
    if (damaged) {
      book_work(i, o, first, second, converted<double>(as_in_memory(now)));
      if (bond.residual > 0.0)
        book_friction(i, bond, offset, last_opening(a0, a1, b0, b1), o, state);
      points[i] = state;
      if (before == JointStage::whole) {
        stage[i] = JointStage::softened;
        raise(changed, change_softened);
      }
    }
    force[i] = now;
    if (failed >= 2) {
      JointHandover over{max(0.0, pressure), drag, {}};
      for (int q = 0; q < 3; ++q)
        over.held.add(weight_of(q) * h, stored_pressed(bond, strength[i], h, o.open[q] + offset.x,
                                                       o.slide[q] + offset.y, state.point[q]));
      handover[i] = over;
      finish(i);
    }
  }

  /// Books what pressure that changes takes on the slip of joints that stay whole
  /// (docs/theory-fdem.md, 2).
  /// @param drags  of i and its neighbours, a bit for each
  template <class R>
  BR_HD void book_slips(Index i, unsigned drags) const {
    book_slips<R>(i, drags, dt);
  }
  /// @param span  of the step  [s]
  template <class R>
  BR_HD void book_slips(Index i, unsigned drags, double span) const {
    Loaded<R> loaded;
    load_early(i, loaded);
    load_late(i, loaded);
    const R sum = spent_on_slips(i, loaded, span);
    if constexpr (width_of<R> == 1) {
      work[i].slide += sum;
    } else {
      for (Index k = 0; k < width_of<R>; ++k)
        if ((drags >> k & 1U) != 0) work[i + k].slide += sum[k];
    }
  }

  /// That work of a joint in a step.  [J/m]
  /// @param span  of the step  [s]
  template <class R>
  BR_HD R spent_on_slips(Index i, const Loaded<R>& loaded, double span) const {
    const ElasticBond<R> elastic = elastic_law(i, loaded);
    const JointOpening<R> now = opening<R>(loaded, 0.0), before = opening<R>(loaded, span);
    return spent_by_pressures<R>(elastic.slope, elastic.cohesion, elastic.bond[3], loaded.length,
                                 before, now, elastic.offset);
  }
  template <class R>
  BR_HD ElasticBond<R> elastic_law(Index i, const Loaded<R>& loaded) const {
    ElasticBond<R> elastic;
    gather_records(bonds, loaded.law, elastic.bond);
    offset_of(i, elastic.offset);
    elastic.derive(loaded.length, loaded.strength);
    return elastic;
  }
  /// Forces of whole joints from their points, and whether the rock there may fail.
  template <class R>
  BR_HD void add_points(const Loaded<R>& loaded, const ElasticBond<R>& elastic,
                        const JointOpening<R>& o, const BondTraction<R> (&t)[3],
                        WholeOf<R>& w) const {
    const R& h = loaded.length;
    fdem::add_points(h, elastic, o, t, w, [&](const R& normal, const R& shear) {
      const R stretch = o.size / h - 1.0;
      const auto along_from = [&](const auto& start) {
        return elastic.along(o.along, stretch, normal, shear, start);
      };
      return graded.size > 0
                 ? along_from(Sym2Of<R>{loaded.start[0], loaded.start[1], loaded.start[2]})
                 : along_from(in_situ);
    });
  }
  /// A joint that is whole, or a pack, in the precision of the run. @param loaded  of R numbers, of
  /// one joint always in double
  template <class R>
  BR_HD auto whole_in_run(Index i, const Loaded<R>& loaded) const {
    if constexpr (!in_single) {
      return whole(i, loaded);
    } else {
      using S = std::conditional_t<width_of<R> == 1, Single, R>;
      constexpr Index width = width_of<PartOf<S>>;
      Index laws[width_of<S>];
      const auto wide = parts_by<S>([&](Index p) {
        const auto& part = part_of(loaded, p);
        __builtin_memcpy(laws + p * width, &part.law, width * sizeof(Index));
        return differences(i + p * width, part);
      });
      return whole_in_single<S>(bonds_in_single, laws, narrowed_record<S>(wide.part));
    }
  }

  /// How the rock at a joint fails under the tractions of its points.
  BR_HD Failure rock_failure_at(Index i, const JointBond& bond, const JointOpening<double>& o,
                                const BondTraction<double> (&t)[3]) const {
    double normal = 0.0, shear = 0.0;
    for (int q = 0; q < 3; ++q) {
      normal += weight_of(q) * t[q].normal;
      shear += weight_of(q) * t[q].shear;
    }
    const double along =
        stress_along(o.along, o.size / length[i] - 1.0, normal, shear, bond.young, bond.poisson,
                     bond.skew, graded.size > 0 ? start_of(i) : in_situ);
    return failure_of(rock_failure(bond, strength[i], {normal, shear, along}));
  }
  /// Work of residual friction in a step, of a point in a mean.  [J/m2]
  /// @param from, to  opening and slip before and now  @param last, state  of the point likewise
  BR_HD static double rubbed_at(int q, const JointBond& bond, double share, double h,
                                const Vec2& from, const Vec2& to, const BondState<double>& last,
                                const BondState<double>& state) {
    const double began = residual_traction(bond, share, h, from.x, from.y, last);
    const double ended = residual_traction(bond, share, h, to.x, to.y, state);
    return weight_of(q) * 0.5 * (began + ended) * (to.y - from.y);
  }
  /// Work of this step by the trapezoidal rule: with leapfrog velocities it sums to exactly what
  /// the nodes lose.
  BR_HD void book_work(Index i, const JointOpening<double>& o, const Vec2& first,
                       const Vec2& second, const JointForce& now) const {
    const JointForce last = converted<double>(force[i]);
    const Vec2 f = last.first + now.first, s = last.second + now.second;
    JointWork& w = work[i];
    w.open -=
        0.5 * (dot(f, o.normal) * dot(first, o.normal) + dot(s, o.normal) * dot(second, o.normal));
    w.slide -=
        0.5 * (dot(f, o.along) * dot(first, o.along) + dot(s, o.along) * dot(second, o.along));
  }
  /// @param ago  how long before the positions  [s]
  template <class R>
  BR_HD static JointOpening<R> opening(const Loaded<R>& loaded, double ago) {
    const auto at = [&](int k) {
      const R(&c)[4] = loaded.corner[k];
      return ago > 0.0 ? Vec2Of<R>{c[0] - ago * c[2], c[1] - ago * c[3]} : Vec2Of<R>{c[0], c[1]};
    };
    return opening_of(at(0), at(1), at(2), at(3));
  }

 private:
  /// Whether the force of its last evaluation is other than zero.
  BR_HD bool acts(Index i) const {
    const JointForce last = converted<double>(force[i]);
    return dot(last.first, last.first) + dot(last.second, last.second) > 0.0;
  }
  /// Whether none of a pack is whole.
  template <class R>
  BR_HD static bool left(const Loaded<R>& loaded) {
    return width_of<R> != 1 && loaded.stage != JointStage::whole;
  }
  template <class R>
  void store_but(unsigned others, Index i, const R (&numbers)[4]) const {
    for (Index k = 0; k < width_of<R>; ++k) {
      if ((others >> k & 1U) != 0) continue;
      if constexpr (is_single<R>) {
        force[i + k] = {{numbers[0].v[k], numbers[1].v[k]}, {numbers[2].v[k], numbers[3].v[k]}};
      } else {
        const double own[4] = {numbers[0][k], numbers[1][k], numbers[2][k], numbers[3][k]};
        store_four<Stores>(force, i + k, own);
      }
    }
  }
  template <class R>
  BR_HD void offset_of(Index i, R (&offset)[2]) const {
    offset[0] = offset[1] = constant<R>(0.0);
    if (preset.size > 0) gather_records(preset, consecutive<R>(i), offset);
  }
  /// Whether a joint has nothing to do: it is dormant, or parted and without a force.
  BR_HD bool is_quiet(Index i, const Loaded<double>& loaded) const {
    return loaded.stage == JointStage::dormant || (is_parted(loaded.stage) && !acts(i));
  }
  /// A joint that is whole, nearly every one. @returns false, with nothing written, if it does not
  /// stay so, or slips under pressure and this is not booked
  /// @param books  for which the length of the step must be known
  BR_HD bool stays_whole(Index i, const Loaded<double>& loaded, bool books) const {
    if (loaded.stage != JointStage::whole) return false;
    const WholeOf<Computed> now = whole_in_run(i, loaded);
    if (now.beyond || (now.drags && !books)) return false;
    store_four<Stores>(force, i, now.force);
    if (now.drags) book_slips<double>(i, 1);
    return true;
  }
  template <class R>
  BR_HD WholeOf<R> whole(Index i, const Loaded<R>& loaded) const {
    const JointOpening<R> o = opening(loaded, 0.0);
    const ElasticBond<R> elastic = elastic_law(i, loaded);
    WholeOf<R> w;
    BondTraction<R> t[3];
    elastic.points(o, loaded.length, t, w);
    add_points(loaded, elastic, o, t, w);
    return w;
  }
  template <class W>
  BR_HD JointDifferences<W> differences(Index i, const Loaded<W>& loaded) const {
    W offset[2];
    offset_of(i, offset);
    const Sym2Of<W> even{constant<W>(in_situ.xx), constant<W>(in_situ.yy), constant<W>(in_situ.xy)};
    return differences_of(
        loaded.corner, loaded.length, loaded.strength, offset,
        graded.size > 0 ? Sym2Of<W>{loaded.start[0], loaded.start[1], loaded.start[2]} : even);
  }
  template <class R>
  BR_HD static const auto& part_of(const Loaded<R>& loaded, [[maybe_unused]] Index which) {
    if constexpr (is_single<R>)
      return loaded.part[which];
    else
      return loaded;
  }
  /// visit(first joint, part) for the parts of a pack that is computed in single precision.
  template <class V, class Visit>
  BR_HD static void each_part(Index i, Loaded<SingleOf<V>>& loaded, const Visit& visit) {
    using R = SingleOf<V>;
    for (Index p = 0; p < PartsOf<R>::count; ++p)
      visit(i + p * width_of<PartOf<R>>, loaded.part[p]);
  }
  /// Stress at the start of the rock at a joint: the mean of its two triangles'.  [Pa]
  BR_HD Sym2 start_of(Index i) const {
    const Sym2 &a = graded[id[ends[i].a0 / 3]].preset, &b = graded[id[ends[i].b0 / 3]].preset;
    return {0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.xy + b.xy)};
  }
  template <class R>
  BR_HD void load_start(Index i, R (&start)[3]) const {
    double own[3][width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) {
      const Sym2 at = start_of(i + k);
      own[0][k] = at.xx;
      own[1][k] = at.yy;
      own[2][k] = at.xy;
    }
    for (int c = 0; c < 3; ++c) start[c] = pack_of<R>(own[c]);
  }
  /// Lets all points of a joint fail where the mean stress of the rock there fails near its edge.
  /// @param bond_traction  of its points by the law of edges
  /// @returns false where it does not fail: `state` and `bond_traction` are those of this step then
  BR_HD bool fails_with_rock(Index i, const JointBond& bond, const JointOpening<double>& o,
                             const Vec2& offset, JointPoints& state,
                             BondTraction<double> (&bond_traction)[3]) const {
    const double h = length[i], share = strength[i];
    bool half_soft = false;  // it goes its own way to the end
    for (int q = 0; q < 3; ++q) {
      BondState<double>& point = state.point[q];
      bond_traction[q] =
          response(bond, share, h, o.open[q] + offset.x, o.slide[q] + offset.y, point);
      half_soft = half_soft || is_half_soft(point);
    }
    if (half_soft) return false;
    const Failure how = rock_failure_at(i, bond, o, bond_traction);
    if (how == Failure::none) return false;
    for (int q = 0; q < 3; ++q)
      fail(bond, share, h, how, o.open[q] + offset.x, o.slide[q] + offset.y, bond_traction[q],
           state.point[q]);
    return true;
  }
  /// A step before.
  BR_HD JointOpening<double> last_opening(const NodeState& a0, const NodeState& a1,
                                          const NodeState& b0, const NodeState& b1) const {
    return opening_of(a0.position - dt * a0.velocity, a1.position - dt * a1.velocity,
                      b0.position - dt * b0.velocity, b1.position - dt * b1.velocity);
  }
  /// A joint that softens in this step had stored this much before it: all it had taken up.
  BR_HD void begin_work(Index i, const JointBond& bond, const Vec2& offset, const NodeState& a0,
                        const NodeState& a1, const NodeState& b0, const NodeState& b1) const {
    const StoredEnergy e = stored_in(bond, strength[i], length[i], offset,
                                     last_opening(a0, a1, b0, b1), JointPoints{});
    work[i].open += e.open;
    work[i].slide += e.slide;
  }
  /// Of the work of this step, that of residual friction, by the trapezoidal rule.
  /// @param state  its points now; those of the step before are still kept
  BR_HD void book_friction(Index i, const JointBond& bond, const Vec2& offset,
                           const JointOpening<double>& before, const JointOpening<double>& now,
                           const JointPoints& state) const {
    const double h = length[i];
    double sum = 0.0;
    for (int q = 0; q < 3; ++q)
      sum += rubbed_at(
          q, bond, strength[i], h, {before.open[q] + offset.x, before.slide[q] + offset.y},
          {now.open[q] + offset.x, now.slide[q] + offset.y}, points[i].point[q], state.point[q]);
    rubbed[i] += h * sum;
  }
  BR_HD void finish(Index i) const {
    stage[i] = JointStage::broken;
    broke_at[i] = time;
    raise(changed, change_broken);
  }
};

}  // namespace breccia::fdem
