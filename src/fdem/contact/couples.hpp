#pragma once
// Triangles in contact: what a couple remembers, and the kernel of one launch.

#include "core/incidence.hpp"
#include "core/kernel.hpp"
#include "core/pair_list.hpp"
#include "exec/early.hpp"
#include "fdem/joints/joints.hpp"
#include "fdem/laws/potential_contact.hpp"
#include "fdem/triangles/triangles.hpp"
#include "fdem_shared/couple_phase.hpp"

namespace breccia::fdem {

using fdem_shared::CouplePhase;

/// Contact of two materials.
struct ContactPair {
  double penalty;     ///< p_n  [Pa]
  double tangential;  ///< p_t  [Pa]
  double friction;    ///< mu  [-]
};

/// How the normal forces of a couple fall as it opens, so that it gives back e^2 of what it took
/// up, whatever the law of its forces and whoever presses. With the energy U of its overlap, of
/// which there was most U_0 since it began to touch, forces are those of the potential times
///
///   g = max(0, 1 - k (1 - U/U_0)),   int_0^U_0 g dU = e^2 U_0,
///   k = 2 (1 - e^2) if e^2 >= 1/2, else 1/(2 e^2).
///
/// Between 0 and U_0 it closes and opens on one curve, without loss. Walton and Braun (1986) do
/// this for a linear spring, whose forces then fall along one line.
struct Rebound {
  double fall = 0.0;  ///< k; 0: it gives all back  [-]

  static Rebound of(double restitution) {
    const double back = restitution * restitution;
    return {back >= 0.5 ? 2.0 * (1.0 - back) : 0.5 / back};
  }
  BR_HD bool loses() const { return fall > 0.0; }
  BR_HD double share(double energy, double most) const {
    return energy < most ? max(0.0, 1.0 - fall * (1.0 - energy / most)) : 1.0;
  }
  /// Stiffness where it begins to open, of a linear spring, over that of the spring.  [-]
  BR_HD double stiffness() const { return 1.0 + 2.0 * fall; }
};

/// State of a couple of triangles.
struct CoupleState {
  double drag[6];    ///< tangential force of a's edges through b, then of b's through a  [N/m]
  double scale;      ///< of its normal penalty; 0: it is new  [-]
  double stiffness;  ///< of its springs of friction, the greatest since it began to touch  [Pa]
  double work;       ///< taken up since it began to touch, friction included  [J/m]
  double slid;       ///< the part of it that friction has spent  [J/m]
  double sprung;     ///< the part of it that the springs of friction hold  [J/m]
  double lost;       ///< what was left of both when it parted: errors of integration  [J/m]
  double rubbed;     ///< what friction spent in touches that have ended  [J/m]
  double most;  ///< energy of its overlap since it began to touch, if contacts lose some  [J/m]
};

/// Forces of a couple on the corners of both triangles.  [N/m]
template <class Number>
struct CoupleForceOf {
  CornerVectors<Number> on_a, on_b;
};
using CoupleForce = CoupleForceOf<double>;
template <class To, class From>
BR_HD CoupleForceOf<To> converted(const CoupleForceOf<From>& f) {
  CoupleForceOf<To> same;
  for (int k = 0; k < 3; ++k) {
    same.on_a.at[k] = converted<To>(f.on_a.at[k]);
    same.on_b.at[k] = converted<To>(f.on_b.at[k]);
  }
  return same;
}
template <class Number>
using CoupleForcesOf = Buffer<CoupleForceOf<Number>>;

struct CoupleHistory {
  Precision precision = Precision::full;  ///< of `force`
  Buffer<CoupleState> state;
  Stored<CoupleForcesOf> force;

  explicit CoupleHistory(Space space = Space::host)
      : state(space), force{CoupleForcesOf<double>(space), CoupleForcesOf<float>(space)} {}

