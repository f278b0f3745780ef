#pragma once
// Couples of tetrahedra that may touch: push and rub (docs/theory-fdem3.md, 3).

#include "core/incidence.hpp"
#include "core/kernel.hpp"
#include "core/pair_list.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem3/joints/joints.hpp"
#include "fdem3/laws/distance_contact.hpp"

namespace breccia::fdem3 {

/// Contact of two materials.
struct ContactPair {
  double penalty;     ///< k_n = p_n/h_c  [Pa/m]
  double tangential;  ///< k_t = p_t/h_c  [Pa/m]
  double friction;    ///< mu  [-]
};

/// State of a couple from step to step.
struct CoupleState {
  Vec3 drag;      ///< T: tangential force on a  [N]
  double spring;  ///< k: stiffness of its spring; 0: it is new  [N/m]
  double scale;   ///< of its normal penalty; 0: it is new  [-]
  double begun;   ///< energy of the overlap that it began with and nobody paid for  [J]
  double work;    ///< taken up since it began to touch, friction included  [J]
  double slid;    ///< the part of it that friction has spent  [J]
  double sprung;  ///< the part of it that the spring of friction holds  [J]
  double lost;    ///< what was left of both when it parted: errors of integration  [J]
  double rubbed;  ///< what friction spent in touches that have ended  [J]
};

/// Forces of a couple on the corners of both.  [N]
struct CoupleForce {
  Corners on_a, on_b;
};

struct CoupleHistory {
  Buffer<CoupleState> state;
  Buffer<CoupleForce> force;

  explicit CoupleHistory(Space space = Space::host) : state(space), force(space) {}

  template <class Visit>
  void each_field(Visit&& field) {
    field("state", "-", state);
    field("force", "N", force);
  }
};
using Couples = PairList<CoupleHistory>;

BR_HD inline bool boxes_apart(const Vec3 (&p)[4], const Vec3 (&q)[4], double by) {
  const auto low = [](double a, double b, double c, double d) { return min(min(a, b), min(c, d)); };
  const auto high = [](double a, double b, double c, double d) {
    return max(max(a, b), max(c, d));
  };
  return low(p[0].x, p[1].x, p[2].x, p[3].x) - high(q[0].x, q[1].x, q[2].x, q[3].x) > by ||
         low(q[0].x, q[1].x, q[2].x, q[3].x) - high(p[0].x, p[1].x, p[2].x, p[3].x) > by ||
         low(p[0].y, p[1].y, p[2].y, p[3].y) - high(q[0].y, q[1].y, q[2].y, q[3].y) > by ||
         low(q[0].y, q[1].y, q[2].y, q[3].y) - high(p[0].y, p[1].y, p[2].y, p[3].y) > by ||
         low(p[0].z, p[1].z, p[2].z, p[3].z) - high(q[0].z, q[1].z, q[2].z, q[3].z) > by ||
         low(q[0].z, q[1].z, q[2].z, q[3].z) - high(p[0].z, p[1].z, p[2].z, p[3].z) > by;
}

/// Bits of the faces of a tetrahedron that nothing joins.
BR_HD inline int exposed_faces(const FaceJoints& faces, const View<const JointStage>& stage) {
  int exposed = 0;
  for (int k = 0; k < 4; ++k) {
    const Index entry = faces.at[k];
    if (entry == face_free || (entry >= 0 && is_parted(stage[pair_of(entry)]))) exposed |= 1 << k;
  }
  return exposed;
}

/// Actions of a face of one tetrahedron that is partly in the other.
struct FacePart {
  Vec3 on_face[3], on_target[4];  ///< forces on its corners and on those of the other  [N]
  Inside::FaceShare inside;       ///< of the other
  bool exposed;                   ///< nothing joins it: it touches and rubs
  bool pushes;                    ///< exposed, and more than a sum of rounding, without a middle
  double size;                    ///< of its push  [N]
  Vec3 push, moment;              ///< sum of on_face; its middle times `size`  [N], [N m]
};
/// Sums over both passes of a couple: faces of a in b, then faces of b in a. Forces are those of
/// all faces, joined ones too, so that they are the slope of the overlap's energy whatever its
/// neighbours do; those of joined faces cancel where the neighbour presses as hard.
struct Pressing {
  CoupleForce force{};
  Vec3 on_a{};    ///< N, of exposed faces  [N]
  Vec3 centre{};  ///< weighted by `weight`  [N m]
  double weight = 0.0;
  double area = 0.0;    ///< of both passes  [m2]
  double joined = 0.0;  ///< area of faces inside that are joined  [m2]
  double energy = 0.0;  ///< of the overlap  [J]

