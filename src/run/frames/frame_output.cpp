#include "run/frames/frame_output.hpp"

#include "exec/tasks.hpp"

namespace breccia {

Image drawn(const Frame& whole, RenderOptions options, int threads, FrameOutput& output) {
  if (!options.extent) options.extent = bulk_extent(whole);
  output.extent = *options.extent;
  return render(whole, options, threads);
}

FrameOutput frame_output(const Frame& whole, const FrameWish& wish, int threads) {
  FrameOutput output;
  Image image;
  if (wish.picture) image = drawn(whole, *wish.picture, threads, output);
  const FramePlaces places = places_in(whole);
  std::optional<FrameBlocks> files;
  if (wish.files) files.emplace(whole, places);
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

}  // namespace breccia
