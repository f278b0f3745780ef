#pragma once
// The text of fdem_shared/servos.hpp.

#include "core/incidence.hpp"
#include "domain/ghosts.hpp"
#include "domain/set_here.hpp"
#include "exec/fold_sum.hpp"
#include "fdem_shared/servos.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Elements that a servo moves as a whole: those of a platen.
template <class Shape>
struct LedWhole {
  std::int16_t motion;
  int axis;
  View<const Index> hold;
  View<const typename Shape::Hold> holds;

  BR_HD bool operator()(Index t) const {
    if (hold[t] < 0) return false;
    const typename Shape::Hold& h = holds[hold[t]];
    for (int k = 0; k < static_cast<int>(Shape::corners); ++k)
      if (h.motion[k] != motion || (h.fixed_at(k) >> axis & 1) == 0) return false;
    return true;
  }
};

/// A held corner takes what all else does to it. How stiff that is, it knows by its own modulus. A
/// plate knows what a platen's contacts (PlatenPush) and the elements of a face (FacePush) will do;
/// of what else may act on it the mass of its corners tells, or the most that contact can do.
template <class Shape>
struct SupportPush {
  OwnedView owned;
  int axis;
  double gravity;  ///< along the axis  [m/s2]
  bool plate;
  bool known;  ///< contact alone acts on a platen
  double dt;   ///< of the next step  [s]
  LedWhole<Shape> led;
  View<const Index> corners;
  View<const typename Shape::CornersOfElement> force;
  View<const double> mass;
  View<const Index> law_of, material;
  View<const typename Shape::Law> laws;
  View<const typename Shape::Reference> reference;
  View<const typename Shape::ContactPair> contacts;
  Index materials;
  View<const typename Shape::Sides> sides;
  View<const Index> side_a, side_b;
  View<const typename Shape::Stage> stage;

  BR_HD ServoReading operator()(Index k) const {
    const Index n = corners[k], t = n / Shape::corners;
    ServoReading r;
    if (!owned(t)) return r;
    r.force.add(-(part_of(force[t].at[n % Shape::corners], axis) + mass[t] * gravity));
    if (!plate) {
      r.stiffness.add(Shape::corner_stiffness(laws[law_of[t]], reference[t]));
      r.mass.add(mass[t]);
    } else if (!led(t)) {
      if (!known) r.inertia.add(mass[t]);
    } else if (!known || is_tied(t)) {
      const double penalty = contacts[material[t] * materials + material[t]].penalty;
      r.inertia.add(0.5 * dt * dt * Shape::pressed_corner(penalty, reference[t]));
    }
    return r;
  }
  /// Whether a joint ties it to an element that does not go with it.
  BR_HD bool is_tied(Index t) const {
    for (int k = 0; k < static_cast<int>(Shape::corners); ++k) {
      const Index entry = sides[t].at[k];
      if (entry < 0 || is_parted(stage[pair_of(entry)])) continue;
      const Index joint = pair_of(entry);
      const Index other = (side_of(entry) == 0 ? side_b[joint] : side_a[joint]) / Shape::corners;
      if (!led(other)) return true;
    }
    return false;
  }
};

/// Elements with corners in a face that a support holds: where they will be after the step to come,
/// with the face at the velocity v_0 that it has, and all else moved by the forces of the moment.
template <class Shape, class Kick>
struct FaceAfter {
  static constexpr int corners = static_cast<int>(Shape::corners);
  double dt;        ///< of the next step  [s]
  double velocity;  ///< v_0  [m/s]
  LedWhole<Shape> led;
  Kick kick;

  /// Whether a corner lies in the face.
  BR_HD bool leads(Index t, int corner) const {
    if (led.hold[t] < 0) return false;
    const typename Shape::Hold& h = led.holds[led.hold[t]];
    return h.motion[corner] == led.motion && (h.fixed_at(corner) >> led.axis & 1) != 0;
  }
  BR_HD bool leads_one(Index t) const {
    for (int k = 0; k < corners; ++k)
      if (leads(t, k)) return true;
    return false;
  }
  /// @param way  that the face goes farther  [m]
  BR_HD typename Shape::Nodes operator()(Index t, double way) const {
    const auto of = kick.given(t);
    const auto then = kick(of);
    const int none = 0;
    typename Shape::Nodes after = of.nodes;
    for (int k = 0; k < corners; ++k) {
      auto &x = after.at[k].position, &v = after.at[k].velocity;
      v = held_parts(of.hold >= 0 ? led.holds[of.hold].fixed_at(k) : none, v, then.velocity[k]);
      if (leads(t, k)) part_of(v, led.axis) = velocity;
      x += dt * v;
      if (!leads(t, k)) continue;
      part_of(x, led.axis) += way;
      part_of(v, led.axis) += way / dt;
    }
    return after;
  }
};