  /// Adds what a face brings besides forces on corners.
  BR_HD void add(const FacePart& part, bool of_a) {
    if (!part.exposed) joined += part.inside.area;
    if (!part.pushes) return;
    on_a += of_a ? part.push : -part.push;
    centre += part.moment;
    weight += part.size;
    area += part.inside.area;
  }
  /// Work that moving on with these velocities takes in a time.  [J]
  BR_HD double taken_in(double time, const Vec3 (&va)[4], const Vec3 (&vb)[4]) const {
    double power = 0.0;
    for (int k = 0; k < 4; ++k)
      power += dot(force.on_a.at[k], va[k]) + dot(force.on_b.at[k], vb[k]);
    return -time * power;
  }
  BR_HD bool touches() const { return weight > 0.0 || energy > 0.0; }
  /// Whether friction acts on a couple that touches.
  BR_HD bool rubs(const ContactPair& law) const {
    return touches() && law.friction > 0.0 && norm(on_a) > 0.0 && stiffness(law) > 0.0;
  }
  BR_HD double stiffness(const ContactPair& law) const { return law.tangential * 0.5 * area; }
  /// Centre of pressure.  [m]
  BR_HD Vec3 middle() const { return (1.0 / weight) * centre; }
  /// Share of the forces that are left beyond this energy.  [-]
  BR_HD double share_beyond(double begun) const {
    const double ratio = begun / energy;
    return energy > begun ? 1.0 - ratio * ratio : 0.0;
  }
  /// Takes off what an overlap began with: with E the energy of the overlap and E_0 that at the
  /// beginning, the couple has (E - E_0)^2/E beyond E_0, and its forces are the slope of that.
  BR_HD void take_off(double begun) {
    if (!(begun > 0.0)) return;
    const double share = share_beyond(begun);
    for (int k = 0; k < 4; ++k) {
      force.on_a.at[k] = share * force.on_a.at[k];
      force.on_b.at[k] = share * force.on_b.at[k];
    }
    on_a = share * on_a;
  }
};

/// A tetrahedron of a couple.
struct Partner {
  Vec3 x[4];  ///< corners  [m]
  int exposed;
  Target target;
  CornersInside in_other;

