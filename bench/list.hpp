#pragma once
// The built-in benchmarks by name.

#include <vector>

#include "bench/benchmark.hpp"
#include "bench/ranks.hpp"

namespace breccia {

/// One benchmark. To add one: a line in list.cpp.
struct Benchmark {
  const char* name;
  const char* meaning;  ///< one line for people
  std::vector<Measurement> (*measure)(const Exec& exec);
};

const std::vector<Benchmark>& benchmarks();

/// One that ranks make together. They run only when they are named.
struct RankBenchmark {
  const char* name;
  const char* meaning;  ///< one line for people
  std::vector<Measurement> (*measure)(const Exec& exec, Communicator* ranks,
                                      const RankScale& scale);
};

const std::vector<RankBenchmark>& rank_benchmarks();

}  // namespace breccia
