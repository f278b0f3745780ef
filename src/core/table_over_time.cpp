#include "core/table_over_time.hpp"

#include <algorithm>
#include <cmath>

namespace breccia {
namespace {

View<const double> view_of(const std::vector<double>& numbers) {
  View<const double> view;
  view.data = numbers.data();
  view.size = static_cast<Index>(numbers.size());
  return view;
}

}  // namespace

double Amplitude::at(double time) const {
  return AmplitudeTable{ramp, begin, 0, static_cast<Index>(times.size())}.at(time, view_of(times),
                                                                             view_of(factors));
}

double Amplitude::largest() const {
  double most = factors.empty() ? 1.0 : 0.0;
  for (const double f : factors) most = std::max(most, std::abs(f));
  return most;
}

bool ScaledAmplitude::is_zero() const {
  return scale * amplitude.largest() == 0.0;
}

AmplitudeTable AmplitudeTables::append(const Amplitude& a) {
  const auto first = static_cast<Index>(times.size());
  times.insert(times.end(), a.times.begin(), a.times.end());
  factors.insert(factors.end(), a.factors.begin(), a.factors.end());
  return {a.ramp, a.begin, first, static_cast<Index>(times.size())};
}
View<const double> AmplitudeTables::times_view() const {
  return view_of(times);
}
View<const double> AmplitudeTables::factors_view() const {
  return view_of(factors);
}

}  // namespace breccia
