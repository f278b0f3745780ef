#include "io/whole_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "exec/error.hpp"

namespace breccia {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int reason) {
  throw IoError(path + ": cannot " + what + ": " + std::strerror(reason));
}

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

void replace_file(const std::string& path, std::string_view content) {
  const std::string temporary = path + ".part";
  File file(std::fopen(temporary.c_str(), "wb"));
  if (!file) fail(path, "write", errno);
  const bool written = std::fwrite(content.data(), 1, content.size(), file.get()) == content.size();
  const int write_error = errno;
  const bool closed = std::fclose(file.release()) == 0;
  if (!written || !closed) {
    const int reason = written ? errno : write_error;
    std::remove(temporary.c_str());
    fail(path, "write", reason);
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    std::remove(temporary.c_str());
    fail(path, "rename to", reason);
  }
}

std::string read_whole_file(const std::string& path) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "read", errno);
  std::string content;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) {
    content.append(buffer, count);
  }
  if (std::ferror(file.get()) != 0) fail(path, "read", errno);
  return content;
}

}  // namespace breccia
