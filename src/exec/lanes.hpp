#pragma once
// How many items the processor's vectors take side by side.

namespace breccia {

/// 1, 4 (AVX2) or 8 (AVX-512) doubles.
enum class Lanes { one = 1, four = 4, eight = 8 };

/// The widest that was built and that this processor has.
Lanes widest_lanes();

}  // namespace breccia
