#pragma once
// Where links broke first.

#include <cstdint>
#include <vector>

#include "report/record.hpp"
#include "report/shot.hpp"

namespace breccia::report {

/// Of the links that a shot shows broken, leaves those near the first of all breaks, if that is
/// known: a frame may be late, and a symmetric body breaks on both sides at once.
/// @param broken  1 for each broken link of the shot
void leave_first(const Record& record, const Shot& shot, std::vector<std::uint8_t>& broken);

/// Mean of the middles of those links.  [m]
Vec3 middle_of(const Shot& shot, const std::vector<std::uint8_t>& broken);

}  // namespace breccia::report
