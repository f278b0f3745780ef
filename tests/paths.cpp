#include "paths.hpp"

namespace breccia {

const char* const source_dir = BR_SOURCE_DIR;
const char* const program = BR_PROGRAM;
const char* const hundred_lines = BR_HUNDRED_LINES;
const char* const mpirun_program = BR_MPIRUN;
const char* const no_memory = BR_NO_MEMORY;

}  // namespace breccia
