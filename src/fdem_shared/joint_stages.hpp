#pragma once
// Whether joints are at some stage: what tells of them copies no other array where none is.

#include <algorithm>

#include "core/on_host.hpp"

namespace breccia::fdem_shared {

/// @param is  is(stage)
template <class World, class Is>
bool any_joint(const World& w, const Is& is) {
  const OnHost stages(w.joints.stage, w.exec.space);
  const auto all = stages->host();
  return std::any_of(all.begin(), all.end(), is);
}
template <class World>
bool any_damaged(const World& w) {
  return any_joint(w, [](auto stage) { return is_damaged(stage); });
}
template <class World>
bool any_broken(const World& w) {
  return any_joint(w, [](auto stage) { return stage == decltype(stage)::broken; });
}

template <class World>
Index count_broken(const World& w) {
  const OnHost stages(w.joints.stage, w.exec.space);
  const auto all = stages->host();
  return static_cast<Index>(std::count_if(
      all.begin(), all.end(), [](auto stage) { return stage == decltype(stage)::broken; }));
}

}  // namespace breccia::fdem_shared