/// How far a face goes to feel its stiffness.  [m]
template <class Shape>
BR_HD double little_way(const typename Shape::Reference& reference) {
  constexpr double share = 1e-6;  // of an element
  return share * 100.0 * Shape::near(reference);
}

/// The push to come of an element that has corners in a face that a support holds. With the face at
/// v_0 a corner will push with P_1 in the step to come instead of P_0 now, and with K dt more for
/// each m/s more: R' = R + (P_1 - P_0) + K (v - v_0) dt. Joints between corners of the face do
/// nothing to their sum.
template <class Shape, class Elastic, class Kick>
struct FacePush {
  static constexpr int corners = static_cast<int>(Shape::corners);
  OwnedView owned;
  View<const Index> members;  ///< held corners
  FaceAfter<Shape, Kick> after;
  Elastic elastic;
  View<const typename Shape::Reference> reference;

  BR_HD ServoReading operator()(Index i) const {
    const Index t = members[i] / Shape::corners;
    const int corner = static_cast<int>(members[i] % Shape::corners);
    ServoReading r;
    if (!owned(t) || after.led.hold[t] < 0 || after.led(t)) return r;
    const double way = little_way<Shape>(reference[t]);
    const double now = push_of(t, corner, after.kick.given(t).nodes);
    const double next = push_of(t, corner, after(t, 0.0));
    const double stiffness = (push_of(t, corner, after(t, way)) - next) / way;
    r.stiffness.add(stiffness);
    r.flow.add(stiffness * after.velocity - (next - now) / after.dt);
    return r;
  }

 private:
  BR_HD double push_of(Index t, int corner, const typename Shape::Nodes& nodes) const {
    typename Shape::Vector x[corners], v[corners];
    for (int k = 0; k < corners; ++k) {
      x[k] = nodes.at[k].position;
      v[k] = nodes.at[k].velocity;
    }
    return -part_of(elastic.on_corner(t, corner, x, v), after.led.axis);
  }
};

/// A couple's forces by its law, friction included, where its two elements will be after a step,
/// without a change of its state.
/// @param dt  of that step  [s]
template <class Couples, class Nodes>
BR_HD auto force_after(const Couples& couples, Index i, double dt, const Nodes (&nodes)[2]) {
  const Index a = 0, b = 1, no_joint = -1,
              materials[2] = {couples.material[couples.a[i]], couples.material[couples.b[i]]};
  auto state = couples.state[i];
  auto force = couples.force[i];
  Couples alone = couples;
  const auto see = [](auto& view, auto* items, Index count) {
    view.data = items;
    view.size = count;
    view.space = Space::host;
  };
  std::uint8_t exposed[2] = {};
  if constexpr (requires { couples.exposed; }) {
    exposed[0] = couples.exposed[couples.a[i]];
    exposed[1] = couples.exposed[couples.b[i]];
    see(alone.exposed, exposed, 2);
  }
  alone.dt = dt;
  see(alone.nodes, nodes, 2);
  see(alone.material, materials, 2);
  see(alone.a, &a, 1);
  see(alone.b, &b, 1);
  see(alone.parent_joint, &no_joint, 1);
  see(alone.state, &state, 1);
  see(alone.force, &force, 1);
  alone.slow(0);
  return force;
}

/// The push to come of contacts of elements that have corners in a face that a support holds, by
/// their law, as FacePush.
template <class Shape, class Couples, class Kick>
struct FaceContactPush {
  OwnedView owned;
  FaceAfter<Shape, Kick> after;
  Couples couples;
  View<const typename Shape::Reference> reference;

  BR_HD ServoReading operator()(Index i) const {
    const Index pair[2] = {couples.a[i], couples.b[i]};
    ServoReading r;
    if (!owned(pair[0]) || after.led(pair[0]) || after.led(pair[1])) return r;
    const bool by_a = after.leads_one(pair[0]);
    if (!by_a && !after.leads_one(pair[1])) return r;
    const double way = little_way<Shape>(reference[pair[by_a ? 0 : 1]]);
    const double now = push_of(pair, couples.force[i]), next = push_after(i, pair, 0.0);
    const double stiffness = (push_after(i, pair, way) - next) / way;
    r.stiffness.add(stiffness);
    r.flow.add(stiffness * after.velocity - (next - now) / after.dt);
    return r;
  }

