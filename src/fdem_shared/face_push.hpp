#pragma once
// Forces of elements and contacts at the face of a body on a support in the step to come:
// for its servo (fdem_shared/servo_forces.hpp).

#include <type_traits>
#include <utility>
#include <vector>

#include "core/servo.hpp"
#include "domain/owned.hpp"
#include "fdem_shared/motion.hpp"

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
  /// An element now, and its velocities by the forces of the moment.
  struct Element {
    typename Kick::Given now;
    typename Kick::Result then;
  };
  BR_HD Element element(Index t) const {
    Element e{kick.given(t), {}};
    e.then = kick(e.now);
    return e;
  }
  /// @param way  that the face goes farther  [m]
  BR_HD typename Shape::Nodes operator()(Index t, const Element& e, double way) const {
    typename Shape::Nodes after = e.now.nodes;
    for (int k = 0; k < corners; ++k) {
      auto &x = after.at[k].position, &v = after.at[k].velocity;
      const int fixed = e.now.hold >= 0 ? led.holds[e.now.hold].fixed_at(k) : 0;
      const bool leading = leads(t, k);
      v = held_parts(fixed, v, e.then.velocity[k]);
      if (leading) part_of(v, led.axis) = velocity;
      x += dt * v;
      if (!leading) continue;
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
    ServoReading r;
    add_to(r, i);
    return r;
  }
  /// The first of an element's held corners, which lie side by side, adds what all of them have.
  BR_HD void add_to(ServoReading& r, Index i) const {
    const Index t = members[i] / Shape::corners;
    if (i > 0 && members[i - 1] / Shape::corners == t) return;
    if (!owned(t) || after.led.hold[t] < 0 || after.led(t)) return;
    const auto element = after.element(t);
    const double way = little_way<Shape>(reference[t]);
    double now[corners], next[corners], farther[corners];
    find_pushes(t, element.now.nodes, now);
    find_pushes(t, after(t, element, 0.0), next);
    find_pushes(t, after(t, element, way), farther);
    for (Index k = i; k < members.size && members[k] / Shape::corners == t; ++k) {
      const Index corner = members[k] % Shape::corners;
      const double stiffness = (farther[corner] - next[corner]) / way;
      r.stiffness.add(stiffness);
      r.flow.add(stiffness * after.velocity - (next[corner] - now[corner]) / after.dt);
    }
  }

 private:
  BR_HD void find_pushes(Index t, const typename Shape::Nodes& nodes,
                         double (&pushes)[corners]) const {
    typename Shape::Vector x[corners], v[corners], on[corners];
    for (int k = 0; k < corners; ++k) {
      x[k] = nodes.at[k].position;
      v[k] = nodes.at[k].velocity;
    }
    elastic.on_corners(t, x, v, on);
    for (int k = 0; k < corners; ++k) pushes[k] = -part_of(on[k], after.led.axis);
  }
};

/// Items that belong to nobody else, for a kernel.
template <class T>
BR_HD void show(View<T>& view, T* items, Index count) {
  view.data = items;
  view.size = count;
  view.space = Space::host;
}

/// A couple's forces by its law, friction included, where its two elements will be after a step,
/// without a change of its state.
/// @param dt  of that step  [s]
template <class Couples, class Nodes>
BR_HD auto force_after(const Couples& couples, Index i, double dt, const Nodes (&nodes)[2]) {
  const Index a = 0, b = 1, no_joint = -1,
              materials[2] = {couples.material[couples.a[i]], couples.material[couples.b[i]]};
  auto state = couples.state[i];
  auto force = couples.force[i];
  auto phase = CouplePhase::acts;
  Couples alone = couples;
  std::uint8_t exposed[2] = {};
  if constexpr (requires { couples.exposed; }) {
    exposed[0] = couples.exposed[couples.a[i]];
    exposed[1] = couples.exposed[couples.b[i]];
    show<const std::uint8_t>(alone.exposed, exposed, 2);
  }
  alone.dt = dt;
  show(alone.nodes, nodes, 2);
  show(alone.material, materials, 2);
  show(alone.a, &a, 1);
  show(alone.b, &b, 1);
  show(alone.parent_joint, &no_joint, 1);
  show(alone.state, &state, 1);
  show(alone.force, &force, 1);
  show(alone.phase, &phase, 1);
  alone.slow(0);
  return force;
}

/// Couples whose elements are somewhere else, with forces and states of their own: force_after() of
/// many, on the host.
template <class Couples, class Nodes>
class CouplesElsewhere {
  using Force = std::remove_cvref_t<decltype(std::declval<Couples&>().force[0])>;
  using State = std::remove_cvref_t<decltype(std::declval<Couples&>().state[0])>;

 public:
  CouplesElsewhere(const Couples& couples, double dt) : couples_(couples) { couples_.dt = dt; }

