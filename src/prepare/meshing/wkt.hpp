#pragma once
// Lines and polygons of .wkt files.

#include <string>
#include <vector>

#include "math/vec.hpp"

namespace breccia::prepare {

/// Points of each LINESTRING, those of MULTILINESTRINGs and GEOMETRYCOLLECTIONs, too. z is 0 where
/// it is left out; m is dropped.  [m]
/// @throws InputError  names file and line where it holds something else
std::vector<std::vector<Vec3>> lines_of_wkt(const std::string& path);

/// Corners of each POLYGON likewise, the last one, which is the first again, left out. Holes are
/// refused.  [m]
std::vector<std::vector<Vec3>> polygons_of_wkt(const std::string& path);

}  // namespace breccia::prepare