  template <class Visit>
  void each_field(Visit&& field) {
    field("state", "-", state);
    with_number(precision,
                [&, this](auto number) { field("force", "N/m", force.as<decltype(number)>()); });
  }
};
using Couples = PairList<CoupleHistory>;

/// An end of an edge, or of several side by side.
template <class R>
struct EdgeEnd {
  Vec2Of<R> position, velocity;
};

/// Force and work of an edge of one triangle in the other, in one step. The numbers of edges that
/// do not touch mean nothing, but for drag.
template <class R>
struct EdgePushOf {
  EdgeOverlapOf<R> overlap;
  decltype(R{} < R{}) touches{};
  Vec2Of<R> normal[2], friction[2];  ///< forces on its ends  [N/m]
  R drag;                            ///< what friction pulls with now  [N/m]
  R taken;                           ///< work that it has taken up in this step  [J/m]
  R sprung;                          ///< what its spring holds now  [J/m]
  R stiffness;                       ///< of its spring  [Pa]
};
using EdgePush = EdgePushOf<double>;

/// Work that friction of a couple takes up in a step, by the trapezoidal rule, and what its springs
/// hold after it: no more than they were given. The rest is spent, what a spring held that is
/// forgotten, too.  [J/m]
struct FrictionWork {
  double taken = 0.0, sprung = 0.0;
  BR_HD void add(double more_taken, double more_sprung) {
    taken += more_taken;
    sprung += more_sprung;
  }
  BR_HD void book(double& spent, double& held) const {
    const double given = held + taken;
    held = max(0.0, min(sprung, given));
    spent += given - held;
  }
};

/// Friction of an edge is a spring that pulls with T:
///
///   T <- T + k v_t dt, cut at mu N,   k = max(k, p_t x),   x the share of the edge that is inside
///
/// and holds T^2/(2 k). k never falls while the couple touches, and v_t is that where T acts: what
/// the spring holds grows by just the work of T by the trapezoidal rule, and falls where T is cut
/// or k grows. A k that fell with x would make T^2/(2 k) of nothing as the edge leaves, or T and
/// the body with it give way.
/// @param scale      of the penalty
/// @param stiffness  of the couple's springs, the greatest before  [Pa]
/// @param drag       what friction pulled with before  [N/m]
/// @param dt         the step that led here  [s]
/// @param target_v   velocities of the target's corners  [m/s]
/// @param p          has the area coordinates of the edge's ends in the target
template <class R, class End, class Velocities>
BR_HD inline void push_edge(const ContactPair& law, double scale, double stiffness, const R& drag,
                            double dt, const End& from, const End& to, const Velocities& target_v,
                            EdgePushOf<R>& p) {
  EdgeOverlapOf<R>& o = p.overlap;
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  p.touches = overlap_of_ends(o);
  p.drag = zero;
  if (!any(p.touches)) return;
  const double penalty = scale * law.penalty;
  normal_forces(o, from.position, to.position, penalty, p.normal[0], p.normal[1]);
  if (!(law.friction > 0.0)) {
    p.drag = select(p.touches, drag, zero);
    p.taken = p.sprung = p.stiffness = zero;
    return;
  }

  const Vec2Of<R> edge = to.position - from.position;
  const R size = norm(edge);
  const Vec2Of<R> along = (one / size) * edge;
  const auto rate_at = [&](const R& s) {  // of the target against a point of the edge
    Vec2Of<R> rate = -((one - s) * from.velocity + s * to.velocity);
    for (int m = 0; m < 3; ++m) rate += (o.at_a[m] + s * (o.at_b[m] - o.at_a[m])) * target_v[m];
    return dot(rate, along);
  };
  const R share = o.moment / o.whole;
  const R slip = dt * rate_at(share);
  const R limit = law.friction * penalty * o.whole * size;
  p.stiffness = max(constant<R>(stiffness), law.tangential * (o.end - o.begin));
  R pull = drag + p.stiffness * slip;
  pull = select(abs(pull) > limit, select(pull < 0.0, -limit, limit), pull);
  p.taken = 0.5 * (drag + pull) * slip;
  p.sprung = 0.5 * pull * pull / p.stiffness;
  p.friction[0] = (pull * (one - share)) * along;
  p.friction[1] = (pull * share) * along;
  p.drag = select(p.touches, pull, zero);
}
/// The push of an edge in a target.
template <class R, class End>
BR_HD inline void edge_push(const ContactPair& law, double scale, double stiffness, const R& drag,
                            double dt, const End& from, const End& to, const TargetOf<R>& target,
                            const Vec2Of<R> (&target_v)[3], EdgePushOf<R>& p) {
  target.coordinates(from.position, p.overlap.at_a);
  target.coordinates(to.position, p.overlap.at_b);
  push_edge(law, scale, stiffness, drag, dt, from, to, target_v, p);
}

/// The six edges of a couple one after the other; any couple.
struct EdgesInTurn {
  static constexpr bool any_couple = true;  ///< new ones, too, conservative or with losses

