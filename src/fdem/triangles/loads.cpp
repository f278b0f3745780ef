#include "fdem/triangles/loads.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::fdem {

double Amplitude::at(double time) const {
  View<const double> seen_times, seen_factors;
  seen_times.data = times.data();
  seen_factors.data = factors.data();
  seen_times.size = seen_factors.size = static_cast<Index>(times.size());
  return AmplitudeTable{ramp, 0, seen_times.size}.at(time, seen_times, seen_factors);
}

double Amplitude::largest() const {
  double most = factors.empty() ? 1.0 : 0.0;
  for (const double f : factors) most = std::max(most, std::abs(f));
  return most;
}

}  // namespace breccia::fdem
