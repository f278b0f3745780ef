#pragma once
// Notes of a picture on its run, from which it can be made again.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/picture/picture.hpp"
#include "io/picture/png_notes.hpp"

namespace breccia {

/// Of which moment of a run a picture is.
struct PictureMoment {
  std::int64_t step = 0;
  double time = 0.0;                       ///<  [s]
  std::optional<std::uint64_t> hash = {};  ///< of the state
  std::optional<int> frame = {};  ///< number of the stored frame it was drawn from; none: the state
};

/// A picture as its texts describe it.
struct PictureRecipe {
  std::string version, case_name, case_text;
  PictureMoment moment;
  RenderOptions options;
};

/// Program and its version, case with its completed file, seed.
std::vector<PngNote> notes_of_case(const std::string& name, const std::string& text,
                                   std::int64_t seed);
/// Step, time, hash and options of the picture.
std::vector<PngNote> notes_of_picture(const PictureMoment& moment, const RenderOptions& options);

/// @throws InputError naming `path` if the picture cannot be made again: texts are missing or
/// damaged
PictureRecipe recipe_of(const std::vector<PngNote>& notes, const std::string& path);

}  // namespace breccia
