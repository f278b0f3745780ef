#pragma once
// Films: pictures on their way to the program ffmpeg, which is called, not linked.

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

#include "io/picture/picture.hpp"

namespace breccia::app {

/// Whether a file of this name is a film: .mp4, .webm or .gif.
bool is_film(const std::string& path);

/// Raw pixels (RGB, 3 bytes) of a film's pictures, cut to this size, from ffmpeg; for pclose.
/// @throws IoError if there is no ffmpeg here
FILE* decoded(const std::string& path, int width, int height);

/// A film that is being written, under a temporary name until it is whole.
class Film {
 public:
  /// @param rate  pictures a second
  /// @param note  kept in the film's metadata
  /// @throws IoError if there is no ffmpeg here
  Film(const std::string& path, int rate, std::string note);
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;
  ~Film();

  /// All pictures are of the first one's size. @throws IoError if ffmpeg does not take it
  void add(const Image& image);
  /// @param more  added to the note, known when the film is over
  /// @throws IoError if ffmpeg failed
  void close(const std::string& more = "");

 private:
  void start(const Image& first);
  /// The film under its temporary name again, with another comment.
  void put_comment();
  /// Runs ffmpeg to its end. Whether it did well.
  static bool ran(std::vector<std::string> words);
  [[noreturn]] void fail();

  std::string path_, temporary_, note_;
  int rate_;
  int width_ = 0, height_ = 0;
  pid_t child_ = -1;
  int pipe_ = -1;
};

}  // namespace breccia::app
