#pragma once
// Which elements supports hold, and how these must move.

#include <vector>

#include "dem/element_kernels.hpp"
#include "dem/model.hpp"

namespace breccia::dem {

struct Config;

/// What the supports of a case prescribe of each element.
struct Prescribed {
  std::vector<std::uint8_t> fixed;          ///< bits of Fixed  [-]
  std::vector<std::int16_t> motion;         ///< index into motions, -1: stands still  [-]
  std::vector<Motion> motions;              ///< each combination of supports that there is
  std::vector<std::vector<Index>> members;  ///< of each support, ascending
};

/// Several supports may hold one element, if they prescribe different directions or the same
/// motion.
/// @throws InputError naming supports that hold no element, or that contradict each other
Prescribed prescribed(const Config& config, const Model& model);

}  // namespace breccia::dem
