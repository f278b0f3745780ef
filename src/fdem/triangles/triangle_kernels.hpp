#pragma once
// Kernels of each triangle by itself: its sum of forces, its stable step.

#include "core/kernel.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem/contact/nearness.hpp"
#include "fdem/joints/joint_kernels.hpp"
#include "fdem/triangles/motion.hpp"
#include "fdem_shared/bundles.hpp"
#include "fdem_shared/stable_parts.hpp"

namespace breccia::fdem {

/// The joints on the three edges of a triangle: entries as of an Incidence (pair 2 i + side), or a
/// reason why there is none.
struct EdgeJoints {
  Index at[3];
};
inline constexpr Index edge_free = -1;    ///< on the border, or no law joins the two materials
inline constexpr Index edge_bonded = -2;  ///< the neighbours move as one body: no joint, no contact

/// Internal force of the triangle, plus its joints by slot, plus its couples by the partners'
/// global ids: no order of memory, threads or ranks changes a bit.
/// @tparam Number  what forces of joints and couples are stored in, and Single, too, what internal
///                 forces are computed in
template <class Number>
struct TriangleForces {
  static constexpr const char* name = "fdem.triangles";
  using Stores = StoredAs<Number>;
  static constexpr bool in_single = is_single<ComputedIn<Number>>;
  double span;  ///< time that the forces of this moment act  [s]
  View<const TriangleNodes> nodes;
  View<const Index> law;  ///< place among the laws
  View<const ElasticTriangle> laws;
  View<const ElasticLaw<float>> laws_in_single;  ///< where they are computed so
  View<const Mat2> shape_inverse;
  View<const double> viscosity;
  View<const EdgeJoints> edges;
  View<const JointForceOf<Stores>>
      joint_force;  ///< the last one is zero: that of an edge without a joint
  IncidenceView couples;
  View<const CoupleForceOf<Stores>> couple_force;
  View<const CouplePhase> phase;  ///< of couples: others than those that act have no force
  View<Corners> force;
  View<double> viscous_work;

  template <class R>
  struct Loaded {
    Columns<R, TriangleNodes> nodes;
    Columns<R, Mat2> inverse;
    R viscosity;
    Indices<R> law;
    Index couples, couples_end;  ///< of the first triangle, and of the last
    Index edge[3][width_of<R>];  ///< entries of `edges`
    R joint[3][4];               ///< forces
  };
  /// A pack that is computed in single precision loads part by part.
  template <class V>
  struct Loaded<SingleOf<V>> {};
  BR_HD void set(const StepTime& now) { span = now.last_dt; }
  /// All but forces of joints and couples.
  template <class R>
  BR_HD void load_early(Index t, Loaded<R>& loaded) const {
    if constexpr (!is_single<R>) {
      loaded.nodes.read(nodes, t);
      load_own(t, loaded);
      loaded.nodes.wait();
    }
  }
  /// As that, but for the corners.
  template <class R>
  BR_HD void load_own(Index t, Loaded<R>& loaded) const {
    load_edges(t, loaded);
    loaded.law = load_indices_now<R>(law, t);
    loaded.viscosity = load_now<R>(viscosity, t);
    load_couples(t, loaded);
    loaded.inverse.read(shape_inverse, t);
    loaded.inverse.wait();
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    if constexpr (!is_single<R>)
      for (int k = 0; k < 3; ++k) {
        if constexpr (width_of<R> == 1) {
          const JointForce own =
              converted<double>(read_record_now(&joint_force[joint_of(loaded.edge[k][0])]));
          __builtin_memcpy(loaded.joint[k], &own, sizeof own);
        } else {
          Index joint[width_of<R>];
          for (Index i = 0; i < width_of<R>; ++i) joint[i] = joint_of(loaded.edge[k][i]);
          gather_four<Stores>(joint_force, indices<R>(joint), loaded.joint[k]);
        }
      }
  }
  /// Triangle t, or t and its neighbours in a pack.
  template <class R>
  BR_HD void update(Index t, const Loaded<R>& loaded) const {
    if constexpr (is_single<R>) {
      sum_parts<R>(t, [this](Index first, const auto& total) { write(first, total); });
    } else {
      R total[6];
      sum(t, loaded, total);
      write(t, total);
    }
  }
  BR_HD void operator()(Index t) const { run_at<double>(*this, t); }

