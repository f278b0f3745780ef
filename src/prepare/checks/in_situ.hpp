#pragma once
// Stress at the start as its checks read it, and what they call it.

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/round_numbers.hpp"

namespace breccia::prepare {

inline std::string stress_text(double stress) {
  const ScaledUnit scaled = scaled_unit("Pa", std::abs(stress));
  return fmt::format("{:.4g} {}", scaled.factor * stress, scaled.unit);
}

/// Normal stress across an axis.  [Pa]
inline double stress_across(const fdem::InSituConfig& in_situ, const Vec3& x, std::size_t axis) {
  const Sym2 s = in_situ.at({x.x, x.y});
  return axis == 0 ? s.xx : s.yy;
}
inline double stress_across(const fdem3::InSituConfig& in_situ, const Vec3& x, std::size_t axis) {
  const Sym3 s = in_situ.at(x);
  return axis == 0 ? s.xx : axis == 1 ? s.yy : s.zz;
}

/// The key that says most of the stress across an axis.
inline std::string key_across(const fdem::InSituConfig& s, std::size_t axis) {
  const double value = axis == 0 ? s.xx : s.yy;
  return std::string("in_situ.") + (axis == 0 ? "xx" : "yy") + (value == 0.0 ? "_slope" : "");
}
inline std::string key_across(const fdem3::InSituConfig& s, std::size_t axis) {
  const double value = axis == 0 ? s.xx : axis == 1 ? s.yy : s.zz;
  const char* const words[] = {"xx", "yy", "zz"};
  return std::string("in_situ.") + words[axis] + (value == 0.0 ? "_slope" : "");
}

/// Size of a pressure at the start.  [Pa]
template <class Load>
double first_pressure(const Load& load) {
  if (load.history.ramp > 0.0) return 0.0;
  double factor = 1.0;
  if (const auto& times = load.history.times; !times.empty()) {
    OverTime<double> table;
    table.times = times;
    table.values = load.history.factors;
    factor = table.at(0.0);
  }
  return factor * load.pressure.at(0.0);
}

}  // namespace breccia::prepare
