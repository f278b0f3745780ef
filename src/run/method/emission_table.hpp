#pragma once
// Acoustic emission in the results of a run, of any method.

#include <vector>

#include "core/emission.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// events.csv.
Table table_of(const std::vector<EmissionEvent>& events);

/// `emission.*`: nothing where there was no event.
void add_emission(std::vector<Fact>& facts, const std::vector<EmissionEvent>& events);

}  // namespace breccia