  /// The sums, which are not stored.
  template <class R>
  BR_HD void sum(Index t, const Loaded<R>& loaded, R (&total)[6]) const {
    if constexpr (in_single) {
      Vec2Of<R> own[1][3];
      deform_in_single<Single>(t, {loaded.law.at}, {loaded.viscosity}, own,
                               [&loaded](Index, bool bedded) {
                                 return strains_of<R>(loaded.nodes, loaded.inverse, bedded);
                               });
      add_all(t, loaded, own[0], total);
    } else {
      Vec2Of<R> own[3];
      deform(t, loaded, own);
      add_all(t, loaded, own, total);
    }
  }
  /// Sums of a pack that is computed in single precision. Calls visit(first, total) for each part.
  template <class S, class Visit>
  void sum_parts(Index t, const Visit& visit) const {
    using W = PartOf<S>;
    constexpr Index count = PartsOf<S>::count, width = width_of<W>;
    Index at[width_of<S>];
    __builtin_memcpy(at, law.data + t, sizeof at);
    W eta[count];
    for (Index p = 0; p < count; ++p) eta[p] = load<W>(viscosity, t + p * width);
    Vec2Of<W> own[count][3];
    deform_in_single<S>(t, at, eta, own, [this, t](Index p, bool bedded) {
      Columns<W, TriangleNodes> corners;
      Columns<W, Mat2> inverse;
      corners.read(nodes, t + p * width);
      inverse.read(shape_inverse, t + p * width);
      return strains_of<W>(corners, inverse, bedded);
    });
    for (Index p = 0; p < count; ++p) {
      Loaded<W> loaded;
      load_edges(t + p * width, loaded);
      load_couples(t + p * width, loaded);
      load_late(t + p * width, loaded);
      W total[6];
      add_all(t + p * width, loaded, own[p], total);
      visit(t + p * width, total);
    }
  }

