#include "run/machine/signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>

namespace breccia {
namespace {

constexpr std::array handled{SIGTERM, SIGINT, SIGUSR1};

volatile sig_atomic_t first_signal = 0, between_steps = 0;
std::array<struct sigaction, handled.size()> former_handled;
struct sigaction former_pipe;

extern "C" void note_signal(int signal) {
  if (first_signal != 0 || between_steps == 0) ::_exit(128 + signal);
  first_signal = signal;
}

}  // namespace

void ignore_quota_signal() {
  ::signal(SIGXFSZ, SIG_IGN);
}

StopSignals::StopSignals() {
  first_signal = 0;
  between_steps = 0;
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  action.sa_handler = note_signal;
  for (std::size_t i = 0; i < handled.size(); ++i)
    ::sigaction(handled[i], &action, &former_handled[i]);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, &former_pipe);
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < handled.size(); ++i)
    ::sigaction(handled[i], &former_handled[i], nullptr);
  ::sigaction(SIGPIPE, &former_pipe, nullptr);
}

void StopSignals::answer_between_steps() {
  between_steps = 1;
}

int StopSignals::received() {
  return first_signal;
}

const char* signal_name(int signal) {
  switch (signal) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGUSR1:
      return "SIGUSR1";
    default:
      return "a signal";
  }
}

}  // namespace breccia