  /// False only where the two cannot touch.
  BR_HD bool near(const Vec2 (&xa)[3], const Vec2 (&xb)[3]) const { return meet(xa, xb); }
  /// Calls visit(edge, push) for edges 0 to 2 of a in b, then for 3 to 5: those of b in a.
  template <class Visit>
  BR_HD void operator()(const ContactPair& law, double scale, double stiffness,
                        const double (&drag)[6], double dt, const Vec2 (&xa)[3],
                        const Vec2 (&va)[3], const Target& of_a, const Vec2 (&xb)[3],
                        const Vec2 (&vb)[3], const Target& of_b, const Visit& visit) const {
    using End = EdgeEnd<double>;
    for (int edge = 0; edge < 6; ++edge) {
      const bool own = edge < 3;
      const int k = own ? edge : edge - 3, next = k == 2 ? 0 : k + 1;
      const auto &x = own ? xa : xb, &v = own ? va : vb;
      EdgePush p;
      edge_push(law, scale, stiffness, drag[edge], dt, End{x[k], v[k]}, End{x[next], v[next]},
                own ? of_b : of_a, own ? vb : va, p);
      visit(edge, p);
    }
  }
};

/// Forces and work that a broken joint hands to the contact of its faces.
struct JointLegacy {
  View<const Index> edge_a, edge_b;
  View<const JointHandover> handover;
  View<JointWork> inherited_work;  ///<  [J/m]
};

/// Normal force by potential, both ways; Coulomb friction on each edge with a spring that remembers
/// (docs/theory-fdem.md, 4).
/// @tparam Number  what forces are stored in
template <class Number>
struct CoupleForces {
  static constexpr const char* name = "fdem.couples";
  double dt;          ///< the step that led here  [s]
  bool conservative;  ///< adds the shape forces that make it the gradient of an energy
  Rebound rebound;
  View<const TriangleNodes> nodes;
  View<const Index> material;
  View<const ContactPair> laws;  ///< of materials a and b at a * materials + b
  Index materials;
  View<const Index> a, b;
  View<const Index>
      parent_joint;  ///< the joint between them where it broke in the step before, or -1
  JointLegacy joints;
  View<CoupleState> state;
  View<CoupleForceOf<Number>> force;
  View<CouplePhase> phase;

