#pragma once
// NLopt, for calibrations: what it costs beside secants is in docs/laboratory.md.

#include <functional>
#include <string>
#include <vector>

namespace breccia::laboratory {

/// Whether the program is built with NLopt.
bool has_nlopt();

/// Makes the largest of several misfits small, without slopes. "cobyla" makes a bound t small
/// under which all misfits are, and "sbplx" goes on from the best point where that stalls;
/// "sbplx" and "bobyqa" alone make the largest misfit small.
/// @param start    first point; no coordinate leaves it by more than a factor e
/// @param misfits  of a point, any number of them, of either sign; empty: the search is over
/// @throws InputError of an unknown method, or if the program is built without NLopt
void make_small(const std::string& method, std::vector<double> start,
                const std::function<std::vector<double>(const std::vector<double>&)>& misfits);

}  // namespace breccia::laboratory
