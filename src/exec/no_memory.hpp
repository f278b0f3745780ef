#pragma once
// Memory that is missing where no exception can tell of it.

namespace breccia {

/// Sets the handlers by which a program ends with exit code 5 and one line where std::bad_alloc
/// meets a destructor or a noexcept function, or where a NeedsMemory stands. For main: a library
/// leaves its host's handlers alone.
void end_without_memory();

/// While one stands in a thread, an allocation of that thread that fails ends the program, if
/// end_without_memory() was called. For libraries that do not survive std::bad_alloc: nlohmann-json
/// 3.11.2 destroys objects that it could not make.
class NeedsMemory {
 public:
  NeedsMemory();
  NeedsMemory(const NeedsMemory&) = delete;
  NeedsMemory& operator=(const NeedsMemory&) = delete;
  ~NeedsMemory();
};

}  // namespace breccia
