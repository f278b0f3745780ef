#include "exec/no_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#include "run/results/summary.hpp"

namespace breccia {
namespace no_memory_test {

/// Memory that no machine has.
void take_all() {
  ::operator delete(::operator new(std::numeric_limits<std::ptrdiff_t>::max()));
}
void take_all_and_throw_nothing() noexcept {
  take_all();
}
/// Leaves no memory but that of small blocks, and then none at all.
void take_what_there_is() {
  const rlimit none{0, 0};
  if (::setrlimit(RLIMIT_AS, &none) != 0) std::abort();
  for (std::size_t size = 1 << 20; size > 0; size /= 2)
    while (std::malloc(size) != nullptr) {
    }
}

/// Sanitizers end the program where `new` finds no memory, whatever handles it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_UNDER_SANITIZERS() GTEST_SKIP() << "new does not throw here"
#else
#define SKIP_UNDER_SANITIZERS()
#endif

TEST(no_memory, is_told_by_exception_where_nothing_else_is_asked_for) {
  SKIP_UNDER_SANITIZERS();
  EXPECT_EXIT(
      {
        end_without_memory();
        try {
          take_all();
        } catch (const std::bad_alloc&) {
          std::_Exit(33);
        }
      },
      testing::ExitedWithCode(33), "");
}

TEST(no_memory, ends_the_program_in_a_scope_that_needs_it) {
  SKIP_UNDER_SANITIZERS();
  EXPECT_EXIT(
      {
        end_without_memory();
        const NeedsMemory scope;
        take_all();
      },
      testing::ExitedWithCode(5), "error: not enough memory");
}

TEST(no_memory, ends_the_program_in_functions_that_throw_nothing) {
  SKIP_UNDER_SANITIZERS();
  EXPECT_EXIT(
      {
        end_without_memory();
        take_all_and_throw_nothing();
      },
      testing::ExitedWithCode(5), "error: not enough memory");
}

TEST(no_memory, of_a_summary_ends_the_program) {
  SKIP_UNDER_SANITIZERS();
  const Summary summary;
  EXPECT_EXIT(
      {
        end_without_memory();
        take_what_there_is();
        to_json(summary);
      },
      testing::ExitedWithCode(5), "error: not enough memory");
}

}  // namespace no_memory_test
}  // namespace breccia
