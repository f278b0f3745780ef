#pragma once
// Requests of a device to the host in the middle of a step.

#include <cstdint>

namespace breccia::fdem_shared {

/// Values of StepClock::host_request. Insertion and room come when the search is done: the host
/// takes the rest of the step.
enum Wanted : std::int32_t {
  request_marks = 1,   ///< vertices must be marked anew
  request_search = 2,  ///< a margin is used up, too or alone
  request_insertion = 3,
  request_room = 4  ///< joints that fail wait for room for their records
};

}  // namespace breccia::fdem_shared
