#pragma once
// Readings of probes (fdem_shared/observe.hpp): quantities of corners, stresses of elements, cracks
// of joints; made for each method in its probes.cpp, which says what stress and joints are there.

#include <algorithm>
#include <utility>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "domain/owned.hpp"
#include "domain/set_here.hpp"
#include "exec/error.hpp"
#include "fdem_shared/bolts/bolts.hpp"
#include "fdem_shared/observe.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Quantities of corners.
template <class Shape, class Kick>
struct ReadCorner {
  using Vector = typename Shape::Vector;
  static constexpr Index corners = Shape::corners;

  Quantity quantity;
  View<const Index> members;  ///< corners; empty: all
  View<const GlobalId> id;
  Kick kick;  ///< velocities are read at the time of the positions
  View<const double> damage;
  View<const Vector> starts;  ///< by global number
  ReadBox box;
  Vector about;   ///<  [m]
  StrainFit fit;  ///< of a probe of strain

  BR_HD double part(const Vector& v) const { return part_of(v, quantity.axis); }
  BR_HD bool from_start() const {
    return quantity.kind == Quantity::Kind::displacement || quantity.kind == Quantity::Kind::strain;
  }
  BR_HD double value(Index t, Index k) const {
    const auto& node = kick.nodes[t].at[k];
    const Vector velocity = kick.between(node.velocity, kick(t).velocity[k]);
    const Vector arm = node.position - about;
    switch (quantity.kind) {
      case Quantity::Kind::position:
        return part(node.position);
      case Quantity::Kind::displacement:
        return part(node.position - starts[corners * id[t] + k]);
      case Quantity::Kind::strain: {
        const Vector& start = starts[corners * id[t] + k];
        return fit.term(to_space(start), to_space(node.position - start), quantity.axis,
                        quantity.other);
      }
      case Quantity::Kind::velocity:
        return part(velocity);
      case Quantity::Kind::force:
        return part(kick.force[t].at[k]);
      case Quantity::Kind::torque:
        return moment(arm, kick.force[t].at[k], quantity.axis);
      case Quantity::Kind::momentum:
        return kick.mass[t] * part(velocity);
      case Quantity::Kind::angular_momentum:
        return kick.mass[t] * moment(arm, velocity, quantity.axis);
      case Quantity::Kind::speed:
        return norm(velocity);
      case Quantity::Kind::damage:
        return damage[t];
      default:
        break;
    }
    return 0.5 * kick.mass[t] * dot(velocity, velocity);
  }
  BR_HD Readings operator()(Index i) const {
    const Index n = members.size > 0 ? members[i] : i;
    const Index t = n / corners, k = n % corners;
    if (kick.is_gone(t)) return Readings();
    const Vector place = from_start() ? starts[corners * id[t] + k] : kick.nodes[t].at[k].position;
    if (!box.holds(to_space(place))) return Readings();
    return Readings(value(t, k), corners * id[t] + k);
  }
};

/// 1: a corner of the element is one of a set's.
template <Index corners>
struct MarkMembers {
  static constexpr const char* name = "fdem.mark_members";
  View<const Index> members;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { set_flag(marked, members[i] / corners); }
};

/// Cauchy stress of elements, without viscosity, each by its size.
/// @tparam Stress  a method's: middle(t), in space; weighted(t, i, j, id): component ij by its size
template <class Stress>
struct ReadStress {
  Quantity quantity;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< empty: all
  View<const GlobalId> id;
  Stress stress;

  BR_HD Readings operator()(Index t) const {
    if (stress.is_gone(t) || (marked.size > 0 && marked[t] == 0)) return Readings();
    if (!box.holds(stress.middle(t))) return Readings();
    return stress.weighted(t, quantity.axis, quantity.other, id[t]);
  }
};

/// Joints: 1 for each broken one, 0 for each other; or how far those that soften or are broken have
/// opened and slipped.
/// @tparam Ends   a method's: sides a and b, middle(i), in space, opening(i), slip(i)
template <class Ends, class Stage, Index corners>
struct ReadJoints {
  Quantity::Kind kind;
  ReadBox box;
  View<const std::uint8_t> marked;  ///< of elements; empty: all
  View<const GlobalId> id;
  View<const Stage> stage;
  Ends ends;

  BR_HD Readings operator()(Index i) const {
    const Index side = ends.side_a[i], a = side / corners, b = ends.side_b[i] / corners;
    if (marked.size > 0 && marked[a] == 0 && marked[b] == 0) return Readings();
    if (!box.holds(ends.middle(i))) return Readings();
    const Index number = corners * id[a] + side % corners;
    if (kind == Quantity::Kind::broken)
      return Readings(stage[i] == Stage::broken ? 1.0 : 0.0, number);
    if (!is_damaged(stage[i])) return Readings();
    return Readings(kind == Quantity::Kind::opening ? ends.opening(i) : ends.slip(i), number);
  }
};

