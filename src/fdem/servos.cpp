#include "fdem/servos.hpp"

#include "fdem/shape.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem {

void Shape::place_on_device(World& w) {
  if (w.servo_motions.empty() || w.prescribed_velocity.empty()) return;
  std::vector<Vec2> velocity;
  for (const PrescribedMotion& p : w.prescribed) velocity.push_back(p.velocity);
  copy_to(w.prescribed_velocity, velocity);
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem::World&, const fdem::Config&);
template void correct_servos(fdem::World&, const fdem::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem::World&);

}  // namespace breccia::fdem_shared
