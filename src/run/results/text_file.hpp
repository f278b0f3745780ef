#pragma once
// Text on disk that grows by lines, and that a kill or a full disk leaves whole.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "io/file.hpp"

namespace breccia {

/// A text file that grows line by line and never keeps a part of a line.
class LineFile {
 public:
  /// Opens the file at `path` to append; makes it if there is none. @throws IoError
  explicit LineFile(const std::string& path);

  /// Adds the line and a line end, at once.
  /// @throws IoError naming path and reason; the file then ends after its last whole line
  void append(std::string_view line);
  /// Waits until the disk has everything. @throws IoError, also if somebody has moved or removed it
  void sync();

 private:
  std::string path_;
  File file_;
  std::uint64_t size_;  ///< up to the end of the last whole line  [bytes]
};

/// Keeps only the whole lines for which keep(line) is true; a last line without its end is dropped.
/// A file that does not exist stays so. @throws IoError
void keep_lines(const std::string& path, const std::function<bool(std::string_view)>& keep);

}  // namespace breccia
