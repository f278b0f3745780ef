#pragma once
// The probes of a run as curves.

#include <string>

#include "report/record.hpp"

namespace breccia::report {

/// Probes over time, those of one unit in a plot; before them stresses over strain, if the run has
/// a probe with "strain" in its name and others in Pa, and before all the curves that the case
/// names. SVG; empty if the run has no probes.
std::string curves_of(const Record& record);

}  // namespace breccia::report
