#pragma once
// The text of fdem_shared/observe.hpp, but for probes; made for each method in its observe.cpp.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/case_config.hpp"
#include "core/on_host.hpp"
#include "core/pieces.hpp"
#include "core/state_hash.hpp"
#include "domain/owned.hpp"
#include "fdem_shared/bundle_steps.hpp"
#include "fdem_shared/joint_stages.hpp"
#include "fdem_shared/observe.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

template <class Shape>
struct HashElement {
  View<const GlobalId> id;
  View<const typename Shape::Nodes> nodes;
  BR_HD std::uint64_t operator()(Index t) const {
    ItemHash hash(id[t]);
    for (const auto& n : nodes[t].at) {
      for (int axis = 0; axis < Shape::dimension; ++axis) hash.add(part_of(n.position, axis));
      for (int axis = 0; axis < Shape::dimension; ++axis) hash.add(part_of(n.velocity, axis));
    }
    return hash.value();
  }
};

/// Of the fastest corner.
template <class Shape>
struct SpeedOf {
  View<const GlobalId> id;
  View<const typename Shape::Nodes> nodes;
  BR_HD Speed operator()(Index t) const {
    Speed speed;
    for (const auto& n : nodes[t].at) speed = Faster{}(speed, {dot(n.velocity, n.velocity), id[t]});
    return speed;
  }
};

/// The lowest global id whose numbers are unsound, or none.
template <class Shape>
struct FindUnsound {
  double dt;
  View<const GlobalId> id;
  View<const typename Shape::Nodes> nodes;
  View<const typename Shape::Reference> reference;
  BR_HD GlobalId operator()(Index t) const {
    double fastest = 0.0, sum = 0.0;
    for (const auto& n : nodes[t].at) {
      fastest = max(fastest, dot(n.velocity, n.velocity));
      for (int axis = 0; axis < Shape::dimension; ++axis)
        sum += part_of(n.position, axis) + part_of(n.velocity, axis);
    }
    const bool finite = sum - sum == 0.0;
    const typename Shape::Size size = Shape::size_of(nodes[t], reference[t]);
    return finite && size.left > 0.0 && dt * dt * fastest <= size.squared ? Unsound::none : id[t];
  }
};

/// Velocities of the corners at the time of the positions.
template <class Kick, class Corners>
struct CentreVelocities {
  static constexpr const char* name = "fdem.centre_velocities";
  Kick kick;
  View<Corners> now;
  BR_HD void operator()(Index t) const {
    const auto next = kick(t);
    int k = 0;
    for (auto& velocity : now[t].at) {
      velocity = kick.between(kick.nodes[t].at[k].velocity, next.velocity[k]);
      ++k;
    }
  }
};

/// An element's stable step by its parts, and the element.
template <class StableStep>
struct Ruling {
  typename StableStep::Parts parts{};
  Index element = 0x7fffffff;

  BR_HD bool operator<(const Ruling& other) const {
    if (parts.step != other.parts.step) return parts.step < other.parts.step;
    return element < other.element;
  }
};
template <class StableStep>
struct RulingOf {
  StableStep stable;
  bool pressed;
  BR_HD Ruling<StableStep> operator()(Index t) const {
    return {pressed ? stable.parts_pressed(t) : stable.parts(t), t};
  }
};

template <class World>
std::uint64_t state_hash(const World& w) {
  using Shape = ShapeOf<World>;
  const auto& t = Shape::elements(w);
  return fold_owned(w.exec, w.domain, t.size(), std::uint64_t{0},
                    HashElement<Shape>{t.id.view(), t.nodes.view()}, Sum{});
}

template <class World>
Fastest fastest(const World& w) {
  using Shape = ShapeOf<World>;
  const auto& t = Shape::elements(w);
  const Speed speed = fold_owned(w.exec, w.domain, t.size(), Speed{},
                                 SpeedOf<Shape>{t.id.view(), t.nodes.view()}, Faster{});
  std::vector<GlobalId> ids;
  std::vector<std::int16_t> groups;
  copy_to(ids, t.id);
  copy_to(groups, t.group);
  const auto place = std::find(ids.begin(), ids.end(), speed.id) - ids.begin();
  if (place == static_cast<std::ptrdiff_t>(ids.size())) return {};
  const auto group = static_cast<std::size_t>(groups[static_cast<std::size_t>(place)]);
  char text[200];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(text, sizeof text, "%s %d (%.100s) moves fastest, at %.3g m/s", Shape::element,
                speed.id, w.given->groups.at(group).c_str(), std::sqrt(speed.squared));
  return {speed, text};
}

