#pragma once
// How a film can be made again: the texts of all its pictures and digests of their pixels, kept in
// the film's comment.

#include <string>
#include <vector>

#include "io/picture/picture.hpp"
#include "io/picture/png_notes.hpp"

namespace breccia::app {

struct FilmRecipe {
  std::vector<PngNote> run;                    ///< of all pictures
  std::vector<std::vector<PngNote>> pictures;  ///< of each, in the order of the film
  std::vector<std::string> pixels;             ///< digest of each, as it went to ffmpeg

  void add(std::vector<PngNote> notes, const Image& image);
};

/// 32 hexadecimal digits.
std::string digest_of_pixels(const Image& image);

/// As text for a comment; empty if it would be too long for one.
std::string comment_of(const FilmRecipe& recipe);
/// @throws InputError naming `path` if the film's content holds no recipe, or a damaged one
FilmRecipe film_recipe_in(const std::string& content, const std::string& path);

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