  BR_HD bool has_volume() const { return target.six_volumes > 0.0; }
};

/// Coordinates of the corners of a face, of those of all corners.
BR_HD inline void corners_of_face(const CornersInside& all, int face, double (&lambda)[3][4]) {
  for (int k = 0; k < 3; ++k)
    for (int m = 0; m < 4; ++m) lambda[k][m] = all.lambda[corner_of_face(face, k)][m];
}
/// Whether an exposed face of one tetrahedron reaches into the other: no other face pushes.
BR_HD inline bool exposed_reaches_into(const Partner& one, const Target& target) {
  for (int f = 0; f < 4; ++f) {
    if ((one.exposed >> f & 1) == 0) continue;
    double lambda[3][4];
    corners_of_face(one.in_other, f, lambda);
    if (face_reaches_into(target, lambda)) return true;
  }
  return false;
}

inline constexpr double least_moment = 1e-300;  ///< of an overlap, over twice the area  [m]

/// @param x       corners of the tetrahedron of the face  @param in_target  they in the target
/// @param inside  of the target
/// @returns whether any part of the face is in the target
BR_HD inline bool part_of_face(const Vec3 (&x)[4], const CornersInside& in_target, int f,
                               bool exposed, const Target& target, const Inside& inside,
                               double penalty, bool of_a, FacePart& part) {
  Vec3 face[3];
  FaceOverlap o;
  for (int k = 0; k < 3; ++k) face[k] = x[corner_of_face(f, k)];
  corners_of_face(in_target, f, o.lambda);
  settle_plane(of_a, in_target.lambda[f], o.lambda);
  if (!overlap_of_face(target, o)) return false;
  part.inside = inside.share_of(o, face);
  push(o, face, penalty, part.on_face, part.on_target);
  const double all = o.moment[0] + o.moment[1] + o.moment[2];
  part.exposed = exposed;
  part.pushes = exposed && abs(all) > least_moment;
  part.push = part.moment = {};
  part.size = 0.0;
  if (!part.pushes) return true;
  part.push = part.on_face[0] + part.on_face[1] + part.on_face[2];
  part.size = norm(part.push);
  const Vec3 middle =
      (1.0 / all) * (o.moment[0] * face[0] + o.moment[1] * face[1] + o.moment[2] * face[2]);
  part.moment = part.size * middle;
  return true;
}

/// Adds the faces of one tetrahedron that are in the other; only exposed ones touch and rub.
/// @param inside  of the target  @param own  of the tetrahedron itself
BR_HD inline void add_faces(const Partner& one, const Target& target, double penalty, bool of_a,
                            Pressing& sum, Inside& inside, Inside& own) {
  Corners& on_own = of_a ? sum.force.on_a : sum.force.on_b;
  Corners& on_other = of_a ? sum.force.on_b : sum.force.on_a;
  for (int f = 0; f < 4; ++f) {
    FacePart part;
    if (!part_of_face(one.x, one.in_other, f, (one.exposed >> f & 1) != 0, target, inside, penalty,
                      of_a, part))
      continue;
    inside.add_other(part.inside);
    own.add_own(f, part.inside.area);
    for (int k = 0; k < 3; ++k) on_own.at[corner_of_face(f, k)] += part.on_face[k];
    for (int k = 0; k < 4; ++k) on_other.at[k] += part.on_target[k];
    sum.add(part, of_a);
  }
}

/// Energy that a couple takes off: neighbours at a vertex become one some steps after a joint there
/// has softened, or have overlapped by joined faces before an exposed one reached in: by more than
/// the last step can have brought.
/// @param taken_in  Pressing::taken_in of the last step  [J]
BR_HD inline void note_begun(bool is_new, double taken_in, CoupleState& kept, const Pressing& sum) {
  if (is_new)
    kept.begun = sum.energy;
  else if (sum.joined > 0.0)
    kept.begun = max(0.0, sum.energy - taken_in);
}

/// Pull of friction on a, by the spring of the couple.  [N]
/// @param rate  velocity of a against b at the centre of pressure  [m/s]
BR_HD inline Vec3 pull_of(const ContactPair& law, double dt, Vec3 rate, const Pressing& sum,
                          CoupleState& kept) {
  const double size = norm(sum.on_a), stiffness = sum.stiffness(law);
  const Vec3 n = (1.0 / size) * sum.on_a;
  rate -= dot(rate, n) * n;
  // Turned with the plane of contact, its length kept.
  Vec3 before = kept.drag - dot(kept.drag, n) * n;
  const double left = norm(before), had = norm(kept.drag);
  const double most = law.friction * size;
  // The spring keeps, as the area changes, its energy T^2/(2 k).
  const double stiffer = kept.spring > 0.0 ? sqrt(stiffness / kept.spring) : 1.0;
  if (left > 0.0) before = (stiffer * had / left) * before;
  kept.spring = stiffness;
  Vec3 pull = before - (stiffness * dt) * rate;
  const double tried = norm(pull);
  if (tried > most) pull = (most / tried) * pull;
  const double taken = -0.5 * dt * dot(before + pull, rate);
  fdem::FrictionWork friction_work;
  friction_work.add(taken, 0.5 * dot(pull, pull) / stiffness);
  friction_work.book(kept.slid, kept.sprung);
  kept.drag = pull;
  return pull;
}

/// Ends the step of a couple of which the work has been added up.
BR_HD inline void end_step(bool touches, CoupleState& kept) {
  if (touches) {
    // Not even one that has taken up nothing rests: its forces must end.
    if (kept.work == 0.0 && kept.slid == 0.0) kept.work = 1e-300;
    return;
  }
  kept.slid += kept.sprung;  // what the spring held is spent
  kept.lost += kept.work - kept.slid;
  kept.rubbed += kept.slid;
  kept.work = kept.slid = kept.sprung = 0.0;
  kept.scale = 1.0;
  kept.begun = 0.0;
  kept.drag = {};
  kept.spring = 0.0;
}

/// Normal force by potential, both ways; Coulomb friction with one spring a couple that remembers.
struct CoupleForces {
  static constexpr const char* name = "fdem3.couples";
  double dt;  ///< the step that led here  [s]
  View<const TetrahedronNodes> nodes;
  View<const Index> material;
  View<const ContactPair> laws;  ///< of materials a and b at a * materials + b
  Index materials;
  View<const std::uint8_t> exposed;
  View<const Index> a, b;
  View<const Index> parent_joint;  ///< the joint between them where it broke in the step before, or
                                   ///< -1
  RareView<JointFailure> broken;   ///< forces and work of joints, which the contact of their faces
                                   ///< takes over
  View<CoupleState> state;
  View<CoupleForce> force;
  View<fdem_shared::CouplePhase> phase;  ///< none rests: the state tells it

