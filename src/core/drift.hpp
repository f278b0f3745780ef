#pragma once
// The motion that travel is measured against.

#include "core/energy.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

/// A motion that all elements are thought to share. Whether two of them touch depends on where
/// they are to each other: moving both back by the same way changes nothing. So travel since a
/// search (core/travel.hpp) may be measured after any common way is taken off; a body at rest then
/// travels backwards.
template <class V>
struct DriftOf {
  V velocity{};           ///<  [m/s]
  double since = 0.0;     ///< time of the search  [s]
  double farthest = 0.0;  ///< way for which rounding is covered  [m]

  BR_HD V way(double time) const { return (time - since) * velocity; }
};
using Drift = DriftOf<Vec3>;
using PlaneDrift = DriftOf<Vec2>;

/// Common motion of elements. Sums are exact: the same on any number of ranks and threads.
struct CommonMotion {
  ExactSum x, y, z, squares;  ///< of velocities  [m/s], [m2/s2]
  std::int64_t count = 0;

  BR_HD void add(const Vec3& velocity) {
    constexpr double fastest = 1e5;  // the sums hold no more; what is faster has gone wrong
    if (!(dot(velocity, velocity) < fastest * fastest)) return;
    x.add(velocity.x);
    y.add(velocity.y);
    z.add(velocity.z);
    squares.add(dot(velocity, velocity));
    ++count;
  }

  /// The drift from now on: the mean velocity, where it makes up most of all motion. Otherwise
  /// there are some that fly and many at rest, and each is served best by its own speed.
  /// @param farthest  way after which a search comes in any case  [m]
  Drift drift(double time, double farthest) const {
    if (count == 0) return {};
    const double share = 1.0 / static_cast<double>(count);
    const Vec3 mean = share * Vec3{x.value(), y.value(), z.value()};
    if (!(dot(mean, mean) > 0.75 * share * squares.value())) return {};
    return {mean, time, farthest};
  }
};
BR_HD inline CommonMotion operator+(CommonMotion a, const CommonMotion& b) {
  a.x.add(b.x);
  a.y.add(b.y);
  a.z.add(b.z);
  a.squares.add(b.squares);
  a.count += b.count;
  return a;
}

}  // namespace breccia
