#pragma once
// How films, sheets and panels can be made again: the texts of all their pictures, and digests of
// their pixels.

#include <cstdio>
#include <string>
#include <vector>

#include "io/picture/picture.hpp"
#include "io/picture/png_notes.hpp"

namespace breccia::app {

/// One frame as it stands in a picture.
struct RecipePart {
  int run = 0;                 ///< number of its run
  std::vector<PngNote> notes;  ///< of the frame
};

struct FilmRecipe {
  std::vector<std::vector<PngNote>> runs;         ///< texts of each run
  int columns = 1;                                ///< of parts in a picture
  std::vector<std::vector<RecipePart>> pictures;  ///< in the order of the film
  std::vector<std::string> pixels;  ///< digest of each, as it went to ffmpeg; none: not a film
};

/// Images of one size in rows from the top; places that are left are white.
Image grid(const std::vector<Image>& images, int columns);

/// 32 hexadecimal digits.
std::string digest_of_pixels(const Image& image);

/// As JSON.
std::string text_of(const FilmRecipe& recipe);
/// @throws InputError naming `path` if it is damaged
FilmRecipe recipe_of_text(const std::string& text, const std::string& path);

/// Packed, for a comment.
std::string comment_of(const FilmRecipe& recipe);
/// @throws InputError naming `path` if the content of a film or drawing holds no recipe, or a
/// damaged one
FilmRecipe recipe_in(const std::string& content, const std::string& path);

/// The pictures of a film, by the program ffmpeg. @throws IoError if it is not here or fails
class FilmReader {
 public:
  FilmReader(const std::string& path, int width, int height);
  FilmReader(const FilmReader&) = delete;
  FilmReader& operator=(const FilmReader&) = delete;
  ~FilmReader();

  /// The next picture's width x height x 3 bytes; none at the end.
  std::vector<std::uint8_t> next();

 private:
  std::size_t size_;
  FILE* pipe_;
};

}  // namespace breccia::app
