#pragma once
// Loads of a case: their edges, sizes, and how they change over time.

#include "fdem/setup/config.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// The factor of a quantity along an axis: its own table, or the table of factors.
template <class Value>
Amplitude amplitude(const OverTime<Value>& quantity, int axis, const HistoryConfig& history) {
  if (quantity.is_table())
    return scaled_amplitude(quantity, axis, history.ramp, history.begin).amplitude;
  return {history.ramp, history.begin, history.times, history.factors};
}

/// The quantity that amplitudes are factors of.
inline Vec2 scale_of(const OverTime<Vec2>& quantity) {
  return quantity.is_table() ? Vec2{1.0, 1.0} : quantity.value;
}

/// How large loads are, and how that changes: what configure() writes anew.
void prescribe_loads(World& w, const Config& config);
/// Which edges they act on.
void set_up_loads(World& w, const Config& config, const Model& model);

}  // namespace breccia::fdem
