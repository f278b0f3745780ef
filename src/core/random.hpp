#pragma once
// Random numbers that are a function of (seed, stream, index): no state, so no order matters.

#include <array>
#include <cstdint>

#include "exec/types.hpp"

namespace breccia {

/// Philox 4x32 with 10 rounds (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3"):
/// four random words from a counter of four words and a key of two.
BR_HD constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t q = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {
        static_cast<std::uint32_t>(q >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(q),
        static_cast<std::uint32_t>(p >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p)};
    key[0] += 0x9E3779B9U;
    key[1] += 0xBB67AE85U;
  }
  return counter;
}

/// The random numbers of one purpose (stream) in one case (seed).
struct Random {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;

  /// Uniform in [0, 1), a multiple of 2^-53; `draw` numbers the values of one index.
  BR_HD constexpr double uniform(std::uint64_t index, std::uint32_t draw = 0) const {
    const auto word = philox(
        {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), stream, draw},
        {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
    const std::uint64_t bits = (std::uint64_t{word[0]} << 32) | word[1];
    return static_cast<double>(bits >> 11) * 0x1p-53;
  }
};

}  // namespace breccia
