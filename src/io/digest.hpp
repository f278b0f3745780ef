#pragma once
// Digests that tell damage from what was written: XXH3-128, in its canonical byte order.

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "io/file.hpp"

namespace breccia {

using Digest = std::array<std::byte, 16>;

/// The digest of pieces that follow each other.
class RunningDigest {
 public:
  RunningDigest();
  RunningDigest(const RunningDigest&) = delete;
  RunningDigest& operator=(const RunningDigest&) = delete;
  ~RunningDigest();

  void add(Bytes bytes);
  Digest value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

Digest digest(Bytes bytes);
/// 32 hexadecimal digits.
std::string digest_text(const Digest& digest);

}  // namespace breccia
