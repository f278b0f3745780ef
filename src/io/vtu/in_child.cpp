#include "io/vtu/in_child.hpp"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

#include <array>
#include <string_view>

namespace breccia {
namespace {

[[noreturn]] void answer(int to, const std::function<std::string()>& work) {
#ifdef __SANITIZE_ADDRESS__
  __sanitizer_set_report_path("/dev/null");  // what is found here is the library's
#endif
  const rlimit none{0, 0}, minute{60, 60};
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_CPU, &minute);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE})
    ::signal(number, SIG_DFL);
  try {
    const std::string whole = work() + '.';  // by which the other side knows that it is whole
    for (std::string_view left = whole; !left.empty();) {
      const ssize_t sent = ::write(to, left.data(), left.size());
      if (sent < 0 && errno != EINTR) break;
      if (sent > 0) left.remove_prefix(static_cast<std::size_t>(sent));
    }
  } catch (...) {
  }
  ::_exit(0);
}

std::string all_from(int from) {
  std::string bytes;
  std::array<char, 1 << 16> some;
  for (ssize_t got = 0; (got = ::read(from, some.data(), some.size())) != 0;) {
    if (got < 0 && errno != EINTR) break;
    if (got > 0) bytes.append(some.data(), static_cast<std::size_t>(got));
  }
  return bytes;
}

}  // namespace

std::optional<std::string> answer_of_child(const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return work();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    answer(ends[1], work);
  }
  ::close(ends[1]);
  std::string bytes = child > 0 ? all_from(ends[0]) : "";
  ::close(ends[0]);
  if (child < 0) return work();
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (bytes.empty() || bytes.back() != '.') return std::nullopt;
  bytes.pop_back();
  return bytes;
}

}  // namespace breccia
