#pragma once
// Phase of a couple: a byte that tells a step whether to evaluate it, without a look at its state.

#include <cstdint>

#include "exec/early.hpp"

namespace breccia::fdem_shared {

enum class CouplePhase : std::uint8_t {
  rests,  ///< it has begun, and holds no work and no force: only whether the two meet is asked
  acts,   ///< it is new, or may hold work or a force
  waits   ///< it may not touch yet (open_vertices.hpp): it is new, without a force
};

/// read_now() of a phase.
BR_HD inline CouplePhase read_phase_now(const CouplePhase* from) {
  return static_cast<CouplePhase>(breccia::read_now(reinterpret_cast<const std::uint8_t*>(from)));
}

}  // namespace breccia::fdem_shared
