#include "dem/observe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/on_host.hpp"
#include "core/pieces.hpp"
#include "core/rows.hpp"
#include "core/state_hash.hpp"
#include "domain/owned.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"
#include "math/constants.hpp"

namespace breccia::dem {
namespace {

struct HashElement {
  View<const GlobalId> id;
  View<const ElementState> state;
  View<const Quaternion> orientation;
  BR_HD std::uint64_t operator()(Index e) const {
    ItemHash hash(id[e]);
    hash.add(state[e].position);
    hash.add(state[e].velocity);
    hash.add(state[e].spin);
    const Quaternion& q = orientation[e];
    hash.add(Vec3{q.x, q.y, q.z});
    hash.add(q.w);
    return hash.value();
  }
};

/// The lowest global id whose numbers are unsound, or none.
struct FindUnsound {
  double dt;
  Vec3 drift;  ///< velocity that all share  [m/s]
  View<const GlobalId> id;
  View<const ElementState> state;
  BR_HD GlobalId operator()(Index e) const {
    const Vec3 x = state[e].position, v = state[e].velocity - drift, spin = state[e].spin;
    const double radius = state[e].radius;
    const double travelled = dt * dt * dot(v, v);
    const double sum = x.x + x.y + x.z + dot(spin, spin);
    const bool finite = sum - sum == 0.0;            // false for NaN and infinity
    const bool slow = travelled <= radius * radius;  // false for NaN, too
    return finite && slow ? Unsound::none : id[e];
  }
};

struct SpeedOf {
  View<const GlobalId> id;
  View<const ElementState> state;
  BR_HD Speed operator()(Index e) const {
    return {dot(state[e].velocity, state[e].velocity), id[e]};
  }
};

struct CentreMotion {
  static constexpr const char* name = "dem.centre_motion";
  Kick kick;
  View<Vec3> velocity, spin;
  BR_HD void operator()(Index e) const {
    const Kick::Result next = kick(e);
    velocity[e] = kick.between(kick.state[e].velocity, next.velocity);
    spin[e] = kick.between(kick.state[e].spin, next.spin);
  }
};

/// Damage of links is added up in whole parts of a link, in any order: below `one_link` what an
/// element's links have lost, above it how many they are.
constexpr std::uint64_t parts_of_a_link = 1024, one_link = std::uint64_t{1} << 32;

/// Adds a link's damage to both of its ends.
struct AddDamage {
  View<const Index> a, b;
  View<std::uint64_t> lost;
  bool alone;  ///< whether one thread takes all links

  template <class Law>
  AddDamage to(const LinkSet<Law>& set) const {
    return {set.a.view(), set.b.view(), lost, alone};
  }
  BR_HD void operator()(Index i, double damage) const {
    const auto parts =
        static_cast<std::uint64_t>(static_cast<double>(parts_of_a_link) * damage + 0.5);
    for (const Index e : {a[i], b[i]})
      if (alone)
        lost[e] += one_link + parts;
      else
        count_up(lost[e], one_link + parts);
  }
};
template <class Number>
struct ConcreteDamage {
  AddDamage add;
  ConcreteLink law;
  Index first;
  View<const Number> opening;
  View<const double> length, stiffness, area, rate;

