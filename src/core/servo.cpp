#include "core/servo.hpp"

#include <cmath>

namespace breccia {

void ServoState::correct(const ServoConfig& servo, double missing, const ServoReading& touched,
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

}  // namespace breccia
