#pragma once
// Problems of the keys of a set of joints, in the plane and in space.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/nearest_name.hpp"

namespace breccia::prepare {

/// Problems of the keys that sets in the plane and in space share. @returns whether it comes from a
/// file, so that there is nothing more to check
/// @param items    "lines" or "discs"
/// @param require  (bool holds, std::string text after the set's name)
template <class Set, class Require>
bool check_shared_keys(const Set& set, const std::vector<std::string>& joints, const char* items,
                       const Require& require) {
  require(set.kind != "cohesive" ||
              std::find(joints.begin(), joints.end(), set.material) != joints.end(),
          fmt::format(".material = \"{}\" is not a joint law; there are: {}", set.material,
                      joints.empty() ? "none" : fmt::format("{}", fmt::join(joints, ", "))) +
              meant_name(set.material, joints));
  if (set.file.empty()) return false;
  require(set.file.ends_with(".csv") || set.file.ends_with(".wkt"),
          fmt::format(".file = \"{}\" is neither a .csv nor a .wkt file", set.file));
  require(set.intensity == 0.0,
          fmt::format(".intensity is of random {}, and these come from a file", items));
  return true;
}

}  // namespace breccia::prepare