  template <class R>
  struct Loaded {
    Index a, b;
    bool waits;  ///< it may not touch yet
    bool apart;  ///< it has not touched and does not
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_HD void load_early(Index i, Loaded<double>& loaded) const {
    loaded.a = read_now(&a[i]);
    loaded.b = read_now(&b[i]);
    const CoupleState& kept = state[i];
    loaded.waits = waits(i);
    loaded.apart = kept.scale != 0.0 && kept.work == 0.0 && kept.slid == 0.0;
  }
  BR_HD void load_late(Index, Loaded<double>& loaded) const {
    if (!loaded.apart) return;
    Vec3 xa[4], xb[4];
    places(nodes[loaded.a], xa);
    places(nodes[loaded.b], xb);
    loaded.apart = boxes_apart(xa, xb, 0.0);
  }
  /// Most couples rest apart: their forces are zero already. @returns whether this one does
  BR_HD bool update(Index, const Loaded<double>& loaded) const {
    return loaded.waits || loaded.apart;
  }
  BR_HD bool waits(Index i) const { return phase[i] == fdem_shared::CouplePhase::waits; }
  BR_HD void operator()(Index i) const {
    if (!run_at<double>(*this, i)) slow(i);
  }
  BR_HD void slow(Index i) const {
    CoupleState& kept = state[i];
    if (waits(i)) return;
    const bool is_new = kept.scale == 0.0;
    if (is_new) kept.scale = 1.0;
    const TetrahedronNodes &na = nodes[a[i]], &nb = nodes[b[i]];
    Partner of_a, of_b;
    Vec3 va[4], vb[4];
    split(na, of_a.x, va);
    split(nb, of_b.x, vb);
    const bool meeting = !boxes_apart(of_a.x, of_b.x, 0.0) && meet(of_a, of_b);
    // It has begun and holds nothing: its forces are zero already.
    const bool holds = kept.work != 0.0 || kept.slid != 0.0, resting = !is_new && !holds;
    if (!meeting && resting) return;
    Pressing sum;
    if (meeting) {
      of_a.exposed = exposed[a[i]];
      of_b.exposed = exposed[b[i]];
      const ContactPair& law = law_of(i);
      if (is_new && parent_joint[i] >= 0) inherit(parent_joint[i], law, kept, of_a, of_b);
      press(law.penalty * kept.scale, of_a, of_b, holds, sum);
      if (!holds && kept.work == 0.0) note_begun(is_new, sum.taken_in(dt, va, vb), kept, sum);
      sum.take_off(kept.begun);
      if (sum.rubs(law)) rub(law, of_a.target, va, of_b.target, vb, kept, sum);
    }
    if (!sum.touches() && resting) return;
    const CoupleForce last = force[i];
    force[i] = sum.force;
    for (int k = 0; k < 4; ++k) {
      kept.work -= 0.5 * dt * dot(last.on_a.at[k] + sum.force.on_a.at[k], va[k]);
      kept.work -= 0.5 * dt * dot(last.on_b.at[k] + sum.force.on_b.at[k], vb[k]);
    }
    end_step(sum.touches(), kept);
  }
  /// Whether a couple that is busy has anything to evaluate: others rest apart, though their boxes
  /// are not.
  BR_HD bool is_due(Index i) const {
    const CoupleState& kept = state[i];
    if (waits(i)) return false;
    if (kept.scale == 0.0 || kept.work != 0.0 || kept.slid != 0.0) return true;
    Partner of_a, of_b;
    places(nodes[a[i]], of_a.x);
    places(nodes[b[i]], of_b.x);
    return meet(of_a, of_b);
  }
  /// A new couple that meets takes over what the joint between them has left.
  BR_HD void begin(Index i) const {
    state[i].scale = 1.0;
    Partner of_a, of_b;
    places(nodes[a[i]], of_a.x);
    places(nodes[b[i]], of_b.x);
    meet(of_a, of_b);
    of_a.exposed = exposed[a[i]];
    of_b.exposed = exposed[b[i]];
    inherit(parent_joint[i], law_of(i), state[i], of_a, of_b);
  }
  BR_HD const ContactPair& law_of(Index i) const {
    return laws[material[a[i]] * materials + material[b[i]]];
  }

