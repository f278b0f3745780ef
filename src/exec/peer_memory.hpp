#pragma once
// Memory of a GPU that other processes of this machine read, and moments that their GPUs wait for.

#include <cstddef>
#include <memory>

#include "exec/space.hpp"

namespace breccia {

/// Handles by which another process opens a PeerMemory.
struct PeerPass {
  static constexpr int moments = 4;
  std::byte memory[64] = {};
  std::byte moment[moments][64] = {};
  bool valid = false;
};

/// An array that its owner makes and others open, by CUDA's interprocess calls; on the host, for
/// tests, of threads of one process. With it go a few moments: points that the owner's stream has
/// reached. All who have opened it let go of it before its owner does.
class PeerMemory {
 public:
  /// @returns null where memory cannot be shared
  static std::unique_ptr<PeerMemory> make(Space space, std::size_t bytes);
  static std::unique_ptr<PeerMemory> open(Space space, const PeerPass& pass);
  PeerMemory(const PeerMemory&) = delete;
  PeerMemory& operator=(const PeerMemory&) = delete;
  ~PeerMemory();

  const PeerPass& pass() const { return pass_; }
  std::byte* data() const { return data_; }

  /// The owner: moment k is when all that this thread has asked of its GPU so far is done.
  void mark(int k) const;
  /// The owner or another: what this thread asks of its GPU from now on begins after moment k, as
  /// it was last marked before this call, by whatever process; at once if it never was.
  void follow(int k) const;

 private:
  PeerMemory(Space space, bool own) : space_(space), own_(own) {}
  bool take(std::size_t bytes);
  bool reach(const PeerPass& pass);

  Space space_;
  bool own_;
  std::byte* data_ = nullptr;
  PeerPass pass_;
  void* moment_[PeerPass::moments] = {};  ///< events of CUDA
};

}  // namespace breccia