  BR_HD void operator()(Index k) const {
    const Index i = first + k;
    const double so_far = opening[i];
    LinkConstants<double> link{length[i], stiffness[i], area[i], 0.0, 0.0};
    if (law.rated()) link.factor = law.factor_of(link, so_far, rate[i]);
    add(i, so_far < 0.0 ? 1.0 : law.damage(link, so_far));
  }
};
/// Links that are whole or broken.
template <class Broken>
struct BrokenDamage {
  AddDamage add;
  Broken is_broken;
  BR_HD void operator()(Index i) const { add(i, is_broken(i) ? 1.0 : 0.0); }
};
/// Notes when a link was first seen broken.
template <class Broken>
struct NoteBreak {
  Broken is_broken;
  double now;  ///<  [s]
  View<double> seen_broken;
  BR_HD void operator()(Index i) const {
    if (seen_broken[i] < 0.0 && is_broken(i)) seen_broken[i] = now;
  }
};
struct Damage {
  View<const std::uint64_t> lost;
  View<double> damage;
  BR_HD void operator()(Index e) const {
    const std::uint64_t links = lost[e] / one_link;
    const auto whole = static_cast<double>(parts_of_a_link * links);
    damage[e] = links > 0 ? static_cast<double>(lost[e] % one_link) / whole : 0.0;
  }
};

/// Calls visit(kind, a, b, broken) for each link, with both its ends.
template <class Visit>
void each_link(const World& w, const Visit& visit) {
  w.each_set([&](const auto& set) {
    const OnHost arrays(set.arrays(), w.exec.space);
    with_number(w.exec.precision, [&](auto number) {
      const auto is_broken = arrays->template broken<decltype(number)>();
      for (Index i = 0; i < arrays->size(); ++i)
        visit(set.kind, arrays->a.data()[i], arrays->b.data()[i], is_broken(i));
    });
  });
}

}  // namespace

std::uint64_t state_hash(const World& w) {
  const Elements& e = w.elements;
  return fold_owned(w.exec, w.domain, e.size(), std::uint64_t{0},
                    HashElement{e.id.view(), e.state.view(), e.orientation.view()}, Sum{});
}

Fastest fastest(const World& w) {
  const Elements& e = w.elements;
  const Speed speed = fold_owned(w.exec, w.domain, e.size(), Speed{},
                                 SpeedOf{e.id.view(), e.state.view()}, Faster{});
  std::vector<GlobalId> ids;
  std::vector<std::int16_t> groups;
  copy_to(ids, e.id);
  copy_to(groups, e.group);
  const auto at = std::find(ids.begin(), ids.end(), speed.id) - ids.begin();
  if (at == static_cast<std::ptrdiff_t>(ids.size())) return {};
  const auto group = static_cast<std::size_t>(groups[static_cast<std::size_t>(at)]);
  char text[200];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(text, sizeof text, "element %d (%.100s) moves fastest, at %.3g m/s", speed.id,
                w.given->sets.at(group).name.c_str(), std::sqrt(speed.squared));
  return {speed, text};
}

namespace {

/// An unsound element, and what to tell of it.
Unsound told_of(const World& w, GlobalId bad) {
  const Elements host = host_copy(w.elements);
  const auto ids = host.id.host();
  const auto i = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), bad) - ids.begin());
  const std::string group = w.given->sets.at(static_cast<std::size_t>(host.group.data()[i])).name;
  char message[400];  // snprintf, because nvcc does not take fmt's headers
  std::snprintf(
      message, sizeof message,
      "step %lld, t = %.6e s: element %d (%s) moves at %.3e m/s, more than its radius %.3e m in a "
      "step of %.3e s, or is not finite; a smaller time.safety (now %g) may help",
      static_cast<long long>(w.step), w.time, bad, group.c_str(),
      norm(host.state.data()[i].velocity - w.travel.drift.velocity), host.state.data()[i].radius,
      w.last_dt, w.given->time.safety);
  return {bad, message};
}

}  // namespace

UnsoundLater find_unsound_later(const World& w) {
  const Elements& e = w.elements;
  const auto found = fold_owned_later(
      w.exec, w.domain, e.size(), Unsound::none,
      FindUnsound{w.last_dt, w.travel.drift.velocity, e.id.view(), e.state.view()}, Least{});
  return [&w, found] {
    const GlobalId bad = found.value();
    return bad == Unsound::none ? Unsound{} : told_of(w, bad);
  };
}

MotionNow motion_now(const World& w) {
  const Index count = w.elements.size();
  Buffer<Vec3> velocity(w.exec.space, count), spin(w.exec.space, count);
  for_each(w.exec, count, CentreMotion{kick(w), velocity.view(), spin.view()});
  MotionNow now;
  copy_to(now.velocity, velocity);
  copy_to(now.spin, spin);
  return now;
}

namespace {

template <class Number>
auto damage_kernel(const AddDamage& add, const ConcreteLinks& set,
                   const LinkGroup<ConcreteLink>& g) {
  return ConcreteDamage<Number>{add,
                                g.law,
                                g.begin,
                                set.kept.template as<Number>().opening.view(),
                                set.length.view(),
                                set.stiffness.view(),
                                set.area.view(),
                                set.rate.view()};
}
template <class Number, class Law, class... Rest>
auto damage_part(const AddDamage& add, const LinkSet<Law>& set, const Parts<Rest...>& rest) {
  const auto is_broken = set.template broken<Number>();
  return part(set.size(),
              BrokenDamage<std::remove_const_t<decltype(is_broken)>>{add.to(set), is_broken}, rest);
}

}  // namespace

