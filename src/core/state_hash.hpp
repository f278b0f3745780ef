#pragma once
// A 64-bit hash of a state by global id: a sum over elements, so no order matters.

#include "exec/buffer.hpp"
#include "math/vec.hpp"

namespace breccia {

/// Mixes every bit of a word into all others (finalizer of the splitmix64 generator).
BR_HD inline std::uint64_t mixed(std::uint64_t word) {
  word ^= word >> 30;
  word *= 0xbf58476d1ce4e5b9ULL;
  word ^= word >> 27;
  word *= 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

/// The bits of a number; both zeros count as one.
BR_HD inline std::uint64_t number_bits(double value) {
  const double one_zero = value + 0.0;
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof one_zero);
  const auto* from = reinterpret_cast<const unsigned char*>(&one_zero);
  auto* to = reinterpret_cast<unsigned char*>(&bits);
  for (unsigned k = 0; k < sizeof bits; ++k) to[k] = from[k];
  return bits;
}

/// Hash of one element: its id and, in their order, the numbers it is made of.
class ItemHash {
 public:
  BR_HD explicit ItemHash(GlobalId id)
      : word_(mixed(static_cast<std::uint64_t>(static_cast<std::uint32_t>(id)) +
                    0x9e3779b97f4a7c15ULL)) {}
  BR_HD void add(double value) {
    word_ = mixed(word_ + 0x9e3779b97f4a7c15ULL + number_bits(value));
  }
  BR_HD void add(const Vec3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  BR_HD std::uint64_t value() const { return word_; }

 private:
  std::uint64_t word_;
};

}  // namespace breccia
