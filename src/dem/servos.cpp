#include "dem/servos.hpp"

#include <algorithm>
#include <type_traits>

#include "dem/push_of_links.hpp"
#include "dem/stepping/launches.hpp"
#include "domain/owned.hpp"
#include "domain/set_here.hpp"
#include "exec/fold_sum.hpp"

namespace breccia::dem {
namespace {

/// The velocity of an element in the step to come, as a plate reads it.  [m/s]
struct Comes {
  bool asked;
  Kick kick;

  BR_HD void add(ServoReading& r, double stiffness, Index e, const Vec3& along) const {
    if (asked) r.flow.add(stiffness * dot(kick(e).velocity, along));
  }
};

struct WallPush {
  Comes comes;
  Index first;  ///< contact of the wall
  Vec3 normal;
  double factor;  ///< of the wall's stiffness  [-]
  bool hertz;
  View<const double> mass;
  View<const Index> a;
  View<const Vec3> on_wall;
  View<const ContactState> contact;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const ContactPair> pairs;

  BR_HD ServoReading operator()(Index k) const {
    const Index i = first + k, e = a[i];
    ServoReading r;
    const double overlap = contact[i].overlap, radius = state[e].radius;
    if (overlap <= 0.0) return r;
    r.force.add(-dot(on_wall[i], normal));
    const double normal_constant = pairs[material[e]].normal;
    const double stiffness = hertz ? 2.0 * normal_constant * sqrt(radius * overlap)
                                   : 0.5 * normal_constant * factor * radius;
    r.stiffness.add(stiffness);
    comes.add(r, stiffness, e, normal);
    r.mass.add(mass[e]);
    return r;
  }
};

/// A held element takes what all else does to it.
struct SupportPush {
  int axis;
  double gravity;  ///< along the axis  [m/s2]
  View<const Index> members;
  View<const Vec3> force;
  View<const double> mass;

  BR_HD ServoReading operator()(Index k) const {
    const Index e = members[k];
    ServoReading r;
    r.force.add(-(part_along(axis, force[e]) + mass[e] * gravity));
    return r;
  }
};

/// The element on the other side of a link of a held element is as stiff as its own modulus says;
/// it goes with it.
struct TiedPush {
  Comes comes;
  Vec3 along;
  View<const Index> members;
  View<const double> mass;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const ContactPair> pairs;  ///< of a material with a rigid wall

  BR_HD ServoReading operator()(Index k) const {
    const Index e = members[k];
    ServoReading r;
    const double stiffness = pairs[material[e]].normal * state[e].radius;
    r.stiffness.add(stiffness);
    comes.add(r, stiffness, e, along);
    r.mass.add(mass[e]);
    return r;
  }
};

/// A contact of an element that the servo leads with one that it does not: of platens, that are led
/// as a whole, their faces alone.
struct ContactPush {
  Comes comes;
  Vec3 ahead;
  LedElements led;
  bool hertz;
  View<const double> mass;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const ContactPair> pairs;  ///< of materials p, q at p * materials + q
  Index materials;
  View<const Index> a, b;
  View<const ContactState> contact;

