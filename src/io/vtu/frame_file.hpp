#pragma once
// Content of a frame's file, whatever its format.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "io/frame.hpp"

namespace breccia {

class FrameFile {
 public:
  explicit FrameFile(std::string path) : path_(std::move(path)) {}
  FrameFile(const FrameFile&) = delete;
  FrameFile& operator=(const FrameFile&) = delete;
  virtual ~FrameFile() = default;

  virtual std::size_t points() const = 0;
  virtual std::size_t cells() const = 0;
  /// An array of so many items of a section of a .vtu. @throws IoError if there is none
  virtual std::vector<double> numbers(const std::string& section, const std::string& name,
                                      std::size_t items) const = 0;
  virtual std::vector<std::int32_t> integers(const std::string& section, const std::string& name,
                                             std::size_t items) const = 0;
  virtual std::vector<FrameField> fields(const std::string& section, std::size_t items) const = 0;
  virtual std::vector<std::string> groups() const = 0;
  /// "walls": point and normal of each plane; "wall_triangles": corners, three a triangle.
  virtual std::vector<double> walls(const std::string& name) const = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(path_ + ": cannot read: " + what);
  }

 private:
  std::string path_;
};

/// Names, each ended by 0.
inline std::vector<std::string> names_in(const std::string& codes) {
  std::vector<std::string> names;
  for (std::size_t begin = 0, end = 0; (end = codes.find('\0', begin)) != std::string::npos;
       begin = end + 1)
    names.push_back(codes.substr(begin, end - begin));
  return names;
}

}  // namespace breccia
