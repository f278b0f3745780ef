#pragma once
// The text of fdem_shared/servos.hpp.

#include "core/incidence.hpp"
#include "core/select.hpp"
#include "domain/ghosts.hpp"
#include "domain/set_here.hpp"
#include "exec/fold_sum.hpp"
#include "fdem_shared/face_push.hpp"
#include "fdem_shared/servos.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

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
    ServoReading r;
    add_to(r, k);
    return r;
  }
  BR_HD void add_to(ServoReading& r, Index k) const {
    const Index n = corners[k], t = n / Shape::corners;
    if (!owned(t)) return;
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

/// The push of a platen's contacts to come. With the platen at the velocity v_0 that it has, and
/// all else moved by the forces of the moment, it will push with P_1 in the step to come instead of
/// P_0 now, and with K dt more for each m/s more: R' = R + (P_1 - P_0) + K (v - v_0) dt.
template <class Shape, class Couples, class Kick>
struct PlatenPush {
  using Vector = typename Shape::Vector;
  static constexpr int corners = static_cast<int>(Shape::corners);
  OwnedView owned;
  View<const Index> listed;  ///< couples of held elements
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
  BR_HD void add_to(ServoReading& r, Index item) const {
    const Index i = listed[item], a = couples.a[i], b = couples.b[i];
    const bool by_a = led(a);
    if (by_a == led(b) || !owned(by_a ? b : a)) return;
    Vector x[2][corners];
    place(a, 0.0, 0.0, x[0]);
    place(b, 0.0, 0.0, x[1]);
    const double now = push_of(i, by_a, x);
    place(a, dt, 0.0, x[0]);
    place(b, dt, 0.0, x[1]);
    const double next = push_of(i, by_a, x);
    const double way = little_way<Shape>(reference[by_a ? a : b]);
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

struct HoldsOne {
  View<const Index> hold, a, b;
  View<const CouplePhase> phase;
  BR_HD bool operator()(Index i) const {
    return phase[i] != CouplePhase::waits && (hold[a[i]] >= 0 || hold[b[i]] >= 0);
  }
};
template <class World>
View<const Index> held_couples(World& w) {
  HeldCouples& held = w.held_couples;
  if (!held.known) {
    const auto& pairs = std::as_const(w.couples.pairs);
    const auto& hold = std::as_const(ShapeOf<World>::elements(w).hold);
    held.item = items_where(w.exec, pairs.size(),
                            HoldsOne{hold.view(), pairs.a.view(), pairs.b.view(),
                                     std::as_const(w.couple_phase).view()});
    held.known = true;
  }
  return std::as_const(held.item).view();
}

/// @param number  of the set of its corners
template <class World, class Support>
ServoReading read_support(World& part, std::size_t support, std::size_t number,
                          const Support& config) {
  using Shape = ShapeOf<World>;
  const auto& set = part.given->sets[number];
  auto& e = Shape::elements(part);
  SetHere& here = part.sets_here[number];
  keep_here(here, part.domain, e.id, set.nodes, Shape::corners, part.exec.space);
  const View<const Index> corners = std::as_const(here.places).view();
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
  ServoReading contacts;
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
    const View<const Index> listed = held_couples(part);
    if (Shape::contact_alone_presses(part)) {
      const auto elastic = elastic_forces(part);
      const FaceAfter<Shape, std::remove_cv_t<decltype(moves)>> after{part.next_dt, state.velocity,
                                                                      led, moves};
      sum.add(corners.size,
              FacePush<Shape, std::remove_cv_t<decltype(elastic)>, decltype(after.kick)>{
                  owned, corners, after, elastic, reference});
      with_couples(part, [&](const auto& in_touch) {
        using InTouch = std::remove_cvref_t<decltype(in_touch)>;
        const FaceContactPush<Shape, InTouch, decltype(after.kick)> push{owned, listed, after,
                                                                         in_touch, reference};
        if (part.exec.space != Space::host) return sum.add(listed.size, push);
        contacts = push.at_once([&part](const auto& elsewhere, Index count) {
          run_couples_elsewhere(part, elsewhere, count);
        });
      });
    }
    sum.add(listed.size,
            PlatenPush<Shape, decltype(couples), decltype(moves)>{
                owned, listed, axis, part.next_dt, state.velocity, state.share * servo.speed,
                target_of(part, config) < 0.0 ? -1.0 : 1.0, led, couples, moves, reference});
  }
  return sum.sum() + contacts;
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