  void add(Index i, const Nodes& a, const Nodes& b) {
    const auto element = [this](Index t, const Nodes& at, std::vector<Index>& places) {
      places.push_back(static_cast<Index>(nodes_.size()));
      nodes_.push_back(at);
      material_.push_back(couples_.material[t]);
      if constexpr (requires { couples_.exposed; }) exposed_.push_back(couples_.exposed[t]);
    };
    element(couples_.a[i], a, a_);
    element(couples_.b[i], b, b_);
    no_joint_.push_back(-1);
    state_.push_back(couples_.state[i]);
    force_.push_back(couples_.force[i]);
    phase_.push_back(CouplePhase::acts);
  }
  /// @param run  evaluates all couples of a kernel
  template <class Run>
  void evaluate(const Run& run) {
    Couples alone = couples_;
    const auto see = [](auto& view, auto& items) {
      show(view, items.data(), static_cast<Index>(items.size()));
    };
    if constexpr (requires { couples_.exposed; }) see(alone.exposed, std::as_const(exposed_));
    see(alone.nodes, std::as_const(nodes_));
    see(alone.material, std::as_const(material_));
    see(alone.a, std::as_const(a_));
    see(alone.b, std::as_const(b_));
    see(alone.parent_joint, std::as_const(no_joint_));
    see(alone.state, state_);
    see(alone.force, force_);
    see(alone.phase, phase_);
    if (!force_.empty()) run(alone, static_cast<Index>(force_.size()));
  }
  /// Of the couple that was added as number k.
  const Force& force(std::size_t k) const { return force_[k]; }

 private:
  Couples couples_;
  std::vector<Nodes> nodes_;
  std::vector<Index> material_, a_, b_, no_joint_;
  std::vector<std::uint8_t> exposed_;
  std::vector<State> state_;
  std::vector<Force> force_;
  std::vector<CouplePhase> phase_;
};

/// The push to come of contacts of elements that have corners in a face that a support holds, by
/// their law, as FacePush.
template <class Shape, class Couples, class Kick>
struct FaceContactPush {
  using After = FaceAfter<Shape, Kick>;
  OwnedView owned;
  View<const Index> listed;  ///< couples of held elements
  After after;
  Couples couples;
  View<const typename Shape::Reference> reference;

  /// A couple, and how far the face goes to feel its stiffness  [m].
  struct Pressed {
    Index couple, pair[2];
    double way;
  };
  /// @returns whether it is one of an element with corners in the face
  BR_HD bool presses(Index item, Pressed& p) const {
    const Index i = listed[item], pair[2] = {couples.a[i], couples.b[i]};
    if (!owned(pair[0]) || after.led(pair[0]) || after.led(pair[1])) return false;
    const bool by_a = after.leads_one(pair[0]);
    if (!by_a && !after.leads_one(pair[1])) return false;
    p = {i, {pair[0], pair[1]}, little_way<Shape>(reference[pair[by_a ? 0 : 1]])};
    return true;
  }
  BR_HD ServoReading operator()(Index item) const {
    ServoReading r;
    Pressed p;
    if (!presses(item, p)) return r;
    const typename After::Element a = after.element(p.pair[0]), b = after.element(p.pair[1]);
    const auto force_over = [&, this](double way) {
      const typename Shape::Nodes nodes[2] = {after(p.pair[0], a, way), after(p.pair[1], b, way)};
      return force_after(couples, p.couple, after.dt, nodes);
    };
    add(r, p, force_over(0.0), force_over(p.way));
    return r;
  }
  /// All of them, on the host. @param run  evaluates couples of a kernel
  template <class Run>
  [[gnu::flatten]] ServoReading at_once(const Run& run) const {
    std::vector<Pressed> all;
    CouplesElsewhere<Couples, typename Shape::Nodes> elsewhere(couples, after.dt);
    typename After::Element a{};
    for (Index item = 0; item < listed.size; ++item) {
      Pressed p;
      if (!presses(item, p)) continue;
      if (all.empty() || all.back().pair[0] != p.pair[0]) a = after.element(p.pair[0]);
      all.push_back(p);
      const typename After::Element b = after.element(p.pair[1]);
      const auto add_at = [&](double way) {
        elsewhere.add(p.couple, after(p.pair[0], a, way), after(p.pair[1], b, way));
      };
      add_at(0.0);
      add_at(p.way);
    }
    elsewhere.evaluate(run);
    ServoReading r;
    for (std::size_t k = 0; k < all.size(); ++k)
      add(r, all[k], elsewhere.force(2 * k), elsewhere.force(2 * k + 1));
    return r;
  }

 private:
  template <class Force>
  BR_HD void add(ServoReading& r, const Pressed& p, const Force& next, const Force& farther) const {
    const double at_next = push_of(p.pair, next);
    const double stiffness = (push_of(p.pair, farther) - at_next) / p.way;
    r.stiffness.add(stiffness);
    r.flow.add(stiffness * after.velocity -
               (at_next - push_of(p.pair, couples.force[p.couple])) / after.dt);
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

}  // namespace breccia::fdem_shared
