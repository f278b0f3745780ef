#pragma once
// Quantities that a case gives as one value or as a table over time.

#include <initializer_list>
#include <type_traits>
#include <vector>

#include "exec/buffer.hpp"
#include "math/pack.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

/// A quantity of a case: one value, or a table [[t, v], ...] that is linear in between and keeps
/// its first and last value beyond its ends. `Value`: double, Vec2 or Vec3.
template <class Value>
struct OverTime {
  Value value{};              ///< where there is no table  [SI]
  std::vector<double> times;  ///< ascending; empty: no table  [s]
  std::vector<Value> values;  ///< at these times  [SI]

  OverTime() = default;
  OverTime(const Value& constant) : value(constant) {}  // NOLINT: a value is the common case
  template <class... Part>
  requires(sizeof...(Part) > 1 && (std::is_arithmetic_v<Part> && ...)) OverTime(Part... parts)
      : value{static_cast<double>(parts)...} {}

  bool is_table() const { return !times.empty(); }
  /// The value where there is no table, else that at a time since its begin.
  Value at(double time) const {
    if (!is_table()) return value;
    std::size_t next = 0;  // the first row later than that
    while (next < times.size() && times[next] <= time) ++next;
    if (next == 0) return values.front();
    if (next == times.size()) return values.back();
    const double share = (time - times[next - 1]) / (times[next] - times[next - 1]);
    return values[next - 1] + share * (values[next] - values[next - 1]);
  }
};

/// The number along axis k of a value.
inline double component(double value, int) {
  return value;
}
inline double component(const Vec2& v, int k) {
  return k == 0 ? v.x : v.y;
}
inline double component(const Vec3& v, int k) {
  return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/// A factor over time where kernels can read it: entries first to end - 1 of the tables of all
/// factors (none: always 1), linear in between and constant beyond, times a ramp from zero.
struct AmplitudeTable {
  double ramp = 0.0;   ///<  [s]
  double begin = 0.0;  ///< where its time begins  [s]
  Index first = 0, end = 0;

  BR_HD double at(double time, const View<const double>& times,
                  const View<const double>& factors) const {
    const double now = time - begin;
    const double grown = ramp > 0.0 ? min(1.0, max(0.0, now / ramp)) : 1.0;
    if (first == end) return grown;
    Index next = first;  // the first entry later than `now`
    for (Index step = end - first; step > 0;) {
      const Index half = step / 2;
      if (times[next + half] <= now) {
        next += half + 1;
        step -= half + 1;
      } else {
        step = half;
      }
    }
    if (next == first) return grown * factors[first];
    if (next == end) return grown * factors[end - 1];
    const double share = (now - times[next - 1]) / (times[next] - times[next - 1]);
    return grown * (factors[next - 1] + share * (factors[next] - factors[next - 1]));
  }
};

/// An amplitude on the host.
struct Amplitude {
  double ramp = 0.0;                   ///<  [s]
  double begin = 0.0;                  ///< where its time begins  [s]
  std::vector<double> times, factors;  ///< ascending  [s], [-]

  double at(double time) const;
  /// Largest size of its factors.  [-]
  double largest() const;
  bool operator==(const Amplitude&) const = default;
};

/// The number along axis k of a quantity as an amplitude, whose `scale` is the value where there is
/// no table and 1 where there is one.
struct ScaledAmplitude {
  double scale = 0.0;
  Amplitude amplitude;

  bool is_zero() const;
  bool operator==(const ScaledAmplitude&) const = default;
};
template <class Value>
ScaledAmplitude scaled_amplitude(const OverTime<Value>& quantity, int axis, double ramp,
                                 double begin) {
  ScaledAmplitude s{component(quantity.value, axis), {ramp, begin, quantity.times, {}}};
  for (const Value& v : quantity.values) s.amplitude.factors.push_back(component(v, axis));
  if (quantity.is_table()) s.scale = 1.0;
  return s;
}

/// Tables of many amplitudes one behind the other.
struct AmplitudeTables {
  std::vector<double> times, factors;  ///<  [s], [-]

  AmplitudeTable append(const Amplitude& a);
  View<const double> times_view() const;
  View<const double> factors_view() const;
};

}  // namespace breccia