 private:
  template <class R>
  BR_HD void write(Index t, const R (&total)[6]) const {
    Columns<R, Corners>::write(force, t, total);
  }
  template <class R>
  BR_HD void load_edges(Index t, Loaded<R>& loaded) const {
    for (int k = 0; k < 3; ++k)
      for (Index i = 0; i < width_of<R>; ++i) loaded.edge[k][i] = read_now(&edges[t + i].at[k]);
  }
  template <class R>
  BR_HD void load_couples(Index t, Loaded<R>& loaded) const {
    loaded.couples = read_now(&couples.starts[t]);
    loaded.couples_end = read_now(&couples.starts[t + width_of<R>]);
  }
  /// Adds forces of joints and couples to internal ones.
  template <class R>
  BR_HD void add_all(Index t, const Loaded<R>& loaded, Vec2Of<R> (&sum)[3], R (&total)[6]) const {
    for (int k = 0; k < 3; ++k)
      add_force(is_b<R>(loaded.edge[k]), loaded.joint[k], sum[k], sum[k == 2 ? 0 : k + 1]);
    if constexpr (width_of<R> == 1) add_couples(loaded.couples, loaded.couples_end, sum);
    for (int k = 0; k < 3; ++k) {
      total[2 * k] = sum[k].x;
      total[2 * k + 1] = sum[k].y;
    }
    if (width_of<R> != 1 && loaded.couples < loaded.couples_end) add_couples(t, total);
  }
  /// Internal forces on the corners, and the work of viscosity.
  template <class R>
  BR_HD void deform(Index t, const Loaded<R>& loaded, Vec2Of<R> (&sum)[3]) const {
    const CornersOf<R> c(loaded.nodes.numbers);
    const R(&inverse)[4] = loaded.inverse.numbers;
    const R& eta = loaded.viscosity;
    R numbers[8];
    gather_records(laws, loaded.law, numbers);
    const ElasticLaw<R> elastic{numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4]},
                                numbers[5], numbers[6], numbers[7]};
    const Deformation<R> d =
        deformation(Mat2Of<R>{inverse[0], inverse[1], inverse[2], inverse[3]}, c.x, c.v);
    corner_forces(elastic.stress(d, eta), c.x, sum);
    if (any(eta > 0.0)) {
      const Mat2Of<R>& l = d.velocity_gradient;
      const Sym2Of<R> rate{l.xx, l.yy, 0.5 * (l.xy + l.yx)};
      const R area = 0.5 * cross(c.x[1] - c.x[0], c.x[2] - c.x[0]);
      store(viscous_work, t, load<R>(viscous_work, t) + span * (eta * area * contract(rate, rate)));
    }
  }
  template <class R>
  BR_HD static TriangleStrains<R> strains_of(const Columns<R, TriangleNodes>& nodes,
                                             const Columns<R, Mat2>& inverse, bool bedded) {
    const CornersOf<R> c(nodes.numbers);
    const R(&i)[4] = inverse.numbers;
    return strains(Mat2Of<R>{i[0], i[1], i[2], i[3]}, c.x, c.v, bedded);
  }
  /// As deform(), in single precision. @param at, viscosities  of each
  /// @param measure  measure(p, bedded): the strains of part p in double
  template <class S, class Measure>
  BR_HD void deform_in_single(Index t, const Index (&at)[width_of<S>],
                              const PartOf<S> (&viscosities)[PartsOf<S>::count],
                              Vec2Of<PartOf<S>> (&sum)[PartsOf<S>::count][3],
                              const Measure& measure) const {
    using W = PartOf<S>;
    constexpr Index count = PartsOf<S>::count;
    S numbers[8];
    gather_floats(laws_in_single, at, numbers);
    const ElasticLaw<S> elastic{numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4]},
                                numbers[5], numbers[6], numbers[7]};
    const bool bedded = any(elastic.is_bedded());
    const auto wide = parts_by<S>([&](Index p) { return measure(p, bedded); });
    const Deformation<S> d(narrowed_record<S>(wide.part));
    S eta;
    if constexpr (count == 1)
      eta = narrowed(viscosities[0]);
    else
      eta = narrowed(Wide<S>{{viscosities[0], viscosities[1]}});
    Vec2Of<S> pull[2];
    corner_forces(elastic.stress(d, eta), d.taken.edge, pull);
    for (int k = 0; k < 2; ++k) {
      const auto x = widened(pull[k].x), y = widened(pull[k].y);
      for (Index p = 0; p < count; ++p) sum[p][k + 1] = {part_of<W>(x, p), part_of<W>(y, p)};
    }
    for (Index p = 0; p < count; ++p) sum[p][0] = -(sum[p][1] + sum[p][2]);
    if (any(eta > 0.0)) {
      const Mat2Of<S>& l = d.velocity_gradient;
      const Sym2Of<S> rate{l.xx, l.yy, 0.5 * (l.xy + l.yx)};
      const S area = 0.5 * cross(d.taken.edge[0], d.taken.edge[1]);
      const auto power = widened(eta * area * contract(rate, rate));
      for (Index p = 0; p < count; ++p) {
        const Index first = t + p * width_of<W>;
        store(viscous_work, first, load<W>(viscous_work, first) + span * part_of<W>(power, p));
      }
    }
  }
  BR_HD Index joint_of(Index entry) const {
    return entry < 0 ? joint_force.size - 1 : pair_of(entry);
  }
  /// Where triangles are side b of the joints on edges.
  template <class R>
  BR_HD static auto is_b(const Index (&edge)[width_of<R>]) {
    if constexpr (width_of<R> == 1) {
      return edge[0] >= 0 && side_of(edge[0]) != 0;
    } else {
      double side[width_of<R>];
      for (Index i = 0; i < width_of<R>; ++i)
        side[i] = edge[i] < 0 ? 0.0 : static_cast<double>(side_of(edge[i]));
      return pack_of<R>(side) > 0.0;
    }
  }
  /// Adds a joint's forces to the two corners of its edge: on b the edge runs the other way, and
  /// forces are opposite.
  template <class R, class Mask>
  BR_HD static void add_force(const Mask& on_b, const R (&f)[4], Vec2Of<R>& from, Vec2Of<R>& to) {
    from.x += select(on_b, -f[2], f[0]);
    from.y += select(on_b, -f[3], f[1]);
    to.x += select(on_b, -f[0], f[2]);
    to.y += select(on_b, -f[1], f[3]);
  }
  /// Couples of triangles in a pack, one by one.
  template <class R>
  void add_couples(Index t, R (&total)[6]) const {
    Corners own[width_of<R>];
    store_records(View<Corners>{own, width_of<R>}, 0, total);
    for (Index k = 0; k < width_of<R>; ++k)
      add_couples(couples.first(t + k), couples.last(t + k), own[k].at);
    gather_records(View<const Corners>{own, width_of<R>}, consecutive<R>(0), total);
  }
  BR_HD void add_couples(Index first, Index last, Vec2 (&sum)[3]) const {
    for (Index c = first; c < last; ++c) {
      const Entry entry = couples.entries[c];
#if defined(__CUDA_ARCH__)
      if (phase[pair_of(entry)] != CouplePhase::acts) {  // a byte for 48 that are zero
        for (Vec2& s : sum) s += Vec2{0.0, 0.0};
        continue;
      }
#endif
      const CoupleForceOf<Stores>& f = couple_force[pair_of(entry)];
      const CornerVectors<Stores>& mine = side_of(entry) == 0 ? f.on_a : f.on_b;
      for (int k = 0; k < 3; ++k) sum[k] += converted<double>(mine.at[k]);
    }
  }
};

