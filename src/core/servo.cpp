#include "core/servo.hpp"

#include <cmath>

namespace breccia {

void ServoState::correct(const ServoConfig& servo, double missing, const ServoReading& touched,
                         double last_dt, double next_dt) {
  if (servo.is_plate())
    push_plate(servo, missing, touched, 0.5 * (last_dt + next_dt));
  else
    follow_force(servo, missing, touched, static_cast<double>(servo_every) * next_dt);
}

/// Proportional and integral control: by what is missing and by its sum over time, so that what
/// gives way steadily meets the force without an error.
/// @param span  until the next correction  [s]
void ServoState::follow_force(const ServoConfig& servo, double missing, const ServoReading& touched,
                              double span) {
  constexpr double first_share = 0.5;
  const double most = share * servo.speed;
  const double stiffness = touched.stiffness.value();
  if (!(stiffness > 0.0)) {
    steady = 0.0;
    velocity = missing > 0.0 ? most : missing < 0.0 ? -most : 0.0;
    return;
  }
  // In less than that time what it touches answers with its inertia, sqrt(K M) v, not with K v T.
  const double inert = std::sqrt(touched.mass.value() / stiffness);
  const double ratio = inert > span ? 0.2 * span / inert : 1.0 / 50.0;
  const double gain = servo.gain * first_share / (stiffness * std::max(span, inert));
  if (gain * missing < most && gain * missing > -most)
    steady = std::clamp(steady + ratio * gain * missing, -most, most);
  velocity = std::clamp(gain * missing + steady, -most, most);
}

/// A plate's law of motion, M dv/dt = what is missing: the force on its back less what it pushes
/// with.
/// @param dt  from the middle of the last step to that of the next  [s]
void ServoState::push_plate(const ServoConfig& servo, double missing, const ServoReading& touched,
                            double dt) {
  // A lighter one would swing on what it touches faster than the step resolves, K dt^2 < 4 M.
  const double least = 2.0 * touched.stiffness.value() * dt * dt;
  const double inertia = std::max(servo.mass + touched.held.value(), least);
  const double most = share * servo.speed;
  velocity = inertia > 0.0   ? std::clamp(velocity + missing * dt / inertia, -most, most)
             : missing > 0.0 ? most
                             : 0.0;
}

}  // namespace breccia