/// An unsound element, and what to tell of it.
template <class World>
Unsound told_of(const World& w, GlobalId bad) {
  using Shape = ShapeOf<World>;
  const typename Shape::Elements host = host_copy(Shape::elements(w));
  const auto ids = host.id.host();
  const auto i = static_cast<Index>(std::find(ids.begin(), ids.end(), bad) - ids.begin());
  const typename Shape::Nodes& nodes = host.nodes.data()[i];
  const double left = Shape::size_of(nodes, Shape::reference(host).data()[i]).left;
  const double speed = norm(nodes.at[0].velocity);
  char how[160];  // snprintf, because nvcc does not take fmt's headers
  if (std::isfinite(left) && std::isfinite(speed))
    std::snprintf(how, sizeof how, "%s: %.3g of its %s is left, it moves at %.3e m/s",
                  left > 0.0 ? "too fast" : "inside out", left, Shape::size_word, speed);
  else
    std::snprintf(how, sizeof how, "not finite: its corners have no place or no velocity");
  char message[400];
  std::snprintf(message, sizeof message,
                "step %lld, t = %.6e s: %s %d (%s) is %s in steps of %.3e s; a smaller time.safety "
                "(now %g) may help",
                static_cast<long long>(w.step), w.time, Shape::element, bad,
                w.given->groups[static_cast<std::size_t>(host.group.data()[i])].c_str(), how,
                w.last_dt, w.given->time.safety);
  return {bad, message};
}

template <class World>
UnsoundLater find_unsound_later(const World& w) {
  using Shape = ShapeOf<World>;
  const auto& t = Shape::elements(w);
  const auto found = fold_owned_later(
      w.exec, w.domain, t.size(), Unsound::none,
      FindUnsound<Shape>{w.last_dt, t.id.view(), t.nodes.view(), Shape::reference(t).view()},
      Least{});
  return [&w, found] {
    const GlobalId bad = found.value();
    return bad == Unsound::none ? Unsound{} : told_of(w, bad);
  };
}

template <class World>
auto corner_velocities(World& w) {
  using Corners = typename ShapeOf<World>::CornersOfElement;
  Buffer<Corners> now(w.exec.space, ShapeOf<World>::elements(w).size());
  const auto of_world = kick(w);
  for_each(w.exec, now.size(),
           CentreVelocities<std::remove_cv_t<decltype(of_world)>, Corners>{of_world, now.view()});
  if (!w.domain.single_rank()) w.domain.halo.refresh(w.exec, *w.domain.ranks, now);
  std::vector<Corners> velocities;
  copy_to(velocities, now);
  return velocities;
}

template <class World>
std::vector<double> damage(const World& w) {
  using Shape = ShapeOf<World>;
  std::vector<double> worst(at(Shape::elements(w).size()), 0.0);
  if (!any_damaged(w)) return worst;
  const OnHost joints(w.joints, w.exec.space);
  const auto& j = *joints;
  using Stage = std::remove_cvref_t<decltype(j.stage.data()[0])>;
  for (Index i = 0; i < j.size(); ++i) {
    if (!is_damaged(j.stage.data()[i])) continue;
    double d = j.stage.data()[i] == Stage::broken ? 1.0 : 0.0;
    const auto& points = points_of(j, i);
    for (const auto& point : points.point) d = std::max(d, point.damage);
    for (const Index side : {Shape::side_a(j).data()[i], Shape::side_b(j).data()[i]}) {
      double& of_element = worst[at(side / Shape::corners)];
      of_element = std::max(of_element, d);
    }
  }
  return worst;
}

