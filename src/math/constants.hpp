#pragma once
// Numbers of mathematics.

namespace breccia {

inline constexpr double pi = 3.14159265358979323846;

}  // namespace breccia
