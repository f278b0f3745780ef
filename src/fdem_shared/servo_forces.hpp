#pragma once
// The text of fdem_shared/servos.hpp.

#include "domain/set_here.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/servos.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// A held corner takes what all else does to it. How stiff that is, it knows by its own modulus. A
/// plate knows that of contact alone where the whole element goes with it, as in a platen; else the
/// corner's own mass stands for what is tied to it.
template <class Shape>
struct SupportPush {
  OwnedView owned;
  int axis;
  double gravity;  ///< along the axis  [m/s2]
  bool plate;
  double dt;  ///< of the next step  [s]
  View<const Index> corners;
  View<const typename Shape::CornersOfElement> force;
  View<const double> mass;
  View<const Index> law_of, material;
  View<const typename Shape::Law> laws;
  View<const typename Shape::Reference> reference;
  View<const typename Shape::ContactPair> contacts;
  Index materials;
  View<const Index> hold;
  View<const typename Shape::Hold> holds;

  BR_HD ServoReading operator()(Index k) const {
    const Index n = corners[k], t = n / Shape::corners;
    ServoReading r;
    if (!owned(t)) return r;
    r.force.add(-(part_of(force[t].at[n % Shape::corners], axis) + mass[t] * gravity));
    if (!plate) {
      r.stiffness.add(Shape::corner_stiffness(laws[law_of[t]], reference[t]));
      r.mass.add(mass[t]);
    } else if (hold[t] >= 0 && goes_as_one(holds[hold[t]])) {
      const double penalty = contacts[material[t] * materials + material[t]].penalty;
      r.inertia.add(0.5 * dt * dt * Shape::pressed_corner(penalty, reference[t]));
    } else {
      r.inertia.add(mass[t]);
    }
    return r;
  }
  BR_HD static bool goes_as_one(const typename Shape::Hold& h) {
    for (int c = 1; c < Shape::corners; ++c)
      if (h.motion[c] != h.motion[0]) return false;
    return h.motion[0] >= 0;
  }
};

template <class World>
ServoReading read_support(World& part, std::size_t number, int axis, bool plate) {
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
  return fold(part.exec, corners.size, ServoReading{},
              SupportPush<Shape>{part.domain.owned_view(), axis, part_of(part.given->gravity, axis),
                                 plate, part.next_dt, corners, std::as_const(e.force).view(),
                                 std::as_const(e.mass).view(), Shape::laws(part),
                                 std::as_const(e.material).view(), part.given->laws.view(),
                                 std::as_const(Shape::reference(e)).view(),
                                 part.given->contact_pairs.view(), part.given->materials,
                                 std::as_const(e.hold).view(), part.given->holds.view()},
              Sum{});
}

template <class World, class Config>
std::vector<ServoReading> read_servos(World& part, const Config& now) {
  std::vector<ServoReading> readings;
  const std::size_t bodies = part.given->sets.size() - now.supports.size();
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const SupportServoConfig& servo = now.supports[s].servo;
    readings.push_back(servo.is_due(part.step)
                           ? read_support(part, bodies + s, servo.axis_number(), servo.is_plate())
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
    w.servos[s].correct(
        support.servo,
        support.servo.target(support.servo.aims_at(w.time, w.next_dt), support.history.begin) -
            sums[s].force.value(),
        sums[s], w.last_dt, w.next_dt);
  }
  place_servos(w);
}

}  // namespace breccia::fdem_shared