template <class World>
ReadingsLater read_corners(const World& w, const ProbeConfig& p, const Quantity& quantity,
                           const Buffer<Index>& members) {
  using Shape = ShapeOf<World>;
  Buffer<double> lost(w.exec.space);
  if (quantity.kind == Quantity::Kind::damage) copy_to(lost, damage(w));
  StrainFit fit;
  for (const ProbeFit& of_probe : w.given->strain_fits)
    if (of_probe.probe == p.name) fit = of_probe.fit;
  const auto& t = Shape::elements(w);
  const auto of_world = kick(w);
  const auto readings = fold_owned_later(
      w.exec, w.domain, p.on.empty() ? Shape::corners * t.size() : members.size(), Readings{},
      ReadCorner<Shape, std::remove_cv_t<decltype(of_world)>>{
          quantity, members.view(), t.id.view(), of_world, std::as_const(lost).view(),
          w.given->starts.view(), ReadBox(p.min, p.max),
          from_space<typename Shape::Vector>(point_of(p.about)), fit},
      Sum{}, MemberElement<Shape::corners>{members.view()});
  return [readings] { return readings.value(); };
}

/// @param members  of the set that the probe names, by their places in memory
template <class World>
ReadingsLater read(const World& w, const ProbeConfig& p, const Buffer<Index>& members) {
  using Shape = ShapeOf<World>;
  using Kind = Quantity::Kind;
  const Quantity quantity = quantity_named(p.quantity).quantity;
  const Kind kind = quantity.kind;
  const bool joints = kind == Kind::broken || kind == Kind::opening || kind == Kind::slip;
  if (kind != Kind::stress && !joints) return read_corners(w, p, quantity, members);
  const auto& t = Shape::elements(w);
  Buffer<std::uint8_t> marks(w.exec.space);
  if (!p.on.empty()) {
    copy_to(marks, std::vector<std::uint8_t>(at(t.size()), 0));
    for_each(w.exec, members.size(), MarkMembers<Shape::corners>{members.view(), marks.view()});
  }
  const View<const std::uint8_t> marked = std::as_const(marks).view();
  const ReadBox box(p.min, p.max);
  if (kind == Kind::stress) {
    const auto stress = stress_to_read(w);
    const auto readings = fold_owned_later(
        w.exec, w.domain, t.size(), Readings{},
        ReadStress<std::remove_cv_t<decltype(stress)>>{quantity, box, marked, t.id.view(), stress},
        Sum{});
    return [readings] { return readings.value(); };
  }
  const auto ends = joints_to_read(w);
  const auto stage = w.joints.stage.view();
  using Stage = std::remove_cvref_t<decltype(stage[0])>;
  const auto readings =
      fold_owned_later(w.exec, w.domain, w.joints.size(), Readings{},
                       ReadJoints<std::remove_cv_t<decltype(ends)>, Stage, Shape::corners>{
                           kind, box, marked, t.id.view(), stage, ends},
                       Sum{}, ListedElement<Shape::corners>{ends.side_a});
  return [readings] { return readings.value(); };
}

/// Of a rank's own elements, and not of bolts.
template <class World>
ReadingsLater read_elements(const World& part, const ProbeConfig& p) {
  using Shape = ShapeOf<World>;
  if (p.on.empty()) return read(part, p, Buffer<Index>(part.exec.space));
  const auto& sets = part.given->sets;
  const auto set =
      std::find_if(sets.begin(), sets.end(), [&](const auto& s) { return s.name == p.on; });
  if (set == sets.end())
    throw InputError("probe " + p.name + ".on: there is no body or support \"" + p.on + "\"");
  SetHere& here = part.sets_here[static_cast<std::size_t>(set - sets.begin())];
  keep_here(here, part.domain, Shape::elements(part).id, set->nodes, Shape::corners,
            part.exec.space);
  return read(part, p, here.places);
}

template <class World>
std::function<double()> probe_later(const World& w, const ProbeConfig& p) {
  if (const auto bolt = read_bolt(w, p)) return [value = bolt->reduced(p.reduce)] { return value; };
  constexpr auto where = ShapeOf<World>::dimension == 2 ? in_plane : in_solid;
  for (const std::string& problem : probe_problems(p, where)) throw InputError(problem);
  return [read = read_elements(w, p), how = p.reduce] { return read().reduced(how); };
}

template <class World>
Readings read_own(World& part, const ProbeConfig& p) {
  const auto bolt = read_bolt(part, p);
  return bolt ? *bolt : read_elements(part, p)();
}

}  // namespace breccia::fdem_shared