  /// Normal force on a if their corners lay there.  [N]
  BR_HD Vec3 pressing(Index i, const Vec3 (&xa)[4], const Vec3 (&xb)[4]) const {
    if (boxes_apart(xa, xb, 0.0)) return {};
    Partner of_a, of_b;
    for (int k = 0; k < 4; ++k) {
      of_a.x[k] = xa[k];
      of_b.x[k] = xb[k];
    }
    if (!meet(of_a, of_b)) return {};
    of_a.exposed = exposed[a[i]];
    of_b.exposed = exposed[b[i]];
    const CoupleState& kept = state[i];
    Pressing sum;
    press((kept.scale == 0.0 ? 1.0 : kept.scale) * law_of(i).penalty, of_a, of_b,
          kept.work != 0.0 || kept.slid != 0.0, sum);
    sum.take_off(kept.begun);
    return sum.on_a;
  }

 private:
  /// Whether no face of either has the other one on its outer side. Makes targets of both.
  BR_HD static bool meet(Partner& a, Partner& b) {
    a.target = Target::of(a.x);
    if (!a.has_volume()) return false;
    b.in_other = CornersInside::of(b.x, a.target);
    if (b.in_other.beyond_a_face()) return false;
    b.target = Target::of(b.x);
    if (!b.has_volume()) return false;
    a.in_other = CornersInside::of(a.x, b.target);
    if (a.in_other.beyond_a_face()) return false;
    a.target.measure_heights();
    b.target.measure_heights();
    return true;
  }
  /// @param holds  whether the couple has pressed before: then it does until the overlap ends
  BR_HD static void press(double penalty, const Partner& a, const Partner& b, bool holds,
                          Pressing& sum) {
    // Beside a surface most neighbours at an edge or a corner overlap by faces that are joined.
    if (!holds && !exposed_reaches_into(a, b.target) && !exposed_reaches_into(b, a.target)) return;
    Inside in_a(a.target), in_b(b.target);
    add_faces(a, b.target, penalty, true, sum, in_b, in_a);
    add_faces(b, a.target, penalty, false, sum, in_a, in_b);
    if (!holds && !sum.touches()) {
      sum = {};
      return;
    }
    in_a.add_shape_forces(a.target, penalty, sum.force.on_a.at);
    in_b.add_shape_forces(b.target, penalty, sum.force.on_b.at);
    sum.energy = in_a.energy(penalty) + in_b.energy(penalty);
  }
  /// Coulomb friction at the centre of pressure, shared among the corners by its coordinates.
  BR_HD void rub(const ContactPair& law, const Target& of_a, const Vec3 (&va)[4],
                 const Target& of_b, const Vec3 (&vb)[4], CoupleState& kept, Pressing& sum) const {
    const Vec3 centre = sum.middle();
    double share_a[4], share_b[4];
    of_a.coordinates(centre, share_a);
    of_b.coordinates(centre, share_b);
    Vec3 rate{};  // of a against b
    for (int k = 0; k < 4; ++k) rate += share_a[k] * va[k] - share_b[k] * vb[k];
    const Vec3 pull = pull_of(law, dt, rate, sum, kept);
    for (int k = 0; k < 4; ++k) {
      sum.force.on_a.at[k] += share_a[k] * pull;
      sum.force.on_b.at[k] -= share_b[k] * pull;
    }
  }
  /// A couple born in overlap, where a joint broke under compression, goes on with the joint's
  /// forces as far as friction bears them, so that neither force jumps, and stores what the joint's
  /// pressed points held, no more: with P, W of the joint, F, E of the overlap at its full penalty
  /// and x the share of E that is taken off,
  ///
  ///   s (1 - x^2) F = P,   s (1 - x)^2 E = W,   0.01 <= s <= 2,   x >= 0.
  ///
  /// A tilted joint overlaps farther at its corners than at its points, and holds far less than E.
  BR_HD void inherit(Index joint, const ContactPair& law, CoupleState& kept, const Partner& of_a,
                     const Partner& of_b) const {
    JointFailure* const legacy = broken.find(joint);
    if (legacy == nullptr || !(legacy->pressing > 0.0)) return;
    const double pressing = legacy->pressing;
    Pressing whole;
    press(law.penalty, of_a, of_b, false, whole);
    const double size = norm(whole.on_a);
    if (!(size > 0.0)) return;
    const JointWork held = legacy->held;
    const double excess = held.open > 0.0 ? pressing * whole.energy / (size * held.open) : 1.0;
    const double steeper = 0.25 * (excess + 1.0) * (excess + 1.0) / excess;  // 1/(1 - x^2)
    kept.scale = min(2.0, max(0.01, pressing / size * (excess > 1.0 ? steeper : 1.0)));
    const double energy = kept.scale * whole.energy;
    const double off = energy > held.open ? 1.0 - sqrt(held.open / energy) : 0.0;  // x
    kept.begun = off * energy;
    const double now = (1.0 - off * off) * kept.scale * size;
    const Vec3 n = (1.0 / size) * whole.on_a;
    Vec3 drag = legacy->shear_at_break;
    drag -= dot(drag, n) * n;
    const double drawn = norm(drag), most = law.friction * now;
    if (drawn > most) drag = (most / drawn) * drag;
    const double stiffness = law.tangential * 0.5 * whole.area;
    const double spring = stiffness > 0.0 ? 0.5 * dot(drag, drag) / stiffness : 0.0;
    if (!(stiffness > 0.0)) drag = {};
    if (spring > held.slide) drag = sqrt(held.slide / spring) * drag;
    kept.drag = drag;
    kept.spring = max(0.0, stiffness);
    const JointWork given = JointWork{energy, spring}.within(held);
    kept.work = given.open + given.slide;
    kept.sprung = given.slide;
    legacy->inherited = given;
  }
};

}  // namespace breccia::fdem3
