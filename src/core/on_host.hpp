#pragma once
// States and arrays as the host reads them.

#include <optional>

#include "core/fields.hpp"

namespace breccia {

/// A state or an array for reading on the host: itself where it lies there, else a copy.
template <class State>
class OnHost {
 public:
  /// @param space  where the state lies
  OnHost(const State& state, Space space) : state_(&state) {
    if (space == Space::host) return;
    copy_.emplace(host_copy(state));
    state_ = &*copy_;
  }
  OnHost(const OnHost&) = delete;
  OnHost& operator=(const OnHost&) = delete;

  const State& operator*() const { return *state_; }
  const State* operator->() const { return state_; }

 private:
  std::optional<State> copy_;
  const State* state_;
};

}  // namespace breccia
