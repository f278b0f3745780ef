// Readings of probes: quantities of elements and walls, the stress of a box, broken links.

#include <algorithm>
#include <optional>
#include <utility>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "core/probe.hpp"
#include "dem/free_walls.hpp"
#include "dem/observe.hpp"
#include "domain/owned.hpp"
#include "exec/error.hpp"

namespace breccia::dem {
namespace {

/// Quantities of elements.
struct ReadProbe {
  Quantity quantity;
  View<const Index> members;  ///< empty: all elements
  View<const GlobalId> id;
  Kick kick;  ///< velocities are read at the time of the positions
  View<const double> damage;
  View<const Vec3> starts;  ///< by global id
  ReadBox box;
  Vec3 about;     ///<  [m]
  StrainFit fit;  ///< of a probe of strain

  BR_HD double part(const Vec3& v) const { return on_axis(v, quantity.axis); }
  BR_HD bool from_start() const {
    return quantity.kind == Quantity::Kind::displacement || quantity.kind == Quantity::Kind::strain;
  }
  BR_HD double value(Index e) const {
    const ElementState& s = kick.state[e];
    switch (quantity.kind) {
      case Quantity::Kind::position:
        return part(s.position);
      case Quantity::Kind::displacement:
        return part(s.position - starts[id[e]]);
      case Quantity::Kind::strain:
        return fit.term(starts[id[e]], s.position - starts[id[e]], quantity.axis, quantity.other);
      case Quantity::Kind::force:
        return part(kick.force[e]);
      case Quantity::Kind::torque:
        return part(cross(s.position - about, kick.force[e]) + kick.torque[e]);
      case Quantity::Kind::damage:
        return damage[e];
      default:
        return of_motion(e);
    }
  }
  BR_HD double of_motion(Index e) const {
    const ElementState& s = kick.state[e];
    const Kick::Result next = kick(e);
    const Vec3 velocity = kick.between(s.velocity, next.velocity);
    const Vec3 spin = kick.between(s.spin, next.spin);
    switch (quantity.kind) {
      case Quantity::Kind::velocity:
        return part(velocity);
      case Quantity::Kind::momentum:
        return kick.mass[e] * part(velocity);
      case Quantity::Kind::angular_momentum:
        return part(kick.mass[e] * cross(s.position - about, velocity) + kick.inertia[e] * spin);
      case Quantity::Kind::speed:
        return norm(velocity);
      default:
        break;
    }
    return 0.5 * kick.mass[e] * dot(velocity, velocity) + 0.5 * kick.inertia[e] * dot(spin, spin);
  }
  BR_HD Readings operator()(Index i) const {
    const Index e = members.size > 0 ? members[i] : i;
    if (!box.holds(from_start() ? starts[id[e]] : kick.state[e].position)) return Readings();
    return Readings(value(e), id[e]);
  }
};

/// Share of an interaction in the volume times the mean stress of a box (Weber, Love): its force,
/// on the way between its ends that lies inside. Tension is positive.  [N m]
struct BranchStress {
  ReadBox box;
  int i, j;

  /// @param force  on the end at q
  BR_HD double operator()(const Vec3& p, const Vec3& q, const Vec3& force) const {
    const Vec3 way = q - p;
    const double both = on_axis(force, i) * on_axis(way, j) + on_axis(force, j) * on_axis(way, i);
    return both == 0.0 ? 0.0 : -0.5 * both * box.share(p, q);
  }
};

/// Of concrete links, by what they keep.
template <class Number>
struct ConcreteStress {
  BranchStress branch;
  ConcreteLink law;
  Index first;
  View<const ElementState> state;
  View<const Index> a, b;
  View<const double> length, stiffness, area, rate;
  View<const Number> opening;
  PlanesView<const Number> shear;
  View<const float> branch_normal;
  PlanesView<const float> branch_shear;

