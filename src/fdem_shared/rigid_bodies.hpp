#pragma once
// The text of fdem_shared/rigid.hpp: sums over the corners of a body, and where it goes.

#include <cmath>
#include <vector>

#include "core/energy.hpp"
#include "domain/owned.hpp"
#include "domain/set_here.hpp"
#include "domain/together.hpp"
#include "fdem_shared/rigid.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Several exact sums.
template <int count>
struct ExactSums {
  ExactSum of[count];
};
template <int count>
BR_HD ExactSums<count> operator+(ExactSums<count> a, const ExactSums<count>& b) {
  for (int k = 0; k < count; ++k) a.of[k].add(b.of[k]);
  return a;
}

/// Numbers of a turn: one in the plane.
template <class Shape>
inline constexpr int spins_of = Shape::dimension == 2 ? 1 : 3;
/// Numbers of an inertia, in the order of Sym3.
template <class Shape>
inline constexpr int inertias_of = Shape::dimension == 2 ? 1 : 6;

inline double spin_of(const double (&part)[1]) {
  return part[0];
}
inline Vec3 spin_of(const double (&part)[3]) {
  return {part[0], part[1], part[2]};
}
inline TurnOf<Vec2> turn_of(const double (&inertia)[1]) {
  return {inertia[0]};
}
inline TurnOf<Vec3> turn_of(const double (&j)[6]) {
  const Mat3 all{{j[0], j[5], j[4]}, {j[5], j[1], j[3]}, {j[4], j[3], j[2]}};
  const Mat3 over = cofactors(all);
  const double each = 1.0 / determinant(all);
  TurnOf<Vec3> turn;
  turn.inverse = {each * over.a.x, each * over.b.y, each * over.c.z,
                  each * over.b.z, each * over.a.z, each * over.a.y};
  return turn;
}

/// Corners of a body, those of elements that have been taken out left out.
template <class Shape>
struct BodyCorners {
  View<const Index> corners;
  View<const Index> hold;
  View<const typename Shape::Hold> holds;
  View<const typename Shape::Nodes> nodes;
  View<const double> mass;

  BR_HD Index element(Index i) const { return corners[i] / Shape::corners; }
  BR_HD int corner(Index i) const { return static_cast<int>(corners[i] % Shape::corners); }
  BR_HD bool is_there(Index i) const { return !is_gone<Shape>(holds, hold[element(i)]); }
};

/// Sum and torque of the forces.
template <class Shape>
struct PushOnBody {
  static constexpr int dimension = Shape::dimension, spins = spins_of<Shape>;
  using Sums = ExactSums<dimension + spins>;
  BodyCorners<Shape> body;
  View<const typename Shape::CornersOfElement> force;
  typename Shape::Vector centre;  ///<  [m]

  BR_HD Sums operator()(Index i) const {
    Sums sums;
    if (!body.is_there(i)) return sums;
    const Index t = body.element(i);
    const int k = body.corner(i);
    const auto& on = force[t].at[k];
    const auto arm = body.nodes[t].at[k].position - centre;
    for (int axis = 0; axis < dimension; ++axis) sums.of[axis].add(part_of(on, axis));
    for (int axis = 0; axis < spins; ++axis) sums.of[dimension + axis].add(moment(arm, on, axis));
    return sums;
  }
};

/// The least mass of a corner.  [kg; in 2D kg/m]
template <class Shape>
struct LeastOfBody {
  BodyCorners<Shape> body;
  BR_HD double operator()(Index i) const {
    return body.is_there(i) ? body.mass[body.element(i)] : 1e300;
  }
};

/// Mass, and mass times place and velocity, in units of mass.
template <class Shape>
struct MassOfBody {
  static constexpr int dimension = Shape::dimension;
  using Sums = ExactSums<1 + 2 * dimension>;
  BodyCorners<Shape> body;
  double unit;  ///< of mass, a power of two  [kg; in 2D kg/m]

  BR_HD Sums operator()(Index i) const {
    Sums sums;
    if (!body.is_there(i)) return sums;
    const Index t = body.element(i);
    const auto& node = body.nodes[t].at[body.corner(i)];
    const double mass = body.mass[t] / unit;
    sums.of[0].add(mass);
    for (int axis = 0; axis < dimension; ++axis) {
      sums.of[1 + axis].add(mass * part_of(node.position, axis));
      sums.of[1 + dimension + axis].add(mass * part_of(node.velocity, axis));
    }
    return sums;
  }
};

