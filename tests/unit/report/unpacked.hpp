#pragma once
// The other way round: what a page's reader makes of packed bytes.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace breccia::test {

inline std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 255U));
  }
  return bytes;
}

inline std::string inflated(const std::string& packed) {
  std::string bytes(1 << 22, '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  bytes.resize(size);
  return bytes;
}

/// Reads numbers whose bytes lie in planes.
class PlaneReader {
 public:
  explicit PlaneReader(std::string bytes) : bytes_(std::move(bytes)) {}

  std::vector<std::uint32_t> numbers(std::size_t count, int width) {
    std::vector<std::uint32_t> read(count, 0);
    for (int plane = 0; plane < width; ++plane)
      for (std::uint32_t& number : read)
        number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_.at(place_++)))
                  << (8 * plane);
    return read;
  }
  bool at_end() const { return place_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

inline std::int32_t unzigzag(std::uint32_t folded) {
  return static_cast<std::int32_t>(folded >> 1) ^ -static_cast<std::int32_t>(folded & 1U);
}

}  // namespace breccia::test
