#pragma once
// Signals that end a run: noted by a flag, answered at the next step boundary.

namespace breccia {

/// From now on a file that would grow past the quota (`ulimit -f`) is an error of the write call,
/// not the end of the process.
void ignore_quota_signal();

/// While it lives, SIGTERM, SIGINT and SIGUSR1 end the process at once with 128 + their number.
/// Once answer_between_steps() has been called they only set a flag, and a second one ends it at
/// once. SIGPIPE is ignored, so that a closed terminal becomes an error of the write call. The
/// former handlers return with its end.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  /// From now on there is a state to save.
  void answer_between_steps();

  /// The number of the first signal that came, 0 if none did.
  static int received();
};

/// "SIGTERM", ... of a signal number.
const char* signal_name(int signal);

}  // namespace breccia