using fdem_shared::Bundles;
using BundleForces = fdem_shared::BundleForces<Corners>;

/// Impedance rho c_p of absorbing edges of a triangle, times their largest factor; 0 elsewhere.
struct EdgeDashpots {
  double at[3] = {0.0, 0.0, 0.0};  ///<  [Pa s/m]
};

/// The stable step of a triangle (docs/theory-fdem.md, 5): fdem_shared/stable_parts.hpp with its
/// joints, contacts and dashpots.
struct StableStep {
  View<const TriangleNodes> nodes;
  View<const Index> material, law_of;  ///< the latter: place among the laws
  View<const ElasticTriangle> laws;
  View<const double> viscosity, mass;
  View<const ContactPair> contacts;
  Index materials;
  View<const EdgeJoints> edges;
  View<const JointBond> bonds;
  View<const Index> bond_of;
  View<const JointStage> stage;
  View<const Index> hold;
  View<const Hold> holds;
  View<const EdgeDashpots> dashpots;  ///< empty: nothing absorbs
  Nearness nearness;
  int evaluate_every;  ///< steps from one evaluation to the next
  double rebound;      ///< factor on the stiffness of contacts that lose energy  [-]

  using Parts = fdem_shared::StepParts;  ///< of the largest row sum

  BR_HD double operator()(Index t) const { return parts(t).step; }

  /// As if something were near everywhere.
  BR_HD Parts parts_pressed(Index t) const {
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    return parts(t, x, exposed_edges(t));
  }
  BR_HD Parts parts(Index t) const {
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    const int exposed = exposed_edges(t);
    if (exposed != 0 && is_loose(t)) return parts(t, x, exposed);
    const int near = exposed == 0 ? 0 : near_edges(t, x, exposed);
    return fdem_shared::parts_until_next([&, this](int pressed) { return parts(t, x, pressed); },
                                         near, exposed, v, evaluate_every,
                                         [&, this] { return nearness.reach(t); });
  }
  /// The rows of its corners, held ones too, whatever they move with.
  /// @param longest  no step until the next evaluation is longer  [s]
  BR_HD void list(Index t, double longest, fdem_shared::Pressed where, Parts (&corner)[3]) const {
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    int pressed = where == fdem_shared::Pressed::nowhere ? 0 : exposed_edges(t);
    if (pressed != 0 && where == fdem_shared::Pressed::soon && !is_loose(t))
      pressed = fdem_shared::pressed_until_next(near_edges(t, x, pressed), pressed, v,
                                                evaluate_every * longest,
                                                [&, this] { return nearness.reach(t); });
    const Form form(*this, t, x, pressed);
    for (int i = 0; i < 3; ++i) corner[i] = form.row(*this, t, x, i);
  }
  /// Whether a corner goes where it is told, whatever its mass.
  BR_HD bool is_held(Index t, int corner) const {
    return hold[t] >= 0 && holds[hold[t]].fixed_at(corner) == 3 && holds[hold[t]].loose == 0;
  }
  /// Whether it is a part of a rigid body that forces move: only what it meets is stiff. Contact
  /// counts wherever it is exposed: else nothing bounds the step of a body at rest.
  BR_HD bool is_loose(Index t) const { return hold[t] >= 0 && holds[hold[t]].loose != 0; }

