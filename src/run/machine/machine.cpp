#include "run/machine/machine.hpp"

#include <sys/resource.h>

#include <fstream>

#include "domain/mpi_ranks.hpp"

namespace breccia {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

std::int64_t peak_memory() {
  struct rusage usage {};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

const Build& this_build() {
#if defined(__clang__)
  static const char* const compiler = "clang " __clang_version__;
#else
  static const char* const compiler = "g++ " __VERSION__;
#endif
#if defined(BR_CUDA)
  constexpr bool cuda = true;
#else
  constexpr bool cuda = false;
#endif
  static const Build build{BR_VERSION, BR_COMMIT, BR_BUILD_TYPE, compiler, cuda, built_with_mpi()};
  return build;
}

}  // namespace breccia