  BR_HD ServoReading operator()(Index i) const {
    const Index p = a[i], q = b[i];
    ServoReading r;
    const double overlap = contact[i].overlap;
    if (!(overlap > 0.0)) return r;
    const bool by_p = led(p);
    if (by_p == led(q)) return r;
    const double radius_p = state[p].radius, radius_q = state[q].radius, sum = radius_p + radius_q;
    const Vec3 way = state[q].position - state[p].position;
    const double along = part_along(led.axis, way), smaller = min(radius_p, radius_q);
    const double constant = pairs[material[p] * materials + material[q]].normal;
    const double stiffness = hertz ? 2.0 * constant * sqrt(radius_p * radius_q / sum * overlap)
                                   : constant * smaller * smaller / sum;
    const double straight = stiffness * along * along / dot(way, way);
    r.stiffness.add(straight);
    comes.add(r, straight, by_p ? q : p, ahead);
    r.mass.add(mass[by_p ? q : p]);
    return r;
  }
};

Vec3 along_axis(int axis) {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

ServoReading read_wall(const World& w, std::size_t wall, bool plate) {
  if (wall + 1 >= w.wall_begin.size()) return {};
  const Index begin = w.wall_begin[wall], end = w.wall_begin[wall + 1];
  const WallContacts& c = w.wall_contacts;
  return fold_owned(
      w.exec, w.domain, end - begin, ServoReading{},
      WallPush{Comes{plate, kick(w)}, begin, w.walls[wall].normal, w.walls[wall].stiffness,
               w.given->contact.hertz, w.elements.mass.view(), c.pairs.a.view(),
               c.history.on_wall.view(), c.history.state.view(), w.elements.material.view(),
               w.elements.state.view(), w.given->wall_pairs.view()},
      Sum{}, ListedElement<>{c.pairs.a.view(), begin});
}

/// Where elements of a set lie on this rank.
View<const Index> places_of(const World& part, const ElementSet& set, SetHere& here) {
  if (part.domain.single_rank()) return set.members.view();
  keep_here(here, part.domain, part.elements.id, set.members.host(), 1, part.exec.space);
  return std::as_const(here.places).view();
}

/// Adds what links will push with that a plate knows by their law.
template <class Law>
void add_links(World& part, LinkSet<Law>& set, const LedElements& led, double velocity,
               FoldSum<ServoReading>& all) {
  for (const LinkGroup<Law>& group : set.groups) {
    const auto add = [&](const auto& forces) {
      const LinkPush<std::decay_t<decltype(forces)>> push{forces,   group.begin, part.next_dt,
                                                          velocity, led,         kick(part)};
      all.add(group.end - group.begin, of_owned(part.domain, ServoReading{}, push,
                                                ListedElement<>{set.a.view(), group.begin}));
    };
    if constexpr (LinkSet<Law>::swept)
      with_number(set.precision, [&](auto number) {
        add(link_kernel<decltype(number)>(part, set, group.law, 0));
      });
    else
      add(link_kernel<double>(part, set, group.law, 0));
  }
}

/// Forces on elements that another rank leads, as they were summed there.
void refresh_forces(World& w) {
  const auto refresh = [&w](Buffer<Vec3>& items) {
    w.domain.start_refresh(w.exec, items);
    w.domain.finish_refresh(w.exec, items);
  };
  refresh(w.elements.force);
  refresh(w.elements.torque);
}

/// @param support  its number among supports  @param servo  its number among servos, walls first
ServoReading read_support(World& part, std::size_t support, std::size_t servo, int axis,
                          bool plate) {
  const Case& given = *part.given;
  const std::size_t set = given.sets.size() - given.tied.size() + support;
  const Elements& e = part.elements;
  const Contacts& c = part.contacts;
  const View<const Index> members = places_of(part, given.sets[set], part.sets_here[set]);
  const View<const Index> tied = places_of(part, given.tied[support], part.tied_here[support]);
  FoldSum<ServoReading> all(part.exec);
  const auto own = [&part](const auto& kernel, View<const Index> element) {
    return of_owned(part.domain, ServoReading{}, kernel, ListedElement<>{element});
  };
  all.add(members.size, own(SupportPush{axis, part_along(axis, given.gravity), members,
                                        e.force.view(), e.mass.view()},
                            members));
  const Comes comes{plate, kick(part)};
  const Vec3 along = along_axis(axis);
  const LedElements led{static_cast<std::int16_t>(servo), axis, e.motion.view(),
                        std::as_const(part.led).view()};
  if (plate) {
    add_links(part, part.concrete, led, part.servos[servo].velocity, all);
    add_links(part, part.parallel, led, part.servos[servo].velocity, all);
  }
  const Index others = part.links() - part.concrete.size() - part.parallel.size();
  if (!plate || others > 0)
    all.add(tied.size, own(TiedPush{comes, along, tied, e.mass.view(), e.material.view(),
                                    e.state.view(), given.wall_pairs.view()},
                           tied));
  all.add(c.size(),
          own(ContactPush{comes, along, led, given.contact.hertz, e.mass.view(), e.material.view(),
                          e.state.view(), given.contact_pairs.view(), given.materials,
                          c.pairs.a.view(), c.pairs.b.view(), c.history.state.view()},
              c.pairs.a.view()));
  return all.sum();
}

}  // namespace

std::vector<ServoReading> read_servos(World& part, const Config& now) {
  std::vector<ServoReading> readings;
  const auto is_plate = [](const auto& led) { return led.servo.is_plate(); };
  if (std::any_of(now.supports.begin(), now.supports.end(), is_plate)) refresh_forces(part);
  for (std::size_t k = 0; k < now.walls.size(); ++k)
    readings.push_back(now.walls[k].servo.is_due(part.step)
                           ? read_wall(part, k, now.walls[k].servo.is_plate())
                           : ServoReading{});
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const SupportServoConfig& servo = now.supports[s].servo;
    readings.push_back(servo.is_due(part.step) ? read_support(part, s, now.walls.size() + s,
                                                              servo.axis_number(), servo.is_plate())
                                               : ServoReading{});
  }
  return readings;
}

void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums) {
  const auto correct = [&](const ServoConfig& servo, double begin, std::size_t k) {
    if (!servo.is_due(w.step)) return;
    const ServoReading& r = sums[k];
    w.servos[k].correct(servo,
                        servo.target(servo.aims_at(w.time, w.next_dt), begin) - r.force.value(), r,
                        w.last_dt, w.next_dt);
  };
  const std::size_t walls = now.walls.size();
  for (std::size_t k = 0; k < walls; ++k) correct(now.walls[k].servo, now.walls[k].begin, k);
  for (std::size_t s = 0; s < now.supports.size(); ++s)
    correct(now.supports[s].servo, now.supports[s].begin, walls + s);
  place_servos(w);
}

void place_servos(World& w) {
  if (w.prescribed.servos.empty()) return;
  const std::size_t first = w.prescribed.motions.size() - w.walls.size();
  for (const ServoMotion& m : w.prescribed.servos) {
    Vec3& velocity = w.prescribed.motions[static_cast<std::size_t>(m.motion)].velocity;
    const double v = w.servos[m.servo].velocity;
    if (m.axis < 0)
      velocity = v * w.walls[static_cast<std::size_t>(m.motion) - first].normal;
    else
      (m.axis == 0 ? velocity.x : m.axis == 1 ? velocity.y : velocity.z) = v;
  }
  copy_to(w.motions, w.prescribed.motions);
}

}  // namespace breccia::dem
