#pragma once
// The opening and closing lines of a run.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/stages.hpp"
#include "run/results/summary.hpp"

namespace breccia {

/// Where a run ends at the latest.
struct RunEnd {
  double time = 0.0;  ///< simulated  [s]
  std::int64_t steps = std::numeric_limits<std::int64_t>::max();
  bool may_be_earlier = false;  ///< a stage may end at rest or by a probe
};

/// Text at the start: what was read and what is to come.
std::string opening_text(const Summary& summary, const RunEnd& end, const std::string& folder);

/// How many links or joints have broken, in words; empty if there are none to break.
std::string broken_text(const std::vector<Fact>& facts);

/// A warning if inertia had a part in a run in which it was scaled; else empty.
/// @param kinetic_share  see Summary
std::string inertia_text(double mass_scaling, double kinetic_share);

/// A warning if a case has come to its end before all its stages have begun; else empty.
/// @param present  place of the stage that it ended in
std::string unbegun_text(const std::vector<StageEnd>& stages, int present);

/// Text at the end: what came out, and where it lies.
std::string closing_text(const Summary& summary, std::int64_t frames, const std::string& folder);

}  // namespace breccia
