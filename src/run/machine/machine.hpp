#pragma once
// Where and with what a run is made: the processor, the memory, the build of the program.

#include <cstdint>
#include <string>

namespace breccia {

/// The part of summary.json about the machine.
struct Machine {
  std::string cpu;  ///< model of the processor
  std::string device = "cpu";
  int threads = 1;
  int ranks = 1;
};

/// The part of summary.json about the program.
struct Build {
  std::string version, commit, type, compiler;
  bool cuda = false, mpi = false;
};

std::string processor_name();
/// The most memory this process ever held.  [bytes]
std::int64_t peak_memory();
/// How this program was built.
const Build& this_build();

}  // namespace breccia