  struct Loaded {
    Index a, b;
    CouplePhase phase;
    Vec2 corner[2][3];
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    loaded.phase = fdem_shared::read_phase_now(&phase[i]);
    loaded.a = read_now(&a[i]);
    loaded.b = read_now(&b[i]);
  }
  BR_HD void load_late(Index, Loaded& loaded) const {
    if (loaded.phase != CouplePhase::rests) return;
    for (int k = 0; k < 3; ++k) {
      loaded.corner[0][k] = read_record_now(&nodes[loaded.a].at[k].position);
      loaded.corner[1][k] = read_record_now(&nodes[loaded.b].at[k].position);
    }
  }
  /// Most couples only find that the two do not meet. @returns false if these may; nothing is
  /// written
  BR_HD bool update(Index, const Loaded& loaded) const {
    if (loaded.phase == CouplePhase::rests) return !meet(loaded.corner[0], loaded.corner[1]);
    return loaded.phase == CouplePhase::waits;
  }
  /// On the host all couples: it finds whether the two meet on its way.
  BR_HD void operator()(Index i) const { slow(i); }
  BR_HD void slow(Index i) const { evaluate(i, EdgesInTurn{}); }
  /// @param edges  how the edges are taken: EdgesInTurn, or side by side
  template <class Edges>
  BR_HD void evaluate(Index i, const Edges& edges) const {
    if (phase[i] == CouplePhase::waits) return;
    CoupleState& kept = state[i];
    Vec2 xa[3], va[3], xb[3], vb[3];
    split(nodes[a[i]], xa, va);
    split(nodes[b[i]], xb, vb);
    CoupleForce sum{};
    FrictionWork friction_work;
    bool touching = false;
    const bool is_new = Edges::any_couple && kept.scale == 0.0;
    if (is_new) kept.scale = 1.0;
    if (edges.near(xa, xb)) {
      const ContactPair& law = law_of(i);
      const Target of_a = Target::of(xa), of_b = Target::of(xb);
      if constexpr (Edges::any_couple)
        if (is_new && parent_joint[i] >= 0) inherit(parent_joint[i], law, kept, xa, of_a, xb, of_b);
      double scale = kept.scale;
      if constexpr (Edges::any_couple)
        if (rebound.loses()) {
          const Unloading now = unloading(scale * law.penalty, kept.most, of_a, of_b);
          scale *= now.share;
          kept.most = now.most;
        }
      double stiffness = 0.0;
      edges(law, scale, kept.stiffness, kept.drag, dt, xa, va, of_a, xb, vb, of_b,
            [&](int edge, const EdgePush& p) {
              kept.drag[edge] = p.drag;
              if (!p.touches) return;
              touching = true;
              stiffness = max(stiffness, p.stiffness);
              friction_work.add(p.taken, p.sprung);
              const bool of_own = edge < 3;
              auto& on_x = of_own ? sum.on_a.at : sum.on_b.at;
              auto& on_target = of_own ? sum.on_b.at : sum.on_a.at;
              const int k = of_own ? edge : edge - 3;
              push(p.overlap, k, p.normal[0], p.normal[1], on_x, on_target);
              if (law.friction > 0.0)
                push(p.overlap, k, p.friction[0], p.friction[1], on_x, on_target);
            });
      if (touching) kept.stiffness = stiffness;
      if constexpr (Edges::any_couple)
        if (touching && conservative) {
          const Polygon over = overlap_of(of_a, of_b);
          add_shape_forces(of_a, over, scale * law.penalty, sum.on_a.at);
          add_shape_forces(of_b, over, scale * law.penalty, sum.on_b.at);
        }
    }
    phase[i] = touching ? CouplePhase::acts : CouplePhase::rests;
    CoupleForceOf<Number>& stored = force[i];
    if (!touching && kept.work == 0.0 && kept.slid == 0.0) {
      stored = {};  // it may have touched while nothing moved
      return;
    }
    // Work is booked of the forces that act: as they are stored.
    const CoupleForce last = converted<double>(stored);
    stored = converted<Number>(sum);
    const CoupleForce now = converted<double>(as_in_memory(stored));
    for (int k = 0; k < 3; ++k) {
      kept.work -= 0.5 * dt * dot(last.on_a.at[k] + now.on_a.at[k], va[k]);
      kept.work -= 0.5 * dt * dot(last.on_b.at[k] + now.on_b.at[k], vb[k]);
    }
    friction_work.book(kept.slid, kept.sprung);
    if (!touching) {
      kept.lost += kept.work - kept.slid;
      kept.rubbed += kept.slid;
      kept.work = kept.slid = kept.most = kept.stiffness = 0.0;
      kept.scale = 1.0;
      for (double& drag : kept.drag) drag = 0.0;
    }
  }

