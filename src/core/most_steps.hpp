#pragma once
// How many steps a run can take at most.

namespace breccia {

/// No machine takes more steps than this, and time, a sum of them, would stop.
inline constexpr double most_steps = 1e15;

}  // namespace breccia
