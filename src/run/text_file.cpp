#include "run/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int reason) {
  throw IoError(fmt::format("{}: {}: {}", path, what, std::strerror(reason)));
}

/// The errno of the failure, 0 if all bytes were written.
int write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void sync_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

}  // namespace

void replace_durably(const std::string& path, std::string_view text) {
  const std::string temporary = path + ".tmp";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(path, "cannot be written", errno);
  int reason = write_all(file, text);
  if (reason == 0 && ::fsync(file) != 0) reason = errno;
  if (::close(file) != 0 && reason == 0) reason = errno;
  if (reason == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
  if (reason != 0) {
    ::unlink(temporary.c_str());
    fail(path, "cannot be written", reason);
  }
  sync_folder_of(path);
}

LineFile::LineFile(const std::string& path) : path_(path) {
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path_, "cannot be written", errno);
  struct stat status {};
  if (::fstat(file_, &status) == 0) size_ = status.st_size;
}

LineFile::~LineFile() {
  ::close(file_);
}

void LineFile::append(std::string_view line) {
  std::string whole(line);
  whole += '\n';
  const int reason = write_all(file_, whole);
  if (reason != 0) {
    if (::ftruncate(file_, size_) != 0) fail(path_, "cannot be cut to its last whole line", errno);
    fail(path_, "cannot be written", reason);
  }
  size_ += static_cast<std::int64_t>(whole.size());
}

void LineFile::sync() {
  // Pipes and the like cannot be synced and need not be.
  if (::fsync(file_) != 0 && errno != EINVAL && errno != EROFS)
    fail(path_, "cannot be synced", errno);
}

void keep_lines(const std::string& path, const std::function<bool(std::string_view)>& keep) {
  if (!std::filesystem::exists(path)) return;
  const std::string text = read_whole_file(path);
  std::string kept;
  std::string_view rest = text;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    if (keep(rest.substr(0, end))) kept += rest.substr(0, end + 1);
    rest.remove_prefix(end + 1);
  }
  if (kept != text) replace_durably(path, kept);
}

}  // namespace breccia
