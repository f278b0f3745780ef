#include "io/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "exec/error.hpp"

namespace breccia {
namespace {

[[noreturn]] void fail_at(const std::string& path, const std::string& what) {
  throw IoError(fmt::format("{}: cannot {}: {}", path, what, std::strerror(errno)));
}

int flags_of(File::Use use) {
  switch (use) {
    case File::Use::read:
      return O_RDONLY | O_NONBLOCK;  // or a pipe without a writer would be waited for
    case File::Use::create:
      return O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW;
    case File::Use::append:
      return O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK;
    case File::Use::change:
      return O_WRONLY | O_NOFOLLOW | O_NONBLOCK;
  }
  return O_RDONLY;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

void sync_folder(const std::string& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) fail_at(folder, "open");
  const bool synced = ::fsync(file) == 0 || errno == EINVAL;  // some systems have no such call
  const int reason = errno;
  ::close(file);
  errno = reason;
  if (!synced) fail_at(folder, "sync");
}

std::uint64_t length_of(std::span<const Bytes> pieces) {
  std::uint64_t length = 0;
  for (const Bytes piece : pieces) length += piece.size();
  return length;
}

/// A disk that is written full harms everybody who uses it, so what cannot fit is not begun.
void refuse_without_room(const std::string& path, std::uint64_t bytes) {
  struct statvfs disk {};
  if (::statvfs(folder_of(path).c_str(), &disk) != 0 || disk.f_blocks == 0) return;  // not told
  const std::uint64_t blocks = ::geteuid() == 0 ? disk.f_bfree : disk.f_bavail;
  const std::uint64_t room = blocks * disk.f_frsize;
  if (room < bytes)
    throw IoError(fmt::format("{}: cannot write: it needs {} bytes, {} are free on its disk", path,
                              bytes, room));
}

void compare(const File& file, std::span<const Bytes> pieces, const std::string& path) {
  constexpr std::size_t chunk = std::size_t{1} << 20;
  std::vector<std::byte> read(chunk);
  std::uint64_t offset = 0;
  for (Bytes piece : pieces) {
    while (!piece.empty()) {
      const Bytes part = piece.first(std::min(chunk, piece.size()));
      const std::size_t count = file.read(std::span(read).first(part.size()), offset);
      if (count != part.size() || std::memcmp(read.data(), part.data(), count) != 0)
        throw IoError(path + ": cannot write: what was read back is not what was written");
      offset += count;
      piece = piece.subspan(count);
    }
  }
}

const char* kind_text(mode_t mode) {
  return S_ISLNK(mode)                    ? "a link"
         : S_ISDIR(mode)                  ? "a folder"
         : S_ISFIFO(mode)                 ? "a pipe"
         : S_ISCHR(mode) || S_ISBLK(mode) ? "a device"
                                          : "no regular file";
}

/// A rename would put a file in the place of a device, too, where the user may do that.
void refuse_what_is_no_file(const std::string& path) {
  struct stat about {};
  if (::lstat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode))
    throw IoError(fmt::format("{}: cannot write: it is {}", path, kind_text(about.st_mode)));
}

constexpr std::size_t random_digits = 16;
constexpr std::string_view temporary_end = ".tmp";

/// NAME.0123456789abcdef.tmp. Where others may write, a name that could be guessed could be a link
/// that waits there.
std::string temporary_name(const std::string& path) {
  std::uint64_t random = 0;
  if (::getrandom(&random, sizeof random, 0) != sizeof random) fail_at(path, "name a copy of it");
  return fmt::format("{}.{:0{}x}{}", path, random, random_digits, temporary_end);
}

bool is_temporary_name(std::string_view name) {
  if (!name.ends_with(temporary_end)) return false;
  name.remove_suffix(temporary_end.size());
  if (name.size() < random_digits + 2 || name[name.size() - random_digits - 1] != '.') return false;
  return name.substr(name.size() - random_digits).find_first_not_of("0123456789abcdef") ==
         std::string_view::npos;
}

/// Calls write(file) on a temporary file, which then takes the name `path` or is gone.
template <class Write>
void replace_by(const std::string& path, const Write& write) {
  refuse_what_is_no_file(path);
  const std::string temporary = temporary_name(path);
  File file(temporary, File::Use::create, path);
  try {
    write(file);
    file.close();
    if (std::rename(temporary.c_str(), path.c_str()) != 0)
      fail_at(path, "rename " + temporary + " to it");
  } catch (...) {
    std::remove(temporary.c_str());
    throw;
  }
}

}  // namespace

File::File(const std::string& path, Use use, const std::string& called)
    : path_(path), called_(called.empty() ? path : called) {
  file_ = ::open(path.c_str(), flags_of(use) | O_CLOEXEC, 0666);
  const char* const what = use == Use::read ? "read" : "write";
  if (file_ < 0 && errno == ELOOP && use != Use::read)
    throw IoError(fmt::format("{}: cannot write: it is a link", called_));
  if (file_ < 0) fail(what);
  struct stat about {};
  if (::fstat(file_, &about) == 0 && S_ISREG(about.st_mode)) return;
  ::close(file_);
  throw IoError(fmt::format("{}: cannot {}: it is not a regular file", called_, what));
}

File::~File() {
  if (file_ >= 0) ::close(file_);
}

void File::fail(const char* what) const {
  fail_at(called_, what);
}

std::uint64_t File::size() const {
  struct stat about {};
  if (::fstat(file_, &about) != 0) fail("read the size");
  return static_cast<std::uint64_t>(about.st_size);
}

std::size_t File::read(std::span<std::byte> to, std::uint64_t offset) const {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t count =
        ::pread(file_, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("read");
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

void File::write(Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("write");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void File::sync() {
  // Pipes and the like cannot be synced and need not be.
  if (::fsync(file_) != 0 && errno != EINVAL && errno != EROFS) fail("sync");
}

void File::cut(std::uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0) fail("cut");
}

bool File::in_place() const {
  struct stat named {
  }, open{};
  return ::stat(path_.c_str(), &named) == 0 && ::fstat(file_, &open) == 0 &&
         named.st_ino == open.st_ino && named.st_dev == open.st_dev;
}

void File::close() {
  const int file = file_;
  file_ = -1;
  if (::close(file) != 0 && errno != EINTR) fail("close");
}

void replace_file(const std::string& path, std::span<const Bytes> pieces) {
  replace_by(path, [&](File& file) {
    for (const Bytes piece : pieces) file.write(piece);
  });
}

void replace_durably(const std::string& path, std::span<const Bytes> pieces) {
  refuse_without_room(path, length_of(pieces));
  replace_by(path, [&](File& file) {
    for (const Bytes piece : pieces) file.write(piece);
    file.sync();
    compare(file, pieces, path);
  });
  sync_folder(folder_of(path));
}

void overwrite(const std::string& path, Bytes bytes) {
  File file(path, File::Use::change);
  struct stat about {};
  constexpr std::uint64_t block = 512;  // of st_blocks, whatever the disk's are  [bytes]
  if (::stat(path.c_str(), &about) != 0) fail_at(path, "write");
  if (static_cast<std::uint64_t>(about.st_blocks) * block < bytes.size())
    throw IoError(path + ": cannot write: it has no room on its disk");
  file.write(bytes);
  file.cut(bytes.size());
  file.sync();
}

void remove_leftovers(const std::string& folder) {
  std::error_code ignored;  // one that stays does no harm
  for (const std::filesystem::directory_entry& entry :
       std::filesystem::directory_iterator(folder, ignored))
    if (is_temporary_name(entry.path().filename().string()))
      std::filesystem::remove(entry.path(), ignored);
}

}  // namespace breccia
