#pragma once
// Numbers as the few bytes of text that a page carries: quantised, split into planes, deflated, in
// base 64.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace breccia::report {

/// Numbers of 1 to 4 bytes behind each other: of each array first all lowest bytes, then all next
/// ones. Bytes that hardly change then stand side by side, which packs well.
class Planes {
 public:
  void add(const std::vector<std::uint32_t>& numbers, int width);
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A difference modulo 2^(8 width) as a small number whatever its sign: 0, -1, 1, -2, ... become
/// 0, 1, 2, 3, ...
std::uint32_t zigzag(std::uint32_t difference, int width);

/// How a field's values become whole numbers, from 0 to `last`.
struct Scale {
  float low = 0.0F, high = 0.0F;  ///< values of the two ends
  std::uint32_t last = 255;
  bool root = false;  ///< steps are even in sign(v) sqrt|v|: fine near zero, for a few high peaks

  /// The nearest step; what is no number counts as zero.
  std::uint32_t step_of(float value) const;
  /// Bytes of a step.
  int width() const { return last < 256 ? 1 : last < 65536 ? 2 : last < (1U << 24) ? 3 : 4; }
};

/// The bytes as a zlib stream. @throws DeviceError if there is not enough memory
std::string deflated(std::string_view bytes);
std::string base64(std::string_view bytes);

}  // namespace breccia::report