/// By time of break, then by number. crack(joint, its work) makes one.
/// @param gone  1: of each element that has been taken out; its cracks left with it
template <class World, class Crack, class Joints, class Make>
std::vector<Crack> cracks_of(const Joints& j, const std::vector<std::uint8_t>& gone,
                             const Make& crack) {
  using Stage = std::remove_cvref_t<decltype(j.stage.data()[0])>;
  std::vector<Crack> all;
  for (Index i = 0; i < j.size(); ++i) {
    if (j.stage.data()[i] != Stage::broken || is_beside_gone<World>(j, i, gone)) continue;
    const auto &work = j.work.data()[i], &inherited = inherited_work(j, i);
    all.push_back(crack(
        i, work.open + work.slide - inherited.open - inherited.slide - friction_of_broken(j, i)));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Crack& a, const Crack& b) { return a.time < b.time; });
  return all;
}

/// 1: of each joint that holds nothing any more.
template <class World>
std::vector<std::uint8_t> parted_joints(const World& w) {
  std::vector<std::uint8_t> parted;
  const OnHost stages(w.joints.stage, w.exec.space);
  parted.reserve(at(stages->size()));
  for (const auto stage : stages->host()) parted.push_back(is_parted(stage) ? 1 : 0);
  return parted;
}

/// Elements that hold together by joints and bonds.
/// @param broken  1: of each joint
/// @param gone    1: of each element that has been taken out; empty: none has
template <class World>
Pieces joined_elements(const World& w, const std::vector<std::uint8_t>& broken,
                       const std::vector<std::uint8_t>& gone) {
  using Shape = ShapeOf<World>;
  constexpr Index corners = Shape::corners;
  const auto stays = [&](Index t) { return gone.empty() || gone[at(t)] == 0; };
  Pieces pieces(at(Shape::sides(w).size()));
  {
    const OnHost side_a(Shape::side_a(w.joints), w.exec.space),
        side_b(Shape::side_b(w.joints), w.exec.space);
    for (std::size_t i = 0; i < broken.size(); ++i) {
      const Index a = side_a->host()[i] / corners, b = side_b->host()[i] / corners;
      if (broken[i] == 0 && stays(a) && stays(b)) pieces.join(a, b);
    }
  }
  const OnHost sides(Shape::sides(w), w.exec.space);
  for (std::size_t side = 0; side < w.across.size(); ++side) {
    const auto t = static_cast<Index>(side) / corners;
    if (sides->data()[t].at[static_cast<Index>(side) % corners] == Shape::side_bonded)
      pieces.join(t, w.across[side] / corners);
  }
  return pieces;
}

/// Pieces by falling mass.
struct OrderedPieces {
  std::vector<Index> root;  ///< of each piece
  std::vector<Index> of;    ///< number of the piece of each element
};
/// @param mass  of each piece, at its root; pieces without mass do not count  [kg]
inline OrderedPieces by_mass(Pieces& pieces, const std::vector<double>& mass) {
  OrderedPieces ordered;
  for (std::size_t t = 0; t < mass.size(); ++t)
    if (mass[t] > 0.0) ordered.root.push_back(static_cast<Index>(t));
  std::stable_sort(ordered.root.begin(), ordered.root.end(),
                   [&](Index a, Index b) { return mass[at(a)] > mass[at(b)]; });
  std::vector<Index> number(mass.size(), 0);
  for (std::size_t i = 0; i < ordered.root.size(); ++i)
    number[at(ordered.root[i])] = static_cast<Index>(i);
  ordered.of.reserve(mass.size());
  for (std::size_t t = 0; t < mass.size(); ++t)
    ordered.of.push_back(number[at(pieces.root(static_cast<Index>(t)))]);
  return ordered;
}

/// The parts of the least stable step.
template <class World>
StepParts ruling_parts(const World& w, bool pressed) {
  const Index count = ShapeOf<World>::elements(w).size();
  if (bundles_bound(w)) {
    Buffer<RowsOfCorners<StepParts, ShapeOf<World>::corners>> rows(w.exec.space);
    const StepParts alone = fold(w.exec, count, StepParts{},
                                 list_rows_kernel(w, rows, longest_step(w)(w.last_dt),
                                                  pressed ? Pressed::everywhere : Pressed::soon),
                                 Least{});
    const StepParts tied =
        fold(w.exec, count_rings(w), StepParts{}, least_of_ring_kernel(w, rows), Least{});
    return Least{}(alone, tied);
  }
  const auto stable = stable_step(w);
  using StableStep = std::remove_cv_t<decltype(stable)>;
  Ruling<StableStep> none;
  none.parts.step = no_limit;
  return fold(w.exec, count, none, RulingOf<StableStep>{stable, pressed}, Least{}).parts;
}

