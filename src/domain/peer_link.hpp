#pragma once
// Copies from one GPU to another without the host: each rank packs what others hold copies of into
// memory that they reach, and they read it from there.

#include <vector>

#include "domain/communicator.hpp"
#include "exec/peer_memory.hpp"

namespace breccia {

/// Ranks of one machine that read each other's memory.
///
/// Each rank has two halves of memory that all others have opened, and for each half two moments:
/// "packed" and "taken". Exchange n uses half n % 2. Every rank, in exchange n:
///
///     begin    its GPU waits for "taken" n - 2 of those that have read this half; then it packs
///     packed   "packed" n is marked, and a token sent to all
///     await    when the tokens of all have come, its GPU waits for "packed" n; then it reads
///     taken    "taken" n is marked
///
/// The host waits for tokens alone, never for its GPU. They tell that moments have been marked
/// before others' GPUs wait for them, since a wait for what is not marked yet would not wait:
/// - of "packed" n that is what token n says;
/// - "taken" n - 2 was marked before token n - 1 was sent, and all those have come in await n - 1.
/// And no moment is marked anew too early:
/// - "packed" n + 2 is marked after token n + 1 of all, which a rank sends after await n;
/// - "taken" n is marked after token n of all, which a rank sends after begin n.
/// GPUs wait in no circle: what "packed" n waits for, "taken" n - 2, waits for "packed" n - 2 only.
class PeerLink {
 public:
  /// @param space  where the memory lies: that of a GPU, or of the host's threads in tests
  PeerLink(Communicator& ranks, Space space) : ranks_(ranks), space_(space) {}

  Space space() const { return space_; }
  /// Whether there is room that all reach.
  bool in_use() const { return own_ != nullptr; }

  /// Room for so many bytes in each half. Every rank calls it with the same number; where that is
  /// more than there is, all meet. @returns whether every rank reaches all others' memory; if not,
  /// there is no link.
  bool make_room(std::size_t bytes);

  /// @param readers  ranks that will read what is packed now
  /// @returns where to pack it
  std::byte* begin(const std::vector<int>& readers);
  void packed();
  /// @param owners  ranks whose halves will be read
  void await(const std::vector<int>& owners);
  /// Items that a rank has packed.
  const std::byte* half_of(int rank) const { return half(*peers_[static_cast<std::size_t>(rank)]); }
  void taken() { own_->mark(taken_ + side_); }

  /// Lets go of the others' memory, until room is made anew. When all have done so the link may
  /// end.
  void close();

 private:
  static constexpr int packed_ = 0, taken_ = 2;  ///< moments of the first half; then the other's

  std::byte* half(const PeerMemory& memory) const {
    return memory.data() + static_cast<std::size_t>(side_) * room_;
  }
  void prepare_tokens();

  Communicator& ranks_;
  Space space_;
  std::size_t room_ = 0;  ///< of a half  [B]
  bool refused_ = false;
  int side_ = 0;  ///< half of the last exchange
  std::unique_ptr<PeerMemory> own_;
  std::vector<std::unique_ptr<PeerMemory>> peers_;  ///< by rank; none for this one
  std::vector<int> readers_[2];                     ///< of what was packed last in each half
  std::byte token_{};
  std::vector<std::byte> came_;
  std::unique_ptr<RepeatedMessages> tokens_;
};

}  // namespace breccia
