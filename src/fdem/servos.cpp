#include "fdem/servos.hpp"

#include "domain/set_here.hpp"
#include "exec/for_each.hpp"

namespace breccia::fdem {
namespace {

/// A held corner takes what all else does to it. How stiff that is, it knows by its own modulus.
struct SupportPush {
  OwnedView owned;
  int axis;
  double gravity;  ///< along the axis  [m/s2]
  View<const Index> corners;
  View<const Corners> force;
  View<const double> mass;
  View<const Index> material;
  View<const ElasticTriangle> laws;

  /// A vertex has about three corners on the side of a body, and its modulus as stiffness.  [N/m2]
  BR_HD static double stiff(const ElasticTriangle& law) {
    return (law.lambda + 2.0 * law.shear + law.bend) / 3.0;
  }

  BR_HD ServoReading operator()(Index k) const {
    const Index n = corners[k];
    ServoReading r;
    if (!owned(n / 3)) return r;
    const Vec2& f = force[n / 3].at[n % 3];
    r.force.add(-((axis == 0 ? f.x : f.y) + mass[n / 3] * gravity));
    r.stiffness.add(stiff(laws[material[n / 3]]));
    return r;
  }
};

ServoReading read_support(World& part, std::size_t number, int axis) {
  const NodeSet& set = part.given->sets[number];
  Buffer<Index> all(part.exec.space);
  View<const Index> corners;
  if (part.domain.single_rank()) {
    copy_to(all, set.nodes);
    corners = std::as_const(all).view();
  } else {
    SetHere& here = part.sets_here[number];
    keep_here(here, part.domain, part.triangles.id, set.nodes, 3, part.exec.space);
    corners = std::as_const(here.places).view();
  }
  const Vec2& g = part.given->gravity;
  return fold(part.exec, corners.size, ServoReading{},
              SupportPush{part.domain.owned_view(), axis, axis == 0 ? g.x : g.y, corners,
                          std::as_const(part.triangles.force).view(),
                          std::as_const(part.triangles.mass).view(), laws_of(part),
                          part.given->laws.view()},
              Sum{});
}

}  // namespace

std::vector<ServoReading> read_servos(World& part, const Config& now) {
  std::vector<ServoReading> readings;
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
  for (std::size_t s = 0; s < now.supports.size(); ++s) {
    const SupportConfig& support = now.supports[s];
    if (!support.servo.is_on()) continue;
    w.servos[s].correct(support.servo,
                        support.servo.target(w.time, support.history.begin) - sums[s].force.value(),
                        sums[s].stiffness.value(), span);
  }
  place_servos(w);
}

void place_servos(World& w) {
  for (const ServoMotion& m : w.servo_motions) {
    Vec2& velocity = w.prescribed[static_cast<std::size_t>(m.motion)].velocity;
    (m.axis == 0 ? velocity.x : velocity.y) = w.servos[m.servo].velocity;
  }
  if (w.servo_motions.empty() || w.prescribed_velocity.empty()) return;
  std::vector<Vec2> velocity;
  for (const PrescribedMotion& p : w.prescribed) velocity.push_back(p.velocity);
  copy_to(w.prescribed_velocity, velocity);
}

}  // namespace breccia::fdem
