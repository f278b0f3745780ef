#pragma once
// Ranks as processes that mpirun has started. The only part of the program that knows MPI.

#include <memory>

#include "domain/communicator.hpp"

namespace breccia {

/// Whether this build has MPI.
bool built_with_mpi();

/// The ranks that this process was started as one of; null when it was started alone, or when this
/// build has no MPI. Call once. The end of the object ends the use of MPI.
std::unique_ptr<Communicator> launched_ranks();

/// How many of the ranks share this machine with the calling one; 1 when alone.
int ranks_on_this_machine(Communicator* ranks);
/// This rank's number among them, from 0.
int number_on_this_machine(Communicator* ranks);

}  // namespace breccia
