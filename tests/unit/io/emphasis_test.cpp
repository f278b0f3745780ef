#include "io/emphasis.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <cstdlib>

namespace breccia {
namespace emphasis_test {

/// A terminal of one's own.
class Terminal {
 public:
  Terminal() {
    if (::openpty(&control_, &line_, nullptr, nullptr, nullptr) == 0)
      stream_ = ::fdopen(line_, "w");
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (control_ >= 0) ::close(control_);
  }
  std::FILE* stream() const { return stream_; }

 private:
  int control_ = -1, line_ = -1;
  std::FILE* stream_ = nullptr;
};

TEST(Emphasis, colors_are_for_terminals_and_no_color_switches_them_off) {
  const Terminal terminal;
  ASSERT_NE(terminal.stream(), nullptr);
  ::setenv("TERM", "xterm", 1);
  ::unsetenv("NO_COLOR");
  EXPECT_EQ(emphasized(Emphasis::error, "error:", terminal.stream()), "\033[1;31merror:\033[0m");
  std::FILE* const file = std::tmpfile();
  EXPECT_EQ(emphasized(Emphasis::error, "error:", file), "error:");
  std::fclose(file);
  ::setenv("NO_COLOR", "1", 1);
  EXPECT_EQ(emphasized(Emphasis::error, "error:", terminal.stream()), "error:");
  ::unsetenv("NO_COLOR");
  ::setenv("TERM", "dumb", 1);
  EXPECT_EQ(emphasized(Emphasis::good, "pass", terminal.stream()), "pass");
}

}  // namespace emphasis_test
}  // namespace breccia
