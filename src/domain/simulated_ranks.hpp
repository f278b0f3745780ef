#pragma once
// Ranks as threads of one process, for tests: any number of them, messages in shuffled order.

#include <functional>

#include "domain/communicator.hpp"

namespace breccia {

/// Runs `rank_main` on `count` ranks at once, each on a thread of its own. Messages are delivered
/// in an order drawn from `seed`. If a rank throws, the others' operations throw too, and the first
/// rank's own exception is thrown again here.
void simulate_ranks(int count, std::uint64_t seed,
                    const std::function<void(Communicator&)>& rank_main);

}  // namespace breccia