  /// The force of a couple as it parts (contact.restitution).
  struct Unloading {
    double share;  ///< of its normal forces that is left  [-]
    double most;   ///< energy of its overlap so far  [J/m]
  };
  BR_HD Unloading unloading(double penalty, double most, const Target& of_a,
                            const Target& of_b) const {
    const Polygon over = overlap_of(of_a, of_b);
    const double energy =
        penalty * (potential_integral(of_a, over) + potential_integral(of_b, over));
    return {rebound.share(energy, most), max(energy, most)};
  }
  /// Unloading of couple i at its present position.
  BR_HD Unloading unloading(Index i, double penalty, double most) const {
    Vec2 xa[3], va[3], xb[3], vb[3];
    split(nodes[a[i]], xa, va);
    split(nodes[b[i]], xb, vb);
    if (!meet(xa, xb)) return {1.0, most};
    return unloading(penalty, most, Target::of(xa), Target::of(xb));
  }

  /// Normal force on a if their corners lay there.  [N/m]
  BR_HD Vec2 pressing(Index i, const Vec2 (&xa)[3], const Vec2 (&xb)[3]) const {
    if (!meet(xa, xb)) return {};
    const Target of_a = Target::of(xa), of_b = Target::of(xb);
    const CoupleState& kept = state[i];
    double penalty = (kept.scale == 0.0 ? 1.0 : kept.scale) * law_of(i).penalty;
    if (rebound.loses()) penalty *= unloading(penalty, kept.most, of_a, of_b).share;
    return normal_on_a(penalty, xa, of_a, xb, of_b);
  }

  BR_HD Index number_of_law(Index triangle_a, Index triangle_b) const {
    return material[triangle_a] * materials + material[triangle_b];
  }
  BR_HD const ContactPair& law_of(Index i) const { return laws[number_of_law(a[i], b[i])]; }
  /// A new couple of which a joint is known that broke between them.
  BR_HD void begin(Index i) const {
    Vec2 xa[3], va[3], xb[3], vb[3];
    split(nodes[a[i]], xa, va);
    split(nodes[b[i]], xb, vb);
    state[i].scale = 1.0;
    if (!meet(xa, xb)) return;
    inherit(parent_joint[i], law_of(i), state[i], xa, Target::of(xa), xb, Target::of(xb));
  }
  /// Force of `add_shape_forces` on a corner of one of the two.
  BR_HD Vec2 shape_force(Index i, double penalty, bool of_a, int corner) const {
    Vec2 x[2][3], v[2][3];
    split(nodes[a[i]], x[0], v[0]);
    split(nodes[b[i]], x[1], v[1]);
    const Target targets[2] = {Target::of(x[0]), Target::of(x[1])};
    Vec2 shape[3] = {};
    add_shape_forces(targets[of_a ? 0 : 1], overlap_of(targets[0], targets[1]), penalty, shape);
    return shape[corner];
  }

