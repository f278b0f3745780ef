#pragma once
// The constants of a run, for set-up to write.

#include "core/set_up.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

inline Case& set_up(World& w) {
  return w.given.change(SetUp{});
}

}  // namespace breccia::fdem3
