#pragma once
// Loads of a case: their faces, sizes, and how they change over time.

#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// The three factors of a quantity over time: its own table, or the table of factors.
template <class Value>
AmplitudeOf3 amplitude(const OverTime<Value>& quantity, const HistoryConfig& history) {
  const auto along = [&](int axis) -> Amplitude {
    if (quantity.is_table())
      return scaled_amplitude(quantity, axis, history.ramp, history.begin).amplitude;
    return {history.ramp, history.begin, history.times, history.factors};
  };
  return {along(0), along(1), along(2)};
}
/// The quantity that they are factors of.
inline Vec3 scale_of(const OverTime<Vec3>& quantity) {
  return quantity.is_table() ? Vec3{1.0, 1.0, 1.0} : quantity.value;
}

/// How large loads are, and how that changes: what configure() writes anew.
void prescribe_loads(World& w, const Config& config);
/// Which faces they act on.
void set_up_loads(World& w, const Config& config, const Model& model);

}  // namespace breccia::fdem3
