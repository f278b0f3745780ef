#pragma once
// Where a run computes, from the words of people.

#include <string>

#include "domain/communicator.hpp"
#include "exec/space.hpp"

namespace breccia {

/// @param device   cpu, cuda or cuda:N; behind the latter two +tiles or +launches
///                 (dem/tiles/tile_run.hpp)
/// @param threads  of the host; 0: this rank's share of the machine
/// @param ranks    those that share the work; null: none
/// @throws InputError for a device that is none, DeviceError if this build or machine has it not
Exec exec_on(const std::string& device, int threads, Communicator* ranks);

}  // namespace breccia
