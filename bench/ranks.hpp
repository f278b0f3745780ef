#pragma once
// Benchmarks that ranks make together: how a step's time grows with ranks of equal work, and
// shrinks with ranks that share the work.

#include "bench/benchmark.hpp"
#include "domain/communicator.hpp"

namespace breccia {

/// Request for a weak or strong benchmark.
struct RankScale {
  std::int64_t elements = 0;  ///< of each rank, or of all; 0: as many as fits the device  [-]
  int steps = 50;             ///< of a window  [-]
};

/// Whole steps of the paper's slabs side by side, during the impact: as many slabs for each rank,
/// 7 on a host and 700 on a GPU. Every rank calls it, and gets the same result.
/// @param ranks  null: alone
std::vector<Measurement> measure_weak_slabs(const Exec& exec, Communicator* ranks,
                                            const RankScale& scale);
/// Slabs side by side: as many in all, whatever the number of ranks.
std::vector<Measurement> measure_strong_slabs(const Exec& exec, Communicator* ranks,
                                              const RankScale& scale);
/// Whole FDEM steps of a plate of joined triangles that rings: as many for each rank, 50,000 on a
/// host and 10 million on a GPU.
std::vector<Measurement> measure_weak_plate(const Exec& exec, Communicator* ranks,
                                            const RankScale& scale);
/// A plate: as many triangles in all, whatever the number of ranks.
std::vector<Measurement> measure_strong_plate(const Exec& exec, Communicator* ranks,
                                              const RankScale& scale);
/// The work before the first step of a large model of spheres, part by part: slabs side by side,
/// and one body cut from a cell that is repeated; of about a million elements each. Of one rank.
std::vector<Measurement> measure_set_up(const Exec& exec, Communicator* ranks,
                                        const RankScale& scale);

}  // namespace breccia