 private:
  BR_HD double push_after(Index i, const Index (&pair)[2], double way) const {
    const typename Shape::Nodes nodes[2] = {after(pair[0], way), after(pair[1], way)};
    return push_of(pair, force_after(couples, i, after.dt, nodes));
  }
  template <class Force>
  BR_HD double push_of(const Index (&pair)[2], const Force& force) const {
    double push = 0.0;
    for (int k = 0; k < static_cast<int>(Shape::corners); ++k) {
      if (after.leads(pair[0], k)) push -= part_of(to_space(force.on_a.at[k]), after.led.axis);
      if (after.leads(pair[1], k)) push -= part_of(to_space(force.on_b.at[k]), after.led.axis);
    }
    return push;
  }
};

/// The push of a platen's contacts to come. With the platen at the velocity v_0 that it has, and
/// all else moved by the forces of the moment, it will push with P_1 in the step to come instead of
/// P_0 now, and with K dt more for each m/s more: R' = R + (P_1 - P_0) + K (v - v_0) dt.
template <class Shape, class Couples, class Kick>
struct PlatenPush {
  using Vector = typename Shape::Vector;
  static constexpr int corners = static_cast<int>(Shape::corners);
  OwnedView owned;
  int axis;
  double dt;        ///< of the next step  [s]
  double velocity;  ///< v_0  [m/s]
  double most;      ///< greatest v  [m/s]
  double along;     ///< in which it presses: 1, -1
  LedWhole<Shape> led;
  Couples couples;
  Kick kick;
  View<const typename Shape::Reference> reference;

  BR_HD ServoReading operator()(Index i) const {
    ServoReading r;
    add_to(r, i);
    return r;
  }
  BR_HD void add_to(ServoReading& r, Index i) const {
    constexpr double share = 1e-6;  // of an element: how far it goes to feel the stiffness
    const Index a = couples.a[i], b = couples.b[i];
    const bool by_a = led(a);
    if (by_a == led(b) || !owned(by_a ? b : a)) return;
    Vector x[2][corners];
    place(a, 0.0, 0.0, x[0]);
    place(b, 0.0, 0.0, x[1]);
    const double now = push_of(i, by_a, x);
    place(a, dt, 0.0, x[0]);
    place(b, dt, 0.0, x[1]);
    const double next = push_of(i, by_a, x);
    const double way = share * 100.0 * Shape::near(reference[by_a ? a : b]);
    const auto stiffness_over = [&, this](double farther) {
      place(by_a ? a : b, dt, along * farther, x[by_a ? 0 : 1]);
      return max(0.0, along * (push_of(i, by_a, x) - next) / farther);
    };
    const double stiffness = stiffness_over(way), farthest = (most - along * velocity) * dt;
    r.stiffness.add(stiffness);
    r.flow.add(stiffness * velocity - (next - now) / dt);
    if (farthest > way) r.stiffer.add(stiffness_over(farthest) - stiffness);
  }

 private:
  /// Corners after `span`, of a platen `way` farther along the axis.
  BR_HD void place(Index t, double span, double way, Vector (&x)[corners]) const {
    const auto of = kick.given(t);
    for (int k = 0; k < corners; ++k) x[k] = of.nodes.at[k].position;
    if (!(span > 0.0)) return;
    if (led(t)) {
      for (int k = 0; k < corners; ++k) {
        x[k] += span * of.nodes.at[k].velocity;
        part_of(x[k], axis) += way;
      }
    } else {
      const auto next = kick(of);
      for (int k = 0; k < corners; ++k) {
        const int bits = of.hold >= 0 ? led.holds[of.hold].fixed_at(k) : 0;
        x[k] += span * held_parts(bits, of.nodes.at[k].velocity, next.velocity[k]);
      }
    }
  }
  /// On the other one along the axis.  [N; in 2D N/m]
  BR_HD double push_of(Index i, bool by_a, const Vector (&x)[2][corners]) const {
    const double on_a = part_of(couples.pressing(i, x[0], x[1]), axis);
    return by_a ? -on_a : on_a;
  }
};

/// The force that a support's servo is to push with.  [N; in 2D N/m]
template <class World, class Support>
double target_of(const World& w, const Support& support) {
  return support.servo.target(support.servo.aims_at(w.time, w.next_dt), support.history.begin);
}

