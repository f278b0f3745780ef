#include "dem/setup/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::dem {
namespace {

/// Spring force and tangent of the dimensionless contact at overlap x.
struct Spring {
  bool hertz;
  double force(double x) const { return hertz ? x * std::sqrt(x) : x; }
  /// of the spring that the dashpot is scaled with: S_n is 2 E* sqrt(R* d), 3/2 of force / overlap
  double tangent(double x) const { return hertz ? 1.5 * std::sqrt(x) : 1.0; }
};

/// Speed after a collision at speed 1: x'' = -max(0, f(x) + 2 xi sqrt(f'(x)) x'), by Runge-Kutta 4.
double rebound(const Spring& spring, double xi) {
  double x = 0.0, v = 1.0;
  const double h = 2e-4;
  const auto acceleration = [&](double at, double speed) {
    if (at <= 0.0) return 0.0;
    const double push = spring.force(at) + 2.0 * xi * std::sqrt(spring.tangent(at)) * speed;
    return -std::max(0.0, push);
  };
  for (int i = 0; i < 2'000'000 && (x > 0.0 || v > 0.0); ++i) {
    const double k1 = acceleration(x, v);
    const double k2 = acceleration(x + 0.5 * h * v, v + 0.5 * h * k1);
    const double k3 = acceleration(x + 0.5 * h * (v + 0.5 * h * k1), v + 0.5 * h * k2);
    const double k4 = acceleration(x + h * (v + 0.5 * h * k2), v + h * k3);
    x += h * (v + h / 6.0 * (k1 + k2 + k3));
    v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    if (v < 0.0 && acceleration(x, v) == 0.0) break;  // the push is over: it flies on at this speed
  }
  return -v;
}

double damping_ratio(const Spring& spring, double restitution) {
  if (restitution >= 1.0) return 0.0;
  double low = 0.0, high = 1.0;
  while (rebound(spring, high) > restitution && high < 1e3) high *= 2.0;
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (low + high);
    (rebound(spring, middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double damping_ratio_linear(double restitution) {
  return damping_ratio({false}, restitution);
}
double damping_ratio_hertz(double restitution) {
  return damping_ratio({true}, restitution);
}

}  // namespace breccia::dem
