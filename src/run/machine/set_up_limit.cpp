#include "run/machine/set_up_limit.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"
#include "io/emphasis.hpp"
#include "io/fold.hpp"
#include "io/harmless.hpp"

namespace breccia {
namespace {

std::array<char, 600> sentence;  ///< what the handler writes: it may make no text
std::size_t letters = 0;
int exit_code = 0;
struct sigaction former;

extern "C" void end_of_limit(int) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, sentence.data(), letters);
  ::_exit(exit_code);
}

void set_timer(double seconds) {
  const double whole = std::floor(seconds);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

SetUpLimit::SetUpLimit(std::optional<double> seconds, const std::string& given) {
  constexpr double least = 1e-3, most = 1e9;  // [s]
  if (!seconds || !(*seconds < most)) return;
  const std::string text = fitting(
      fmt::format("{} --max-wall {}: the model was not yet built; nothing was run. breccia check "
                  "tells how long that takes, breccia prepare keeps what it built\n",
                  emphasized(Emphasis::error, "error:", stderr), harmless(given)),
      2, stderr);
  letters = std::min(text.size(), sentence.size());
  std::copy_n(text.begin(), letters, sentence.begin());
  exit_code = InputError("").exit_code();
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_handler = end_of_limit;
  ::sigaction(SIGALRM, &action, &former);
  set_timer(std::max(*seconds, least));
  limits_ = true;
}

SetUpLimit::~SetUpLimit() {
  if (!limits_) return;
  set_timer(0.0);
  ::sigaction(SIGALRM, &former, nullptr);
}

}  // namespace breccia
