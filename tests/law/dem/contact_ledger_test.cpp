// A ball that meets another with a dashpot: what the contact books is what motion lost.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/laws/contact.hpp"

namespace breccia::dem {
namespace contact_ledger_test {

/// Share of the energy of a collision that the contact has not booked, the mean over where in a
/// step the balls begin to touch.  [-]
double unbooked(double safety) {
  constexpr int starts = 50;
  constexpr double xi = 0.36, speed = 0.01;
  const ContactLaw law{false, 0.0, xi, 0.0, 0.0};
  const ContactPair material{2.0, 0.0};
  const ContactLaw::Pair pair{1.0, 1.0, 2.0, 1.0, 1.0};  // K_n = 1, m* = 1
  const double dt = safety * 2.0 * (std::sqrt(1.0 + xi * xi) - xi);
  double missing = 0.0;
  for (int start = 0; start < starts; ++start) {
    double v = speed, damped = 0.0;
    double overlap = -(start + 0.5) / starts * v * dt;
    ContactState state{};
    for (bool met = false;;) {
      overlap += v * dt;
      if (overlap <= 0.0 && !met) continue;
      PairMotion<double> motion{};
      motion.normal = {1.0, 0.0, 0.0};
      motion.distance = 2.0 - overlap;
      motion.extension = -v * dt;
      motion.turn_scale = 1.0;
      const ContactResponse r = law.response(material, pair, overlap, v, motion, state);
      damped += r.damped;
      if (overlap <= 0.0) break;
      met = true;
      v -= dt * r.pressure;
    }
    missing += (speed * speed - v * v - 2.0 * damped) / (speed * speed) / starts;
  }
  return std::fabs(missing);
}

TEST(ContactLedger, a_dashpots_work_is_booked_also_where_its_way_is_a_gap) {
  EXPECT_LT(unbooked(0.7), 0.15);
  EXPECT_LT(unbooked(0.35), 0.04);
  EXPECT_LT(unbooked(0.1), 0.004);  // falls with the square of the step
}

}  // namespace contact_ledger_test
}  // namespace breccia::dem