 private:
  /// A triangle as it stands now, and the stiffness of its edges.
  struct Form {
    double area;
    Vec2 slope[3];
    double on_edge[3][2];  ///< of the joint and of contact
    BR_HD Form(const StableStep& s, Index t, const Vec2 (&x)[3], int pressed) {
      const Target shape = Target::of(x);
      area = 0.5 / shape.over_double;
      for (int k = 0; k < 3; ++k) {
        slope[k] = shape.slope(k);
        on_edge[k][0] = s.joint_stiffness(t, k);
        on_edge[k][1] = (pressed >> k & 1) != 0 ? s.contact_stiffness(t, k, x, area) : 0.0;
      }
    }
    BR_HD Parts row(const StableStep& s, Index t, const Vec2 (&x)[3], int i) const {
      const ElasticTriangle& law = s.laws[s.law_of[t]];
      Parts p;
      if (!s.is_loose(t)) {
        fdem_shared::add_element<2>(p, slope, i, {area, 1.0}, law.lambda, law.shear,
                                    s.viscosity[t]);
        if (law.is_bedded()) p.element += row_of_planes(slope, i, area, law);
      }
      const int before = i == 0 ? 2 : i - 1;
      if (s.dashpots.size > 0) p.absorbed = s.dashpot(t, i, x) + s.dashpot(t, before, x);
      p.joint = on_edge[i][0] + on_edge[before][0];
      p.contact = on_edge[i][1] + on_edge[before][1];
      return p;
    }
  };
  /// @param pressed  bits of the edges whose contact counts
  BR_HD Parts parts(Index t, const Vec2 (&x)[3], int pressed) const {
    const Form form(*this, t, x, pressed);
    Parts largest;
    for (int i = 0; i < 3; ++i) {
      if (is_held(t, i)) continue;
      Parts p = form.row(*this, t, x, i);
      p.finish(mass[t]);
      if (p.step < largest.step) largest = p;
    }
    return largest;
  }
  /// Share of the planes of bedded rock in a row, at most, however it has turned: of g_i and D g_i,
  /// which are equally long, sum |a_c b_d| over d <= sqrt 2 |a| |b|.
  BR_HD static double row_of_planes(const Vec2 (&slope)[3], int i, double area,
                                    const ElasticTriangle& law) {
    double sum = 0.0;
    for (int j = 0; j < 3; ++j) sum += norm(slope[j]);
    return 1.4142135623730951 * (2.0 * abs(law.tilt) + abs(law.bend)) * area * norm(slope[i]) * sum;
  }
  /// Dashpot of an absorbing edge at each of its ends, half its length times the impedance: both
  /// of its impedances are at most the larger one.
  BR_HD double dashpot(Index t, int k, const Vec2 (&x)[3]) const {
    return 0.5 * norm(x[(k + 1) % 3] - x[k]) * dashpots[t].at[k];
  }
  /// A live joint adds p_f to the row of each of its nodes.
  BR_HD double joint_stiffness(Index t, int k) const {
    const Index entry = edges[t].at[k];
    if (entry < 0 || !is_live(stage[pair_of(entry)])) return 0.0;
    return bonds[bond_of[pair_of(entry)]].stiffness;
  }
  /// An edge that may touch adds the stiffness of two faces pressed together, 3 p L (1/H + 1/H).
  BR_HD double contact_stiffness(Index t, int k, const Vec2 (&x)[3], double area) const {
    const Vec2 edge = x[(k + 1) % 3] - x[k];
    const double over_height = dot(edge, edge) / (2.0 * area);  // L / H
    return 6.0 * rebound * contacts[material[t] * materials + material[t]].penalty * over_height;
  }
  BR_HD bool is_broken(Index entry) const { return entry >= 0 && is_parted(stage[pair_of(entry)]); }
  /// Bits of the edges that nothing joins.
  BR_HD int exposed_edges(Index t) const {
    int exposed = 0;
    for (int k = 0; k < 3; ++k) {
      const Index entry = edges[t].at[k];
      if (entry == edge_free || is_broken(entry)) exposed |= 1 << k;
    }
    return exposed;
  }
  BR_HD int near_edges(Index t, const Vec2 (&x)[3], int exposed) const {
    int near = 0;
    for (int k = 0; k < 3; ++k)
      if (is_broken(edges[t].at[k]))
        near |= nearness.edges_near_across(t, x, edges[t].at[k], exposed & ~near);
    return near == exposed ? near : near | nearness.edges_near(t, x, exposed & ~near);
  }
};

}  // namespace breccia::fdem
