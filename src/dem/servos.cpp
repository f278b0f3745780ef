#include "dem/servos.hpp"

#include "domain/set_here.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

struct WallPush {
  OwnedView owned;
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
    if (!owned(e) || overlap <= 0.0) return r;
    r.force.add(-dot(on_wall[i], normal));
    const double normal_constant = pairs[material[e]].normal;
    r.stiffness.add(hertz ? 2.0 * normal_constant * sqrt(radius * overlap)
                          : 0.5 * normal_constant * factor * radius);
    r.mass.add(mass[e]);
    return r;
  }
};

/// A held element takes what all else does to it. How stiff that is, it knows by its own modulus.
struct SupportPush {
  OwnedView owned;
  int axis;
  double gravity;  ///< along the axis  [m/s2]
  View<const Index> members;
  View<const Vec3> force;
  View<const double> mass;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const ContactPair> pairs;  ///< of a material with a rigid wall

  BR_HD ServoReading operator()(Index k) const {
    const Index e = members[k];
    ServoReading r;
    if (!owned(e)) return r;
    const Vec3& f = force[e];
    r.force.add(-((axis == 0 ? f.x : axis == 1 ? f.y : f.z) + mass[e] * gravity));
    r.stiffness.add(pairs[material[e]].normal * state[e].radius);
    r.mass.add(mass[e]);
    return r;
  }
};

ServoReading read_wall(const World& w, std::size_t wall) {
  if (wall + 1 >= w.wall_begin.size()) return {};
  const Index begin = w.wall_begin[wall], end = w.wall_begin[wall + 1];
  const WallContacts& c = w.wall_contacts;
  return fold(w.exec, end - begin, ServoReading{},
              WallPush{w.domain.owned_view(), begin, w.walls[wall].normal, w.walls[wall].stiffness,
                       w.given->contact.hertz, w.elements.mass.view(), c.pairs.a.view(),
                       c.history.on_wall.view(), c.history.state.view(), w.elements.material.view(),
                       w.elements.state.view(), w.given->wall_pairs.view()},
              Sum{});
}

ServoReading read_support(World& part, std::size_t number, int axis) {
  const ElementSet& set = part.given->sets[number];
  const Vec3& g = part.given->gravity;
  View<const Index> members = set.members.view();
  if (!part.domain.single_rank()) {
    SetHere& here = part.sets_here[number];
    keep_here(here, part.domain, part.elements.id, set.members.host(), 1, part.exec.space);
    members = std::as_const(here.places).view();
  }
  return fold(part.exec, members.size, ServoReading{},
              SupportPush{part.domain.owned_view(), axis,
                          axis == 0   ? g.x
                          : axis == 1 ? g.y
                                      : g.z,
                          members, std::as_const(part.elements.force).view(),
                          std::as_const(part.elements.mass).view(),
                          std::as_const(part.elements.material).view(),
                          std::as_const(part.elements.state).view(), part.given->wall_pairs.view()},
              Sum{});
}

}  // namespace

std::vector<ServoReading> read_servos(World& part, const Config& now) {
  std::vector<ServoReading> readings;
  for (std::size_t k = 0; k < now.walls.size(); ++k)
    readings.push_back(now.walls[k].servo.is_on() ? read_wall(part, k) : ServoReading{});
  const std::size_t bodies = part.given->sets.size() - now.supports.size();
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const SupportServoConfig& servo = now.supports[s].servo;
    readings.push_back(servo.is_on() ? read_support(part, bodies + s, servo.axis_number())
                                     : ServoReading{});
  }
  return readings;
}

void correct_servos(World& w, const Config& now, const std::vector<ServoReading>& sums) {
  const double span = static_cast<double>(servo_every) * w.next_dt;
  const auto correct = [&](const ServoConfig& servo, double begin, std::size_t k) {
    if (!servo.is_on()) return;
    const ServoReading& r = sums[k];
    w.servos[k].correct(servo, servo.target(w.time, begin) - r.force.value(), r, span);
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
