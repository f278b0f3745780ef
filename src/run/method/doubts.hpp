#pragma once
// Doubts about a case that show once its model is set up.

#include <string>
#include <vector>

#include "run/method/method.hpp"

namespace breccia {

/// A warning if a run may pass its end by more than a fiftieth of it; else empty: steps are not
/// cut, so that where a run ends changes no bit of it.
/// @param step  at the start  [s]  @param end  time.end  [s]
std::string long_step_text(double step, double end);

/// Warnings of a method about its case, and about its step if it is at the start.
/// @param end  time.end; large if the run does not go there  [s]
std::vector<std::string> doubts_of(Method& method, double end);

}  // namespace breccia