/// @param number  of the set of its corners
template <class World, class Support>
ServoReading read_support(World& part, std::size_t support, std::size_t number,
                          const Support& config) {
  using Shape = ShapeOf<World>;
  const auto& set = part.given->sets[number];
  auto& e = Shape::elements(part);
  Buffer<Index> all(part.exec.space);
  View<const Index> corners;
  if (part.domain.single_rank()) {
    copy_to(all, set.nodes);
    corners = std::as_const(all).view();
  } else {
    SetHere& here = part.sets_here[number];
    keep_here(here, part.domain, e.id, set.nodes, Shape::corners, part.exec.space);
    corners = std::as_const(here.places).view();
  }
  const SupportServoConfig& servo = config.servo;
  const int axis = servo.axis_number();
  const ServoState& state = part.servos[support];
  std::int16_t motion = -2;
  for (const ServoMotion& m : part.servo_motions)
    if (m.servo == support) motion = m.motion;
  const OwnedView owned = part.domain.owned_view();
  const View<const typename Shape::Reference> reference = std::as_const(Shape::reference(e)).view();
  const LedWhole<Shape> led{motion, axis, std::as_const(e.hold).view(), part.given->holds.view()};
  FoldSum<ServoReading> sum(part.exec);
  sum.add(corners.size, SupportPush<Shape>{owned,
                                           axis,
                                           part_of(part.given->gravity, axis),
                                           servo.is_plate(),
                                           Shape::contact_alone_presses(part),
                                           part.next_dt,
                                           led,
                                           corners,
                                           std::as_const(e.force).view(),
                                           std::as_const(e.mass).view(),
                                           Shape::laws(part),
                                           std::as_const(e.material).view(),
                                           part.given->laws.view(),
                                           reference,
                                           part.given->contact_pairs.view(),
                                           part.given->materials,
                                           std::as_const(Shape::sides(part)).view(),
                                           std::as_const(Shape::side_a(part.joints)).view(),
                                           std::as_const(Shape::side_b(part.joints)).view(),
                                           std::as_const(part.joints.stage).view()});
  if (servo.is_plate()) {
    const auto couples = pressing_couples(part);
    const auto moves = kick(part);
    if (Shape::contact_alone_presses(part)) {
      const auto elastic = elastic_forces(part);
      const FaceAfter<Shape, std::remove_cv_t<decltype(moves)>> after{part.next_dt, state.velocity,
                                                                      led, moves};
      sum.add(corners.size,
              FacePush<Shape, std::remove_cv_t<decltype(elastic)>, decltype(after.kick)>{
                  owned, corners, after, elastic, reference});
      with_couples(part, [&](const auto& in_touch) {
        using InTouch = std::remove_cvref_t<decltype(in_touch)>;
        sum.add(part.couples.size(), FaceContactPush<Shape, InTouch, decltype(after.kick)>{
                                         owned, after, in_touch, reference});
      });
    }
    sum.add(part.couples.size(),
            PlatenPush<Shape, decltype(couples), decltype(moves)>{
                owned, axis, part.next_dt, state.velocity, state.share * servo.speed,
                target_of(part, config) < 0.0 ? -1.0 : 1.0, led, couples, moves, reference});
  }
  return sum.sum();
}

/// Whether a plate must know what acts on elements that other ranks own.
template <class World, class Config>
bool asks_for_ghost_forces(const World& part, const Config& now) {
  if (part.domain.single_rank() || !ShapeOf<World>::contact_alone_presses(part)) return false;
  for (const auto& support : now.supports)
    if (support.servo.is_plate()) return true;
  return false;
}

template <class World, class Config>
std::vector<ServoReading> read_servos(World& part, const Config& now) {
  if (asks_for_ghost_forces(part, now)) {
    start_ghosts(part, ShapeOf<World>::elements(part).force);
    finish_ghosts(part, ShapeOf<World>::elements(part).force);
  }
  std::vector<ServoReading> readings;
  const std::size_t bodies = part.given->sets.size() - now.supports.size();
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const auto& support = now.supports[s];
    readings.push_back(support.servo.is_due(part.step) ? read_support(part, s, bodies + s, support)
                                                       : ServoReading{});
  }
  return readings;
}

template <class World>
void place_servos(World& w) {
  for (const ServoMotion& m : w.servo_motions)
    part_of(w.prescribed[at(m.motion)].velocity, m.axis) = w.servos[m.servo].velocity;
  if (w.servo_motions.empty() || w.prescribed_velocity.empty()) return;
  std::vector<typename ShapeOf<World>::Vector> velocity;  // where launches ahead read it
  for (const auto& p : w.prescribed) velocity.push_back(p.velocity);
  copy_to(w.prescribed_velocity, velocity);
}

template <class World, class Config>
void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums) {
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const auto& support = now.supports[s];
    if (!support.servo.is_due(w.step)) continue;
    w.servos[s].correct(support.servo, target_of(w, support) - sums[s].force.value(), sums[s],
                        w.last_dt, w.next_dt);
  }
  place_servos(w);
}

}  // namespace breccia::fdem_shared