  BR_HD ExactSum operator()(Index k) const {
    const Index i = first + k;
    const ElementState &s = state[a[i]], &t = state[b[i]];
    const double touching = s.radius + t.radius;
    LinkConstants<double> link{length[i], stiffness[i], area[i], 0.5 * touching, touching};
    LinkState<double> kept{opening[i], shear[i], {}};
    if (law.rated()) link.factor = law.factor_of<double>(link, kept.opening, rate[i]);
    if (law.damps()) kept.branch = {branch_normal[i], branch_shear[i]};
    const Vec3 on_b = law.force_on_b(link, t.position - s.position, kept);
    return ExactSum(branch(s.position, t.position, on_b));
  }
};

/// Of interactions that write their actions.
struct ActionStress {
  BranchStress branch;
  View<const ElementState> state;
  View<const Index> a, b;
  View<const PairForce> actions;
  Index first;  ///< action of interaction 0

  BR_HD ExactSum operator()(Index i) const {
    return ExactSum(
        branch(state[a[i]].position, state[b[i]].position, actions[first + i].force_on_b()));
  }
};

struct WallStress {
  BranchStress branch;
  View<const ElementState> state;
  View<const Wall> walls;
  View<const Index> a, b;
  View<const Vec3> on_wall, place;

  BR_HD ExactSum operator()(Index i) const {
    const Vec3& x = state[a[i]].position;
    return ExactSum(branch(x, foot_on(walls[b[i]], x, place[i]), on_wall[i]));
  }
};

template <class Law>
ExactSum link_stress(const World& w, const LinkSet<Law>& set, const BranchStress& branch,
                     Index& first_action) {
  const auto state = w.elements.state.view();
  ExactSum sum;
  if constexpr (LinkSet<Law>::kind == LinkKind::concrete) {
    with_number(w.exec.precision, [&](auto number) {
      using Number = decltype(number);
      const LinkHistory<Number>& kept = set.kept.template as<Number>();
      for (const auto& g : set.groups)
        sum.add(fold_owned(
            w.exec, w.domain, g.end - g.begin, ExactSum(),
            ConcreteStress<Number>{branch, g.law, g.begin, state, set.a.view(), set.b.view(),
                                   set.length.view(), set.stiffness.view(), set.area.view(),
                                   set.rate.view(), kept.opening.view(), kept.shear.view(),
                                   set.branch_normal.view(), set.branch_shear.view()},
            Sum{}, ListedElement<>{set.a.view(), g.begin}));
    });
  } else {
    sum = fold_owned(
        w.exec, w.domain, set.size(), ExactSum(),
        ActionStress{branch, state, set.a.view(), set.b.view(), w.bar_actions.view(), first_action},
        Sum{}, ListedElement<>{set.a.view()});
    first_action += set.size();
  }
  return sum;
}

bool is_first(const World& w) {
  return w.domain.single_rank() || w.domain.ranks->rank() == 0;
}

/// Mean stress of a box from links, contacts and walls; the first rank adds the volume.
Readings read_stress(const World& w, const ProbeConfig& p) {
  const Quantity quantity = quantity_named(p.quantity).quantity;
  const BranchStress branch{ReadBox(p.min, p.max), quantity.axis, quantity.other};
  const auto state = w.elements.state.view();
  Readings r;
  Index first_action = 0;
  w.each_set([&](const auto& set) { r.sum.add(link_stress(w, set, branch, first_action)); });
  const auto& pairs = w.contacts.pairs;
  r.sum.add(fold_owned(
      w.exec, w.domain, w.contacts.size(), ExactSum(),
      ActionStress{branch, state, pairs.a.view(), pairs.b.view(), w.contact_actions.view(), 0},
      Sum{}, ListedElement<>{pairs.a.view()}));
  Buffer<Wall> walls(w.exec.space);
  copy_to(walls, w.walls);
  const auto& at_walls = w.wall_contacts.pairs;
  r.sum.add(fold_owned(
      w.exec, w.domain, w.wall_contacts.size(), ExactSum(),
      WallStress{branch, state, std::as_const(walls).view(), at_walls.a.view(), at_walls.b.view(),
                 w.wall_contacts.history.on_wall.view(), w.wall_contacts.history.place.view()},
      Sum{}, ListedElement<>{at_walls.a.view()}));
  if (is_first(w)) r.weight = ExactSum(branch.box.volume());
  return r;
}

struct Mark {
  static constexpr const char* name = "dem.mark_members";
  View<const Index> members;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { marked[members[i]] = 1; }
};
/// Links of a set of elements, by their middles. @tparam Value  value(i, id) of one: its Readings
template <class Value>
struct ReadLinks {
  ReadBox box;
  View<const std::uint8_t> marked;  ///< empty: all elements
  View<const ElementState> state;
  View<const GlobalId> id;
  View<const Index> a, b;
  Index first;
  Value value;

