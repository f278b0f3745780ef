#pragma once
// Motions of supports and sizes of loads, which follow tables over time.

#include <algorithm>
#include <vector>

#include "core/table_over_time.hpp"
#include "fdem_shared/prescribed.hpp"

namespace breccia::fdem_shared {

/// The integral of an amplitude since its time began: by Simpson's rule, which is exact between its
/// rows.  [s]
inline double sum_over_time(const Amplitude& a, double time) {
  const double end = time - a.begin;
  if (!(end > 0.0)) return 0.0;
  std::vector<double> knots{0.0, end};
  const auto add = [&](double at) {
    if (at > 0.0 && at < end) knots.push_back(at);
  };
  add(a.ramp);
  for (const double at : a.times) add(at);
  std::sort(knots.begin(), knots.end());
  double sum = 0.0;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double from = a.begin + knots[k - 1], to = a.begin + knots[k];
    sum += (to - from) / 6.0 * (a.at(from) + 4.0 * a.at(0.5 * (from + to)) + a.at(to));
  }
  return sum;
}

/// A vector over time: its parts, each by its own table; of a pressure x alone.
template <class Vector>
struct AmplitudeOf;
template <>
struct AmplitudeOf<double> {
  Amplitude x;

  double at(double time) const { return x.at(time); }
};
template <>
struct AmplitudeOf<Vec2> {
  Amplitude x, y;

  Vec2 at(double time) const { return {x.at(time), y.at(time)}; }
  Vec2 sum(double time) const { return {sum_over_time(x, time), sum_over_time(y, time)}; }
};
template <>
struct AmplitudeOf<Vec3> {
  Amplitude x, y, z;

  Vec3 at(double time) const { return {x.at(time), y.at(time), z.at(time)}; }
  Vec3 sum(double time) const {
    return {sum_over_time(x, time), sum_over_time(y, time), sum_over_time(z, time)};
  }
};

inline double by_parts(double a, double b) {
  return a * b;
}
inline Vec2 by_parts(const Vec2& a, const Vec2& b) {
  return {a.x * b.x, a.y * b.y};
}
inline Vec3 by_parts(const Vec3& a, const Vec3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// A support's motion over time; the host puts its value of each step into World::motions.
template <class Vector>
struct PrescribedMotionOf {
  Vector velocity{};  ///<  [m/s]
  AmplitudeOf<Vector> over;
  Vector point{};         ///< of the axis of its turn, where their time begins  [m]
  SpinOf<Vector> spin{};  ///<  [rad/s]
  AmplitudeOf<SpinOf<Vector>> spin_over{};

  bool turns() const { return squared(spin) > 0.0; }
  Vector at(double time) const { return by_parts(over.at(time), velocity); }
  /// Where the point of the axis is: what servos give it is left out.  [m]
  Vector point_at(double time) const { return point + by_parts(over.sum(time), velocity); }
  /// In the step of dt that begins then.
  MotionNow<Vector> now(double time, double dt) const {
    const double middle = time + 0.5 * dt;
    if (!turns()) return {at(middle)};
    return {at(middle), point_at(time), by_parts(spin_over.at(middle), spin)};
  }
};

/// Load on a side. Pressure and traction act per present length or area; a force is dead: it stays
/// as given however its sides deform. A fluid is a pressure that spreads into cracks. Each side
/// that a bolt pulls at has a force of its own.
enum class LoadKind : std::uint8_t { pressure, traction, force, absorbing, fluid, bolt };

inline LoadKind load_kind(const std::string& word) {
  if (word == "pressure") return LoadKind::pressure;
  if (word == "traction") return LoadKind::traction;
  if (word == "fluid") return LoadKind::fluid;
  return word == "force" ? LoadKind::force : LoadKind::absorbing;
}

/// A load with its value at this moment.
template <class Vector>
struct LoadLawOf {
  LoadKind kind;
  Vector factor;    ///< of the amplitude, now; of what has no direction all are alike  [-]
  double pressure;  ///<  [Pa]
  Vector traction;  ///<  [Pa]
  Vector force;     ///<  [N; in 2D N/m]
};

}  // namespace breccia::fdem_shared