  /// Gives a couple in overlap the forces that its faces carry, as far as friction bears them.
  /// Springs of friction are softer than joints and would hold more at that force; they are as much
  /// stiffer as it takes to store what was held there, but no stiffer than the penalty across. What
  /// even that stores beyond is taken off the force: nobody has paid for it.
  /// @param edges  that lie on each other, of a and of b
  /// @returns what it stores then
  BR_HD static JointWork begin_pressed(const JointHandover& broken, const int (&edges)[2],
                                       const ContactPair& law, CoupleState& kept,
                                       const Vec2 (&xa)[3], const Target& of_a, const Vec2 (&xb)[3],
                                       const Target& of_b) {
    kept.scale = first_scale(broken.pressing, law, xa, of_a, xb, of_b);
    const double penalty = kept.scale * law.penalty;
    const Polygon over = overlap_of(of_a, of_b);
    JointWork given{penalty * (potential_integral(of_a, over) + potential_integral(of_b, over)),
                    0.0};

    double limit[2] = {}, inside = 0.0;
    for (int side = 0; side < 2; ++side) {
      const Vec2(&x)[3] = side == 0 ? xa : xb;
      const Vec2 &from = x[edges[side]], &to = x[(edges[side] + 1) % 3];
      EdgeOverlap o;
      if (!overlap_of_edge(from, to, side == 0 ? of_b : of_a, o)) continue;
      limit[side] = law.friction * penalty * o.whole * norm(to - from);
      inside = max(inside, o.end - o.begin);
    }
    // Along either edge, in its own direction, it is the same: both turn.
    const double most = limit[0] + limit[1], held = broken.held.slide;
    if (most > 0.0) {
      double share = max(-1.0, min(1.0, broken.shear / most));
      const double squares = share * share * (limit[0] * limit[0] + limit[1] * limit[1]);
      kept.stiffness = law.tangential * inside;
      if (0.5 * squares > held * kept.stiffness)
        kept.stiffness = max(kept.stiffness, min(law.penalty, 0.5 * squares / held));
      given.slide = 0.5 * squares / kept.stiffness;
      if (given.slide > held) share *= sqrt(held / given.slide);
      for (int side = 0; side < 2; ++side) kept.drag[3 * side + edges[side]] = share * limit[side];
    }
    given = given.within(broken.held);
    kept.work = given.open + given.slide;
    kept.sprung = given.slide;
    return given;
  }

 private:
  /// A couple born in overlap, where a joint broke under compression, goes on with the joint's
  /// forces as far as friction bears them, so that neither force jumps; what it then stores is its
  /// part of the joint's work, no more than the joint held.
  BR_HD void inherit(Index joint, const ContactPair& law, CoupleState& kept, const Vec2 (&xa)[3],
                     const Target& of_a, const Vec2 (&xb)[3], const Target& of_b) const {
    const JointHandover& broken = joints.handover[joint];
    if (!(broken.pressing > 0.0)) return;
    const int of_joint[2] = {joints.edge_a[joint] % 3, joints.edge_b[joint] % 3};
    joints.inherited_work[joint] = begin_pressed(broken, of_joint, law, kept, xa, of_a, xb, of_b);
  }

  /// Of the penalty, so that the couple presses as hard as this.  [N/m]
  BR_HD static double first_scale(double force, const ContactPair& law, const Vec2 (&xa)[3],
                                  const Target& of_a, const Vec2 (&xb)[3], const Target& of_b) {
    const double size = norm(normal_on_a(law.penalty, xa, of_a, xb, of_b));
    return size > 0.0 ? min(2.0, max(0.01, force / size)) : 1.0;
  }
  BR_HD static Vec2 normal_on_a(double penalty, const Vec2 (&xa)[3], const Target& of_a,
                                const Vec2 (&xb)[3], const Target& of_b) {
    Vec2 on_a{};
    for (int k = 0; k < 3; ++k) {
      EdgeOverlap o;
      Vec2 first, second;
      if (overlap_of_edge(xa[k], xa[(k + 1) % 3], of_b, o)) {
        normal_forces(o, xa[k], xa[(k + 1) % 3], penalty, first, second);
        on_a += first + second;
      }
      if (overlap_of_edge(xb[k], xb[(k + 1) % 3], of_a, o)) {
        normal_forces(o, xb[k], xb[(k + 1) % 3], penalty, first, second);
        on_a -= first + second;
      }
    }
    return on_a;
  }
};

}  // namespace breccia::fdem
