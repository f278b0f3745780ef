#pragma once
// Places that only the build knows. One file holds them, so that all others compile alike in every
// folder.

namespace breccia {

extern const char* const source_dir;      ///< of the project
extern const char* const program;         ///< breccia, as built
extern const char* const hundred_lines;   ///< docs/dem_in_100_lines.cpp, as built
extern const char* const mpirun_program;  ///< empty without MPI
extern const char* const no_memory;       ///< the library of no_memory.cpp

}  // namespace breccia
