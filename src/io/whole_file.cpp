#include "io/whole_file.hpp"

#include <fmt/format.h>

#include "exec/error.hpp"
#include "io/file.hpp"

namespace breccia {

void replace_file(const std::string& path, std::string_view content) {
  const Bytes bytes = bytes_of(content);
  replace_file(path, {&bytes, 1});
}

void replace_durably(const std::string& path, std::string_view content) {
  const Bytes bytes = bytes_of(content);
  replace_durably(path, {&bytes, 1});
}

std::string read_whole_file(const std::string& path, std::uint64_t limit) {
  const File file(path, File::Use::read);
  std::string content;
  // Some files tell no size, and some grow while they are read: the end is where reading ends.
  for (std::uint64_t want = file.size() + 1;; want = std::uint64_t{1} << 16) {
    const std::size_t have = content.size();
    if (have > limit || want > limit + 1)
      throw IoError(fmt::format("{}: cannot read: it is longer than {} bytes", path, limit));
    content.resize(have + static_cast<std::size_t>(want));
    const std::size_t count =
        file.read(std::as_writable_bytes(std::span(content).subspan(have)), have);
    content.resize(have + count);
    if (count < want) return content;
  }
}

}  // namespace breccia