  BR_HD Readings operator()(Index k) const {
    const Index i = first + k, p = a[i], q = b[i];
    if (marked.size > 0 && marked[p] == 0 && marked[q] == 0) return Readings();
    if (!box.holds(0.5 * (state[p].position + state[q].position))) return Readings();
    return value(i, id[p]);
  }
};
/// 1 for each broken link, 0 for each other one.
template <class Broken>
struct WhetherBroken {
  Broken is_broken;
  BR_HD Readings operator()(Index i, GlobalId at) const {
    return Readings(is_broken(i) ? 1.0 : 0.0, at);
  }
};
/// With which pieces of bar are pulled.  [N]
struct PullOfBar {
  View<const ElementState> state;
  View<const Index> a, b;
  View<const PairForce> actions;
  Index first;  ///< action of piece 0

  BR_HD Readings operator()(Index i, GlobalId at) const {
    const Vec3 way = state[b[i]].position - state[a[i]].position;
    return Readings(-dot(actions[first + i].force_on_b(), way) / norm(way), at);
  }
};
/// How far concrete links that soften or are broken are open beyond what the force that they still
/// bear asks for.
template <class Number>
struct OpeningOfConcrete {
  ConcreteLink law;
  View<const ElementState> state;
  View<const Index> a, b;
  View<const double> length, stiffness, area, rate;
  View<const Number> largest;

  BR_HD Readings operator()(Index i, GlobalId at) const {
    const ElementState &s = state[a[i]], &t = state[b[i]];
    const double touching = s.radius + t.radius, most = largest[i];
    LinkConstants<double> link{length[i], stiffness[i], area[i], 0.5 * touching, touching};
    if (law.rated()) link.factor = law.factor_of(link, most, rate[i]);
    if (most >= 0.0 && !(law.damage(link, most) > 0.0)) return Readings();
    const double stretch = norm(t.position - s.position) - length[i];
    return Readings(max(0.0, stretch - law.normal_force(link, stretch, most) / link.stiffness), at);
  }
};
/// Of facets of LDPM, what is not elastic of their strain across; 0: none.
struct OpeningOfFacet {
  LdpmFacet law;
  View<const LdpmPlace> place;
  View<const LdpmFacetState> facet;

