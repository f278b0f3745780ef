// Loaded before a program's own libraries (LD_PRELOAD), it lets one call fail, or writes down the
// order in which files change.
//
//   FAULT_CALL=K    the K-th call (from 1) of open, read, write, fsync, rename, ftruncate, statvfs,
//                   unlink or mkdir on something below FAULT_BELOW fails with FAULT_ERRNO
//   FAULT_ALLOC=K   the K-th call of operator new or aligned_alloc finds no memory
//                   (counted from the first signal handler on, which main sets first of all)
//   FAULT_STAYS=1   and every one after it, too
//   FAULT_COUNT=F   writes the numbers of calls and allocations to the file F at the end
//   FAULT_RECORD=F  writes each change below FAULT_BELOW to F: what a power cut may leave of it

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <new>

namespace {

std::atomic<long> calls{0}, allocations{0};
std::atomic<bool> in_main{false};  ///< before, an exception could reach nobody

long number(const char* name) {
  const char* const text = ::getenv(name);
  return text == nullptr ? 0 : ::atol(text);
}
struct Wanted {
  long call = number("FAULT_CALL"), alloc = number("FAULT_ALLOC"), stays = number("FAULT_STAYS");
  int error = number("FAULT_ERRNO") > 0 ? static_cast<int>(number("FAULT_ERRNO")) : EIO;
};
const Wanted& wanted() {
  static const Wanted w;
  return w;
}
bool hits(long count, long at) {
  return at > 0 && (count == at || (wanted().stays && count > at));
}

template <class Call>
Call real(const char* name) {
  return reinterpret_cast<Call>(::dlsym(RTLD_NEXT, name));
}

bool below(const char* path) {
  const char* const folder = ::getenv("FAULT_BELOW");
  return folder != nullptr && path != nullptr && ::strncmp(path, folder, ::strlen(folder)) == 0;
}
/// The path of an open file; empty if it has none.
bool path_of(int file, char (&path)[PATH_MAX]) {
  char link[64];
  ::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = ::readlink(link, path, sizeof path - 1);
  path[length < 0 ? 0 : length] = 0;
  return length > 0;
}

/// Whether this call is the one that fails.
bool fails(const char* path) {
  if (!below(path) || !hits(++calls, wanted().call)) return false;
  errno = wanted().error;
  return true;
}
bool fails(int file) {
  char path[PATH_MAX];
  return path_of(file, path) && fails(path);
}

std::mutex recording;
/// One line "what path other", then `size` bytes.
void record(const char* what, const char* path, const char* other, const void* bytes, size_t size,
            long offset) {
  static const auto real_open = real<int (*)(const char*, int, ...)>("open");
  static const auto real_write = real<ssize_t (*)(int, const void*, size_t)>("write");
  static const char* const to = ::getenv("FAULT_RECORD");
  if (to == nullptr || !below(path)) return;
  const std::lock_guard lock(recording);
  static const int log = real_open(to, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  char line[2 * PATH_MAX + 100];
  const int length =
      ::snprintf(line, sizeof line, "%s\t%s\t%s\t%zu\t%ld\n", what, path, other, size, offset);
  real_write(log, line, static_cast<size_t>(length));
  if (size > 0) real_write(log, bytes, size);
}

struct AtEnd {
  ~AtEnd() {
    const char* const path = ::getenv("FAULT_COUNT");
    if (path == nullptr) return;
    if (FILE* const file = ::fopen(path, "w")) {
      ::fprintf(file, "%ld %ld\n", calls.load(), allocations.load());
      ::fclose(file);
    }
  }
} at_end;

int open_as(const char* name, const char* path, int flags, mode_t mode) {
  if (fails(path)) return -1;
  const auto call = real<int (*)(const char*, int, ...)>(name);
  struct stat about {};
  const bool fresh = (flags & O_CREAT) != 0 && ::lstat(path, &about) != 0;
  const int file = call(path, flags, mode);
  if (file >= 0 && fresh) record("create", path, "", nullptr, 0, 0);
  if (file >= 0 && (flags & O_TRUNC) != 0 && !fresh) record("cut", path, "", nullptr, 0, 0);
  return file;
}

void* allocate(size_t size) {
  return (in_main && hits(++allocations, wanted().alloc)) ? nullptr
                                                          : ::malloc(size == 0 ? 1 : size);
}
void* allocate_aligned(size_t alignment, size_t size) {
  static const auto call = real<void* (*)(size_t, size_t)>("aligned_alloc");
  return (in_main && hits(++allocations, wanted().alloc)) ? nullptr : call(alignment, size);
}
/// As the standard's operator new: a handler ends the program, throws, or has found memory.
void* or_throw(size_t size) {
  for (;;) {
    if (void* const memory = allocate(size)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void* or_null(size_t size) noexcept {
  try {
    return or_throw(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

}  // namespace

#pragma GCC visibility push(default)

void* operator new(size_t size) {
  return or_throw(size);
}
void* operator new[](size_t size) {
  return or_throw(size);
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return or_null(size);
}
void* operator new[](size_t size, const std::nothrow_t&) noexcept {
  return or_null(size);
}
void operator delete(void* memory) noexcept {
  ::free(memory);
}
void operator delete[](void* memory) noexcept {
  ::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  ::free(memory);
}
void operator delete[](void* memory, size_t) noexcept {
  ::free(memory);
}

extern "C" {

void* aligned_alloc(size_t alignment, size_t size) {
  void* const memory = allocate_aligned(alignment, size);
  if (memory == nullptr) errno = ENOMEM;
  return memory;
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open_as("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open_as("open64", path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t)>("write");
  if (fails(file)) return -1;
  char path[PATH_MAX];
  const bool known = ::getenv("FAULT_RECORD") != nullptr && path_of(file, path);
  const int flags = known ? ::fcntl(file, F_GETFL) : 0;
  const ssize_t done = call(file, bytes, size);
  if (known && done > 0) {
    const long end = ::lseek(file, 0, SEEK_CUR);
    record("write", path, "", bytes, static_cast<size_t>(done),
           (flags & O_APPEND) != 0 ? -1 : end - done);
  }
  return done;
}
ssize_t read(int file, void* bytes, size_t size) {
  static const auto call = real<ssize_t (*)(int, void*, size_t)>("read");
  return fails(file) ? -1 : call(file, bytes, size);
}
ssize_t pread64(int file, void* bytes, size_t size, off64_t offset) {
  static const auto call = real<ssize_t (*)(int, void*, size_t, off64_t)>("pread64");
  return fails(file) ? -1 : call(file, bytes, size, offset);
}
ssize_t pread(int file, void* bytes, size_t size, off_t offset) {
  static const auto call = real<ssize_t (*)(int, void*, size_t, off_t)>("pread");
  return fails(file) ? -1 : call(file, bytes, size, offset);
}
int sigaction(int number, const struct sigaction* action, struct sigaction* old) {
  static const auto call =
      real<int (*)(int, const struct sigaction*, struct sigaction*)>("sigaction");
  in_main = true;
  return call(number, action, old);
}
sighandler_t signal(int number, sighandler_t handler) {
  static const auto call = real<sighandler_t (*)(int, sighandler_t)>("signal");
  in_main = true;
  return call(number, handler);
}
int fsync(int file) {
  static const auto call = real<int (*)(int)>("fsync");
  if (fails(file)) return -1;
  char path[PATH_MAX];
  if (path_of(file, path)) record("sync", path, "", nullptr, 0, 0);
  return call(file);
}
int ftruncate(int file, off_t size) {
  static const auto call = real<int (*)(int, off_t)>("ftruncate");
  if (fails(file)) return -1;
  char path[PATH_MAX];
  if (path_of(file, path)) record("cut", path, "", nullptr, 0, size);
  return call(file, size);
}
int rename(const char* from, const char* to) {
  static const auto call = real<int (*)(const char*, const char*)>("rename");
  if (fails(to)) return -1;
  const int result = call(from, to);
  if (result == 0) record("rename", from, to, nullptr, 0, 0);
  return result;
}
int unlink(const char* path) {
  static const auto call = real<int (*)(const char*)>("unlink");
  if (fails(path)) return -1;
  const int result = call(path);
  if (result == 0) record("unlink", path, "", nullptr, 0, 0);
  return result;
}
int remove(const char* path) {
  static const auto call = real<int (*)(const char*)>("remove");
  if (fails(path)) return -1;
  const int result = call(path);
  if (result == 0) record("unlink", path, "", nullptr, 0, 0);
  return result;
}
int mkdir(const char* path, mode_t mode) {
  static const auto call = real<int (*)(const char*, mode_t)>("mkdir");
  return fails(path) ? -1 : call(path, mode);
}
int statvfs(const char* path, struct statvfs* about) {
  static const auto call = real<int (*)(const char*, struct statvfs*)>("statvfs");
  return fails(path) ? -1 : call(path, about);
}

}  // extern "C"

#pragma GCC visibility pop