/// Angular momentum half a step before the positions, and inertia at these, about the centre of
/// mass, in units of mass and length.
template <class Shape>
struct InertiaOfBody {
  static constexpr int dimension = Shape::dimension, spins = spins_of<Shape>;
  using Vector = typename Shape::Vector;
  using Sums = ExactSums<spins + inertias_of<Shape>>;
  BodyCorners<Shape> body;
  double unit, length;  ///<  [kg; in 2D kg/m], [m]
  Vector centre;        ///<  [m]
  Vector velocity;      ///< of that  [m/s]
  double last_dt;       ///<  [s]

  BR_HD Sums operator()(Index i) const {
    Sums sums;
    if (!body.is_there(i)) return sums;
    const Index t = body.element(i);
    const auto& node = body.nodes[t].at[body.corner(i)];
    const double mass = body.mass[t] / unit;
    const Vector arm = (1.0 / length) * (node.position - centre);
    const Vector moves = node.velocity - velocity;
    const Vector before = arm - (0.5 * last_dt / length) * moves;
    for (int axis = 0; axis < spins; ++axis) sums.of[axis].add(mass * moment(before, moves, axis));
    const Vec3 r = to_space(arm);
    if constexpr (dimension == 2) {
      sums.of[spins].add(mass * dot(r, r));
    } else {
      const double all = dot(r, r);
      const double terms[6] = {all - r.x * r.x, all - r.y * r.y, all - r.z * r.z,
                               -r.y * r.z,      -r.x * r.z,      -r.x * r.y};
      for (int k = 0; k < 6; ++k) sums.of[spins + k].add(mass * terms[k]);
    }
    return sums;
  }
};

/// Gives the corners of a body its motion.
template <class Shape>
struct SetMoving {
  static constexpr const char* name = "fdem.set_moving";
  View<const Index> corners;
  View<typename Shape::Nodes> nodes;
  MotionNow<typename Shape::Vector> motion;
  BR_HD void operator()(Index i) const {
    auto& node = nodes[corners[i] / Shape::corners].at[corners[i] % Shape::corners];
    node.velocity = motion.at(node.position, 0.0);
  }
};

/// Calls visit(corners) with the corners of a set, by their places in memory.
template <class World, class Visit>
auto with_corners_of_set(World& w, std::size_t set, const Visit& visit) {
  using Shape = ShapeOf<World>;
  SetHere& here = w.sets_here[set];
  keep_here(here, w.domain, Shape::elements(w).id, w.given->sets[set].nodes, Shape::corners,
            w.exec.space);
  return visit(std::as_const(here.places).view());
}

template <class World>
BodyCorners<ShapeOf<World>> body_corners(World& w, const View<const Index>& corners) {
  auto& e = ShapeOf<World>::elements(w);
  return {corners, std::as_const(e.hold).view(), w.given->holds.view(),
          std::as_const(e.nodes).view(), std::as_const(e.mass).view()};
}

/// A sum over the corners that all ranks own. All of them call it.
/// @param kernel_of  kernel_of(corners)
template <class World, class KernelOf>
auto sum_over_body(World& w, std::size_t set, const KernelOf& kernel_of) {
  constexpr Index corners = ShapeOf<World>::corners;
  return with_corners_of_set(w, set, [&](const View<const Index>& places) {
    const auto kernel = kernel_of(body_corners(w, places));
    using Sums = decltype(kernel(Index{}));
    const Sums own = fold_owned(w.exec, w.domain, places.size, Sums{}, kernel, Sum{},
                                ListedElement<corners>{places});
    if (w.domain.single_rank()) return own;
    Sums all;
    for (const Sums& of_rank : from_each(*w.domain.ranks, own)) all = all + of_rank;
    return all;
  });
}

