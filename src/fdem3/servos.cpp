#include "fdem3/servos.hpp"

#include "core/gauge.hpp"
#include "domain/set_here.hpp"
#include "exec/for_each.hpp"

namespace breccia::fdem3 {
namespace {

/// A held corner takes what all else does to it. How stiff that is, it knows by its own modulus.
struct SupportPush {
  OwnedView owned;
  int axis;
  Vec3 gravity;  ///<  [m/s2]
  View<const Index> corners;
  View<const Corners> force;
  View<const double> mass;
  View<const Index> material;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;

  /// A vertex has about six corners on the side of a body, and (lambda + 2 mu) times the size of an
  /// element as stiffness.  [N/m]
  BR_HD static double stiff(const ElasticTetrahedron& law, const ShapeGradients& shape) {
    return (law.lambda + 2.0 * law.shear) * 100.0 * near_reach(shape) / 6.0;
  }
  BR_HD ServoReading operator()(Index k) const {
    const Index n = corners[k], t = n / 4;
    ServoReading r;
    if (!owned(t)) return r;
    const Vec3 f = force[t].at[n % 4] + mass[t] * gravity;
    r.force.add(-on_axis(f, axis));
    r.stiffness.add(stiff(laws[material[t]], shape[t]));
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
    keep_here(here, part.domain, part.tetrahedra.id, set.nodes, 4, part.exec.space);
    corners = std::as_const(here.places).view();
  }
  const Tetrahedra& t = part.tetrahedra;
  return fold(
      part.exec, corners.size, ServoReading{},
      SupportPush{part.domain.owned_view(), axis, part.given->gravity, corners, t.force.view(),
                  t.mass.view(), t.material.view(), part.given->laws.view(), t.shape.view()},
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
    Vec3& velocity = w.prescribed[static_cast<std::size_t>(m.motion)].velocity;
    (m.axis == 0 ? velocity.x : m.axis == 1 ? velocity.y : velocity.z) = w.servos[m.servo].velocity;
  }
}

}  // namespace breccia::fdem3
