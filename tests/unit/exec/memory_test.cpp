#include "exec/memory.hpp"

#include <gtest/gtest.h>

#include "exec/buffer.hpp"

namespace breccia {
namespace memory_test {

TEST(ArrayMemory, PeakCountsFromWhereItWasForgotten) {
  constexpr Index large = 1 << 20, small = 1 << 17;
  const Buffer<double> kept(Space::host, small);
  { const Buffer<double> gone(Space::host, large); }
  EXPECT_GE(peak_array_bytes(), sizeof(double) * (large + small));
  forget_peak_of_arrays();
  const std::size_t alive = peak_array_bytes();
  EXPECT_GE(alive, sizeof(double) * small);
  EXPECT_LT(alive, sizeof(double) * large);
  { const Buffer<double> more(Space::host, small); }
  EXPECT_GE(peak_array_bytes(), alive + sizeof(double) * small);
  EXPECT_LT(peak_array_bytes(), alive + sizeof(double) * large);
}

TEST(ArrayMemory, KeepsWhatWasWrittenBeyondTheEnd) {
  Buffer<int> numbers(Space::host, 2);
  numbers.reserve(8);
  const int* const memory = numbers.data();
  for (int k = 0; k < 5; ++k) numbers.data()[k] = 10 + k;
  numbers.extend_to(5);
  ASSERT_EQ(numbers.size(), 5);
  EXPECT_EQ(numbers.data(), memory);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(numbers.host()[static_cast<std::size_t>(k)], 10 + k);
}

}  // namespace memory_test
}  // namespace breccia
