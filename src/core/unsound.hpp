#pragma once
// Names of elements that something is wrong with, or may be.

#include <functional>
#include <string>

#include "exec/types.hpp"

namespace breccia {

/// The first element whose numbers are unsound, and what to tell of it.
struct Unsound {
  static constexpr GlobalId none = 0x7fffffff;
  GlobalId id = none;
  std::string text;
};

/// The first unsound element of the present state, when it is asked for: until then the host can go
/// on, but not the state.
using UnsoundLater = std::function<Unsound()>;

/// A speed and whose it is.
struct Speed {
  double squared = -1.0;        ///<  [m2/s2]
  GlobalId id = Unsound::none;  ///< none: no element has one
};
/// Combines speeds: the larger one, of equal ones that of the lower id.
struct Faster {
  BR_HD Speed operator()(const Speed& a, const Speed& b) const {
    const bool second = b.squared > a.squared || (b.squared == a.squared && b.id < a.id);
    return second ? b : a;
  }
};
/// The element that moves fastest, and what to tell of it.
struct Fastest {
  Speed speed;
  std::string text;
};

}  // namespace breccia
