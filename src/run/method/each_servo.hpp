#pragma once
// The servos of a case as it is in a stage: of walls, then of supports.

#include "core/servo.hpp"

namespace breccia {

/// Calls visit(servo, its number).
template <class Config, class Visit>
void each_servo(const Config& now, const Visit& visit) {
  std::size_t k = 0;
  if constexpr (requires { now.walls; })
    for (const auto& wall : now.walls) visit(wall.servo, k++);
  for (const auto& support : now.supports) visit(support.servo, k++);
}
/// Whether any is slowed where the model is far from rest.
template <class Config>
bool slows(const Config& now) {
  bool any = false;
  each_servo(now, [&](const ServoConfig& servo, std::size_t) {
    any |= servo.is_on() && servo.slow > 0.0;
  });
  return any;
}

}  // namespace breccia
