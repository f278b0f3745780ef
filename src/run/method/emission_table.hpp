#pragma once
// Acoustic emission in the results of a run, of any method.

#include <vector>

#include "core/emission.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// events.csv.
Table table_of(const std::vector<EmissionEvent>& events);

/// Numbers of `emission` in a summary that a run may tell besides `events`.
inline constexpr const char* emission_numbers[] = {"largest_magnitude", "b_value", "b_deviation",
                                                   "completeness", "counted"};

/// `emission.events`, and the others where there are events enough.
void add_emission(std::vector<Fact>& facts, const std::vector<EmissionEvent>& events);

}  // namespace breccia
