#pragma once
// Numbers that the ranks of one machine tell each other in memory that they share.

#include <atomic>
#include <cstdint>
#include <span>

namespace breccia {

/// The numbers that a rank has published, in rounds: even and odd ones apart. All zero at first.
struct VoteSlot {
  struct alignas(64) Side {
    std::atomic<std::uint64_t> round;  ///< the last one told, counted from 1
    std::uint64_t number;
  };
  Side side[2];
};

/// Each rank publishes one number a round and collects those of all. Publishing never waits.
/// Double buffering suffices: no rank can publish round n+2 before every rank has published n+1
/// and therefore read n.
class SharedReduction {
 public:
  /// @param slots  of all ranks; they outlive the board
  /// @param self   which of them is this rank's
  SharedReduction(std::span<VoteSlot> slots, std::size_t self) : slots_(slots), self_(self) {}

  /// Begins a round. The last one has been heard.
  void publish(std::uint64_t number) {
    ++round_;
    VoteSlot::Side& own = side(slots_[self_]);
    own.number = number;
    own.round.store(round_, std::memory_order_release);
  }
  /// Calls visit(number) for each rank, in their order, when all have told theirs.
  /// @param idle  called again and again while this rank waits
  template <class Idle, class Visit>
  void collect(const Idle& idle, const Visit& visit) {
    for (VoteSlot& slot : slots_) {
      VoteSlot::Side& other = side(slot);
      while (other.round.load(std::memory_order_acquire) < round_) idle();
      visit(other.number);
    }
  }

 private:
  VoteSlot::Side& side(VoteSlot& slot) const { return slot.side[round_ % 2]; }

  std::span<VoteSlot> slots_;
  std::size_t self_;
  std::uint64_t round_ = 0;
};

}  // namespace breccia
