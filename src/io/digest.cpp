#include "io/digest.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>
#include <new>

namespace breccia {
namespace {

Digest canonical(const XXH128_hash_t& hash) {
  XXH128_canonical_t ordered;
  XXH128_canonicalFromHash(&ordered, hash);
  Digest result;
  static_assert(sizeof result == sizeof ordered.digest);
  std::memcpy(result.data(), ordered.digest, sizeof ordered.digest);
  return result;
}

}  // namespace

struct RunningDigest::State {
  XXH3_state_t* stream = XXH3_createState();
  State() {
    if (stream == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(stream);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { XXH3_freeState(stream); }
};

RunningDigest::RunningDigest() : state_(std::make_unique<State>()) {}
RunningDigest::~RunningDigest() = default;

void RunningDigest::add(Bytes bytes) {
  XXH3_128bits_update(state_->stream, bytes.data(), bytes.size());
}

Digest RunningDigest::value() const {
  return canonical(XXH3_128bits_digest(state_->stream));
}

Digest digest(Bytes bytes) {
  return canonical(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string digest_text(const Digest& digest) {
  std::string text;
  for (const std::byte b : digest) text += fmt::format("{:02x}", std::to_integer<unsigned>(b));
  return text;
}

}  // namespace breccia
