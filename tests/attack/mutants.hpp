#pragma once
// Damage at random, from a seed alone: changed bits, runs, lengths, blocks and numbers at borders.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace breccia::attack {

using Random = std::mt19937_64;

inline std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : random() % n;
}

/// Changes at least one byte or the length, in one of ten ways.
inline void mutate(std::string& bytes, Random& random) {
  const std::string before = bytes;
  while (bytes == before) {
    const std::size_t size = bytes.size(), at = below(random, size);
    const std::size_t length = std::min(size - at, std::size_t{1} << below(random, 13));
    switch (random() % 10) {
      case 0:  // one bit
      case 1:
        if (size > 0) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 2:  // one byte
        if (size > 0) bytes[at] = static_cast<char>(random());
        break;
      case 3: {  // a number at a border of its range
        static constexpr std::int64_t numbers[] = {
            -1, 0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, INT64_MAX, INT64_MIN};
        const std::size_t width = std::size_t{1} << random() % 4;
        const std::int64_t number = numbers[random() % std::size(numbers)];
        if (at + width <= size) std::memcpy(bytes.data() + at, &number, width);
        break;
      }
      case 4:  // cut
        bytes.resize(at);
        break;
      case 5:  // longer
        bytes.append(1 + below(random, 4096), static_cast<char>(random()));
        break;
      case 6:  // a block of zeros or ones, as a disk may leave it
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length, random() % 2 ? 0 : -1);
        break;
      case 7:  // left out
        bytes.erase(at, length);
        break;
      case 8:  // twice
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 9: {  // two blocks changed about
        const std::size_t other = below(random, size - length + 1);
        const std::string a = bytes.substr(at, length), b = bytes.substr(other, length);
        bytes.replace(at, length, b);
        bytes.replace(other, length, a);
        break;
      }
    }
  }
}

}  // namespace breccia::attack
