#pragma once
// Names of wrong numbers in a state.

#include <string>

#include "exec/types.hpp"

namespace breccia {

/// The first element whose numbers are unsound, and what to tell of it.
struct Unsound {
  static constexpr GlobalId none = 0x7fffffff;
  GlobalId id = none;
  std::string text;
};

}  // namespace breccia
