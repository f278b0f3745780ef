#pragma once
// The bounds of bodies, as regions, walls and points see them before a model is built.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// A box with sides along the axes; in the plane the third is of no extent.
struct Bounds {
  std::array<double, 3> low{}, high{};  ///<  [m]
};

/// The box around a region; without end of the complement of one.
Bounds region_bounds(const dem::SupportConfig& support);
Bounds region_bounds(const fdem::RegionConfig& region);
Bounds region_bounds(const fdem3::RegionConfig& region);

/// A body as regions see it.
struct Outline {
  std::string name;
  std::optional<Bounds> bounds;  ///< none: only its file tells
  bool in_another = false;       ///< a part: its triangles are some of another body
};

/// @param folder  of the case; null: files are not looked at
/// @param radii   whether spheres of a file reach beyond their centres
std::vector<Outline> outlines_of(const dem::Config& config, const std::string* folder,
                                 bool radii = false);
std::vector<Outline> outlines_of(const fdem::Config& config, const std::string* folder);
std::vector<Outline> outlines_of(const fdem3::Config& config, const std::string* folder);

}  // namespace breccia::prepare
