#pragma once
// The kinds of error, each with the exit code that scripts rely on.

#include <stdexcept>
#include <string>
#include <vector>

namespace breccia {

/// The base of every error Breccia reports; what() is the whole message for the user.
class Error : public std::runtime_error {
 public:
  Error(int exit_code, const std::string& message)
      : std::runtime_error(message), exit_code_(exit_code) {}
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// Bad input or usage; nothing was run, nothing written.
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(2, message) {}
};
/// A file or folder could not be read or written; names the path and the reason.
struct IoError : Error {
  explicit IoError(const std::string& message) : Error(3, message) {}
};
/// The numbers went wrong during a run; names step, time and element.
struct NumericsError : Error {
  explicit NumericsError(const std::string& message) : Error(4, message) {}
};
/// Too little memory, or no usable device.
struct DeviceError : Error {
  explicit DeviceError(const std::string& message) : Error(5, message) {}
};
/// A checkpoint that is damaged, of another version or of another case.
struct CheckpointError : Error {
  explicit CheckpointError(const std::string& message) : Error(7, message) {}
};
/// A check that the case states does not hold.
struct CheckFailed : Error {
  explicit CheckFailed(const std::string& message) : Error(9, message) {}
};

}  // namespace breccia
