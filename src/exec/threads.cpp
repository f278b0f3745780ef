#include "exec/threads.hpp"

#include <unistd.h>

#include <cstdlib>

namespace breccia {

void let_waiting_threads_sleep(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  ::setenv("GOMP_SPINCOUNT", "2000", 0);
  ::execv("/proc/self/exe",
          argv);  // returns only if it fails: then threads spin as they always did
}

}  // namespace breccia
