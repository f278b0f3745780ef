#pragma once
// Keys of cases of spheres and tetrahedra, for pages of keys.

#include <vector>

#include "coupled/setup/config.hpp"
#include "io/case/key_pages.hpp"
#include "run/case_keys.hpp"

namespace breccia::app {

/// The word for method = ["dem3d", "fdem3d"].
inline constexpr const char* both_methods = "dem3d+fdem3d";

/// Keys that neither method has; theirs stand below [spheres] and [tetrahedra].
inline std::vector<KeyInfo> keys_between() {
  std::vector<KeyInfo> keys;
  for (const char* table : {"coupling.", "bond[]."})
    for (KeyInfo& key : list_keys<coupled::Config>(table)) keys.push_back(std::move(key));
  return keys;
}

}  // namespace breccia::app
