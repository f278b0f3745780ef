#include "run/frames/frame_output.hpp"

#include <utility>

#include "exec/tasks.hpp"
#include "io/vtu/touching.hpp"

namespace breccia {

Image drawn(const Frame& whole, const FrameWish& wish, int threads, FrameOutput& output) {
  constexpr double ahead = 0.5;  // of what leaves the picture: the next frames are to fit, too
  RenderOptions options = *wish.picture;
  const bool moved = options.scale != 1.0;
  const Frame frame = moved ? displaced(whole, options.scale) : Frame();
  const Frame& seen = moved ? frame : whole;
  if (!options.extent)
    options.extent = bulk_extent(seen);
  else if (wish.grows_from)
    options.extent = grown_extent(*options.extent, *wish.grows_from, seen, ahead);
  options.scale = 1.0;
  output.extent = *options.extent;
  Image image = render(seen, options, threads);
  output.height = image.height;
  output.blank = image.model_pixels == 0;
  return image;
}

FrameOutput frame_output(const Frame& whole, const FrameWish& wish, int threads) {
  FrameOutput output;
  Image image;
  if (wish.picture) image = drawn(whole, wish, threads, output);
  const FramePlaces places = places_in(whole);
  std::optional<FrameBlocks> files;
  if (wish.files) files.emplace(whole, places, wish.format);
  std::vector<std::string> packed(files ? files->blocks().size() : 0);
  // The picture is one piece, and the longest: it comes first.
  for_each_task(threads, 1 + static_cast<int>(packed.size()), [&](int task) {
    const std::size_t b = static_cast<std::size_t>(task) - 1;
    if (task > 0)
      packed[b] = files->packed(files->blocks()[b]);
    else if (wish.picture)
      output.png = png_content(image);
  });
  if (files) output.files = files->contents(packed);
  return output;
}

FrameOutput frame_output(const FramePart& whole, const FrameWish& wish, int threads) {
  FrameOutput output = frame_output(whole.frame, wish, threads);
  if (!wish.files) return output;
  Touching touching{whole.frame.contacts, {}, places_in(whole.frame).plane()};
  touching.around.add(whole.frame.position);
  add_touching(output.files, whole.frame, std::move(touching), wish.format, threads);
  return output;
}

}  // namespace breccia
