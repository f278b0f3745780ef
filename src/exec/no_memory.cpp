#include "exec/no_memory.hpp"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

namespace breccia {
namespace {

constinit thread_local int scopes_that_need_memory = 0;
constinit thread_local bool an_allocation_failed = false;
std::terminate_handler other_terminate = nullptr;  ///< tells of the other errors

/// Takes no memory. mpirun then ends the other ranks.
[[noreturn]] void end_at_once() {
  constexpr std::string_view message = "error: not enough memory\n";
  constexpr int memory_error = 5;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
  std::_Exit(memory_error);
}

/// The new handler: as without it, but in a scope that needs memory.
void tell_of_no_memory() {
  if (scopes_that_need_memory > 0) end_at_once();
  an_allocation_failed = true;
  throw std::bad_alloc();
}

[[noreturn]] void terminate() {
  const std::exception_ptr error = std::current_exception();
  // g++ 12 calls the handler with an exception that nobody has caught in noexcept functions that it
  // inlined, as in std::filesystem: its type cannot be asked for.
  if (!error && an_allocation_failed && std::uncaught_exceptions() > 0) end_at_once();
  try {
    if (error) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    end_at_once();
  } catch (...) {
    other_terminate();
  }
  std::abort();
}

}  // namespace

void end_without_memory() {
  if (std::get_terminate() == terminate) return;
  other_terminate = std::set_terminate(terminate);
  std::set_new_handler(tell_of_no_memory);
}

NeedsMemory::NeedsMemory() {
  ++scopes_that_need_memory;
}
NeedsMemory::~NeedsMemory() {
  --scopes_that_need_memory;
}

}  // namespace breccia
