#pragma once
// Where cracks point, and what pieces are left.

#include <string>
#include <vector>

#include "report/record.hpp"
#include "report/shot.hpp"

namespace breccia::report {

/// A histogram of directions.
struct Rose {
  std::string name;             ///< what the angle is
  double from = 0.0, to = 0.0;  ///< angle at the ends of all bars  [deg]
  std::string unit;             ///< of the bars
  std::vector<double> bars;
};

/// In a plane: the directions of cracks, 0 along x, by their length. In space: strike and dip of
/// the planes across broken links, by their area. Empty if nothing broke.
/// @param first  where links pointed before
std::vector<Rose> roses_of(const Record& record, const Shot& first, const Shot& last);

/// Masses, or volumes, of the pieces that whole lines hold together, falling, as shares of all. By
/// fragments.csv, else by the links of spheres; empty if neither is there.
std::vector<double> fragment_shares(const Record& record, const Shot& last);

}  // namespace breccia::report
