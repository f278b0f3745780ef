#pragma once
// The end of a process whose model takes longer to build than it may run.

#include <optional>
#include <string>

namespace breccia {

/// While it lives, the process ends with exit code 2 and a sentence once the wall-clock time of
/// --max-wall has passed: before the first step there is no state to save, and a job that is sent
/// again would come no farther.
class SetUpLimit {
 public:
  /// @param seconds  from now; none: no limit  [s]  @param given  that as it was written
  SetUpLimit(std::optional<double> seconds, const std::string& given);
  SetUpLimit(const SetUpLimit&) = delete;
  SetUpLimit& operator=(const SetUpLimit&) = delete;
  ~SetUpLimit();

 private:
  bool limits_ = false;
};

}  // namespace breccia