  BR_HD Readings operator()(Index i, GlobalId at) const {
    const double open = law.opening(place[i].length, facet[i]);
    return open > 0.0 ? Readings(open, at) : Readings();
  }
};

Readings read_links(const World& w, const ProbeConfig& p, View<const Index> members,
                    Quantity::Kind kind) {
  Buffer<std::uint8_t> marked(w.exec.space);
  if (!p.on.empty()) {
    copy_to(marked, std::vector<std::uint8_t>(static_cast<std::size_t>(w.elements.size()), 0));
    for_each(w.exec, members.size, Mark{members, marked.view()});
  }
  Readings all;
  const auto state = w.elements.state.view();
  const auto add = [&](const auto& set, Index first, Index end, const auto& value) {
    using Value = std::remove_cv_t<std::remove_reference_t<decltype(value)>>;
    all = all + fold_owned(w.exec, w.domain, end - first, Readings{},
                           ReadLinks<Value>{ReadBox(p.min, p.max), std::as_const(marked).view(),
                                            state, w.elements.id.view(), set.a.view(), set.b.view(),
                                            first, value},
                           Sum{}, ListedElement<>{set.a.view(), first});
  };
  const auto add_openings = [&](const auto& set, auto number) {
    using Number = decltype(number);
    constexpr LinkKind of = std::remove_reference_t<decltype(set)>::kind;
    for (const auto& g : set.groups) {
      if constexpr (of == LinkKind::concrete)
        add(set, g.begin, g.end,
            OpeningOfConcrete<Number>{g.law, state, set.a.view(), set.b.view(), set.length.view(),
                                      set.stiffness.view(), set.area.view(), set.rate.view(),
                                      set.kept.template as<Number>().opening.view()});
      else if constexpr (of == LinkKind::ldpm)
        add(set, g.begin, g.end, OpeningOfFacet{g.law, set.place.view(), set.state.view()});
    }
  };
  if (kind == Quantity::Kind::axial_force) {
    constexpr Index first = 0;  // actions of other links come behind those of bars
    add(w.steel, 0, w.steel.size(),
        PullOfBar{state, w.steel.a.view(), w.steel.b.view(), w.bar_actions.view(), first});
    return all;
  }
  w.each_set([&](const auto& set) {
    with_number(w.exec.precision, [&](auto number) {
      if (kind == Quantity::Kind::opening) return add_openings(set, number);
      const auto is_broken = set.template broken<decltype(number)>();
      add(set, 0, set.size(), WhetherBroken<std::remove_const_t<decltype(is_broken)>>{is_broken});
    });
  });
  return all;
}

StrainFit fit_of(const World& w, const ProbeConfig& p) {
  for (const ProbeFit& fit : w.given->strain_fits)
    if (fit.probe == p.name) return fit.fit;
  return {};
}

/// Readings that are there already.
ReadingsLater known(const Readings& readings) {
  return [readings] { return readings; };
}

ReadingsLater read(const World& w, const ProbeConfig& p, View<const Index> members) {
  const Elements& e = w.elements;
  const Quantity quantity = quantity_named(p.quantity).quantity;
  if (quantity.kind == Quantity::Kind::stress) return known(read_stress(w, p));
  if (quantity.kind == Quantity::Kind::broken || quantity.kind == Quantity::Kind::opening ||
      quantity.kind == Quantity::Kind::axial_force)
    return known(read_links(w, p, members, quantity.kind));
  Buffer<double> lost(w.exec.space);
  if (quantity.kind == Quantity::Kind::damage) lost = damage_of(w);
  const auto readings = fold_owned_later(
      w.exec, w.domain, p.on.empty() ? e.size() : members.size, Readings{},
      ReadProbe{quantity, members, e.id.view(), kick(w), std::as_const(lost).view(),
                w.given->starts.view(), ReadBox(p.min, p.max), point_of(p.about), fit_of(w, p)},
      Sum{}, MemberElement<>{members});
  return [readings] { return readings.value(); };
}

/// A component of the force on a wall, or of its torque about a point.
struct PushOnWall {
  Index first;  ///< contact of the wall
  int axis;
  bool turns;
  Wall wall;
  Vec3 about;  ///<  [m]
  View<const ElementState> state;
  View<const Index> a;
  View<const Vec3> on_wall, place;
  BR_HD ExactSum operator()(Index k) const {
    const Index i = first + k;
    const Vec3& f = on_wall[i];
    if (!turns) return ExactSum(on_axis(f, axis));
    const Vec3 foot = foot_on(wall, state[a[i]].position, place[i]);
    return ExactSum(on_axis(cross(foot - about, f), axis));
  }
};

/// The wall of a probe; none: the probe reads elements.
std::optional<std::size_t> wall_of(const World& w, const ProbeConfig& p) {
  const auto name = std::find(w.given->wall_names.begin(), w.given->wall_names.end(), p.on);
  if (p.on.empty() || name == w.given->wall_names.end()) return std::nullopt;
  return static_cast<std::size_t>(name - w.given->wall_names.begin());
}

double motion_of_wall(const World& w, const Quantity& quantity, std::size_t wall,
                      const Vec3& about) {
  const Wall& own = w.walls[wall];
  const bool free = is_free(w, wall);
  const Vec3 velocity = free ? velocity_of_free_wall(w, wall) : own.velocity;
  const double mass = free ? w.given->free_walls[wall].mass : 0.0;
  switch (quantity.kind) {
    case Quantity::Kind::position:
      return on_axis(own.point, quantity.axis);
    case Quantity::Kind::displacement:
      return on_axis(own.point - w.given->wall_starts[wall], quantity.axis);
    case Quantity::Kind::velocity:
      return on_axis(velocity, quantity.axis);
    case Quantity::Kind::momentum:
      return mass * on_axis(velocity, quantity.axis);
    case Quantity::Kind::angular_momentum:
      return free ? on_axis(angular_momentum_of_wall(w, wall, about), quantity.axis) : 0.0;
    case Quantity::Kind::kinetic:
      return free ? kinetic_of_free_wall(w, wall) : 0.0;
    default:
      return norm(velocity);
  }
}

/// A wall's place and velocity, which rank 0 knows as well as all, and what this rank's elements
/// push it with.
ReadingsLater read_wall(const World& w, const ProbeConfig& p, std::size_t wall) {
  const Quantity quantity = quantity_named(p.quantity).quantity;
  const bool first = is_first(w);
  const Wall& own = w.walls[wall];
  const bool turns = quantity.kind == Quantity::Kind::torque;
  if (quantity.kind != Quantity::Kind::force && !turns) {
    return known(first ? Readings(motion_of_wall(w, quantity, wall, point_of(p.about)), 0)
                       : Readings());
  }
  Readings read;
  if (first) read = Readings(0.0, 0);
  if (wall + 1 >= w.wall_begin.size()) return known(read);  // no search yet
  const Index begin = w.wall_begin[wall], end = w.wall_begin[wall + 1];
  const auto push = fold_owned_later(
      w.exec, w.domain, end - begin, ExactSum(),
      PushOnWall{begin, quantity.axis, turns, own, point_of(p.about), w.elements.state.view(),
                 w.wall_contacts.pairs.a.view(), w.wall_contacts.history.on_wall.view(),
                 w.wall_contacts.history.place.view()},
      Sum{}, ListedElement<>{w.wall_contacts.pairs.a.view(), begin});
  return [read, push]() mutable {
    read.sum.add(push.value());
    return read;
  };
}

}  // namespace

std::function<double()> probe_later(const World& w, const ProbeConfig& p) {
  if (const auto wall = wall_of(w, p))
    return [read = read_wall(w, p, *wall)] { return read().sum.value(); };
  View<const Index> members{};
  if (!p.on.empty()) {
    const auto set = std::find_if(w.given->sets.begin(), w.given->sets.end(),
                                  [&](const ElementSet& s) { return s.name == p.on; });
    if (set == w.given->sets.end())
      throw InputError("probe " + p.name + ": there is no group " + p.on);
    members = set->members.view();
  }
  return [read = read(w, p, members), how = p.reduce] { return read().reduced(how); };
}

Readings read_own(World& part, const ProbeConfig& p) {
  if (const auto wall = wall_of(part, p)) return read_wall(part, p, *wall)();
  const auto set = std::find_if(part.given->sets.begin(), part.given->sets.end(),
                                [&](const ElementSet& s) { return s.name == p.on; });
  if (set == part.given->sets.end()) return read(part, p, {})();
  SetHere& here = part.sets_here[static_cast<std::size_t>(set - part.given->sets.begin())];
  keep_here(here, part.domain, part.elements.id, set->members.host(), 1, part.exec.space);
  return read(part, p, std::as_const(here.places).view())();
}

}  // namespace breccia::dem
