#pragma once
// A frame without some of its groups.

#include <set>
#include <string>

#include "io/frame.hpp"

namespace breccia {

/// The frame without the spheres and triangles of some groups, and without the lines that end at
/// such spheres.
/// @throws InputError if the frame has no group of such a name (lists what it has)
Frame without_groups(const Frame& frame, const std::set<std::string>& hidden);

}  // namespace breccia
