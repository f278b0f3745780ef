#pragma once
// The constants of a run, for set-up to write.

#include "core/set_up.hpp"

namespace breccia::fdem_shared {

template <class World>
auto& set_up(World& w) {
  return w.given.change(SetUp{});
}

}  // namespace breccia::fdem_shared
