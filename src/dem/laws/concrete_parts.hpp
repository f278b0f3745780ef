#pragma once
// Parts of the law of concrete links, for kernels that are compiled for some of them.

#include "exec/types.hpp"

namespace breccia::dem {

/// Parts of the law that a material may lack, as bits. A kernel that is compiled for few of them
/// has fewer questions and registers; its results are those of the whole law.
using ConcreteParts = unsigned;
inline constexpr ConcreteParts concrete_compacts = 1, concrete_wears = 2,
                               concrete_caps_friction = 4, concrete_caps_rolling = 8,
                               concrete_is_hyperbolic = 16, concrete_knee = 32, concrete_rated = 64,
                               concrete_damps = 128, concrete_all = 255;
/// Parts of concrete with bounds under pressure (docs/theory.md, concrete under pressure).
inline constexpr ConcreteParts concrete_bounded =
    concrete_compacts | concrete_wears | concrete_caps_rolling;

/// Whether a constant of a law that is 0 or a plain number is above 0: a device compares integers.
BR_HD inline bool is_given(double constant) {
#if defined(__CUDA_ARCH__)
  return __double2hiint(constant) > 0;
#else
  return constant > 0.0;
#endif
}
BR_HD inline bool is_given(float constant) {
#if defined(__CUDA_ARCH__)
  return __float_as_int(constant) > 0;
#else
  return constant > 0.0F;
#endif
}

}  // namespace breccia::dem
