#pragma once
// A frame that ranks make together: values go to where their blocks are compressed, and rank 0 gets
// the compressed blocks, and what it needs to draw the picture. No rank holds the whole.

#include <optional>
#include <string>
#include <vector>

#include "domain/together.hpp"
#include "run/frames/frame_output.hpp"

namespace breccia {

class FrameOfParts {
 public:
  /// On every rank, with its part of the frame. Of the picture that is wished for, ranks other than
  /// 0 use what names fields, and size.
  FrameOfParts(FramePart part, const FrameWish& wish, Communicator& ranks, int threads);

  /// Every rank at once. On ranks other than 0 the result is empty.
  FrameOutput output();

 private:
  using Block = FrameBlocks::Block;
  /// One rank's share of a block.
  struct Values {
    std::vector<std::uint16_t> behind;  ///< items from the first one of the block on
    std::span<const std::byte> bytes;
  };

  /// This rank's share of the work, for rank 0.
  Message share();
  void see();
  void give_values(Message& message, const Block& block) const;
  void take_values(const Block& block, const std::vector<Values>& from,
                   std::vector<std::byte>& to) const;

  FramePart part_;
  FrameWish wish_;
  Communicator& ranks_;
  int threads_;
  std::optional<FrameBlocks> files_;
  std::vector<int> worker_;  ///< that compresses each block
  Frame seen_;               ///< rank 0: what the picture shows
  FrameOutput output_;
};

}  // namespace breccia
