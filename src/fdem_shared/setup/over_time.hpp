#pragma once
// Quantities of a case that change over time: their factors, and the quantity that these scale.

#include "fdem_shared/over_time.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// The factors of a quantity along all axes: its own table, or the table of factors.
template <class Vector, class Value, class History>
AmplitudeOf<Vector> amplitudes(const OverTime<Value>& quantity, const History& history) {
  const auto along = [&](int axis) -> Amplitude {
    if (quantity.is_table())
      return scaled_amplitude(quantity, axis, history.ramp, history.begin).amplitude;
    return {history.ramp, history.begin, history.times, history.factors};
  };
  if constexpr (std::is_same_v<Vector, double>)
    return {along(0)};
  else if constexpr (std::is_same_v<Vector, Vec2>)
    return {along(0), along(1)};
  else
    return {along(0), along(1), along(2)};
}

/// The quantity that amplitudes are factors of.
template <class Vector>
Vector scale_of(const OverTime<Vector>& quantity) {
  return quantity.is_table() ? from_space<Vector>({1.0, 1.0, 1.0}) : quantity.value;
}

inline double scale_of(const OverTime<double>& quantity) {
  return quantity.is_table() ? 1.0 : quantity.value;
}

/// Bits of the directions that a support prescribes: x, y, z.
template <class Support>
int fixed_directions(const Support& support) {
  int bits = 0;
  for (const std::string& direction : support.fix)
    bits |= direction == "x" ? 1 : direction == "y" ? 2 : 4;
  return bits;
}

/// The motion that a support prescribes as its keys say: without its servo.
template <class Vector, class Support>
PrescribedMotionOf<Vector> motion_of(const Support& support) {
  const int bits = fixed_directions(support);
  PrescribedMotionOf<Vector> motion{held_parts(bits, scale_of(support.velocity), Vector{}),
                                    amplitudes<Vector>(support.velocity, support.history),
                                    support.point};
  if (bits == 0) return motion;
  motion.spin = scale_of(support.spin);
  motion.spin_over = amplitudes<SpinOf<Vector>>(support.spin, support.history);
  return motion;
}

/// How a load changes over time, by the quantity that its kind asks for.
template <class Vector, class Load>
AmplitudeOf<Vector> load_amplitude(const Load& load, LoadKind kind) {
  if (kind == LoadKind::traction) return amplitudes<Vector>(load.traction, load.history);
  if (kind == LoadKind::force) return amplitudes<Vector>(load.force, load.history);
  return amplitudes<Vector>(kind == LoadKind::absorbing ? OverTime<double>(1.0) : load.pressure,
                            load.history);
}

/// How large loads are, and how that changes: what configure() writes anew.
template <class World, class Config>
void prescribe_loads(World& w, const Config& config) {
  using Vector = typename ShapeOf<World>::Vector;
  auto& given = set_up(w);
  given.loads.clear();
  given.load_amplitudes.clear();
  given.load_names.clear();
  for (const auto& load : config.loads) {
    const LoadKind kind = load_kind(load.kind);
    given.load_names.push_back(load.name);
    given.loads.push_back({kind, from_space<Vector>({1.0, 1.0, 1.0}), 0.0, {}, {}});
    if (load.acts()) {
      given.loads.back().pressure = scale_of(load.pressure);
      given.loads.back().traction = scale_of(load.traction);
      given.loads.back().force = scale_of(load.force);
    }
    given.load_amplitudes.push_back(load_amplitude<Vector>(load, kind));
  }
}

}  // namespace breccia::fdem_shared