/// The body as its corners are now.
template <class World>
RigidStateOf<typename ShapeOf<World>::Vector> body_now(World& w, std::size_t set) {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  constexpr int dimension = Shape::dimension, spins = spins_of<Shape>;
  RigidStateOf<Vector> state;
  const double least =
      w.domain.least(with_corners_of_set(w, set, [&](const View<const Index>& places) {
        return fold_owned(w.exec, w.domain, places.size, largest_least,
                          LeastOfBody<Shape>{body_corners(w, places)}, Least{},
                          ListedElement<Shape::corners>{places});
      }));
  if (!(least < largest_least)) return state;  // all of it has been taken out
  const double unit = std::ldexp(1.0, std::ilogb(least)), length = w.given->mean_edge;
  const auto masses = sum_over_body(w, set, [&](const auto& body) {
    return MassOfBody<Shape>{body, unit};
  });
  const double mass = masses.of[0].value();
  for (int axis = 0; axis < dimension; ++axis) {
    part_of(state.centre, axis) = masses.of[1 + axis].value() / mass;
    part_of(state.velocity, axis) = masses.of[1 + dimension + axis].value() / mass;
  }
  const auto turns = sum_over_body(w, set, [&](const auto& body) {
    return InertiaOfBody<Shape>{body, unit, length, state.centre, state.velocity, w.last_dt};
  });
  state.mass = unit * mass;
  double angular[spins], inertia[inertias_of<Shape>];
  for (int k = 0; k < spins; ++k) angular[k] = unit * length * turns.of[k].value();
  for (int k = 0; k < inertias_of<Shape>; ++k)
    inertia[k] = unit * length * length * turns.of[spins + k].value();
  state.angular = spin_of(angular);
  state.turn = turn_of(inertia);
  return state;
}

/// Takes up bodies that a stage sets free, with the motion that they have, and those that have lost
/// a part; drops those that go where they are told from now on. All ranks call it.
template <class World>
void take_up_rigid_of_world(World& w) {
  if (w.rigid.empty()) return;
  std::vector<std::uint8_t> free(w.rigid.size(), 0);
  for (const auto& body : w.rigid_bodies) {
    free[body.support] = 1;
    const auto now = body_now(w, body.set);
    if (now.mass != w.rigid[body.support].mass) w.rigid[body.support] = now;
  }
  for (std::size_t s = 0; s < free.size(); ++s)
    if (free[s] == 0) w.rigid[s] = {};
}

/// Of a new world: bodies begin with the velocity and spin that their supports give, or else with
/// those of their elements.
template <class World, class Config>
void start_rigid_of_world(World& w, const Config& config) {
  using Shape = ShapeOf<World>;
  take_up_rigid_of_world(w);
  for (const auto& body : w.rigid_bodies) {
    auto& state = w.rigid[body.support];
    const auto& support = config.supports[body.support];
    const auto& velocity = support.velocity.value;
    const auto& spin = support.spin.value;
    if (dot(velocity, velocity) > 0.0 || squared(spin) > 0.0) {
      state.velocity = velocity;
      state.angular = state.turn.momentum(spin);
    }
    state.velocity =
        held_parts(body.along, state.velocity, w.prescribed[at(body.motion)].at(w.time));
    if (!body.turns) state.angular = {};
    const MotionNow<typename Shape::Vector> motion{state.velocity, state.centre,
                                                   state.turn.spin(state.angular, 0.0)};
    with_corners_of_set(w, body.set, [&](const View<const Index>& corners) {
      for_each(w.exec, corners.size,
               SetMoving<Shape>{corners, Shape::elements(w).nodes.view(), motion});
    });
  }
}

/// Where a body goes in the step to come by the forces on it now: its motion, and its state after
/// it.
template <class Vector>
struct RigidStep {
  MotionNow<Vector> motion;
  RigidStateOf<Vector> after;
};
template <class World, class Body>
auto rigid_step(World& w, const Body& body) {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  constexpr int dimension = Shape::dimension, spins = spins_of<Shape>;
  RigidStateOf<Vector> state = w.rigid[body.support];
  if (!state.is_there()) return RigidStep<Vector>{{}, state};
  const auto sums = sum_over_body(w, body.set, [&](const auto& corners) {
    return PushOnBody<Shape>{corners, std::as_const(Shape::elements(w).force).view(), state.centre};
  });
  Vector force = body.force_at(w.time);
  for (int axis = 0; axis < dimension; ++axis) part_of(force, axis) += sums.of[axis].value();
  double torque[spins];
  for (int k = 0; k < spins; ++k) torque[k] = sums.of[dimension + k].value();
  const double span = 0.5 * (w.last_dt + w.next_dt), dt = w.next_dt;
  const Vector pushed = state.velocity + span * ((1.0 / state.mass) * force + w.given->gravity);
  const Vector told = w.prescribed[at(body.motion)].at(w.time + 0.5 * dt);
  state.velocity = held_parts(body.along, pushed, told);
  state.angular = body.turns ? state.angular + span * (spin_of(torque) + body.torque_at(w.time))
                             : SpinOf<Vector>{};
  const MotionNow<Vector> motion{state.velocity, state.centre, state.turn.spin(state.angular, dt)};
  state.centre += dt * state.velocity;
  state.turn.go(dt * motion.spin);
  return RigidStep<Vector>{motion, state};
}

}  // namespace breccia::fdem_shared
