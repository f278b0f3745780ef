#pragma once
// From a frame to the bytes of its files and of its picture.

#include <optional>
#include <string>

#include "io/picture/picture.hpp"
#include "io/vtu/vtu_writer.hpp"

namespace breccia {

/// Files and pictures asked for of a frame.
struct FrameWish {
  bool files = true;
  std::optional<RenderOptions> picture;  ///< without an extent: that of this frame
  /// The extent of the first frame, if the picture's is to grow with what leaves it.
  std::optional<Extent> grows_from = {};
  FrameFormat format = FrameFormat::vtu;
};

struct FrameOutput {
  FrameContents files;  ///< empty if not wished
  std::string png;      ///< likewise
  Extent extent{};      ///< that the picture shows
  int height = 0;       ///< of the picture  [pixels]
  bool blank = false;   ///< nothing of the model is in the picture
};

/// Blocks are compressed, and the picture is encoded meanwhile, by that many threads: the same
/// bytes for any number of them.
FrameOutput frame_output(const Frame& whole, const FrameWish& wish, int threads);

/// Output of a frame, with the files of contacts.
FrameOutput frame_output(const FramePart& whole, const FrameWish& wish, int threads);

/// The picture that is wished for; notes what it shows.
Image drawn(const Frame& whole, const FrameWish& wish, int threads, FrameOutput& output);

}  // namespace breccia
