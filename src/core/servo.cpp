#include "core/servo.hpp"

#include <cmath>

namespace breccia {

void ServoState::correct(const ServoConfig& servo, double missing, const ServoReading& touched,
                         double last_dt, double next_dt) {
  if (servo.is_plate())
    push_plate(servo, missing, touched, last_dt, next_dt);
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

/// A plate's law of motion with the force that it will meet, M dv/dt = F - R'. In the step to come
/// what it touches, which moves with the velocity u, adds K (v - u) dt to R, so that
///
///   (M/s + K dt) v = M/s v_old + F - R + K dt u          s: from the middle of a step to the next
///
/// which is stable for any mass; without one R' = F. What stiffens by k over the way to its
/// greatest speed v_m, as faces that are not yet in touch, adds k (v - v_old)^2 dt/(v_m - v_old)
/// where it is pressed. Where K and u are not known, M is large enough for a step without them.
void ServoState::push_plate(const ServoConfig& servo, double missing, const ServoReading& touched,
                            double last_dt, double next_dt) {
  const double mass = std::max(servo.mass, touched.inertia.value());
  const double inertia = mass / (0.5 * (last_dt + next_dt));
  const double resists = inertia + touched.stiffness.value() * next_dt;
  const double most = share * servo.speed;
  const double aims = missing + touched.force.value();
  const double along = aims < 0.0 ? -1.0 : 1.0;  // in which it presses
  const double left = most - along * velocity;
  const double lacks =
      along * (missing + (touched.flow.value() - touched.stiffness.value() * velocity) * next_dt);
  const double more = touched.stiffer.value() * next_dt;
  if (lacks > 0.0 && left > 0.0 && more > 0.0)
    velocity +=
        along * 2.0 * lacks / (resists + std::sqrt(resists * resists + 4.0 * more / left * lacks));
  else if (resists > 0.0)
    velocity = (inertia * velocity + missing + touched.flow.value() * next_dt) / resists;
  else
    velocity = missing > 0.0 ? most : missing < 0.0 ? -most : 0.0;
  velocity = std::clamp(velocity, -most, most);
}

}  // namespace breccia