Buffer<double> damage_of(const World& w) {
  const Index count = w.elements.size();
  Buffer<std::uint64_t> lost(w.exec.space, count);
  Buffer<double> damage(w.exec.space, count);
  const bool alone = w.exec.space != Space::cuda && w.exec.threads <= 1;
  const AddDamage add{{}, {}, lost.view(), alone};
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    const auto& groups = w.concrete.groups;
    const LinkGroup<ConcreteLink> none{}, &first = groups.empty() ? none : groups.front();
    for_each_of(
        w.exec,
        part(first.end - first.begin, damage_kernel<Number>(add.to(w.concrete), w.concrete, first),
             damage_part<Number>(
                 add, w.steel,
                 damage_part<Number>(
                     add, w.interface,
                     damage_part<Number>(add, w.parallel,
                                         damage_part<Number>(add, w.ldpm, Parts<>{}))))));
    for (std::size_t k = 1; k < groups.size(); ++k)
      for_each(w.exec, groups[k].end - groups[k].begin,
               damage_kernel<Number>(add.to(w.concrete), w.concrete, groups[k]));
  });
  for_each(w.exec, count, Damage{std::as_const(lost).view(), damage.view()});
  return damage;
}

namespace {

template <class Number, class Law, class... Rest>
auto breaks_part(LinkSet<Law>& set, double now, const Parts<Rest...>& rest) {
  const auto is_broken = set.template broken<Number>();
  return part(
      set.size(),
      NoteBreak<std::remove_const_t<decltype(is_broken)>>{is_broken, now, set.seen_broken.view()},
      rest);
}

}  // namespace

void note_breaks(World& w) {
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    const auto further =
        breaks_part<Number>(w.parallel, w.time, breaks_part<Number>(w.ldpm, w.time, Parts<>{}));
    const auto all = breaks_part<Number>(
        w.concrete, w.time,
        breaks_part<Number>(w.steel, w.time, breaks_part<Number>(w.interface, w.time, further)));
    for_each_of(w.exec, all);
  });
}

std::vector<double> damage(const World& w) {
  std::vector<double> values;
  copy_to(values, damage_of(w));
  return values;
}

Counts count(const World& w) {
  Counts n;
  Pieces pieces(at(w.elements.size()));
  const OnHost fixed(w.elements.fixed, w.exec.space);
  const auto gone = [&](Index e) { return is_gone(fixed->data()[e]); };
  each_link(w, [&](LinkKind kind, Index a, Index b, bool broken) {
    if (gone(a) || gone(b)) {
      n.removed += broken && gone(a) && gone(b) ? 1 : 0;  // others were let go
      return;
    }
    if (!broken)
      pieces.join(a, b);
    else
      ++n.broken[static_cast<std::size_t>(kind)];
  });
  const OnHost contacts(w.contacts.history.state, w.exec.space);
  for (const ContactState& contact : contacts->host())
    if (contact.overlap > 0.0) ++n.touching;
  const OnHost masses(w.elements.mass, w.exec.space);
  std::vector<double> mass(at(masses->size()), 0.0);
  double total = 0.0;
  for (Index i = 0; i < masses->size(); ++i) {
    if (gone(i)) continue;
    mass[at(pieces.root(i))] += masses->data()[i];
    total += masses->data()[i];
  }
  for (const double m : mass) {
    if (m > 0.0) ++n.fragments;
    n.largest_fragment = std::max(n.largest_fragment, m / total);
  }
  return n;
}

double link_opening(const ConcreteLinks& links, Index i) {
  return with_number(links.precision, [&](auto number) -> double {
    return links.kept.as<decltype(number)>().opening.data()[i];
  });
}

Vec3 link_force(const ConcreteLink& law, const ConcreteLinks& links, const Elements& elements,
                Index i) {
  const ElementState& a = elements.state.data()[links.a.data()[i]];
  const ElementState& b = elements.state.data()[links.b.data()[i]];
  const double touching = a.radius + b.radius;
  const LinkState<double> state = links.state_of(law, i);
  const LinkConstants<double> link = links.constants(law, i, state.opening, touching);
  return law.force_on_b(link, b.position - a.position, state);
}

}  // namespace breccia::dem
