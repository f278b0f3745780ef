#pragma once
// How large pictures can be.

namespace breccia {

/// Sides of a picture.  [pixels]
constexpr int least_side = 16, largest_side = 16384;

constexpr bool is_side(int pixels) {
  return pixels >= least_side && pixels <= largest_side;
}

}  // namespace breccia