template <class World>
RuledStep ruled_step(const World& w, bool pressed) {
  using Shape = ShapeOf<World>;
  const StepParts least = ruling_parts(w, pressed);
  const double undamped = 2.0 / std::sqrt(least.square);
  const char* term = least.joint >= least.contact ? "joints" : "contact";
  if (least.element >= least.joint && least.element >= least.contact) term = "elements";
  if (least.step < 0.5 * undamped)
    term = least.absorbed > least.viscous ? Shape::absorbing_sides : "viscosity";
  return {least.step, term};
}

/// The steps of corners.
template <int corners>
struct StepsOfCorners {
  StepOfElement at[corners];
};
template <class StableStep, int corners>
struct ListSteps {
  static constexpr const char* name = "fdem.list_steps";
  StableStep stable;
  View<StepsOfCorners<corners>> step;
  BR_HD void operator()(Index t) const {
    for (StepOfElement& of : step[t].at) of = {stable(t), stable.mass[t]};
  }
};
/// Of corners that move by themselves; others get none.
template <class List, int corners>
struct ListStepsOfCorners {
  static constexpr const char* name = "fdem.list_steps_of_corners";
  List list;
  View<StepsOfCorners<corners>> step;
  BR_HD void operator()(Index t) const {
    list(t);
    const double mass = list.stable.mass[t];
    for (int k = 0; k < corners; ++k)
      step[t].at[k] = list.goes_with_others(t, k) || list.stable.is_held(t, k)
                          ? StepOfElement{largest_least, 0.0}
                          : StepOfElement{bound_of(list.rows[t].at[k], mass), mass};
  }
};
template <class Each, int corners>
struct ListStepsOfRing {
  static constexpr const char* name = "fdem.list_steps_of_rings";
  Each each;
  View<StepsOfCorners<corners>> step;
  BR_HD void operator()(Index ring) const {
    const Index end = each.starts[ring + 1];
    each(ring, [this, end](Index first, double bound, double mass, const RowSums& sum) {
      for (Index k = first; k < end; ++k) {
        if (each.leader[k] != first) continue;
        const Index t = each.nodes[k] / corners, corner = each.nodes[k] % corners;
        step[t].at[corner] = {bound, mass * (each.rows[t].at[corner].stiffness / sum.stiffness)};
      }
    });
  }
};

template <class World>
std::vector<StepOfElement> stable_steps(const World& w) {
  constexpr int corners = ShapeOf<World>::corners;
  Buffer<StepsOfCorners<corners>> listed(w.exec.space, ShapeOf<World>::elements(w).size());
  if (bundles_bound(w)) {
    Buffer<RowsOfCorners<RowSums, corners>> rows(w.exec.space);
    const auto list = list_rows_kernel(w, rows, longest_step(w)(w.last_dt), Pressed::soon);
    for_each(w.exec, listed.size(),
             ListStepsOfCorners<std::remove_cv_t<decltype(list)>, corners>{list, listed.view()});
    const auto each = each_bundle(w, rows);
    for_each(w.exec, count_rings(w),
             ListStepsOfRing<std::remove_cv_t<decltype(each)>, corners>{each, listed.view()});
  } else {
    const auto stable = stable_step(w);
    for_each(w.exec, listed.size(),
             ListSteps<std::remove_cv_t<decltype(stable)>, corners>{stable, listed.view()});
  }
  std::vector<StepsOfCorners<corners>> of_corners;
  copy_to(of_corners, listed);
  std::vector<StepOfElement> steps;
  steps.reserve(of_corners.size());
  for (const StepsOfCorners<corners>& of : of_corners) {
    StepOfElement least{largest_least, 0.0};
    for (const StepOfElement& corner : of.at)
      least = {std::min(least.step, corner.step), std::max(least.bears, corner.bears)};
    steps.push_back(least);
  }
  return steps;
}

}  // namespace breccia::fdem_shared
