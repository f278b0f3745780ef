#pragma once
// Couples of which supports hold an element: all that servos look at.

#include "exec/buffer.hpp"

namespace breccia::fdem_shared {

/// Listed when a servo asks for them. A search, another stage and ranks make the list unknown.
struct HeldCouples {
  Buffer<Index> item;  ///< ascending  [-]
  bool known = false;
};

}  // namespace breccia::fdem_shared
